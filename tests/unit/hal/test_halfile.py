"""Lines of HAL files: continuation, comments, substitution, words."""

from __future__ import annotations

from pathlib import Path

import pytest

from hal.halfile import logical_lines, split, strip_comment, substitute, without_arrows, words
from nml.errors import HalError
from nml.inifile import IniFile


@pytest.fixture
def ini(tmp_path: Path) -> IniFile:
    path = tmp_path / "m.ini"
    path.write_text("[KINS]\nKINEMATICS = trivkins coordinates=XZ\nJOINTS = 2\n[A-B]\nX_1 = 7\n")
    return IniFile(path)


def test_a_continued_line_counts_as_its_last_line() -> None:
    assert list(logical_lines(["a \\\n", "b\n", "c\n", "d \\"])) == [(2, "a b"), (3, "c"), (4, "d ")]


@pytest.mark.parametrize(
    ("line", "kept"),
    [("a # b", "a "), ('print "# no" # yes', 'print "# no" '), ("# all", ""), ("a#b", "a")],
)
def test_a_comment_begins_outside_of_quotes(line: str, kept: str) -> None:
    assert strip_comment(line) == kept


@pytest.mark.parametrize(
    ("line", "result"),
    [
        ("loadrt [KINS]KINEMATICS", ["loadrt", "trivkins", "coordinates=XZ"]),
        ("loadrt x n=[KINS](JOINTS)00", ["loadrt", "x", "n=200"]),
        ("setp [A-B]X_1 1", ["setp", "7", "1"]),
        ("loadrt m num_joints=[KINS]JOINTS", ["loadrt", "m", "num_joints=2"]),
        ("setp a $(HALTEST)x", ["setp", "a", "yesx"]),
        ("setp a $HALTEST", ["setp", "a", "yes"]),
        ("source $HALTEST/a.hal", ["source", "yes/a.hal"]),
        ("loadrt x n=[KINS]JOINTS,[KINS]JOINTS", ["loadrt", "x", "n=2,2"]),
        ("print 'a[KINS]JOINTS' $(HALTEST)$(HALTEST)", ["print", "'a2'", "yesyes"]),
    ],
)
def test_variables_are_put_in(ini: IniFile, monkeypatch: pytest.MonkeyPatch, line: str, result: list[str]) -> None:
    monkeypatch.setenv("HALTEST", "yes")
    assert words(line, ini) == result


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ("setp a [KINS JOINTS", "Missing close square"), ("setp a [KINS](JOINTS 1", "Missing close parenthesis"),
        ("print $(HOME", "Missing close parenthesis"), ("print $", "Empty variable name"), ("print a[0]", "Empty"),
        ('print "a b', "unterminated quoted string"), ("print it's", "unterminated quoted string"),
        ('print "a # b', "unterminated quoted string"),
    ],
)  # fmt: skip
def test_a_bracket_or_quote_that_is_left_open_is_named(ini: IniFile, line: str, what: str) -> None:
    with pytest.raises(HalError, match=what):
        words(line, ini)


@pytest.mark.parametrize("line", ["setp a [KINS]NONE", "setp a [NO]JOINTS", "setp a $NO_SUCH_THING", "setp a $A.b"])
def test_an_unknown_variable_is_an_error(ini: IniFile, line: str) -> None:
    with pytest.raises(HalError, match="not found"):
        substitute(line, ini)


def test_without_an_ini_file_the_error_says_so() -> None:
    with pytest.raises(HalError, match="no INI file was given"):
        substitute("setp a [KINS]JOINTS", None)


def test_quotes_hold_words_together_and_stay() -> None:
    assert split("""loadusr "a b" 'c d'  e""") == ["loadusr", '"a b"', "'c d'", "e"]


def test_arrows_mean_nothing() -> None:
    assert without_arrows(["s", "<=", "a", "=>", "b", "<=>", "c"]) == ["s", "a", "b", "c"]
