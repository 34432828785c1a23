"""The table of INI entries: its document is current, and it has whatever the processes ask an INI file for."""

from pathlib import Path

import pytest

from emcio.__main__ import tool_source
from emctask.config import read_config
from linuxcnc import inikeys
from nml.inifile import IniFile
from rs274ngc import settings
from rs274ngc.canon import Canon
from rs274ngc.interp import Interpreter
from tests.support.machine import MILL, ROOT


class Asked(IniFile):
    """An INI file that notes what it is asked for."""

    def __init__(self, path: Path) -> None:
        self.asked: set[tuple[str, str]] = set()
        super().__init__(path)

    def _entry(self, section, key, num):
        self.asked.add((section, key))
        return super()._entry(section, key, num)


READERS = {
    inikeys.Reader.TASK: read_config,
    inikeys.Reader.IO: tool_source,
    inikeys.Reader.LANGUAGE: lambda ini: settings.apply_settings(Interpreter(Canon()), ini),
}


def test_the_document_is_made_from_the_table():
    assert (ROOT / "docs" / "ini.md").read_text() == "\n".join(inikeys.document()) + "\n"


def test_no_entry_is_there_twice():
    assert len({(key.section, key.name) for key in inikeys.KEYS}) == len(inikeys.KEYS)


@pytest.mark.parametrize("reader", READERS, ids=lambda reader: reader.value)
def test_whatever_a_process_asks_for_is_in_the_table(reader):
    ini = Asked(MILL / "mill_mm.ini")
    READERS[reader](ini)
    asked = {(section, key): inikeys.lookup(section, key) for section, key in ini.asked}
    unknown = {entry for entry, key in asked.items() if key is None} - {("RS274NGC", "FEATURE")}
    assert not unknown
    assert not {entry for entry, key in asked.items() if key and key.reader is inikeys.Reader.NOBODY}


@pytest.mark.parametrize("key", inikeys.KEYS, ids=lambda key: f"[{key.section}]{key.name}")
def test_a_default_is_a_value_that_is_allowed(key):
    if key.kind is inikeys.Kind.REAL and key.default not in ("", "FERROR", "forward"):
        value = float(key.default)
        assert key.minimum is None or value >= key.minimum
        assert key.maximum is None or value <= key.maximum
    if key.choices and key.default:
        assert key.default in key.choices


@pytest.mark.parametrize(
    ("section", "family"), [("JOINT_12", "JOINT_n"), ("AXIS_U", "AXIS_L"), ("AXIS_Q", "AXIS_Q"), ("TRAJ", "TRAJ")]
)
def test_numbered_sections_have_one_entry_in_the_table(section, family):
    assert inikeys.family(section) == family
