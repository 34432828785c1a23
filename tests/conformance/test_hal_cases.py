"""LinuxCNC's own HAL test cases: ``halrun`` prints what it should."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from tests.support.halsession import run

CASES = Path(__file__).resolve().parents[3] / "shared" / "conformance" / "hal"
NAMES = sorted(path.parent.name for path in CASES.glob("*/case.json"))


@pytest.mark.process
@pytest.mark.skipif(not NAMES, reason=f"{CASES} is absent")
@pytest.mark.parametrize("name", NAMES or ["none"])
def test_halrun_prints_what_linuxcnc_expects(name: str, tmp_path: Path) -> None:
    folder = tmp_path / name
    shutil.copytree(CASES / name, folder)
    program, *arguments = json.loads((folder / "case.json").read_text())["argv"]
    assert program == "halrun"
    done = run("halrun", *arguments, cwd=folder)
    assert done.stdout == (folder / "expected").read_text(), done.stderr

