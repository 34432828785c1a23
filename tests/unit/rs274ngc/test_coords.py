"""Units, offsets and rotation, there and back."""

import pytest

from rs274ngc.canon import CANON_UNITS_INCHES
from rs274ngc.coords import Coordinates


def test_a_point_comes_back_from_machine_coordinates():
    coords = Coordinates()
    coords.use_length_units(CANON_UNITS_INCHES)
    coords.set_g5x(2, 1, 2, 3, 4, 5, 6, 7, 8, 9)
    coords.set_g92(0.5, 0, 0, 0, 0, 0, 0, 0, 0)
    coords.set_tool(0, 0, 2, 0, 0, 0, 0, 0, 0)
    coords.set_rotation(30)
    point = (1.0, -2.0, 3.0, 10.0, 20.0, 30.0, 4.0, 5.0, 6.0)
    assert coords.to_program(*coords.to_machine(*point)) == pytest.approx(point)


def test_rotation_turns_before_the_origin_is_added():
    coords = Coordinates()
    coords.set_g5x(1, 10, 0, 0, 0, 0, 0, 0, 0, 0)
    coords.set_rotation(90)
    assert coords.to_machine(1, 0, 0, 0, 0, 0, 0, 0, 0)[:2] == pytest.approx((10.0, 1.0))
