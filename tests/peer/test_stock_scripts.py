"""Terminal programs of Debian's LinuxCNC that import its module, run unchanged on a machine of ours."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import linuxcnc
from tests.support.machine import ROOT, copy_mill, running, wait_until

PROGRAMS = Path("/usr/bin")

pytestmark = [
    pytest.mark.peer,
    pytest.mark.process,
    pytest.mark.skipif(not (PROGRAMS / "mdi").exists(), reason="Debian's linuxcnc-uspace is not installed"),
]


def start(program: str, *words: str) -> subprocess.Popen[str]:
    """The program with our modules; only its interpreter is another one."""
    return subprocess.Popen(
        [sys.executable, str(PROGRAMS / program), *words],
        env={**os.environ, "PYTHONPATH": str(ROOT), "PYTHONSAFEPATH": "1", "PYTHONUNBUFFERED": "1"},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def test_stock_programs_run_unchanged(tmp_path):
    ini = copy_mill(tmp_path)
    ini.write_text(ini.read_text().replace("[HAL]", "[HAL]\nHALUI = halui"))  # mqtt-publisher lives as long as halui
    with running(ini, speed=5.0) as run:
        run.port()
        status, command = linuxcnc.stat(), linuxcnc.command()
        command.state(linuxcnc.STATE_ESTOP_RESET)
        command.state(linuxcnc.STATE_ON)
        command.home(-1)
        assert command.result(120.0)

        assert start("mdi", "G0", "X2").communicate(timeout=120)[0] == ""
        wait_until(lambda: status.poll() or abs(status.position[0] - 2.0) < 1e-9, "X2")
        said, _ = start("mdi").communicate("'G0 Y3'\n''\n", timeout=120)
        assert said.startswith("MDI> MDI> (")
        wait_until(lambda: status.poll() or abs(status.position[1] - 3.0) < 1e-9, "Y3")

        publisher = start("mqtt-publisher", "--dryrun", "keys=iocontrol.0.tool-number")
        try:
            assert publisher.stdout is not None
            wait_until(lambda: "Not publishing" in publisher.stdout.readline(), "it has looked at the machine")
        finally:
            publisher.kill()
            publisher.communicate()
