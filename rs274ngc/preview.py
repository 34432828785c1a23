"""A program's moves as arrays, without a machine: for a display's tool path, plots and statistics.

``load`` runs a program to its end (one that waits or probes does not wait here) and returns its moves, all at once or
in pieces while it goes on. ``python -m rs274ngc.preview PROGRAM -i INI`` does the same in a process of its own and
writes the pieces to its standard output, so that a server goes on serving meanwhile: frames of one line of JSON,
followed by ``bytes`` bytes of rows (``geometry.ROW``, little-endian):

    {"frame": "rows", "rows": n, "bytes": n * row size, "done": share of the program read, 0 to 1}
    {"frame": "end", "bytes": 0, "moves": n, "tools": [...], "error": null or {"message", "file", "line", "column"}}
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from nml.errors import ConfigError, InterpError
from nml.inifile import IniFile
from rs274ngc import settings, tooltable
from rs274ngc.geometry import ROW, GeometryCanon
from rs274ngc.interp import Interpreter


class Cancelled(Exception):
    """``progress`` asked for the end."""


@dataclass(frozen=True, slots=True)
class Preview:
    """What came of a program: its rows (none when they were handed on), and the error that ended it, if one did."""

    rows: Any
    moves: int
    tools: list[int]
    dwell_s: float
    error: InterpError | None
    cancelled: bool


def machine_of(ini: Any) -> dict[str, Any]:
    """Units and tools of the machine of an INI file, for a canon; without one those of ``rs274``."""
    if ini is None:
        return {"tools": tooltable.DEFAULT}
    machine: dict[str, Any] = {"length_units": settings.units_per_mm(ini)}
    table = ini.find("EMCIO", "TOOL_TABLE")
    if table is not None:
        machine["tools"] = tooltable.load(settings.expanded(settings.folder_of(ini), table))
    return machine


def load(
    path: str | os.PathLike[str],
    ini: Any = None,
    *,
    progress: Callable[[float], object] | None = None,
    on_rows: Callable[[Any], None] | None = None,
    piece: int = 1 << 16,
    chord_error: float = 0.01,
    parameter_file: str | None = None,
    **machine: Any,
) -> Preview:
    """Run a program on a geometry canon.

    ``progress(share read, 0 to 1)`` is called every thousand lines and cancels by returning something true. With
    ``on_rows(array)`` every ``piece`` rows are handed on instead of being kept. ``parameter_file`` is read, never
    written; without it the one of ``ini`` is. ``chord_error``: mm. ``machine``: what an OfflineCanon takes, instead of
    what ``ini`` says.
    """
    moves = 0

    def count(rows: Any) -> None:
        nonlocal moves
        moves += len(rows)
        if on_rows is not None:
            on_rows(rows)

    def look(share: float) -> None:
        if progress is not None and progress(share):
            raise Cancelled

    kept = on_rows is None
    canon = GeometryCanon(chord_error, None if kept else count, piece, **{**machine_of(ini), **machine})
    if ini is not None:
        canon.axis_mask = settings.axis_mask(ini)
    interp = Interpreter(canon, ini)
    interp.parameter_file = parameter_file or interp.parameter_file
    error, cancelled = None, False
    try:
        interp.init()
        interp.open(path)
        interp.run_file(on_progress=look)
    except InterpError as reason:
        error = reason
    except Cancelled:
        cancelled = True
    finally:
        interp.close()
    if not kept:
        canon.hand_on()
    rows = canon.table() if kept else np.empty(0, ROW)
    return Preview(rows, len(rows) if kept else moves, canon.tools_used, canon.dwell_time, error, cancelled)


def error_frame(error: InterpError | None) -> dict[str, Any] | None:
    """The error of a program as JSON values."""
    if error is None:
        return None
    place = error.place
    where = {"file": place.file, "line": place.line, "column": place.column} if place is not None else {}
    return {"message": error.message, **where}


def main(arguments: list[str] | None = None) -> int:
    """Write a program's frames to the standard output; 0: the program was right."""
    options = argparse.ArgumentParser(prog="python -m rs274ngc.preview", description="A program's moves as frames.")
    options.add_argument("program")
    options.add_argument("-i", dest="ini", metavar="FILE.INI", help="INI file of the machine")
    options.add_argument("--piece", type=int, default=1 << 14, help="rows of a frame")
    options.add_argument("--chord-error", type=float, default=0.01, help="how far a chord may be from its arc, mm")
    chosen = options.parse_args(arguments)
    out = sys.stdout.buffer
    done = 0.0

    def frame(values: dict[str, Any], data: bytes = b"") -> None:
        out.write(json.dumps({**values, "bytes": len(data)}).encode() + b"\n" + data)
        out.flush()

    def note(share: float) -> None:
        nonlocal done
        done = share

    def send(rows: Any) -> None:
        frame({"frame": "rows", "rows": len(rows), "done": done}, rows.tobytes())

    try:
        result = load(
            chosen.program,
            IniFile(chosen.ini) if chosen.ini else None,
            progress=note,
            on_rows=send,
            piece=chosen.piece,
            chord_error=chosen.chord_error,
        )
        frame({"frame": "end", "moves": result.moves, "tools": result.tools, "error": error_frame(result.error)})
    except BrokenPipeError:     # nobody wants it any more
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        return 1
    except ConfigError as error:
        print(error, file=sys.stderr)
        return 1
    return 0 if result.error is None else 1


if __name__ == "__main__":
    sys.exit(main())
