"""One script, written for LinuxCNC's Python module, on Debian's LinuxCNC and on ours: the same answers and attributes.

The script is the display of a mill with the same INI file here and there, so everything is local: nothing is lost on
a wire. Results of commands, texts for the operator and every attribute of the status are compared after each step.
"""

from __future__ import annotations

import math
from typing import Any

import pytest

import linuxcnc
from tests.support.compared import on_both
from tests.support.stock_machine import needs_stock_machine

pytestmark = [pytest.mark.peer, pytest.mark.process, needs_stock_machine]

SCRIPT = r'''
s, c, e = linuxcnc.stat(), linuxcnc.command(), linuxcnc.error_channel()

def attributes():
    names = [n for n in dir(s) if not n.startswith("_") and not callable(getattr(s, n))]
    return {n: getattr(s, n) for n in names}

def settle():
    end = time.time() + 20
    before = None
    while time.time() < end:
        s.poll()
        now = (s.task_mode, s.motion_mode, s.interp_state, s.inpos, s.joint_position, s.homed, s.exec_state)
        if now == before and s.inpos and s.exec_state == linuxcnc.EXEC_DONE:
            return
        before = now
        time.sleep(0.06)

def do(name, *args):
    getattr(c, name)(*args)
    result = c.wait_complete(20)
    settle()
    texts = []
    while (message := e.poll()):
        texts.append(list(message))
    out.append([name, list(args), result, texts, attributes()])

open("part.ngc", "w").write("G21 G90 F3000\nG0 X0 Y0\nG1 X5\nG2 X10 Y5 I0 J5\nM2\n")
s.poll()
settle()
do("mdi", "G0 X1")
do("state", linuxcnc.STATE_ON)
do("state", linuxcnc.STATE_ESTOP_RESET)
do("state", linuxcnc.STATE_ON)
do("mdi", "G0 X1")
do("mode", linuxcnc.MODE_MDI)
do("mdi", "G0 X1")
do("mode", linuxcnc.MODE_MANUAL)
for joint in range(3):
    do("home", joint)
do("teleop_enable", 0)
do("jog", linuxcnc.JOG_INCREMENT, True, 0, 20.0, 2.5)
do("jog", linuxcnc.JOG_STOP, True, 0)
do("teleop_enable", 1)
do("jog", linuxcnc.JOG_INCREMENT, False, 1, 20.0, -1.5)
do("mode", linuxcnc.MODE_MDI)
do("jog", linuxcnc.JOG_CONTINUOUS, True, 0, 1.0)
do("mdi", "G1 bad")
do("mdi", "G21 G90 G0 X10 Y5 Z-3")
do("mdi", "G10 L2 P2 X1 Y2 Z3 R10")
do("mdi", "G55")
do("mdi", "G92 X0")
do("mdi", "G1 X2 F1200")
do("mdi", "S500 M3")
do("mdi", "M5")
do("mdi", "M8")
do("mdi", "T1 M6 G43")
do("mdi", "G54 G49 G92.1 G64 P0.01 Q0.005")
do("feedrate", 0.8)
do("rapidrate", 0.5)
do("spindleoverride", 0.9)
do("set_feed_override", 0)
do("set_optional_stop", 1)
do("set_block_delete", 1)
do("set_digital_output", 2, 1)
do("set_analog_output", 1, 2.5)
do("override_limits")
do("mode", linuxcnc.MODE_AUTO)
do("program_open", os.path.abspath("part.ngc"))
do("auto", linuxcnc.AUTO_RUN, 0)
do("mode", linuxcnc.MODE_MANUAL)
do("spindle", linuxcnc.SPINDLE_FORWARD, 100.0)
do("brake", linuxcnc.BRAKE_ENGAGE)
do("flood", linuxcnc.FLOOD_OFF)
do("unhome", 1)
do("teleop_enable", 0)
do("unhome", 1)
do("state", linuxcnc.STATE_OFF)
do("state", linuxcnc.STATE_ESTOP)
out.append(sorted(set(linuxcnc.ini("machine.ini").findall("JOINT_0", "TYPE"))))
'''


Step = list[Any]  # command, arguments, result, texts, attributes

# Where the two machines lie, and how often a script asked: program_open is two commands in LinuxCNC
PLACES = {"ini_filename", "file", "echo_serial_number"}

# Orders that cannot be carried out now: LinuxCNC passes over them in silence, ours says why
TOLD_BY_OURS = [["state", [4]], ["jog", [1, True, 0, 1.0]], ["unhome", [1]]]

# LinuxCNC's insides: the last return code of its interpreter, and the tolerance of G64 before a program gave one
NOT_COMPARED = {"interpreter_errcode", "settings"}
# What a brake is before the machine was on for the first time
UNTIL_ON = {"spindle"}
# Places in lists of codes: group 0, of which LinuxCNC shows G10 only; M2, which it shows for a moment; M48 to M51, ours
# as the overrides really are
PASSED_OVER = {"gcodes": {2}, "mcodes": {1, 6}}


def differences(steps: list[tuple[Step, Step]]) -> object:
    return unlike_results(steps) or unlike_attributes(steps)


@pytest.fixture(scope="module")
def steps(tmp_path_factory: pytest.TempPathFactory) -> list[tuple[Step, Step]]:
    """Each step on Debian's machine and on ours."""
    return on_both(tmp_path_factory.mktemp("ours"), SCRIPT, differences)


def test_every_command_has_the_same_result_and_tells_the_operator_the_same(steps: list[tuple[Step, Step]]) -> None:
    assert unlike_results(steps) == []


def unlike_results(steps: list[tuple[Step, Step]]) -> list[tuple[Any, ...]]:
    """Commands whose result or texts are not the stock machine's, nor told where ours is to tell."""
    differing = [(theirs[:2], theirs[2:4], ours[2:4]) for theirs, ours in steps[:-1] if theirs[2:4] != ours[2:4]]
    return [
        step for step in differing
        if step[0] not in TOLD_BY_OURS or step[2][0] != step[1][0] or not step[2][1]
    ]  # fmt: skip


def test_every_attribute_is_the_same_after_every_command(steps: list[tuple[Step, Step]]) -> None:
    assert unlike_attributes(steps) == {}


def unlike_attributes(steps: list[tuple[Step, Step]]) -> dict[str, tuple[Any, ...]]:
    """Attributes that differ, with the first command after which they do and both values."""
    differing: dict[str, tuple[Any, ...]] = {}
    was_on = False
    for theirs, ours in steps[:-1]:
        was_on = was_on or theirs[4]["task_state"] == linuxcnc.STATE_ON
        ignored = PLACES | NOT_COMPARED | (set() if was_on else UNTIL_ON)
        for name in theirs[4].keys() - ignored:
            stock, own = (of_machine(name, step[4]) for step in (theirs, ours))
            if not same(stock, own):
                differing.setdefault(name, (theirs[:2], stock, own))
    return differing


def test_the_ini_file_gives_the_same_values(steps: list[tuple[Step, Step]]) -> None:
    assert steps[-1][0] == steps[-1][1] == ["LINEAR"]


def of_machine(name: str, attributes: dict[str, Any]) -> Any:
    """A value without what no joint or spindle of the machine stands behind, and what is passed over."""
    value = attributes[name]
    if count := {"joint": "joints", "spindle": "spindles"}.get(name):
        return value[: attributes[count]]
    passed_over = PASSED_OVER.get(name, set())
    return [one for place, one in enumerate(value) if place not in passed_over] if passed_over else value


def same(stock: Any, ours: Any) -> bool:
    """Equal, numbers within what a float shows; our dictionaries may have more."""
    if isinstance(stock, dict):
        return all(same(value, ours[key]) for key, value in stock.items())
    if isinstance(stock, list):
        return len(stock) == len(ours) and all(map(same, stock, ours))
    if isinstance(stock, float) or isinstance(ours, float):
        return math.isclose(stock, ours, rel_tol=1e-6, abs_tol=1e-6)
    return bool(stock == ours)
