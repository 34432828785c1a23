"""Whenever the direction of a run is switched, no limit breaks, the path stays within tolerance and its end is hit."""

import os

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from emcmot.tp.planner import Planner
from emcmot.tp.verifier import Arc, Line, differences
from tests.support.planned import DT, ROUNDING, come_to_rest

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


def add(planner, path, at, end, bulge, feed):
    """A line, or where `bulge` is given a half turn about the middle of the chord."""
    end9 = np.zeros(9)
    end9[:3] = end
    if bulge is None or np.hypot(*(end9[:2] - at[:2])) < 1e-3:
        assert planner.add_line(end9, feed, tolerance=TOLERANCE, vel_max=feed * 2, id=len(path) + 1)
        path.append(Line(at, end9))
    else:
        center = np.array([*(at[:2] + end9[:2]) / 2, at[2]])
        assert planner.add_arc(end9, center, (0, 0, 1), bulge, feed, tolerance=TOLERANCE, vel_max=feed * 2)
        path.append(Arc(at, end9, center, np.array([0.0, 0, 1]), bulge))
    return end9


@SETTINGS
@given(
    moves=st.lists(
        st.tuples(point, st.sampled_from([None, None, 0, -1]), st.booleans()), min_size=3, max_size=12
    ),
    commands=st.lists(command, min_size=3, max_size=25),
    limits=st.tuples(limit, limit, limit),
    feed=st.floats(10, 120),
)
def test_turning_round_at_any_place_breaks_nothing(moves, commands, limits, feed):
    planner, path, at, late = Planner(DT, 500), [], np.zeros(9), []
    for axis, (vel, acc) in enumerate(limits):
        planner.set_limits(axis, vel, acc)
    for end, bulge, now in moves:
        if now and not late:
            at = add(planner, path, at, end, bulge, feed)
        else:
            late.append((end, bulge))
    parts = [planner.step()]
    for periods, (name, *arguments) in commands:
        parts.append(planner.step(periods))
        if late:
            at = add(planner, path, at, *late.pop(0), feed)
        if name == "turn":
            parts.append(come_to_rest(planner))
            planner.reverse(*arguments)
            planner.resume()
        else:
            getattr(planner, name)(*arguments)
    for end, bulge in late:
        at = add(planner, path, at, end, bulge, feed)
    planner.feed_scale(1.0)
    planner.vel_limit(0.0)
    parts.append(come_to_rest(planner))
    assert planner.reverse(False)
    planner.resume()
    parts.append(planner.run_to_end())
    positions = np.concatenate(parts)
    velocity, acceleration = differences(positions, np.zeros(9), DT)
    for axis, (vel, acc) in enumerate(limits):
        assert np.abs(velocity[:, axis]).max() <= vel * ROUNDING
        assert np.abs(acceleration[:, axis]).max() <= acc * ROUNDING
    assert np.array_equal(positions[-1], at)
    stride = max(1, len(positions) // 500)
    assert max(min(move.distance(q) for move in path) for q in positions[::stride]) <= TOLERANCE + 1e-6
