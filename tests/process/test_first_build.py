"""``scripts/linuxcnc`` in a fresh checkout sets up what is missing; after an interruption the next start does it."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.machine import ROOT, wait_until

pytestmark = pytest.mark.process

SETUP = """
import os, sys, time
with open("built", "a") as file:
    print(*sys.argv[1:], os.environ.get("CYTHON_FORCE_REGEN"), file=file)
while os.path.exists("slow"):
    time.sleep(0.02)
sys.exit(os.path.exists("broken"))
"""
"""The build: notes how it was called, lasts while there is a file ``slow``, fails where there is one ``broken``."""


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A checkout with nothing but what the set-up looks at, its virtual environment made and filled."""
    shutil.copytree(ROOT / "scripts", tmp_path / "scripts")
    for package in ("nml/emc", "hal", "rs274ngc", "emcmot", ".venv/bin"):
        (tmp_path / package).mkdir(parents=True)
    (tmp_path / "nml" / "emc" / "emcmot.py").touch()
    (tmp_path / "setup.py").write_text(SETUP)
    (tmp_path / "pyproject.toml").write_text(
        "[build-system]\nrequires = []\n[project]\ndependencies = []\noptional-dependencies = {}\n"
    )
    for name, text in (("python", f'exec {sys.executable} "$@"'), ("pip", "exit 0")):
        (tmp_path / ".venv" / "bin" / name).write_text(f"#!/bin/sh\n{text}\n")
        (tmp_path / ".venv" / "bin" / name).chmod(0o755)
    return tmp_path


def prepare(folder: Path) -> subprocess.Popen[str]:
    """The set-up that every command of ``scripts`` begins with."""
    script = "set -euo pipefail; source scripts/prepare.bash; prepare run; echo ready"
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    return subprocess.Popen(
        ["env", "--default-signal=INT,TERM", "bash", "-c", script],  # a test run in the background ignores SIGINT
        cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )


def built(folder: Path) -> list[str]:
    """How the native core was built, one line each time."""
    return (folder / "built").read_text().splitlines()


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_interrupted_build_is_told_and_done_again_from_the_beginning(
    checkout: Path, number: signal.Signals, code: int
) -> None:
    (checkout / "slow").touch()
    first = prepare(checkout)
    wait_until(lambda: (checkout / "built").exists() and built(checkout), "the build")
    os.killpg(first.pid, number)
    output, errors = first.communicate()
    assert (first.returncode, output) == (code, "")
    assert errors.splitlines()[-1] == "pyemc: interrupted; the next start does this again"
    assert "does not compile" not in errors
    (checkout / "slow").unlink()
    second = prepare(checkout)
    assert second.communicate()[0] == "ready\n"
    third = prepare(checkout)
    assert third.communicate() == ("ready\n", "")
    calls = built(checkout)
    assert len(calls) == 2
    assert calls[0].endswith(" None")
    assert calls[1].endswith(" --force 1")


def test_a_build_that_fails_says_so_and_the_next_one_goes_on_from_there(checkout: Path) -> None:
    (checkout / "broken").touch()
    first = prepare(checkout)
    output, errors = first.communicate()
    assert (first.returncode, output) == (1, "")
    assert "the native core does not compile; the whole log is in" in errors.splitlines()[-1]
    (checkout / "broken").unlink()
    assert prepare(checkout).communicate()[0] == "ready\n"
    assert [call.split()[-1] for call in built(checkout)] == ["None", "None"]
