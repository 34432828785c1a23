"""Splines as curves: NURBS in every plane, with weights and with the program's own knots."""

import math
from pathlib import Path

import numpy as np
import pytest

from nml.errors import InterpError
from rs274ngc import nurbs
from rs274ngc.geometry import GeometryCanon
from rs274ngc.interp import Interpreter

PLANES = {"g17": ("x", "y", 0, 1), "g18": ("z", "x", 2, 0), "g19": ("y", "z", 1, 2)}
QUARTER = ((10.0, 0.0, 1.0), (10.0, 10.0, math.sqrt(0.5)), (0.0, 10.0, 1.0))
"""Control points and weights of a quarter of a circle about the origin."""


def points_of(text: str, folder: Path) -> np.ndarray:
    """The ends of all moves of a program."""
    program = folder / "program.ngc"
    program.write_text(text + "\nm2\n")
    canon = GeometryCanon()
    interp = Interpreter(canon)
    interp.init()
    interp.open(program)
    interp.run_file()
    return np.asarray(canon.moves)[:, :3]


def test_a_curve_of_order_two_is_its_polygon() -> None:
    points, knots = [(0.0, 0.0, 1.0), (1.0, 0.0, 1.0), (1.0, 1.0, 1.0)], [0.0, 0.0, 1.0, 2.0, 2.0]
    assert nurbs.point(points, 2, knots, 0.5) == (0.5, 0.0)
    assert nurbs.point(points, 2, knots, 2.0) == (1.0, 1.0)


@pytest.mark.parametrize("plane", PLANES)
def test_weights_make_a_circle_of_g5_2_in_every_plane(plane: str, tmp_path: Path) -> None:
    a, b, first, second = PLANES[plane]
    lines = [f"{a}{x} {b}{y} p{weight:.9f}" for x, y, weight in QUARTER[1:]]
    ends = points_of(f"g21 {plane} f100\ng0 {a}10\ng5.2 p1 l3\n" + "\n".join(lines) + "\ng5.3", tmp_path)
    assert len(ends) > 10
    assert np.allclose(np.hypot(ends[:, first], ends[:, second]), 10.0, atol=1e-6)
    assert np.allclose(ends[-1, [first, second]], [0.0, 10.0])


@pytest.mark.parametrize("plane", PLANES)
def test_g6_2_takes_knots_from_the_program_in_every_plane(plane: str, tmp_path: Path) -> None:
    a, b, first, second = PLANES[plane]
    lines = [f"{a}{x} {b}{y} r{weight:.9f} k0" for x, y, weight in QUARTER]
    lines[0] = f"g6.2 {lines[0]} p3 q1"
    ends = points_of(
        f"g21 {plane} f100\ng0 {a}10\n" + "\n".join(lines) + "\ng6.2 k1\ng6.2 k1\ng6.2 k1\ng1 x0 y0 z0", tmp_path
    )
    curve = ends[1:-1]
    assert len(curve) > 10
    assert np.allclose(np.hypot(curve[:, first], curve[:, second]), 10.0, atol=1e-6)
    assert np.allclose(curve[-1, [first, second]], [0.0, 10.0])


def test_a_curve_of_g6_2_of_order_two_is_its_polygon_whatever_its_knots(tmp_path: Path) -> None:
    text = "g21 f100\ng6.2 x0 y0 k0 p2\nx1 y0 k0\nx1 y3 k1\nx4 y3 k5\ng6.2 k6\ng6.2 k6"
    ends = points_of(text, tmp_path)
    assert all(x in (1.0, 4.0) or y in (0.0, 3.0) for x, y, _ in np.round(ends, 9))
    assert tuple(ends[-1, :2]) == (4.0, 3.0)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("g6.2 x1 y1 p3", "K word (knot) missing with G6.2"),
        ("g6.2 x1 y1 k0", "The first G6.2 needs a P word"),
        ("g6.2 k0 p3", "The first G6.2 needs a control point"),
        ("g6.2 x1 k0 p3", "You must specify both X and Y coordinates"),
        ("g6.2 x1 y1 k1 p3\nx2 y2 k0", "Knots of G6.2 must not decrease"),
        ("g6.2 x1 y1 k0 p3\nx2 y2 k0 r0", "Must specify positive weight R"),
        ("g6.2 x1 y1 k0 p3\ng6.2 k1\nx2 y2 k2", "No control point may follow"),
        ("g6.2 x1 y1 k0 p2\ng6.2 k1\ng6.2 k2", "needs at least as many control points"),
        ("g6.2 x1 y1 k0 p2\nx2 y2 k0\ng6.2 k0\ng6.2 k0", "The knots of G6.2 are all the same"),
        ("g18 g6.2 z1 x1 y1 k0 p3", "Splines may not have motion outside their plane"),
    ],
)
def test_g6_2_says_what_is_missing(lines: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(InterpError) as refused:
        points_of("g21 f100\n" + lines, tmp_path)
    assert message in str(refused.value)
