"""What the components around a machine do: offsets, spindles, torches, supervision, trial moves."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import pytest

from hal._messages import hear
from tests.unit.hal.conftest import Bench

Load = Callable[..., Bench]


@pytest.fixture
def moveoff(component: Load) -> Bench:
    """Two joints, offsets allowed."""
    bench = component("moveoff", "names=mv", "personality=2", instance="mv")
    bench.set(power_on=True, move_enable=True, apply_offsets=True, pos_0=100.0, fb_0=200.0)
    hear()
    return bench


def step(bench: Bench, periods: int) -> list[tuple[float, float]]:
    """The offsets of both joints after each period."""
    ways = []
    for _ in range(periods):
        bench.run("mv.read-inputs")
        bench.run("mv.write-outputs")
        ways.append((bench.get("offset_current_0"), bench.get("offset_current_1")))
    return ways


def test_moveoff_reaches_the_offset_within_all_limits(moveoff: Bench) -> None:
    moveoff.set(offset_in_0=2.0, offset_in_1=-5.0, offset_min_1=-1.0, offset_vel_0=10.0, offset_accel_0=100.0)
    ways = step(moveoff, 1000)
    assert ways[-1] == (pytest.approx(2.0, abs=1e-4), pytest.approx(-1.0, abs=1e-4))
    assert max(a for a, _ in ways) <= 2.0 + 1e-6
    speeds = [(after[0] - before[0]) * 1000 for before, after in itertools.pairwise(ways)]
    assert max(speeds) <= 10.0 + 1e-6
    assert max(abs(b - a) for a, b in itertools.pairwise(speeds)) <= 100.0 * 1e-3 + 1e-6
    assert moveoff.get("pos_plusoffset_0") == pytest.approx(102.0, abs=1e-4)
    assert moveoff.get("fb_minusoffset_0") == pytest.approx(198.0, abs=1e-4)
    assert moveoff.get("offset_applied")


def test_moveoff_goes_back_by_the_way_it_came(moveoff: Bench) -> None:
    moveoff.set(offset_in_0=1.0)
    step(moveoff, 400)
    moveoff.set(offset_in_1=1.0)
    step(moveoff, 400)
    assert moveoff.get("waypoint_ct") > 5
    moveoff.set(move_enable=False)
    back = step(moveoff, 6000)
    assert back[-1] == (pytest.approx(0.0, abs=1e-3), pytest.approx(0.0, abs=1e-3))
    assert all(b < 0.1 for a, b in back if a < 0.5), "the second joint was back first"
    assert not moveoff.get("offset_applied")
    assert moveoff.get("waypoint_ct") == 0
    assert not moveoff.get("warning")


def test_moveoff_warns_when_offsets_are_taken_from_under_it(moveoff: Bench) -> None:
    moveoff.set(offset_in_0=1.0)
    step(moveoff, 300)
    moveoff.set(apply_offsets=False)
    step(moveoff, 1)
    assert moveoff.get("warning")
    assert hear() == ["moveoff: apply-offsets fell while offsets are applied; they are taken back now"]
    step(moveoff, 5000)
    assert not moveoff.get("warning")


def test_moveoff_stands_still_without_power_and_without_room(moveoff: Bench) -> None:
    moveoff.set(offset_in_0=5.0, dbg_waypoint_limit_test=True)
    step(moveoff, 1500)
    assert moveoff.get("waypoint_limit")
    assert moveoff.get("offset_current_0") < 5.0
    held = step(moveoff, 200)
    assert held[0] == held[-1]
    moveoff.set(move_enable=False)
    step(moveoff, 20)
    moveoff.set(power_on=False)
    still = step(moveoff, 50)
    assert still[0] == still[-1]


def test_a_spindle_ramps_turns_round_and_tells_when_it_is_there(component: Load) -> None:
    spindle = component("spindle", "numgears=2")
    gear = {"max": 600, "accel": 2000, "decel": 4000, "speed-tolerance": 1, "zero-tolerance": 1, "scale": 0.01}
    spindle.set(**{f"{name}.0": value for name, value in gear.items()})
    spindle.set(simulate_encoder=True, enable=True, commanded_speed=1000.0)
    spindle.run("spindle.0", 100)
    assert spindle.get("spindle_rpm") == pytest.approx(198.0)
    assert (spindle.get("at_speed"), spindle.get("forward"), spindle.get("limited")) == (False, True, True)
    spindle.run("spindle.0", 300)
    assert (spindle.get("at_speed"), spindle.get("output")) == (True, pytest.approx(6.0))
    spindle.set(commanded_speed=-300.0)
    spindle.run("spindle.0", 100)
    assert (spindle.get("brake"), spindle.get("forward")) == (True, True)
    spindle.run("spindle.0", 400)
    assert (spindle.get("reverse"), spindle.get("spindle_rpm")) == (True, pytest.approx(-300.0))
    spindle.set(enable=False)
    spindle.run("spindle.0", 200)
    assert (spindle.get("zero_speed"), spindle.get("forward"), spindle.get("reverse")) == (True, False, False)
    spindle.set(**{"select.1": True})
    spindle.run("spindle.0")
    assert spindle.get("current_gear") == 1


def test_thc_lowers_a_torch_with_too_many_volts_and_gives_it_back_on_the_way_up(component: Load) -> None:
    thc = component("thc", instance="thc")
    thc.set(enable=True, torch_on=True, arc_ok=True, requested_vel=10.0, current_vel=10.0, z_pos_in=5.0)
    thc.set(vel_scale=0.1, encoder_vel=1200.0, volts_requested=100.0, voltage_tol=5.0, correction_vel=0.01)
    thc.run("thc", 10)
    assert thc.get("volts") == pytest.approx(120.0)
    assert thc.get("z_pos_out") == pytest.approx(4.9)
    thc.set(current_vel=5.0)  # a corner
    thc.run("thc", 10)
    assert thc.get("z_pos_out") == pytest.approx(4.9)
    thc.set(torch_on=False)
    for n in range(1, 9):
        thc.set(z_pos_in=5.0 + 0.02 * n)
        thc.run("thc")
    assert thc.get("z_pos_out") == pytest.approx(5.16)


def test_a_message_is_said_at_its_edge_and_when_forced(component: Load) -> None:
    message = component("message", "names=m", "messages=Oil is low", instance="m")
    hear()
    message.run("m")
    message.set(trigger=True)
    message.run("m", 3)
    assert hear() == ["Oil is low"]
    message.set(force=True)
    message.run("m", 3)
    assert hear() == ["Oil is low"]


@pytest.mark.parametrize("name", ["steptest", "axistest"])
def test_a_trial_runs_to_and_fro_and_comes_back(component: Load, name: str) -> None:
    function = {"steptest": "steptest.0", "axistest": "axistest.0.update"}[name]
    trial = component(name)
    trial.set(maxvel=20.0, amplitude=0.5, run=True, **({"maxaccel": 500.0} if name == "steptest" else {}))
    places = []
    for n in range(1500):
        trial.set(run=n < 1000)
        trial.run(function)
        places.append(trial.get("position_cmd"))
        trial.set(position_fb=places[-1])
    assert max(places) == pytest.approx(0.5, abs=2e-3)
    assert min(places) == pytest.approx(-0.5, abs=2e-3)
    assert places[-1] == pytest.approx(0.0, abs=2e-3)
    assert not trial.get("running")


def test_thcud_takes_its_correction_back_on_the_way_up_no_faster_than_z(component: Callable[..., Bench]) -> None:
    bench = component("thcud", instance="thcud")
    bench.set(enable=1, torch_on=1, arc_ok=1, current_vel=10.0, requested_vel=10.0, torch_up=1, correction_vel=0.25)
    bench.run("thcud", 4)
    assert (bench.get("z-pos-out"), bench.get("vel-status")) == (1.0, True)
    bench.set(torch_on=0)
    heights = []
    for z in (0.0, -0.5, 0.0, 0.5, 2.0, 2.1):
        bench.set(z_pos_in=z)
        bench.run("thcud")
        heights.append((bench.get("z-pos-out") - z, bench.get("removing-offset"), bench.get("z-fb-out") == z))
    assert heights == [
        (1.0, False, True), (1.0, False, True), (0.5, True, True), (0.0, True, True), *[(0.0, False, True)] * 2
    ]  # fmt: skip


def test_thcud_lets_z_pass_when_it_is_off(component: Callable[..., Bench]) -> None:
    bench = component("thcud", instance="thcud")
    bench.set(torch_on=1, arc_ok=1, current_vel=10.0, requested_vel=10.0, torch_up=1, correction_vel=0.25, z_pos_in=3.0)
    bench.run("thcud", 4)
    assert bench.get("z-pos-out") == 3.0


def test_a_gantry_holds_the_joint_whose_switch_closes_first(component: Callable[..., Bench]) -> None:
    bench = component("gantry", "personality=2")
    bench.set(search_vel=-1.0)
    seen = []
    switches = ((0, 0), (0, 0), (1, 0), (1, 0), (1, 1), (0, 1), (0, 0))
    for command, (left, right) in zip((0.0, -1.0, -2.0, -3.0, -4.0, -3.0, -2.0), switches, strict=True):
        bench.set(**{"position_cmd": command, "joint.00.home": left, "joint.01.home": right})
        bench.run("gantry.0.read")
        bench.run("gantry.0.write")
        seen.append(tuple(map(bench.get, ("joint.00.pos-cmd", "joint.01.pos-cmd", "home", "limit"))))
    assert seen == [
        (0.0, 0.0, False, False), (-1.0, -1.0, False, False), (-1.0, -2.0, False, True), (-1.0, -3.0, False, True),
        (-2.0, -4.0, True, True), (-1.0, -3.0, True, True), (0.0, -2.0, False, False),
    ]  # fmt: skip


def test_ohmic_sees_contact_between_two_voltages_while_probing(component: Load) -> None:
    bench = component("ohmic")
    bench.set(thcad_0_volt_freq=100000.0, thcad_max_volt_freq=900000.0, thcad_divide=32.0, is_probing=True)
    seen = []
    for volts in (0.0, 17.0, 19.0, 6.0, 4.9):
        bench.set(velocity_in=(100000.0 + 800000.0 * volts / (5.0 * 4.9)) / 32.0)
        bench.run("ohmic.0")
        assert bench.get("ohmic_volts") == pytest.approx(volts)
        seen.append(bench.get("ohmic_on"))
    assert seen == [False, False, True, True, False]
    bench.set(is_probing=False, velocity_in=900000.0 / 32.0)
    bench.run("ohmic.0")
    assert (bench.get("arc_on"), bench.get("ohmic_on")) == (True, False)


def test_threadtest_counts_between_resets(component: Load) -> None:
    bench = component("threadtest")
    bench.run("threadtest.0.increment", 7)
    assert bench.get("count") == 7
    bench.run("threadtest.0.reset")
    assert bench.get("count") == 0
