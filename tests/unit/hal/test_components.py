"""What the built-in components do, a period at a time."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import pytest

from nml.errors import HalError
from tests.unit.hal.conftest import Bench

Load = Callable[..., Bench]


@pytest.mark.parametrize(
    ("name", "table"),
    [
        ("and2", "00:0 01:0 10:0 11:1"),
        ("or2", "00:0 01:1 10:1 11:1"),
        ("xor2", "00:0 01:1 10:1 11:0"),
    ],
)
def test_gates_follow_their_truth_tables(component: Load, name: str, table: str) -> None:
    gate = component(name)
    for row in table.split():
        gate.set(in0=row[0] == "1", in1=row[1] == "1")
        gate.run(f"{name}.0")
        assert gate.get("out") == (row[3] == "1"), row


@pytest.mark.parametrize(
    ("name", "words", "given", "out", "expected"),
    [
        ("abs", (), {"in_": -2.5}, "out", 2.5),
        ("sum2", (), {"in0": 2.0, "in1": 3.0, "gain1": -2.0, "offset": 1.0}, "out", -3.0),
        ("mult2", (), {"in0": 2.0, "in1": 3.0}, "out", 6.0),
        ("div2", (), {"in0": 1.0, "in1": 4.0}, "out", 0.25),
        ("div2", (), {"in0": 1.0, "in1": -0.1, "deadband": 0.5}, "out", -2.0),
        ("invert", (), {"in_": 4.0}, "out", 0.25),
        ("invert", (), {"in_": 0.1, "deadband": 0.5}, "out", 0.0),
        ("scale", (), {"in_": 2.0, "gain": 3.0, "offset": 1.0}, "out", 7.0),
        ("constant", (), {"value": 9.0}, "out", 9.0),
        ("hypot", (), {"in0": 2.0, "in1": 3.0, "in2": 6.0}, "out", 7.0),
        ("blend", (), {"in1": 10.0, "in2": 20.0, "select": 0.25}, "out", 17.5),
        ("blend", (), {"in1": 10.0, "in2": 20.0, "select": 2.0}, "out", 10.0),
        ("blend", (), {"in1": 10.0, "in2": 20.0, "select": 2.0, "open": True}, "out", 0.0),
        ("deadzone", (), {"in_": 0.4}, "out", 0.0),
        ("deadzone", (), {"in_": 1.5}, "out", 1.0),
        ("limit1", (), {"in_": 5.0, "max": 3.0}, "out", 3.0),
        ("limit1", (), {"in_": -5.0, "min": -3.0}, "out", -3.0),
        ("comp", (), {"in0": 1.0, "in1": 1.2, "hyst": 0.1}, "out", True),
        ("comp", (), {"in0": 1.0, "in1": 1.04, "hyst": 0.1}, "equal", True),
        ("wcomp", (), {"in_": 2.0, "min": 1.0, "max": 3.0}, "out", True),
        ("wcomp", (), {"in_": 3.0, "min": 1.0, "max": 3.0}, "over", True),
        ("near", (), {"in1": 100.0, "in2": 109.0, "scale": 1.1}, "out", True),
        ("near", (), {"in1": -100.0, "in2": -109.0, "scale": 1.1}, "out", True),
        ("near", (), {"in1": 100.0, "in2": 112.0, "scale": 1.1}, "out", False),
        ("near", (), {"in1": 0.0, "in2": 0.5, "difference": 0.5}, "out", True),
        ("maj3", (), {"in1": True, "in3": True}, "out", True),
        ("maj3", (), {"in1": True, "in3": True, "invert": True}, "out", False),
        ("lut5", (), {"in_0": True, "in_2": True, "function": 1 << 5}, "out", True),
        ("logic", ("personality=0x403",), {"in_00": True, "in_01": True, "in_02": True}, "xor", True),
        ("logic", ("personality=0x802",), {"in_00": True}, "nand", True),
        ("select8", (), {"sel": 3}, "out3", True),
        ("select8", (), {"sel": 3, "enable": False}, "out3", False),
        ("mux2", (), {"in0": 1.0, "in1": 2.0, "sel": True}, "out", 2.0),
        ("mux4", (), {"in2": 7.0, "sel1": True}, "out", 7.0),
        ("mux8", (), {"in6": 7.0, "sel1": True, "sel2": True}, "out", 7.0),
        ("mux16", (), {"in02": 7.9, "sel0": True, "sel1": True, "use_graycode": True}, "out_s", 7),
        ("bitslice", ("personality=8",), {"in_": 0x12}, "out_04", True),
        ("bitwise", (), {"in0": 0b1100, "in1": 0b1010}, "out_xor", 0b0110),
        ("match8", (), {"a3": True, "b3": True}, "out", True),
        ("match8", (), {"a3": True}, "out", False),
        ("conv_float_s32", (), {"in_": 1e10, "clamp": True}, "out", 2**31 - 1),
        ("conv_float_s32", (), {"in_": -2.9}, "out", -2),
        ("conv_s32_u32", (), {"in_": -1}, "out", 2**32 - 1),
        ("conv_s32_u32", (), {"in_": -1, "clamp": True}, "out", 0),
        ("conv_s32_u32", (), {"in_": -1}, "out_of_range", True),
        ("conv_u64_s64", (), {"in_": 2**64 - 1, "clamp": True}, "out", 2**63 - 1),
        ("conv_u32_bit", (), {"in_": 8}, "out", True),
        ("bin2gray", (), {"in_": 6}, "out", 5),
        ("gray2bin", (), {"in_": 5}, "out", 6),
        ("demux", ("personality=4",), {"sel_bit_00": True, "sel_u32": 1}, "out_02", True),
        ("demux", ("personality=4",), {"sel_u32": 9}, "out_03", True),
        ("scaled_s32_sums", (), {"in0": 3, "in1": 8, "scale1": 0.25}, "out_s", 5),
        ("corexy_by_hal", (), {"j0_motor_pos_cmd": 3.0, "j1_motor_pos_cmd": 1.0}, "beta_cmd", 1.0),
        ("corexy_by_hal", (), {"alpha_fb": 2.0, "beta_fb": 1.0}, "j1_motor_pos_fb", 1.0),
        ("differential", (), {"roll_cmd": 3.0, "pitch_cmd": 1.0}, "motor1_cmd", 2.0),
        ("clarke2", (), {"a": 1.0, "b": -0.5}, "y", 0.0),
        ("clarke3", (), {"a": 1.0, "b": -0.5, "c": -0.5}, "x", 1.0),
        ("clarkeinv", (), {"x": 1.0, "theta": 0.5}, "b", 0.5),
        ("sphereprobe", (), {"pz": 9, "r": 10}, "probe_out", True),
        ("sphereprobe", (), {"pz": 11, "r": 10}, "probe_out", False),
        ("orient", (), {"enable": True, "position": 2.9, "angle": 36.0}, "command", 3.1),
        ("orient", (), {"enable": True, "position": 2.9, "angle": 36.0, "mode": 2}, "command", 2.1),
        ("feedcomp", (), {"in_": 6.0, "vel": 2.0, "feed": 4.0, "enable": True}, "out", 3.0),
        ("gearchange", (), {"sel": True, "speed_in": -900.0, "max2": 800.0, "scale2": 2.0}, "speed_out", -400.0),
        ("joyhandle", (), {"in_": -0.5}, "out", -0.25),
        ("knob2float", (), {"counts": 3, "scale": 0.25, "enable": True}, "out", 0.75),
        ("filter_kalman", (), {"zk": 3.0, "Rk": 1.0, "Qk": 1.0}, "xk_out", 2.0),
        ("multiswitch", ("cfg=3",), {"down": True}, "bit_02", True),
        ("biquad", (), {"in_": 2.0, "n0": 0.5, "enable": True}, "out", 1.0),
        ("biquad", (), {"type": 1, "f0": 600.0, "enable": True}, "valid", False),
        ("latencybins", (), {"index": 1001}, "pbinvalue", -1),
    ],
)
def test_a_component_gives_its_result_at_once(
    component: Load, name: str, words: tuple[str, ...], given: dict[str, float], out: str, expected: float
) -> None:
    bench = component(name, *words)
    bench.set(**given)
    bench.run(f"{name.replace('_', '-')}.0")
    assert bench.get(out) == pytest.approx(expected, rel=1e-12)


def series(bench: Bench, function: str, pin: str, values: str, out: str = "out") -> str:
    """Feed bits to a pin, one a period, and collect the output's."""
    got = ""
    for value in values:
        bench.set(**{pin: value == "1"})
        bench.run(function)
        got += "01"[bool(bench.get(out))]
    return got


@pytest.mark.parametrize(
    ("name", "given", "pin", "values", "expected"),
    [
        ("toggle", {"debounce": 1}, "in_", "0111110001110000", "0011111111000000"),
        ("edge", {"in_edge": False}, "in_", "0110010", "0100010"),
        ("edge", {"in_edge": True}, "in_", "0110010", "0001001"),
        ("edge", {"both": True}, "in_", "0110010", "0101011"),
        ("edge", {"in_edge": False, "out_width_ns": 2_000_000}, "in_", "0111111", "0110000"),
        ("oneshot", {"width": 0.0025}, "in_", "0111110", "0111000"),
        ("oneshot", {"width": 0.0025, "rising": False, "falling": True}, "in_", "110000", "001110"),
        ("timedelay", {"on_delay": 0.0015, "off_delay": 0.0025}, "in_", "01100110000", "00111111100"),
        ("dbounce", {"delay": 3}, "in_", "0101110001000", "0000011100000"),
        ("estop_latch", {}, "reset", "0110", "0111"),
        ("ton", {"pt": 0.002}, "in_", "01110", "00110"),
        ("tof", {"pt": 0.002}, "in_", "010000", "011000"),
        ("tp", {"pt": 0.002}, "in_", "0111010", "0110011"),
    ],
)
def test_bits_in_time(
    component: Load, name: str, given: dict[str, float], pin: str, values: str, expected: str
) -> None:
    bench = component(name)
    bench.set(**given)
    out = {"estop_latch": "ok_out"}.get(name, "q" if name in ("ton", "tof", "tp") else "out")
    assert series(bench, f"{name.replace('_', '-')}.0", pin, values, out) == expected


def test_debounce_filters_each_input_of_a_group(component: Load) -> None:
    bench = component("debounce", "cfg=1,2")
    bench.use("debounce.1")
    bench.hal.set_item("debounce.1.delay", "2")
    bench.hal.set_item("debounce.1.1.in", "1")
    bench.run("debounce.1", 2)
    assert bench.hal.value("debounce.1.1.out") is False
    bench.run("debounce.1")
    assert bench.hal.value("debounce.1.1.out") is True
    assert bench.hal.value("debounce.1.0.out") is False


def test_a_fault_opens_the_estop_latch_until_reset_rises(component: Load) -> None:
    bench = component("estop_latch")
    assert series(bench, "estop-latch.0", "reset", "01", "ok_out") == "01"
    bench.set(fault_in=True)
    bench.run("estop-latch.0")
    assert (bench.get("ok_out"), bench.get("fault_out")) == (False, True)
    bench.set(fault_in=False)
    assert series(bench, "estop-latch.0", "reset", "1101", "ok_out") == "0001"


def test_flipflop_takes_data_at_the_clock(component: Load) -> None:
    bench = component("flipflop")
    bench.set(data=True)
    assert series(bench, "flipflop.0", "clk", "0100") == "0111"
    bench.set(data=False)
    assert series(bench, "flipflop.0", "clk", "01") == "10"
    bench.set(set_=True, reset=True)
    assert series(bench, "flipflop.0", "clk", "0") == "0"


def test_toggle2nist_asks_until_the_device_answers(component: Load) -> None:
    bench = component("toggle2nist")
    bench.set(in_=True)
    bench.run("toggle2nist.0", 3)
    assert (bench.get("on"), bench.get("off")) == (True, False)
    bench.set(is_on=True, in_=False)
    bench.run("toggle2nist.0")
    assert (bench.get("on"), bench.get("off")) == (False, False)
    bench.set(in_=True)
    bench.run("toggle2nist.0")
    assert (bench.get("on"), bench.get("off")) == (False, True)


@pytest.mark.parametrize(
    ("given", "expected"), [({"clamp": True, "max": 2}, [1, 2, 2]), ({"wrap": True, "max": 1}, [1, 0, 1])]
)
def test_updown_counts_edges_within_its_limits(component: Load, given: dict[str, int], expected: list[int]) -> None:
    bench = component("updown")
    bench.set(**given)
    counts = []
    for _ in range(3):
        series(bench, "updown.0", "countup", "10", "count")
        counts.append(bench.get("count"))
    assert counts == expected


def test_ddt_and_integ_undo_each_other(component: Load) -> None:
    bench = component("ddt")
    bench.load("integ")
    bench.hal.net("v", ["ddt.0.out", "integ.0.in"])
    for n in range(200):
        bench.use("ddt.0").set(in_=math.sin(n / 20))
        bench.run("ddt.0")
        bench.run("integ.0")
    assert bench.use("integ.0").get("out") == pytest.approx(math.sin(199 / 20), abs=1e-9)


def test_lincurve_draws_straight_lines(component: Load) -> None:
    bench = component("lincurve", "personality=3")
    for n, (x, y) in enumerate([(0, 0), (10, 100), (20, 0)]):
        bench.set(**{f"x_val_0{n}": x, f"y_val_0{n}": y})
    got = []
    for value in (-5.0, 5.0, 10.0, 15.0, 99.0):
        bench.set(in_=value)
        bench.run("lincurve.0")
        got.append(bench.get("out"))
    assert got == [0.0, 50.0, 100.0, 50.0, 0.0]


def test_limit2_keeps_its_velocity(component: Load) -> None:
    bench = component("limit2")
    bench.set(in_=1.0, maxv=300.0)
    got = []
    for _ in range(4):
        bench.run("limit2.0")
        got.append(round(bench.get("out"), 6))
    assert got == [0.3, 0.6, 0.9, 1.0]


@pytest.mark.parametrize("seed", range(20))
def test_limit3_keeps_all_limits_whatever_comes(component: Load, seed: int) -> None:
    import random

    rng = random.Random(seed)
    bench = component("limit3")
    maxv, maxa, low, high = rng.uniform(1, 50), rng.uniform(10, 2000), -rng.uniform(0.1, 5), rng.uniform(0.1, 5)
    bench.set(maxv=maxv, maxa=maxa, min=low, max=high)
    old, old_v, target = 0.0, 0.0, 0.0
    for _ in range(600):
        if rng.random() < 0.02:
            target = rng.uniform(-6, 6)
        target += rng.uniform(-0.001, 0.001)
        bench.set(in_=target)
        bench.run("limit3.0")
        out = bench.get("out")
        v = (out - old) / 1e-3
        assert low - 1e-9 <= out <= high + 1e-9
        assert abs(v) <= maxv * (1 + 1e-9) + 1e-6
        assert abs(v - old_v) <= maxa * 1e-3 * (1 + 1e-6) + 1e-6
        old, old_v = out, v


def test_limit3_follows_a_ramp_without_lag(component: Load) -> None:
    bench = component("limit3")
    bench.set(maxv=100.0, maxa=1000.0)
    for n in range(400):
        bench.set(in_=0.01 * n)
        bench.run("limit3.0")
    assert bench.get("out") == pytest.approx(0.01 * 399, abs=1e-9)


def test_lowpass_approaches_and_loads(component: Load) -> None:
    bench = component("lowpass")
    bench.set(in_=1.0, gain=0.5)
    bench.run("lowpass.0", 2)
    assert bench.get("out") == 0.75
    bench.set(load=True, in_=9.0)
    bench.run("lowpass.0")
    assert bench.get("out") == 9.0


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


def test_mux_generic_converts_between_types(component: Load) -> None:
    bench = component("mux_generic", "config=fs4", instance="mux-gen.00")
    bench.set(in_float_03=-2.75, sel_bit_00=True, sel_bit_01=True)
    bench.run("mux-gen.00")
    assert bench.get("out_s32") == -2


def test_mux_generic_says_what_is_wrong_with_its_configuration(bench: Bench) -> None:
    with pytest.raises(HalError, match="bb4,fu12"):
        bench.load("mux_generic", "config=bx4")


def test_weighted_sum_holds_its_sum(component: Load) -> None:
    bench = component("weighted_sum", "wsum_sizes=3", instance="wsum.0")
    bench.set(**{"bit.2.in": True, "bit.0.in": True, "offset": 10})
    bench.run("process_wsums")
    assert bench.get("sum") == 15
    bench.set(**{"bit.0.in": False, "hold": True})
    bench.run("process_wsums")
    assert bench.get("sum") == 15


def test_multiclick_tells_two_clicks_from_three(component: Load) -> None:
    bench = component("multiclick")
    bench.set(max_space_ns=3_000_000, output_hold_ns=1_000_000)
    assert series(bench, "multiclick.0", "in_", "10100000000", "double_click_only") == "00000001000"
    assert series(bench, "multiclick.0", "in_", "10101000000", "double_click_only") == "00000000000"


def test_simple_tp_arrives_without_passing_its_target(component: Load) -> None:
    bench = component("simple_tp")
    bench.set(target_pos=1.0, maxvel=20.0, maxaccel=500.0, enable=True)
    places = []
    for _ in range(150):
        bench.run("simple-tp.0.update")
        places.append(bench.get("current_pos"))
    assert max(places) <= 1.0 + 1e-6
    assert places[-1] == pytest.approx(1.0, abs=1e-4)
    assert bench.get("active") is False


def test_histobins_counts_what_lies_outside(component: Load) -> None:
    bench = component("histobins")
    bench.set(nbins=2, index=1)
    for value in (0.0, 1.5, 1.9, -1.0, 7.0):
        bench.set(input=value)
        bench.run("histobins.0")
    assert [bench.get(name) for name in ("binvalue", "nextra", "pextra")] == [2.0, 1.0, 1.0]
