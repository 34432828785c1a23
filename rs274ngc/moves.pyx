"""From canonical calls to moves in machine coordinates: the arithmetic that task and the forecast share.

A MoveCanon applies units, offsets and rotation (``rs274ngc.coords``), joins short lines within the naive CAM tolerance, and finds
the velocity and acceleration that the axes allow on each move. What comes out are four calls, ``line``, ``arc``, ``probe`` and
``tap``, with machine units and machine coordinates: a subclass makes messages for motion of them, or segments for a planner.

Velocity of a straight move: each axis would need |distance| / MAX_VELOCITY; the slowest axis decides, and the path is counted along
XYZ if any of them moves, else UVW, else the rotary axes. Acceleration likewise. A programmed feed counts along the same path.
Joined lines are held back until ``flush``; whoever queues anything else flushes first. Lines are joined within JOINED_SHARE of the
path tolerance (G64 P) at most, so only where they are as good as straight: the planner makes better use of the tolerance. A joined
line leaves only the rest of it to the planner: path error within P.
"""

from libc.math cimport INFINITY, atan2, cos, fabs, fmax, fmin, hypot, sin, sqrt

from rs274ngc import nurbs
from rs274ngc.canon import CANON_CONTINUOUS, CANON_EXACT_PATH, CANON_EXACT_STOP
from rs274ngc.path cimport plane_axes

TRAVERSE, FEED, ARC, TOOLCHANGE, PROBING, INDEXROTARY = range(1, 7)
"""Kinds of moves: EMC_MOTION_TYPE_*."""

STOP, BLEND, TANGENT = range(1, 4)
"""How a move ends: motion's TermCond."""

_TERM_COND = {CANON_EXACT_STOP: STOP, CANON_EXACT_PATH: TANGENT, CANON_CONTINUOUS: BLEND}

cdef double TINY = 1e-7  # an axis that moves less than this does not move
cdef double JOINED_SHARE = 0.002
cdef double TWO_PI = 6.283185307179586
cdef int C_FEED = FEED
cdef int C_TRAVERSE = TRAVERSE
cdef int C_INDEXROTARY = INDEXROTARY
cdef int CONTINUOUS = CANON_CONTINUOUS

NURBS_STEPS = 20  # lines for each control point


cdef inline double norm(double x, double y, double z) noexcept nogil:
    return sqrt(x * x + y * y + z * z)


cdef inline void copy_point(double* to, const double* source) noexcept nogil:
    cdef int axis
    for axis in range(9):
        to[axis] = source[axis]


cdef inline Limits finish_limits(Limits limits, double path, double time, double ratio) noexcept nogil:
    """``time`` and ``ratio``: distance by velocity and distance by acceleration of the slowest axis."""
    limits.vel = path / time if time > 0.0 else (INFINITY if path > 0.0 else 0.0)
    limits.acc = path / ratio if ratio > 0.0 else (INFINITY if path > 0.0 else 0.0)
    return limits


cdef void measure_arc(Arc* arc, int rotation) noexcept nogil:
    """Radius, angle (signed, with all turns) and height of an arc from its start, end, centre and normal."""
    cdef double start[3]
    cdef double end[3]
    cdef double start_height = 0.0, end_height = 0.0, sine, cosine = 0.0
    cdef double* n = arc.normal
    cdef int axis
    for axis in range(3):
        start[axis] = arc.start[axis] - arc.centre[axis]
        end[axis] = arc.end[axis] - arc.centre[axis]
        start_height += start[axis] * n[axis]
        end_height += end[axis] * n[axis]
    for axis in range(3):
        start[axis] -= start_height * n[axis]
        end[axis] -= end_height * n[axis]
        cosine += start[axis] * end[axis]
    sine = ((start[1] * end[2] - start[2] * end[1]) * n[0] + (start[2] * end[0] - start[0] * end[2]) * n[1]
            + (start[0] * end[1] - start[1] * end[0]) * n[2])
    arc.radius = norm(start[0], start[1], start[2])
    arc.height = end_height - start_height
    arc.angle = atan2(sine, cosine)
    if rotation > 0:
        arc.angle += TWO_PI * (rotation - (0 if arc.angle <= TINY else 1))
    else:
        arc.angle += TWO_PI * (rotation + (0 if arc.angle >= -TINY else 1))


cdef void arc_middle(const Arc* arc, double* middle) noexcept nogil:
    """The point half way along an arc, by turning the radius at the start about the normal (Rodrigues' formula)."""
    cdef double r[3]
    cdef double turned
    cdef const double* n = &arc.normal[0]
    cdef double height = 0.0, cosine = cos(0.5 * arc.angle), sine = sin(0.5 * arc.angle)
    cdef int axis
    copy_point(middle, arc.start)
    for axis in range(3):
        r[axis] = arc.start[axis] - arc.centre[axis]
        height += r[axis] * n[axis]
    for axis in range(3):
        turned = (r[axis] * cosine + (n[(axis + 1) % 3] * r[(axis + 2) % 3] - n[(axis + 2) % 3] * r[(axis + 1) % 3]) * sine
                  + n[axis] * height * (1.0 - cosine))
        middle[axis] = arc.centre[axis] + turned + 0.5 * arc.height * n[axis]


cdef class MoveCanon(Canon):
    """Turns canonical motion calls into moves; see the module. Subclasses override ``line``, ``arc``, ``probe`` and ``tap``."""

    def __init__(self, double length_units=1.0, double angle_units=1.0):
        """``length_units``: machine length units in a millimetre; ``angle_units``: machine angle units in a degree."""
        self.coords = Coordinates(length_units, angle_units)
        self.motion_mode = CANON_CONTINUOUS
        self.term_cond = BLEND
        self.indexer = -1
        self.set_limits([INFINITY] * 9, [INFINITY] * 9, 0x1FF)

    def set_limits(self, velocities, accelerations, int axis_mask):
        """Limits of the axes X to W in machine units; ``axis_mask``: which of them the machine has (bit 0: X)."""
        cdef int axis
        for axis in range(9):
            self.max_vel[axis] = velocities[axis]
            self.max_acc[axis] = accelerations[axis]
        self.axis_mask = axis_mask

    def set_end(self, point):
        """The next move begins at this machine point (X to W); joined lines not yet sent are forgotten."""
        cdef int axis
        self.chain_length = 0
        for axis in range(9):
            self.end[axis] = point[axis]

    def chain_end(self):
        """Machine point (X to W) at which the last programmed move ends, joined or sent."""
        cdef double* point = self.programmed_end()
        return tuple([point[i] for i in range(9)])

    @property
    def end_point(self):
        """Machine point (X to W) at which the last sent move ends."""
        return tuple([self.end[i] for i in range(9)])

    # --- What the subclass does with the moves

    cpdef void line(self, int line, int kind, double x, double y, double z, double a, double b, double c, double u, double v, double w, double vel, double ini_maxvel, double acc) except *:
        """A straight move of this ``kind`` to a machine point."""

    cpdef void arc(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w, double cx, double cy, double cz, double nx, double ny, double nz, int turn, double vel, double ini_maxvel, double acc) except *:
        """An arc or helix about centre and normal; ``turn``: full turns before the end, below 0: clockwise."""

    cpdef void probe(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w, double vel, double ini_maxvel, double acc, int probe_type) except *:
        """A probing move."""

    cpdef void tap(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w, double vel, double ini_maxvel, double acc, double scale) except *:
        """A rigid tap to the point and back."""

    # --- Coordinates, units and modes

    cpdef void use_length_units(self, int units) except *:
        self.coords.use_length_units(units)

    cpdef void set_g5x_offset(self, int index, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        self.flush()
        self.coords.set_g5x(index, x, y, z, a, b, c, u, v, w)

    cpdef void set_g92_offset(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        self.flush()
        self.coords.set_g92(x, y, z, a, b, c, u, v, w)

    cpdef void set_xy_rotation(self, double theta) except *:
        self.flush()
        self.coords.set_rotation(theta)

    cpdef void use_tool_length_offset(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        self.flush()
        self.coords.set_tool(x, y, z, a, b, c, u, v, w)

    cpdef void select_plane(self, int plane) except *:
        self.coords.select_plane(plane)

    cpdef void set_feed_mode(self, int spindle, int mode) except *:
        self.flush()
        self.feed_mode = mode
        self.feed_spindle = spindle
        if not mode:
            self.stop_speed_feed_synch()

    cpdef void set_feed_rate(self, double rate) except *:
        cdef double linear, angular
        if self.feed_mode:
            self.turn_feed = self.coords.length(rate)
            self.start_speed_feed_synch(self.feed_spindle, rate, True)
            return
        linear = self.coords.feed(rate)
        angular = self.coords.feed(rate, True)
        if linear != self.linear_feed or angular != self.angular_feed:
            self.flush()
            self.linear_feed = linear
            self.angular_feed = angular

    cpdef void start_speed_feed_synch(self, int spindle, double feed_per_revolution, bint velocity_mode) except *:
        self.flush()
        self.synched = True

    cpdef void stop_speed_feed_synch(self) except *:
        self.flush()
        self.synched = False

    cpdef void set_motion_control_mode(self, int mode, double tolerance) except *:
        self.flush()
        self.motion_mode = mode
        self.term_cond = _TERM_COND[mode]
        self.tolerance = self.coords.length(tolerance)
        self._limit_joining()

    cpdef void set_naivecam_tolerance(self, double tolerance) except *:
        self.flush()
        self.naivecam_tolerance = self.coords.length(tolerance)
        self._limit_joining()

    cdef void _limit_joining(self) noexcept:
        """How far joined lines may leave the program's path."""
        self.join_tolerance = self.naivecam_tolerance
        if self.tolerance > 0.0:
            self.join_tolerance = fmin(self.join_tolerance, JOINED_SHARE * self.tolerance)

    cpdef void update_end_point(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        self.set_end(self.coords.to_machine(x, y, z, a, b, c, u, v, w))

    # --- Motion

    cpdef void straight_traverse(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        cdef double program[9]
        cdef double to[9]
        self.flush()
        program[0], program[1], program[2] = x, y, z
        program[3], program[4], program[5] = a, b, c
        program[6], program[7], program[8] = u, v, w
        self.coords.machine_point(program, to)
        self.send_line(line, C_TRAVERSE if self.indexer < 0 else C_INDEXROTARY, to)

    cpdef void straight_feed(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        cdef double program[9]
        cdef double to[9]
        program[0], program[1], program[2] = x, y, z
        program[3], program[4], program[5] = a, b, c
        program[6], program[7], program[8] = u, v, w
        self.coords.machine_point(program, to)
        self.feed_to(line, to)

    cpdef void arc_feed(self, int line, double first_end, double second_end, double first_axis, double second_axis, int rotation, double axis_end, double a, double b, double c, double u, double v, double w) except *:
        cdef Arc arc
        cdef Limits limits
        cdef int axis
        cdef double vel
        copy_point(arc.start, self.programmed_end())
        start = self.coords.to_program(arc.start[0], arc.start[1], arc.start[2], arc.start[3], arc.start[4], arc.start[5], arc.start[6], arc.start[7], arc.start[8])
        ends, centre, normal = self.coords.arc(start, first_end, second_end, first_axis, second_axis, axis_end, a, b, c, u, v, w)
        for axis in range(9):
            arc.end[axis] = ends[axis]
        for axis in range(3):
            arc.centre[axis] = centre[axis]
            arc.normal[axis] = normal[axis]
        measure_arc(&arc, rotation if rotation else 1)
        if self.arc_may_join(&arc):
            self.join_arc(line, &arc)
            return
        self.flush()
        limits = self.arc_limits(&arc)
        copy_point(self.end, arc.end)
        vel = self.requested_velocity(limits)
        if vel > 0.0 and limits.acc > 0.0:
            self.arc(line, arc.end[0], arc.end[1], arc.end[2], arc.end[3], arc.end[4], arc.end[5], arc.end[6], arc.end[7], arc.end[8],
                     arc.centre[0], arc.centre[1], arc.centre[2], arc.normal[0], arc.normal[1], arc.normal[2],
                     rotation - 1 if rotation > 0 else rotation, vel, limits.vel, limits.acc)

    cpdef void nurbs_feed(self, int line, list control_points, int order) except *:
        cdef int count = len(control_points)
        knots = [0.0] * order + [float(i) for i in range(1, count - order + 1)] + [float(max(count - order + 1, 1))] * order
        self.nurbs_knots_feed(line, control_points, knots, order)

    cpdef void nurbs_knots_feed(self, int line, list control_points, list knots, int order) except *:
        cdef int step, steps = NURBS_STEPS * len(control_points)
        cdef double first = knots[order - 1], last = knots[len(control_points)]
        cdef int* axes = plane_axes[self.coords.plane]
        x, y, z, a, b, c, u, v, w = self.chain_end()
        here = self.coords.to_program(x, y, z, a, b, c, u, v, w)
        end = list(here[:3])
        for step in range(1, steps + 1):
            end[axes[0]], end[axes[1]] = nurbs.point(control_points, order, knots, first + (last - first) * step / steps)
            self.straight_feed(line, end[0], end[1], end[2], here[3], here[4], here[5], here[6], here[7], here[8])

    cpdef void straight_probe(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w, int probe_type) except *:
        cdef double to[9]
        cdef double vel
        self.flush()
        point = self.coords.to_machine(x, y, z, a, b, c, u, v, w)
        for axis in range(9):
            to[<int>axis] = point[axis]
        cdef Limits limits = self.straight_limits(self.end, to)
        vel = self.requested_velocity(limits)
        copy_point(self.end, to)
        if vel > 0.0 and limits.acc > 0.0:
            self.probe(line, to[0], to[1], to[2], to[3], to[4], to[5], to[6], to[7], to[8], vel, limits.vel, limits.acc, probe_type)

    cpdef void rigid_tap(self, int line, double x, double y, double z, double scale) except *:
        cdef double to[9]
        self.flush()
        here = self.coords.to_program(self.end[0], self.end[1], self.end[2], self.end[3], self.end[4], self.end[5], self.end[6], self.end[7], self.end[8])
        point = self.coords.to_machine(x, y, z, here[3], here[4], here[5], here[6], here[7], here[8])
        for axis in range(9):
            to[<int>axis] = point[axis]
        cdef Limits limits = self.straight_limits(self.end, to)
        if limits.vel > 0.0 and limits.acc > 0.0:  # the tool comes back: the end point stays
            self.tap(line, to[0], to[1], to[2], to[3], to[4], to[5], to[6], to[7], to[8], limits.vel, limits.vel, limits.acc, scale)

    # --- Limits

    cdef Limits straight_limits(self, const double* start, const double* to) noexcept nogil:
        cdef Limits limits
        cdef double delta[9]
        cdef double time = 0.0, ratio = 0.0, path
        cdef int axis
        for axis in range(9):
            delta[axis] = fabs(to[axis] - start[axis]) if self.axis_mask >> axis & 1 else 0.0
            if delta[axis] < TINY:
                delta[axis] = 0.0
                continue
            time = fmax(time, delta[axis] / self.max_vel[axis])
            ratio = fmax(ratio, delta[axis] / self.max_acc[axis])
        path = norm(delta[0], delta[1], delta[2])
        if path == 0.0:
            path = norm(delta[6], delta[7], delta[8])
        limits.cartesian = path > 0.0
        if path == 0.0:
            path = norm(delta[3], delta[4], delta[5])
        return finish_limits(limits, path, time, ratio)

    cdef Limits arc_limits(self, const Arc* arc) noexcept nogil:
        cdef Limits limits
        cdef double turned = fabs(arc.angle) * arc.radius
        cdef double time = 0.0, ratio = 0.0, across, along
        cdef int axis
        limits.cartesian = True
        for axis in range(9):
            if not self.axis_mask >> axis & 1:
                continue
            if axis < 3:
                across = turned * sqrt(fmax(0.0, 1.0 - arc.normal[axis] * arc.normal[axis]))
                along = fabs(arc.height * arc.normal[axis])
                along = fmax(across, along) if across < TINY or along < TINY else hypot(across, along)
            else:
                along = fabs(arc.end[axis] - arc.start[axis])
            time = fmax(time, along / self.max_vel[axis])
            ratio = fmax(ratio, along / self.max_acc[axis])
        return finish_limits(limits, hypot(turned, arc.height), time, ratio)

    cdef double requested_velocity(self, Limits limits) noexcept nogil:
        if self.synched:
            return limits.vel
        return fmin(self.linear_feed if limits.cartesian else self.angular_feed, limits.vel)

    # --- Lines, joined where the tolerance allows it

    cdef void feed_to(self, int line, const double* to) except *:
        if self.chain_length and not self.may_join(to):
            self.flush()
        self.join(line, to)
        if self.motion_mode != CONTINUOUS or self.join_tolerance <= 0.0 or self.chain_length == CHAIN_MAX:
            self.flush()

    cdef bint may_join(self, const double* to) noexcept nogil:
        """Do all held points lie within the tolerance of the line from the last sent point to ``to``, in its direction?"""
        cdef double direction[3]
        cdef double offset[3]
        cdef double length, along, last = 0.0
        cdef int axis, point
        for axis in range(3, 9):
            if fabs(to[axis] - self.end[axis]) > TINY:
                return False
        for axis in range(3):
            direction[axis] = to[axis] - self.end[axis]
        length = norm(direction[0], direction[1], direction[2])
        if length < TINY:
            return False
        for point in range(self.chain_length):
            along = 0.0
            for axis in range(3):
                offset[axis] = self.chain[point][axis] - self.end[axis]
                along += offset[axis] * direction[axis] / length
            if along < last or along > length:
                return False
            last = along
            for axis in range(3):
                offset[axis] -= along * direction[axis] / length
            if norm(offset[0], offset[1], offset[2]) > self.join_tolerance:
                return False
        return True

    cdef void join(self, int line, const double* to) except *:
        copy_point(self.chain[self.chain_length], to)
        self.chain_length += 1
        self.chain_line = line

    cdef bint arc_may_join(self, const Arc* arc) noexcept nogil:
        """Is the arc so flat and short that its two half chords stay within the tolerance?"""
        cdef int axis
        if self.motion_mode != CONTINUOUS or self.join_tolerance <= 0.0 or fabs(arc.angle) > 1.6:
            return False
        for axis in range(3, 9):
            if fabs(arc.end[axis] - arc.start[axis]) > TINY:
                return False
        return arc.radius * (1.0 - cos(0.5 * arc.angle)) < self.join_tolerance

    cdef void join_arc(self, int line, const Arc* arc) except *:
        cdef double middle[9]
        arc_middle(arc, middle)
        self.feed_to(line, middle)
        self.feed_to(line, arc.end)

    cdef double* programmed_end(self) noexcept nogil:
        """Where the last programmed move ends, joined or sent."""
        if self.chain_length:
            return self.chain[self.chain_length - 1]
        return self.end

    cpdef void flush(self) except *:
        """Send the line that is held back, if there is one."""
        cdef double to[9]
        cdef double tolerance = self.tolerance
        if self.chain_length:
            copy_point(to, self.chain[self.chain_length - 1])
            if self.chain_length > 1 and tolerance > 0.0:
                self.tolerance = tolerance - self.join_tolerance
            self.chain_length = 0
            try:
                self.send_line(self.chain_line, C_FEED, to)
            finally:
                self.tolerance = tolerance

    cdef void send_line(self, int line, int kind, const double* to) except *:
        cdef Limits limits = self.straight_limits(self.end, to)
        cdef double vel = self.requested_velocity(limits) if kind == C_FEED else limits.vel
        copy_point(self.end, to)
        if vel > 0.0 and limits.acc > 0.0:
            self.line(line, kind, to[0], to[1], to[2], to[3], to[4], to[5], to[6], to[7], to[8], vel, limits.vel, limits.acc)
