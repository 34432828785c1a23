"""The whole machine, driven from elsewhere: by Debian's unchanged Python module, its linuxcncrsh and its scheduler.

They reach it through NML over TCP only, as programs on another computer do.
"""

from __future__ import annotations

import socket
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.support.machine import PATIENCE, Run, copy_mill, wait_until
from tests.support.nml_server import free_port, nml_text
from tests.support.stock import DRIVE, StockClient, needs_module

pytestmark = [pytest.mark.peer, pytest.mark.process, needs_module]

PROGRAM = """\
G21 G90 G64 P0.01 F200
G0 X0 Y0 Z0
G1 X5 Y0
G2 X10 Y5 I0 J5
G1 X10 Y8
M2
"""

RSH_INI = """\
[EMC]
VERSION = 1.1
MACHINE = remote
NML_FILE = {nml}
[DISPLAY]
DISPLAY = linuxcncrsh
[TRAJ]
COORDINATES = XYZ
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
[KINS]
JOINTS = 3
KINEMATICS = trivkins
[EMCIO]
TOOL_TABLE = tool.tbl
"""


class Machine:
    """A simulated mill whose buffers are served on a port of their own."""

    def __init__(self, folder: Path) -> None:
        ini = copy_mill(folder)
        self.folder = folder
        self.file = folder / "local.nml"
        self.port = free_port()
        self.file.write_text(nml_text(f"TCP={self.port}"))
        self.run = Run(ini)
        self.run.port()
        wait_until(self._served, "NML server")
        self.stock = StockClient(folder, self.file)

    def _served(self) -> bool:
        with socket.socket() as sock:
            return sock.connect_ex(("127.0.0.1", self.port)) == 0


@pytest.fixture
def machine(tmp_path: Path) -> Iterator[Machine]:
    one = Machine(tmp_path)
    yield one
    assert one.run.stop() in (0, 143)



def test_the_stock_module_switches_on_homes_jogs_and_moves_by_mdi(machine: Machine) -> None:
    state, homed, jogged, stopped, mdi, position, failed, message = machine.stock.run(
        DRIVE
        + """
out.append([s.task_state, do("state", linuxcnc.STATE_ESTOP_RESET), s.task_state])
out[0] += [do("state", linuxcnc.STATE_ON), s.task_state]
do("home", -1); until(lambda: all(s.homed[:3])); out.append(s.homed[:4])
do("mode", linuxcnc.MODE_MANUAL); do("teleop_enable", 0)
c.jog(linuxcnc.JOG_CONTINUOUS, True, 0, 5.0); until(lambda: s.joint_position[0] > 0.5)
out.append(s.joint_position[0])
c.jog(linuxcnc.JOG_STOP, True, 0); until(lambda: s.inpos); at = s.joint_position[0]
time.sleep(0.2); s.poll(); out.append(s.joint_position[0] == at)
do("mode", linuxcnc.MODE_MDI)
out.append([do("mdi", "G21 G90 G0 X5 Y2 Z1"), s.task_mode]); out.append(s.position[:3])
out.append(do("mdi", "G1 X1"))
heard = []; until(lambda: heard.append(e.poll()) or heard[-1]); out.append(heard[-1])
"""
    )
    assert state == [1, 1, 2, 1, 4]
    assert homed == [1, 1, 1, 0]
    assert jogged > 0.5
    assert stopped
    assert mdi == [1, 3]
    assert position == pytest.approx([5.0, 2.0, 1.0])
    assert failed == 3
    assert message[0] == 11
    assert "feed" in message[1].lower()


def test_the_stock_module_runs_a_program_to_its_end(machine: Machine) -> None:
    program = machine.folder / "part.ngc"
    program.write_text(PROGRAM)
    opened, done, position, lines, error = machine.stock.run(
        DRIVE
        + f"""
ready(); do("mode", linuxcnc.MODE_AUTO)
out.append([do("program_open", {str(program)!r}), s.file])
lines = set()
c.auto(linuxcnc.AUTO_RUN, 0)
until(lambda: s.interp_state != linuxcnc.INTERP_IDLE)
until(lambda: lines.add(s.motion_line) or s.interp_state == linuxcnc.INTERP_IDLE)
out.append(c.wait_complete(60)); s.poll(); out.append(s.position[:3]); out.append(sorted(lines)); out.append(e.poll())
"""
    )
    assert opened == [1, str(program)]
    assert done == 1
    assert position == pytest.approx([10.0, 8.0, 0.0])
    assert {3, 4, 5} <= set(lines)
    assert error is None


def test_the_stock_module_pauses_resumes_and_aborts_a_program(machine: Machine) -> None:
    program = machine.folder / "long.ngc"
    program.write_text("G21 G90 F300\nG1 X200\nM2\n")
    paused, resumed, after = machine.stock.run(
        DRIVE
        + f"""
ready(); do("mode", linuxcnc.MODE_AUTO); do("program_open", {str(program)!r})
c.auto(linuxcnc.AUTO_RUN, 0); until(lambda: s.position[0] > 1)
c.auto(linuxcnc.AUTO_PAUSE); until(lambda: s.paused and s.current_vel == 0); at = s.position[0]
time.sleep(0.3); s.poll(); out.append(s.position[0] == at)
c.auto(linuxcnc.AUTO_RESUME); until(lambda: s.position[0] > at + 1); out.append(True)
c.abort(); until(lambda: s.interp_state == linuxcnc.INTERP_IDLE and s.inpos); out.append(s.position[0])
"""
    )
    assert paused
    assert resumed
    assert 2.0 < after < 150.0


class Telnet:
    """A line-by-line talk with one of LinuxCNC's text servers."""

    def __init__(self, port: int) -> None:
        deadline = time.monotonic() + PATIENCE
        while True:
            try:
                self._sock = socket.create_connection(("127.0.0.1", port), PATIENCE)
                break
            except OSError:
                assert time.monotonic() < deadline, "the program does not listen"
                time.sleep(0.05)
        self._sock.settimeout(PATIENCE)

    def say(self, line: str, expected: str = "", seconds: float = PATIENCE) -> str:
        """Send a line, again until the answer contains ``expected``; the answer."""
        deadline = time.monotonic() + seconds
        while True:
            self._sock.sendall(line.encode() + b"\r\n")
            time.sleep(0.1)
            answer = self._sock.recv(65536).decode()
            if expected in answer:
                return answer
            assert time.monotonic() < deadline, f"{line!r} answered {answer!r}, not {expected!r}"

    def close(self) -> None:
        self._sock.close()


def text_server(machine: Machine, program: str) -> tuple[subprocess.Popen[Any], Telnet]:
    """A stock text server as a remote client of the machine, and a talk with it."""
    ini = machine.folder / "remote.ini"
    ini.write_text(RSH_INI.format(nml=machine.stock.file))
    port = free_port()
    process = subprocess.Popen(
        [program, "--port", str(port), "--", "-ini", str(ini)],
        cwd=machine.folder,
        env=machine.stock.environment(),
        stdout=subprocess.DEVNULL,
    )
    try:
        talk = Telnet(port)
    except BaseException:
        process.kill()
        raise
    talk.say("hello EMC tester 1.0", "HELLO ACK")
    talk.say("set enable EMCTOO")
    return process, talk


@pytest.mark.skipif(not Path("/usr/bin/linuxcncrsh").exists(), reason="Debian's linuxcncrsh is not installed")
def test_the_stock_linuxcncrsh_drives_the_machine(machine: Machine) -> None:
    process, talk = text_server(machine, "/usr/bin/linuxcncrsh")
    talk.say("get estop", "ESTOP ON")
    talk.say("set estop off")
    talk.say("get estop", "ESTOP OFF")
    talk.say("set machine on")
    talk.say("get machine", "MACHINE ON")
    talk.say("set mode manual")
    for joint in range(3):
        talk.say(f"set home {joint}")
    talk.say("get joint_homed", "YES YES YES")
    talk.say("set mode mdi")
    talk.say("get mode", "MODE MDI")
    talk.say("set mdi g21 g90 g0 x3 y4 z1")
    talk.say("get abs_act_pos", "3.000000 4.000000 1.000000")
    talk.close()
    process.terminate()
    process.wait(PATIENCE)


@pytest.mark.skipif(not Path("/usr/bin/schedrmt").exists(), reason="Debian's schedrmt is not installed")
def test_the_stock_scheduler_connects(machine: Machine) -> None:
    process, talk = text_server(machine, "/usr/bin/schedrmt")
    assert "QMODE" in talk.say("get qmode", "QMODE")
    talk.close()
    process.terminate()
    process.wait(PATIENCE)
