"""What the interpreter may ask of the machine: position, probe, tools, spindle, inputs, as task knows them.

The answers come from the latest status of motion and io. The interpreter only asks when it synchronises, and then both
have finished everything that was queued before, so that an answer can never be older than the program.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from emctask.config import MachineConfig
from emctask.ioclient import IoClient
from emctask.motion import MotionClient
from nml.emc.emcmot import MAX_SPINDLES, Enables
from rs274ngc.canon import (
    CANON_CLOCKWISE,
    CANON_CONTINUOUS,
    CANON_COUNTERCLOCKWISE,
    CANON_PLANE_XY,
    CANON_STOPPED,
    CANON_UNITS_INCHES,
    Tool,
)
from rs274ngc.moves import MoveCanon

NO_OFFSET = (0.0,) * 9
UNSET_TOLERANCE_MM = 0.0254
"""What LinuxCNC shows as path tolerance until a program sets one; the planner has none then."""


class SpindleState:
    """What the program asked of one spindle."""

    __slots__ = ("css_maximum", "direction", "speed")

    def __init__(self) -> None:
        self.speed = 0.0  # rpm, or surface speed in program units (m or ft a minute) with css_maximum
        self.direction = 0  # -1, 0, 1
        self.css_maximum = 0.0  # rpm; 0: no constant surface speed

    def take(self, other: SpindleState) -> None:
        """Become like ``other``."""
        self.speed, self.direction, self.css_maximum = other.speed, other.direction, other.css_maximum

    def same(self, other: SpindleState) -> bool:
        """Does ``other`` turn in the same way? A spindle that is off has no speed."""
        if not self.direction and not other.direction:
            return True
        mine = self.direction, self.speed, self.css_maximum
        return mine == (other.direction, other.speed, other.css_maximum)


class WorldModel(MoveCanon):
    """The answering half of task's canon; ``emctask.canon`` is the acting half."""

    def __init__(self, config: MachineConfig, motion: MotionClient, io: IoClient) -> None:
        super().__init__(config.length_units, config.angle_units)
        if math.isclose(config.length_units * 25.4, 1.0, rel_tol=1e-3):
            MoveCanon.use_length_units(self, CANON_UNITS_INCHES)  # a machine in inches starts in G20
        self._first_units = self.coords.units
        self.is_task = True
        self.config = config
        self.motion = motion
        self.io = io
        self.input_timed_out: Callable[[], bool] = lambda: False
        self.tolerance_set = False
        """Has a program chosen a path mode?"""
        self._feed_word = 0.0, 1.0  # F as programmed, and the machine units of a program unit then
        self.spindles = [SpindleState() for _ in range(MAX_SPINDLES)]
        self.set_limits(config.max_axis_velocities, config.max_axis_accelerations, config.axis_mask)

    def init_canon(self) -> None:
        self.use_length_units(self._first_units)
        self.select_plane(CANON_PLANE_XY)
        self.use_tool_length_offset(*NO_OFFSET)
        self.set_motion_control_mode(CANON_CONTINUOUS, 0.0)
        self.set_naivecam_tolerance(0.0)
        self.tolerance_set = False
        self.set_feed_mode(0, 0)
        self.set_feed_rate(0.0)
        for spindle in self.spindles:
            spindle.speed = spindle.css_maximum = 0.0

    def set_feed_rate(self, rate: float) -> None:
        self._feed_word = rate, self.coords.length(1.0)
        MoveCanon.set_feed_rate(self, rate)

    def set_motion_control_mode(self, mode: int, tolerance: float) -> None:
        self.tolerance_set |= mode == CANON_CONTINUOUS
        MoveCanon.set_motion_control_mode(self, mode, tolerance)

    def shown_settings(self, settings: tuple[float, ...]) -> tuple[float, ...]:
        """The interpreter's settings (line, F, S, path and naive CAM tolerance) as clients are to see them."""
        if self.tolerance_set:
            return settings
        return (*settings[:3], UNSET_TOLERANCE_MM * self.config.length_units / self.coords.length(1.0), *settings[4:])

    def get_external_position(self) -> tuple[float, ...]:
        position = self.motion.status.carte_pos_cmd
        here = (position.tran.x, position.tran.y, position.tran.z, position.a, position.b, position.c,
                position.u, position.v, position.w)  # fmt: skip
        self.set_end(here)
        return self.coords.to_program(*here)

    def get_external_probe_position(self) -> tuple[float, ...]:
        place = self.motion.status.probedPos
        return self.coords.to_program(
            place.tran.x, place.tran.y, place.tran.z, place.a, place.b, place.c, place.u, place.v, place.w
        )

    def get_external_probe_tripped_value(self) -> int:
        return int(bool(self.motion.status.probeTripped))

    def get_external_probe_value(self) -> float:
        return float(self.motion.status.probeVal)

    def get_external_length_units(self) -> float:
        return self.config.length_units

    def get_external_angle_units(self) -> float:
        return self.config.angle_units

    def get_external_length_unit_type(self) -> int:
        return self.coords.units

    def get_external_feed_rate(self) -> float:
        rate, factor = self._feed_word
        now = self.coords.length(1.0)
        return rate if factor == now else rate * factor / now

    def get_external_motion_control_mode(self) -> int:
        return self.motion_mode

    def get_external_motion_control_tolerance(self) -> float:
        return self.tolerance / self.coords.length(1.0)

    def get_external_motion_control_naivecam_tolerance(self) -> float:
        return self.naivecam_tolerance / self.coords.length(1.0)

    def get_external_plane(self) -> int:
        return self.coords.plane

    def get_external_axis_mask(self) -> int:
        return self.config.axis_mask

    def get_external_spindle(self, spindle: int) -> int:
        speed = self.motion.status.spindle_status[spindle].speed
        return CANON_STOPPED if not speed else CANON_CLOCKWISE if speed > 0 else CANON_COUNTERCLOCKWISE

    def get_external_speed(self, spindle: int) -> float:
        return self.spindles[spindle].speed

    def get_external_flood(self) -> int:
        return self.io.status.coolant.flood

    def get_external_mist(self) -> int:
        return self.io.status.coolant.mist

    def get_external_queue_empty(self) -> int:
        return int(self.motion.settled)

    def get_external_tool_offset(self) -> tuple[float, ...]:
        return self.in_program_units(self.coords.tool)

    def in_program_units(self, offset: tuple[float, ...]) -> tuple[float, ...]:
        """An offset in machine units (X to W) as the program would write it."""
        length, angle = self.coords.length(1.0), self.config.angle_units
        return tuple(value / (angle if 3 <= axis < 6 else length) for axis, value in enumerate(offset))

    def get_external_tool_slot(self) -> int:
        number = self.io.status.tool.toolInSpindle
        if number < 0:
            return self._first_empty_pocket()
        return max(self.get_external_tool_index(number), 0) if number else 0

    def _first_empty_pocket(self) -> int:
        """Where a random changer's interpreter takes the tool to be from when there is none in the spindle."""
        table = self.io.table
        return next((index for index in range(1, table.last_index + 1) if table.tools[index].toolno < 0), 0)

    def get_external_selected_tool_slot(self) -> int:
        return self.io.status.tool.pocketPrepped

    def get_external_tool_table(self, index: int) -> Tool:
        table = self.io.table
        entry = table.tools[index]
        pose = entry.offset
        offset = (pose.tran.x, pose.tran.y, pose.tran.z, pose.a, pose.b, pose.c, pose.u, pose.v, pose.w)
        return Tool(
            entry.toolno if index or table.random else max(entry.toolno, 0),
            entry.pocketno,
            offset,
            entry.diameter,
            entry.frontangle,
            entry.backangle,
            entry.orientation,
        )

    def get_external_tool_index(self, tool: int) -> int:
        table = self.io.table
        if tool == 0 and not table.random:
            return 0
        for index in range(0 if table.random else 1, table.last_index + 1):
            if table.tools[index].toolno == tool:
                return index
        return -1

    def get_external_pockets_max(self) -> int:
        return self.io.table.last_index + 1

    def get_external_tc_fault(self) -> int:
        return self.io.status.fault

    def get_external_tc_reason(self) -> int:
        return self.io.status.reason

    def get_external_feed_override_enable(self) -> int:
        return int(bool(self.motion.status.enables_new & Enables.FS))

    def get_external_spindle_override_enable(self, spindle: int) -> int:
        return int(bool(self.motion.status.enables_new & Enables.SS))

    def get_external_adaptive_feed_enable(self) -> int:
        return int(bool(self.motion.status.enables_new & Enables.AF))

    def get_external_feed_hold_enable(self) -> int:
        return int(bool(self.motion.status.enables_new & Enables.FH))

    def get_external_digital_input(self, index: int, default: int) -> int:
        if self.input_timed_out():
            return -1
        return int(bool(self.motion.status.synch_di[index])) if 0 <= index < self.motion.status.num_dio else default

    def get_external_analog_input(self, index: int, default: float) -> float:
        if self.input_timed_out():
            return -1.0
        return self.motion.status.analog_input[index] if 0 <= index < self.motion.status.num_aio else default

    def get_external_offset_applied(self) -> int:
        return int(bool(self.motion.status.external_offsets_applied))
