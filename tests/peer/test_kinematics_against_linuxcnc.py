"""Each kinematics gives the poses and joints of LinuxCNC's module of that name, for random poses and geometries."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from tests.support.kinematics_poses import CASES, Case
from tests.support.stock_kinematics import ask, available

pytestmark = [
    pytest.mark.peer,
    pytest.mark.skipif(not available, reason="Debian's LinuxCNC or a C compiler is not installed"),
]

POSES = 40
WHOLE_TURN = 360.0


def pin_names(case: Case) -> dict[str, float]:
    return {f"{case.name}.{name}": value for name, value in case.pins.items()}


def same(ours: list[float], theirs: list[float] | None, tolerance: float) -> bool:
    """Equal, but for whole turns of angles."""
    assert theirs is not None
    gaps = [abs(a - b) for a, b in zip(ours, theirs, strict=False)]
    return all(min(gap, abs(gap - WHOLE_TURN)) < tolerance for gap in gaps)


@pytest.mark.parametrize("case", [case for case in CASES if case.in_2_9], ids=str)
def test_poses_and_joints_are_those_of_linuxcnc(case: Case, tmp_path: Path) -> None:
    rng = random.Random(str(case))
    kins = case.module()
    given = [case.random(rng) for _ in range(POSES)]
    poses = [row + [0.0] * (9 - len(row)) for row in given] if case.of_pose else [kins.forward(row) for row in given]
    joints = [kins.inverse(pose) for pose in poses] if case.of_pose else given
    near = [[j + rng.uniform(-0.5, 0.5) for j in row] for row in joints]
    guess = [[p + 0.01 if p else 0.0 for p in pose] for pose in poses]
    stock = ask(
        tmp_path,
        case.name,
        arguments=case.arguments,
        pins=pin_names(case),
        way=case.way,
        poses=poses,
        joints=joints,
        near=near,
        guess=guess,
    )
    tolerance = 1e-4 if case.name == "genserkins" and case.way == 0 else 1e-6
    for n in range(POSES):
        if case.stock_forward:
            assert same(poses[n][: 9 if case.of_pose else 6], stock["poses"][n], 1e-6), f"pose of joints {joints[n]}"
        assert same(joints[n], stock["joints"][n], tolerance), f"joints of pose {poses[n]}"
