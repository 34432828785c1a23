"""Components that offset positions or turn counts into movement: moveoff, eoffset_per_angle, anglejog, gantry. See ``declare.py``."""

from libc.math cimport M_PI, copysign, cos, fabs, fmod, sin
from libc.stdint cimport int32_t, uint8_t

from hal._messages cimport say
from hal.cell cimport hal_at as at, hal_pin
from hal.components.profile cimport Profile, approach

from hal.components.declare import BIT, FLOAT, S32, U32, declare, pin_in, pin_out


# ---- moveoff ----

cdef enum:
    JOINTS = 9
    WAYPOINTS = 1000
    TEST_WAYPOINTS = 10
    # dbg-state
    IDLE = 0
    OFFSETTING = 1
    RETURNING = 2

cdef struct Moveoff:
    hal_pin power_on, move_enable, apply_offsets, backtrack_enable, epsilon, waypoint_threshold, waypoint_sample_secs
    hal_pin warning, offset_applied, waypoint_limit, waypoint_ct, waypoint_percent_used
    hal_pin offset_in[JOINTS]
    hal_pin pos[JOINTS]
    hal_pin fb[JOINTS]
    hal_pin offset_current[JOINTS]
    hal_pin pos_plusoffset[JOINTS]
    hal_pin fb_minusoffset[JOINTS]
    hal_pin offset_vel[JOINTS]
    hal_pin offset_accel[JOINTS]
    hal_pin offset_min[JOINTS]
    hal_pin offset_max[JOINTS]
    hal_pin dbg_waypoint_limit_test, dbg_state
    size_t joints  # the personality
    Profile way[JOINTS]
    double waypoint[WAYPOINTS][JOINTS]
    double waited  # s since the last waypoint
    double epsilon_used, threshold_used, sample_used
    uint8_t was_applied


cdef bint is_applied(Moveoff* s) noexcept nogil:
    """Whether a joint is off its place by more than epsilon, or moves."""
    cdef size_t j
    for j in range(s.joints):
        if fabs(s.way[j].pos) > s.epsilon_used or s.way[j].vel != 0.0:
            return True
    return False


cdef void go(Moveoff* s, size_t j, double target, double dt) noexcept nogil:
    approach(&s.way[j], target, fabs(at(s.offset_vel[j]).f), fabs(at(s.offset_accel[j]).f), dt)


cdef void keep_waypoint(Moveoff* s, double dt) noexcept nogil:
    """Record where the joints are, when time and way since the last record are enough."""
    cdef int count = at(s.waypoint_ct).s
    cdef int room = TEST_WAYPOINTS if at(s.dbg_waypoint_limit_test).b else WAYPOINTS
    cdef bint far = False
    cdef size_t j
    s.waited += dt
    if s.waited < s.sample_used:
        return
    for j in range(s.joints):
        far = far or fabs(s.way[j].pos - (s.waypoint[count - 1][j] if count > 0 else 0.0)) >= s.threshold_used
    if not far:
        return
    if count >= room:
        if not at(s.waypoint_limit).b:
            say("moveoff: no room for more waypoints; an enabling pin must fall for the way back")
        at(s.waypoint_limit).b = 1
        return
    s.waited = 0.0
    for j in range(s.joints):
        s.waypoint[count][j] = s.way[j].pos
    at(s.waypoint_ct).s = count + 1
    at(s.waypoint_percent_used).s = 100 * (count + 1) // room


cdef void follow_inputs(Moveoff* s, double dt) noexcept nogil:
    cdef size_t j
    for j in range(s.joints):
        if at(s.waypoint_limit).b:
            go(s, j, s.way[j].pos, dt)
        else:
            go(s, j, min(max(at(s.offset_in[j]).f, at(s.offset_min[j]).f), at(s.offset_max[j]).f), dt)
    keep_waypoint(s, dt)


cdef void go_back(Moveoff* s, double dt) noexcept nogil:
    """Towards the last waypoint, or straight to zero; a waypoint that all joints have reached is dropped."""
    cdef int last = at(s.waypoint_ct).s - 1
    cdef bint there = True
    cdef double target
    cdef size_t j
    if not at(s.backtrack_enable).b:
        last = at(s.waypoint_ct).s = -1
    for j in range(s.joints):
        target = s.waypoint[last][j] if last >= 0 else 0.0
        go(s, j, target, dt)
        there = there and fabs(s.way[j].pos - target) <= s.epsilon_used
    if there or last < 0:
        at(s.waypoint_ct).s = max(last, 0)


cdef void sample_settings(Moveoff* s) noexcept nogil:
    s.epsilon_used = max(at(s.epsilon).f, 0.0001)
    s.threshold_used = at(s.waypoint_threshold).f
    s.sample_used = at(s.waypoint_sample_secs).f


cdef void warn(Moveoff* s) noexcept nogil:
    """An operator who resumes with offsets applied must hear of it."""
    if at(s.apply_offsets).b or not at(s.offset_applied).b:
        at(s.warning).b = 0
    elif s.was_applied and at(s.dbg_state).s == OFFSETTING:
        at(s.warning).b = 1
        say("moveoff: apply-offsets fell while offsets are applied; they are taken back now")
    s.was_applied = at(s.apply_offsets).b


cdef void moveoff_read(Moveoff* s, long period) noexcept nogil:
    cdef double dt = period * 1e-9
    cdef bint wanted = at(s.move_enable).b and at(s.apply_offsets).b
    cdef size_t j
    if at(s.dbg_state).s == IDLE:
        sample_settings(s)
    warn(s)
    if not at(s.power_on).b:
        for j in range(s.joints):
            s.way[j].vel = 0.0
    elif wanted:
        at(s.dbg_state).s = OFFSETTING
        follow_inputs(s, dt)
    else:
        at(s.waypoint_limit).b = 0
        go_back(s, dt)
        at(s.dbg_state).s = RETURNING if is_applied(s) else IDLE
        if at(s.dbg_state).s == IDLE:
            at(s.waypoint_ct).s = at(s.waypoint_percent_used).s = 0
    at(s.offset_applied).b = is_applied(s)


cdef void moveoff_write(Moveoff* s, long period) noexcept nogil:
    cdef size_t j
    for j in range(s.joints):
        at(s.offset_current[j]).f = s.way[j].pos
        at(s.pos_plusoffset[j]).f = at(s.pos[j]).f + s.way[j].pos
        at(s.fb_minusoffset[j]).f = at(s.fb[j]).f - s.way[j].pos


def joints(int personality) -> int:
    """How many joints a personality has."""
    return min(max(personality, 1), JOINTS)


def joint_in(str name, str doc, double default = 0.0):
    return pin_in(FLOAT, name, doc, default, count=JOINTS, personal=joints)


def joint_out(str name, str doc):
    return pin_out(FLOAT, name, doc, count=JOINTS, personal=joints)


declare("moveoff", "Offsets of joints, applied and taken back smoothly; personality= is how many joints", sizeof(Moveoff), [
    pin_in(BIT, "power-on", "mostly motion.motion-enabled; while it is false offsets stay as they are"),
    pin_in(BIT, "move-enable", "with apply-offsets: apply them"), pin_in(BIT, "apply-offsets", "with move-enable: apply them"),
    pin_in(BIT, "backtrack-enable", "go back by the way that was gone", True),
    pin_in(FLOAT, "epsilon", "how close to zero is back; at least 0.0001", 0.0005),
    pin_in(FLOAT, "waypoint-threshold", "way of one joint to a new waypoint", 0.02),
    pin_in(FLOAT, "waypoint-sample-secs", "time to a new waypoint, s", 0.02),
    pin_out(BIT, "warning", "apply-offsets fell while offsets were applied"), pin_out(BIT, "offset-applied"),
    pin_out(BIT, "waypoint-limit", "no room for waypoints: it moves no further"), pin_out(S32, "waypoint-ct"),
    pin_out(S32, "waypoint-percent-used"),
    joint_in("offset-in-{}", "wanted offset"), joint_in("pos-{}", "command, mostly joint.N.motor-pos-cmd"),
    joint_in("fb-{}", "feedback"), joint_out("offset-current-{}", "offset now"), joint_out("pos-plusoffset-{}", "pos + offset"),
    joint_out("fb-minusoffset-{}", "fb - offset, mostly to joint.N.motor-pos-fb"),
    joint_in("offset-vel-{}", "highest velocity, per s", 10.0), joint_in("offset-accel-{}", "per s^2", 100.0),
    joint_in("offset-min-{}", "", -1e20), joint_in("offset-max-{}", "", 1e20),
    pin_in(BIT, "dbg-waypoint-limit-test", "few waypoints"), pin_out(S32, "dbg-state", "0 idle, 1 offsetting, 2 going back"),
], {"read-inputs": <size_t>&moveoff_read, "write-outputs": <size_t>&moveoff_write}, personality=3, keep_personality=True)


# ---- eoffset_per_angle ----

cdef enum:
    # state-dbg
    OFF = 0
    WAITING = 1
    RUNNING = 2
    CLEARING = 3
    CLEARED = 4

cdef struct EoffsetPerAngle:
    hal_pin active, is_on, enable_in, radius_ref, angle, start_angle, fnum, rfraction, fmult, k
    hal_pin is_off, enable_out, clear, kcounts, kreciprocal, eoffset_dbg, state_dbg
    int32_t state

cdef double polygon(double apothem, double degrees, double sides) noexcept nogil:
    """Distance of a polygon's side from the centre, at an angle from the middle of a side."""
    cdef double share = 360.0 / sides
    cdef double off = fmod(degrees, share)
    if off < 0.0:
        off += share
    return apothem / cos(min(off, share - off) * M_PI / 180.0)

cdef bint possible(EoffsetPerAngle* s) noexcept nogil:
    """Whether the chosen function has what it needs."""
    return at(s.fmult).f >= 3.0 or at(s.fnum).s == 2 or at(s.fnum).s == 3

cdef double offset_at(EoffsetPerAngle* s, double degrees) noexcept nogil:
    cdef double radius = at(s.radius_ref).f, sides = at(s.fmult).f
    cdef double depth = radius * at(s.rfraction).f
    cdef double wave = cos(sides * degrees * M_PI / 180.0)
    if at(s.fnum).s == 1:
        return polygon((radius + depth) * cos(M_PI / sides), degrees, sides) - radius
    if at(s.fnum).s == 2:
        return 0.5 * depth * (1.0 - wave)
    if at(s.fnum).s == 3:
        return depth if wave < 0.0 else 0.0
    return polygon(radius + depth, degrees, sides) - radius

cdef int next_state(EoffsetPerAngle* s) noexcept nogil:
    cdef bint wanted = at(s.enable_in).b != 0
    if not at(s.is_on).b:
        return OFF
    if s.state == OFF:
        return OFF if wanted else WAITING
    if s.state == WAITING:
        return RUNNING if wanted else WAITING
    if s.state == RUNNING:
        return RUNNING if wanted and possible(s) else CLEARING
    if s.state == CLEARING:
        return CLEARING if at(s.active).b else CLEARED
    return OFF if wanted else WAITING

cdef void eoffset_per_angle(EoffsetPerAngle* s, long period) noexcept nogil:
    cdef double k = at(s.k).u if at(s.k).u > 0 else 10000.0
    cdef double counts
    at(s.kreciprocal).f = 1.0 / k
    at(s.is_off).b = not at(s.is_on).b
    if not at(s.is_on).b:
        s.state = OFF
    at(s.state_dbg).u = s.state
    at(s.enable_out).b = s.state == RUNNING or s.state == CLEARING
    at(s.clear).b = (s.state == RUNNING and not at(s.enable_in).b) or (s.state == CLEARING and at(s.clear).b)
    if s.state == RUNNING and at(s.enable_in).b and possible(s):
        counts = k * offset_at(s, at(s.angle).f - at(s.start_angle).f)
        at(s.kcounts).s = <int32_t>(counts + copysign(1e-6, counts))  # whole ones stay what they are
    else:
        at(s.kcounts).s = 0
    at(s.eoffset_dbg).f = at(s.kcounts).s / k
    s.state = next_state(s)

declare("eoffset_per_angle", "External offset by the angle of a rotary axis or a spindle", sizeof(EoffsetPerAngle), [
    pin_in(BIT, "active", "from motion.eoffset-active"), pin_in(BIT, "is-on", "from halui.machine.is-on"),
    pin_in(BIT, "enable-in"), pin_in(FLOAT, "radius-ref", "radius that the offset is added to", 1.0),
    pin_in(FLOAT, "angle", "degrees"), pin_in(FLOAT, "start-angle", "degrees"),
    pin_in(S32, "fnum", "0 inside polygon, 1 outside polygon, 2 sinusoid, 3 square wave"),
    pin_in(FLOAT, "rfraction", "amplitude, as a part of radius-ref", 0.1),
    pin_in(FLOAT, "fmult", "sides of a polygon, at least 3; periods of a wave in a turn", 6.0),
    pin_in(U32, "k", "counts per unit; 0 is 10000", 10000), pin_out(BIT, "is-off", "not is-on"),
    pin_out(BIT, "enable-out", "to axis.L.eoffset-enable"), pin_out(BIT, "clear", "to axis.L.eoffset-clear"),
    pin_out(S32, "kcounts", "to axis.L.eoffset-counts"), pin_out(FLOAT, "kreciprocal", "1/k, to axis.L.eoffset-scale"),
    pin_out(FLOAT, "eoffset-dbg", "offset"), pin_out(U32, "state-dbg"),
], {"": <size_t>&eoffset_per_angle})


# ---- anglejog ----

cdef struct Anglejog:
    hal_pin enable_in, counts_in, angle_degrees_in, iscale_factor, scale_in, max_vel, max_accel, accel_fraction_in
    hal_pin enable_out, current_scale, current_scale_out, coscounts, sincounts, cos_accel_fraction, sin_accel_fraction
    hal_pin active, current_angle_degrees, current_mag, current_vel
    Profile way  # along the vector, units
    int32_t factor, counts_from

cdef void anglejog(Anglejog* s, long period) noexcept nogil:
    cdef double angle, scale
    at(s.enable_out).b = at(s.enable_in).b
    if not at(s.enable_in).b:
        angle = at(s.angle_degrees_in).f * M_PI / 180.0
        at(s.cos_accel_fraction).f = at(s.accel_fraction_in).f * fabs(cos(angle))
        at(s.sin_accel_fraction).f = at(s.accel_fraction_in).f * fabs(sin(angle))
        s.factor = max(at(s.iscale_factor).s, 1)
        at(s.current_scale).f = at(s.scale_in).f
        at(s.current_scale_out).f = at(s.scale_in).f / s.factor
        at(s.current_angle_degrees).f = at(s.angle_degrees_in).f
        s.way = Profile(0.0, 0.0)
        s.counts_from = at(s.counts_in).s
        at(s.coscounts).s = at(s.sincounts).s = 0
        at(s.active).b = 0
        at(s.current_mag).f = at(s.current_vel).f = 0.0
        return
    angle = at(s.current_angle_degrees).f * M_PI / 180.0
    scale = at(s.current_scale_out).f
    at(s.active).b = approach(&s.way, (at(s.counts_in).s - s.counts_from) * at(s.current_scale).f,
                              at(s.max_vel).f, at(s.max_accel).f, period * 1e-9)
    at(s.current_mag).f, at(s.current_vel).f = s.way.pos, s.way.vel
    if scale != 0.0:
        at(s.coscounts).s = <int32_t>(s.way.pos * cos(angle) / scale)
        at(s.sincounts).s = <int32_t>(s.way.pos * sin(angle) / scale)

declare("anglejog", "Wheel counts as movement of two axes at an angle", sizeof(Anglejog), [
    pin_in(BIT, "enable-in", "false: angle and scale may change"), pin_in(S32, "counts-in", "of the wheel"),
    pin_in(FLOAT, "angle-degrees-in"), pin_in(S32, "iscale-factor", "finer counts, for whole numbers", 10000),
    pin_in(FLOAT, "scale-in", "units for a count"), pin_in(FLOAT, "max-vel", "along the vector, per s"),
    pin_in(FLOAT, "max-accel", "per s^2"), pin_in(FLOAT, "accel-fraction-in", "", 1.0),
    pin_out(BIT, "enable-out", "to the axes' jog-enable"), pin_out(FLOAT, "current-scale"),
    pin_out(FLOAT, "current-scale-out", "to the axes' jog-scale"), pin_out(S32, "coscounts", "to one axis's jog-counts"),
    pin_out(S32, "sincounts", "to the other's"), pin_out(FLOAT, "cos-accel-fraction", "to one axis's jog-accel-fraction"),
    pin_out(FLOAT, "sin-accel-fraction", "to the other's"), pin_out(BIT, "active", "moving"),
    pin_out(FLOAT, "current-angle-degrees"), pin_out(FLOAT, "current-mag", "units along the vector"),
    pin_out(FLOAT, "current-vel", "per s"),
], {"": <size_t>&anglejog})


# ---- gantry ----

cdef enum:
    GANTRY_JOINTS = 7

cdef struct Gantry:
    hal_pin joint_pos_cmd[GANTRY_JOINTS]
    hal_pin joint_pos_fb[GANTRY_JOINTS]
    hal_pin joint_home[GANTRY_JOINTS]
    hal_pin joint_offset[GANTRY_JOINTS]
    hal_pin position_cmd, position_fb, home, limit, search_vel
    size_t joints  # the personality
    size_t measured  # the joint whose feedback is the gantry's
    double old_cmd

cdef void gantry_read(Gantry* s, long period) noexcept nogil:
    """While some switches are closed and others not yet, the feedback is that of a joint that is still to come."""
    cdef size_t i, count = 0, open_one = 0
    for i in range(s.joints):
        if at(s.joint_home[i]).b:
            count += 1
        else:
            open_one = i
    if count == s.joints:
        at(s.home).b = 1
    elif count == 0:
        at(s.home).b = 0
    at(s.limit).b = count > 0
    if at(s.limit).b and not at(s.home).b:
        s.measured = open_one
    at(s.position_fb).f = at(s.joint_pos_fb[s.measured]).f + at(s.joint_offset[s.measured]).f

cdef void gantry_write(Gantry* s, long period) noexcept nogil:
    """Joints follow the command; while the gantry searches, one with a closed switch stands still."""
    cdef double step = at(s.position_cmd).f - s.old_cmd
    cdef bint searching = step * at(s.search_vel).f > 0.0 and at(s.limit).b and not at(s.home).b
    cdef size_t i
    s.old_cmd = at(s.position_cmd).f
    for i in range(s.joints):
        if searching and at(s.joint_home[i]).b:
            at(s.joint_offset[i]).f += step
        at(s.joint_pos_cmd[i]).f = at(s.position_cmd).f - at(s.joint_offset[i]).f

cdef int gantry_joints(int personality):
    return min(max(personality, 1), GANTRY_JOINTS)

declare("gantry", "Several joints driven as one axis, each homed to its own switch", sizeof(Gantry), [
    pin_out(FLOAT, "joint.{:02}.pos-cmd", "to the drive", count=GANTRY_JOINTS, personal=gantry_joints),
    pin_in(FLOAT, "joint.{:02}.pos-fb", "from the encoder", count=GANTRY_JOINTS, personal=gantry_joints),
    pin_in(BIT, "joint.{:02}.home", "home switch", count=GANTRY_JOINTS, personal=gantry_joints),
    pin_out(FLOAT, "joint.{:02}.offset", "how far it stays behind the command", count=GANTRY_JOINTS, personal=gantry_joints),
    pin_in(FLOAT, "position-cmd", "from motion"), pin_out(FLOAT, "position-fb", "to motion"),
    pin_out(BIT, "home", "true from when all switches are closed until all are open"), pin_out(BIT, "limit", "a switch is closed"),
    pin_in(FLOAT, "search-vel", "HOME_SEARCH_VEL of the INI file: its sign counts"),
], {"read": <size_t>&gantry_read, "write": <size_t>&gantry_write}, personality=2, keep_personality=True)
