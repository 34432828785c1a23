"""Limits that change while the machine runs (``ini.*`` HAL pins), and positions that survive its end."""

from __future__ import annotations

from pathlib import Path

import pytest

import hal
import linuxcnc
from tests.support.desk import DONE, ERROR, at_desk
from tests.support.halsession import halcmd
from tests.support.machine import PATIENCE

pytestmark = pytest.mark.process


def setp(pin: str, value: float) -> None:
    assert halcmd("setp", f"ini.{pin}", str(value)) == ""


def test_pins_change_limits_and_speeds_of_the_running_machine_for_the_next_command(tmp_path):
    with at_desk(tmp_path) as desk:
        desk.ready(linuxcnc.MODE_MDI)
        setp("0.max_limit", 20)
        setp("x.max_limit", 20)
        setp("0.max_velocity", 1.5)
        setp("x.max_velocity", 1)
        assert desk.mdi("G53 G0 X21") == ERROR
        assert "would exceed X's positive limit" in desk.texts[-1]
        desk.until(lambda s: s.joint[0]["max_position_limit"] == 20.0, "limit of joint 0")
        desk.until(lambda s: s.axis[0]["max_position_limit"] == 20.0, "limit of axis X")
        for speed, end in ((1.0, 19), (0.5, 15)):
            hal.set_p("ini.x.max_velocity", str(speed))
            desk.command.mdi(f"G53 G0 X{end}")
            desk.until(lambda s, speed=speed: s.current_vel == pytest.approx(speed, rel=0.01), "the new speed of X")
            assert desk.command.wait_complete(PATIENCE) == DONE
            assert desk.look().current_vel == 0.0


@pytest.mark.parametrize(
    ("pin", "value", "reason"),
    [
        ("0.max_velocity", 0, "a number above 0 is needed"),
        ("x.min_limit", 1e9, "a number below max_limit"),
        ("0.max_limit", -1e9, "a number above min_limit"),
        ("1.ferror", -1, "0 or more is needed"),
    ],
)
def test_a_value_that_cannot_be_is_refused_and_the_old_one_stays(tmp_path, pin, value, reason):
    with at_desk(tmp_path) as desk:
        desk.ready(linuxcnc.MODE_MDI)
        setp(pin, value)
        desk.until(lambda _: desk.texts, "a text")
        assert f"ini.{pin}" in desk.texts[-1]
        assert reason in desk.texts[-1]
        assert desk.mdi("G53 G0 X5") == DONE


def test_joints_stand_where_they_stood_when_the_machine_ended(tmp_path: Path) -> None:
    changes = {"TRAJ.COORDINATES": "X Y Z\nPOSITION_FILE = position.txt"}
    with at_desk(tmp_path, changes=changes) as desk:
        desk.ready(linuxcnc.MODE_MDI)
        assert desk.mdi("G53 G0 X3 Y-2.5 Z-1") == DONE
    lines = (tmp_path / "position.txt").read_text().splitlines()
    assert [float(line) for line in lines[:4]] == pytest.approx([3.0, -2.5, -1.0, 0.0])
    with at_desk(tmp_path, changes=changes) as desk:
        desk.until(lambda s: s.joint_actual_position[:3] == pytest.approx((3.0, -2.5, -1.0)), "where it stood")
