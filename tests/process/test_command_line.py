"""linuxcnc-ctl on a whole machine: what it prints, what it does, and its exit codes."""

import json
import subprocess
import sys

import pytest

import linuxcnc
from tests.support.machine import ROOT, copy_mill, running

pytestmark = pytest.mark.process


def ctl(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "linuxcnc.ctl", *words],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


def test_without_a_machine_the_exit_code_says_so():
    answer = ctl("status")
    assert answer.returncode == 3
    assert len(answer.stderr.splitlines()) == 1


def test_a_wrong_command_line_is_refused():
    assert ctl("dance").returncode == 2


def test_a_day_at_the_machine(tmp_path):
    part = tmp_path / "part.ngc"
    part.write_text("G21 G90 G94\nT2 M6\nG1 X4 F3000\nM2\n")
    with running(copy_mill(tmp_path), speed=10.0) as run:
        run.port()
        assert ctl("mdi", "G0", "X1").returncode == 1
        assert ctl("on").returncode == 0
        assert ctl("home", "--all").returncode == 0
        assert ctl("mdi", "G21 G90 G0 X2 Y3").returncode == 0
        status = json.loads(ctl("status", "--json").stdout)
        assert (status["state"], status["homed"], status["position"]) == (
            "on",
            [True, True, True],
            {"X": 2.0, "Y": 3.0, "Z": 0.0},
        )
        assert ctl("jog", "x", "-1.5", "--speed", "600").returncode == 0
        assert ctl("override", "80").returncode == 0
        done = ctl("run", str(part))
        assert done.returncode == 0, done.stderr
        assert "distance:" in done.stdout
        state = linuxcnc.stat()
        assert state.position[0] == pytest.approx(4.0)
        assert state.feedrate == pytest.approx(0.8)
        assert state.tool_in_spindle == 2
        tools = ctl("tools").stdout.splitlines()
        assert len(tools) == 6
        assert tools[1].startswith("*T2 ")
        refused = ctl("mdi", "G0", "XQ")
        assert refused.returncode == 1
        assert len(refused.stderr.splitlines()) == 1
        assert ctl("jog", "q", "1").returncode == 1
        assert ctl("estop").returncode == 0
        assert "estop" in ctl("status").stdout


def test_completion_names_every_order():
    script = ctl("completion").stdout
    orders = ("status", "home", "mdi", "run", "jog", "override", "abort", "tools", "errors")
    assert all(word in script for word in orders)
