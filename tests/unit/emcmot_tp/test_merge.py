"""Runs of short moves with rounded coordinates are cut as the smooth curve that they stand for."""

import math

import numpy as np
import pytest

from emcmot.tp.planner import TERM_TANGENT
from tests.support.planned import Program


def circle_of_short_moves(radius, step, decimals, turn=1.0, **options):
    program = Program(start=(radius, 0, 0), **options)
    for angle in np.arange(1, int(turn * 2 * math.pi * radius / step)) * step / radius:
        program.line(round(radius * math.cos(angle), decimals), round(radius * math.sin(angle), decimals), 0)
    return program


@pytest.mark.parametrize(("decimals", "tolerance"), [(6, 0.005), (4, 0.005), (3, 0.01)])
def test_rounded_coordinates_do_not_slow_the_machine(decimals, tolerance):
    program = circle_of_short_moves(50, 0.05, decimals, turn=0.25, tolerance=tolerance)
    report = program.check(program.run(), tolerance)
    assert report.seconds < 0.25 * 2 * math.pi * 50 / 60 + 60 / 500 * 1.4


def test_without_tolerance_nothing_is_merged():
    program = circle_of_short_moves(5, 0.5, 3, turn=0.2, term=TERM_TANGENT)
    program.check(program.run(), 1e-5)


def test_corners_of_short_moves_stay_corners():
    program = Program(tolerance=0.01)
    for k in range(100):
        program.line(0.1 * (k + 1), 0, 0)
    for k in range(100):
        program.line(10, 0.1 * (k + 1), 0)
    program.check(program.run(), 0.01)


def test_every_programmed_move_is_reported_in_order():
    program = circle_of_short_moves(20, 0.1, 4, turn=0.3, tolerance=0.01, vel=20.0)
    seen = []
    while not program.planner.status()["done"]:
        program.planner.step(1)
        seen.append(program.planner.status()["id"])
    ids = [i for i in seen if i]
    assert ids == sorted(ids)
    assert set(ids) == set(range(1, len(program.path) + 1))


def test_the_feed_of_each_move_is_kept():
    program = Program(tolerance=0.01)
    for k in range(200):
        program.line(0.1 * (k + 1), 0.0001 * (k % 2), 0, vel=5.0 if k < 100 else 40.0)
    positions = program.run()
    speed = np.linalg.norm(np.diff(positions[:, :3], axis=0), axis=1) / program.dt
    assert speed[positions[:-1, 0] < 9.9].max() <= 5.0 + 1e-6
    assert speed.max() > 39.0


def test_steps_of_rounding_as_long_as_the_moves_are_smoothed_within_tolerance():
    program = circle_of_short_moves(20, 0.03, 2, turn=0.2, tolerance=0.02)
    report = program.check(program.run(), 0.02)
    assert report.seconds < 1.0
