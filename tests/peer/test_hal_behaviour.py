"""Side by side with Debian's halrun: fed with the same samples, a component gives the same samples."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.peer.test_hal_peer import PEER, peer
from tests.support.halsession import script
from tests.support.shield import reason_to_skip

pytestmark = [
    pytest.mark.peer,
    pytest.mark.process,
    pytest.mark.skipif(PEER is None, reason="/usr/bin/halrun (linuxcnc-uspace) is not installed"),
    pytest.mark.skipif(reason_to_skip() is not None, reason=reason_to_skip() or ""),
]

SAMPLES = 400
DATA = "in.txt"
Rows = Iterator[Sequence[float]]


@dataclass(frozen=True)
class Case:
    """A component between a streamer and a sampler; pins as ``letter:name``, letters as in ``cfg=``."""

    load: str
    functions: str
    inputs: str
    outputs: str
    rows: Callable[[random.Random], Rows]
    given: str = ""  # pins and parameters set before, ``name=value``
    tolerance: float = 2e-6  # six digits after the point are printed


def noise(*widths: float) -> Callable[[random.Random], Rows]:
    """A random number for each input, from -width to width; an int is a whole number, True a bit."""

    def one(chance: random.Random, width: float) -> float:
        if width is True:
            return chance.randrange(2)
        return chance.randint(-width, width) if isinstance(width, int) else chance.uniform(-width, width)

    return lambda chance: ([one(chance, width) for width in widths] for _ in range(SAMPLES))


def presses(longest: int, pins: int = 1) -> Callable[[random.Random], Rows]:
    """Buttons, each held and let go for random numbers of periods."""

    def rows(chance: random.Random) -> Rows:
        left, level = [0] * pins, [1] * pins
        for _ in range(SAMPLES):
            for i in range(pins):
                if left[i] == 0:
                    left[i], level[i] = chance.randint(1, longest), 1 - level[i]
                left[i] -= 1
            yield list(level)

    return rows


def patterns(pins: int, hold: int) -> Callable[[random.Random], Rows]:
    """Bits that change together, every `hold` periods."""

    def rows(chance: random.Random) -> Rows:
        for _ in range(SAMPLES // hold):
            yield from [[chance.randrange(2) for _ in range(pins)]] * hold

    return rows


def steps(*heights: float, hold: int = 40) -> Callable[[random.Random], Rows]:
    """Each input jumps to a new value every `hold` periods."""

    def rows(chance: random.Random) -> Rows:
        values: list[float] = []
        for i in range(SAMPLES):
            if i % hold == 0:
                values = [chance.uniform(-height, height) for height in heights]
            yield values

    return rows


def turning(counts: int = 60) -> Callable[[random.Random], Rows]:
    """Quadrature of a shaft that swings to and fro, with an index every 40 counts."""

    def rows(chance: random.Random) -> Rows:
        for i in range(SAMPLES):
            count = round(counts * math.sin(i * 2 * math.pi / 4 / SAMPLES))
            yield [(count >> 1) & 1, ((count + 1) >> 1) & 1, int(count % 40 == 0)]

    return rows


def typing(chance: random.Random) -> Rows:
    """Keycodes of a pad of 2 x 3 keys on which at most two are held; LinuxCNC's counts a key twice that it left out."""
    held: list[int] = []
    for _ in range(SAMPLES):
        if held and (len(held) == 2 or chance.random() < 0.5):
            yield [0x80 | held.pop(chance.randrange(len(held)))]
        else:
            held.append(chance.choice([key for key in (0, 1, 2, 4, 5, 6) if key not in held]))
            yield [0xC0 | held[-1]]


Column = Callable[[random.Random, int], float]
"""A value for the number of a period."""


def motor(*columns: Column) -> Callable[[random.Random], Rows]:
    """An amplitude, the pin `rev`, then columns by the period's number."""
    return lambda chance: (
        [chance.choice((1, 0.4, -0.7)) if i // 20 % 2 else 0.8, i // 50 % 2, *(column(chance, i) for column in columns)]
        for i in range(SAMPLES)
    )


def bldc(kind: str, feedback: str, *columns: Column, given: str = "", out: str = "") -> Case:
    """A motor that turns, with pins of its feedback and of its kind of output."""
    outputs = f"f:phase-angle f:rotor-angle f:out b:out-dir f:out-abs {out or 'f:A-value f:B-value f:C-value'}"
    prefixed = [" ".join(pin.replace(":", ":bldc.0.") for pin in pins.split())
                for pins in (f"f:value b:rev {feedback}", outputs)]
    settings = " ".join(f"bldc.0.{setting}" for setting in given.split())
    return Case(f"bldc cfg={kind}", "bldc.0", *prefixed, motor(*columns), settings)


def hall(number: int) -> Column:
    """A sensor of a motor that turns a sixth in eleven periods, forwards and then backwards, by the usual pattern."""
    places = (5, 4, 6, 2, 3, 1)
    return lambda chance, i: places[(i if i < 250 else 500 - i) // 11 % 6] >> (3 - number) & 1


def gray(bit: int) -> Column:
    """A bit of a number that goes up."""
    return lambda chance, i: i // 5 % 16 >> bit & 1


def counts(speed: int) -> Column:
    """An encoder that is turned faster and faster, forwards and backwards."""
    return lambda chance, i: round(speed * 30 * math.sin(i * i / 20000.0))


def thermocouples(chance: random.Random) -> Rows:
    """The bits of two converters, in time with their clock: temperatures, and now and then a fault."""
    words = [0, 0]
    for i in range(SAMPLES):
        if i % 130 == 4:
            words = [(chance.randint(-700, 5200) << 18 & 0xFFFC0000) | chance.randint(0, 800) << 4 for _ in range(2)]
            words[1] |= chance.choice((0, 1, 2, 4))
        bit = 31 - i % 130 // 2 + 2
        yield [word >> bit & 1 if 0 <= bit < 32 else 0 for word in words]


HALLS = "b:hall1 b:hall2 b:hall3"
CASES = {
    "bldc-h": bldc("h", HALLS, hall(1), hall(2), hall(3), out="f:A-value f:B-value f:C-value b:hall-error"),
    "bldc-h-pattern": bldc("h", HALLS, hall(1), hall(2), hall(3), given="pattern=17",
                           out="f:A-value f:B-value f:C-value b:hall-error"),
    "bldc-hB": bldc("hB", HALLS, hall(1), hall(2), hall(3), out="b:A-on b:B-on b:C-on"),
    "bldc-h6": bldc("h6", HALLS, hall(1), hall(2), hall(3), out="f:A-high f:A-low f:B-high f:B-low"),
    "bldc-hB6": bldc("hB6", HALLS, hall(1), hall(2), hall(3), out="b:A-high-on b:A-low-on b:B-high-on b:C-low-on"),
    "bldc-hH": bldc("hH", HALLS, hall(1), hall(2), hall(3), given="output-pattern=33",
                    out="b:hall1-out b:hall2-out b:hall3-out"),
    "bldc-hT": bldc("hT", HALLS, hall(1), hall(2), hall(3)),
    "bldc-hF": bldc("hF", HALLS, hall(1), hall(2), hall(3), out="b:C1-out b:C2-out b:C4-out b:C8-out"),
    "bldc-qh": bldc("qh", f"{HALLS} s:rawcounts", hall(1), hall(2), hall(3), lambda chance, i: 5 * min(i, 500 - i)),
    "bldc-a": bldc("a", "s:rawcounts", counts(7), given="scale=1000 poles=6 encoder-offset=20 lead-angle=70"),
    "bldc-aT": bldc("aT", "s:rawcounts", counts(5), given="lead-angle=70"),
    "bldc-aB": bldc("aB", "s:rawcounts", counts(5), out="b:A-on b:B-on b:C-on"),
    "bldc-aB6": bldc("aB6", "s:rawcounts", counts(5), out="b:A-high-on b:A-low-on b:B-high-on b:C-low-on"),
    "bldc-a6": bldc("a6", "s:rawcounts", counts(5), out="f:A-high f:A-low f:B-high f:B-low"),
    "bldc-aH": bldc("aH", "s:rawcounts", counts(5), out="b:hall1-out b:hall2-out b:hall3-out"),
    "bldc-aF": bldc("aF", "s:rawcounts", counts(5), out="b:C1-out b:C2-out b:C4-out b:C8-out"),
    "bldc-n": bldc("n", "f:frequency", lambda chance, i: 3 * i if i < 300 else -40),
    "bldc-nT": bldc("nT", "f:frequency", lambda chance, i: 3.01 * i if i < 300 else -40),
    "bldc-f": bldc("f", "b:C1 b:C2 b:C4 b:C8", gray(0), gray(1), gray(2), gray(3)),
    "bldc-q": bldc("q", "s:rawcounts b:init", counts(5), lambda chance, i: i > 20,
                   given="initvalue=0.5 drive-offset=30", out="f:A-value f:B-value f:C-value b:init-done"),
    "max31855": Case(
        "max31855 personality=2", "max31855.0.bitbang-spi", "b:max31855.0.data.0.in b:max31855.0.data.1.in",
        "b:max31855.0.cs.out b:max31855.0.clk.out " + " ".join(
            f"f:max31855.0.temp-celsius.{i} f:max31855.0.temp-kelvin.{i} f:max31855.0.temp-fahrenheit.{i} "
            f"b:max31855.0.fault.{i} u:max31855.0.fault-flags.{i}" for i in range(2)
        ), thermocouples, tolerance=0.02,
    ),
    "biquad-lowpass": Case(
        "biquad", "biquad.0", "f:biquad.0.in", "f:biquad.0.out b:biquad.0.valid", noise(1.0),
        "biquad.0.type=1 biquad.0.f0=50 biquad.0.Q=0.7071 biquad.0.enable=1",
    ),
    "biquad-notch": Case(
        "biquad", "biquad.0", "f:biquad.0.in", "f:biquad.0.out b:biquad.0.valid", noise(1.0),
        "biquad.0.type=2 biquad.0.f0=120 biquad.0.Q=1.5 biquad.0.enable=1",
    ),
    "biquad-given": Case(
        "biquad", "biquad.0", "f:biquad.0.in b:biquad.0.enable", "f:biquad.0.out b:biquad.0.valid", noise(1.0, True),
        "biquad.0.n0=0.2 biquad.0.n1=0.3 biquad.0.n2=0.1 biquad.0.d1=-0.4 biquad.0.d2=0.1",
    ),
    "lowpass": Case("lowpass", "lowpass.0", "f:lowpass.0.in b:lowpass.0.load", "f:lowpass.0.out", noise(10.0, True),
                    "lowpass.0.gain=0.2"),
    "timedelay": Case("timedelay", "timedelay.0", "b:timedelay.0.in", "b:timedelay.0.out f:timedelay.0.elapsed",
                      presses(9), "timedelay.0.on-delay=0.0045 timedelay.0.off-delay=0.0025"),
    "debounce": Case("debounce cfg=2", "debounce.0", "b:debounce.0.0.in b:debounce.0.1.in",
                     "b:debounce.0.0.out b:debounce.0.1.out", presses(9, 2)),
    "pid": Case(
        "pid names=p", "p.do-pid-calcs", "f:p.command f:p.feedback b:p.enable", "f:p.output f:p.error b:p.saturated",
        lambda chance: ([chance.uniform(-1.0, 1.0), chance.uniform(-1.0, 1.0), i % 50 > 5] for i in range(SAMPLES)),
        "p.Pgain=3 p.Igain=20 p.Dgain=0.01 p.FF0=0.1 p.FF1=0.01 p.FF2=0.0001 p.maxoutput=40 p.maxerrorI=0.1 "
        "p.deadband=0.05",
    ),
    "encoder": Case(
        "encoder names=e", "encoder.update-counters encoder.capture-position",
        "b:e.phase-A b:e.phase-B b:e.phase-Z", "s:e.counts f:e.position s:e.rawcounts",
        turning(), "e.position-scale=4",
    ),
    "encoder-index": Case(
        "encoder names=e", "encoder.update-counters encoder.capture-position",
        "b:e.phase-A b:e.phase-B b:e.phase-Z", "s:e.counts f:e.position b:e.index-enable",
        turning(), "e.position-scale=4 e.index-enable=1",
    ),
    "encoder-speed": Case(
        "encoder names=e", "encoder.update-counters encoder.capture-position",
        "b:e.phase-A", "f:e.velocity f:e.position-interpolated f:e.velocity-rpm",
        presses(25), "e.min-speed-estimate=1 e.counter-mode=1", 1e-4,
    ),
    "encoder-standstill": Case(  # with a scale LinuxCNC 2.9's takes min-speed-estimate for counts / scale^2
        "encoder names=e", "encoder.update-counters encoder.capture-position",
        "b:e.phase-A", "f:e.velocity f:e.velocity-rpm",
        presses(25), "e.min-speed-estimate=60 e.counter-mode=1", 1e-4,
    ),
    "stepgen-velocity": Case(
        "stepgen step_type=0 ctrl_type=v", "stepgen.update-freq stepgen.make-pulses stepgen.capture-position",
        "f:stepgen.0.velocity-cmd", "b:stepgen.0.step b:stepgen.0.dir s:stepgen.0.counts f:stepgen.0.position-fb",
        steps(400.0),
        "stepgen.0.enable=1 stepgen.0.steplen=1 stepgen.0.dirhold=1 stepgen.0.dirsetup=1 stepgen.0.maxaccel=20000",
    ),
    "stepgen-position": Case(
        "stepgen step_type=2", "stepgen.update-freq stepgen.make-pulses stepgen.capture-position",
        "f:stepgen.0.position-cmd",
        "b:stepgen.0.phase-A b:stepgen.0.phase-B s:stepgen.0.counts f:stepgen.0.position-fb",
        steps(9.0),
        "stepgen.0.enable=1 stepgen.0.maxvel=200 stepgen.0.maxaccel=9000", 1e-3,
    ),
    "pwmgen": Case(
        "pwmgen output_type=1", "pwmgen.make-pulses pwmgen.update", "f:pwmgen.0.value",
        "b:pwmgen.0.pwm b:pwmgen.0.dir f:pwmgen.0.curr-dc", steps(1.2), "pwmgen.0.enable=1 pwmgen.0.pwm-freq=50",
    ),
    "pdm": Case(
        "pwmgen output_type=2", "pwmgen.make-pulses pwmgen.update", "f:pwmgen.0.value",
        "b:pwmgen.0.up b:pwmgen.0.down f:pwmgen.0.curr-dc", steps(1.2), "pwmgen.0.enable=1 pwmgen.0.pwm-freq=0",
    ),
    "multiclick": Case(
        "multiclick", "multiclick.0", "b:multiclick.0.in", " ".join(
            f"b:multiclick.0.{number}-click{only}" for number in ("single", "double", "triple", "quadruple")
            for only in ("", "-only")
        ) + " s:multiclick.0.state",
        presses(7),
        "multiclick.0.max-hold-ns=5500000 multiclick.0.max-space-ns=5500000 multiclick.0.output-hold-ns=3500000",
    ),
    "multiswitch": Case(
        "multiswitch cfg=4", "multiswitch.0", "b:multiswitch.0.up b:multiswitch.0.down",
        "b:multiswitch.0.bit-00 b:multiswitch.0.bit-01 b:multiswitch.0.bit-02 b:multiswitch.0.bit-03", presses(5, 2),
    ),
    "weighted_sum": Case(
        "weighted_sum wsum_sizes=3", "process_wsums",
        "b:wsum.0.bit.0.in b:wsum.0.bit.1.in b:wsum.0.bit.2.in b:wsum.0.hold", "s:wsum.0.sum",
        noise(True, True, True, True), "wsum.0.bit.1.weight=-7 wsum.0.offset=100",
    ),
    "mux_generic": Case(
        "mux_generic config=ff4", "mux-gen.00",
        "b:mux-gen.00.sel-bit-00 b:mux-gen.00.sel-bit-01 f:mux-gen.00.in-float-00 f:mux-gen.00.in-float-02",
        "f:mux-gen.00.out-float", noise(True, True, 9.0, 9.0), "mux-gen.00.sel-int=1 mux-gen.00.in-float-03=4",
    ),
    "mux_generic-debounced": Case(
        "mux_generic config=fs5", "mux-gen.00", "u:mux-gen.00.sel-int f:mux-gen.00.in-float-01",
        "s:mux-gen.00.out-s32",
        lambda chance: ([i // 9 % 7, chance.uniform(-9.0, 9.0)] for i in range(SAMPLES)),
        "mux-gen.00.debounce-us=3000 mux-gen.00.suppress-no-input=1 mux-gen.00.in-float-03=4.7",
    ),
    "demux": Case(
        "demux personality=4", "demux.0", "b:demux.0.sel-bit-00 b:demux.0.sel-bit-01 u:demux.0.sel-u32",
        " ".join(f"b:demux.0.out-0{i}" for i in range(4)),
        lambda chance: ([i & 1, i >> 1 & 1, i // 9 % 3] for i in range(SAMPLES)),
    ),
    "demux-bargraph": Case(
        "demux personality=4", "demux.0", "u:demux.0.sel-u32", " ".join(f"b:demux.0.out-0{i}" for i in range(4)),
        lambda chance: ([i % 6] for i in range(SAMPLES)), "demux.0.bargraph=1",
    ),
    "gray": Case(
        "bin2gray\nloadrt gray2bin", "bin2gray.0 gray2bin.0", "u:bin2gray.0.in u:gray2bin.0.in",
        "u:bin2gray.0.out u:gray2bin.0.out", lambda chance: ([i * i, i * i * i] for i in range(SAMPLES)),
    ),
    "scaled_s32_sums": Case(
        "scaled_s32_sums", "scaled-s32-sums.0", " ".join(f"s:scaled-s32-sums.0.in{i}" for i in range(4)),
        "s:scaled-s32-sums.0.out-s f:scaled-s32-sums.0.out-f", noise(9, 90, 900, 9000),
        "scaled-s32-sums.0.scale1=-0.25 scaled-s32-sums.0.scale2=3.5",
    ),
    "corexy_by_hal": Case(
        "corexy_by_hal", "corexy-by-hal.0",
        "f:corexy-by-hal.0.alpha-fb f:corexy-by-hal.0.beta-fb f:corexy-by-hal.0.j0-motor-pos-cmd "
        "f:corexy-by-hal.0.j1-motor-pos-cmd",
        "f:corexy-by-hal.0.alpha-cmd f:corexy-by-hal.0.beta-cmd f:corexy-by-hal.0.j0-motor-pos-fb "
        "f:corexy-by-hal.0.j1-motor-pos-fb", noise(9.0, 9.0, 9.0, 9.0),
    ),
    "differential": Case(
        "differential", "differential.0",
        "f:differential.0.roll-cmd f:differential.0.pitch-cmd f:differential.0.motor0-fb f:differential.0.motor1-fb",
        "f:differential.0.motor0-cmd f:differential.0.motor1-cmd f:differential.0.roll-fb f:differential.0.pitch-fb",
        noise(9.0, 9.0, 9.0, 9.0),
    ),
    "clarke": Case(
        "clarke2\nloadrt clarke3\nloadrt clarkeinv", "clarke2.0 clarke3.0 clarkeinv.0",
        "f:clarke2.0.a f:clarke2.0.b f:clarke3.0.a f:clarke3.0.b f:clarke3.0.c f:clarkeinv.0.x f:clarkeinv.0.y "
        "f:clarkeinv.0.h f:clarkeinv.0.theta",
        "f:clarke2.0.x f:clarke2.0.y f:clarke3.0.x f:clarke3.0.y f:clarke3.0.h f:clarkeinv.0.a f:clarkeinv.0.b "
        "f:clarkeinv.0.c", noise(*[3.0] * 9), "", 3e-6,
    ),
    "filter_kalman": Case(
        "filter_kalman", "filter-kalman.0", "f:filter-kalman.0.zk", "f:filter-kalman.0.xk-out", noise(5.0),
        "filter-kalman.0.Rk=0.5 filter-kalman.0.Qk=0.01",
    ),
    "filter_kalman-reset": Case(
        "filter_kalman", "filter-kalman.0",
        "f:filter-kalman.0.zk b:filter-kalman.0.reset b:filter-kalman.0.passthrough",
        "f:filter-kalman.0.xk-out", lambda chance: (
            [chance.uniform(-5.0, 5.0), i // 11 % 4 == 0, i // 5 % 3 == 0] for i in range(SAMPLES)
        ), "filter-kalman.0.Rk=0.5 filter-kalman.0.Qk=0.01",
    ),
    "sphereprobe": Case(
        "sphereprobe", "sphereprobe.0", "s:sphereprobe.0.px s:sphereprobe.0.py s:sphereprobe.0.pz",
        "b:sphereprobe.0.probe-out", noise(40, 40, 40),
        "sphereprobe.0.cx=2 sphereprobe.0.cy=-3 sphereprobe.0.cz=5 sphereprobe.0.r=30",
    ),
    "orient": Case(
        "orient", "orient.0", "f:orient.0.position b:orient.0.enable s:orient.0.mode f:orient.0.angle",
        "f:orient.0.command f:orient.0.poserr b:orient.0.is-oriented",
        lambda chance: (
            [chance.uniform(-4.0, 4.0), i % 5 > 1, i // 5 % 3, chance.uniform(0.0, 360.0)] for i in range(SAMPLES)
        ), "", 1e-3,
    ),
    "simple_tp": Case(
        "simple_tp", "simple-tp.0.update", "f:simple-tp.0.target-pos b:simple-tp.0.enable",
        "f:simple-tp.0.current-pos f:simple-tp.0.current-vel b:simple-tp.0.active",
        lambda chance: ([5.0 * (i // 150 % 2) - 1.0, i < 350] for i in range(SAMPLES)),
        "simple-tp.0.maxvel=60 simple-tp.0.maxaccel=2000", 1e-3,
    ),
    "feedcomp": Case(
        "feedcomp", "feedcomp.0", "f:feedcomp.0.in f:feedcomp.0.vel b:feedcomp.0.enable", "f:feedcomp.0.out",
        noise(9.0, 9.0, True), "feedcomp.0.feed=4",
    ),
    "gearchange": Case(
        "gearchange", "gearchange.0", "b:gearchange.0.sel f:gearchange.0.speed-in b:gearchange.0.dir-in",
        "f:gearchange.0.speed-out b:gearchange.0.dir-out", noise(True, 900.0, True),
        "gearchange.0.scale2=2.5 gearchange.0.min1=100 gearchange.0.max1=500 gearchange.0.min2=300 "
        "gearchange.0.max2=800 gearchange.0.reverse=1",
    ),
    "knob2float": Case(
        "knob2float", "knob2float.0", "s:knob2float.0.counts b:knob2float.0.enable", "f:knob2float.0.out",
        noise(20, True), "knob2float.0.scale=0.1 knob2float.0.max-out=2 knob2float.0.min-out=-1",
    ),
    "joyhandle": Case(
        "joyhandle", "joyhandle.0", "f:joyhandle.0.in", "f:joyhandle.0.out", noise(1.2),
        "joyhandle.0.deadband=0.1 joyhandle.0.power=2.5 joyhandle.0.scale=3 joyhandle.0.offset=0.2",
    ),
    "joyhandle-inverse": Case(
        "joyhandle", "joyhandle.0", "f:joyhandle.0.in", "f:joyhandle.0.out",
        lambda chance: ([chance.uniform(0.0, 1.2)] for _ in range(SAMPLES)),
        "joyhandle.0.deadband=0.1 joyhandle.0.power=2.5 joyhandle.0.scale=3 joyhandle.0.inverse=1",
    ),
    "charge_pump": Case(
        "charge_pump", "charge-pump", "b:charge-pump.enable",
        "b:charge-pump.out b:charge-pump.out-2 b:charge-pump.out-4",
        lambda chance: ([i % 23 > 2] for i in range(SAMPLES)),
    ),
    "sim_matrix_kb": Case(
        "sim_matrix_kb", "sim-matrix-kb.0", " ".join(f"b:sim-matrix-kb.0.button.c0{i}.r0{7 - i}" for i in range(8)),
        "u:sim-matrix-kb.0.out", lambda chance: ([i // 5 % 17 == 2 * key for key in range(8)] for i in range(SAMPLES)),
    ),
    "watchdog": Case(
        "watchdog num_inputs=2", "watchdog.process watchdog.set-timeouts",
        "b:watchdog.input-0 b:watchdog.input-1 b:watchdog.enable-in", "b:watchdog.ok-out",
        lambda chance: ([i // 3 % 2, i // (2 if i % 150 < 90 else 9) % 2, i % 100 > 5] for i in range(SAMPLES)),
        "watchdog.timeout-0=0.0045 watchdog.timeout-1=0.0055",
    ),
    "xhc_hb04_util": Case(
        "xhc_hb04_util names=x", "x",
        "b:x.start-or-pause b:x.is-paused b:x.is-idle b:x.is-running s:x.in1 f:x.divide-by-k-in",
        "b:x.pause b:x.resume b:x.run s:x.out1 f:x.divide-by-k-out", noise(True, True, True, True, 100, 5.0),
        "x.coef1=0.2 x.scale1=3 x.k=4",
    ),
    "anglejog": Case(
        "anglejog names=a", "a", "s:a.counts-in b:a.enable-in",
        "b:a.enable-out f:a.current-scale f:a.current-scale-out s:a.coscounts s:a.sincounts f:a.cos-accel-fraction "
        "f:a.sin-accel-fraction b:a.active f:a.current-mag f:a.current-vel",
        lambda chance: ([i // 40 * 3, i > 20] for i in range(SAMPLES)),
        "a.angle-degrees-in=30 a.scale-in=0.1 a.max-vel=10 a.max-accel=300", 1e-3,
    ),
    "eoffset_per_angle": Case(
        "eoffset_per_angle names=e", "e", "f:e.angle b:e.enable-in b:e.is-on s:e.fnum",
        "s:e.kcounts f:e.kreciprocal b:e.enable-out b:e.clear b:e.is-off",
        lambda chance: ([i * 7 % 360, i % 90 > 20, i < 370, i // 90] for i in range(SAMPLES)),
        "e.fmult=4 e.radius-ref=10 e.start-angle=15.3",
    ),
    "thcud": Case(
        "thcud", "thcud",
        "b:thcud.torch-up b:thcud.torch-down f:thcud.current-vel f:thcud.requested-vel b:thcud.torch-on b:thcud.arc-ok "
        "b:thcud.enable f:thcud.z-pos-in",
        "f:thcud.z-pos-out f:thcud.z-fb-out f:thcud.cur-offset b:thcud.vel-status",
        lambda chance: (  # with the torch on: how the stock one takes corrections back is not as documented
            [chance.random() < 0.4, chance.random() < 0.3, (9, 3, 0, 10.5)[i // 11 % 4], 10 - i // 199 * 10,
             1, i // 5 % 6 > 0, 1, chance.uniform(-1.0, 1.0)] for i in range(SAMPLES)
        ), "thcud.velocity-tol=20 thcud.correction-vel=0.05",
    ),
    "gantry": Case(
        "gantry personality=2", "gantry.0.read gantry.0.write",
        "f:gantry.0.position-cmd f:gantry.0.search-vel " + " ".join(
            f"f:gantry.0.joint.0{i}.pos-fb b:gantry.0.joint.0{i}.home" for i in range(2)
        ),
        "f:gantry.0.position-fb b:gantry.0.home b:gantry.0.limit " + " ".join(
            f"f:gantry.0.joint.0{i}.pos-cmd f:gantry.0.joint.0{i}.offset" for i in range(2)
        ),
        lambda chance: (
            [0.5 * (i // 8 % 3) * i, i // 40 % 3 - 1,
             *(word for n in range(2) for word in (100 * n + i, chance.random() < 0.5))] for i in range(SAMPLES)
        ),
    ),
    "limit3": Case(
        "limit3", "limit3.0", "f:limit3.0.in b:limit3.0.enable", "f:limit3.0.out",
        lambda chance: ([40.0 if i // 100 % 2 else -7.3, i < 350] for i in range(SAMPLES)),
        "limit3.0.maxv=900 limit3.0.maxa=20000 limit3.0.min=-5.5 limit3.0.max=33.3",
        0.03,  # rounding may move the last step by a period
    ),
    "matrix_kb": Case(
        "matrix_kb config=2x3", "matrix_kb.0", "u:matrix_kb.0.keycode",
        " ".join(f"b:matrix_kb.0.key.r{r}c{c}" for r in range(2) for c in range(3)),
        typing,
    ),
    "matrix_kb-scan": Case(
        "matrix_kb config=3x4s names=k", "k", " ".join(f"b:k.col-0{c}-in" for c in range(4)),
        "b:k.row-00-out b:k.row-01-out b:k.row-02-out u:k.keycode "
        + " ".join(f"b:k.key.r{r}c{c}" for r in range(3) for c in range(4)), patterns(4, 20), "k.key_rollover=12",
    ),
    "histobins": Case(
        "histobins", "histobins.0", "f:histobins.0.input s:histobins.0.index b:histobins.0.reset",
        "s:histobins.0.check f:histobins.0.binvalue f:histobins.0.pextra f:histobins.0.nextra "
        "f:histobins.0.input-min f:histobins.0.input-max u:histobins.0.nsamples "
        "f:histobins.0.variance f:histobins.0.mean b:histobins.0.input-error",
        lambda chance: ([chance.uniform(-3.0, 14.0), i % 12 - 1, i % 150 < 2] for i in range(SAMPLES)),
        "histobins.0.nbins=10", 1e-4,
    ),
}  # fmt: skip


def samples(case: Case, name: str) -> str:
    """What is streamed, a line for each period."""
    rows = case.rows(random.Random(name))
    return "".join(" ".join(f"{float(value):.12g}" for value in row) + "\n" for row in rows)


def session(case: Case) -> str:
    """The HAL lines."""
    inputs, outputs = ([pin.split(":") for pin in pins.split()] for pins in (case.inputs, case.outputs))
    lines = [
        "loadrt threads name1=t period1=1000000",
        f"loadrt {case.load}",
        f"loadrt streamer depth={SAMPLES + 10} cfg={''.join(letter for letter, _ in inputs)}",
        f"loadrt sampler depth={SAMPLES + 10} cfg={''.join(letter for letter, _ in outputs)}",
        *("setp {} {}".format(*setting.split("=")) for setting in case.given.split()),
        *(f"net in{i} streamer.0.pin.{i} => {pin}" for i, (_, pin) in enumerate(inputs)),
        *(f"net out{i} {pin} => sampler.0.pin.{i}" for i, (_, pin) in enumerate(outputs)),
        *(f"addf {function} t" for function in ["streamer.0", *case.functions.split(), "sampler.0"]),
        f"loadusr -w halstreamer {DATA}",
        "start",
        f"loadusr -w halsampler -n {SAMPLES}",
    ]
    return "\n".join(lines) + "\n"


def numbers(output: str) -> list[list[float]]:
    """The samples that a session printed."""
    return [[float(word) for word in line.split()] for line in output.splitlines() if line[:1] in "-0123456789 "]


@pytest.mark.parametrize("name", CASES)
def test_a_component_gives_the_peers_samples(name: str, tmp_path: Path) -> None:
    case = CASES[name]
    text, data = session(case), samples(case, name)
    (tmp_path / DATA).write_text(data)
    ours, theirs = numbers(script(tmp_path, text).stdout), numbers(peer(text, {DATA: data}))
    assert len(theirs) == SAMPLES, "the peer did not run"
    assert len(ours) == SAMPLES
    for i, (mine, expected) in enumerate(zip(ours, theirs, strict=True)):
        assert mine == pytest.approx(expected, rel=1e-6, abs=case.tolerance), f"sample {i}"
