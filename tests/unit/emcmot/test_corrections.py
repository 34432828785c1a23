"""Backlash, screw tables, motor offsets, external offsets: what is added to the joints' commands."""

from __future__ import annotations

import pytest

from emcmot.sim import Motion
from nml.emc.emcmot import MotCommand as C
from tests.support.mill import line, mill


def test_backlash_is_taken_up_on_a_change_of_direction_and_stays_invisible() -> None:
    m = mill("coord")
    m.send(C.SET_JOINT_BACKLASH, joint=0, backlash=0.2)
    line(m, 10)
    m.run_until_rest()
    m.step(200)
    assert m["joint.0.motor-pos-cmd"] == pytest.approx(10.1)
    assert m["joint.0.pos-fb"] == pytest.approx(10.0)
    line(m, 5)
    m.run_until_rest()
    m.step(200)
    assert m["joint.0.motor-pos-cmd"] == pytest.approx(4.9)
    assert m["joint.0.backlash-filt"] == pytest.approx(-0.1)
    assert m.worst_vel <= 1.5
    assert m.worst_acc <= 1.5 + 1e-6
    assert m.errors() == []


def test_a_screw_table_corrects_each_direction_between_its_points() -> None:
    m = mill("coord")
    for nominal, forward, reverse in ((-10, 0.0, 0.0), (0, 0.0, -0.1), (10, 0.2, -0.2), (20, 0.0, 0.0)):
        assert m.send(C.SET_JOINT_COMP, comp_nominal=nominal, comp_forward=forward, comp_reverse=reverse) == 0
    line(m, 5)
    m.run_until_rest()
    m.step(200)
    assert m["joint.0.motor-pos-cmd"] == pytest.approx(5.1)
    line(m, 20)
    m.run_until_rest()
    line(m, 5)
    m.run_until_rest()
    m.step(200)
    assert m["joint.0.motor-pos-cmd"] == pytest.approx(5.0 - 0.15)
    assert m.worst_acc <= 1.5 + 1e-6


def test_a_screw_table_must_rise_and_has_an_end() -> None:
    m = mill("off")
    assert m.send(C.SET_JOINT_COMP, comp_nominal=1.0) == 0
    assert m.send(C.SET_JOINT_COMP, comp_nominal=1.0) != 0
    assert m.errors() == ["joint 0: compensation values must increase"]
    for n in range(2, 257):
        assert m.send(C.SET_JOINT_COMP, comp_nominal=float(n)) == 0
    assert m.send(C.SET_JOINT_COMP, comp_nominal=1000.0) != 0
    assert m.errors() == ["joint 0: too many compensation entries, 256 fit"]


def test_a_new_motor_offset_renames_the_place_and_moves_nothing() -> None:
    m = mill("off")
    m.send(C.SET_JOINT_MOTOR_OFFSET, joint=1, motor_offset=4.0)
    m.step(100)
    assert m["joint.1.motor-pos-cmd"] == 0.0
    assert m["joint.1.pos-cmd"] == -4.0


def offsets(m: Motion) -> None:
    m.send(C.SET_AXIS_VEL_LIMIT, axis=2, vel=50.0, ext_offset_vel=50.0)
    m.send(C.SET_AXIS_ACC_LIMIT, axis=2, acc=500.0, ext_offset_acc=500.0)
    m["axis.z.eoffset-scale"] = 0.01
    m["axis.z.eoffset-enable"] = 1


@pytest.mark.parametrize("state", ["teleop", "coord"])
def test_an_external_offset_shifts_the_machine_under_its_own_limits(state: str) -> None:
    m = mill(state)
    offsets(m)
    m["axis.z.eoffset-counts"] = 300
    m.step(1000)
    assert m["axis.z.eoffset"] == 3.0
    assert m["joint.2.motor-pos-cmd"] == pytest.approx(3.0)
    assert m["axis.z.pos-cmd"] == 0.0
    assert m["motion.eoffset-active"]
    assert m.status.eoffset_pose.tran.z == 3.0
    assert m.worst_acc <= 0.5 + 1e-6
    m["axis.z.eoffset-clear"] = 1
    m.step(1000)
    assert m["joint.2.motor-pos-cmd"] == pytest.approx(0.0)


def test_moves_go_on_under_an_external_offset_within_the_joints_limits() -> None:
    m = mill("coord")
    offsets(m)
    for n in range(10):
        line(m, 5.0 * (n % 2), 0, -8.0 * (n % 3), id=n + 1, vel=80.0)
    for n in range(3000):
        m["axis.z.eoffset-counts"] = 400 * (n // 100 % 2)
        m.step()
    assert m.worst_vel <= 1.0 + 1e-6
    assert m.worst_acc <= 1.0 + 1e-6


def test_an_external_offset_stops_at_the_axis_limit() -> None:
    m = mill("coord")
    offsets(m)
    m["axis.z.eoffset-counts"] = 1_000_000
    m.step(5000)
    assert m["motion.eoffset-limited"]
    assert m["joint.2.motor-pos-cmd"] == pytest.approx(100.0)


def test_leaving_the_cartesian_modes_keeps_the_machine_where_the_offset_has_it() -> None:
    m = mill("coord")
    offsets(m)
    m["axis.z.eoffset-counts"] = 300
    m.step(50)
    m.send(C.FREE)
    m.step(500)
    assert m.status.motion_state == 1
    here = m["joint.2.motor-pos-cmd"]
    m.send(C.COORD)
    m.step(3)
    assert m["joint.2.motor-pos-cmd"] == pytest.approx(here, abs=0.01)
    assert m.worst_acc <= 1.0 + 1e-6


def test_switching_off_and_on_forgets_the_offset_but_not_the_place() -> None:
    m = mill("coord")
    offsets(m)
    m["axis.z.eoffset-counts"] = 300
    m.step(1000)
    m.send(C.DISABLE)
    m.step(100)
    m.send(C.ENABLE)
    m.step(10)
    assert m["axis.z.eoffset"] == 0.0
    assert m["joint.2.motor-pos-cmd"] == pytest.approx(3.0)
    assert m.status.carte_pos_cmd.tran.z == pytest.approx(3.0)
