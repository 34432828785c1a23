"""Switchable kinematics: motion.switchkins-type selects one at rest, and the pose is the new one's from then on."""

from __future__ import annotations

import pytest

from emcmot.kins import millturn, scarakins, xyzac_trt_kins
from emcmot.sim import Motion
from nml.emc.emcmot import MotCommand as C
from tests.support.mill import bring_to, configure, line


def table_mill(state: str) -> Motion:
    """A mill with a table turned by 90 degrees, at x 10, y 20."""
    kins = xyzac_trt_kins.create(sparm="identityfirst")
    m = bring_to(configure(Motion(kinematics=kins), limit=400.0, axes=9), "homed")
    for joint, where in ((0, 10.0), (1, 20.0), (4, 90.0)):
        m.send(C.JOG_ABS, joint=joint, mode=1, vel=50.0, offset=where)
    m.run_until_rest()
    if state != "homed":
        m.send(C[state.upper()])
        m.step(2)
    assert m.errors() == []
    return m


@pytest.mark.parametrize(("state", "number"), [("homed", 1), ("teleop", 2), ("coord", 3)])
def test_the_pose_is_that_of_the_new_kinematics_and_no_joint_moves(state: str, number: int) -> None:
    m = table_mill(state)
    before = [m[f"joint.{n}.motor-pos-cmd"] for n in range(5)]
    assert m.status.carte_pos_cmd.tran.x == pytest.approx(10.0)
    m["motion.switchkins-type"] = 1.0
    m.step(1)
    pose = m.status.carte_pos_cmd
    assert (pose.tran.x, pose.tran.y, pose.c) == pytest.approx((20.0, -10.0, 90.0))
    assert m.status.kinematics_way == 1
    m.step(50)
    assert [m[f"joint.{n}.motor-pos-cmd"] for n in range(5)] == pytest.approx(before)
    assert m.status.motion_state == number
    assert m.errors() == []


def test_moves_after_a_switch_go_to_the_new_pose() -> None:
    m = table_mill("coord")
    m["motion.switchkins-type"] = 1.9  # truncated
    m.step(2)
    line(m, 25, -10, 0, 0, 0, 90, vel=20.0)
    m.run_until_rest()
    assert (m["joint.0.pos-cmd"], m["joint.1.pos-cmd"]) == pytest.approx((10.0, 25.0))
    m["motion.switchkins-type"] = 0.0
    m.step(2)
    assert m.status.carte_pos_cmd.tran.y == pytest.approx(25.0)
    assert m.worst_acc <= 1.0 + 1e-6
    assert m.errors() == []


def test_a_switch_waits_for_the_end_of_the_motion() -> None:
    m = table_mill("coord")
    line(m, 60, 20, 0, 0, 0, 90, vel=20.0)
    m.step(200)
    m["motion.switchkins-type"] = 1.0
    m.step(100)
    assert m.status.kinematics_way == 0
    m.run_until_rest()
    assert m.status.kinematics_way == 1
    assert m["joint.0.pos-cmd"] == pytest.approx(60.0)
    assert m.status.carte_pos_cmd.tran.x == pytest.approx(20.0)


def test_a_type_that_does_not_exist_is_refused_once_and_changes_nothing() -> None:
    m = bring_to(configure(Motion(kinematics=millturn.create()), axes=4), "coord")
    for asked in (2.0, 2.0, -1.0, float("nan"), 1e300):
        m["motion.switchkins-type"] = asked
        m.step(20)
    assert m.errors() == [
        "motion.switchkins-type: this kinematics has no type 2",
        "motion.switchkins-type: this kinematics has no type -1",
    ]
    assert m.status.kinematics_way == 0


def test_an_analog_output_keeps_motion_out_of_position_until_a_switch_has_come_in() -> None:
    m = bring_to(configure(Motion(kinematics=millturn.create()), axes=4), "coord")
    m.send(C.SET_AOUT, out=3, now=1, minLimit=1.0)
    reached = []
    for _ in range(6):
        m["motion.switchkins-type"] = m["motion.analog-out-03"]
        m.step(1)
        reached.append((m["motion.in-position"], m.status.kinematics_way))
    assert reached == [(0, 1), (0, 1), (0, 1), (1, 1), (1, 1), (1, 1)]


def test_a_lathe_of_a_mill_jogs_its_own_axes() -> None:
    m = bring_to(configure(Motion(kinematics=millturn.create()), axes=4), "teleop")
    m["motion.switchkins-type"] = 1.0
    m.step(2)
    m.send(C.JOG_INCR, axis=0, mode=0, vel=20.0, offset=5.0)
    m.run_until_rest()
    assert m["joint.2.pos-cmd"] == pytest.approx(5.0)
    assert m["joint.0.pos-cmd"] == pytest.approx(0.0)


def test_a_robot_that_is_not_homed_may_be_switched_and_has_no_pose() -> None:
    m = bring_to(configure(Motion(kinematics=scarakins.create()), axes=6), "free")
    m["motion.switchkins-type"] = 1.0
    m.step(2)
    assert m.status.kinematics_way == 1
    assert not m.status.carte_pos_cmd_ok
    assert m.errors() == []


def test_the_pin_is_only_where_there_is_something_to_switch() -> None:
    assert "motion.switchkins-type" not in {pin.name for pin in Motion("xyz").pins}
