"""scripts/run_linuxcnc_tests.py: how a folder of LinuxCNC's form is run and judged."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.machine import ROOT

pytestmark = pytest.mark.process

SUITE: dict[str, str] = {
    "hal/gate/test.hal": "loadrt or2 names=gate\nsetp gate.in0 1\nlist pin gate.in0\n",
    "hal/gate/expected": "gate.in0 \n",
    "shell/right/test.sh": "echo seen by bash\n",
    "shell/right/checkresult": "#!/bin/sh\ngrep -q seen $1\n",
    "shell/wrong/test.sh": "echo one\n",
    "shell/wrong/expected": "two\n",
    "shell/known/test.sh": "exit 3\n",
    "shell/known/xfail": "",
    "shell/off/test.sh": "exit 3\n",
    "shell/off/skip": "",
    "program/own/test": '#!/bin/sh\n[ -n "$PYEMC_NAMESPACE" ] && [ -n "$TEST_DIR" ] && pwd\n',
    "program/own/checkresult": "grep -q program/own $1\n",
    "program/bare/test": "echo no interpreter is named\n",
    "program/bare/checkresult": "grep -q interpreter $1\n",
    "program/slow/test": "#!/bin/sh\nsleep 1000\n",
}


@pytest.fixture
def suite(tmp_path: Path) -> Path:
    for name, text in SUITE.items():
        path = tmp_path / "tests" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        if text.startswith("#!") or "/bare/" in name:
            path.chmod(0o755)
    return tmp_path / "tests"


def suite_run(suite: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(ROOT / "scripts" / "run_linuxcnc_tests.py"), str(suite), *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)


def test_each_folder_gets_its_word_and_a_failure_its_reason(suite: Path) -> None:
    (suite / "program" / "slow" / "test").unlink()
    done = suite_run(suite)
    lines = done.stdout.splitlines()
    words = dict(reversed(line.split()) for line in lines if line and not line.startswith(" ") and "," not in line)
    assert words == {
        "hal/gate": "pass",
        "program/bare": "pass",
        "program/own": "pass",
        "shell/known": "xfail",
        "shell/off": "skip",
        "shell/right": "pass",
        "shell/wrong": "fail",
    }, done.stdout + done.stderr
    assert "      -two" in lines
    assert lines[-1] == "4 pass, 1 fail, 1 xfail, 1 skip"
    assert done.returncode == 1


def test_some_folders_can_be_chosen_and_the_suite_itself_stays_as_it_was(suite: Path) -> None:
    done = suite_run(suite, "right", "program/own")
    assert (done.returncode, done.stdout.splitlines()[-1]) == (0, "2 pass, 0 fail, 0 xfail, 0 skip")
    assert not list(suite.rglob("result"))


def test_a_test_that_does_not_end_is_ended(suite: Path) -> None:
    done = suite_run(suite, "slow", "--timeout", "0.5")
    assert "not over within 0.5 s" in done.stdout
    assert done.returncode == 1
