"""INI files: LinuxCNC's reading rules, typed getters, and errors that say where."""

from pathlib import Path

import pytest

from nml.errors import ConfigError
from nml.inifile import IniFile

RULES = """TOP = 1
[A]
# comment
  ; indented comment
PLAIN = value
SPACES =   value with spaces  \t
INLINE = value # not a comment
EQ = a = b
EMPTY =
NOEQ
CONT = one \\
 two \\
three
case = lower
REP = 1
REP = 2
[ B ]
X = 1
[A]
AGAIN = yes
"""

NUMBERS = """[N]
I = 12
HEX = 0x7FFFFFFF
OCTAL_LOOK = 010
F = 1.5   # mm
BAD = 1,5
ON = yes
OFF = Off
PATH = tool.tbl
UNITS = MM
NAN = nan
"""


def write(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text)
    return path


@pytest.fixture
def rules(tmp_path: Path) -> IniFile:
    return IniFile(write(tmp_path, "rules.ini", RULES))


@pytest.fixture
def numbers(tmp_path: Path) -> IniFile:
    return IniFile(write(tmp_path, "numbers.ini", NUMBERS))


@pytest.mark.parametrize(
    ("section", "key", "value"),
    [
        ("", "TOP", "1"),
        ("A", "PLAIN", "value"),
        ("A", "SPACES", "value with spaces"),
        ("A", "INLINE", "value # not a comment"),
        ("A", "EQ", "a = b"),
        ("A", "EMPTY", None),
        ("A", "NOEQ", None),
        ("A", "CONT", "one  two three"),
        ("A", "CASE", None),
        ("a", "PLAIN", None),
        ("A", "AGAIN", None),
        (" B ", "X", "1"),
        ("B", "X", None),
    ],
)
def test_values_are_read_as_inivar_reads_them(rules: IniFile, section: str, key: str, value: str | None):
    assert rules.find(section, key) == value


def test_repeated_keys_come_in_order(rules: IniFile):
    assert rules.findall("A", "REP") == ["1", "2"]
    assert rules.find("A", "REP", num=2) == "2"
    assert rules.find("A", "REP", num=3) is None
    assert rules.findall("A", "NONE") == []


def test_lines_that_mean_nothing_are_remarked_with_their_place(rules: IniFile):
    assert [remark.split(": ", 1)[0].rsplit(":", 1)[1] for remark in rules.remarks] == ["10", "19"]


def test_unread_entries_include_those_of_a_second_section(rules: IniFile):
    rules.find("A", "PLAIN")
    names = [entry.key for entry in rules.unread()]
    assert "PLAIN" not in names
    assert names[-1] == "AGAIN"


def test_a_place_is_the_first_line_of_a_continued_entry(rules: IniFile):
    assert str(rules.place("A", "CONT")) == f"{rules.file}:11"


def test_typed_getters_convert(numbers: IniFile):
    assert numbers.integer("N", "I") == 12
    assert numbers.integer("N", "HEX") == 0x7FFFFFFF
    assert numbers.integer("N", "OCTAL_LOOK") == 10
    assert numbers.real("N", "F") == 1.5
    assert numbers.boolean("N", "ON") is True
    assert numbers.boolean("N", "OFF") is False
    assert numbers.path("N", "PATH") == numbers.file.parent / "tool.tbl"
    assert numbers.choice("N", "UNITS", {"inch": 25.4, "mm": 1.0}) == 1.0
    assert numbers.real("N", "NONE", None) is None


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda ini: ini.real("N", "BAD"), "numbers.ini:6: [N]BAD: '1,5' is not a number"),
        (lambda ini: ini.real("N", "NAN"), "'nan' is not a number"),
        (lambda ini: ini.integer("N", "I", minimum=1, maximum=9), "12 is out of range; a whole number from 1 to 9"),
        (lambda ini: ini.integer("N", "NONE", minimum=1), "[N]NONE: missing; a whole number, at least 1 is needed"),
        (lambda ini: ini.boolean("N", "BAD"), "is not TRUE, YES, ON, 1, FALSE, NO, OFF or 0"),
        (lambda ini: ini.choice("N", "UNITS", {"inch": 1}), "'MM' is not one of inch"),
    ],
)
def test_a_bad_value_names_place_key_and_limits(numbers: IniFile, call, text: str):
    with pytest.raises(ConfigError) as caught:
        call(numbers)
    assert text in str(caught.value)


def test_included_files_stand_in_their_place(tmp_path: Path):
    write(tmp_path, "axis.inc", "[AXIS_X]\nMAX_VELOCITY = 5\n")
    ini = IniFile(write(tmp_path, "main.ini", "[EMC]\nMACHINE = m\n#INCLUDE axis.inc\n#INCLUDE none.inc\n"))
    assert ini.real("AXIS_X", "MAX_VELOCITY") == 5.0
    assert str(ini.place("AXIS_X", "MAX_VELOCITY")) == f"{tmp_path / 'axis.inc'}:2"
    assert ini.remarks == [f"{tmp_path / 'main.ini'}:4: #INCLUDE of a missing file: {tmp_path / 'none.inc'}"]


def test_a_file_that_includes_itself_is_refused(tmp_path: Path):
    with pytest.raises(ConfigError, match="include itself"):
        IniFile(write(tmp_path, "loop.ini", "#INCLUDE loop.ini\n"))


def test_a_missing_file_is_one_line(tmp_path: Path):
    with pytest.raises(ConfigError, match=r"none\.ini: cannot read the INI file: No such file"):
        IniFile(tmp_path / "none.ini")


def test_lines_end_with_lf_or_cr_lf_and_nothing_else(tmp_path: Path):
    (tmp_path / "ends.ini").write_bytes("[A]\nLF = 1\r\nCRLF = x\u2028y\x0cz\nCUT = a \\\r\nb\n".encode())
    (tmp_path / "cr.ini").write_bytes(b"[A]\rLOST = 1\r")
    ini = IniFile(tmp_path / "ends.ini")
    assert [ini.find("A", key) for key in ("LF", "CRLF", "CUT")] == ["1", "x\u2028y\x0cz", "a b"]
    assert IniFile(tmp_path / "cr.ini").find("A", "LOST") is None
