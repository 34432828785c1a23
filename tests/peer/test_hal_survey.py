"""The INI files of LinuxCNC's samples under ``sim``: their HAL files load, or the message names the one thing missing.

No machine is started: the pins of ``iocontrol`` and ``halui`` are made here, the realtime host is a process, and
programs that need an X display are not on the PATH. Those below ``sim/axis`` are left to
``test_sample_configurations.py``, which starts whole machines.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

import hal
from emcio.pins import make_component
from hal.realtime import REALTIME_VARIABLE
from hal.session import Session
from linuxcnc.configuration import Configuration
from linuxcnc.halsetup import set_up
from nml.errors import ConfigError
from tests.support.halsession import CHECKOUT

SIM = Path("/usr/share/doc/linuxcnc/examples/sample-configs/sim")
LIBRARY = Path("/usr/share/linuxcnc/hallib")

pytestmark = [
    pytest.mark.peer,
    pytest.mark.process,
    pytest.mark.skipif(not SIM.is_dir(), reason="Debian's linuxcnc-uspace is not installed"),
]

NO_PROGRAM = r"program '[\w-]+' not found"  # vismach models, gladevcp, pyvcp, qtvcp: they need an X display
NO_SCREEN = r"[\w-]+ exited without becoming ready"  # the same, where the program is in the sample's folder
LOADED = re.compile(r"^\s*(?:HALFILE|HALCMD|TWOPASS|KINEMATICS|JOINTS)\s*=.*", re.M)
HALUI_PIN = re.compile(r"\bhalui\.([\w.-]+)")
OUTPUTS = re.compile(r"\.is-|value$|units-per|feedback")
NUMBERS = re.compile(r"scale$|value$|speed$|pos-|units-per|analog|deadband|increment$")
COUNTS = re.compile(r"counts$|number$|selected$")


def halui(ini_text: str, folder: Path) -> hal.component:
    """The pins of halui that the HAL files of a sample name, with a type and direction by their names."""
    beside = [path for pattern in ("*.hal", "*.inc") for path in folder.glob(pattern)]
    texts = [ini_text, *(path.read_text(errors="replace") for path in beside)]
    named = {word for text in texts for word in re.findall(r"[\w.-]+\.hal", text)}
    texts += [path.read_text(errors="replace") for path in LIBRARY.glob("*.hal") if path.name in named]
    component = hal.component("halui")
    for name in sorted({name for text in texts for name in HALUI_PIN.findall(text)}):
        kind = hal.HAL_FLOAT if NUMBERS.search(name) else hal.HAL_S32 if COUNTS.search(name) else hal.HAL_BIT
        component.newpin(name, kind, hal.HAL_OUT if OUTPUTS.search(name) else hal.HAL_IN)
    component.ready()
    return component


def complaints(path: Path) -> list[str]:
    """What is said when the HAL files of an INI file are run to their ends."""
    said = io.StringIO()
    try:
        configuration = Configuration(path)
    except ConfigError as refusal:
        return [str(refusal)]
    os.chdir(path.parent)
    with (
        make_component(False), halui(path.read_text(), path.parent), Session(configuration.ini, True) as session,
        contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(said),
    ):  # fmt: skip
        session.host.start()
        try:
            set_up(session, configuration)
        except ConfigError as refusal:
            print(refusal, file=said)
        finally:
            session.teardown()
    return said.getvalue().splitlines()


@pytest.fixture(scope="module")
def samples(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A copy in which links are files."""
    folder = tmp_path_factory.mktemp("samples") / "sim"
    subprocess.run(["cp", "--recursive", "--dereference", SIM, folder], check=False, stderr=subprocess.DEVNULL)
    yield folder
    shutil.rmtree(folder)


def different_ones() -> list[str]:
    """One INI file, below ``sim``, for each folder and set of lines that say what is loaded."""
    found: dict[tuple[Path, str], str] = {}
    for path in sorted(path for path in SIM.rglob("*.ini") if path.relative_to(SIM).parts[0] != "axis"):
        lines = sorted(LOADED.findall(path.read_text(errors="replace")))
        found.setdefault((path.parent, "".join(lines)), str(path.relative_to(SIM)))
    return sorted(found.values())


@pytest.mark.parametrize("name", different_ones())
def test_the_hal_files_of_a_sample_load_or_one_thing_is_missing(
    samples: Path, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(CHECKOUT / ".no-programs"))
    monkeypatch.setenv("INI_FILE_NAME", str(samples / name))
    monkeypatch.setenv(REALTIME_VARIABLE, "0")
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.chdir(samples)
    said = complaints(samples / name)
    if said:
        assert re.search(rf"{NO_PROGRAM}|{NO_SCREEN}|\[KINS\]JOINTS: missing|no such file", said[0]), said[:3]
