"""LinuxCNC's own interpreter cases: program, tool table and INI file in, canonical calls out."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CASES = ROOT.parent / "shared" / "conformance" / "rs274"
NAMES = sorted(folder.name for folder in CASES.iterdir()) if CASES.is_dir() else []

pytestmark = pytest.mark.skipif(not NAMES, reason=f"{CASES} is not there")


def without_first_field(text: str) -> str:
    """Each line as ``awk '{$1=""; print}'`` gives it: the line counter is not compared."""
    return "".join(" ".join(["", *line.split()[1:]]) + "\n" for line in text.splitlines())


@pytest.mark.parametrize("name", NAMES)
def test_a_program_prints_the_expected_canonical_calls(name: str, tmp_path: Path) -> None:
    folder = tmp_path / name
    shutil.copytree(CASES / name, folder)
    case = json.loads((folder / "case.json").read_text())
    environment = dict(os.environ, PYTHONPATH=str(ROOT))
    command = [sys.executable, "-m", "rs274ngc", *case["argv"][1:]]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300)
    output = without_first_field(done.stdout) if case["blank_first_field"] else done.stdout
    if case["replace_minus_zero"]:
        output = output.replace("-0.0000", "0.0000")
    assert output == (folder / "expected").read_text(), done.stderr
