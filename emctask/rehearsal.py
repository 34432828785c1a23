"""The canon of a dry run: follows a program in memory and cannot move, switch or show anything.

Run from line (``emctask.runfromline``) lets the interpreter read the lines before the first one with this canon in
place of task's. It begins as a copy of the machine, with tools, spindles, coolant and offsets of its own; what the
program made of them is handed to the machine afterwards. Motion and io are only asked, never told: there is no way to
them here.
"""

from __future__ import annotations

from dataclasses import replace

from emctask.usercommands import find_program
from emctask.world import SpindleState, WorldModel
from nml.errors import InterpError
from rs274ngc.canon import CANON_CLOCKWISE, CANON_COUNTERCLOCKWISE, CANON_STOPPED, Tool

Z = 2
TURNING = {-1: CANON_COUNTERCLOCKWISE, 0: CANON_STOPPED, 1: CANON_CLOCKWISE}


def hand_over(source: WorldModel, target: WorldModel) -> None:
    """Give ``target`` the units, plane, offsets, path mode and feed of ``source``, by canonical calls."""
    coords = source.coords
    target.use_length_units(coords.units)
    target.select_plane(coords.plane)
    target.set_g5x_offset(coords.g5x_index, *source.in_program_units(coords.g5x))
    target.set_g92_offset(*source.in_program_units(coords.g92))
    target.set_xy_rotation(coords.rotation)
    target.use_tool_length_offset(*source.in_program_units(coords.tool))
    hand_over_path_mode(source, target)
    target.set_naivecam_tolerance(source.get_external_motion_control_naivecam_tolerance())
    target.set_feed_mode(source.feed_spindle, source.feed_mode)
    target.set_feed_rate(source.get_external_feed_rate())


def hand_over_path_mode(source: WorldModel, target: WorldModel) -> None:
    """Give ``target`` the path mode of ``source``, and whether a program chose it."""
    target.set_motion_control_mode(source.motion_mode, source.get_external_motion_control_tolerance())
    target.tolerance_set = source.tolerance_set


class RehearsalCanon(WorldModel):
    """See the module."""

    def __init__(self, machine: WorldModel) -> None:
        super().__init__(machine.config, machine.motion, machine.io)
        self.block_delete, self.optional_stop = machine.block_delete, machine.optional_stop
        self.set_end(machine.end_point)
        hand_over(machine, self)
        for mine, given in zip(self.spindles, machine.spindles, strict=True):
            mine.take(given)
        self.tools = [machine.get_external_tool_table(i) for i in range(machine.get_external_pockets_max())]
        self.random = bool(machine.io.table.random)
        self.selected = machine.get_external_selected_tool_slot()
        self.prepared: int | None = None
        """The tool that the program selected and did not change to yet; None: none."""
        self.loaded: int | None = None
        """The tool that the program would have in the spindle; None: it changed none."""
        self.flood, self.mist = bool(machine.get_external_flood()), bool(machine.get_external_mist())
        self.switches: dict[tuple[str, *tuple[int, ...]], bool] = {}
        """Overrides that the program allowed or forbade: (name, spindle if it is one spindle's)."""
        self.table_entries: list[tuple[float, ...]] = []
        """Arguments of ``set_tool_table_entry``, in order."""
        self.left_out: dict[str, None] = {}
        """What the program did to the world that a dry run does not repeat."""
        self.top = self.end_point[Z] - self.coords.tool[Z]
        """Highest Z of the tool's tip so far, machine coordinates."""

    def refresh_top(self, z: float) -> None:
        """The program goes to this Z, machine coordinates."""
        self.top = max(self.top, z - self.coords.tool[Z])

    # --- Moves

    def line(self, line, kind, x, y, z, *rest):  # type: ignore[no-untyped-def]
        self.refresh_top(z)

    def arc(self, line, x, y, z, *rest):  # type: ignore[no-untyped-def]
        self.refresh_top(z)

    def straight_probe(self, *arguments):  # type: ignore[no-untyped-def]
        raise InterpError("the probe's result cannot be known without probing; start at this line or before it")

    # --- Tools

    def select_tool(self, tool: int) -> None:
        self.selected = self.get_external_tool_index(tool)
        self.prepared = tool

    def change_tool(self) -> None:
        index = max(self.selected, 0)
        if self.random:
            held, fresh = self.tools[0], self.tools[index]
            self.tools[index] = replace(held, pocketno=fresh.pocketno)
            self.tools[0] = replace(fresh, pocketno=held.pocketno)
        else:
            self._hold(index)
        self.loaded, self.prepared, self.selected = self.tools[0].toolno, None, -1

    def change_tool_number(self, pocket: int) -> None:
        self._hold(pocket)
        self.loaded = self.tools[0].toolno

    def _hold(self, index: int) -> None:
        self.tools[0] = self.tools[index] if index or self.random else Tool()

    def set_tool_table_entry(self, pocket, tool, *values):  # type: ignore[no-untyped-def]
        self.table_entries.append((pocket, tool, *values))
        *offset, diameter, front, back, orientation = values
        self.tools[pocket] = Tool(
            tool, self.tools[pocket].pocketno, tuple(offset), diameter, front, back, int(orientation)
        )

    # --- Spindles and coolant

    def set_spindle_mode(self, spindle: int, css_max: float) -> None:
        self.spindles[spindle].css_maximum = abs(css_max)

    def set_spindle_speed(self, spindle: int, speed: float) -> None:
        self.spindles[spindle].speed = speed

    def start_spindle_clockwise(self, spindle: int, wait_for_atspeed: bool) -> None:
        self.spindles[spindle].direction = 1

    def start_spindle_counterclockwise(self, spindle: int, wait_for_atspeed: bool) -> None:
        self.spindles[spindle].direction = -1

    def stop_spindle_turning(self, spindle: int) -> None:
        self.spindles[spindle].direction = 0

    def flood_on(self) -> None:
        self.flood = True

    def flood_off(self) -> None:
        self.flood = False

    def mist_on(self) -> None:
        self.mist = True

    def mist_off(self) -> None:
        self.mist = False

    # --- Overrides

    def enable_feed_override(self) -> None:
        self.switches["feed_override",] = True

    def disable_feed_override(self) -> None:
        self.switches["feed_override",] = False

    def enable_speed_override(self, spindle: int) -> None:
        self.switches["speed_override", spindle] = True

    def disable_speed_override(self, spindle: int) -> None:
        self.switches["speed_override", spindle] = False

    def enable_adaptive_feed(self) -> None:
        self.switches["adaptive_feed",] = True

    def disable_adaptive_feed(self) -> None:
        self.switches["adaptive_feed",] = False

    def enable_feed_hold(self) -> None:
        self.switches["feed_hold",] = True

    def disable_feed_hold(self) -> None:
        self.switches["feed_hold",] = False

    # --- What is not repeated

    def set_motion_output_bit(self, index: int) -> None:
        self.left_out[f"digital output {index}"] = None

    clear_motion_output_bit = set_aux_output_bit = clear_aux_output_bit = set_motion_output_bit

    def set_motion_output_value(self, index: int, value: float) -> None:
        self.left_out[f"analog output {index}"] = None

    set_aux_output_value = set_motion_output_value

    def home_cycle(self) -> None:
        self.left_out["G28.2"] = None

    def home_cycle_joint(self, joint: int) -> None:
        self.left_out["G28.2"] = None

    def orient_spindle(self, spindle: int, orientation: float, mode: int) -> None:
        self.left_out["M19"] = None

    def user_command(self, number: int, p: float, q: float) -> None:
        self.left_out[f"M{number}"] = None

    def user_command_exists(self, number: int) -> bool:
        return find_program(number, self.config.m_code_folders) is not None

    # --- Answers

    def get_external_position(self) -> tuple[float, ...]:
        return self.coords.to_program(*self.chain_end())

    def get_external_queue_empty(self) -> int:
        return 1

    def get_external_spindle(self, spindle: int) -> int:
        return TURNING[self.spindles[spindle].direction]

    def get_external_flood(self) -> int:
        return int(self.flood)

    def get_external_mist(self) -> int:
        return int(self.mist)

    def get_external_tool_slot(self) -> int:
        number = self.tools[0].toolno
        return max(self.get_external_tool_index(number), 0) if number > 0 else 0

    def get_external_selected_tool_slot(self) -> int:
        return self.selected

    def get_external_tool_table(self, index: int) -> Tool:
        return self.tools[index]

    def get_external_tool_index(self, tool: int) -> int:
        if tool == 0 and not self.random:
            return 0
        for index in range(0 if self.random else 1, len(self.tools)):
            if self.tools[index].toolno == tool:
                return index
        return -1

    def get_external_tc_fault(self) -> int:
        return 0

    def get_external_feed_override_enable(self) -> int:
        return self._switch(super().get_external_feed_override_enable(), "feed_override")

    def get_external_spindle_override_enable(self, spindle: int) -> int:
        return self._switch(super().get_external_spindle_override_enable(spindle), "speed_override", spindle)

    def get_external_adaptive_feed_enable(self) -> int:
        return self._switch(super().get_external_adaptive_feed_enable(), "adaptive_feed")

    def get_external_feed_hold_enable(self) -> int:
        return self._switch(super().get_external_feed_hold_enable(), "feed_hold")

    def _switch(self, machine: int, name: str, *spindle: int) -> int:
        return int(self.switches.get((name, *spindle), machine))


def spindle_text(spindle: SpindleState) -> str:
    """How a spindle turns, for the operator."""
    if not spindle.direction:
        return "off"
    way = "forward" if spindle.direction > 0 else "reverse"
    return f"{way} S{spindle.speed:g}" + (f" G96 D{spindle.css_maximum:g}" if spindle.css_maximum else "")
