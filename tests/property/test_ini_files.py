"""Whatever stands in an INI file, the launcher and its check take it or refuse it in one line."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from linuxcnc.check import findings
from linuxcnc.configuration import Configuration
from nml.errors import PyemcError
from tests.support.machine import MILL

FILES = 150
VALUES = (
    *(b'"', b"'", b"\\", b"", b"-1", b"1e999", b"nan", b"inf", b"0x", b"%s", b"${X}", b"(A", b"\xff", b"..", b"/"),
    *(b"~nobody/x", b'a b "c', b"\0", b"\xc2\xbd", b"9" * 400, b"LIB:", b"LIB:x", b"-", b"|", b"web --port x"),
)
INCLUDED = (b"x", b"changed.ini", b"/dev/null", b"/etc", b"", b'"', b"~x", b"\0", b"y" * 300)


def changed(text: bytes, choose: random.Random) -> bytes:
    """The INI file with some lines broken in one way or another."""
    lines = text.split(b"\n")
    for _ in range(choose.choice((1, 1, 2, 4))):
        at, other = choose.randrange(len(lines)), choose.randrange(len(lines))
        ways = (
            lines[at].partition(b"=")[0] + b"= " + choose.choice(VALUES),
            bytes(choose.randrange(256) for _ in range(choose.randrange(40))),
            lines[at][: choose.randrange(len(lines[at]) + 1)],
            lines[at] + b"\n" + lines[other],
            b"#INCLUDE " + choose.choice(INCLUDED),
            b"",
        )
        lines[at] = choose.choice(ways)
    return b"\n".join(lines)


@pytest.mark.parametrize("seed", range(4))
def test_a_broken_ini_file_is_taken_or_refused_in_one_line(tmp_path: Path, seed: int):
    for path in MILL.iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    ini = tmp_path / "changed.ini"
    choose = random.Random(seed)
    refusals = []
    for _ in range(FILES):
        ini.write_bytes(changed((MILL / "mill_mm.ini").read_bytes(), choose))
        assert all(len(line.splitlines()) == 1 for line in findings(ini))
        try:
            configuration = Configuration(ini)
            configuration.display()
            configuration.environment()
        except PyemcError as reason:
            refusals.append(str(reason))
    assert all(len(refusal.splitlines()) == 1 for refusal in refusals), refusals
    assert 0 < len(refusals) < FILES
