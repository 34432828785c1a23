"""Task's canon: turns what the interpreter asks for into entries of the interp list, and answers what it asks.

Moves come from ``rs274ngc.moves`` in machine units and are packed here, once, in the layout that motion reads. Every
other call first flushes the joined lines, so that the list keeps the order of the program. The answers to what the
interpreter asks are in ``emctask.world``.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from emctask import operations as op
from emctask.config import MachineConfig
from emctask.homing import ALL
from emctask.interplist import InterpList, Operation
from emctask.ioclient import IoClient
from emctask.motion import MOVE, MotionClient
from emctask.places import Block, Calls, Modes, Place, Places
from emctask.usercommands import find_program
from emctask.world import WorldModel
from nml.emc import (
    EMC_COOLANT_FLOOD_OFF,
    EMC_COOLANT_FLOOD_ON,
    EMC_COOLANT_MIST_OFF,
    EMC_COOLANT_MIST_ON,
    EMC_TOOL_LOAD,
    EMC_TOOL_LOAD_TOOL_TABLE,
    EMC_TOOL_PREPARE,
    EMC_TOOL_SET_NUMBER,
    EMC_TOOL_SET_OFFSET,
    EMC_TOOL_START_CHANGE,
)
from nml.emc.emcmot import MotCommand
from nml.message import Command
from rs274ngc.canon import CANON_UNITS_INCHES
from rs274ngc.moves import ARC, PROBING, TANGENT, MoveCanon

SET_LINE, SET_CIRCLE = int(MotCommand.SET_LINE), int(MotCommand.SET_CIRCLE)
PROBE, RIGID_TAP = int(MotCommand.PROBE), int(MotCommand.RIGID_TAP)
NO_CIRCLE = (0.0,) * 6
FEED_MOVE = 2


class TaskCanon(WorldModel):
    """See the module."""

    def __init__(self, config: MachineConfig, motion: MotionClient, io: IoClient) -> None:
        super().__init__(config, motion, io)
        self.queue = InterpList()
        self.places = Places()
        self.line_number = 0
        self.block = Block("")
        self._block_before = self.block
        self.tool_offset = self.coords.tool
        """The tool offset as far as the program was read: X to W, machine units."""
        self.tool_data_changed = False
        """Did the program change the tool table since the interpreter took it over?"""
        self.log_path: Path | None = None

    def begin_block(self, line: int, file: str, calls: Calls) -> None:
        """What comes now belongs to this block."""
        self._block_before, self.block = self.block, Block(file, calls, self.block)
        self.line_number = line

    def end_block(self, modes: Modes, offsets: tuple[float, ...]) -> None:
        """The block is executed; these codes and stored offsets are in force after it."""
        self.block.modes, self.block.offsets, self.block.tool_offset = modes, offsets, self.tool_offset

    def put(self, operation: Operation, payload: Any = None) -> None:
        """Queue an operation after everything that came before it."""
        self.flush()
        self.queue.append((operation, payload, self.line_number, self.block))

    def put_motion(self, command: MotCommand, **fields: Any) -> None:
        """Queue a modal command to motion."""
        self.put(op.motion_command, (command, fields))

    def forget(self) -> None:
        """The program is aborted: nothing that it queued counts any more."""
        self.queue.clear()
        self.on_reset()

    def forget_spindles(self) -> None:
        """The spindles were stopped without the program: an S word must not start them again."""
        for spindle in self.spindles:
            spindle.direction = 0

    def on_reset(self) -> None:
        self.set_end(self.end_point)

    # --- Moves

    def origin(self, line: int) -> Block:
        """The block of a move of this line: a line that was held back to be joined comes from before this block."""
        return self.block if line == self.line_number else self._block_before

    def line(self, line, kind, x, y, z, a, b, c, u, v, w, vel, ini_maxvel, acc):  # type: ignore[no-untyped-def]
        block = self.origin(line)
        number = self.places.new_id(Place(line, block))
        packed = MOVE.pack(
            SET_LINE, 0, 0, 0, number, x, y, z, a, b, c, u, v, w, *NO_CIRCLE, self.indexer, kind,
            vel, ini_maxvel, acc, 0.0, self.term_cond, self.coords.units, self.tolerance,
        )  # fmt: skip
        self.queue.append((op.move, packed, line, block))

    def arc(self, line, x, y, z, a, b, c, u, v, w, cx, cy, cz, nx, ny, nz, turn, vel, ini_maxvel, acc):  # type: ignore[no-untyped-def]
        block = self.origin(line)
        number = self.places.new_id(Place(line, block))
        packed = MOVE.pack(
            SET_CIRCLE, 0, 0, 0, number, x, y, z, a, b, c, u, v, w, cx, cy, cz, nx, ny, nz, turn, ARC,
            vel, ini_maxvel, acc, 0.0, self.term_cond, self.coords.units, self.tolerance,
        )  # fmt: skip
        self.queue.append((op.move, packed, line, block))

    def probe(self, line, x, y, z, a, b, c, u, v, w, vel, ini_maxvel, acc, probe_type):  # type: ignore[no-untyped-def]
        block = self.origin(line)
        number = self.places.new_id(Place(line, block))
        packed = MOVE.pack(
            PROBE, 0, 0, 0, number, x, y, z, a, b, c, u, v, w, *NO_CIRCLE, -1, PROBING,
            vel, ini_maxvel, acc, 0.0, TANGENT, 0, 0.0,
        )  # fmt: skip
        self.queue.append((op.probe, (packed, probe_type), line, block))

    def tap(self, line, x, y, z, a, b, c, u, v, w, vel, ini_maxvel, acc, scale):  # type: ignore[no-untyped-def]
        block = self.origin(line)
        number = self.places.new_id(Place(line, block))
        packed = MOVE.pack(
            RIGID_TAP, 0, 0, self.feed_spindle, number, x, y, z, a, b, c, u, v, w, *NO_CIRCLE, -1, FEED_MOVE,
            vel, ini_maxvel, acc, 0.0, TANGENT, 0, 0.0,
        )  # fmt: skip
        self.queue.append((op.rigid_tap, (packed, scale), line, block))

    def home_cycle(self) -> None:
        self.put(op.home, ALL)

    def home_cycle_joint(self, joint: int) -> None:
        self.put(op.home, joint)

    def start_speed_feed_synch(self, spindle, feed_per_revolution, velocity_mode):  # type: ignore[no-untyped-def]
        MoveCanon.start_speed_feed_synch(self, spindle, feed_per_revolution, velocity_mode)
        pitch = self.coords.length(feed_per_revolution)
        self.put_motion(MotCommand.SET_SPINDLESYNC, spindle=spindle, spindlesync=pitch, flags=int(velocity_mode))

    def stop_speed_feed_synch(self) -> None:
        if self.synched:
            self.put_motion(MotCommand.SET_SPINDLESYNC)
        MoveCanon.stop_speed_feed_synch(self)

    # --- Offsets

    def set_g5x_offset(self, index, x, y, z, a, b, c, u, v, w):  # type: ignore[no-untyped-def]
        MoveCanon.set_g5x_offset(self, index, x, y, z, a, b, c, u, v, w)
        self.put(op.set_status, ("g5x_offset", self.coords.g5x))
        self.put(op.set_status, ("g5x_index", index))

    def set_g92_offset(self, x, y, z, a, b, c, u, v, w):  # type: ignore[no-untyped-def]
        MoveCanon.set_g92_offset(self, x, y, z, a, b, c, u, v, w)
        self.put(op.set_status, ("g92_offset", self.coords.g92))

    def set_xy_rotation(self, theta):  # type: ignore[no-untyped-def]
        MoveCanon.set_xy_rotation(self, theta)
        self.put(op.set_status, ("rotation_xy", theta))

    def use_tool_length_offset(self, x, y, z, a, b, c, u, v, w):  # type: ignore[no-untyped-def]
        MoveCanon.use_tool_length_offset(self, x, y, z, a, b, c, u, v, w)
        self.tool_offset = self.coords.tool
        self.put(op.tool_offset, self.tool_offset)

    # --- Spindle

    def set_spindle_mode(self, spindle: int, css_max: float) -> None:
        self.spindles[spindle].css_maximum = abs(css_max)

    def set_spindle_speed(self, spindle: int, speed: float) -> None:
        self.spindles[spindle].speed = speed
        if self.spindles[spindle].direction:
            self._put_spindle(spindle, wait=False)

    def start_spindle_clockwise(self, spindle: int, wait_for_atspeed: bool) -> None:
        self.spindles[spindle].direction = 1
        self._put_spindle(spindle, wait_for_atspeed)

    def start_spindle_counterclockwise(self, spindle: int, wait_for_atspeed: bool) -> None:
        self.spindles[spindle].direction = -1
        self._put_spindle(spindle, wait_for_atspeed)

    def stop_spindle_turning(self, spindle: int) -> None:
        self.spindles[spindle].direction = 0
        self.put(op.motion_command_at_rest, (MotCommand.SPINDLE_OFF, {"spindle": spindle}))

    def _put_spindle(self, number: int, wait: bool) -> None:
        spindle = self.spindles[number]
        fields: dict[str, Any] = {
            "vel": spindle.direction * spindle.speed,
            "state": 1,
            "wait_for_spindle_at_speed": int(wait),
        }
        if spindle.css_maximum:
            # rpm = factor / radius: surface speed in m (ft) a minute, radius in machine units
            per_turn = 12 * 25.4 if self.coords.units == CANON_UNITS_INCHES else 1000.0
            factor = per_turn / (2 * math.pi) * spindle.speed * self.config.length_units
            fields["vel"] = spindle.direction * spindle.css_maximum
            fields["ini_maxvel"] = spindle.direction * spindle.css_maximum
            fields["acc"] = spindle.direction * factor
            fields["offset"] = self.coords.g5x[0] + self.coords.g92[0] + self.coords.tool[0]
        self.put(op.spindle_on, (number, fields))

    def orient_spindle(self, spindle: int, orientation: float, mode: int) -> None:
        self.put(op.orient, (spindle, orientation, mode))

    def wait_spindle_orient_complete(self, spindle: int, timeout: float) -> None:
        self.put(op.wait_oriented, (spindle, timeout))

    # --- Tools and coolant

    def select_tool(self, tool: int) -> None:
        self._put_io(op.io_command, EMC_TOOL_PREPARE(tool=tool))

    def start_change(self) -> None:
        self._put_io(op.io_command_complete, EMC_TOOL_START_CHANGE())

    def change_tool(self) -> None:
        self._go_to_change()
        self._put_io(op.io_command_complete, EMC_TOOL_LOAD())

    def _go_to_change(self) -> None:
        """To [EMCIO]TOOL_CHANGE_POSITION, with the axes that it names."""
        place = self.config.tool_change_position
        if place:
            there = (*place, *self.end_point[len(place) :])
            self.straight_traverse(self.line_number, *self.coords.to_program(*there))

    def change_tool_number(self, pocket: int) -> None:
        self._put_io(op.io_command_complete, EMC_TOOL_SET_NUMBER(tool=pocket))

    def set_tool_table_entry(  # type: ignore[no-untyped-def]
        self, pocket, tool, x, y, z, a, b, c, u, v, w, diameter, frontangle, backangle, orientation
    ):
        command = EMC_TOOL_SET_OFFSET(
            pocket=pocket,
            toolno=tool,
            offset=(x, y, z, a, b, c, u, v, w),
            diameter=diameter,
            frontangle=frontangle,
            backangle=backangle,
            orientation=orientation,
        )
        self._put_io(op.io_command_complete, command)
        self.tool_data_changed = True

    def reload_tooldata(self) -> None:
        self._put_io(op.io_command_complete, EMC_TOOL_LOAD_TOOL_TABLE())
        self.tool_data_changed = True

    def _put_io(self, operation: Operation, command: Command) -> None:
        self.put(operation, command)

    def flood_on(self) -> None:
        self._put_io(op.io_command_at_rest, EMC_COOLANT_FLOOD_ON())

    def flood_off(self) -> None:
        self._put_io(op.io_command_at_rest, EMC_COOLANT_FLOOD_OFF())

    def mist_on(self) -> None:
        self._put_io(op.io_command_at_rest, EMC_COOLANT_MIST_ON())

    def mist_off(self) -> None:
        self._put_io(op.io_command_at_rest, EMC_COOLANT_MIST_OFF())

    # --- Overrides, inputs and outputs

    def enable_feed_override(self) -> None:
        self.put_motion(MotCommand.FS_ENABLE, mode=1)

    def disable_feed_override(self) -> None:
        self.put_motion(MotCommand.FS_ENABLE, mode=0)

    def enable_speed_override(self, spindle: int) -> None:
        self.put_motion(MotCommand.SS_ENABLE, spindle=spindle, mode=1)

    def disable_speed_override(self, spindle: int) -> None:
        self.put_motion(MotCommand.SS_ENABLE, spindle=spindle, mode=0)

    def enable_adaptive_feed(self) -> None:
        self.put_motion(MotCommand.AF_ENABLE, mode=1)

    def disable_adaptive_feed(self) -> None:
        self.put_motion(MotCommand.AF_ENABLE, mode=0)

    def enable_feed_hold(self) -> None:
        self.put_motion(MotCommand.FH_ENABLE, mode=1)

    def disable_feed_hold(self) -> None:
        self.put_motion(MotCommand.FH_ENABLE, mode=0)

    def set_motion_output_bit(self, index: int) -> None:
        self.put_motion(MotCommand.SET_DOUT, out=index, now=0, start=1, end=1)

    def clear_motion_output_bit(self, index: int) -> None:
        self.put_motion(MotCommand.SET_DOUT, out=index, now=0, start=0, end=0)

    def set_aux_output_bit(self, index: int) -> None:
        self.put(op.motion_command_at_rest, (MotCommand.SET_DOUT, {"out": index, "now": 1, "start": 1, "end": 1}))

    def clear_aux_output_bit(self, index: int) -> None:
        self.put(op.motion_command_at_rest, (MotCommand.SET_DOUT, {"out": index, "now": 1}))

    def set_motion_output_value(self, index: int, value: float) -> None:
        self.put_motion(MotCommand.SET_AOUT, out=index, now=0, minLimit=value, maxLimit=value)

    def set_aux_output_value(self, index: int, value: float) -> None:
        fields = {"out": index, "now": 1, "minLimit": value, "maxLimit": value}
        self.put(op.motion_command_at_rest, (MotCommand.SET_AOUT, fields))

    def wait(self, index: int, input_type: int, wait_type: int, timeout: float) -> int:
        self.put(op.wait_input, (index, input_type, wait_type, timeout))
        return 0

    def unlock_rotary(self, line: int, joint: int) -> None:
        self.flush()
        self.indexer = joint

    def lock_rotary(self, line: int, joint: int) -> None:
        self.flush()
        self.indexer = -1

    # --- Program and messages

    def dwell(self, seconds: float) -> None:
        self.put(op.dwell, seconds)

    def program_stop(self) -> None:
        self.put(op.program_stop)

    def optional_program_stop(self) -> None:
        self.put(op.optional_stop)

    def program_end(self) -> None:
        self.put(op.program_end)

    def finish(self) -> None:
        self.flush()

    def message(self, text: str) -> None:
        self.put(op.operator_text, text)

    def error(self, text: str) -> None:
        self.put(op.operator_text, text)

    def print_text(self, text: str) -> None:
        print(text, flush=True)

    def logopen(self, name: str) -> None:
        self.log_path = Path(name)
        self.log_path.write_text("", encoding="utf-8")

    def logappend(self, name: str) -> None:
        self.log_path = Path(name)

    def log(self, text: str) -> None:
        if self.log_path is not None:
            with self.log_path.open("a", encoding="utf-8") as stream:
                print(text, file=stream)

    def logclose(self) -> None:
        self.log_path = None

    def user_command(self, number: int, p: float, q: float) -> None:
        self.put(op.user_command, (number, p, q))

    def user_command_exists(self, number: int) -> bool:
        return find_program(number, self.config.m_code_folders) is not None
