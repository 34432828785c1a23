"""inivar: values for scripts, and the same answers as Debian's."""

import shutil
import subprocess
from pathlib import Path

import pytest

from nml.tools import inivar

TEXT = "[A]\nP = ~/x\nR = 1\nR = 2\nE =\nC = a \\\nb\n[B]\nQ = 9 # no comment\nR = 3\n[A]\nS = hidden\n"
QUESTIONS = [
    ["-var", "P", "-sec", "A"],
    ["-tildeexpand", "-var", "P", "-sec", "A"],
    ["-var", "R", "-sec", "A", "-num", "2"],
    ["-var", "R", "-sec", "A", "-num", "3"],
    ["-var", "C", "-sec", "A"],
    ["-var", "E", "-sec", "A"],
    ["-var", "S", "-sec", "A"],
    ["-var", "Q", "-sec", "A"],
    ["-var", "Q"],
    ["-var", "R", "-num", "2"],
]


@pytest.fixture
def ini(tmp_path: Path) -> Path:
    path = tmp_path / "test.ini"
    path.write_text(TEXT)
    return path


def test_a_value_is_printed(ini: Path, capsys: pytest.CaptureFixture[str]):
    assert inivar.main(["-var", "R", "-sec", "A", "-num", "2", "-ini", str(ini)]) == 0
    assert capsys.readouterr().out == "2\n"


def test_what_is_missing_is_told(ini: Path, capsys: pytest.CaptureFixture[str]):
    assert inivar.main(["-var", "X", "-sec", "A", "-ini", str(ini)]) == 1
    assert inivar.main(["-var", "X", "-ini", str(ini.parent / "none.ini")]) == 255
    missing, unreadable = capsys.readouterr().err.splitlines()
    assert missing == "Can not find -sec A -var X -num 1"
    assert unreadable.endswith("none.ini: cannot read the INI file: No such file or directory")


@pytest.mark.peer
@pytest.mark.skipif(shutil.which("/usr/bin/inivar") is None, reason="Debian's LinuxCNC is not installed")
@pytest.mark.parametrize("question", QUESTIONS, ids=" ".join)
def test_the_answer_is_that_of_debians_inivar(ini: Path, question: list[str], capsys: pytest.CaptureFixture[str]):
    stock = subprocess.run(["/usr/bin/inivar", *question, "-ini", ini], capture_output=True, text=True)
    assert inivar.main([*question, "-ini", str(ini)]) == stock.returncode
    assert capsys.readouterr().out.strip() == stock.stdout.strip()
