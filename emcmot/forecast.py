"""``linuxcnc-forecast``: how long a job takes on a machine, and where it loses time, without the machine.

The program goes through the interpreter and the arithmetic that task uses into the trajectory planner that motion uses,
and the planner's servo periods are run as fast as they go: so the time is the machine's own. Talks to
``emcmot.forecast_canon`` (the canon that feeds and steps the planner), ``rs274ngc`` and the INI file; to no bus.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from emcmot.forecast_canon import ForecastCanon
from emcmot.forecast_error import path_error
from emcmot.forecast_machine import AXES, Machine
from nml.errors import ConfigError, InterpError
from nml.inifile import IniFile
from rs274ngc import tooltable
from rs274ngc.interp import INTERP_ENDFILE, INTERP_EXECUTE_FINISH, INTERP_EXIT, Interpreter

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
    path_error: float | None  # lu: largest distance from the program's path, where a trace was asked for and bounds it
    unbounded: int  # moves in G64 without P, which may leave their path as far as their speed asks for
    reasons: list[tuple[str, float]]
    moves: int
    positions: NDArray[np.float64]  # of every servo period, where a trace was asked for
    lines: NDArray[np.int64]  # program line of every servo period
    run: list[tuple[int, float]]  # program lines in the order of their execution, and when each ends
    start: tuple[float, ...]
    period: float


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
    times, lost = canon.times()
    lines, sections = np.array(canon.move_line), np.array(canon.move_section)
    motion = np.bincount(sections, weights=times, minlength=len(canon.sections))
    pauses = canon.pauses
    positions, ids = canon.trace()
    names = reason_names()
    reasons = sorted(zip(names, canon.reasons(), strict=True), key=lambda item: -item[1])
    return Forecast(
        seconds=canon.periods * canon.period + sum(pauses),
        sections=[
            (tool, operation, float(motion[k]), pauses[k])
            for k, (tool, operation) in enumerate(canon.sections)
            if motion[k] or pauses[k]
        ],
        line_seconds=by_line(lines, times),
        line_lost=by_line(lines, lost),
        line_reason=reasons_of_lines(lines, lost, canon.move_reasons(), names),
        path_error=path_error(canon.moves(), machine.start, positions, ids) if len(positions) else None,
        unbounded=canon.unbounded,
        reasons=[(name, seconds) for name, seconds in reasons if seconds >= 0.001],
        moves=len(lines) - 1,
        positions=positions,
        lines=lines[ids],
        start=machine.start,
        period=canon.period,
        run=run_of(lines, times),
    )


def reason_names() -> list[str]:
    """What a limit that was reached is called."""
    limits = ("jerk", "acceleration", "velocity")
    return [f"{limit} of {axis}" for limit in limits for axis in AXES] + ["corners, curves"]


def reasons_of_lines(
    lines: NDArray[np.int64], lost: NDArray[np.float64], reasons: NDArray[np.int8], names: list[str]
) -> dict[int, str]:
    """For each line that lost time, what cost its slowest move most."""
    order = np.argsort(lost)
    order = order[lost[order] > 0.0]
    return dict(zip(lines[order].tolist(), [names[reason] for reason in reasons[order].tolist()], strict=True))


def run_of(lines: NDArray[np.int64], times: NDArray[np.float64]) -> list[tuple[int, float]]:
    """Lines in the order of their moves, neighbours of one line as one, with the time of motion at the end of each."""
    ends = np.cumsum(times)
    last = np.flatnonzero(np.append(np.diff(lines) != 0, len(lines) > 0))
    last = last[lines[last] != 0]
    return list(zip(lines[last].tolist(), ends[last].round(4).tolist(), strict=True))


def by_line(lines: NDArray[np.int64], seconds: NDArray[np.float64]) -> dict[int, float]:
    """Sums of the moves of each program line, the largest first."""
    sums = np.bincount(lines, weights=seconds) if len(lines) else np.zeros(0)
    order = np.argsort(-sums)
    order = order[sums[order] > 0.0]
    return dict(zip(order.tolist(), sums[order].tolist(), strict=True))


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
    if len(result.positions):
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
        run = [run[k] for k in np.unique(np.linspace(0, len(run) - 1, points).astype(int))]
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


def traces(result: Forecast) -> dict[str, NDArray[Any]]:
    """Position, velocity, acceleration and jerk of every servo period by name, with time and program line."""
    rest = np.zeros((1, len(AXES)))
    velocity = np.diff(result.positions, axis=0, prepend=[result.start]) / result.period
    acceleration = np.diff(velocity, axis=0, prepend=rest) / result.period
    return {
        "time": (np.arange(len(result.positions)) + 1) * result.period,
        "position": result.positions,
        "velocity": velocity,
        "acceleration": acceleration,
        "jerk": np.diff(acceleration, axis=0, prepend=rest) / result.period,
        "line": result.lines,
    }


def draw(traced: dict[str, NDArray[Any]], path: Path) -> None:
    """A picture of the traces of the axes that move."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise ConfigError("pictures need the package matplotlib: pip install matplotlib") from None
    moving = [axis for axis in range(9) if np.ptp(traced["position"][:, axis]) > 0]
    figure = Figure(figsize=(12, 9), layout="constrained")
    rows = figure.subplots(4, 1, sharex=True)
    for row, name in zip(rows, ("position", "velocity", "acceleration", "jerk"), strict=True):
        for axis in moving:
            row.plot(traced["time"], traced[name][:, axis], label=AXES[axis], linewidth=0.8)
        row.set_ylabel(name)
        row.grid(alpha=0.3)
    rows[0].legend(loc="upper right", ncols=9)
    rows[-1].set_xlabel("time, s")
    figure.savefig(path, dpi=100)


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
        if options.trace:
            np.savez_compressed(options.trace, **traces(result))  # type: ignore[arg-type]
        if options.png:
            draw(traces(result), options.png)
    except (ConfigError, InterpError, OSError) as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
