"""inivalue: values of an INI file with their type, and the names in it."""

from pathlib import Path

import pytest

from nml.tools import inivalue

TEXT = """[TRAJ]
AXES = 3
AXES = 0x10
FEED = -2.5
MASK = -1
HOMED = Yes
WORD = up 7
[DISPLAY]
EDITOR = ~/bin/ed
AXES = 0b11
"""


@pytest.fixture
def ini(tmp_path: Path) -> Path:
    path = tmp_path / "test.ini"
    path.write_text(TEXT)
    return path


@pytest.mark.parametrize(
    ("question", "answer"),
    [
        ("--var=AXES", "3"),
        ("--var=AXES --sec=DISPLAY", "0b11"),
        ("-V AXES -N 2", "0x10"),
        ("-V AXES -N 3 -y i", "3"),
        ("--var=AXES --all", "3 0x10 0b11"),
        ("--var=AXES --all --num=2 --type=integer", "16 3"),
        ("--var=NONE --all", ""),
        ("-V FEED -y r", "-2.500000000000000e+00"),
        ("-V FEED -y r -a", "-2.5"),
        ("-V FEED -y r -m -3 -M -2.5", "-2.500000000000000e+00"),
        ("-V MASK -y i -m -1 -M 0", "-1"),
        ("-V MASK -y u", "18446744073709551615"),
        ("-V HOMED -y b", "true"),
        ("-V HOMED -y b -b", "1"),
        ("-V HOMED -y b -B", "True"),
        ("-V EDITOR", "~/bin/ed"),
        ("-V EDITOR -T", "/home/me/bin/ed"),
        ("--sections", "TRAJ DISPLAY"),
        ("--variables --sec DISPLAY", "EDITOR AXES"),
        ("-ocp -S DISPLAY", "[DISPLAY]EDITOR=~/bin/ed [DISPLAY]AXES=0b11"),
        ("-op", "[TRAJ]AXES [TRAJ]AXES [TRAJ]FEED [TRAJ]MASK [TRAJ]HOMED [TRAJ]WORD [DISPLAY]EDITOR [DISPLAY]AXES"),
    ],
)
def test_what_is_printed(
    ini: Path, question: str, answer: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv("HOME", "/home/me")
    assert inivalue.main([*question.split(), str(ini)]) == 0
    assert capsys.readouterr().out.split() == answer.split()


@pytest.mark.parametrize(
    ("question", "code", "reason"),
    [
        ("-V NONE", 2, "[]NONE: there are 0 of them"),
        ("-V AXES -N 9 -S TRAJ", 2, "[TRAJ]AXES: there are 2 of them"),
        ("-V AXES -a -N 4", 2, "[]AXES: there are 3 of them"),
        ("-V WORD -y i", 3, "test.ini:7: [TRAJ]WORD: 'up 7' is not a whole number"),
        ("-V WORD -y r", 3, "'up 7' is not a number"),
        ("-V WORD -y b", 3, "[TRAJ]WORD: 'up 7' is not"),
        ("-V AXES -y i -m 4", 3, "3 is out of range"),
        ("-V MASK -y u -M 7", 3, "18446744073709551615 is out of range; from 0 to 7 is allowed"),
        ("-V FEED -y r -m 0", 3, "-2.5 is out of range"),
        ("-V EDITOR -T", 1, "~/bin/ed: HOME is not set"),
        ("-V AXES -y i -m ten", 1, "ten"),
    ],
)
def test_what_is_wrong(
    ini: Path,
    question: str,
    code: int,
    reason: str,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.delenv("HOME", raising=False)
    assert inivalue.main([*question.split(), str(ini)]) == code
    told = capsys.readouterr()
    assert reason in told.err
    assert not told.out


def test_quiet_says_nothing_of_an_entry_that_is_not_there(ini: Path, capsys: pytest.CaptureFixture[str]):
    assert inivalue.main(["-q", "-V", "NONE", str(ini)]) == 2
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize("question", ["", "-V AXES -y z", "-V AXES -N 0", "--none", "-V"])
def test_wrong_options_end_with_1(ini: Path, question: str):
    with pytest.raises(SystemExit) as end:
        inivalue.main([*question.split(), str(ini)])
    assert end.value.code == 1


def test_a_missing_file_ends_with_1(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert inivalue.main(["--sections", str(tmp_path / "none.ini")]) == 1
    assert "none.ini: cannot read the INI file" in capsys.readouterr().err
