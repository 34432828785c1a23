"""Each order in each state of the machine, on Debian's LinuxCNC and on ours: the same result, and the same comes of it.

The script is the display of the same mill here and there, as in ``test_same_script``. It brings the machine into a
state and gives one order after the other; when one has led out of the state, it goes back before the next.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

import linuxcnc
from tests.support.compared import on_both
from tests.support.stock_machine import needs_stock_machine

pytestmark = [pytest.mark.peer, pytest.mark.process, needs_stock_machine]

SCRIPT = r'''
L = linuxcnc
s, c, e = L.stat(), L.command(), L.error_channel()
PROGRAM = os.path.abspath("p.ngc")
open(PROGRAM, "w").write("G21 G90 G54 F300\nG1 X0\nM2\n")
LONG = os.path.abspath("long.ngc")
open(LONG, "w").write("G21 G90 G54 G64 F60\no1 while [1]\nG1 X10\nG1 X-10\no1 endwhile\nM2\n")
POWER = {"estop": L.STATE_ESTOP, "off": L.STATE_ESTOP_RESET}
OF_A_PROGRAM = ("running", "paused")

def texts():
    found = []
    while (message := e.poll()):
        found.append(list(message))
    return found

def look():
    s.poll()
    return {"task_state": s.task_state, "task_mode": s.task_mode, "motion_mode": s.motion_mode,
            "homed": list(s.homed[:3]), "optional_stop": s.optional_stop, "block_delete": s.block_delete,
            "tool": s.tool_in_spindle, "flood": s.flood, "mist": s.mist, "direction": s.spindle[0]["direction"],
            "brake": s.spindle[0]["brake"], "program": program()}

def program():
    return {L.INTERP_IDLE: "idle", L.INTERP_PAUSED: "paused"}.get(s.interp_state, "running")

def until(condition, seconds=20):
    end = time.time() + seconds
    while time.time() < end:
        s.poll()
        if condition():
            return True
        time.sleep(0.01)
    return False

def give(name, *args):
    getattr(c, name)(*args)
    return c.wait_complete(10)

def go_to(state):
    give("abort")
    until(lambda: s.interp_state == L.INTERP_IDLE)
    power = POWER.get(state, L.STATE_ON)
    if s.task_state != power:
        give("state", L.STATE_ESTOP)
        until(lambda: s.task_state == L.STATE_ESTOP)
    give("mode", L.MODE_MANUAL)
    until(lambda: s.task_mode == L.MODE_MANUAL)
    if state == "estop":
        return
    if s.task_state == L.STATE_ESTOP:
        give("state", L.STATE_ESTOP_RESET)
        until(lambda: s.task_state == L.STATE_ESTOP_RESET)
    if state == "off":
        return
    if s.task_state != L.STATE_ON:
        give("state", L.STATE_ON)
        until(lambda: s.task_state == L.STATE_ON)
    if (state == "unhomed" and any(s.homed[:3])) or (state != "unhomed" and not all(s.homed[:3])):
        give("teleop_enable", 0)
        until(lambda: s.motion_mode == L.TRAJ_MODE_FREE)
        give("unhome", -1)
        until(lambda: not any(s.homed[:3]))
    if state == "unhomed":
        give("teleop_enable", 0)
        until(lambda: s.motion_mode == L.TRAJ_MODE_FREE)
        return
    if not all(s.homed[:3]):
        for joint in range(3):
            give("home", joint)
            until(lambda: s.homed[joint])
        until(lambda: s.motion_mode == L.TRAJ_MODE_TELEOP)
    if state == "mdi":
        give("mode", L.MODE_MDI)
        until(lambda: s.task_mode == L.MODE_MDI)
        return
    if state in OF_A_PROGRAM:
        give("mode", L.MODE_AUTO)
        until(lambda: s.task_mode == L.MODE_AUTO)
        give("program_open", LONG)
        c.auto(L.AUTO_RUN, 0)
        until(lambda: program() == "running" and s.current_vel > 0.5)
        if state == "paused":
            c.auto(L.AUTO_PAUSE)
            until(lambda: program() == "paused" and s.current_vel == 0.0)
        return
    give("teleop_enable", int(state == "teleop"))
    until(lambda: s.motion_mode == (L.TRAJ_MODE_TELEOP if state == "teleop" else L.TRAJ_MODE_FREE))

def settled():
    """What is shown, in two looks one after the other, where the machine stands or a program goes on or waits."""
    before = None
    for _ in range(200):
        now = look(), s.inpos, s.exec_state
        over = s.inpos if program() == "idle" else s.echo_serial_number == c.serial
        if before and now[0] == before[0] and over and (now == before or program() != "idle"):
            return now[0]
        before = now
        time.sleep(0.05)
    return before[0]

def carry_out(order, state):
    """Its result; of one in the midst of a program only whether it failed, for the program has its own end."""
    if state not in OF_A_PROGRAM:
        return give(*order)
    getattr(c, order[0])(*order[1:])
    until(lambda: s.echo_serial_number == c.serial)
    settled()
    return L.RCS_ERROR if s.state == L.RCS_ERROR else None

ORDERS = [
    ("state", L.STATE_ESTOP), ("state", L.STATE_ESTOP_RESET), ("state", L.STATE_OFF), ("state", L.STATE_ON),
    ("mode", L.MODE_MANUAL), ("mode", L.MODE_MDI), ("mode", L.MODE_AUTO), ("mdi", "G0 X1"),
    ("home", 0), ("home", 7), ("unhome", 0), ("unhome", 7), ("teleop_enable", 0), ("teleop_enable", 1),
    ("traj_mode", L.TRAJ_MODE_COORD), ("jog", L.JOG_INCREMENT, True, 0, 20.0, 0.01),
    ("jog", L.JOG_INCREMENT, False, 0, 20.0, 0.01), ("jog", L.JOG_INCREMENT, True, 7, 1.0, 0.01),
    ("spindle", L.SPINDLE_FORWARD, 100.0), ("spindle", L.SPINDLE_INCREASE), ("spindle", L.SPINDLE_FORWARD, 100.0, 3),
    ("brake", 0), ("brake", 1), ("flood", 1), ("mist", 1), ("feedrate", 0.5), ("feedrate", 1.0),
    ("set_optional_stop", 1), ("set_optional_stop", 0), ("set_block_delete", 1), ("set_block_delete", 0),
    ("set_digital_output", 1, 1), ("set_digital_output", 99, 1), ("set_analog_output", 99, 1.0),
    ("set_min_limit", 0, -100.0), ("set_max_limit", 0, 100.0), ("override_limits",),
    ("tool_offset", 1, 1.5, 0.0, 3.0, 0.0, 0.0, 0), ("tool_offset", 77, 1.5, 0.0, 3.0, 0.0, 0.0, 0),
    ("load_tool_table",), ("task_plan_synch",), ("program_open", PROGRAM), ("program_open", "/nonexistent.ngc"),
    ("auto", L.AUTO_STEP), ("auto", L.AUTO_RUN, 0), ("abort",), ("reset_interpreter",),
]
TO_A_PROGRAM = [("auto", L.AUTO_PAUSE), ("auto", L.AUTO_RESUME)]
STATE = ("task_state", "task_mode", "motion_mode", "homed", "program")
until(lambda: s.axis_mask)
for state in ("estop", "unhomed", "joint", "mdi", "running", "paused"):
    go_to(state)
    there = settled()
    for order in ORDERS + (TO_A_PROGRAM if state in OF_A_PROGRAM else []):
        if any(look()[name] != there[name] for name in STATE):
            go_to(state)
            settled()
        texts()
        result = carry_out(order, state)
        shown = settled()
        out.append([[state, *order], result, texts(), shown])
'''

Step = list[Any]  # state and order, result, texts, what is shown

OF_A_PROGRAM = ("running", "paused")
AUTO_STEP = linuxcnc.AUTO_STEP


def refused_here_only(state: str, name: str, *arguments: Any) -> bool:
    """Ours says that a program which is not over keeps its mode, and is not stepped while it runs.

    LinuxCNC drops such an order without a word; auto mode anew ends its program.
    """
    stepped = (state, name, *arguments) == ("running", "auto", AUTO_STEP)
    return stepped or (state in OF_A_PROGRAM and name == "mode")


# Ours says these in words of its own, with the numbers
OWN_WORDS = {"program_open", "set_digital_output", "set_analog_output", "spindle", "jog", "home", "unhome"}


def differences(steps: list[tuple[Step, Step]]) -> object:
    return [*unlike_results(steps), *unlike_effects(steps)]


@pytest.fixture(scope="module")
def steps(tmp_path_factory: pytest.TempPathFactory) -> list[tuple[Step, Step]]:
    """Each order on Debian's machine and on ours."""
    return on_both(tmp_path_factory.mktemp("ours"), SCRIPT, differences)


def unlike_results(steps: list[tuple[Step, Step]]) -> Iterator[tuple[Any, ...]]:
    """Orders whose result differs."""
    return (
        (theirs[0], theirs[1], ours[1])
        for theirs, ours in steps
        if theirs[1] != ours[1] and not refused_here_only(*theirs[0])
    )


def unlike_effects(steps: list[tuple[Step, Step]]) -> Iterator[tuple[Any, ...]]:
    """Orders after which something else is shown."""
    for theirs, ours in steps:
        differing = {name: (value, ours[3][name]) for name, value in theirs[3].items() if ours[3][name] != value}
        if differing and not refused_here_only(*theirs[0]):
            yield theirs[0], differing


def test_every_order_has_the_same_result_in_every_state(steps: list[tuple[Step, Step]]) -> None:
    assert list(unlike_results(steps)) == []


def test_every_order_has_the_same_effect_in_every_state(steps: list[tuple[Step, Step]]) -> None:
    assert list(unlike_effects(steps)) == []


def test_what_is_told_there_is_told_here(steps: list[tuple[Step, Step]]) -> None:
    """Ours says why also where LinuxCNC is silent."""
    for theirs, ours in steps:
        assert len(ours[2]) >= min(len(theirs[2]), 1), (theirs, ours)
        if theirs[2] and theirs[0][1] not in OWN_WORDS:
            assert ours[2] == theirs[2]


def test_an_order_that_is_refused_says_why(steps: list[tuple[Step, Step]]) -> None:
    assert [ours for _, ours in steps if ours[1] == linuxcnc.RCS_ERROR and not ours[2]] == []
