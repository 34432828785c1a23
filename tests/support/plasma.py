"""A plasma table for `plasmac`: a Z axis that follows its offset, material that the float switch feels, a script.

A `Scenario` is run by our component in this process, period by period, and is a HAL file for LinuxCNC's.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from hal._calls import call
from hal._shm import BIT, FLOAT, OUT
from hal.realtime import Host
from hal.values import parse_value

Value = float | Callable[[int], float]
"""What an input is set to: a number, or one for each period of its step."""
Step = tuple[int, Mapping[str, Value]]
"""For so many periods; the inputs that change."""

MACHINE: dict[str, float] = {
    "arc-fail-delay": 0.1, "arc-max-starts": 3, "arc-ok-high": 250, "arc-ok-low": 60, "arc-voltage-scale": 1,
    "axis-x-max-limit": 600, "axis-y-max-limit": 600, "axis-z-max-limit": 65, "cornerlock-enable": 1,
    "cornerlock-threshold": 90, "cut-feed-rate": 3000, "cut-height": 1.5, "cut-volts": 100, "feed-override": 1,
    "feed-upm": 3000, "float-switch-travel": 1.5, "gcode-scale": 1, "height-per-volt": 0.1, "homed": 1,
    "machine-is-on": 1, "pid-p-gain": 10, "pierce-delay": 0.05, "pierce-height": 3, "probe-feed-rate": 3000,
    "probe-start-height": 12, "program-is-idle": 1, "restart-delay": 0.1, "safe-height": 20, "setup-feed-rate": 30000,
    "thc-delay": 0.05, "thc-enable": 1, "thc-feed-rate": 6000, "thc-threshold": 1, "torch-enable": 1,
    "torch-pulse-time": 0.1, "units-per-mm": 1, "use-auto-volts": 1, "voidlock-enable": 1,
}  # fmt: skip
"""A metric one that cuts at 50 mm/s; arcs have 60 to 250 V."""

PLANT = ("conv_s32_float names=px,py,pz", "mult2 names=mx,my,mz", "sum2 names=sz", "comp names=fs")
SIGNALS = {
    **{f"{axis}-counts": f"plasmac.{axis}-offset-counts p{axis}.in" for axis in "xyz"},
    **{f"{axis}-float": f"p{axis}.out m{axis}.in0" for axis in "xyz"},
    **{f"{axis}-offset": f"m{axis}.out plasmac.{axis}-offset-current" for axis in "xy"},
    "scale": "plasmac.offset-scale mx.in1 my.in1 mz.in1",
    "z-offset": "mz.out plasmac.z-offset-current sz.in0",
    "z-position": "sz.out plasmac.axis-z-position fs.in0",
}
FELT = {"felt": "fs.out plasmac.float-switch"}
FUNCTIONS = ("plasmac", "px", "mx", "py", "my", "pz", "mz", "sz", "fs")
WIDEST = 18  # pins of a streamer or sampler
LETTERS = {BIT: "b", FLOAT: "f"}


@dataclass(frozen=True)
class Scenario:
    """Steps after the machine's settings; ``surface`` None: the scenario sets the float switch itself."""

    steps: Sequence[Step]
    given: Mapping[str, float] = field(default_factory=dict)
    surface: float | None = 10.0
    z: float = 50.0
    period_ns: int = 1_000_000

    @property
    def periods(self) -> int:
        return sum(periods for periods, _ in self.steps)

    @property
    def streamed(self) -> list[str]:
        """The inputs that change, in the order in which they are named first."""
        return list(dict.fromkeys(name for _, changes in self.steps for name in changes))

    def settings(self) -> dict[str, float]:
        """What is set before."""
        wanted = {**MACHINE, **self.given}
        return {name: value for name, value in wanted.items() if name not in self.streamed}

    def rows(self) -> Iterator[list[float]]:
        """The streamed inputs of each period."""
        now: dict[str, Value] = {name: {**MACHINE, **self.given}.get(name, 0.0) for name in self.streamed}
        for periods, changes in self.steps:
            now.update(changes)
            for i in range(periods):
                yield [value(i) if callable(value) else value for value in now.values()]

    def signals(self) -> dict[str, list[str]]:
        """The pins of each signal."""
        wanted = SIGNALS if self.surface is None else {**SIGNALS, **FELT}
        return {name: pins.split() for name, pins in wanted.items()}

    def plant(self) -> dict[str, float]:
        return {"sz.in1": self.z, "fs.in1": self.surface or 0.0, "fs.hyst": 0.0}


def run(host: Host, scenario: Scenario) -> list[dict[str, float]]:
    """The outputs of each period, of our component."""
    for line in ("plasmac", *PLANT):
        name, *words = line.split()
        host.load(name, words)
    hal = host.hal
    for signal, pins in scenario.signals().items():
        hal.net(signal, pins)
    for name, value in {**{f"plasmac.{n}": v for n, v in scenario.settings().items()}, **scenario.plant()}.items():
        hal.set_item(name, f"{value:.12g}")
    inputs = [hal.item(f"plasmac.{name}")[1] for name in scenario.streamed]
    outputs = {name: hal.item(f"plasmac.{name}")[1] for name in output_names(host)}
    functions = [funct for name in FUNCTIONS if (funct := hal.segment.find_funct(name)) is not None]
    seen = []
    for row in scenario.rows():
        for item, value in zip(inputs, row, strict=True):
            item.set(parse_value(item.type, f"{value:.12g}"))
        for funct in functions:
            call(funct.code, funct.arg, scenario.period_ns)
        seen.append({name: float(item.get()) for name, item in outputs.items()})
    return seen


def output_names(host: Host) -> list[str]:
    """The component's outputs, sorted."""
    return sorted(
        pin.name.removeprefix("plasmac.") for pin in host.hal.segment.items(0)
        if pin.name.startswith("plasmac.") and pin.dir == OUT and not pin.name.endswith(".time")
    )  # fmt: skip


def hal_file(host: Host, scenario: Scenario) -> tuple[str, dict[str, str]]:
    """The same for halrun: the HAL lines, which print every output of every period, and the files of the inputs."""
    inputs, outputs = parts(scenario.streamed), parts(output_names(host))
    depth = scenario.periods + 10
    kinds = {n: LETTERS.get(host.hal.item(f"plasmac.{n}")[1].type, "s") for part in inputs + outputs for n in part}

    def letters(wanted: list[list[str]]) -> str:
        depths = ",".join([str(depth)] * len(wanted))
        return f"depth={depths} cfg={','.join(''.join(kinds[name] for name in part) for part in wanted)}"

    rows = list(scenario.rows())
    files = {
        f"in{k}.txt": "".join(
            " ".join(f"{value:.12g}" for value in row[k * WIDEST : (k + 1) * WIDEST]) + "\n" for row in rows
        ) for k in range(len(inputs))
    }  # fmt: skip
    nets = scenario.signals()
    for k, part in enumerate(outputs):
        for i, name in enumerate(part):
            pin = f"plasmac.{name}"
            signal = next((signal for signal, pins in nets.items() if pin in pins), f"out-{name}")
            nets.setdefault(signal, [pin]).append(f"sampler.{k}.pin.{i}")
    for k, part in enumerate(inputs):
        for i, name in enumerate(part):
            nets[f"in-{name}"] = [f"streamer.{k}.pin.{i}", f"plasmac.{name}"]
    functions = [f"streamer.{k}" for k in range(len(inputs))], [f"sampler.{k}" for k in range(len(outputs))]
    lines = [
        f"loadrt threads name1=t period1={scenario.period_ns}",
        *(f"loadrt {line}" for line in ("plasmac", *PLANT)),
        f"loadrt streamer {letters(inputs)}",
        f"loadrt sampler {letters(outputs)}",
        *(f"setp plasmac.{name} {value:.12g}" for name, value in scenario.settings().items()),
        *(f"setp {name} {value:.12g}" for name, value in scenario.plant().items()),
        *(f"net {signal} {' '.join(pins)}" for signal, pins in nets.items()),
        *(f"addf {function} t" for function in [*functions[0], *FUNCTIONS, *functions[1]]),
        *(f"loadusr -w halstreamer -c {k} in{k}.txt" for k in range(len(inputs))),
        "start",
        *(f"loadusr -w halsampler -c {k} -n {scenario.periods}" for k in range(len(outputs))),
    ]
    return "\n".join(lines) + "\n", files


def parts(names: list[str]) -> list[list[str]]:
    """Names for several streamers or samplers."""
    return [names[i : i + WIDEST] for i in range(0, len(names), WIDEST)]
