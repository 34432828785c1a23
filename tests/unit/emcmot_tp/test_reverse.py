"""The planner runs back along the path that it has executed, within all limits, and forwards again."""

import numpy as np
import pytest

from emcmot.tp.verifier import differences
from tests.support.planned import AMAX, DT, ROUNDING, VMAX, Program, come_to_rest


def turn(planner, back):
    assert planner.reverse(back)
    planner.resume()


def check_limits(positions, start):
    velocity, acceleration = differences(positions, start, DT)
    assert np.all(np.abs(velocity) <= VMAX * ROUNDING)
    assert np.all(np.abs(acceleration) <= AMAX * ROUNDING)


def curve(**defaults):
    """Lines, arcs and rounded corners; 300 and some mm."""
    program = Program(tolerance=0.05, **defaults)
    program.line(30, 0).line(30, 20).arc((10, 20), (20, 20, 0)).line(0, 0, 5)
    for k in range(1, 60):
        program.line(0.5 * k, 3 * np.sin(0.2 * k), 5)
    center = (29.5, 0.5 * (20 + program.at[1]), 5)
    return program.arc((29.5, 20, 8), center, turn=1).line(0, 0, 0)


def distance_from(positions, q):
    """Distance of a point from the polyline of the positions."""
    a, b = positions[:-1], positions[1:]
    way = b - a
    t = np.clip(np.sum((q - a) * way, axis=1) / np.maximum(np.sum(way * way, axis=1), 1e-30), 0, 1)
    return np.sqrt(np.min(np.sum((a + t[:, None] * way - q) ** 2, axis=1)))


@pytest.mark.parametrize("periods", [150, 700, 1500, 2600, 4000])
def test_the_way_back_is_the_way_there_and_ends_at_its_start(periods):
    program = curve()
    planner = program.planner
    there = np.vstack([np.zeros((1, 9)), planner.step(periods), come_to_rest(planner)])
    turn(planner, True)
    assert planner.status()["reversing"]
    back = planner.step(len(there) + 500)
    check_limits(np.vstack([there[1:], back]), np.zeros(9))
    assert np.array_equal(back[-1], np.zeros(9))
    assert max(distance_from(there, q) for q in back[::7]) < 0.5 * AMAX.max() * DT**2
    assert not planner.status()["done"]


def test_back_and_forward_again_ends_where_the_program_ends():
    program = curve()
    planner = program.planner
    parts = [planner.step(2000), come_to_rest(planner)]
    turn(planner, True)
    parts += [planner.step(900), come_to_rest(planner)]
    turn(planner, False)
    parts.append(program.run())
    positions = np.vstack(parts)
    check_limits(positions, np.zeros(9))
    assert np.array_equal(positions[-1], program.path[-1].end)
    assert not planner.status()["reversing"]


def test_a_finished_program_is_run_back_and_finished_again():
    program = curve()
    planner = program.planner
    there = program.run()
    planner.pause()
    turn(planner, True)
    back = np.vstack([planner.step(1200), come_to_rest(planner)])
    assert not planner.status()["done"]
    turn(planner, False)
    again = program.run()
    check_limits(np.vstack([there, back, again]), np.zeros(9))
    assert np.array_equal(again[-1], program.path[-1].end)
    assert planner.status()["done"]


def test_the_way_back_stops_at_corners_that_were_stops():
    program = Program(tolerance=0.0, term=1)
    program.line(10).line(10, 10).line(0, 10)
    planner = program.planner
    there = np.vstack([planner.step(850), come_to_rest(planner)])
    turn(planner, True)
    back = planner.step(2000)
    check_limits(np.vstack([there, back]), np.zeros(9))
    assert np.min(np.max(np.abs(back[:, :2] - [10, 10]), axis=1)) < 1e-3
    assert np.min(np.max(np.abs(back[:, :2] - [10, 0]), axis=1)) < 1e-3


def test_ids_count_down_and_a_step_back_runs_one_move():
    program = Program(tolerance=0.01)
    for k in range(1, 11):
        program.line(10 * (k % 2), 5 * k)
    planner = program.planner
    planner.step(1500)
    come_to_rest(planner)
    before = planner.status()["id"]
    assert before > 3
    assert planner.reverse(True)
    planner.step_once()
    planner.step(2000)
    status = planner.status()
    assert status["paused"]
    assert status["id"] == before - 1


def test_an_override_holds_on_the_way_back():
    program = Program(tolerance=0.01).line(100, vel=40.0, vel_max=90.0)
    planner = program.planner
    planner.step(1500)
    come_to_rest(planner)
    planner.feed_scale(0.5)
    turn(planner, True)
    planner.step(200)
    assert planner.status()["current_vel"] == pytest.approx(20.0)
    assert planner.status()["vel"][0] == pytest.approx(-20.0)


def test_an_abort_on_the_way_back_ends_the_reverse_run_and_forgets_the_path():
    program = curve()
    planner = program.planner
    parts = [planner.step(1500), come_to_rest(planner)]
    turn(planner, True)
    parts.append(planner.step(300))
    planner.abort()
    parts.append(program.run())
    check_limits(np.vstack(parts), np.zeros(9))
    assert planner.status()["done"]
    assert not planner.status()["reversing"]
    assert not planner.reverse(True)
    assert planner.add_line(np.zeros(9), 50.0)
    assert np.array_equal(program.run()[-1], np.zeros(9))


def test_turning_is_refused_while_the_machine_moves_and_where_nothing_was_executed():
    program = curve()
    planner = program.planner
    assert not planner.reverse(True)
    planner.step(500)
    assert not planner.reverse(True)
    come_to_rest(planner)
    turn(planner, True)
    planner.step(100)
    assert not planner.reverse(False)


def test_the_way_back_ends_before_a_threading_move():
    program = Program(tolerance=0.01)
    planner = program.planner
    planner.spindle(0, 0.0, 10.0)
    program.line(10).line(20, spindle=0, sync_revs=1.0, sync_velocity=True).line(30).line(30, 10)
    program.run()
    planner.pause()
    turn(planner, True)
    assert 19.9 < planner.step(4000)[-1, 0] < 20.1


def test_the_way_back_is_as_long_as_the_history_in_a_long_program_that_goes_on_being_fed():
    program = Program(tolerance=0.01)
    planner = program.planner
    count = 0

    def feed():
        nonlocal count
        while planner.status()["free"] > 0:
            count += 1
            end = np.zeros(9)
            end[:2] = 0.05 * count, 5 * np.sin(0.01 * count)
            assert planner.add_line(end, 80.0, tolerance=0.01, id=count)

    parts = []
    for _ in range(40):
        feed()
        parts.append(planner.step(200))
    parts.append(come_to_rest(planner))
    place = parts[-1][-1, 0]
    turn(planner, True)
    for _ in range(40):
        parts.append(planner.step(200))
        feed()
    assert planner.status()["current_vel"] == 0.0
    assert parts[-1][-1, 0] < place - 20.0
    planner.pause()
    turn(planner, False)
    parts.append(program.run())
    positions = np.vstack(parts)
    check_limits(positions, np.zeros(9))
    assert positions[-1, 0] == 0.05 * count


@pytest.mark.parametrize(("jerk", "moves"), [(0.0, 30), (50_000.0, 10)])
def test_the_way_back_is_whole_while_the_queue_is_full(jerk, moves):
    program = Program(tolerance=0.01)
    planner = program.planner
    for axis in range(9):
        planner.set_limits(axis, VMAX[axis], AMAX[axis], jerk)
    planner.limit_jerk(jerk > 0.0)
    points = [(0.2 * (k % 2), 0.01 * k, 0) for k in range(1, 6001)]
    parts, given = [], 0
    while planner.status()["id"] < 1500:
        while given < len(points) and planner.add_line([*points[given], *[0] * 6], 60.0, tolerance=0.01, id=given + 1):
            given += 1
        parts.append(planner.step(50))
    assert planner.status()["depth"] > 3900
    parts.append(come_to_rest(planner))
    there = np.vstack(parts)
    assert planner.reverse(True)
    planner.resume()
    back = planner.step(1500)
    assert back[-1, 1] < there[-1, 1] - 0.01 * moves
    assert max(distance_from(there, q) for q in back[::7]) < 0.5 * AMAX.max() * DT**2
