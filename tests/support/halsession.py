"""HAL programs as processes, for tests: ``halcmd`` and ``halrun`` of the checkout in the test's namespace."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

CHECKOUT = Path(__file__).resolve().parents[2]


def environment() -> dict[str, str]:
    """This process's, with our packages wherever a program runs."""
    return {**os.environ, "PYTHONPATH": str(CHECKOUT)}


def run(program: str, *arguments: str, cwd: Path | None = None, given: str = "") -> subprocess.CompletedProcess[str]:
    """Run ``hal.PROGRAM`` to its end."""
    return subprocess.run(
        [sys.executable, "-m", f"hal.{program}", *arguments],
        cwd=cwd,
        env=environment(),
        input=given,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


def halcmd(*arguments: str) -> str:
    """What a command prints; an AssertionError with its message where it fails."""
    done = run("halcmd", *arguments)
    assert done.returncode == 0, done.stderr
    return done.stdout


def script(tmp_path: Path, text: str, *options: str, program: str = "halrun") -> subprocess.CompletedProcess[str]:
    """Run the lines of a HAL file."""
    path = tmp_path / "test.hal"
    path.write_text(text)
    return run(program, *options, "-f", str(path), cwd=tmp_path)


PERIODS = """\
import time
from hal.core import Hal

[thread] = Hal().segment.threads()
first = thread.cycles
while thread.cycles < first + 5:
    time.sleep(0.001)
"""


def some_periods(folder: Path) -> str:
    """The line of a HAL file that waits until its one thread has run some periods from then on."""
    path = folder / "periods.py"
    path.write_text(PERIODS)
    return f"loadusr -w {sys.executable} {path}\n"
