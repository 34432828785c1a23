"""Filters: the right one for an extension, its output as the program, its progress, its failure in one line."""

import sys

import pytest

from linuxcnc.filters import FilterError, filtered
from nml.errors import ConfigError
from nml.inifile import IniFile

GOOD = """\
import sys
print("G1 X1", open(sys.argv[1]).read().strip())
for percent in (0, 50, 100):
    print(f"FILTER_PROGRESS={percent}", file=sys.stderr)
print("two layers", file=sys.stderr)
"""


def machine(tmp_path, text, command=f"{sys.executable} make.py"):
    (tmp_path / "make.py").write_text(text)
    ini = tmp_path / "machine.ini"
    ini.write_text(f"[FILTER]\nPROGRAM_EXTENSION = .dat Data\ndat = {command}\n")
    (tmp_path / "part.dat").write_text("Y2\n")
    return IniFile(ini), tmp_path / "part.dat"


def test_a_filter_makes_the_program_and_tells_its_progress(tmp_path):
    ini, part = machine(tmp_path, GOOD)
    percents, lines = [], []
    made = filtered(ini, part, percents.append, lines.append)
    assert made.read_text() == "G1 X1 Y2\n"
    assert (percents, lines) == ([0, 50, 100], ["two layers"])


def test_a_file_without_a_filter_is_the_program_itself(tmp_path):
    ini, _ = machine(tmp_path, GOOD)
    assert filtered(ini, tmp_path / "part.ngc") == tmp_path / "part.ngc"
    assert filtered(ini, tmp_path / "part") == tmp_path / "part"


def test_a_filter_that_fails_says_why_in_one_line(tmp_path):
    ini, part = machine(tmp_path, "raise SystemExit('no such layer')\n")
    with pytest.raises(FilterError, match=r"part\.dat: .*make\.py ended with exit code 1: no such layer"):
        filtered(ini, part)


def test_a_filter_that_is_not_there_is_named_with_its_line(tmp_path):
    ini, part = machine(tmp_path, "", command="nosuchfilter")
    with pytest.raises(ConfigError, match=r"machine\.ini:3: .*nosuchfilter: No such file"):
        filtered(ini, part)
