"""Whatever moves and commands come at whatever time, no limit breaks and the path stays within tolerance.

Each property is asked for twice: with limits of velocity and acceleration only, and of jerk too.
"""

import os

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.support.planned import Job

EXAMPLES = int(os.environ.get("PYEMC_EXAMPLES", "10"))  # of each property; hundreds find more
SETTINGS = settings(max_examples=EXAMPLES, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True)
KINDS = pytest.mark.parametrize("jerk", [False, True], ids=["acceleration", "jerk"])
STANDING = 8000  # periods in which any job comes to rest
AT_LAST = (("reverse", False), ("resume",), ("feed_hold", False), ("feed_scale", 1.0), ("vel_limit", 0.0))

coordinate = st.one_of(st.floats(-8, 8), st.integers(-4, 4).map(float), st.integers(-3, 3).map(lambda k: k * 0.001))
needle = st.tuples(st.just(0.0), st.integers(-2, 2).map(lambda k: 2.0 * k), st.just(0.0), st.just(0.0))
point = st.one_of(st.tuples(coordinate, coordinate, coordinate, st.sampled_from([0.0, 0.0, 5.0, -20.0])), needle)
turn = st.sampled_from([None, None, 0, -1])  # an arc turns that way, half round the middle of its chord
limit = st.tuples(st.floats(20, 150), st.floats(100, 2000), st.floats(2000, 100_000))
limits = st.tuples(limit, limit, limit, limit)
tolerance = st.sampled_from([0.002, 0.02, 0.2, 2.0])
feed = st.floats(5, 120)
command = st.tuples(
    st.integers(1, 200),
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
            ("reverse", True),
            ("reverse", False),
        ]
    ),
)


@KINDS
@SETTINGS
@given(moves=st.lists(st.tuples(point, turn), min_size=1, max_size=20), limits=limits, tolerance=tolerance, feed=feed)
def test_any_chain_of_moves_keeps_every_limit_and_arrives(jerk, moves, limits, tolerance, feed):
    job = Job(limits, tolerance, feed, jerk)
    for move in moves:
        job.add(*move)
    job.check_to_the_end(job.planner.run_to_end(300.0))


@KINDS
@SETTINGS
@given(
    moves=st.lists(st.tuples(point, turn), min_size=1, max_size=15),
    commands=st.lists(command, max_size=25),
    limits=limits,
    feed=feed,
)
def test_commands_at_any_instant_break_nothing(jerk, moves, commands, limits, feed):
    job = Job(limits, 0.02, feed, jerk)
    for move in moves:
        job.add(*move)
    parts = []
    for periods, (name, *arguments) in commands:
        parts.append(job.planner.step(periods))
        getattr(job.planner, name)(*arguments)
    job.planner.pause()
    parts.append(job.planner.step(STANDING))
    for name, *arguments in AT_LAST:
        getattr(job.planner, name)(*arguments)
    parts.append(job.planner.run_to_end(300.0))
    job.check_to_the_end(np.concatenate(parts))


@KINDS
@SETTINGS
@given(
    moves=st.lists(st.tuples(point, turn, st.integers(0, 200)), min_size=2, max_size=20),
    limits=limits,
    tolerance=tolerance,
)
def test_moves_that_arrive_late_are_joined_without_a_jolt(jerk, moves, limits, tolerance):
    job, parts = Job(limits, tolerance, 60.0, jerk), []
    for end, turn, periods in moves:
        job.add(end, turn)
        parts.append(job.planner.step(periods))
    parts.append(job.planner.run_to_end(300.0))
    job.check_to_the_end(np.concatenate(parts))


@KINDS
@SETTINGS
@given(
    moves=st.lists(st.tuples(point, turn), min_size=1, max_size=15),
    limits=limits,
    periods=st.integers(1, 1500),
)
def test_an_abort_at_any_instant_comes_to_rest_within_limits(jerk, moves, limits, periods):
    job = Job(limits, 0.05, 80.0, jerk)
    for move in moves:
        job.add(*move)
    parts = [job.planner.step(periods)]
    job.planner.abort()
    parts.append(job.planner.run_to_end(20.0))
    job.check(np.concatenate(parts))
