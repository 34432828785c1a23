"""Whatever moves and commands come at whatever time, no axis limit breaks and the path stays within tolerance."""

import os

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from emcmot.tp.planner import Planner
from emcmot.tp.verifier import Arc, Line, verify

DT = 0.001
ROUNDING = 1 + 1e-6
EXAMPLES = int(os.environ.get("PYEMC_EXAMPLES", "10"))  # of each property; hundreds find more
SETTINGS = settings(max_examples=EXAMPLES, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True)

coordinate = st.one_of(
    st.floats(-8, 8),
    st.integers(-4, 4).map(float),
    st.integers(-3, 3).map(lambda k: k * 0.001),
)
point = st.tuples(coordinate, coordinate, coordinate)
needle = st.tuples(st.just(0.0), st.integers(-2, 2).map(lambda k: 2.0 * k), st.just(0.0))
limit = st.tuples(st.floats(20, 150), st.floats(100, 2000))
command = st.tuples(
    st.integers(1, 90),
    st.sampled_from(
        [
            ("feed_scale", 0.0),
            ("feed_scale", 0.3),
            ("feed_scale", 1.0),
            ("feed_scale", 1.9),
            ("adaptive_scale", 0.5),
            ("adaptive_scale", 1.0),
            ("vel_limit", 15.0),
            ("vel_limit", 200.0),
            ("feed_hold", True),
            ("feed_hold", False),
            ("pause",),
            ("resume",),
            ("step_once",),
        ]
    ),
)


def build(limits, tolerance):
    planner = Planner(DT, 500)
    for axis, (vel, acc) in enumerate(limits):
        planner.set_limits(axis, vel, acc)
    return planner


def add(planner, path, at, end, bulge, tolerance, feed):
    """One move: a line, or where `bulge` is given a half turn about the middle of the chord."""
    end9 = np.zeros(9)
    end9[:3] = end
    chord = np.hypot(*(end9[:2] - at[:2]))
    if bulge is None or chord < 1e-3:
        assert planner.add_line(end9, feed, tolerance=tolerance, vel_max=feed * 2, id=len(path) + 1)
        if not np.array_equal(at, end9):
            path.append(Line(at, end9))
    else:
        center = np.array([*(at[:2] + end9[:2]) / 2, at[2]])
        assert planner.add_arc(end9, center, (0, 0, 1), bulge, feed, tolerance=tolerance, vel_max=feed * 2)
        path.append(Arc(at, end9, center, np.array([0.0, 0, 1]), bulge))
    return end9


def check(positions, path, limits, tolerance):
    vmax = np.array([vel for vel, _ in limits] + [1.0] * 6)
    amax = np.array([acc for _, acc in limits] + [1.0] * 6)
    report = verify(positions, path, vmax, amax, DT, tolerance, stride=3)
    assert report.worst_velocity <= ROUNDING
    assert report.worst_acceleration <= ROUNDING
    assert report.deviation <= tolerance + 1e-6
    assert report.end == 0.0


@SETTINGS
@given(
    moves=st.lists(st.tuples(st.one_of(point, needle), st.sampled_from([None, None, 0, -1])), min_size=1, max_size=25),
    limits=st.tuples(limit, limit, limit),
    tolerance=st.sampled_from([0.002, 0.02, 0.2]),
    feed=st.floats(5, 120),
)
def test_any_chain_of_moves_keeps_limits_and_tolerance(moves, limits, tolerance, feed):
    planner, path, at = build(limits, tolerance), [], np.zeros(9)
    for end, bulge in moves:
        at = add(planner, path, at, end, bulge, tolerance, feed)
    if path:
        check(planner.run_to_end(), path, limits, tolerance)


@SETTINGS
@given(
    moves=st.lists(st.tuples(point, st.sampled_from([None, None, 0, -1])), min_size=3, max_size=15),
    commands=st.lists(command, max_size=25),
    limits=st.tuples(limit, limit, limit),
    feed=st.floats(5, 120),
)
def test_commands_at_any_instant_break_nothing(moves, commands, limits, feed):
    planner, path, at = build(limits, 0.02), [], np.zeros(9)
    for end, bulge in moves:
        at = add(planner, path, at, end, bulge, 0.02, feed)
    parts = []
    for periods, (name, *arguments) in commands:
        parts.append(planner.step(periods))
        getattr(planner, name)(*arguments)
    for name, *arguments in (("resume",), ("feed_hold", False), ("feed_scale", 1.0), ("vel_limit", 0.0)):
        getattr(planner, name)(*arguments)
    parts.append(planner.run_to_end())
    if path:
        check(np.concatenate(parts), path, limits, 0.02)


@SETTINGS
@given(
    moves=st.lists(
        st.tuples(point, st.sampled_from([None, None, 0, -1]), st.integers(0, 120)), min_size=2, max_size=20
    ),
    limits=st.tuples(limit, limit, limit),
    tolerance=st.sampled_from([0.002, 0.2, 2.0]),
)
def test_moves_that_arrive_late_are_joined_without_a_jolt(moves, limits, tolerance):
    planner, path, at, parts = build(limits, tolerance), [], np.zeros(9), []
    for end, bulge, periods in moves:
        at = add(planner, path, at, end, bulge, tolerance, 60.0)
        parts.append(planner.step(periods))
    parts.append(planner.run_to_end())
    if path:
        check(np.concatenate(parts), path, limits, tolerance)


@SETTINGS
@given(
    moves=st.lists(st.tuples(point, st.sampled_from([None, None, 0, -1])), min_size=2, max_size=15),
    limits=st.tuples(limit, limit, limit),
    periods=st.integers(1, 1500),
)
def test_an_abort_at_any_instant_comes_to_rest_within_limits(moves, limits, periods):
    planner, path, at = build(limits, 0.05), [], np.zeros(9)
    for end, bulge in moves:
        at = add(planner, path, at, end, bulge, 0.05, 80.0)
    parts = [planner.step(periods)]
    planner.abort()
    parts.append(planner.run_to_end(20.0))
    positions = np.concatenate(parts)
    assert planner.status()["done"]
    if path:
        vmax = np.array([vel for vel, _ in limits] + [1.0] * 6)
        amax = np.array([acc for _, acc in limits] + [1.0] * 6)
        report = verify(positions, path, vmax, amax, DT, 0.05, stride=3)
        assert report.worst_velocity <= ROUNDING
        assert report.worst_acceleration <= ROUNDING
        assert report.deviation <= 0.05 + 1e-6
