"""``linuxcnc-forecast``: how long a job takes on a machine, and where it loses time, without the machine.

The program goes through the interpreter and the arithmetic that task uses into the trajectory planner that motion uses,
and the planner's servo periods are run as fast as they go: so the time is the machine's own. Talks to
``emcmot.forecast_canon`` (the canon that feeds and steps the planner), ``rs274ngc``, the INI file, and, where positions
are asked for, ``emcmot.forecast_traces``; to no bus.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from emcmot.forecast_canon import ForecastCanon
from emcmot.forecast_machine import AXES, Machine
from nml.errors import ConfigError, InterpError
from nml.inifile import IniFile
from rs274ngc import tooltable
from rs274ngc.interp import INTERP_ENDFILE, INTERP_EXECUTE_FINISH, INTERP_EXIT, Interpreter

if TYPE_CHECKING:
    from emcmot.forecast_traces import Trace

SHOWN_LINES = 10


@dataclass(frozen=True)
class Standing:
    """What a machine that is on already has in force when the program begins."""

    tool: int = 0
    begin: tuple[str, ...] = ()  # blocks that bring it about
    block_delete: bool = False


HOME = Standing()


@dataclass
class Forecast:
    """What came out: seconds throughout."""

    seconds: float
    sections: list[tuple[int, str, float, float]]  # tool, operation, motion, pauses
    line_seconds: dict[int, float]
    line_lost: dict[int, float]
    line_reason: dict[int, str]  # what cost a line most
    unbounded: int  # moves in G64 without P, which may leave their path as far as their speed asks for
    reasons: list[tuple[str, float]]
    moves: int
    trace: Trace | None  # where it was asked for
    run: list[tuple[int, float]]  # program lines in the order of their execution, and when each ends

    @property
    def path_error(self) -> float | None:
        """lu: largest distance from the program's path, where a trace was asked for and bounds it."""
        return self.trace.path_error if self.trace is not None else None


def forecast(
    ini: IniFile | None, program: Path, machine: Machine, tools: Sequence[Any] = (), tool_change_s: float = 0.0,
    trace: bool = False, stands: Standing = HOME,
) -> Forecast:  # fmt: skip
    """Run a program; InterpError where it is wrong."""
    canon = ForecastCanon(machine, tools, tool_change_s, trace)
    canon.block_delete = stands.block_delete
    if stands.tool > 0:
        canon.change_tool_number(max(canon.get_external_tool_index(stands.tool), 0))
    interp = Interpreter(canon, ini)
    parameters = ini.path("RS274NGC", "PARAMETER_FILE", None) if ini else None
    if parameters and Path(parameters).exists():
        interp.load_parameters(str(parameters))
    interp.init()
    startup = ini.find("RS274NGC", "RS274NGC_STARTUP_CODE", "") if ini else ""
    if startup:
        interp.execute_mdi(startup)
    for block in stands.begin:
        interp.execute_mdi(block)
    interp.open(str(program))
    while interp.read() != INTERP_ENDFILE:
        code = interp.execute()
        if code == INTERP_EXIT:
            break
        if code == INTERP_EXECUTE_FINISH:
            canon.run_out()
            interp.synch()
    canon.run_out()
    return summarise(canon, machine)


def summarise(canon: ForecastCanon, machine: Machine) -> Forecast:
    """Add up what the canon has counted."""
    seconds, lost, reason = canon.by_line()
    motion, pauses = canon.by_section(), canon.pauses
    names = reason_names()
    reasons = sorted(zip(names, canon.reasons(), strict=True), key=lambda item: -item[1])
    trace = None
    if canon.keeps_trace:
        from emcmot.forecast_traces import trace_of

        trace = trace_of(canon, machine.start)
    return Forecast(
        seconds=canon.periods * canon.period + sum(pauses),
        sections=[
            (tool, operation, motion[k], pauses[k])
            for k, (tool, operation) in enumerate(canon.sections)
            if motion[k] or pauses[k]
        ],
        line_seconds=largest_first(seconds),
        line_lost=largest_first(lost),
        line_reason={line: names[number] for line, number in reason.items()},
        unbounded=canon.unbounded,
        reasons=[(name, value) for name, value in reasons if value >= 0.001],
        moves=canon.count,
        trace=trace,
        run=canon.run(),
    )


def reason_names() -> list[str]:
    """What a limit that was reached is called."""
    limits = ("jerk", "acceleration", "velocity")
    return [f"{limit} of {axis}" for limit in limits for axis in AXES] + ["corners, curves"]


def largest_first(seconds: dict[int, float]) -> dict[int, float]:
    """Seconds of lines that have any, the most first."""
    return dict(sorted(((line, value) for line, value in seconds.items() if value > 0.0), key=lambda item: -item[1]))


def clock_text(seconds: float) -> str:
    """Hours, minutes and seconds."""
    minutes, rest = divmod(seconds, 60)
    return f"{int(minutes // 60)}:{int(minutes % 60):02d}:{rest:06.3f}"


def report(result: Forecast) -> str:
    """The forecast as text."""
    out = [f"time {clock_text(result.seconds)}  ({result.seconds:.3f} s, {result.moves} moves)", ""]
    out += [f"{'tool':>5}  {'motion':>12}  {'pauses':>12}  operation"]
    for tool, operation, motion, pauses in sorted(result.sections, key=lambda item: -item[2] - item[3])[:30]:
        out.append(f"{f'T{tool}':>5}  {clock_text(motion):>12}  {clock_text(pauses):>12}  {operation}")
    if result.reasons:
        out += ["", "time lost against the programmed speed, by what was at its limit:"]
        out += [f"  {seconds:10.3f} s  {name}" for name, seconds in result.reasons[:SHOWN_LINES]]
        out += ["", "lines that lost most:"]
        out += [
            f"  line {line:>7}  {seconds:8.3f} s of {result.line_seconds[line]:.3f} s  {result.line_reason[line]}"
            for line, seconds in list(result.line_lost.items())[:SHOWN_LINES]
        ]
    if result.trace is not None:
        out += ["", f"largest distance from the program's path: {path_error_text(result)}"]
    return "\n".join(out)


def path_error_text(result: Forecast) -> str:
    """The worst path error, and what it does not say."""
    known = "n/a" if result.path_error is None else f"{result.path_error:.6f}"
    return f"{known} ({result.unbounded} moves in G64 without P, which sets no bound)" if result.unbounded else known


def as_json(result: Forecast, points: int) -> str:
    """The forecast for programs; the run of lines is thinned out to so many points."""
    run = result.run
    if len(run) > points:
        run = [run[k] for k in sorted({k * (len(run) - 1) // max(points - 1, 1) for k in range(points)})]
    return json.dumps(
        {
            "seconds": result.seconds,
            "moves": result.moves,
            "sections": result.sections,
            "lines": run,
            "reasons": result.reasons,
            "slow_lines": [
                [line, lost, result.line_seconds[line], result.line_reason.get(line, "")]
                for line, lost in list(result.line_lost.items())[:SHOWN_LINES]
            ],
            "path_error": result.path_error,
            "unbounded_moves": result.unbounded,
        }
    )


def parser() -> argparse.ArgumentParser:
    options = argparse.ArgumentParser(prog="linuxcnc-forecast", description=(__doc__ or "").split("\n\n")[0])
    options.add_argument("ini", metavar="INI", type=Path, help="configuration of the machine")
    options.add_argument("program", metavar="FILE", type=Path, help="G-code program")
    options.add_argument("--start", metavar="X,Y,...", help="where the machine stands, machine units (its home)")
    options.add_argument("--tool", type=int, default=0, metavar="N", help="the tool in the spindle")
    options.add_argument("--begin", metavar="BLOCK", action="append", default=[], help="blocks that come before")
    options.add_argument("--block-delete", action="store_true", help="lines that begin with / are skipped")
    options.add_argument("--toolchange", type=float, default=0.0, metavar="S", help="seconds that a tool change takes")
    options.add_argument("--trace", type=Path, metavar="FILE.npz", help="write positions and derivatives")
    options.add_argument("--path-error", action="store_true", help="say how far the tool gets from the program's path")
    options.add_argument("--json", metavar="FILE", help="write the forecast as JSON; - : to standard output, alone")
    options.add_argument("--json-points", type=int, default=20000, metavar="N", help="lines in it at most (20000)")
    options.add_argument("--png", type=Path, metavar="FILE.png", help="draw them")
    return options


def standing_at(machine: Machine, text: str | None) -> Machine:
    """The machine at the place that ``--start`` names."""
    if text is None:
        return machine
    try:
        place = [float(word) for word in text.split(",")]
    except ValueError:
        raise ConfigError(f"--start {text}: numbers with commas between them are needed, like 0,0,10") from None
    return replace(machine, start=(*place, *(0.0,) * 9)[:9])


def main(arguments: list[str] | None = None) -> int:
    """Run the command."""
    options = parser().parse_args(arguments)
    try:
        ini = IniFile(options.ini)
        table = ini.path("EMCIO", "TOOL_TABLE", None)
        tools = tooltable.load(table) if table else []
        traced = bool(options.trace or options.png or options.path_error)
        machine = standing_at(Machine.from_ini(ini), options.start)
        stands = Standing(options.tool, tuple(options.begin), options.block_delete)
        result = forecast(ini, options.program, machine, tools, options.toolchange, traced, stands)
        if options.json:
            text = as_json(result, options.json_points)
            if options.json == "-":
                print(text)
            else:
                Path(options.json).write_text(text)
        if options.json != "-":
            print(report(result))
        if result.trace is not None:
            if options.trace:
                result.trace.save(options.trace)
            if options.png:
                result.trace.draw(options.png)
    except (ConfigError, InterpError, OSError) as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
