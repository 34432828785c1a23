"""G28.2 on a whole machine: what is homed, where the program goes on, and what a refusal or a failure leaves behind."""

from __future__ import annotations

from pathlib import Path

import pytest

import hal
import linuxcnc
from tests.support.desk import DONE, ERROR, Desk, at_desk

pytestmark = pytest.mark.process

FREE, COORD = linuxcnc.TRAJ_MODE_FREE, linuxcnc.TRAJ_MODE_COORD
UNHOMED_MAY_RUN = {"TRAJ.COORDINATES": "X Y Z\nNO_FORCE_HOMING = 1"}
NO_SWITCH = UNHOMED_MAY_RUN | {"JOINT_0.HOME_SEARCH_VEL": "1", "JOINT_0.HOME_LATCH_VEL": "1"}
INHIBIT = "net inhibit motion.digital-out-00 => motion.homing-inhibit\n"


def switched_on(desk: Desk, mode: int) -> None:
    """On in this mode, not homed."""
    assert desk.do(desk.command.state, linuxcnc.STATE_ESTOP_RESET) == DONE
    assert desk.do(desk.command.state, linuxcnc.STATE_ON) == DONE
    assert desk.do(desk.command.mode, mode) == DONE


def test_a_typed_line_homes_a_joint_or_all_and_what_follows_begins_where_the_machine_is_then(tmp_path: Path) -> None:
    with at_desk(tmp_path) as desk:
        desk.ready(linuxcnc.MODE_MDI)
        assert desk.mdi("G0 X5 Y7") == DONE
        assert desk.mdi("G28.2 P0") == DONE
        assert desk.stat.position[:2] == pytest.approx((0.0, 7.0))
        assert desk.mdi("G91 G0 X1") == DONE
        assert desk.stat.position[:2] == pytest.approx((1.0, 7.0))
        assert desk.mdi("G28.2 P-1") == DONE
        assert desk.mdi("G0 Y2") == DONE
        assert desk.stat.position[:2] == pytest.approx((0.0, 2.0))
        assert (desk.stat.task_mode, desk.stat.motion_mode) == (linuxcnc.MODE_MDI, COORD)
        assert desk.stat.homed[:3] == (1, 1, 1)
        assert desk.texts == []


def test_a_line_that_names_nothing_to_home_is_refused_and_moves_nothing(tmp_path: Path) -> None:
    with at_desk(tmp_path) as desk:
        desk.ready(linuxcnc.MODE_MDI)
        assert desk.mdi("G0 X5") == DONE
        for line in ("G28.2", "G28.2 P-2", "G28.2 P1.5", "G28.2 P3"):
            desk.texts.clear()
            assert desk.mdi(line) == ERROR
            assert len(desk.texts) == 1
            assert "P-1" in desk.texts[0]
            assert (desk.stat.homed[:3], desk.stat.motion_mode) == ((1, 1, 1), COORD)
            assert desk.stat.position[0] == pytest.approx(5.0)
        assert desk.mdi("G0 X6") == DONE
        assert desk.stat.position[0] == pytest.approx(6.0)


def test_a_program_homes_the_machine_when_the_moves_before_it_are_done(tmp_path: Path) -> None:
    with at_desk(tmp_path, changes=UNHOMED_MAY_RUN) as desk:
        switched_on(desk, linuxcnc.MODE_AUTO)
        desk.program("G21 G1 X20 F3000\nG28.2 P-1\nG91 G0 Y2\nM2\n")
        desk.run()
        desk.until(lambda s: s.homed[:3] == (1, 1, 1) and s.interp_state == linuxcnc.INTERP_IDLE, "the program's end")
        assert desk.stat.position[:2] == pytest.approx((0.0, 2.0))
        assert hal.get_value("joint.0.motor-pos-cmd") == pytest.approx(20.0), "homed before X20 was reached"
        assert desk.stat.task_mode == linuxcnc.MODE_AUTO
        assert desk.texts == []


def test_after_a_refusal_by_motion_the_next_line_moves_as_before(tmp_path: Path) -> None:
    with at_desk(tmp_path, hal=INHIBIT) as desk:
        desk.ready(linuxcnc.MODE_MDI)
        assert desk.mdi("M64 P0") == DONE
        assert desk.mdi("G28.2 P0") == ERROR
        assert desk.texts == ["Homing denied by motion.homing-inhibit joint=0"]
        assert (desk.stat.task_mode, desk.stat.motion_mode) == (linuxcnc.MODE_MDI, FREE)
        assert desk.mdi("G0 X3") == DONE
        assert desk.stat.position[0] == pytest.approx(3.0)
        assert desk.stat.motion_mode == COORD


def test_an_abort_ends_the_homing_and_the_machine_can_be_used(tmp_path: Path) -> None:
    with at_desk(tmp_path, changes=NO_SWITCH) as desk:
        switched_on(desk, linuxcnc.MODE_MDI)
        desk.command.mdi("G28.2 P0")
        desk.until(lambda s: s.joint[0]["homing"] and s.motion_mode == FREE, "the search for the switch")
        assert desk.do(desk.command.abort) == DONE
        desk.until(lambda s: not s.joint[0]["homing"] and s.interp_state == linuxcnc.INTERP_IDLE, "the abort")
        assert desk.stat.homed[0] == 0
        assert desk.mdi("G0 Y3") == DONE
        assert desk.stat.position[1] == pytest.approx(3.0)
        assert desk.texts == []
