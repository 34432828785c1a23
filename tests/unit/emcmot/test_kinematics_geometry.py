"""Forward undoes inverse for every kinematics, over its whole space."""

from __future__ import annotations

import random

import pytest

from emcmot.kins import corexykins, genhexkins, genserkins, pumakins, rosekins, rotatekins, scarakins
from emcmot.sim import Motion
from nml.emc.emcmot import MotCommand as C
from nml.errors import HalError
from tests.support.kinematics_poses import CASES, Case
from tests.support.mill import bring_to, configure, line


@pytest.mark.parametrize("case", CASES, ids=str)
def test_forward_undoes_inverse(case: Case) -> None:
    kins = case.module()
    rng = random.Random(str(case))
    for _ in range(300):
        given = case.random(rng)
        pose = [*given, *[0.0] * (9 - len(given))] if case.of_pose else kins.forward(given)
        near = None if case.of_pose else [j + rng.uniform(-0.5, 0.5) for j in given]
        joints = kins.inverse(pose, near)
        if not case.of_pose:
            assert joints == pytest.approx(given, abs=1e-6)
        guess = [p + rng.uniform(-0.05, 0.05) if p else 0.0 for p in pose]
        assert kins.forward(joints, guess) == pytest.approx(pose, abs=1e-6)


# what LinuxCNC 2.9's modules answer to joints 10 20 3 4 5 30 7 8 9 (all kinematics: tests/peer)
@pytest.mark.parametrize(
    ("module", "xy"), [(rotatekins, (18.660254037844386, 12.320508075688775)), (corexykins, (15.0, -5.0))]
)
def test_poses_are_those_of_linuxcnc(module: object, xy: tuple[float, float]) -> None:
    joints = [10.0, 20, 3, 4, 5, 30, 7, 8, 9]
    pose = module.create().forward(joints)  # type: ignore[attr-defined]
    assert pose == pytest.approx([*xy, 3, 4, 5, 30, 7, 8, 9])


def test_the_elbow_of_a_scara_stays_on_its_side() -> None:
    kins = scarakins.create()
    for elbow in (60.0, -60.0):
        joints = [30.0, elbow, 100.0, 20.0, 0.0, 0.0]
        assert kins.inverse(kins.forward(joints), joints) == pytest.approx(joints)


@pytest.mark.parametrize("joints", [(30, -60, 20, 40, 50, 60), (-30, -120, 160, 10, -50, 200), (10, -60, 20, 40, 0, 5)])
def test_a_puma_keeps_the_configuration_that_it_has(joints: tuple[float, ...]) -> None:
    kins = pumakins.create()
    near = [j + 1.0 for j in joints]
    near[3] = joints[3]  # a stretched wrist keeps joint 3 where it is
    assert kins.inverse(kins.forward(joints), near) == pytest.approx(joints, abs=1e-6)


def test_what_no_arm_reaches_has_no_solution() -> None:
    for kins in (scarakins.create(), pumakins.create(), genserkins.create()):
        with pytest.raises(ValueError, match="no inverse solution"):
            kins.inverse([2000, 0, 0, 0, 0, 0, 0, 0, 0], [0, -60, 20, 0, 30, 0])


def test_the_work_of_a_rose_engine_turns_on_without_end() -> None:
    kins = rosekins.create()
    joints = [10.0, 0.0, 0.0]
    for degrees in range(0, 1100, 20):
        joints = kins.inverse(kins.forward([10.0, 0.0, degrees]), joints)
        assert joints[2] == pytest.approx(degrees)
    assert kins.output_values() == pytest.approx({"revolutions": 3.0, "theta_degrees": 0.0, "bigtheta_degrees": 1080.0})


def test_a_motor_that_turns_with_the_joint_before_it_is_unrotated() -> None:
    kins = genserkins.create()
    plain = kins.forward([10, -60, 30, 40, 50, 60])
    kins.set_parameter("unrotate-2", 1.0)
    assert kins.forward([10, -60, -30, 40, 50, 60]) == pytest.approx(plain)
    assert kins.inverse(plain, [11, -61, -31, 41, 51, 61, 0, 0, 0])[:6] == pytest.approx([10, -60, -30, 40, 50, 60])


def test_a_hexapod_finds_its_pose_from_far_away() -> None:
    kins = genhexkins.create()
    pose = [3.0, -4.0, 30.0, 10.0, -12.0, 8.0, 0, 0, 0]
    assert kins.forward(kins.inverse(pose), [0, 0, 20, 0, 0, 0, 0, 0, 0]) == pytest.approx(pose, abs=1e-7)
    assert kins.output_values()["fwd-kins-fail"] == 0.0
    assert kins.output_values()["last-iterations"] > 0.0


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ({"coordinates": "xyzabq"}, "1 to 6 letters"),
        ({"coordinates": "xyzabb"}, "no letter may come twice"),
        ({"coordinates": "xyzab"}, "c is missing"),
        ({"sparm": "first"}, "only identityfirst"),
    ],
)
def test_arguments_of_switchable_kinematics_are_checked(arguments: dict[str, str], complaint: str) -> None:
    with pytest.raises(HalError, match=complaint):
        scarakins.create(**arguments)


def test_a_corexy_machine_keeps_its_motors_limits_on_diagonals() -> None:
    kins = corexykins.create()
    kins.fit(3)
    m = bring_to(configure(Motion(kinematics=kins)), "coord")
    for n, pos in enumerate([(30, 30), (-30, 30), (0, -40), (10, 10)]):
        line(m, *pos, id=n + 1, vel=500.0, ini_maxvel=500.0, acc=1e5, motion_type=1)
    m.run_until_rest()
    assert [m[f"axis.{a}.pos-cmd"] for a in "xy"] == pytest.approx([10, 10])
    assert m.worst_vel <= 1.0 + 1e-6
    assert m.worst_acc <= 1.0 + 1e-6


def test_a_pose_out_of_reach_stops_every_joint_under_its_limits() -> None:
    m = bring_to(configure(Motion(kinematics=scarakins.create()), vel=200.0, limit=1000.0, axes=6), "homed")
    m.send(C.JOG_ABS, joint=1, mode=1, vel=100.0, offset=90.0)
    m.run_until_rest()
    m.send(C.TELEOP)
    m.step(2)
    m.send(C.JOG_CONT, axis=0, mode=0, vel=-80.0)
    m.send(C.JOG_CONT, axis=1, mode=0, vel=80.0)
    m.step(20000)
    assert any("can't be reached" in text for text in m.errors())
    m.run_until_rest()
    assert m.status.motion_state == 1
