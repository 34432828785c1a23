"""Completion of linuxcnc-ctl in a real bash: what pressing TAB offers."""

import shutil
import subprocess
import sys

import pytest

from tests.support.machine import ROOT

BASH = shutil.which("bash")

pytestmark = [pytest.mark.process, pytest.mark.skipif(BASH is None, reason="bash is not installed")]

PRESS_TAB = """
source <("$1" -m linuxcnc.ctl completion)
COMP_WORDS=("${@:2}")
COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
_linuxcnc_ctl
printf '%s\\n' "${COMPREPLY[@]}"
"""


def offered(folder, *words):
    result = subprocess.run(
        [str(BASH), "-c", PRESS_TAB, "bash", sys.executable, "linuxcnc-ctl", *words],
        cwd=folder,
        env={"PYTHONPATH": str(ROOT), "PATH": "/usr/bin:/bin"},
        check=True,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert result.stderr == ""
    return result.stdout.split()


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["o"], ["on", "off", "override"]),
        (["--n"], ["--namespace"]),
        (["--namespace", "mill", "wat"], ["watch"]),
        (["status", "--"], ["--help", "--json", "--watch"]),
        (["jog", "x", "1", "--sp"], ["--speed"]),
        (["run", "pa"], ["part.ngc"]),
        (["mdi", "pa"], []),
    ],
)
def test_tab_offers_what_the_command_knows(tmp_path, words, expected):
    (tmp_path / "part.ngc").touch()
    assert offered(tmp_path, *words) == expected
