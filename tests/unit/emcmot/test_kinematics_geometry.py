"""Forward undoes inverse for every kinematics, over its whole space."""

from __future__ import annotations

import math
import random

import pytest

from emcmot.kins import corexykins, genhexkins, rotatekins, scarakins
from emcmot.kins.kinematics import KinematicsModule
from emcmot.sim import Motion
from nml.emc.emcmot import MotCommand as C
from tests.support.mill import bring_to, configure, line


def pose_for(name: str, rng: random.Random) -> list[float]:
    """A pose that the machine can reach."""
    if name == "genhexkins":
        lean = [rng.uniform(-20, 20) for _ in range(3)]
        return [rng.uniform(-5, 5), rng.uniform(-5, 5), rng.uniform(20, 40), *lean, 0, 0, 0]
    if name == "scarakins":
        reach, angle, wrist = rng.uniform(150, 500), rng.uniform(-3, 3), rng.uniform(-170, 170)
        x = reach * math.cos(angle) + 50 * math.cos(math.radians(wrist))
        y = reach * math.sin(angle) + 50 * math.sin(math.radians(wrist))
        return [x, y, rng.uniform(0, 300), rng.uniform(-90, 90), rng.uniform(-90, 90), wrist, 0, 0, 0]
    return [rng.uniform(-200, 200) for _ in range(9)]


@pytest.mark.parametrize("module", [corexykins, rotatekins, scarakins, genhexkins])
def test_forward_undoes_inverse(module: object) -> None:
    kins: KinematicsModule = module.create()  # type: ignore[attr-defined]
    rng = random.Random(kins.name)
    for _ in range(500):
        pose = pose_for(kins.name, rng)
        joints = kins.inverse(pose)
        guess = [p + rng.uniform(-0.5, 0.5) for p in pose[:6]] + pose[6:]
        assert kins.forward(joints, guess) == pytest.approx(pose, abs=1e-7)


# what LinuxCNC 2.9's modules answer to joints 10 20 3 4 5 30 7 8 9
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
        m = Motion(kinematics=kins)
        pose = kins.forward(joints)
        assert m.kinematics.inverse(pose, joints) == pytest.approx(joints)


def test_what_no_arm_reaches_has_no_solution() -> None:
    with pytest.raises(ValueError, match="no inverse solution"):
        scarakins.create().inverse([2000, 0, 0, 0, 0, 0, 0, 0, 0])


def test_a_hexapod_finds_its_pose_from_far_away() -> None:
    kins = genhexkins.create()
    pose = [3.0, -4.0, 30.0, 10.0, -12.0, 8.0, 0, 0, 0]
    assert kins.forward(kins.inverse(pose), [0, 0, 20, 0, 0, 0, 0, 0, 0]) == pytest.approx(pose, abs=1e-7)


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
