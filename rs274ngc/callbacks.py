"""The canon of LinuxCNC's previews: it calls methods of a Python object, lengths in inches, offsets left to the object.

``next_line(linecode)`` comes before the first call of each line. A method that the object lacks is not called; the
questions (``get_tool``, ``get_axis_mask``, ...) have defaults. Module ``gcode`` is its door.
"""

from __future__ import annotations

from collections.abc import Callable
from operator import attrgetter
from typing import Any

from rs274ngc.canon import CANON_UNITS_INCHES, Tool
from rs274ngc.interp import Interpreter
from rs274ngc.offline import OfflineCanon

TOOLS_MAX = 1001
MM_PER_INCH = 25.4
G_FIELDS = {
    "motion_mode": 1, "block": 2, "plane": 3, "cutter_side": 4, "units": 5, "distance_mode": 6, "feed_mode": 7,
    "origin": 8, "tool_length_offset": 9, "retract_mode": 10, "path_mode": 11,
}  # fmt: skip
M_FIELDS = {"stopping": 1, "spindle": 2, "toolchange": 3, "mist": 4, "flood": 5, "overrides": 6}


class LineCode:
    """The codes in force before a line, and its number: what ``next_line`` is given."""

    __slots__ = ("_settings", "gcodes", "mcodes", "sequence_number")

    def __init__(self, interp: Interpreter) -> None:
        self.sequence_number = 0
        self.gcodes, self.mcodes, self._settings = (
            interp.active_g_codes(), interp.active_m_codes(), interp.active_settings(),
        )  # fmt: skip

    @property
    def feed_rate(self) -> float:
        return self._settings[1]

    @property
    def speed(self) -> float:
        return self._settings[2]


def _code(table: str, place: int) -> property:
    """The code of one modal group."""
    of_line = attrgetter(table)
    return property(lambda line: of_line(line)[place])


for _name, _place in G_FIELDS.items():
    setattr(LineCode, _name, _code("gcodes", _place))
for _name, _place in M_FIELDS.items():
    setattr(LineCode, _name, _code("mcodes", _place))


class CallbackCanon(OfflineCanon):
    """Turns canonical calls into method calls of ``target``."""

    def __init__(self, target: Any) -> None:
        self.target = target
        self.interp: Interpreter | None = None
        self.last_line = -1
        self.has_lines = callable(getattr(target, "next_line", None))
        self.code: LineCode | None = None
        units = self.asked("get_external_length_units", 1.0)
        super().__init__(
            length_units=float(units),
            angle_units=float(self.asked("get_external_angular_units", 1.0)),
            tools=self.tool_table(),
        )
        self.axis_mask = int(self.asked("get_axis_mask", 0x1FF))
        self.units = CANON_UNITS_INCHES
        self.feed = 1.0      # a preview needs no F word
        self.block_delete = bool(self.asked("get_block_delete", False))

    def asked(self, name: str, default: Any) -> Any:
        """What the object answers."""
        method = getattr(self.target, name, None)
        return method() if callable(method) else default

    def tool_table(self) -> list[Tool]:
        """The tools of ``get_tool(index)``: number, nine offsets, diameter, angles, orientation."""
        method = getattr(self.target, "get_tool", None)
        tools: list[Tool] = []
        if not callable(method):
            return tools
        for index in range(TOOLS_MAX):
            try:
                number, *rest = method(index)
            except (IndexError, TypeError, ValueError):
                break
            if index > 0:
                tools.append(Tool(int(number), index, tuple(rest[:9]), rest[9], rest[10], rest[11], int(rest[12])))
        while tools and tools[-1].toolno < 0:
            tools.pop()
        return tools

    def begin_line(self) -> None:
        """A line is about to be read: note the codes in force."""
        if self.interp is not None and self.has_lines:
            self.code = LineCode(self.interp)

    def tell(self, name: str, *arguments: Any) -> None:
        """Call a method of the object, ``next_line`` before it where a line begins."""
        if self.interp is not None and self.interp.line != self.last_line:
            self.last_line = self.interp.line
            if self.has_lines:
                code = self.code or LineCode(self.interp)
                code.sequence_number = self.last_line
                self.target.next_line(code)
        method = getattr(self.target, name, None)
        if callable(method):
            method(*arguments)

    def inches(self, values: tuple[float, ...]) -> tuple[float, ...]:
        """Nine coordinates in inches and degrees."""
        if self.units == CANON_UNITS_INCHES:
            return values
        x, y, z, a, b, c, u, v, w = values
        mm = MM_PER_INCH
        return x / mm, y / mm, z / mm, a, b, c, u / mm, v / mm, w / mm

    def length(self, value: float) -> float:
        return value if self.units == CANON_UNITS_INCHES else value / MM_PER_INCH

    # --- Motion

    def straight_traverse(self, line: int, *point: float) -> None:
        super().straight_traverse(line, *point)
        self.tell("straight_traverse", *self.inches(point))

    def straight_feed(self, line: int, *point: float) -> None:
        super().straight_feed(line, *point)
        self.tell("straight_feed", *self.inches(point))

    def straight_probe(self, line: int, *words: Any) -> None:
        super().straight_probe(line, *words)
        self.tell("straight_probe", *self.inches(words[:9]))

    def rigid_tap(self, line: int, x: float, y: float, z: float, scale: float) -> None:
        self.tell("rigid_tap", self.length(x), self.length(y), self.length(z))

    def arc_feed(self, line: int, *words: Any) -> None:
        super().arc_feed(line, *words)
        first, second, centre_first, centre_second, rotation, height, *others = words
        a, b, c, u, v, w = others
        ends = (self.length(value) for value in (first, second, centre_first, centre_second))
        self.tell(
            "arc_feed", *ends, rotation, self.length(height), a, b, c, self.length(u), self.length(v), self.length(w)
        )

    # --- Offsets, modes, tools

    def set_g5x_offset(self, index: int, *offset: float) -> None:
        super().set_g5x_offset(index, *offset)
        self.tell("set_g5x_offset", index, *self.inches(offset))

    def set_g92_offset(self, *offset: float) -> None:
        super().set_g92_offset(*offset)
        self.tell("set_g92_offset", *self.inches(offset))

    def set_xy_rotation(self, theta: float) -> None:
        super().set_xy_rotation(theta)
        self.tell("set_xy_rotation", theta)

    def use_tool_length_offset(self, *offset: float) -> None:
        super().use_tool_length_offset(*offset)
        self.tell("tool_offset", *self.inches(offset))

    def select_plane(self, plane: int) -> None:
        super().select_plane(plane)
        self.tell("set_plane", plane)

    def set_feed_rate(self, rate: float) -> None:
        super().set_feed_rate(rate)
        self.tell("set_feed_rate", self.length(rate))

    def set_traverse_rate(self, rate: float) -> None:
        self.tell("set_traverse_rate", self.length(rate))

    def change_tool(self) -> None:
        super().change_tool()
        self.tell("change_tool", self.slot)

    def user_command_exists(self, number: int) -> bool:
        return True

    def user_command(self, number: int, p: float, q: float) -> None:
        self.tell("user_defined_function", number - 100, p, q)


def telling(name: str) -> Callable[..., None]:
    """A canonical call that the object gets as it is."""

    def method(self: CallbackCanon, *arguments: Any) -> None:
        self.tell(name, *arguments)

    return method


for _name in ("dwell", "message", "comment"):
    setattr(CallbackCanon, _name, telling(_name))
