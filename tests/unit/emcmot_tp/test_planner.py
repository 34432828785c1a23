"""The planner cuts programmed paths within tolerance and limits; checked by the independent verifier."""

import math

import numpy as np
import pytest

from emcmot.tp.planner import TERM_STOP, TERM_TANGENT, Planner, PlannerError
from emcmot.tp.verifier import verify
from tests.support.planned import AMAX, DT, ROUNDING, VMAX, Program


def square(program, size=20.0):
    return program.line(size, 0, 0).line(size, size, 0).line(0, size, 0).line(0, 0, 0)


def test_a_straight_move_takes_the_least_time_that_its_limits_allow():
    program = Program().line(60, 0, 0, vel=80.0)
    report = program.check(program.run(), 0.0)
    assert report.seconds == pytest.approx(60 / 80 + 80 / 500, abs=2 * DT)


def test_a_short_move_accelerates_half_way_and_brakes_the_other_half():
    program = Program().line(1, 0, 0)
    report = program.check(program.run(), 0.0)
    assert report.seconds == pytest.approx(2 * math.sqrt(1 / 500), abs=2 * DT)


def test_the_feed_counts_the_xyz_way_when_rotary_axes_move_along():
    program = Program().line(40, 30, 0, 10, 0, 0, vel=10.0)
    assert program.check(program.run(), 0.0).seconds == pytest.approx(5.0, abs=0.05)


def test_the_feed_of_a_pure_rotary_move_counts_degrees():
    program = Program().line(0, 0, 0, 90, 0, 0, vel=45.0)
    assert program.check(program.run(), 0.0).seconds == pytest.approx(90 / 45 + 45 / 300, abs=2 * DT)


@pytest.mark.parametrize("tolerance", [0.001, 0.01, 0.1, 1.0])
def test_corners_are_rounded_within_the_tolerance(tolerance):
    program = square(Program(tolerance=tolerance))
    report = program.check(program.run(), tolerance)
    assert report.corner > 0.5 * min(tolerance, 0.5)


def test_square_corners_take_the_least_time_that_the_tolerance_allows():
    program, a, tolerance = Program(tolerance=0.01, vel=90.0, vel_max=90.0), 400.0, 0.01
    for axis in (0, 1):
        program.planner.set_limits(axis, 90.0, a)
    for k in range(10):
        program.line(20.0 * ((k + 1) % 2), k).line(20.0 * ((k + 1) % 2), k + 1)
    report = program.check(program.run(), tolerance)
    both = math.sqrt(8 * tolerance / (math.sqrt(2) * a))  # both axes accelerate, and pass the corner at the tolerance
    assert report.seconds == pytest.approx(10 * (20 / 90 + 90 / a + 2 * math.sqrt(1 / a)) - 19 * both, abs=2 * DT)


def test_a_larger_tolerance_takes_less_time():
    times = [len(square(Program(tolerance=t)).run()) for t in (0.001, 0.01, 0.1, 0.5)]
    assert times == sorted(times, reverse=True)
    assert times[0] > times[-1] + 20


def test_without_a_tolerance_corners_are_rounded_as_far_as_the_speed_needs():
    program = square(Program())
    positions = program.run()
    report = verify(positions, program.path, VMAX, AMAX, DT, 5.0)
    assert report.worst_acceleration <= ROUNDING
    assert 0.5 < report.corner < 5.0
    assert report.end == 0.0


@pytest.mark.parametrize("term", [TERM_STOP, TERM_TANGENT])
def test_exact_modes_pass_through_every_corner(term):
    program = square(Program(term=term))
    assert program.check(program.run(), 1e-9).corner < 1e-3


def test_exact_path_runs_through_a_tangent_joint_and_exact_stop_does_not():
    def time(term):
        program = Program(term=term).line(20, 0, 0).line(40, 0, 0).arc((50, 10, 0), (40, 10, 0))
        return program.check(program.run(), 1e-6).seconds

    assert time(TERM_STOP) > time(TERM_TANGENT) + 0.05


@pytest.mark.parametrize(
    ("end", "center", "turn"),
    [
        ((20, 0, 0), (10, 0, 0), 0),
        ((20, 0, 0), (10, 0, 0), -1),
        ((0, 0, 0), (5, 5, 0), 0),
        ((0, 0, 0), (5, 5, 0), -1),
        ((10, 10, -6), (10, 0, 0), 2),
        ((0, 14, 3), (0, 6, 0), -3),
        ((0.2, 0, 0), (0.1, 0, 0), 0),
        ((400, 400, 0), (400, 0, 0), -1),
    ],
    ids=["half", "half cw", "full", "full cw", "helix", "spiral cw", "tiny", "huge"],
)
def test_arcs_helices_and_spirals_keep_path_and_limits(end, center, turn):
    program = Program().arc(end, center, turn=turn)
    program.check(program.run(), 1e-6, stride=5)


def test_arcs_in_other_planes_carry_other_axes_along():
    program = Program().arc((0, 10, 10, 45, 0, 0, 5, 0, 0), (0, 0, 10), normal=(1, 0, 0))
    program.check(program.run(), 1e-6)


def test_a_full_circle_runs_at_the_speed_that_its_radius_allows():
    program = Program().arc((0, 0, 0), (0, 20, 0), vel=200.0, vel_max=200.0)
    report = program.check(program.run(), 1e-6)
    assert report.worst_acceleration > 0.98


@pytest.mark.parametrize("tolerance", [0.005, 0.05, 0.5])
def test_lines_and_arcs_meet_within_the_tolerance(tolerance):
    program = Program(tolerance=tolerance).line(20, 0, 0).arc((30, 10, 0), (20, 10, 0)).line(30, 20, 0)
    program.arc((20, 20, 0), (25, 20, 0), turn=-1).arc((0, 20, 3), (10, 20, 0), turn=0).line(0, 0, 0).arc(
        (0, 0, 0), (5, 5, 0), turn=0
    )
    program.check(program.run(), tolerance)


def test_rotary_and_linear_moves_blend_into_each_other():
    program = Program(tolerance=0.05).line(20, 0, 0).line(20, 0, 0, 30).line(0, 0, 0, 30).line(0, 10, 0, 0, 0, 0, 20)
    program.line(0, 10, 0, 0, 0, 0, 20, 5, 0)
    program.check(program.run(), 0.05)


def test_reversals_and_needles_stay_within_tolerance_and_limits():
    program = Program(tolerance=0.02).line(20, 0, 0).line(0, 0, 0).line(20, 0.001, 0).line(0, 0, 0)
    for k in range(40):
        program.line(5 if k % 2 else 0, 0.01 * k, 0)
    program.check(program.run(), 0.02)


def test_moves_of_no_length_change_nothing():
    program = Program(tolerance=0.01).line(10, 0, 0).line(10, 0, 0).line(10, 0, 0).line(20, 1, 0)
    with_them = program.run()
    program = Program(tolerance=0.01).line(10, 0, 0).line(20, 1, 0)
    assert np.array_equal(with_them, program.run())


def test_chains_of_tiny_segments_are_cut_at_the_speed_of_the_curve():
    program = Program(start=(50, 0, 0), tolerance=0.005)
    for angle in np.arange(1, 1201) * 0.001:
        program.line(50 * math.cos(angle), 50 * math.sin(angle), 0)
    report = program.check(program.run(), 0.005)
    assert report.seconds < 60 / 60 + 60 / 500 * 1.4


def test_a_queue_that_runs_dry_stops_at_its_end_and_goes_on_later():
    program = Program(tolerance=0.1).line(10, 0, 0)
    parts = []
    for k in range(30):
        parts.append(program.planner.step(37 + 5 * k))
        program.line(10 + (k + 1) * 2.0, (k % 2) * 2.0, 0)
    parts.append(program.run())
    program.check(np.concatenate(parts), 0.1)


@pytest.mark.parametrize("seed", range(3))
def test_overrides_pauses_and_holds_at_any_instant_break_no_limit(seed):
    random = np.random.default_rng(seed)
    program = Program(tolerance=0.02)
    for _ in range(60):
        end = random.uniform(-15, 15, 3)
        if random.random() < 0.3:
            middle = (program.at[:2] + end[:2]) / 2
            program.arc((end[0], end[1], end[2]), (*middle, program.at[2]), turn=int(random.integers(-1, 1)))
        else:
            program.line(*end)
    parts, planner = [], program.planner
    while not planner.status()["done"] and len(parts) < 4000:
        parts.append(planner.step(int(random.integers(1, 60))))
        match random.integers(0, 8):
            case 0:
                planner.feed_scale(random.choice([0.0, 0.1, 0.5, 1.0, 1.3, 2.0]))
            case 1:
                planner.pause()
            case 2 | 3:
                planner.resume()
                planner.feed_scale(1.0)
            case 4:
                planner.feed_hold(True)
            case 5:
                planner.feed_hold(False)
            case 6:
                planner.step_once()
            case 7:
                planner.adaptive_scale(random.choice([0.3, 1.0]))
        if not planner.status()["id"]:
            break
    planner.resume()
    planner.feed_hold(False)
    planner.feed_scale(1.0)
    parts.append(program.run())
    program.check(np.concatenate(parts), 0.02, stride=7)


def test_pause_comes_to_rest_on_the_path_and_resume_goes_on():
    program = square(Program(tolerance=0.01))
    first = program.planner.step(250)
    program.planner.pause()
    rest = program.planner.step(300)
    assert np.array_equal(rest[-1], rest[-2])
    assert program.planner.status()["paused"]
    program.planner.resume()
    program.check(np.concatenate([first, rest, program.run()]), 0.01)


def test_a_pause_ends_in_rest_to_the_last_bit_whatever_the_acceleration():
    for k in range(300):
        program = Program()
        program.planner.set_limits(0, 200.0, 1000.0 - 3.1 * k)
        program.line(20, vel=10.0).line(160, vel=10.0)
        program.planner.step(50 + 11 * k)
        program.planner.pause()
        program.planner.step(200)
        assert program.planner.reverse(True), k  # which is taken at rest only


def test_abort_comes_to_rest_on_the_path_and_drops_the_queue():
    program = square(Program(tolerance=0.01))
    positions = program.planner.step(250)
    program.planner.abort()
    positions = np.concatenate([positions, program.planner.step(400)])
    status = program.planner.status()
    assert status["done"]
    assert status["depth"] == 0
    report = verify(positions, program.path, VMAX, AMAX, DT, 0.01)
    assert report.worst_acceleration <= ROUNDING
    assert report.deviation <= 0.01
    program.planner.add_line(positions[-1] + 1.0, 10.0)
    assert np.allclose(program.run()[-1], positions[-1] + 1.0)


def test_a_step_runs_one_segment_and_holds():
    program = square(Program(tolerance=0.01))
    planner = program.planner
    planner.pause()
    planner.step(1)
    seen = []
    for _ in range(3):
        planner.step_once()
        planner.step(1500)
        assert planner.status()["paused"]
        seen.append(planner.status()["id"])
    assert seen == [2, 3, 4]


def test_the_feed_override_scales_the_speed_and_zero_stops():
    program = Program().line(200, 0, 0, vel=20.0, vel_max=90.0)
    planner = program.planner
    speeds = []
    for scale in (1.0, 0.5, 2.0, 10.0, 0.0):
        planner.feed_scale(scale)
        planner.step(400)
        speeds.append(planner.status()["current_vel"])
    assert speeds == pytest.approx([20, 10, 40, 90, 0], abs=1e-6)


def test_status_names_the_executing_segment_and_its_distance_to_go():
    program = square(Program(tolerance=0.01))
    planner, seen = program.planner, []
    while not planner.status()["done"]:
        planner.step(5)
        status = planner.status()
        if status["id"]:
            seen.append(status["id"])
            end = program.path[status["id"] - 1].end
            assert np.allclose(status["dtg"], end - np.array(status["pos"]))
    assert list(dict.fromkeys(seen)) == [1, 2, 3, 4]
    assert planner.status()["motion_type"] == 0


def test_the_queue_takes_what_it_says_is_free():
    planner = Planner(DT, 100)
    count = 0
    while planner.add_line((count + 1.0, 0, 0), 10.0):
        count += 1
        assert planner.status()["free"] == 100 - count
    assert count == 100


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_moves_that_are_no_moves_are_refused(bad):
    planner = Planner(DT, 10)
    with pytest.raises(PlannerError):
        planner.add_line((bad, 0, 0), 10.0)
    with pytest.raises(PlannerError):
        planner.add_line((1, 0, 0), bad)
    with pytest.raises(PlannerError):
        planner.add_line((1, 0, 0), 0.0)
    with pytest.raises(PlannerError):
        planner.add_arc((1, 0, 0), (0, 0, 0), (0, 0, 1), 0, 10.0)
    with pytest.raises(PlannerError):
        planner.add_arc((1, 0, 0), (2, 0, 0), (0, 0, 0), 0, 10.0)
    assert planner.status()["depth"] == 0


@pytest.mark.parametrize("dt", [0.0005, 0.001, 0.004])
def test_limits_hold_at_any_servo_period(dt):
    program = square(Program(dt=dt, tolerance=0.05)).arc((20, 0, 0), (10, 0, 0))
    program.check(program.run(), 0.05)


def test_slow_moves_of_any_length_reach_their_end():
    random = np.random.default_rng(5)
    for _ in range(400):
        planner = Planner(0.004, 10)
        planner.set_limits(0, 100.0, 10 ** random.uniform(2, 4))
        length = random.uniform(0.001, 0.5)
        planner.add_line((length,), 10 ** random.uniform(-0.7, 1))
        planner.run_to_end(20.0)
        assert planner.status()["done"], length


@pytest.mark.parametrize("radius", [0.11, 0.49, 0.94, 1.07, 2.38, 3.94])
def test_a_program_that_ends_with_an_arc_comes_to_its_end(radius):
    program = Program(tolerance=0.02).line(3, 0, 0).arc((3 + radius, radius, 0), (3, radius, 0))
    positions = program.planner.run_to_end(10.0)
    assert program.planner.status()["done"]
    program.check(positions, 0.02)


def test_a_short_queue_of_tiny_moves_that_is_refilled_keeps_the_limits():
    program, count, parts = Program(), 3000, []
    program.planner = Planner(DT, 300)
    for axis in range(9):
        program.planner.set_limits(axis, VMAX[axis], AMAX[axis])
    while len(program.path) < count or not program.planner.status()["done"]:
        for _ in range(min(program.planner.status()["free"], count - len(program.path))):
            angle = 2e-4 * (len(program.path) + 1)
            program.line(100 * math.cos(angle) - 100, 100 * math.sin(angle), 0, vel=80.0, tolerance=0.0005)
        parts.append(program.planner.step(20))
    report = program.check(np.concatenate(parts), 0.0005, stride=9)
    assert report.seconds < 1.6 * count * 0.02 / 80.0
