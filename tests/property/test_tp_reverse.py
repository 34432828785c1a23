"""Whenever the direction of a run is switched, no limit breaks, the path stays within tolerance and its end is hit."""

import os

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.support.planned import Job, come_to_rest

TOLERANCE = 0.02
EXAMPLES = int(os.environ.get("PYEMC_EXAMPLES", "15"))
SETTINGS = settings(max_examples=EXAMPLES, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True)

coordinate = st.one_of(st.floats(-8, 8), st.integers(-4, 4).map(float))
point = st.tuples(coordinate, coordinate, coordinate)
limit = st.tuples(st.floats(20, 150), st.floats(100, 2000))
command = st.tuples(
    st.integers(1, 250),
    st.sampled_from(
        [
            ("turn", True),
            ("turn", True),
            ("turn", False),
            ("feed_scale", 0.0),
            ("feed_scale", 0.3),
            ("feed_scale", 1.0),
            ("feed_scale", 1.9),
            ("vel_limit", 15.0),
            ("pause",),
            ("resume",),
            ("step_once",),
        ]
    ),
)


@SETTINGS
@given(
    moves=st.lists(st.tuples(point, st.sampled_from([None, None, 0, -1]), st.booleans()), min_size=3, max_size=12),
    commands=st.lists(command, min_size=3, max_size=25),
    limits=st.tuples(limit, limit, limit),
    feed=st.floats(10, 120),
)
def test_turning_round_at_any_place_breaks_nothing(moves, commands, limits, feed):
    job, late = Job(limits, TOLERANCE, feed), []
    for end, turn, now in moves:
        if now and not late:
            job.add(end, turn)
        else:
            late.append((end, turn))
    parts = [job.planner.step()]
    for periods, (name, *arguments) in commands:
        parts.append(job.planner.step(periods))
        if late:
            job.add(*late.pop(0))
        if name == "turn":
            parts.append(come_to_rest(job.planner))
            job.planner.reverse(*arguments)
            job.planner.resume()
        else:
            getattr(job.planner, name)(*arguments)
    for move in late:
        job.add(*move)
    job.planner.feed_scale(1.0)
    job.planner.vel_limit(0.0)
    parts.append(come_to_rest(job.planner))
    assert job.planner.reverse(False)
    job.planner.resume()
    parts.append(job.planner.run_to_end(300.0))
    job.check_to_the_end(np.concatenate(parts))
