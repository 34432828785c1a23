"""LinuxCNC's preview module: run a program and hear of its moves; lengths in inches.

    result, line = gcode.parse(filename, canon, ["G20", "G40 G49"])
    if result > gcode.MIN_ERROR:
        print(f"{filename}:{line}: {gcode.strerror(result)}")

``canon`` is an object with LinuxCNC's callbacks (``rs274.interpret`` has the usual ones); its ``parameter_file`` is
read. Remapped codes and subroutine folders are those of the INI file that INI_FILE_NAME of the environment names.
"""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from itertools import product
from math import atan2, cos, hypot, pi, sin, tau
from typing import Any

from nml.errors import ConfigError, InterpError
from nml.inifile import IniFile
from rs274ngc.callbacks import CallbackCanon, LineCode
from rs274ngc.interp import INTERP_ENDFILE, INTERP_EXIT, INTERP_OK, Interpreter

MIN_ERROR, MAX_ERROR = 3, -1
INTERP_ERROR = 5
NOWHERE = 9e99
SEGMENTS_MIN = 3
ASKED_EVERY_S = 1.0  # how often a display is asked whether it wants to abort
START, END = 1, 2  # places of a move's ends
PLANE_AXES = {1: (0, 1, 2), 2: (1, 2, 0), 3: (2, 0, 1)}

linecode = LineCode
_last_error = ""


def parse(filename: str, canon: Any, *codes: str | list[str]) -> tuple[int, int]:
    """Run a program: (result, number of the last line); results above MIN_ERROR are errors, see ``strerror``.

    ``codes``: a list of lines that are run before it, or one or two such lines; a last text names one of LinuxCNC's
    other interpreters, of which there is none. ``canon.check_abort()`` is asked once a second; when it says yes,
    KeyboardInterrupt is raised.
    """
    global _last_error
    _last_error = ""
    lines = _lines_before(codes)
    machine = CallbackCanon(canon)
    path = os.environ.get("INI_FILE_NAME")
    try:
        interp = Interpreter(machine, IniFile(path) if path and os.path.exists(path) else None)
        machine.interp = interp
        interp.parameter_file = getattr(canon, "parameter_file", None) or None
        interp.init()
        try:
            for line in lines:
                if interp.execute_mdi(line) == INTERP_EXIT:
                    return INTERP_EXIT, 0
        except InterpError as error:
            _last_error = error.message
            return INTERP_ERROR, 0
        interp.open(filename)
        return _run(interp, machine)
    except InterpError as error:
        _last_error = error.message
        return INTERP_ERROR, error.place.line if error.place is not None else 0
    except ConfigError as error:
        _last_error = str(error)
        return INTERP_ERROR, 0


def _lines_before(codes: tuple[str | list[str], ...]) -> list[str]:
    """The lines to run before the program. TypeError as LinuxCNC's module."""
    given: list[Any] = list(codes)
    lines = given[:2]
    if given and isinstance(given[0], list) and len(given) < 3:
        lines = given.pop(0)
    for number, value in enumerate([*given, *lines], 3):
        if not isinstance(value, str):
            raise TypeError(f"parse() argument {number} must be str, not {type(value).__name__}")
    return [line for line in lines if line]


def _run(interp: Interpreter, machine: CallbackCanon) -> tuple[int, int]:
    """Line after line."""
    asked = getattr(machine.target, "check_abort", None)
    result = INTERP_OK
    next_time = time.monotonic() + ASKED_EVERY_S
    try:
        while result not in (INTERP_EXIT, INTERP_ENDFILE):
            if callable(asked) and time.monotonic() >= next_time:
                next_time += ASKED_EVERY_S
                if asked():
                    raise KeyboardInterrupt
            machine.begin_line()
            result = interp.read()
            if result != INTERP_ENDFILE:
                result = interp.execute()
        return result, interp.line
    finally:
        interp.close()


def strerror(result: int) -> str:
    """The text of the error that ``parse`` returned."""
    return _last_error if result > MIN_ERROR else ""


def calc_extents(*lists: Sequence[Sequence[Any]]) -> tuple[list[float], list[float], list[float], list[float]]:
    """Lowest and highest X, Y, Z of moves, as they are and with their tool offsets left out.

    A move is (line, start, end, ..., tool offset), as LinuxCNC's displays keep it.
    """
    low, high = [NOWHERE] * 3, [-NOWHERE] * 3
    low_bare, high_bare = [NOWHERE] * 3, [-NOWHERE] * 3
    of_tool: dict[tuple[float, ...], list[Sequence[Any]]] = {}
    for moves in lists:
        for move in moves:
            of_tool.setdefault(tuple(move[-1]), []).append(move)
    for offset, moves in of_tool.items():
        for axis, place in product(range(3), (START, END)):
            values = [move[place][axis] for move in moves]
            least, most = min(values), max(values)
            low[axis], high[axis] = min(low[axis], least), max(high[axis], most)
            low_bare[axis] = min(low_bare[axis], least + offset[axis])
            high_bare[axis] = max(high_bare[axis], most + offset[axis])
    return low, high, low_bare, high_bare


def arc_to_segments(
    canon: Any, x1: float, y1: float, cx: float, cy: float, rot: int, z1: float, *words: float
) -> list[tuple[float, ...]]:
    """The points of an arc in machine coordinates; ``words``: A to W of its end, the segments of half a turn.

    The arc begins at ``canon.lo`` and lies in ``canon.plane``; offsets and rotation are the canon's, as
    ``rs274.interpret.Translated`` keeps them.
    """
    *others, division = words
    first, second, third = PLANE_AXES[canon.plane]
    begin = _untranslated(canon, canon.lo)
    start_angle = atan2(begin[second] - cy, begin[first] - cx)
    angle = atan2(y1 - cy, x1 - cx) - start_angle
    if rot < 0:
        while angle - 1e-12 >= 0.0:
            angle -= tau
        angle = (angle or -tau) + (rot + 1) * tau
    else:
        while angle + 1e-12 <= 0.0:
            angle += tau
        angle = (angle or tau) + (rot - 1) * tau
    if abs(angle) < 1e-12:
        angle = tau if rot > 0 else -tau
    radius, end_radius = hypot(begin[first] - cx, begin[second] - cy), hypot(x1 - cx, y1 - cy)
    end = [0.0] * 3 + list(others)
    end[first], end[second], end[third] = x1, y1, z1
    steps = max(SEGMENTS_MIN, int(division * abs(angle) / pi + 1e-9))
    points = []
    for step in range(1, steps):
        share = step / steps
        point = [a + share * (b - a) for a, b in zip(begin, end, strict=True)]
        here = radius + share * (end_radius - radius)
        point[first] = cx + here * cos(start_angle + share * angle)
        point[second] = cy + here * sin(start_angle + share * angle)
        points.append(canon.rotate_and_translate(*point))
    points.append(canon.rotate_and_translate(*end))
    return points


def _untranslated(canon: Any, point: Sequence[float]) -> list[float]:
    """A machine point in program coordinates."""
    values = [value - getattr(canon, f"g5x_offset_{axis}") for axis, value in zip("xyzabcuvw", point, strict=True)]
    if canon.rotation_xy:
        x, y = values[:2]
        values[0] = x * canon.rotation_cos + y * canon.rotation_sin
        values[1] = y * canon.rotation_cos - x * canon.rotation_sin
    return [value - getattr(canon, f"g92_offset_{axis}") for axis, value in zip("xyzabcuvw", values, strict=True)]
