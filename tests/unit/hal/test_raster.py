"""The raster component and the programmer at the other end of its port."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from hal import module
from hal.raster import FaultCodes, RasterProgrammer
from hal.realtime import Host
from nml.errors import HalError
from tests.unit.hal.conftest import Bench

Load = Callable[..., Bench]


class Engraver:
    """A raster component with its programmer; a period at a time."""

    def __init__(self, bench: Bench) -> None:
        self.bench = bench
        bench.load("raster", "names=r")
        bench.use("r")
        self.programmer = RasterProgrammer("programmer")
        module.new_sig("program", module.HAL_PORT)
        for pin in ("programmer.program", "r.program"):
            module.connect(pin, "program")
        module.set_s("program", 200)

    def give(self, program: str) -> None:
        """Write a program and let the component read it."""
        self.bench.set(reset=True, run=False)
        self.bench.run("r")
        self.bench.set(reset=False)
        assert self.programmer.port.write(program)
        self.bench.set(run=True)
        self.bench.run("r")

    def output_at(self, position: float) -> float:
        self.bench.set(position=position)
        self.bench.run("r")
        return round(self.bench.get("output"), 6)

    @property
    def fault(self) -> FaultCodes:
        return FaultCodes(int(self.bench.get("fault_code")))


@pytest.fixture
def engraver(host: Host, bench: Bench) -> Iterator[Engraver]:
    made = Engraver(bench)
    yield made
    made.programmer.exit()


@pytest.mark.parametrize(
    ("program", "fault"),
    [
        ("FOO;4;1;2;00", "InvalidOffset"),
        ("1;;1;2;00", "InvalidBPP"),
        *((f"1;{bpp};1;2;00", "InvalidBPP") for bpp in ("0", "2", "10", "36", "-50.0", "4.5")),
        *((f"1;4;{ppu};2;00", "InvalidPPU") for ppu in ("0", "-1")),
        *((f"1;4;1;{count};00", "InvalidCount") for count in ("0", "1", "-3")),
        ("1" * 40, "InvalidOffset"),
    ],
)
def test_a_wrong_head_is_named(engraver: Engraver, program: str, fault: str) -> None:
    engraver.give(program)
    assert engraver.fault is FaultCodes[fault]
    assert not engraver.bench.get("enabled")
    assert engraver.bench.get("output") == -1.0


@pytest.mark.parametrize("bpp", [4, 8, 12, 16, 20, 24, 28, 32])
def test_all_depths_are_accepted(engraver: Engraver, bpp: int) -> None:
    digits = bpp // 4
    engraver.give(f"0;{bpp};2.5;2;{'0' * digits}{'F' * (digits - 1)}E")
    assert engraver.bench.get("enabled")
    assert (engraver.bench.get("bpp"), engraver.bench.get("ppu"), engraver.bench.get("count")) == (bpp, 2.5, 2)
    assert [engraver.output_at(x) for x in (0.0, 0.2, 0.4)] == [0.0, 50.0, 100.0]


def test_power_is_linear_between_pixels_and_none_outside(engraver: Engraver) -> None:
    engraver.bench.set(position=-1.0)
    engraver.give("1.0;4;1.0;3;0E0")
    places = [-0.5, 0.0, 0.25, 1.0, 1.5, 2.0, 2.1]
    assert [engraver.output_at(x) for x in places] == [-1.0, 0.0, 25.0, 100.0, 50.0, 0.0, -1.0]


def test_a_program_runs_backwards_and_the_largest_value_is_no_power(engraver: Engraver) -> None:
    engraver.bench.set(position=2.0)
    engraver.give("-1.0;4;1.0;3;E7F")
    assert [engraver.output_at(x) for x in (1.5, 1.0, 0.5, 0.0, -0.5)] == [-1.0, 100.0, 75.0, 50.0, -1.0]


def test_pixels_that_come_late_and_turning_back_are_faults(engraver: Engraver) -> None:
    engraver.give("0;4;1;9;0E")
    assert engraver.output_at(1.0) == 100.0
    assert engraver.output_at(2.0) == -1.0
    assert engraver.fault is FaultCodes.ProgramUnderrun
    engraver.bench.set(position=0.0)
    engraver.give("0;4;1;9;0E0E0E0E0")
    engraver.output_at(5.0)
    engraver.output_at(2.0)
    assert engraver.fault is FaultCodes.WrongDirection
    engraver.bench.set(position=0.0)
    engraver.give("0;4;1;3;0x0")
    engraver.output_at(1.0)
    assert engraver.fault is FaultCodes.BadPixelData


def test_the_programmer_says_what_was_wrong(engraver: Engraver) -> None:
    module.new_sig("enabled", module.HAL_BIT)
    module.new_sig("code", module.HAL_S32)
    for pin, signal in (("r.enabled", "enabled"), ("r.fault-code", "code")):
        module.connect(pin, signal)
        module.connect(f"programmer.{pin[2:]}", signal)
    engraver.programmer.begin(0.0, 5, 1.0, 2)
    engraver.bench.set(run=True)
    engraver.bench.run("r")
    with pytest.raises(HalError, match="not accepted: InvalidBPP"):
        engraver.programmer.start(timeout=0.0)
    with pytest.raises(HalError, match="no room for 300 bytes"):
        engraver.programmer.data("0" * 300)
