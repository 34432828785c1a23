"""What the built-in components do, a period at a time."""

from __future__ import annotations

from collections.abc import Callable

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
        ("toggle", {"debounce": 1}, "in_", "0111110001110000", "0111111110000000"),
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
