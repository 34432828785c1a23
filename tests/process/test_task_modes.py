"""Modes of task beside those of motion: what homing, a pause before the start, and switching off leave."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import linuxcnc
from tests.support.desk import DONE, Desk, at_desk
from tests.support.machine import PATIENCE

pytestmark = pytest.mark.process

FREE, COORD, TELEOP = linuxcnc.TRAJ_MODE_FREE, linuxcnc.TRAJ_MODE_COORD, linuxcnc.TRAJ_MODE_TELEOP


@pytest.fixture
def desk(tmp_path: Path) -> Iterator[Desk]:
    with at_desk(tmp_path) as desk:
        yield desk


def switch_on(desk: Desk) -> None:
    assert desk.do(desk.command.state, linuxcnc.STATE_ESTOP_RESET) == DONE
    assert desk.do(desk.command.state, linuxcnc.STATE_ON) == DONE


def test_when_the_last_joint_is_homed_jogs_move_axes(desk):
    switch_on(desk)
    assert desk.stat.motion_mode == FREE
    for joint in range(3):
        assert desk.do(desk.command.home, joint) == DONE
        assert desk.stat.motion_mode == (TELEOP if joint == 2 else FREE)
    assert desk.texts == []


def test_homing_all_ends_in_teleop_mode_without_a_text(desk):
    switch_on(desk)
    assert desk.do(desk.command.home, -1) == DONE
    assert (desk.stat.motion_mode, desk.texts) == (TELEOP, [])


def test_the_mode_survives_that_the_machine_is_off(desk):
    desk.ready(linuxcnc.MODE_MDI)
    assert desk.do(desk.command.state, linuxcnc.STATE_ESTOP) == DONE
    assert desk.stat.task_mode == linuxcnc.MODE_MDI
    switch_on(desk)
    assert (desk.stat.task_mode, desk.stat.motion_mode) == (linuxcnc.MODE_MDI, COORD)
    assert desk.mdi("G53 G0 X1") == DONE


def test_a_loaded_program_can_be_held_before_it_begins_and_an_abort_lets_go(desk):
    desk.ready(linuxcnc.MODE_AUTO)
    desk.program("G0 X1\nM2\n")
    desk.command.auto(linuxcnc.AUTO_PAUSE)
    desk.until(lambda s: (s.interp_state, s.task_paused) == (linuxcnc.INTERP_PAUSED, 1), "held")
    assert desk.do(desk.command.abort) == DONE
    assert desk.stat.interp_state == linuxcnc.INTERP_IDLE
    desk.run()
    desk.until(lambda s: s.position[0] == pytest.approx(1.0), "the program's end")


def test_teleop_is_manual_mode(desk):
    desk.ready(linuxcnc.MODE_MDI)
    assert desk.do(desk.command.teleop_enable, 0) == DONE
    assert (desk.stat.task_mode, desk.stat.motion_mode) == (linuxcnc.MODE_MANUAL, FREE)


def test_an_idle_machine_is_never_seen_busy(desk):
    desk.ready(linuxcnc.MODE_MANUAL)
    assert {desk.look().state for _ in range(30) if desk.stat.wait(1.0)} == {linuxcnc.RCS_DONE}


def test_a_line_that_is_wrong_at_once_changes_nothing_but_drops_those_behind_it(desk):
    desk.ready(linuxcnc.MODE_MDI)
    for line in ("M8", "M3 S100", "G43 H1", "G55"):
        assert desk.mdi(line) == DONE
    before = (desk.stat.flood, desk.stat.spindle[0]["speed"], desk.stat.gcodes[3:], desk.stat.mcodes[2:])
    desk.command.mdi("G4 P15")  # long enough for the two behind it to arrive
    desk.command.mdi("bad")
    desk.command.mdi("G53 G0 X50")
    desk.until(lambda s: desk.texts and s.queued_mdi_commands == 0 and s.interp_state == 1, "the refusal")
    assert desk.command.wait_complete(PATIENCE) == linuxcnc.RCS_ERROR
    status = desk.look()
    assert (status.flood, status.spindle[0]["speed"], status.gcodes[3:], status.mcodes[2:]) == before
    assert status.position[0] == 0.0
    assert desk.mdi("G53 G0 X1") == DONE


def test_the_brake_holds_a_spindle_that_nobody_has_started(desk):
    desk.until(lambda s: s.spindle[0]["brake"] == 1, "the brake")
    desk.ready(linuxcnc.MODE_MANUAL)
    desk.command.spindle(linuxcnc.SPINDLE_FORWARD, 500)
    desk.until(lambda s: s.spindle[0]["brake"] == 0, "the brake let go")
