"""What the components around motors do: pulses, encoders, control, simulated hardware."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import pytest

from tests.unit.hal.conftest import Bench

Load = Callable[..., Bench]


def test_pid_adds_its_terms_and_keeps_its_limit(component: Load) -> None:
    bench = component("pid", "num_chan=1")
    bench.set(enable=True, error_previous_target=False, command=1.0, Pgain=2.0, Igain=100.0, FF0=0.5, bias=0.25)
    bench.run("pid.0.do-pid-calcs")
    assert bench.get("output") == pytest.approx(0.25 + 2.0 + 100.0 * 1e-3 + 0.5)
    bench.set(maxoutput=1.0)
    bench.run("pid.0.do-pid-calcs", 5)
    assert (bench.get("output"), bench.get("saturated"), bench.get("saturated_count")) == (1.0, True, 5)
    bench.set(enable=False)
    bench.run("pid.0.do-pid-calcs")
    assert bench.get("output") == 0.0


def plant(bench: Bench, seconds: float) -> list[float]:
    """Three lags in a row behind the pid, such as an oven; its temperature each period."""
    stages = [0.0, 0.0, 0.0]
    got = []
    for _ in range(int(seconds / 1e-3)):
        bench.set(feedback=stages[2])
        bench.run("pid.0.do-pid-calcs")
        before = bench.get("output")
        for i, stage in enumerate(stages):
            stages[i] += (before - stage) * 0.02
            before = stages[i]
        got.append(stages[2])
    return got


def test_pid_tunes_itself_and_then_controls(component: Load) -> None:
    bench = component("pid", "num_chan=1")
    bench.set(enable=True, tune_mode=True, tune_start=True, tune_cycles=10, tune_effort=2.0, command=0.5)
    plant(bench, 10.0)
    assert bench.get("tune_start") is False
    assert bench.get("Igain") > 0.0
    bench.set(tune_mode=False)
    assert plant(bench, 5.0)[-1] == pytest.approx(0.5, abs=0.001)


def test_stepgen_reaches_its_command_and_follows_it(component: Load) -> None:
    bench = component("stepgen", "step_type=0")
    bench.set(enable=True, position_scale=1000.0, maxaccel=50.0, maxvel=4.0)
    position = 0.0
    steps = 0
    old_step = False
    for n in range(18000):
        position = min(0.0002 * n, 3.0)
        if n % 10 == 0:
            bench.set(position_cmd=position)
            bench.run("stepgen.update-freq")
        bench.run("stepgen.make-pulses", period_ns=100_000)
        bench.run("stepgen.capture-position")
        step = bench.get("step")
        if step and not old_step:
            steps += -1 if bench.get("dir") else 1
        old_step = step
    assert bench.get("counts") == 3000 == steps
    assert bench.get("position_fb") == pytest.approx(3.0, abs=0.001)


@pytest.mark.parametrize(("type_", "phases"), [(2, "AB"), (4, "ABC"), (9, "ABCD"), (14, "ABCDE")])
def test_stepgen_phases_change_with_every_step(component: Load, type_: int, phases: str) -> None:
    bench = component("stepgen", f"step_type={type_}", "ctrl_type=v")
    bench.set(enable=True, velocity_cmd=5000.0)
    seen = []
    for _ in range(60):
        bench.run("stepgen.update-freq", period_ns=100_000)
        bench.run("stepgen.make-pulses", period_ns=100_000)
        bench.run("stepgen.capture-position")
        seen.append((bench.get("counts"), tuple(bench.get(f"phase_{p}") for p in phases)))
    states = list(dict.fromkeys(seen))
    assert len({count for count, _ in states}) == len(states) > 8
    assert all(a[1] != b[1] for a, b in pairwise(states))


def test_sim_encoder_and_encoder_agree(component: Load) -> None:
    bench = component("sim_encoder", "num_chan=1")
    bench.load("encoder", "num_chan=1")
    for phase in "ABZ":
        bench.hal.net(phase, [f"sim-encoder.0.phase-{phase}", f"encoder.0.phase-{phase}"])
    bench.hal.set_item("sim-encoder.0.speed", "10")
    bench.hal.set_item("encoder.0.position-scale", "400")
    for n in range(4000):
        if n % 20 == 0:
            bench.run("sim-encoder.update-speed")
            bench.run("encoder.capture-position")
        bench.run("sim-encoder.make-pulses", period_ns=50_000)
        bench.run("encoder.update-counters", period_ns=50_000)
    bench.run("encoder.capture-position")
    assert bench.use("encoder.0").get("position") == pytest.approx(10 * 0.2, abs=0.01)
    assert bench.get("velocity") == pytest.approx(10.0, rel=0.02)
    assert bench.get("velocity_rpm") == pytest.approx(600.0, rel=0.02)
    bench.set(index_enable=True)
    bench.run("encoder.capture-position")
    for _ in range(2500):
        bench.run("sim-encoder.make-pulses", period_ns=50_000)
        bench.run("encoder.update-counters", period_ns=50_000)
    bench.run("encoder.capture-position")
    assert bench.get("index_enable") is False
    assert 0 <= bench.get("counts") < 600


def test_encoder_velocity_falls_to_zero_when_counts_stop(component: Load) -> None:
    bench = component("encoder", "num_chan=1")
    bench.set(counter_mode=True)
    for n in range(200):
        bench.set(phase_A=n % 10 < 5)
        bench.run("encoder.update-counters")
        bench.run("encoder.capture-position")
    assert bench.get("velocity") == pytest.approx(100.0, rel=0.01)
    for _ in range(1100):
        bench.run("encoder.update-counters")
        bench.run("encoder.capture-position")
    assert bench.get("velocity") == 0.0


@pytest.mark.parametrize(("value", "ones", "backwards"), [(0.5, 50, False), (-0.25, 25, True), (2.0, 100, False)])
def test_pwmgen_is_on_for_its_share(component: Load, value: float, ones: int, backwards: bool) -> None:
    bench = component("pwmgen", "output_type=1")
    bench.set(enable=True, value=value, pwm_freq=1000.0)
    bench.run("pwmgen.make-pulses", period_ns=10_000)
    bench.run("pwmgen.update")
    bench.run("pwmgen.make-pulses", 99, period_ns=10_000)  # the pulse of before
    on = 0
    for _ in range(100):
        bench.run("pwmgen.make-pulses", period_ns=10_000)
        on += bool(bench.get("pwm"))
    assert (on, bench.get("dir")) == (ones, backwards)


def test_siggen_waves_keep_their_phases(component: Load) -> None:
    bench = component("siggen")
    bench.set(frequency=1.0, amplitude=2.0, offset=1.0)
    bench.run("siggen.0.update", 125)
    assert bench.get("sine") == pytest.approx(1.0 + 2.0 * math.sin(math.pi / 4))
    assert bench.get("cosine") == pytest.approx(1.0 + 2.0 * math.cos(math.pi / 4))
    assert (bench.get("square"), bench.get("clock")) == (-1.0, False)
    assert bench.get("triangle") == pytest.approx(2.0)
    assert bench.get("sawtooth") == pytest.approx(1.0 - 1.5)


def test_sim_spindle_resets_at_the_index(component: Load) -> None:
    bench = component("sim_spindle")
    bench.set(velocity_cmd=100.0, scale=1.0)
    bench.run("sim-spindle.0", 15)
    assert bench.get("position_fb") == pytest.approx(1.5)
    bench.set(index_enable=True)
    bench.run("sim-spindle.0", 8)
    assert bench.get("index_enable") is False
    assert bench.get("position_fb") == pytest.approx(0.3)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_sim_home_switch_closes_at_home_and_opens_behind_it(component: Load, side: float) -> None:
    bench = component("sim_home_switch")
    bench.set(home_pos=side)
    states = []
    for position in (0.0, 0.99, 1.0, 1.5, 0.95, 0.85):
        bench.set(cur_pos=side * position)
        bench.run("sim-home-switch.0")
        states.append(bench.get("home_sw"))
    assert states == [False, False, True, True, True, False]


def test_sim_parport_connects_both_ends(component: Load) -> None:
    bench = component("sim_parport", "count=1")
    bench.set(pin_02_out=True, pin_10_in_fake=True, pin_03_out_invert=True)
    bench.run("sim-parport.0.write")
    bench.run("sim-parport.0.read")
    assert (bench.get("pin_02_out_fake"), bench.get("pin_03_out_fake")) == (True, True)
    assert (bench.get("pin_10_in"), bench.get("pin_10_in_not")) == (True, False)
