"""The interpreter: reads a program line by line and makes a canon do what it says.

``read`` takes the next line and understands it, ``execute`` runs it. Both raise InterpError with file, line and column.
Task and the stand-alone ``rs274`` drive it in the same way; it keeps no globals, so there may be several in a process.
"""

import os

from libc.string cimport memcpy, memset

from nml.errors import InterpError, Place
from rs274ngc import varfile
from rs274ngc.block cimport *
from rs274ngc.canon import CANON_SIDE_OFF, CANON_UNITS_INCHES, CANON_XYZ
from rs274ngc.canon cimport Canon
from rs274ngc.codes cimport check, enhance, run
from rs274ngc.compensation cimport drop
from rs274ngc.context cimport active_g_codes, active_m_codes, active_settings, restore
from rs274ngc.flow cimport Flow
from rs274ngc.modal cimport STEP_MOTION
from rs274ngc.offsets cimport activate_origin, send_g92, send_origin
from rs274ngc.params cimport get_named, get_numbered, named_exists, set_numbered
from rs274ngc.plugin import plugin_of
from rs274ngc.remapping cimport Pending
from rs274ngc.remapping import go_on
from rs274ngc.scan cimport read_unsigned, scan_words, strip
from rs274ngc.settings import apply_settings
from rs274ngc.source cimport Source
from rs274ngc.state cimport (
    ENDFILE, EXIT, FINISH, OK, PARAMETERS, SPINDLES, WAIT_INPUT, WAIT_PROBE, WAIT_TOOL, Frame, State, fail, fail_word,
)
from rs274ngc.tools cimport refresh_tool_parameters

INTERP_OK, INTERP_EXIT, INTERP_EXECUTE_FINISH, INTERP_ENDFILE = OK, EXIT, FINISH, ENDFILE

cdef int SIDE_OFF = CANON_SIDE_OFF


cdef class Interpreter:
    """One interpreter with its modes, parameters and program."""

    cdef readonly State state
    cdef readonly Flow flow
    cdef public Canon canon
    cdef public object parameter_file
    cdef public bint repeats_main   # M99 in the main program begins it again; else it ends it
    cdef bint percent, stop_after_block
    cdef readonly int sequence_number

    def __init__(self, Canon canon, ini=None):
        """``ini``: the INI file, anything with ``find(section, key)`` and ``findall(section, key)``."""
        self.canon = canon
        self.state = State(canon, ini)
        self.state.interp = self
        self.state.params[5599] = 1.0
        self.flow = Flow(self.state)
        self.flow.search_path = [os.curdir]
        self.parameter_file = None
        if ini is not None:
            apply_settings(self, ini)
            self.flow.search_path = self.folders()
            self.state.plugin = plugin_of(self, ini)

    # --- Beginning and end

    def init(self):
        """Load the parameter file, take the state of the machine, tell the canon units, origin and offsets."""
        cdef State s = self.state
        s.units = self.canon.get_external_length_unit_type()
        self.canon.init_canon()
        self.canon.use_length_units(s.units)
        s.axis_mask = self.canon.get_external_axis_mask()
        if self.parameter_file is not None and os.path.exists(self.parameter_file):
            self.load_parameters(self.parameter_file)
        self.take_up()

    def restart(self):
        """As after the start: default modes, and zero in the parameters that no file keeps. Names and retract mode stay."""
        cdef State s = self.state
        cdef int number
        kept = s.persistent | set(varfile.REQUIRED)
        for number in range(1, 5400):
            if number not in kept:
                s.params[number] = 0.0
        s.set_defaults()
        s.line = 0
        self.canon.init_canon()
        s.units = self.canon.get_external_length_unit_type()
        self.take_up()

    def take_up(self):
        """Tell the canon origin and offsets, and take the state of the machine."""
        cdef State s = self.state
        activate_origin(s, self.stored_origin())
        self.restore_g92()
        send_origin(s)
        send_g92(s)
        self.canon.set_xy_rotation(s.rotation)
        self.canon.set_feed_reference(CANON_XYZ)
        self.synch()
        self.reset()

    def stored_origin(self):
        """The coordinate system of #5220."""
        index = int(self.state.params[5220])
        return index if 1 <= index <= 9 else 1

    def restore_g92(self):
        """G92 as it was, where the INI file asks for it."""
        cdef State s = self.state
        cdef int k
        cdef double factor
        if not s.g92_persistent:
            memset(s.g92, 0, sizeof(s.g92))
            memset(&s.params[5210], 0, 10 * sizeof(double))
        elif s.params[5210] != 0.0:
            factor = self.canon.get_external_length_units() * (25.4 if s.units == CANON_UNITS_INCHES else 1.0)
            for k in range(9):
                s.g92[k] = s.params[5211 + k] / (factor if k < 3 or k > 5 else 1.0)

    def load_parameters(self, path):
        """Read a parameter file; ConfigError where it is wrong."""
        cdef State s = self.state
        cdef int number
        values = varfile.load(path, PARAMETERS)
        for number in range(1, 5400):
            s.params[number] = values.get(number, 0.0)
        s.persistent = set(values) | set(varfile.REQUIRED)
        self.parameter_file = path

    def save_parameters(self, path=None):
        """Write the parameter file; the old one stays as ``.bak``."""
        cdef State s = self.state
        s.persistent = s.persistent | set(varfile.REQUIRED)
        varfile.save(path or self.parameter_file, s.persistent, lambda number: s.params[<int>number])

    def exit(self):
        """The session is over: end the Python plug-in, save the parameters if they came from a file."""
        self.reset()
        if self.state.plugin is not None:
            self.state.plugin.close()
        if self.parameter_file is not None:
            self.save_parameters()

    def open(self, path):
        """Begin with a program file."""
        cdef State s = self.state
        cdef int size, i
        self.close()
        path = os.fspath(path)
        self.flow.source = Source(path)
        s.file = path
        s.subs.clear()
        self.flow.defined.clear()
        self.flow.search_path = self.folders()
        self.percent = False
        while True:
            try:
                size = self.flow.read_raw()
            except InterpError:
                break
            if size < 0:
                break
            text = s.raw[:size].strip()
            if text:
                self.percent = text == b"%"
                break
        if not self.percent:
            self.flow.source.position = 0
            self.flow.source.line = 0
        s.line = self.flow.source.line
        s.raw_size = 0
        s.raw[0] = 0

    def folders(self):
        """Where subroutine files are looked for: as the INI file says, else in the current folder."""
        prefix = [self.state.program_prefix] if self.state.program_prefix else []
        return prefix + list(self.state.subroutine_path) or [os.curdir]

    def close(self):
        """Let go of the program file."""
        self.unwind()
        self.flow.source = None
        self.state.frame.labels.clear()

    def reset(self):
        """After a program or an abort: no open calls, no half-read line."""
        cdef State s = self.state
        self.unwind()
        drop(s)
        s.frame.labels.clear()
        s.raw_size = 0
        s.raw[0] = 0
        s.block.steps = 0
        s.waiting = 0
        s.nurbs_active = False
        s.ended = s.must_finish = False
        self.canon.on_reset()

    def restore_context(self, saved):
        """M73: the modes of the caller, at return."""
        restore(self.state, saved)

    def unwind(self):
        """Back to the main program."""
        self.flow.unwind()

    def abort(self):
        """Task was aborted: leave all calls, close the file, forget what was being waited for."""
        cdef State s = self.state
        self.unwind()
        s.waiting = 0
        self.close()
        self.reset()

    def synch(self):
        """Take position, tool, spindles, feed and overrides from the machine."""
        cdef State s = self.state
        cdef Canon canon = self.canon
        cdef int k
        position = canon.get_external_position()
        for k in range(9):
            s.pos[k] = position[k]
        s.comp_x, s.comp_y, s.comp_z = s.pos[0], s.pos[1], s.pos[2]
        offset = canon.get_external_tool_offset()
        for k in range(9):
            s.tool[k] = offset[k]
        for k in range(s.spindles):
            s.turning[k] = canon.get_external_spindle(k)
            s.speed[k] = canon.get_external_speed(k)
            s.speed_override[k] = canon.get_external_spindle_override_enable(k)
        s.feed = canon.get_external_feed_rate()
        s.flood, s.mist = canon.get_external_flood(), canon.get_external_mist()
        s.feed_override = canon.get_external_feed_override_enable()
        s.adaptive_feed = canon.get_external_adaptive_feed_enable()
        s.feed_hold = canon.get_external_feed_hold_enable()
        s.plane = canon.get_external_plane()
        s.control_mode = canon.get_external_motion_control_mode()
        s.tolerance = canon.get_external_motion_control_tolerance()
        s.naivecam_tolerance = canon.get_external_motion_control_naivecam_tolerance()
        s.tool_index = canon.get_external_tool_slot()
        s.selected_index = canon.get_external_selected_tool_slot()
        refresh_tool_parameters(s)
        s.modal_version += 1
        if s.waiting:
            self.take_results()

    cdef int take_results(self) except -1:
        """The machine stands still: what came of probing, tool change, input."""
        cdef State s = self.state
        cdef Canon canon = self.canon
        cdef int k, waiting = s.waiting
        s.waiting = 0
        if not canon.get_external_queue_empty():
            what = "probing" if waiting & WAIT_PROBE else "tool change" if waiting & WAIT_TOOL else "external input"
            return fail(s, f"Queue is not empty after {what}")
        if waiting & WAIT_PROBE:
            probed = canon.get_external_probe_position()
            for k in range(9):
                s.params[5061 + k] = probed[k]
            s.params[5070] = canon.get_external_probe_tripped_value()
        if waiting & (WAIT_PROBE | WAIT_TOOL):
            position = canon.get_external_position()
            for k in range(9):
                s.pos[k] = position[k]
            s.comp_x, s.comp_y, s.comp_z = s.pos[0], s.pos[1], s.pos[2]
        if waiting & WAIT_TOOL:
            refresh_tool_parameters(s)
            s.params[5600] = canon.get_external_tc_fault()
            s.params[5601] = canon.get_external_tc_reason()
        if waiting & WAIT_INPUT:
            if s.input_digital:
                s.params[5399] = canon.get_external_digital_input(s.input_index, s.params[5399] != 0.0)
            else:
                s.params[5399] = canon.get_external_analog_input(s.input_index, s.params[5399])
        return 0

    # --- Read and execute

    def read(self, text=None):
        """Understand the next line of the program, or ``text``: INTERP_OK or INTERP_ENDFILE."""
        try:
            if text is not None:
                self.take_text(text)
                return self.understand()
            return self.read_line()
        except InterpError as error:
            raise self.placed(error)

    cdef int take_text(self, str text) except -1:
        """A line that was typed in."""
        cdef State s = self.state
        encoded = text.encode("utf-8").rstrip(b"\r\n")
        if b"\n" in encoded or b"\0" in encoded:
            return fail(s, "Bad character '\\012' used")
        if len(encoded) >= LINE_SIZE:
            s.raw_size = 0
            return fail(s, "Command too long")
        s.raw_size = <int>len(encoded)
        memcpy(s.raw, <const char*>encoded, s.raw_size + 1)
        return 0

    cdef int read_line(self) except -1:
        cdef State s = self.state
        if s.resume is not None:        # a remapped code waited for the machine: its steps go on instead of a line
            if s.waiting:
                self.take_results()
            return OK
        if self.flow.source is None:
            if len(s.frames) == 1:
                return ENDFILE
            return fail(s, "File not open")
        if self.flow.read_raw() < 0:
            self.stop_after_block = True
            if self.percent and len(s.frames) == 1:
                return fail(s, "File ended with no percent sign")
            return fail(s, "File ended with no percent sign or program end")
        return self.understand()

    cdef int understand(self) except -1:
        """From the raw line in the state to its block; O-lines are done at once."""
        cdef State s = self.state
        cdef Block* b = &s.block
        cdef int at = 0, number
        s.error_at = -1
        b.steps = 0
        b.motion = -1
        b.words = 0
        if s.waiting:
            self.take_results()
        strip(s)
        s.blocks += 1
        if s.size == 0:
            return OK
        if s.text[0] == c'%' and s.text[1] == 0 and self.percent and self.flow.source is not None:
            self.canon.finish()
            return ENDFILE
        if s.text[0] == c'/':
            if self.canon.get_block_delete():
                return OK
            at = 1
        memset(b.g, 0xFF, sizeof(b.g))
        memset(b.m, 0xFF, sizeof(b.m))
        b.m_count = 0
        b.comment = -1
        if s.text[at] == c'n':
            at += 1
            read_unsigned(s, &at, &number)
            if s.text[at] == c'.':
                at += 1
                while c'0' <= s.text[at] <= c'9':
                    at += 1
        if s.text[at] == c'o':
            s.modal_version += 1
            self.flow.o_line(at)
            b.steps = 0
            return OK
        if s.text[at] == c'm' and s.text[at + 1] == c'9' and s.text[at + 2] == c'8' and not c'0' <= s.text[at + 3] <= c'9':
            self.call_subprogram(at + 3)
            return OK
        scan_words(s, at)
        if b.words == 0 and b.steps == 0 and b.comment < 0:
            # only modal codes without a step of their own (G0 .. G89 alone) are left to look at
            if b.g[0] < 0 and b.g[1] < 0:
                return OK
        enhance(s, b)
        check(s, b)
        if b.comment >= 0 and b.comment_size:
            b.steps |= 2
        return OK

    cdef int call_subprogram(self, int at) except -1:
        """M98 P number L repetitions"""
        cdef State s = self.state
        if not s.fanuc_subs:
            return fail(s, "DISABLE_FANUC_STYLE_SUB set in INI file, but found m98", at)
        scan_words(s, at)
        if not has(&s.block, W_P):
            return fail(s, "Found 'm98' code with no P-word", at)
        number = round(s.block.value[W_P])
        if abs(s.block.value[W_P] - number) > 0.0001:
            return fail_word(s, "Non integer value for integer", W_P)
        repeats = value_or(&s.block, W_L, 1.0)
        s.block.steps = 0
        if repeats >= 1.0:
            self.flow.enter(str(number), [], True, <long>repeats)
        return 0

    def end_subprogram(self):
        """M99, for its handler: False if the program is over."""
        if self.call_level and not self.state.fanuc_subs:
            fail(self.state, "DISABLE_FANUC_STYLE_SUB set in INI file, but found m99")
        return self.flow.end_subprogram()

    def run_aside(self, text):
        """Run a line of plain, not remapped codes in the middle of another."""
        cdef State s = self.state
        cdef Block block = s.block
        cdef bytes raw = s.raw[:s.raw_size]
        remaps, s.remaps = s.remaps, {}
        try:
            self.take_text(text)
            self.understand()
            run(s, &s.block)
        finally:
            s.remaps = remaps
        s.block = block
        memcpy(s.raw, <const char*>raw, len(raw) + 1)
        s.raw_size = <int>len(raw)

    def execute_inner(self, text):
        """Run a line, and the subroutine that it calls, in the middle of another: for Python remaps."""
        cdef State s = self.state
        cdef Block block = s.block
        cdef int level = len(s.frames), line = s.line
        cdef bytes raw = s.raw[:s.raw_size]
        self.take_text(text)
        self.understand()
        self.run_block()
        while len(s.frames) > level:
            if self.read_line() == ENDFILE:
                fail(s, "File ended with no percent sign or program end")
            self.run_block()
        s.must_finish = False
        s.block = block
        memcpy(s.raw, <const char*>raw, len(raw) + 1)
        s.raw_size, s.line = <int>len(raw), line

    def read_subroutine(self, str label, take):
        """Call a subroutine whose lines are not executed: ``take()`` looks at each in ``state.block``, for the lathe cycles."""
        cdef State s = self.state
        cdef int level = len(s.frames), line = s.line
        cdef bytes raw = s.raw[:s.raw_size]
        self.flow.enter(label, [])
        s.profile = True
        try:
            while len(s.frames) > level:
                if self.read_line() == ENDFILE:
                    fail(s, "File ended with no percent sign or program end")
                if s.block.steps:
                    take()
        finally:
            s.profile = False
        memcpy(s.raw, <const char*>raw, len(raw) + 1)
        s.raw_size, s.line = <int>len(raw), line
        s.block.steps = 0

    def execute(self):
        """Run the line that was read: INTERP_OK, INTERP_EXIT or INTERP_EXECUTE_FINISH."""
        try:
            return self.run_block()
        except InterpError as error:
            raise self.placed(error)

    cdef int run_block(self) except -1:
        cdef State s = self.state
        cdef int what
        while True:
            if s.resume is not None:
                s.modal_version += 1
                what = go_on(s)
                if what == FINISH:
                    return FINISH
            if s.block.steps == 0:
                break
            if s.block.steps != 1ULL << STEP_MOTION:     # anything besides a plain move may have changed a mode
                s.modal_version += 1
            s.last_setting, s.last_change = s.block.g[0], s.block.m[6]
            run(s, &s.block)
            if s.resume is None:
                break
        s.block.steps = 0
        if s.ended:
            s.ended = False
            self.unwind()
            s.frame.labels.clear()
            return EXIT
        if s.must_finish or s.waiting:
            s.must_finish = False
            return FINISH
        return OK

    def execute_mdi(self, text):
        """Read and execute a line that was typed in."""
        try:
            self.take_text(text)
            if self.understand() == ENDFILE:
                return ENDFILE
            return self.run_block()
        except InterpError as error:
            raise self.placed(error, typed=not self.call_level)

    def run_file(self, stop_on_error=True, on_error=None, on_progress=None):
        """Read and execute until the program is over; ``on_error(InterpError)`` is told, and so may go on.

        ``on_progress(share read, 0 to 1)`` is called every thousand lines; an exception from it ends the run.
        """
        cdef int code
        cdef unsigned int count = 0
        while True:
            count += 1
            if not count & 0x3FF:
                check_signals()
                if on_progress is not None:
                    on_progress(self.share_read)
            try:
                code = self.read_line()
                if code == ENDFILE:
                    return ENDFILE
                code = self.run_block()
                if code == EXIT:
                    return EXIT
            except InterpError as error:
                placed = self.placed(error)
                at_end = self.stop_after_block
                self.stop_after_block = False
                if on_error is None:
                    raise placed from None
                on_error(placed)
                if stop_on_error or at_end:
                    return EXIT

    def placed(self, error, bint typed=False):
        """The error with its place, and the calls it happened in left; ``typed``: it stands in no file."""
        cdef State s = self.state
        if error.place is None:
            source = None if typed else self.flow.source
            file = source.path if source is not None else "MDI"
            error = InterpError(error.message, Place(file, s.line if source is not None else 1, self.column()), self.block_text)
        s.block.steps = 0
        s.waiting = 0
        self.unwind()
        return error

    def column(self):
        """Column of the raw line for the place of the last error in the stripped one; 0: none."""
        cdef State s = self.state
        cdef int k, stripped = -1, at = s.error_at
        cdef bint comment = False
        if at < 0:
            return 0
        for k in range(s.raw_size):
            if comment or s.raw[k] not in b" \t\r":
                stripped += 1
            if s.raw[k] == c'(':
                comment = True
            elif s.raw[k] == c')':
                comment = False
            if stripped == at:
                return k + 1
        return s.raw_size + 1

    # --- What others ask

    @property
    def line(self):
        """Line of the file that was read last."""
        return self.state.line

    @property
    def share_read(self):
        """How much of the program file was read, 0 to 1; where a subroutine is called, up to the call."""
        cdef Frame main = self.state.frames[0]
        source = self.flow.source if self.call_level == 0 else main.source
        if source is None:
            return 1.0
        return min(1.0, (source.position if self.call_level == 0 else main.position) / max(1, source.bytes))

    @property
    def file(self):
        """The file being read, or the one opened last."""
        return self.flow.source.path if self.flow.source is not None else self.state.file

    @property
    def block_text(self):
        """The line that was read last, as written."""
        return self.state.raw[:self.state.raw_size].decode("utf-8", "replace")

    @property
    def call_level(self):
        """Depth of subroutine calls; a remapped code that waits for the machine counts as one."""
        return len(self.state.frames) - 1 + (self.state.resume is not None)

    @property
    def calls(self):
        """The calls under way, the outermost first: (what is called, file of the call, line); as many as ``call_level``."""
        cdef State s = self.state
        cdef list found = []
        cdef Frame caller, called
        cdef Pending waiting
        for caller, called in zip(s.frames, s.frames[1:]):
            found.append((called.sub, caller.source.path if caller.source is not None else "", caller.line))
        if s.resume is not None:
            waiting = s.resume
            found.append((waiting.sub or waiting.remap.name, self.file, waiting.line))
        return tuple(found)

    @property
    def modal_version(self):
        """Grows whenever modes or settings may have changed."""
        return self.state.modal_version

    @property
    def program_units(self):
        """CANON_UNITS_*"""
        return self.state.units

    def parameter(self, int number):
        """Value of #number."""
        cdef double value
        get_numbered(self.state, number, &value, -1)
        return value

    def set_parameter(self, int number, double value):
        """#number = value, also where a program may not."""
        if not 0 < number < PARAMETERS:
            raise InterpError("Parameter number out of range")
        self.state.params[number] = value

    def named_parameter(self, str name):
        """Value of #<name>; InterpError when there is none."""
        return get_named(self.state, name.lower(), -1)

    def active_g_codes(self):
        """Sequence number and the G codes in force, times 10, by modal group; -1: none."""
        return active_g_codes(self.state)

    def active_m_codes(self):
        """Sequence number and the M codes in force; -1: none."""
        return active_m_codes(self.state)

    def active_settings(self):
        """Sequence number, feed, speed, tolerance, naive CAM tolerance."""
        return active_settings(self.state)


cdef extern from "Python.h":
    int PyErr_CheckSignals() except -1


cdef int check_signals() except -1:
    return PyErr_CheckSignals()
