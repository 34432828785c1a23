"""Motion's HAL pins after each step of a session are those of LinuxCNC: on, homed, jogged, fed, probed, stopped.

The same script is the display of the same machine here and there (see ``stock_machine``); after each step, at rest,
all pins of motion, two joints, an axis and a spindle are read with halcmd.
"""

from __future__ import annotations

import os
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from tests.support import stock_machine
from tests.support.compared import each_time
from tests.support.stock_machine import needs_stock_machine

pytestmark = [pytest.mark.peer, pytest.mark.process, needs_stock_machine]

PRELUDE = r'''
s, c, e = linuxcnc.stat(), linuxcnc.command(), linuxcnc.error_channel()
SHOWN = ("motion.", "joint.0.", "joint.1.", "axis.x.", "spindle.0.")

def snap(name):
    still = 0
    before = None
    while still < 5:
        time.sleep(0.05)
        s.poll()
        now = (s.joint_position, s.inpos, s.exec_state, s.spindle[0]["speed"])
        still = still + 1 if now == before else 0
        before = now
    read(name, SHOWN)

def read(name, shown):
    rows = subprocess.run(["halcmd", "-s", "show", "pin"], capture_output=True, text=True).stdout.split("\n")
    words = [row.split() for row in rows]
    texts = []
    while (message := e.poll()):
        texts.append(message[1].strip())
    out.append([name, {w[4]: w[3] for w in words if len(w) > 4 and w[4].startswith(shown)}, texts])

def do(call, *args):
    call(*args)
    c.wait_complete(10)

def until(condition, seconds=20):
    end = time.time() + seconds
    while not condition() and time.time() < end:
        s.poll()
        time.sleep(0.01)

def setp(name, value):
    subprocess.run(["halcmd", "setp", name, str(value)])

def mdi(name, *lines):
    for line in lines:
        do(c.mdi, line)
    snap(name)

time.sleep(1.0)
'''
SESSION = r'''
do(c.state, linuxcnc.STATE_ESTOP_RESET)
snap("out of E-stop")
do(c.state, linuxcnc.STATE_ON)
snap("on")
c.jog(linuxcnc.JOG_INCREMENT, True, 0, 20, 5)
until(lambda: s.joint[0]["output"] > 4.9)
snap("jogged a joint")
do(c.home, 0)
until(lambda: s.homed[0])
do(c.teleop_enable, 0)
do(c.home, -1)
until(lambda: all(s.homed[:3]))
snap("homed")
do(c.teleop_enable, 1)
c.jog(linuxcnc.JOG_INCREMENT, False, 0, 20, 3)
until(lambda: s.position[0] > 2.9)
snap("jogged an axis")
c.jog(linuxcnc.JOG_CONTINUOUS, False, 0, 50)
until(lambda: s.position[0] > 29.9)
snap("jogged to the limit")
c.jog(linuxcnc.JOG_INCREMENT, False, 0, -50, 30)
until(lambda: s.position[0] < 0.1)
snap("jogged back")
do(c.teleop_enable, 0)
snap("joint mode")
do(c.mode, linuxcnc.MODE_MDI)
snap("MDI")
mdi("fed", "G21 G90 G1 X10 F600")
do(c.mdi, "G20")
c.mdi("G1 X0.7 F4")
until(lambda: s.current_vel > 1.6)
read("feeding in inches", ("motion.feed-", "motion.requested-vel", "motion.motion-type"))
c.wait_complete(20)
mdi("back", "G21 G1 X10 F600")
mdi("an arc", "G2 X10 Y0 I5 F1200")
mdi("spindle on", "M3 S1000")
mdi("outputs wait", "M62 P1", "M67 E1 Q2.5")
mdi("outputs with a move", "G1 X5 F600")
mdi("outputs at once", "M63 P1", "M65 P1", "M64 P2", "M68 E2 Q-1")
c.spindleoverride(0.5)
c.wait_complete(5)
snap("override")
mdi("spindle off", "M5")
c.mdi("M19 R90")
time.sleep(0.3)
snap("orienting")
setp("spindle.0.is-oriented", 1)
c.wait_complete(5)
snap("oriented")
setp("spindle.0.is-oriented", 0)
mdi("on after M19", "M4 S500")
setp("spindle.0.inhibit", 1)
snap("inhibited")
setp("spindle.0.inhibit", 0)
mdi("probed nothing", "G38.3 X15 F600")
mdi("probe fails", "G38.2 X20 F600")
do(c.mode, linuxcnc.MODE_MANUAL)
setp("motion.enable", 0)
snap("enable taken away")
setp("motion.enable", 1)
do(c.state, linuxcnc.STATE_ON)
snap("on again")
setp("joint.1.amp-fault-in", 1)
snap("amplifier fault")
'''
LIMITS = r'''
def flags(name):
    s.poll()
    joint = {key: s.joint[0][key] for key in ("min_hard_limit", "max_hard_limit", "enabled", "override_limits")}
    texts = []
    while (message := e.poll()):
        texts.append(message[1].strip())
    still = s.joint[0]["velocity"] == 0.0
    out.append([name, still, s.joint[0]["inpos"], s.limit[:3], s.enabled, s.task_state, joint, texts])

do(c.state, linuxcnc.STATE_ESTOP_RESET)
do(c.state, linuxcnc.STATE_ON)
do(c.mode, linuxcnc.MODE_MANUAL)
for joint in range(3):
    c.home(joint)
until(lambda: all(s.homed[:3]))
do(c.teleop_enable, 0)
c.jog(linuxcnc.JOG_CONTINUOUS, True, 0, -10)
until(lambda: s.position[0] < -2)
flags("jogging")
setp("joint.0.neg-lim-sw-in", 1)
until(lambda: not s.enabled)
time.sleep(0.5)
flags("at the switch")
c.override_limits()
time.sleep(0.5)
flags("overridden")
do(c.state, linuxcnc.STATE_ON)
time.sleep(0.3)
flags("on")
c.jog(linuxcnc.JOG_INCREMENT, True, 0, -10, 3)
time.sleep(0.5)
flags("jog further")
c.jog(linuxcnc.JOG_CONTINUOUS, True, 0, 10)
until(lambda: s.position[0] > -1)
setp("joint.0.neg-lim-sw-in", 0)
time.sleep(0.2)
flags("off the switch")
c.jog(linuxcnc.JOG_STOP, True, 0)
until(lambda: s.joint[0]["velocity"] == 0.0)
time.sleep(0.3)
flags("stopped")
'''
SHORT = {"MAX_LIMIT = 200": "MAX_LIMIT = 30"}  # so that the limit is near
# what differs, and why
OF_OTHER_CODE = ("time", "last-period", "free-pos-cmd", "free-vel-lim", "teleop-vel-lim")  # the planners' own insides
UNTIL_ABORT = ("joint.1.error",)  # LinuxCNC's task aborts after a fault, which clears it
ROUNDING = 1e-6


def same(ours: str, theirs: str) -> bool:
    try:
        return abs(float(ours) - float(theirs)) <= ROUNDING
    except ValueError:
        return ours == theirs


@pytest.fixture(autouse=True)
def our_halcmd(monkeypatch: pytest.MonkeyPatch) -> None:
    """The scripts find our halcmd on our machine."""
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}:{os.environ['PATH']}")


def run_on_both(tmp_path: Path, script: str, changes: dict[str, str] | None = None) -> tuple[list[Any], list[Any]]:
    """What the script found on our machine and on LinuxCNC's, which run side by side."""
    with ThreadPoolExecutor() as pool:
        theirs = pool.submit(stock_machine.display, script, changes=changes)
        return stock_machine.ours(tmp_path, script, changes=changes), theirs.result()


@each_time
def test_a_limit_switch_stops_the_machine_and_can_be_left_as_with_linuxcnc(tmp_path: Path) -> None:
    ours, theirs = run_on_both(tmp_path, PRELUDE + LIMITS)
    for row, stock_row in zip(ours, theirs, strict=True):
        assert row == stock_row


@each_time
def test_pins_and_texts_are_those_of_linuxcnc_after_every_step(tmp_path: Path) -> None:
    ours, theirs = run_on_both(tmp_path, PRELUDE + SESSION, changes=SHORT)
    assert [row[0] for row in ours] == [row[0] for row in theirs]
    found = []
    for (name, pins, texts), (_, stock_pins, stock_texts) in zip(ours, theirs, strict=True):
        assert texts == stock_texts, name
        for pin, value in stock_pins.items():
            if not pin.endswith(OF_OTHER_CODE + UNTIL_ABORT) and not same(pins[pin], value):
                found.append(f"{name}: {pin} is {pins[pin]}, LinuxCNC's {value}")
    assert not found, "\n".join(found)
