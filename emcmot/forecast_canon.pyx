"""The forecast's canon: feeds the moves of a program to the trajectory planner and runs its servo periods at once.

The moves come from ``rs274ngc.moves``, the same that task sends to motion, and the planner is the one that motion steps, so
the periods counted here are those that the machine takes. Spindles turn at the programmed speed, probes reach the end
of their move, tools are changed in a given time. ``emcmot.forecast`` drives it and prints what it has recorded.
"""

from cpython.mem cimport PyMem_Free, PyMem_Realloc
from libc.math cimport INFINITY, fabs, fmax, fmin
from libc.stdint cimport int64_t
from libc.string cimport memset

from emcmot.kins.kinematics cimport KINS_JOINTS, KinematicsModule
from emcmot.tp.tp cimport *
from rs274ngc.moves cimport MoveCanon

from rs274ngc.canon import CANON_CLOCKWISE, CANON_COUNTERCLOCKWISE, CANON_STOPPED, Tool
from emcmot.layout import same_size

same_size(__name__, "TpSegment", sizeof(TpSegment))

cdef enum:
    CHUNK = 65536                # periods in one piece of the trace
    AXIS_COUNT = 9
    TRAVERSE = 1
    FEED = 2
    ARC = 3
    PROBING = 5
    REASONS = 3 * AXIS_COUNT + 1 # jerk of each axis, acceleration, velocity, the path itself

OF_INTERPRETER = "interpreter:"  # comments that are none of the program

cdef struct MoveFigures:
    double seconds               # that the move took
    double lost                  # seconds against the programmed speed
    int line                     # of the program
    int section
    int reason                   # what cost it most

cdef double SLOW = 0.98          # share of the programmed speed below which a period counts as slow
cdef double AT_JERK = 0.45       # share of a jerk limit from which it counts: see emcmot.tp.smooth
cdef double AT_LIMIT = 0.97      # share of a limit from which it counts as reached


cdef class ForecastCanon(MoveCanon):
    """Counts servo periods by move; ``run_out`` ends what is queued."""

    cdef Tp* tp
    cdef TpStatus status
    cdef readonly double period
    cdef readonly int64_t periods
    cdef double tool_change_s
    cdef readonly bint keeps_trace
    cdef double[AXIS_COUNT] amax
    cdef double[AXIS_COUNT] vmax
    cdef double[AXIS_COUNT] jmax
    cdef double[AXIS_COUNT] last_vel
    cdef double[AXIS_COUNT] last_acc
    cdef MoveFigures* figures    # of the moves by number, from 1 on
    cdef Py_ssize_t room         # of them
    cdef readonly Py_ssize_t count
    cdef double[REASONS] lost_now
    cdef int64_t judged              # the move that `lost_now` is of
    cdef readonly list sections, pauses
    cdef list shapes
    cdef object chunk, positions_out, ids_out
    cdef double[:, ::1] chunk_positions
    cdef int64_t[::1] chunk_ids
    cdef int chunk_used
    cdef double[REASONS] lost_by_reason
    cdef double sync_revs
    cdef bint sync_velocity
    cdef int section, slot, selected
    cdef double revs, rpm
    cdef int direction
    cdef list tools
    cdef str operation
    cdef KinematicsModule kinematics # lives as long as the planner that asks it
    cdef readonly int unbounded      # moves without a tolerance

    def __cinit__(self, *arguments, **options):
        self.tp = tp_create(4096)
        if self.tp == NULL:
            raise MemoryError

    def __dealloc__(self):
        tp_free(self.tp)
        PyMem_Free(self.figures)

    def __init__(self, machine, tools=(), tool_change_s=0.0, trace=False):
        """``machine``: an ``emcmot.forecast_machine.Machine``; ``tools``: the tool table; ``trace``: keep every position."""
        super().__init__(machine.length_units, machine.angle_units)
        self.set_limits(machine.velocities, machine.accelerations, machine.axis_mask)
        self.period = machine.period
        self.tool_change_s = tool_change_s
        self.keeps_trace = trace
        self.tools = [Tool(), *tools]
        self.selected = -1
        tp_set_cycle_time(self.tp, self.period)
        for axis in range(AXIS_COUNT):
            self.vmax[axis] = machine.velocities[axis]
            self.amax[axis] = machine.accelerations[axis]
            self.jmax[axis] = machine.jerks[axis] if machine.jerks[axis] > 0.0 else INFINITY
        self.limit_joints(machine.kinematics, machine.joints)
        for axis in range(AXIS_COUNT):
            tp_set_axis_limits(self.tp, axis, self.vmax[axis], self.amax[axis], machine.jerks[axis])
        tp_set_planner_type(self.tp, any(machine.jerks) or any(joint.jerk for joint in machine.joints))
        tp_set_vel_limit(self.tp, machine.max_linear_velocity)
        self.make_room(4096)
        self.sections, self.pauses, self.shapes = [], [], []
        self.positions_out, self.ids_out = [], []
        self.operation = ""
        self.new_section()
        self.new_chunk()
        self.place(machine.start)

    cdef limit_joints(self, KinematicsModule kinematics, joints):
        """Limits of joints, as motion tells the planner: those that are one axis lower its limits, others have rows of their own."""
        cdef double vel[KINS_JOINTS]
        cdef double acc[KINS_JOINTS]
        cdef double jerk[KINS_JOINTS]
        cdef int n, axis, all_axes = 1
        self.kinematics = kinematics
        if kinematics is None:
            return
        for n in range(kinematics.kins.joints):
            vel[n], acc[n], jerk[n] = joints[n].velocity, joints[n].acceleration, joints[n].jerk
            axis = kinematics.kins.axis_of_joint[n]
            if axis < 0:
                all_axes = 0
                continue
            self.vmax[axis] = fmin(self.vmax[axis], vel[n] if vel[n] > 0.0 else INFINITY)
            self.amax[axis] = fmin(self.amax[axis], acc[n] if acc[n] > 0.0 else INFINITY)
        if not all_axes:
            tp_set_joints(
                self.tp, <TpInverse>kinematics.kins.inverse, &kinematics.kins, kinematics.kins.joints, vel, acc, jerk)

    def place(self, point):
        """The machine stands at this point."""
        cdef double[AXIS_COUNT] p
        cdef int axis
        for axis in range(AXIS_COUNT):
            p[axis] = point[axis]
        tp_set_pos(self.tp, p)
        self.set_end(point)

    # --- Sections and traces

    cdef new_section(self):
        """What follows is counted for the present tool and operation."""
        key = (self.tools[0].toolno, self.operation)
        if key not in self.sections:
            self.sections.append(key)
            self.pauses.append(0.0)
        self.section = self.sections.index(key)

    cdef new_chunk(self):
        cdef int periods = CHUNK if self.keeps_trace else 1
        if self.chunk_used:
            self.positions_out.append(self.chunk_positions[: self.chunk_used])
            self.ids_out.append(self.chunk_ids[: self.chunk_used])
        self.chunk_positions = memoryview(bytearray(periods * AXIS_COUNT * 8)).cast("d", (periods, AXIS_COUNT))
        self.chunk_ids = memoryview(bytearray(periods * 8)).cast("q")
        self.chunk_used = 0

    def trace(self):
        """Commanded position of every period, shape (periods, 9), and the number of the move that it belongs to: both in
        parts, one behind the other."""
        self.new_chunk()
        return self.positions_out, self.ids_out

    cdef int make_room(self, Py_ssize_t more) except -1:
        """Room for the figures of so many further moves."""
        figures = <MoveFigures*>PyMem_Realloc(self.figures, (self.room + more) * sizeof(MoveFigures))
        if figures == NULL:
            raise MemoryError(f"no room for the figures of {self.room + more} moves")
        memset(&figures[self.room], 0, more * sizeof(MoveFigures))
        self.figures = figures
        self.room += more
        return 0

    # --- Sums

    def by_line(self):
        """Of each program line: seconds, seconds lost against the programmed speed, and what cost its slowest move most, as
        an index into `reasons`."""
        cdef dict seconds = {}, lost = {}, reason = {}, slowest = {}
        cdef MoveFigures* move
        cdef Py_ssize_t number
        for number in range(1, self.count + 1):
            move = &self.figures[number]
            line = move.line
            seconds[line] = seconds.get(line, 0.0) + move.seconds
            if move.lost > 0.0:
                lost[line] = lost.get(line, 0.0) + move.lost
                if move.lost >= slowest.get(line, 0.0):
                    slowest[line] = move.lost
                    reason[line] = move.reason
        return seconds, lost, reason

    def by_section(self):
        """Seconds of motion of each section."""
        cdef Py_ssize_t number
        cdef list seconds = [0.0] * len(self.sections)
        for number in range(1, self.count + 1):
            seconds[self.figures[number].section] += self.figures[number].seconds
        return seconds

    def run(self):
        """Lines in the order of their moves, neighbours of one line as one, with the time of motion at the end of each."""
        cdef list ends = []
        cdef double time = 0.0
        cdef Py_ssize_t number
        cdef int line
        for number in range(1, self.count + 1):
            line = self.figures[number].line
            time += self.figures[number].seconds
            if line and (number == self.count or self.figures[number + 1].line != line):
                ends.append((line, round(time, 4)))
        return ends

    def lines(self):
        """The program line of each move, by its number; 0 is none."""
        return [self.figures[number].line for number in range(self.count + 1)]

    def moves(self):
        """Shapes of the moves from the first one on, where a trace is kept: end, center, normal and turns of arcs, and
        whether a tolerance bounds the path."""
        return self.shapes

    def reasons(self):
        """Seconds lost by reason: jerk of X to W, acceleration, velocity, and the speed that corners and curves leave."""
        return [self.lost_by_reason[i] for i in range(REASONS)]

    # --- Servo periods

    cdef void cycle(self) noexcept nogil:
        """One servo period, and what it says."""
        cdef double speed, wanted
        cdef int axis
        if self.direction:
            self.revs += self.direction * self.rpm / 60.0 * self.period
        if self.status.wants_index >= 0:
            self.revs = 0.0
            tp_index_seen(self.tp)
        speed = self.direction * self.rpm / 60.0
        if self.status.wants_reverse >= 0:
            speed = -speed
            self.revs -= 2.0 * self.direction * self.rpm / 60.0 * self.period
        tp_spindle(self.tp, 0, self.revs, speed)
        tp_run_cycle(self.tp)
        tp_get_status(self.tp, &self.status)
        self.periods += 1
        if self.status.id == 0:
            return
        self.figures[self.status.id].seconds += self.period
        wanted = self.status.requested_vel
        if self.status.current_vel < SLOW * wanted:
            self.blame(self.period * (1.0 - self.status.current_vel / wanted))
        for axis in range(AXIS_COUNT):
            self.last_acc[axis] = self.status.vel[axis] - self.last_vel[axis]
            self.last_vel[axis] = self.status.vel[axis]

    cdef void blame(self, double lost) noexcept nogil:
        """Count seconds lost in this period for its move, and for what was at its limit."""
        cdef int axis, reason = 3 * AXIS_COUNT
        cdef double change
        for axis in range(AXIS_COUNT):
            change = self.status.vel[axis] - self.last_vel[axis]
            if fabs(self.status.vel[axis]) > AT_LIMIT * self.vmax[axis]:
                reason = 2 * AXIS_COUNT + axis
            elif fabs(change) > AT_LIMIT * self.amax[axis] * self.period:
                reason = AXIS_COUNT + axis
            elif fabs(change - self.last_acc[axis]) > AT_JERK * self.jmax[axis] * self.period * self.period:
                reason = axis
        if self.judged != self.status.id:
            memset(self.lost_now, 0, sizeof(self.lost_now))
            self.judged = self.status.id
        self.lost_now[reason] += lost
        self.lost_by_reason[reason] += lost
        self.figures[self.status.id].lost += lost
        if self.lost_now[reason] >= self.lost_now[self.figures[self.status.id].reason]:
            self.figures[self.status.id].reason = reason

    cdef record(self):
        cdef int axis
        if self.chunk_used == CHUNK:
            self.new_chunk()
        for axis in range(AXIS_COUNT):
            self.chunk_positions[self.chunk_used, axis] = self.status.pos[axis]
        self.chunk_ids[self.chunk_used] = self.status.id
        self.chunk_used += 1

    cdef run_until(self, int free):
        """Run periods until this many moves fit into the queue, or it is done."""
        tp_get_status(self.tp, &self.status)
        while not self.status.done and self.status.free < free:
            self.cycle()
            if self.keeps_trace:
                self.record()

    def run_out(self):
        """Run everything that is queued to its end."""
        self.flush()
        self.run_until(1 << 30)

    # --- Moves

    cdef queue(self, TpSegment* seg, int line):
        cdef int result
        if self.count + 2 > self.room:
            self.make_room(self.room)
        seg.id = self.count + 1
        result = tp_add(self.tp, seg, NULL)
        if result == TP_FULL:
            self.run_until(2048)
            result = tp_add(self.tp, seg, NULL)
        if result == TP_OK:
            self.count += 1
            self.figures[self.count].line = line
            self.figures[self.count].section = self.section
            bounded = seg.term != TP_TERM_BLEND or seg.tolerance > 0.0
            self.unbounded += not bounded
            if self.keeps_trace:
                end = tuple([seg.end[i] for i in range(AXIS_COUNT)])
                arc = (tuple(seg.center), tuple(seg.normal), seg.turn) if seg.kind == TP_ARC else None
                self.shapes.append((end, arc, bounded))

    cdef void begin(self, TpSegment* seg, double x, double y, double z, double a, double b, double c, double u, double v, double w, double vel, double ini_maxvel, double acc) noexcept:
        memset(seg, 0, sizeof(TpSegment))
        seg.kind = TP_LINE
        seg.motion_type = FEED
        seg.term = self.term_cond
        seg.tolerance = self.tolerance
        seg.indexer = seg.spindle = -1
        seg.end[0], seg.end[1], seg.end[2] = x, y, z
        seg.end[3], seg.end[4], seg.end[5] = a, b, c
        seg.end[6], seg.end[7], seg.end[8] = u, v, w
        seg.vel = vel
        seg.vel_max = ini_maxvel
        seg.acc = acc
        if self.synched and self.sync_revs > 0.0:
            seg.spindle = 0
            seg.sync_revs = self.sync_revs
            seg.sync_velocity = self.sync_velocity

    cpdef void line(self, int line, int kind, double x, double y, double z, double a, double b, double c, double u, double v, double w, double vel, double ini_maxvel, double acc) except *:
        cdef TpSegment seg
        self.begin(&seg, x, y, z, a, b, c, u, v, w, vel, ini_maxvel, acc)
        seg.motion_type = kind
        if kind == TRAVERSE:
            seg.spindle = -1
        self.queue(&seg, line)

    cpdef void arc(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w, double cx, double cy, double cz, double nx, double ny, double nz, int turn, double vel, double ini_maxvel, double acc) except *:
        cdef TpSegment seg
        self.begin(&seg, x, y, z, a, b, c, u, v, w, vel, ini_maxvel, acc)
        seg.kind = TP_ARC
        seg.motion_type = ARC
        seg.turn = turn
        seg.center[0], seg.center[1], seg.center[2] = cx, cy, cz
        seg.normal[0], seg.normal[1], seg.normal[2] = nx, ny, nz
        self.queue(&seg, line)

    cpdef void probe(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w, double vel, double ini_maxvel, double acc, int probe_type) except *:
        cdef TpSegment seg
        self.begin(&seg, x, y, z, a, b, c, u, v, w, vel, ini_maxvel, acc)
        seg.motion_type = PROBING
        seg.term = TP_TERM_STOP
        self.queue(&seg, line)
        self.run_until(1 << 30)

    cpdef void tap(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w, double vel, double ini_maxvel, double acc, double scale) except *:
        cdef TpSegment seg
        self.begin(&seg, x, y, z, a, b, c, u, v, w, vel, ini_maxvel, acc)
        seg.kind = TP_TAP
        seg.spindle = 0
        seg.sync_revs = self.sync_revs
        seg.retract_scale = scale
        self.queue(&seg, line)
        self.run_until(1 << 30)

    # --- What takes time without motion, or changes what the time is counted for

    cpdef void dwell(self, double seconds) except *:
        self.run_out()
        self.pauses[self.section] += seconds

    cpdef void select_tool(self, int tool) except *:
        self.selected = self.get_external_tool_index(tool)

    cpdef void change_tool(self) except *:
        self.run_out()
        self.change_tool_number(max(self.selected, 0))
        self.pauses[self.section] += self.tool_change_s

    cpdef void change_tool_number(self, int pocket) except *:
        self.flush()
        self.slot = pocket
        self.tools[0] = self.tools[pocket] if pocket else Tool()
        self.new_section()

    cpdef void set_tool_table_entry(self, int pocket, int tool, double x, double y, double z, double a, double b, double c, double u, double v, double w, double diameter, double frontangle, double backangle, int orientation) except *:
        offset = (x, y, z, a, b, c, u, v, w)
        self.tools[pocket] = Tool(tool, self.tools[pocket].pocketno, offset, diameter, frontangle, backangle, orientation)

    cpdef void comment(self, str text) except *:
        if not text.startswith(OF_INTERPRETER):
            self.operation = text.strip()
            self.new_section()

    cpdef void set_spindle_speed(self, int spindle, double speed) except *:
        self.rpm = fabs(speed)

    cpdef void start_spindle_clockwise(self, int spindle, bint wait_for_atspeed) except *:
        self.direction = 1

    cpdef void start_spindle_counterclockwise(self, int spindle, bint wait_for_atspeed) except *:
        self.direction = -1

    cpdef void stop_spindle_turning(self, int spindle) except *:
        self.direction = 0

    cpdef void start_speed_feed_synch(self, int spindle, double feed_per_revolution, bint velocity_mode) except *:
        MoveCanon.start_speed_feed_synch(self, spindle, feed_per_revolution, velocity_mode)
        self.run_out()
        self.sync_revs = self.coords.length(feed_per_revolution)
        self.sync_velocity = velocity_mode

    cpdef void program_end(self) except *:
        self.run_out()

    # --- What the interpreter asks

    cpdef tuple get_external_position(self):
        x, y, z, a, b, c, u, v, w = self.chain_end()
        return self.coords.to_program(x, y, z, a, b, c, u, v, w)

    cpdef tuple get_external_probe_position(self):
        return self.get_external_position()

    cpdef int get_external_probe_tripped_value(self) except? -1:
        return 1

    cpdef int get_external_length_unit_type(self) except? -1:
        return self.coords.units

    cpdef double get_external_feed_rate(self) except? -1:
        return self.linear_feed * 60.0 / self.coords.length(1.0)

    cpdef int get_external_motion_control_mode(self) except? -1:
        return self.motion_mode

    cpdef double get_external_motion_control_tolerance(self) except? -1:
        return self.tolerance / self.coords.length(1.0)

    cpdef double get_external_motion_control_naivecam_tolerance(self) except? -1:
        return self.naivecam_tolerance / self.coords.length(1.0)

    cpdef int get_external_plane(self) except? -1:
        return self.coords.plane

    cpdef double get_external_length_units(self) except? -1:
        return self.coords.length_units

    cpdef double get_external_angle_units(self) except? -1:
        return self.coords.angle_units

    cpdef int get_external_axis_mask(self) except? -1:
        return self.axis_mask

    cpdef int get_external_spindle(self, int spindle) except? -1:
        return CANON_CLOCKWISE if self.direction > 0 else CANON_COUNTERCLOCKWISE if self.direction < 0 else CANON_STOPPED

    cpdef tuple get_external_tool_offset(self):
        cdef double length = self.coords.length(1.0)
        return tuple([value / (self.coords.angle_units if 3 <= axis < 6 else length) for axis, value in enumerate(self.coords.tool)])

    cpdef int get_external_tool_slot(self) except? -1:
        return self.slot

    cpdef int get_external_selected_tool_slot(self) except? -1:
        return self.selected

    cpdef object get_external_tool_table(self, int index):
        return self.tools[index]

    cpdef int get_external_tool_index(self, int tool) except? -1:
        for index in range(1, len(self.tools)):
            if self.tools[index].toolno == tool:
                return index
        return 0 if tool == 0 else -1

    cpdef int get_external_pockets_max(self) except? -1:
        return len(self.tools)
