"""``self`` of the functions of Python remaps: LinuxCNC's names for what the interpreter knows.

A name is one row of ``READ`` (what it is) and, where functions may set it, of ``WRITE``. Lengths are in program units.
"""

from collections import namedtuple
from types import SimpleNamespace

from nml.errors import InterpError
from rs274ngc.canon import AXES
from rs274ngc.params cimport get_named, get_numbered, named_exists, set_named
from rs274ngc.plugin_interpreter import (
    INTERP_ERROR,
    INTERP_OK,
    INVERSE_TIME,
    UNITS_PER_MINUTE,
    UNITS_PER_REVOLUTION,
    InterpreterException,
)
from rs274ngc.plugin_canon import write_out
from rs274ngc.predefined import PREDEFINED
from rs274ngc.remapping import remap_level, view
from rs274ngc.state cimport PARAMETERS, SPINDLES, WAIT_INPUT, WAIT_PROBE, WAIT_TOOL, Frame, State
from rs274ngc.tools cimport find_tool, refresh_tool_parameters


READ_ONLY, GLOBAL, LOOKED_UP, FROM_INI, FROM_PYTHON = 1, 2, 8, 16, 32
"""Bits of ``attr`` of a named parameter, as LinuxCNC numbers them."""


class Parameters:
    """``self.params``: by number, or by name; called, it lists the names."""

    def __init__(self, State s):
        self._state = s

    def __getitem__(self, key):
        cdef State s = self._state
        cdef double value
        if isinstance(key, str):
            if not named_exists(s, key.lower()):
                raise IndexError(f"no parameter #<{key}>")
            return get_named(s, key.lower(), -1)
        get_numbered(s, key, &value, -1)
        return value

    def __setitem__(self, key, double value):
        cdef State s = self._state
        if isinstance(key, str):
            set_named(s, key.lower(), value, -1)
        elif 0 < key < PARAMETERS:
            s.params[<int>key] = value
        else:
            raise IndexError(f"no parameter #{key}")

    def __call__(self):
        return sorted({*self.globals(), *self.locals()})

    def locals(self):
        """Names of the parameters of this level alone."""
        cdef State s = self._state
        return sorted(s.frame.named) if len(s.frames) > 1 else []

    def globals(self):
        """All other names: the predefined ones, and those of the main program."""
        cdef State s = self._state
        cdef Frame main = s.frames[0]
        return sorted({*PREDEFINED, *s.globals, *main.named})


class NamedValue:
    """One named parameter: ``key()``, and ``data()`` with its ``value`` and the bits of ``attr``."""

    def __init__(self, name, double value, int attr=0):
        self._name, self.value, self.attr = name, value, attr

    def key(self):
        return self._name

    def data(self):
        return self


class NamedValues:
    """``named_params`` of a level: a list of NamedValue that also takes names; all that is global is at level 0."""

    def __init__(self, State s, Frame frame, int level):
        self._state, self._own, self._level = s, frame.named, level

    def _names(self):
        cdef State s = self._state
        everywhere = () if self._level else (*s.globals, *PREDEFINED, *(s.plugin.named if s.plugin is not None else ()))
        return sorted({*self._own, *everywhere})

    def _named(self, name):
        cdef State s = self._state
        if name in self._own:
            return NamedValue(name, self._own[name])
        if s.plugin is not None and name in s.plugin.named:
            attr = READ_ONLY | GLOBAL | FROM_PYTHON
        elif name in PREDEFINED:
            attr = READ_ONLY | GLOBAL | LOOKED_UP
        else:
            attr = READ_ONLY | GLOBAL | FROM_INI if name.startswith("_ini[") else GLOBAL
        return NamedValue(name, get_named(s, name, -1), attr)

    def __len__(self):
        return len(self._names())

    def __contains__(self, name):
        return name in self._names()

    def __getitem__(self, key):
        names = self._names()
        if isinstance(key, int):
            return self._named(names[key])
        if key not in names:
            raise KeyError(f"there is no parameter #<{key}> at level {self._level}")
        return self._named(key)


class Context:
    """``self.sub_context[level]``: a level of calls, 0 the main program."""

    def __init__(self, State s, int level):
        cdef Frame frame = s.frames[level]
        self.subName, self.filename, self.position, self.sequence_number = frame.sub, frame.file, frame.position, frame.line
        self.named_params = NamedValues(s, frame, level)


class Contexts:
    """``self.sub_context``: the levels of calls."""

    def __init__(self, State s):
        self._state = s

    def __getitem__(self, int level):
        if not 0 <= level < len(self):
            raise IndexError(f"there is no level {level} of calls")
        return Context(self._state, level)

    def __len__(self):
        return len(self._state.frames)


class Levels:
    """``self.blocks``: the lines whose remapped codes are under way, by remap level."""

    def __init__(self, State s):
        self._state = s

    def __getitem__(self, level):
        return view(self._state, level)


class Spindles:
    """``self.speed``: by spindle."""

    def __init__(self, State s):
        self._state = s

    def __len__(self):
        return SPINDLES

    def __getitem__(self, int n):
        cdef State s = self._state
        return s.speed[self._index(n)]

    def __setitem__(self, int n, double value):
        cdef State s = self._state
        s.speed[self._index(n)] = value

    def _index(self, int n):
        if not 0 <= n < SPINDLES:
            raise IndexError(f"there is no spindle {n}")
        return n


Pose = namedtuple("Pose", "x y z a b c u v w")
TOOLS_MAX = 1001        # LinuxCNC's greatest tool table


class ToolTable:
    """``self.tool_table``: the tools by index, 0 the one in the spindle; lengths in machine units."""

    def __init__(self, State s):
        self._state = s

    def __len__(self):
        return TOOLS_MAX

    def __getitem__(self, int index):
        if not 0 <= index < TOOLS_MAX:
            raise IndexError(f"there is no tool table index {index}")
        tool = self._state.canon.get_external_tool_table(index)
        return SimpleNamespace(
            toolno=tool.toolno, pocketno=tool.pocketno, offset=Pose(*tool.offset), diameter=tool.diameter,
            frontangle=tool.frontangle, backangle=tool.backangle, orientation=tool.orientation,
        )


def tool_offset(State s):
    """The tool offset that applies, program units."""
    return Pose(*[s.tool[i] for i in range(9)])


def axis_value(name, State s):
    """A name of one axis: current_x, AA_current, u_current, axis_offset_z, origin_offset_x, tool offsets; None: no such name."""
    for prefix, which in (("current_", 0), ("axis_offset_", 1), ("origin_offset_", 2), ("tool_offset_", 3)):
        if name.startswith(prefix) and len(name) == len(prefix) + 1:
            axis = AXES.find(name[len(prefix)].upper())
            if axis >= 0:
                return (s.pos[<int>axis], s.g92[<int>axis], s.origin[<int>axis], s.tool[<int>axis])[which]
    if name.endswith("_current") and name[0].upper() in AXES:
        return s.pos[<int>AXES.index(name[0].upper())]
    return None


def rotation(State s):
    """Rotation of the coordinate system in degrees."""
    return s.rotation


def setting(State s, section, key):
    """A whole number of the INI file, 0 where it does not stand there."""
    return s.ini.integer(section, key, 0) if s.ini is not None else 0


DEBUG_UNCONDITIONAL = 0x40000000    # the bit of messages that no debug mask suppresses
FEED_MODES = {940: UNITS_PER_MINUTE, 930: INVERSE_TIME, 950: UNITS_PER_REVOLUTION}
READ = {
    "remap_level": remap_level,
    "tool_offset": tool_offset,
    "tool_table": ToolTable,
    "call_level": lambda s: len(s.frames) - 1,
    "return_value": lambda s: s.return_value,
    "value_returned": lambda s: int(s.value_returned),
    "feed_rate": lambda s: s.feed,
    "feed_mode": lambda s: FEED_MODES[s.feed_mode],
    "motion_mode": lambda s: s.motion,
    "plane": lambda s: s.plane,
    "length_units": lambda s: s.units,
    "distance_mode": lambda s: int(s.incremental),
    "ijk_distance_mode": lambda s: int(not s.ijk_absolute),
    "retract_mode": lambda s: int(s.retract_old_z),
    "control_mode": lambda s: s.control_mode,
    "origin_index": lambda s: s.origin_index,
    "cutter_comp_side": lambda s: {1: 1, 2: 2, 3: 0}[s.comp_side],
    "cutter_comp_radius": lambda s: s.comp_radius,
    "current_tool": lambda s: s.current_tool,
    "current_pocket": lambda s: s.tool_index,
    "selected_tool": lambda s: s.selected_tool,
    "selected_pocket": lambda s: s.selected_index,
    "mist": lambda s: bool(s.mist),
    "flood": lambda s: bool(s.flood),
    "feed_override": lambda s: bool(s.feed_override),
    "random_toolchanger": lambda s: int(s.random_toolchanger),
    "tool_change_at_g30": lambda s: int(s.change_at_g30),
    "tool_change_quill_up": lambda s: int(s.change_with_quill_up),
    "tool_change_with_spindle_on": lambda s: int(s.change_with_spindle_on),
    "active_spindle": lambda s: s.active_spindle,
    "cutter_comp_orientation": lambda s: s.comp_orientation,
    "cutter_comp_firstmove": lambda s: bool(s.comp_first),
    "arc_not_allowed": lambda s: bool(s.arc_not_allowed),
    "percent_flag": lambda s: bool(s.percent),
    "traverse_rate": lambda s: 0.0,
    "rotation_xy": lambda s: rotation(s),
    "adaptive_feed": lambda s: int(s.adaptive_feed),
    "feed_hold": lambda s: int(s.feed_hold),
    "num_spindles": lambda s: s.spindles,
    "sequence_number": lambda s: s.line,
    "filename": lambda s: s.interp.file,
    "linetext": lambda s: s.interp.block_text,
    "blocktext": lambda s: s.interp.block_text,
    "feature_set": lambda s: s.features,
    "debugmask": lambda s: DEBUG_UNCONDITIONAL | setting(s, "EMC", "DEBUG"),
    "loggingLevel": lambda s: setting(s, "RS274NGC", "LOG_LEVEL"),
    "task": lambda s: int(s.canon.is_task),
    "active_g_codes": lambda s: s.interp.active_g_codes(),
    "active_m_codes": lambda s: s.interp.active_m_codes(),
    "active_settings": lambda s: s.interp.active_settings(),
    "stack_index": lambda s: 0,
    "input_flag": lambda s: bool(s.waiting & WAIT_INPUT),
    "probe_flag": lambda s: bool(s.waiting & WAIT_PROBE),
    "toolchange_flag": lambda s: bool(s.waiting & WAIT_TOOL),
}
"""What can be read."""

WRITE = {
    "feed_rate": "feed", "motion_mode": "motion", "selected_tool": "selected_tool", "selected_pocket": "selected_index",
    "current_tool": "current_tool", "current_pocket": "tool_index", "return_value": "return_value", "mist": "mist",
    "flood": "flood",
}
"""What can be set, and where it is kept."""

FLAGS = {
    "toolchange_flag": WAIT_TOOL, "tool_change_flag": WAIT_TOOL, "probe_flag": WAIT_PROBE, "input_flag": WAIT_INPUT,
}
"""Setting one of these asks for the machine to come to rest before the next line."""


class InterpView:
    """LinuxCNC's interpreter object."""

    def __init__(self, interp):
        cdef State s = interp.state
        own = self.__dict__
        own["_interp"], own["_state"] = interp, s
        own["params"], own["blocks"], own["speed"] = Parameters(s), Levels(s), Spindles(s)
        own["sub_context"] = Contexts(s)

    def __getattr__(self, name):
        cdef State s = self.__dict__["_state"]
        known = READ.get(name)
        if known is not None:
            return known(s)
        value = axis_value(name, s)
        if value is None:
            raise AttributeError(f"the interpreter has no '{name}'")
        return value

    def __setattr__(self, name, value):
        cdef State s = self.__dict__["_state"]
        if name in WRITE:
            setattr(s, WRITE[name], value)
            s.modal_version += 1
        elif name in FLAGS:
            s.waiting = s.waiting | FLAGS[name] if value else s.waiting & ~FLAGS[name]
        elif name in READ:
            raise AttributeError(f"'{name}' of the interpreter can only be read")
        else:
            self.__dict__[name] = value

    def execute(self, text, line_number=0):
        """Run a line of G-code, subroutines included; InterpreterException when it is wrong."""
        write_out(self._state.canon)
        try:
            self._interp.execute_inner(text)
        except InterpError as error:
            raise InterpreterException(error.message, line_number, text) from error
        finally:
            write_out(self._state.canon)
        return INTERP_OK

    def set_errormsg(self, text):
        """The text of the error that INTERP_ERROR is to report."""
        self._state.plugin.error_message = text

    def find_tool_pocket(self, number):
        """(INTERP_OK, tool-table index) of a tool number."""
        try:
            return INTERP_OK, find_tool(self._state, int(number), -1)
        except InterpError:
            return INTERP_ERROR, -1

    def set_tool_parameters(self):
        """#5400 to #5413 of the tool in the spindle."""
        refresh_tool_parameters(self._state)

    def load_tool_table(self):
        """The tool table is the canon's; there is nothing to load."""
        return INTERP_OK

    def synch(self):
        """Take over what the machine says."""
        self._interp.synch()

    def ini(self, section, key):
        """A value of the INI file, None when it is not there."""
        s = self._state
        return s.ini.find(section, key) if s.ini is not None else None

    def stack(self):
        """Names of the subroutines under way."""
        return [frame.sub for frame in self._state.frames[1:]]
