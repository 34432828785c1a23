"""What a program would do on a machine: its moves, its limits, its state at a line. A worker process for displays.

    python -m rs274ngc.dryrun PROGRAM -i INI          the moves as frames, as ``rs274ngc.preview`` writes them
    python -m rs274ngc.dryrun --check PROGRAM -i INI  only whether it is right
    python -m rs274ngc.dryrun --state-at N PROGRAM -i INI
    python -m rs274ngc.dryrun --mdi 'G1 X5 F100' -i INI

With ``--wait`` alone the arguments come later, as a JSON list in one line of the standard input. The last three
answer with one line of JSON. The machine begins at ``--start`` (machine coordinates, machine units), with ``--tool``
in its spindle, with the coordinate systems of the INI file's parameter file, after the blocks ``--begin``.

The end frame says whether the picture is to be trusted: ``outside`` has every move whose controlled point (the
tool's tip plus the tool offset in force) leaves the limits of the INI file, arcs widened by the chord error, and
``notes`` what had to be assumed: a probe's result, an input, a value of HAL. Nothing outside and nothing assumed is
an all-clear.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from nml.errors import ConfigError, InterpError
from nml.inifile import IniFile
from rs274ngc import settings
from rs274ngc.canon import AXES, CANON_UNITS_INCHES
from rs274ngc.geometry import ARC, FEED, PROBE, GeometryCanon
from rs274ngc.interp import INTERP_ENDFILE, INTERP_EXECUTE_FINISH, INTERP_EXIT, Interpreter
from rs274ngc.preview import error_frame, machine_of

JUMP = 4  # kind of the first row: where the tool stands before the program
CHORD_ERROR = 0.01  # mm
HAND_ON = 0.3  # s between pieces of a slow program
MOST_LISTED = 100
NICENESS = 10
TOLERANCE = 1e-6  # machine units beyond a limit that still count as at the limit
ROTARY = slice(3, 6)
MM_PER_INCH = 25.4


class Limits:
    """Watches rows go by: what they reach, and what leaves the machine's limits."""

    def __init__(self, ini: IniFile) -> None:
        letters = {letter for letter in (ini.find("TRAJ", "COORDINATES") or "").upper() if letter in AXES}
        self.scale = np.full(9, settings.units_per_mm(ini))
        self.scale[ROTARY] = 1.0
        self._low = np.array([self._limit(ini, letter, "MIN", -np.inf, letters) for letter in AXES])
        self._high = np.array([self._limit(ini, letter, "MAX", np.inf, letters) for letter in AXES])
        self._margin = CHORD_ERROR * self.scale
        self.outside: list[dict[str, Any]] = []
        self.count = 0
        self.last = np.zeros(9)
        """Where the controlled point was last."""
        self._all = (np.full(9, np.inf), np.full(9, -np.inf))
        self._feed = (np.full(9, np.inf), np.full(9, -np.inf))

    @staticmethod
    def _limit(ini: IniFile, letter: str, which: str, none: float, letters: set[str]) -> float:
        return ini.real(f"AXIS_{letter}", f"{which}_LIMIT", none) if letter in letters else none

    def look(self, rows: Any, offsets: Any) -> None:
        """One piece of rows, with the tool offset of each (mm)."""
        tips = rows["end"] * self.scale
        self._reach(self._all, tips)
        self._reach(self._feed, tips[np.isin(rows["kind"], (FEED, ARC, PROBE))])
        moves = rows["kind"] != JUMP
        margin = np.where((rows["kind"] == ARC)[:, None], self._margin, 0.0)
        points = tips + offsets * self.scale
        self.last = points[-1] if len(points) else self.last
        for limit, beyond in (
            (self._low, points - margin < self._low - TOLERANCE),
            (self._high, points + margin > self._high + TOLERANCE),
        ):
            found = np.argwhere(beyond & moves[:, None])
            self.count += len(found)
            for row, axis in found[: MOST_LISTED - len(self.outside)]:
                self.outside.append(
                    {
                        "line": int(rows["line"][row]), "axis": AXES[axis], "value": float(points[row, axis]),
                        "limit": float(limit[axis]),
                    }
                )  # fmt: skip

    @staticmethod
    def _reach(reached: tuple[Any, Any], points: Any) -> None:
        if len(points):
            np.minimum(reached[0], points.min(axis=0), out=reached[0])
            np.maximum(reached[1], points.max(axis=0), out=reached[1])

    def extents(self) -> dict[str, Any]:
        """What all moves and what the cutting moves reach, least and greatest; null where there are none."""

        def pair(reached: tuple[Any, Any]) -> list[list[float]] | None:
            return [part.tolist() for part in reached] if np.isfinite(reached[0]).all() else None

        return {"all": pair(self._all), "feed": pair(self._feed)}


class DryRunCanon(GeometryCanon):
    """Notes what had to be assumed, and the tool offset that each row is made with."""

    def __init__(self, **options: Any) -> None:
        super().__init__(CHORD_ERROR, **options)
        self.notes: list[dict[str, Any]] = []
        self.interp: Any = None
        self.handed = 0  # rows that were handed on
        self._offsets: list[tuple[int, tuple[float, ...]]] = [(0, (0.0,) * 9)]

    def note(self, text: str) -> None:
        """Something was assumed in this line."""
        line = self.interp.line if self.interp is not None else 0
        if len(self.notes) < MOST_LISTED and all(note["line"] != line or note["text"] != text for note in self.notes):
            self.notes.append({"line": line, "text": text})

    def offsets(self, first: int, count: int) -> Any:
        """Tool offsets in mm and degrees of the rows from ``first``."""
        made = np.empty((count, 9))
        for row, offset in self._offsets:
            made[max(row - first, 0) :] = offset
        self._offsets = self._offsets[-1:]
        return made

    def use_tool_length_offset(
        self, x: float, y: float, z: float, a: float, b: float, c: float, u: float, v: float, w: float,
    ) -> None:  # fmt: skip
        factor = MM_PER_INCH if self.get_external_length_unit_type() == CANON_UNITS_INCHES else 1.0
        self._offsets.append(
            (
                self.handed + self.count,
                (x * factor, y * factor, z * factor, a, b, c, u * factor, v * factor, w * factor),
            )
        )
        super().use_tool_length_offset(x, y, z, a, b, c, u, v, w)

    def straight_probe(
        self, line: int, x: float, y: float, z: float, a: float, b: float, c: float, u: float, v: float, w: float,
        probe_type: int,
    ) -> None:  # fmt: skip
        self.note("the result of a probe is assumed")
        super().straight_probe(line, x, y, z, a, b, c, u, v, w, probe_type)

    def wait(self, index: int, input_type: int, wait_type: int, timeout: float) -> int:
        self.note("the result of M66 is assumed")
        return super().wait(index, input_type, wait_type, timeout)

    def user_command(self, number: int, p: float, q: float) -> None:
        self.note(f"M{number} is not executed")
        super().user_command(number, p, q)

    def get_external_parameter(self, name: str) -> Any:
        value = super().get_external_parameter(name)
        if name.startswith("_hal["):
            self.note(f"#<{name}> is assumed")
            return 0.0 if value is None else value
        return value


class DryRun:
    """One program or block on a machine as it is now."""

    def __init__(self, ini: IniFile, chosen: argparse.Namespace, on_rows: Any = None) -> None:
        self.ini = ini
        self.limits = Limits(ini)
        self._on_rows = on_rows
        self.done = 0.0
        self._handed_at = time.monotonic()
        self.canon = DryRunCanon(on_rows=self._take, piece=chosen.piece, **machine_of(ini))
        self.canon.axis_mask = settings.axis_mask(ini)
        self.canon.block_delete = chosen.block_delete
        start = [float(word) for word in chosen.start.split(",")] if chosen.start else [0.0] * 9
        self.canon.straight_traverse(0, *(np.array((start + [0.0] * 9)[:9]) / self.limits.scale))
        self.interp = self.canon.interp = Interpreter(self.canon, ini)
        if chosen.tool > 0:
            self._load(chosen.tool)
        self.interp.init()
        for block in chosen.begin:
            self.interp.execute_mdi(block)

    def _load(self, tool: int) -> None:
        index = self.canon.get_external_tool_index(tool)
        if index > 0:
            self.canon.change_tool_number(index)
        else:
            self.canon.note(f"tool {tool} is not in the tool table")

    def _take(self, rows: Any) -> None:
        """Rows that the canon hands on."""
        first = self.canon.handed
        if first == 0:
            rows = rows.copy()
            rows["kind"][0] = JUMP
        self.limits.look(rows, self.canon.offsets(first, len(rows)))
        self.canon.handed += len(rows)
        self._handed_at = time.monotonic()
        if self._on_rows is not None:
            self._on_rows(rows)

    def _progress(self, share: float) -> None:
        self.done = share
        if time.monotonic() - self._handed_at > HAND_ON and self.canon.count:
            self.canon.hand_on()

    def run(self, program: str) -> InterpError | None:
        """The whole program; the error that ended it."""
        error = None
        try:
            self.interp.open(program)
            self.interp.run_file(on_progress=self._progress)
        except InterpError as reason:
            error = reason
        self.canon.hand_on()
        return error

    def run_block(self, text: str) -> InterpError | None:
        """One line of MDI."""
        error = None
        try:
            self.interp.execute_mdi(text)
        except InterpError as reason:
            error = reason
        self.canon.hand_on()
        return error

    def advance_to(self, program: str, line: int) -> str | None:
        """Run until a line is next; why it never is, or None. InterpError for what is wrong before it."""
        interp = self.interp
        interp.open(program)
        path = interp.flow.source.path
        while not ((source := interp.flow.source) is not None and source.line + 1 == line and source.path == path):
            if interp.read() == INTERP_ENDFILE:
                return f"the program never comes to line {line}"
            code = interp.execute()
            if code == INTERP_EXIT:
                return f"the program ends before line {line}"
            if code == INTERP_EXECUTE_FINISH:
                interp.synch()
        return None

    def state(self) -> dict[str, Any]:
        """Codes, tool, feed, speed and place as they are now, for people."""
        self.canon.hand_on()
        codes = self.interp.active_g_codes()[1:]
        return {
            "gcodes": [f"G{code // 10}" + (f".{code % 10}" if code % 10 else "") for code in codes if code >= 0],
            "mcodes": [f"M{code}" for code in self.interp.active_m_codes()[1:] if code >= 0],
            "feed": self.interp.active_settings()[1],
            "speed": self.interp.active_settings()[2],
            "tool": max(0, self.canon.get_external_tool_table(0).toolno),
            "position": self.place(),
        }

    def place(self) -> list[float]:
        """The controlled point: machine coordinates, machine units."""
        return [float(value) for value in self.limits.last]

    def verdict(self, error: InterpError | None) -> dict[str, Any]:
        """What the end frame says."""
        return {
            "moves": self.canon.handed,
            "tools": self.canon.tools_used,
            "error": error_frame(error),
            "notes": self.canon.notes,
            "outside": self.limits.outside,
            "outside_count": self.limits.count,
            "extents": self.limits.extents(),
        }


def parser() -> argparse.ArgumentParser:
    options = argparse.ArgumentParser(prog="python -m rs274ngc.dryrun", description="What a program would do.")
    options.add_argument("program", nargs="?")
    options.add_argument("-i", dest="ini", metavar="FILE.INI", required=True, help="INI file of the machine")
    options.add_argument("--check", action="store_true", help="only whether the program is right")
    options.add_argument("--state-at", type=int, metavar="LINE", help="the state when a line is next")
    options.add_argument("--mdi", metavar="BLOCK", help="one line in place of a program")
    options.add_argument("--begin", metavar="BLOCK", action="append", default=[], help="blocks that come before")
    options.add_argument("--start", metavar="X,Y,...", help="where the machine stands")
    options.add_argument("--tool", type=int, default=0, help="the tool in the spindle")
    options.add_argument("--block-delete", action="store_true", help="lines that begin with / are skipped")
    options.add_argument("--piece", type=int, default=1 << 13, help="rows of a frame")
    return options


def main(arguments: list[str] | None = None) -> int:
    """Entry point; 0: the program is right."""
    given = sys.argv[1:] if arguments is None else arguments
    if given == ["--wait"]:
        line = sys.stdin.readline()
        if not line:  # whoever started it has ended
            return 0
        given = json.loads(line)
    chosen = parser().parse_args(given)
    try:
        ini = IniFile(Path(chosen.ini))
        if chosen.mdi is None and chosen.program is None:
            raise ConfigError("a program or --mdi BLOCK is needed")
        return stream(ini, chosen) if not (chosen.check or chosen.state_at or chosen.mdi) else answer(ini, chosen)
    except BrokenPipeError:  # nobody wants it any more
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        return 1
    except (ConfigError, OSError, ValueError) as error:
        print(error, file=sys.stderr)
        return 1


def stream(ini: IniFile, chosen: argparse.Namespace) -> int:
    """Frames on the standard output."""
    out = sys.stdout.buffer

    def frame(values: dict[str, Any], data: bytes = b"") -> None:
        out.write(json.dumps({**values, "bytes": len(data)}).encode() + b"\n" + data)
        out.flush()

    def send(rows: Any) -> None:
        frame({"frame": "rows", "rows": len(rows), "done": run.done}, rows.tobytes())
        if run.canon.handed == len(rows):  # there is a first picture; the rest must not hold anybody up
            os.nice(NICENESS)

    run = DryRun(ini, chosen, send)
    error = run.run(chosen.program)
    frame({"frame": "end", **run.verdict(error)})
    return 0 if error is None else 1


def answer(ini: IniFile, chosen: argparse.Namespace) -> int:
    """One line of JSON on the standard output."""
    run = DryRun(ini, chosen)
    found: dict[str, Any] = {}
    error = None
    if chosen.state_at:
        try:
            blocked = run.advance_to(chosen.program, chosen.state_at)
        except InterpError as reason:
            error, blocked = reason, None
        found = {**run.state(), "blocked": blocked}
    elif chosen.mdi is not None:
        error = run.run_block(chosen.mdi)
        found = {"end": run.place(), "ok": error is None}
    else:
        error = run.run(chosen.program)
    print(json.dumps({**found, **run.verdict(error)}))
    return 0 if error is None else 1


if __name__ == "__main__":
    sys.exit(main())
