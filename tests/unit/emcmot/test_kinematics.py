"""Each kinematics: forward undoes inverse, and its arguments are checked."""

from __future__ import annotations

from types import ModuleType

import pytest

from emcmot.core import Core
from emcmot.kins import millturn, trivkins, userkins
from nml.errors import HalError


def test_trivkins_takes_the_axes_in_any_order() -> None:
    kins = trivkins.create("zxa")
    assert kins.inverse([1, 2, 3, 4, 0, 0, 0, 0, 0]) == [3, 1, 4]
    assert kins.forward([3, 1, 4]) == [1, 0, 3, 4, 0, 0, 0, 0, 0]


def test_the_first_joint_of_a_letter_gives_the_axis_position() -> None:
    kins = trivkins.create("xyyz")
    assert kins.inverse([1, 2, 3, 0, 0, 0, 0, 0, 0]) == [1, 2, 2, 3]
    assert kins.forward([1, 2, 2.5, 3])[:3] == [1, 2, 3]


def test_trivkins_without_coordinates_has_the_joints_of_the_machine() -> None:
    kins = trivkins.create()
    Core(kins, num_joints=4)
    assert kins.joints == 4
    assert kins.inverse([1, 2, 3, 4, 5, 0, 0, 0, 0]) == [1, 2, 3, 4]


@pytest.mark.parametrize(("text", "number"), [("1", 1), ("both", 4), ("BOTH", 4), ("f", 2), ("i", 3)])
def test_kinstype_says_what_motion_believes(text: str, number: int) -> None:
    assert trivkins.create("xyz", text).type == number


@pytest.mark.parametrize("arguments", [{"coordinates": "xyq"}, {"coordinates": "x" * 17}, {"kinstype": "z"}])
def test_bad_arguments_are_named(arguments: dict[str, str]) -> None:
    with pytest.raises(HalError, match=next(iter(arguments.values()))):
        trivkins.create(**arguments)


def test_too_few_joints_for_the_kinematics_are_refused() -> None:
    with pytest.raises(HalError, match="num_joints=2"):
        Core(trivkins.create("xyz"), num_joints=2)


@pytest.mark.parametrize("module", [millturn, userkins])
def test_kinematics_of_the_template_echo_their_pin_when_the_inverse_is_called(module: ModuleType) -> None:
    kins = module.create()
    kins.set_parameter("in", 7.0)
    assert kins.output_values()["out"] == 0.0
    assert kins.inverse([1, 2, 3, 4, 0, 0, 0, 0, 0])[:3] == [1, 2, 3]
    assert kins.output_values()["out"] == 7.0
