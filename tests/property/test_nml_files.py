"""NML and INI files made of nearly right lines: they parse, or a ConfigError names a place; nothing else happens."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from hypothesis import given, settings
from hypothesis import strategies as st

from nml.check import contradictions, topology
from nml.config import NmlConfig
from nml.errors import ConfigError
from nml.inifile import IniFile

VALID = """B P one two default SHMEM LOCMEM PHANTOM localhost 1024 0 1 16 -1 1e9 INF R RW LOCAL REMOTE AUTO TCP=5005
TCP= queue broadcast neut mutex=mao split mutex=none passwd= bsem=x # sub=var max_timeouts=INF é"""
WORDS = st.sampled_from([*VALID.split(), "\0"])
LINES = st.lists(st.lists(WORDS, max_size=14).map(" ".join), max_size=8).map("\n".join)
PARTS = ("[A]", "[", "]", "KEY", "=", "1.5", "\\\n", "\n", "#", ";", " ", "#INCLUDE x\n", "é", "\t")
INI_PARTS = st.sampled_from(PARTS)


@settings(max_examples=150, deadline=None)
@given(LINES)
def test_an_nml_file_parses_or_names_the_place(text: str):
    with TemporaryDirectory() as folder:
        path = Path(folder) / "test.nml"
        path.write_text(text)
        try:
            config = NmlConfig(path)
        except ConfigError as error:
            place = error.place
            assert place is not None
        else:
            for finding in contradictions(config):
                assert finding.startswith(str(path))
            assert len(list(topology(config))) == 2 * len(config.buffer_lines)
            return
        assert place.file == str(path)
        assert 1 <= place.line <= text.count("\n") + 1
        assert place.column >= 1


@settings(max_examples=150, deadline=None)
@given(st.lists(INI_PARTS, max_size=40).map("".join))
def test_an_ini_file_always_parses_and_keeps_its_entries(text: str):
    with TemporaryDirectory() as folder:
        path = Path(folder) / "test.ini"
        path.write_text(text)
        ini = IniFile(path)
        for section in ini.sections():
            for key in ini.keys(section):
                values = ini.findall(section, key)
                assert values == [ini.find(section, key, num=n + 1) for n in range(len(values))]
                assert all(values)
        assert [entry for entry in ini.unread() if not entry.hidden] == []
