"""The predefined named parameters: what a program can ask of the interpreter by name.

One row is one parameter: name, what it says, and how it is found in the interpreter's state.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rs274ngc.canon import CANON_CLOCKWISE, CANON_STOPPED, CANON_UNITS_INCHES

VERSION_MAJOR, VERSION_MINOR = 2.10, 0.0
PLANE_CODES = {1: 170, 2: 190, 3: 180, 4: 171, 5: 191, 6: 181}
COORD_SYSTEM_CODES = (0, 540, 550, 560, 570, 580, 590, 591, 592, 593)


def metric_machine(state: Any) -> float:
    """1: a machine unit is a millimetre; 0: an inch; -1: neither."""
    units = state.canon.get_external_length_units()
    return 1.0 if units == 1.0 else 0.0 if units == 1.0 / 25.4 else -1.0


ROWS: tuple[tuple[str, str, Callable[[Any], float]], ...] = (
    ("_vmajor", "version of the control, major and minor", lambda s: VERSION_MAJOR),
    ("_vminor", "version of the control, patch level", lambda s: VERSION_MINOR),
    ("_line", "line of the file", lambda s: s.line),
    ("_motion_mode", "motion code times 10", lambda s: s.motion),
    ("_plane", "plane code times 10", lambda s: PLANE_CODES[s.plane]),
    ("_ccomp", "cutter compensation code times 10", lambda s: {1: 420, 2: 410, 3: 400}[s.comp_side]),
    ("_metric", "1 with G21", lambda s: s.units != CANON_UNITS_INCHES),
    ("_imperial", "1 with G20", lambda s: s.units == CANON_UNITS_INCHES),
    ("_metric_machine", "1 on a machine in mm, 0 on one in inches, else -1", metric_machine),
    ("_absolute", "1 with G90", lambda s: not s.incremental),
    ("_incremental", "1 with G91", lambda s: s.incremental),
    ("_inverse_time", "1 with G93", lambda s: s.feed_mode == 930),
    ("_units_per_minute", "1 with G94", lambda s: s.feed_mode == 940),
    ("_units_per_rev", "1 with G95", lambda s: s.feed_mode == 950),
    ("_coord_system", "coordinate system code times 10", lambda s: COORD_SYSTEM_CODES[s.origin_index]),
    ("_tool_offset", "1 while a tool offset is in force", lambda s: any(s.tool_offset)),
    ("_retract_r_plane", "1 with G99", lambda s: not s.retract_old_z),
    ("_retract_old_z", "1 with G98", lambda s: s.retract_old_z),
    ("_spindle_rpm_mode", "1 with G97", lambda s: s.surface_speed_mode(0) == 0.0),
    ("_spindle_css_mode", "1 with G96", lambda s: s.surface_speed_mode(0) != 0.0),
    ("_ijk_absolute_mode", "1 with G90.1", lambda s: s.ijk_absolute),
    ("_lathe_diameter_mode", "1 with G7", lambda s: s.diameter_mode),
    ("_lathe_radius_mode", "1 with G8", lambda s: not s.diameter_mode),
    ("_spindle_on", "1 while the spindle turns", lambda s: s.spindle_turning(0) != CANON_STOPPED),
    ("_spindle_cw", "1 while it turns clockwise", lambda s: s.spindle_turning(0) == CANON_CLOCKWISE),
    ("_mist", "1 while mist is on", lambda s: s.mist),
    ("_flood", "1 while flood is on", lambda s: s.flood),
    ("_speed_override", "1 while the speed override works", lambda s: s.speed_override_enabled(0)),
    ("_feed_override", "1 while the feed override works", lambda s: s.feed_override),
    ("_adaptive_feed", "1 while adaptive feed works", lambda s: s.adaptive_feed),
    ("_feed_hold", "1 while feed hold works", lambda s: s.feed_hold),
    ("_feed", "feed rate", lambda s: s.feed),
    ("_rpm", "spindle speed", lambda s: s.spindle_speed(0)),
    *(
        (f"_{axis}", f"{axis.upper()} of the position", lambda s, i=i: s.position[i])
        for i, axis in enumerate("xyzabcuvw")
    ),
    *(
        (f"_abs_{axis}", f"{axis.upper()} of the position without offsets", lambda s, i=i: s.machine_position[i])
        for i, axis in enumerate("xyzabcuvw")
    ),
    ("_current_tool", "number of the tool in the spindle", lambda s: s.current_tool),
    ("_current_pocket", "pocket of the tool in the spindle", lambda s: s.pocket_of(s.tool_index)),
    ("_selected_tool", "number of the selected tool, -1: none", lambda s: s.selected_tool),
    ("_selected_pocket", "pocket of the selected tool, -1: none", lambda s: s.pocket_of(s.selected_index)),
    ("_call_level", "depth of subroutine calls", lambda s: len(s.frames) - 1),
    ("_remap_level", "depth of remapped codes", lambda s: sum(not pending.sub for pending in s.remap_stack)),
    ("_value", "value that the last subroutine returned", lambda s: s.return_value),
    ("_value_returned", "1 when the last subroutine returned a value", lambda s: s.value_returned),
    ("_task", "1 in the machine's task, 0 in a preview", lambda s: s.canon.is_task),
)

PREDEFINED: dict[str, Callable[[Any], float]] = {name: value for name, _, value in ROWS}
