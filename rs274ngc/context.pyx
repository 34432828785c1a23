"""The codes in force, and putting them aside and taking them back: M70, M71, M72, M73.

What is saved belongs to a call level and goes with it. Restoring writes the codes that have changed since as a line, as
LinuxCNC does, and runs it; so it restores what such a line can say: a feed with one decimal, a whole speed, spindle 0,
G43 of the tool in the spindle.
"""

from nml.errors import InterpError
from rs274ngc.block cimport Block
from rs274ngc.canon import CANON_CLOCKWISE, CANON_STOPPED, CANON_UNITS_INCHES
from rs274ngc.predefined import PLANE_CODES
from rs274ngc.state cimport State, fail

SIDE_CODES = {1: 420, 2: 410, 3: 400}
CONTROL_CODES = {1: 611, 2: 610, 3: 640}

RESTORED_G = (3, 4, 6, 7, 8, 9, 10, 11, 13, 14, 15, 16)
"""Places in ``active_g_codes`` that M72 restores, in the order of its line; units (5) have one of their own before."""
UNITS, CONTROL, SPINDLE = 5, 11, 2
RESTORED_M = (4, 5, 6, 7, 8)
"""Places in ``active_m_codes``: mist, flood, overrides, adaptive feed, feed hold. The first M code is on the line, others after it."""


cdef tuple active_g_codes(State s):
    """Line number and the G codes in force, times 10, by modal group; -1: none."""
    return (
        s.line,
        s.motion,
        s.last_setting,
        PLANE_CODES[s.plane],
        SIDE_CODES[s.comp_side],
        200 if s.units == CANON_UNITS_INCHES else 210,
        910 if s.incremental else 900,
        s.feed_mode,
        540 + 10 * (s.origin_index - 1) if s.origin_index <= 6 else 590 + s.origin_index - 6,
        430 if any([s.tool[k] for k in range(9)]) else 490,
        980 if s.retract_old_z else 990,
        CONTROL_CODES[s.control_mode],
        -1,
        970 if s.css[0] == 0.0 else 960,
        901 if s.ijk_absolute else 911,
        70 if s.diameter_mode else 80,
        922 if s.params[5210] == 0.0 else 923,
    )


cdef tuple active_m_codes(State s):
    """Line number and the M codes in force; -1: none. M51 stands for M49 and M50 P0 too, as in LinuxCNC."""
    cdef int spindle = 5 if s.turning[0] == CANON_STOPPED else 3 if s.turning[0] == CANON_CLOCKWISE else 4
    return (
        s.line, -1, spindle, s.last_change, 7 if s.mist else -1 if s.flood else 9, 8 if s.flood else -1,
        48 if s.feed_override else 51, 52 if s.adaptive_feed else -1, 53 if s.feed_hold else -1, 0,
    )


cdef tuple active_settings(State s):
    """Line number, feed, speed, tolerance, naive CAM tolerance."""
    return (float(s.line), s.feed, s.speed[0], s.tolerance, s.naivecam_tolerance)


cdef int context(State s, Block* b, int code) except -1:
    """M70 save; M71 forget; M72 restore; M73 save, and restore at return"""
    if code == 72:
        if s.frame.saved is None:
            return fail(s, "Cannot restore context from invalid stack frame - missing M70/M73?", b.m_at[7])
        return restore(s, s.frame.saved)
    if code == 71:
        s.frame.saved = None
        s.frame.restore = False
        return 0
    s.frame.saved = (active_g_codes(s), active_m_codes(s), active_settings(s))
    if code == 73:
        s.frame.restore = len(s.frames) > 1
    return 0


cdef int restore(State s, saved) except -1:
    """Back to the modes of ``saved``."""
    for line in restoring_lines(saved, (active_g_codes(s), active_m_codes(s), active_settings(s))):
        try:
            s.interp.run_aside(line)
        except InterpError as error:
            raise InterpError(f"M7x: restore_settings failed executing: '{line}': {error.message}") from None
    return 0


def restoring_lines(saved, now):
    """What must be executed to get from the codes and settings in force now to the saved ones."""
    g, m, (_, feed, speed, tolerance, naivecam) = saved
    g_now, m_now, settings_now = now
    lines = []
    if g[UNITS] != g_now[UNITS]:
        lines.append(f"G{g[UNITS] // 10}")
    line = ""
    if feed != settings_now[1]:
        line += f" F{feed:.1f}"
    if speed != settings_now[2]:
        line += f" S{speed:.0f}"
    for k in RESTORED_G:
        if g[k] != g_now[k] and not (k == CONTROL and g[k] == 640):
            line += f" G{g[k] // 10}" + (f".{g[k] % 10}" if g[k] % 10 else "")
    if g[CONTROL] == 640 and (g_now[CONTROL] != 640 or (tolerance, naivecam) != settings_now[3:]):
        line += f" G64 P{tolerance:f} Q{naivecam:f}"
    m_codes = [f"M{m[k]}" for k in (SPINDLE, *RESTORED_M) if m[k] not in (-1, m_now[k])]
    if m_codes:
        line += m_codes.pop(0)
    if line:
        lines.append(line)
    return lines + m_codes
