"""With jerk limits on, moves keep them, corners stay within tolerance, and every command ends at rest on the path."""

import math

import numpy as np
import pytest

from emcmot.tp.planner import TERM_STOP, TERM_TANGENT, Planner
from emcmot.tp.verifier import verify
from tests.support.planned import AMAX, DT, ROUNDING, VMAX, Program, come_to_rest

JERK = 8000.0
JMAX = np.full(9, JERK)


def jerk_limited(jerk=JERK, **options):
    program = Program(**options)
    for axis in range(9):
        program.planner.set_limits(axis, VMAX[axis], AMAX[axis], jerk)
    program.planner.limit_jerk(True)
    return program


def checked(program, positions, tolerance, stride=1):
    report = verify(positions, program.path, VMAX, AMAX, DT, tolerance, stride, JMAX)
    assert report.worst_velocity <= ROUNDING
    assert report.worst_acceleration <= ROUNDING
    assert report.worst_jerk <= ROUNDING
    assert report.deviation <= tolerance + 1e-7
    return report


def test_a_long_move_reaches_the_acceleration_limit_and_arrives_exactly():
    program = jerk_limited().line(200, vel=80.0)
    report = checked(program, program.run(), 0.0)
    assert report.worst_acceleration > 0.95
    assert report.end == 0.0
    assert report.seconds < 200 / 80 + 80 / 500 + 2.6 * 500 / JERK


def test_straight_moves_between_stops_use_the_jerk_fully():
    program = jerk_limited(term=TERM_STOP).line(100, 0, 0).line(100, 100, 0).line(0, 100, 0)
    report = checked(program, program.run(), 0.0)
    assert report.worst_jerk > 0.96  # overrides need what is left, to begin


def test_short_moves_along_a_curve_are_hardly_slower_than_one_straight_move():
    program = jerk_limited(tolerance=0.01)
    for angle in 0.001 * np.arange(1, 1201):
        program.line(50 * np.cos(angle) - 50, 50 * np.sin(angle), vel=60.0)
    report = checked(program, program.run(), 0.01)
    assert report.seconds < 1.06 * (60 / 60 + 60 / 500 + 500 / JERK)


def test_a_corner_that_a_blend_would_crawl_round_is_a_stop():
    program = jerk_limited(tolerance=0.002).line(0, -5, 0).line(0, -5.002, -0.001, -20, 20).line(0, -5.002, 5)
    report = checked(program, program.run(), 0.002)
    assert report.end <= 1e-9
    assert report.seconds < 5.0


def test_without_the_planner_type_jerk_limits_are_only_kept():
    program = jerk_limited()
    program.planner.limit_jerk(False)
    report = verify(program.line(60).run(), program.path, VMAX, AMAX, DT, 0.0, 1, JMAX)
    assert report.worst_jerk > 10.0


@pytest.mark.parametrize("tolerance", [0.01, 0.1])
def test_corners_are_passed_in_motion_and_within_tolerance(tolerance):
    program = jerk_limited(tolerance=tolerance).line(20, 0, 0).line(20, 20, 0).line(0, 20, 0)
    positions = program.run()
    checked(program, positions, tolerance)
    inside = np.linalg.norm(np.diff(positions[30:-60], axis=0), axis=1) / DT
    assert inside.min() > 0.05


@pytest.mark.parametrize("term", [TERM_STOP, TERM_TANGENT])
def test_exact_modes_come_to_rest_at_every_corner(term):
    program = jerk_limited(term=term).line(20, 0, 0).line(20, 20, 0)
    positions = program.run()
    checked(program, positions, 1e-9)
    assert np.any(np.all(positions[:, :2] == [20, 0], axis=1))


def test_lines_and_arcs_meet_with_continuous_acceleration():
    program = jerk_limited(tolerance=0.02).line(20, 0, 0).arc((30, 10, 0), (20, 10, 0)).line(30, 20, 0)
    program.arc((20, 20, 3), (25, 20, 0), turn=-1).arc((20, 20, 3), (15, 20, 3), turn=0)
    checked(program, program.run(), 0.02)


def test_chains_of_tiny_segments_keep_moving():
    program = jerk_limited(start=(50, 0, 0), tolerance=0.01)
    for angle in np.arange(1, 1201) * 0.001:
        program.line(50 * math.cos(angle), 50 * math.sin(angle), 0)
    assert checked(program, program.run(), 0.01).seconds < 3.0


def test_rotary_moves_are_limited_as_well():
    program = jerk_limited(tolerance=0.05).line(20, 0, 0).line(20, 0, 0, 30).line(0, 0, 0, 30)
    program.line(0, 10, 0, 0, 0, 0, 20)
    checked(program, program.run(), 0.05)


def test_pause_and_reverse_come_to_rest_on_the_path_without_a_jolt():
    program = jerk_limited(tolerance=0.02).line(20, 0, 0).line(20, 20, 0).arc((0, 20, 0), (10, 20, 0))
    planner = program.planner
    parts = [planner.step(500), come_to_rest(planner)]
    assert np.array_equal(planner.step(1), parts[-1][-1:])
    assert planner.reverse(True)
    planner.resume()
    parts += [planner.step(300), come_to_rest(planner)]
    assert parts[-1][-1][0] < parts[1][-1][0] or parts[-1][-1][1] < parts[1][-1][1]
    assert planner.reverse(False)
    planner.resume()
    parts.append(program.run())
    assert checked(program, np.concatenate(parts), 0.02).end == 0.0


def test_a_feed_override_changes_the_speed_within_the_jerk_limit():
    program = jerk_limited().line(300, vel=60.0)
    parts = []
    for scale in (1.0, 0.2, 0.0, 0.7, 1.0):
        program.planner.feed_scale(scale)
        parts.append(program.planner.step(600))
        speed = (parts[-1][-1, 0] - parts[-1][-2, 0]) / DT
        assert 0.999 * scale <= speed / 60.0 <= 1.0001 * scale
    parts.append(program.run())
    assert checked(program, np.concatenate(parts), 0.0).end == 0.0


def test_lower_and_lower_overrides_are_kept_and_left_again():
    program = jerk_limited().line(300, vel=60.0)
    parts = [program.planner.step(800)]
    for scale in (0.2, 0.04, 0.008, 0.0016, 0.0003):
        program.planner.feed_scale(scale)
        parts.append(program.planner.step(1500))
        assert parts[-1][-1, 0] - parts[-1][-2, 0] == pytest.approx(60.0 * scale * DT, rel=2e-3)
    program.planner.feed_scale(1.0)
    parts.append(program.planner.step(600))
    assert parts[-1][-1, 0] - parts[-1][-2, 0] == pytest.approx(60.0 * DT, rel=2e-3)
    parts.append(program.run())
    assert checked(program, np.concatenate(parts), 0.0).end == 0.0


def test_without_jerk_of_an_axis_only_the_others_are_limited():
    program = jerk_limited()
    program.planner.set_limits(0, VMAX[0], AMAX[0], 0.0)
    program.line(30, 0, 0).line(30, 30, 0)
    report = verify(program.run(), program.path, VMAX, AMAX, DT, 0.0, 1, JMAX)
    assert report.jerk[1] <= ROUNDING


@pytest.mark.parametrize(("jerk", "seconds"), [(50_000.0, 2.15), (5_000.0, 2.3)])
def test_short_moves_never_wait_for_the_queue_that_they_arrive_in(jerk, seconds):
    planner = Planner(DT)
    planner.limit_jerk(True)
    for axis in range(9):
        planner.set_limits(axis, VMAX[axis], AMAX[axis], jerk)
    angles = np.arange(1, 8001) * 2e-4
    points = np.column_stack([100 * np.cos(angles) - 100, 100 * np.sin(angles), *[0 * angles] * 7])
    parts, given = [], 0
    while given < len(points) or not planner.status()["done"]:
        while given < len(points) and planner.add_line(points[given], 85.0, tolerance=0.005, id=given + 1):
            given += 1
        parts.append(planner.step_until_done(20))
    assert len(np.concatenate(parts)) * DT < seconds, "160 mm and one ramp each at both ends"


def test_a_path_that_turns_back_twice_within_one_blend_is_run_to_its_end():
    program = jerk_limited(jerk=129_000.0, tolerance=0.2, vel=36.0)
    for y in (5.0125, 4.6074, 6.2044, 5.0647, 9.2960):
        program.line(0, y, 0)
    report = verify(program.run(), program.path, VMAX, AMAX, DT, 0.2, 1, np.full(9, 129_000.0))
    assert max(report.worst_velocity, report.worst_acceleration, report.worst_jerk) <= ROUNDING
    assert report.end == 0.0


def test_short_rounded_moves_are_laid_as_the_curve_that_they_stand_for():
    program, angles = jerk_limited(5000.0, tolerance=0.01), np.arange(1, 1201) * 2 * math.pi / 300
    for x, y in np.round(np.column_stack([8 * np.cos(angles) - 8, 8 * np.sin(angles)]), 3):
        program.line(x, y, 0, vel=85.0)
    report = verify(program.run(), program.path, VMAX, AMAX, DT, 0.01, 1, np.full(9, 5000.0))
    assert report.worst_jerk <= ROUNDING
    assert report.deviation <= 0.01 + 1e-7
    fastest = min((5000.0 * 8**2) ** (1 / 3), math.sqrt(500.0 * 8))  # an axis's jerk on a circle is v^3 / r^2
    assert report.seconds < 1.08 * 2 * math.pi * 8 * 4 / fastest + 0.4


def test_the_move_that_is_reported_is_the_one_where_the_machine_is():
    program = jerk_limited(40_000.0, tolerance=0.02)
    for n in range(1, 601):
        program.line(0.05 * n, 10 - 0.0005 * (300 - n) ** 2 / 9, 0, vel=50.0)
    while not program.planner.status()["done"]:
        program.planner.step(25)
        status = program.planner.status()
        if status["id"] > 1:
            assert status["id"] == pytest.approx(status["pos"][0] / 0.05, abs=2.0)
    assert status["pos"][0] == 30.0
