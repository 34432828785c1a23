"""``linuxcnc.ini``: what LinuxCNC 2.9 has, and the typed getters of 2.10."""

from __future__ import annotations

from pathlib import Path

import pytest

import linuxcnc

TEXT = """\
[FIRST]
NAME = mill
LONG = one \\
two
SWITCH = TRUE
SWITCH = no
SWITCH = On
SWITCH = perhaps
COUNT = 42
COUNT = -0x2a
COUNT = 0o52
COUNT = 0b101010
COUNT = many
SIZE = 4.2e1
SIZE = large
[SECOND]
NAME = lathe
"""


@pytest.fixture
def ini(tmp_path: Path) -> linuxcnc.ini:
    path = tmp_path / "machine.ini"
    path.write_text(TEXT)
    return linuxcnc.ini(path)


def test_sections_and_keys_are_listed_and_found(ini: linuxcnc.ini, tmp_path: Path) -> None:
    assert ini.getsections() == ["FIRST", "SECOND"]
    assert (ini.hassection("SECOND"), ini.hassection("THIRD")) == (True, False)
    assert ini.getvariables("FIRST")[:4] == [
        ("NAME", "mill"), ("LONG", "one two"), ("SWITCH", "TRUE"), ("SWITCH", "no"),
    ]  # fmt: skip
    assert ini.getvariables()[-2:] == [("SIZE", "large"), ("NAME", "lathe")]
    assert ini.getvariables("THIRD") == []
    assert (ini.hasvariable("FIRST", "NAME"), ini.hasvariable("SECOND", "SIZE")) == (True, False)
    assert ini.lineof("FIRST", "COUNT", 2) == (str(tmp_path / "machine.ini"), 10)
    assert ini.lineof("FIRST", "OTHER") == (None, None)


def test_texts_come_as_they_stand_there(ini: linuxcnc.ini) -> None:
    assert (ini.find("FIRST", "NAME"), ini.find("FIRST", "OTHER")) == ("mill", None)
    assert ini.getstring("FIRST", "LONG") == "one two"
    assert ini.getstring("FIRST", "SWITCH", 2) == "no"
    assert ini.getstring("FIRST", "SWITCH", 5, "fifth") == "fifth"
    assert ini.findall("FIRST", "SWITCH") == ["TRUE", "no", "On", "perhaps"]
    assert ini.findall("SECOND", "") == ["lathe"]


def test_typed_values_have_their_type(ini: linuxcnc.ini) -> None:
    assert [ini.getbool("FIRST", "SWITCH", n) for n in (1, 2, 3)] == [True, False, True]
    assert [ini.getsint("FIRST", "COUNT", n) for n in (1, 2, 3, 4)] == [42, -42, 42, 42]
    assert ini.getint("FIRST", "COUNT") == ini.getuint("FIRST", "COUNT") == 42
    assert ini.getreal("FIRST", "SIZE") == ini.getfloat("FIRST", "SIZE") == 42.0


@pytest.mark.parametrize(
    ("getter", "key", "num"),
    [("getbool", "SWITCH", 4), ("getsint", "COUNT", 5), ("getuint", "COUNT", 5), ("getreal", "SIZE", 2)],
)
def test_a_value_of_another_type_is_the_fallback_and_is_told(
    ini: linuxcnc.ini, capsys: pytest.CaptureFixture[str], getter: str, key: str, num: int
) -> None:
    assert getattr(ini, getter)("FIRST", key, num) is None
    assert getattr(ini, getter)("FIRST", key, num, fallback="else") == "else"
    assert f"[FIRST]{key}" in capsys.readouterr().err


@pytest.mark.parametrize("getter", ["getbool", "getsint", "getuint", "getreal", "getstring"])
def test_what_is_not_there_is_the_fallback_without_a_word(
    ini: linuxcnc.ini, capsys: pytest.CaptureFixture[str], getter: str
) -> None:
    assert getattr(ini, getter)("THIRD", "NAME") is None
    assert getattr(ini, getter)("THIRD", "NAME", fallback=7) == 7
    assert capsys.readouterr().err == ""


def test_a_negative_number_that_should_not_be_wraps_and_is_told(
    ini: linuxcnc.ini, capsys: pytest.CaptureFixture[str]
) -> None:
    assert ini.getuint("FIRST", "COUNT", 2) == 2**64 - 42
    assert "machine.ini:10: [FIRST]COUNT" in capsys.readouterr().err
