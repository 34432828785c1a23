"""Callbacks for ``gcode.parse``: classes that a display mixes into its own canon, with LinuxCNC's names.

``Translated`` turns program coordinates into machine coordinates and calls ``straight_traverse_translated`` and
``straight_feed_translated``; ``ArcsToSegmentsMixin`` makes points of arcs for ``straight_arcsegments``; ``StatMixin``
answers from a ``linuxcnc.stat``; ``PrintCanon`` shows the calls. Lengths are inches.
"""

from __future__ import annotations

from math import cos, radians, sin
from typing import Any

import gcode

AXES = "xyzabcuvw"
NO_TOOL = (-1, *(0.0,) * 12, 0)


class Translated:
    """Knows the offsets in force."""

    g5x_offset_x = g5x_offset_y = g5x_offset_z = 0.0
    g5x_offset_a = g5x_offset_b = g5x_offset_c = 0.0
    g5x_offset_u = g5x_offset_v = g5x_offset_w = 0.0
    g92_offset_x = g92_offset_y = g92_offset_z = 0.0
    g92_offset_a = g92_offset_b = g92_offset_c = 0.0
    g92_offset_u = g92_offset_v = g92_offset_w = 0.0
    rotation_xy = 0.0
    rotation_cos, rotation_sin = 1.0, 0.0

    def rotate_and_translate(
        self, x: float, y: float, z: float, a: float, b: float, c: float, u: float, v: float, w: float
    ) -> tuple[float, ...]:
        """Nine program coordinates as machine coordinates."""
        x += self.g92_offset_x
        y += self.g92_offset_y
        if self.rotation_xy:
            x, y = x * self.rotation_cos - y * self.rotation_sin, x * self.rotation_sin + y * self.rotation_cos
        return (
            x + self.g5x_offset_x,
            y + self.g5x_offset_y,
            z + self.g92_offset_z + self.g5x_offset_z,
            a + self.g92_offset_a + self.g5x_offset_a,
            b + self.g92_offset_b + self.g5x_offset_b,
            c + self.g92_offset_c + self.g5x_offset_c,
            u + self.g92_offset_u + self.g5x_offset_u,
            v + self.g92_offset_v + self.g5x_offset_v,
            w + self.g92_offset_w + self.g5x_offset_w,
        )

    def straight_traverse(self, *point: float) -> None:
        self.straight_traverse_translated(*self.rotate_and_translate(*point))

    def straight_feed(self, *point: float) -> None:
        self.straight_feed_translated(*self.rotate_and_translate(*point))

    def straight_traverse_translated(self, *point: float) -> None:
        """A rapid to a machine point."""

    def straight_feed_translated(self, *point: float) -> None:
        """A feed to a machine point."""

    def set_g5x_offset(self, index: int, *offset: float) -> None:
        self.g5x_index = index
        for axis, value in zip(AXES, offset, strict=False):
            setattr(self, f"g5x_offset_{axis}", value)

    def set_g92_offset(self, *offset: float) -> None:
        for axis, value in zip(AXES, offset, strict=False):
            setattr(self, f"g92_offset_{axis}", value)

    def set_xy_rotation(self, theta: float) -> None:
        self.rotation_xy = theta
        self.rotation_cos, self.rotation_sin = cos(radians(theta)), sin(radians(theta))


class ArcsToSegmentsMixin:
    """Arcs as points; ``arcdivision`` of them in half a turn."""

    plane = 1
    arcdivision = 64

    def set_plane(self, plane: int) -> None:
        self.plane = plane

    def arc_feed(self, *words: Any) -> None:
        self.straight_arcsegments(gcode.arc_to_segments(self, *words, self.arcdivision))

    def straight_arcsegments(self, segments: list[tuple[float, ...]]) -> None:
        """The machine points of an arc."""


class PrintCanon:
    """Shows each call on the standard output."""

    def next_line(self, state: Any) -> None:
        self.state = state
        print("next_line", state.sequence_number)

    def __getattr__(self, name: str) -> Any:
        if name.startswith(("_", "get_", "check_", "is_")) or name == "parameter_file":
            raise AttributeError(name)
        return lambda *arguments: print(name, *arguments)


class StatMixin:
    """Answers what the interpreter asks from a ``linuxcnc.stat`` that was polled."""

    def __init__(self, stat: Any, random: bool) -> None:
        self.s, self.random = stat, random
        self.tools = list(stat.tool_table)
        self.block_delete = bool(stat.block_delete)

    def get_tool(self, index: int) -> tuple[Any, ...]:
        """Entry ``index`` of the tool table, number -1 where there is none."""
        return tuple(self.tools[index]) if 0 <= index < len(self.tools) else NO_TOOL

    def change_tool(self, index: int) -> None:
        """The tool of this entry comes into the spindle; a random changer puts the old one into its place."""
        if not 0 <= index < len(self.tools):
            return
        if self.random:
            self.tools[0], self.tools[index] = self.tools[index], self.tools[0]
        else:
            self.tools[0] = self.tools[index] if index else NO_TOOL

    def get_external_angular_units(self) -> float:
        return self.s.angular_units or 1.0

    def get_external_length_units(self) -> float:
        return self.s.linear_units or 1.0

    def get_axis_mask(self) -> int:
        return self.s.axis_mask

    def get_block_delete(self) -> bool:
        return self.block_delete
