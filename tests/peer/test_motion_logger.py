"""What motion-logger writes is what LinuxCNC's writes: task's orders for the same configuration and lines of G-code."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from tests.support import stock_machine
from tests.support.compared import each_time
from tests.support.stock_machine import needs_stock_machine

pytestmark = [pytest.mark.peer, pytest.mark.process, needs_stock_machine]

PROGRAM = (
    "G0 X1;G1 X2 Y3 F100;G2 X4 I1;G43.1 Z1;M3 S100;M5;M62 P1;G0 X0;M64 P1;M68 E1 Q2;G64 P0.1;G0 X1;"
    "G20 G1 X0.5 F10;G21 G3 X4.7 Y3 I-4 P2 F20;G61;G0 Z0"
)
SESSION = (
    f"PROGRAM = {PROGRAM!r}"
    + r"""
import pathlib
s, c, e = linuxcnc.stat(), linuxcnc.command(), linuxcnc.error_channel()

def do(call, *args):
    call(*args)
    assert c.wait_complete(60) == linuxcnc.RCS_DONE, (call, args, e.poll())

def until(condition):
    end = time.time() + 60
    while not condition():
        assert time.time() < end, "the machine does not come to it"
        s.poll()
        time.sleep(0.01)

def log():
    return pathlib.Path("out.motion-logger").read_text().splitlines()

until(lambda: s.poll() or s.task_state)
do(c.state, linuxcnc.STATE_ESTOP_RESET)
do(c.state, linuxcnc.STATE_ON)
c.home(-1)
until(lambda: all(s.homed[:3]))
do(c.mode, linuxcnc.MODE_MDI)
out.append(log())
for line in PROGRAM.split(";"):
    do(c.mdi, line)
out.append(log())
subprocess.run(["halcmd", "setp", "motion-logger.reopen-log", "1"])
until(lambda: subprocess.check_output(["halcmd", "getp", "motion-logger.reopen-log"]).strip() == b"FALSE")
do(c.mdi, "G0 X5")
out.append(log())
"""
)
CONFIGURATION = (
    "SET_NUM_",
    "SET_VEL",
    "SET_ACC",
    "SETUP_",
    "SET_MAX_",
    "SET_WORLD",
    "SET_JOINT_",
    "SET_AXIS_",
    "SET_SPINDLE_P",
)
WORK = ("SET_LINE", "SET_CIRCLE", "    ", "SET_DOUT", "SET_AOUT", "SPINDLE_ON")
# LinuxCNC's task sends the lower limit first, with an upper one of 0, and learns the speed of SET_VEL later
OTHERWISE = ("SET_JOINT_POSITION_LIMITS", "SET_AXIS_POSITION_LIMITS", "SET_VEL ")
# ids count differently, and the greatest speed on an arc is worked out here by the planner, there by task
OF_OTHER_CODE = re.compile(r"\bid=\d+, |, ini_maxvel=\S+ acc=\S+")

STANDING = "SPINDLE_ON speed=0"  # LinuxCNC's task repeats a speed that does not turn the spindle


def machine(program: str) -> dict[str, str]:
    wiring = "HALCMD = setp iocontrol.0.emc-enable-in 1"
    return {"HALFILE": f"HALCMD = loadusr -Wn motion-logger {program} out.motion-logger\n{wiring}\nUNUSED"}


def chosen(lines: list[str], beginnings: tuple[str, ...]) -> list[str]:
    return [OF_OTHER_CODE.sub("", line) for line in lines if line.startswith(beginnings) and STANDING not in line]


def of_both(lines: list[str]) -> list[str]:
    return [line for line in lines if not line.startswith(OTHERWISE)]


@each_time
def test_the_log_has_linuxcncs_lines_for_configuration_and_work(tmp_path: Path) -> None:
    theirs = stock_machine.display(SESSION, changes=machine("motion-logger"))
    ours = stock_machine.ours(tmp_path, SESSION, changes=machine(f"{sys.executable} -m emcmot.motionlogger"))
    configured, expected = chosen(ours[0], CONFIGURATION), chosen(theirs[0], CONFIGURATION)
    assert of_both(configured) == of_both(expected)
    assert {line for line in set(configured) - set(expected) if not line.startswith("SET_VEL ")} == set()
    assert chosen(ours[1], WORK) == chosen(theirs[1], WORK)
    assert chosen(ours[2], WORK) == chosen(theirs[2], WORK)
    assert len(chosen(ours[2], WORK)) == 1
