"""The HAL pins of motion: every name with its type, direction and the member of the state that it shows.

motmod makes HAL pins of them, the stepped simulator reads and writes them by name, docs/motion.md lists them. Names,
types and directions are LinuxCNC 2.9's (motion(9)).
"""

from libc.stdint cimport uintptr_t

from emcmot.state cimport Axis, Joint, Motion, Spindle

from typing import NamedTuple

from emcmot.layout import same_size

same_size(__name__, "Motion", sizeof(Motion))

AXES = "xyzabcuvw"


class Pin(NamedTuple):
    """One pin: HAL name, ``bit``, ``float``, ``s32`` or ``u32``, ``IN``, ``OUT`` or ``IO``, and where its value is."""

    name: str
    type: str
    direction: str
    address: int


cdef class Collector:
    """Collects pins; their names begin with ``prefix``."""

    cdef list pins
    cdef str prefix

    def __init__(self):
        self.pins = []

    cdef void bit_in(self, str name, void* at) except *:
        self.add(name, "bit", "IN", at)

    cdef void bit_out(self, str name, void* at) except *:
        self.add(name, "bit", "OUT", at)

    cdef void s32_in(self, str name, void* at) except *:
        self.add(name, "s32", "IN", at)

    cdef void s32_out(self, str name, void* at) except *:
        self.add(name, "s32", "OUT", at)

    cdef void float_in(self, str name, void* at) except *:
        self.add(name, "float", "IN", at)

    cdef void float_out(self, str name, void* at) except *:
        self.add(name, "float", "OUT", at)

    cdef void add(self, str name, str kind, str direction, void* at) except *:
        self.pins.append(Pin(f"{self.prefix}{name}", kind, direction, <uintptr_t>at))


cdef void joint_pins(Collector c, Joint* j, bint lockable, bint extra) except *:
    c.float_in("motor-pos-fb", &j.motor_pos_fb)
    c.bit_in("home-sw-in", &j.home_sw)
    c.bit_in("pos-lim-sw-in", &j.pos_lim_sw)
    c.bit_in("neg-lim-sw-in", &j.neg_lim_sw)
    c.bit_in("amp-fault-in", &j.amp_fault_in)
    c.s32_in("jog-counts", &j.jog_counts)
    c.bit_in("jog-enable", &j.jog_enable)
    c.bit_in("jog-vel-mode", &j.jog_vel_mode)
    c.float_in("jog-scale", &j.jog_scale)
    c.float_in("jog-accel-fraction", &j.jog_accel_fraction)
    c.add("index-enable", "bit", "IO", &j.index_enable)
    if lockable:
        c.bit_in("is-unlocked", &j.is_unlocked)
        c.bit_out("unlock", &j.unlock)
    if extra:
        c.float_in("posthome-cmd", &j.posthome_cmd)
    c.float_out("motor-pos-cmd", &j.motor_pos_cmd)
    c.float_out("pos-cmd", &j.pos_cmd)
    c.float_out("vel-cmd", &j.vel_cmd)
    c.float_out("acc-cmd", &j.acc_cmd)
    c.float_out("jerk-cmd", &j.jerk_cmd)
    c.float_out("pos-fb", &j.pos_fb)
    c.float_out("coarse-pos-cmd", &j.coarse_pos)
    c.float_out("backlash-corr", &j.backlash_corr)
    c.float_out("backlash-filt", &j.correction.pos)
    c.float_out("backlash-vel", &j.correction.vel)
    c.float_out("motor-offset", &j.motor_offset)
    c.float_out("f-error", &j.ferror)
    c.float_out("f-error-lim", &j.ferror_limit)
    c.float_out("free-pos-cmd", &j.free.target)
    c.float_out("free-vel-lim", &j.free.vel_limit)
    c.bit_out("free-tp-enable", &j.free.enabled)
    c.bit_out("kb-jog-active", &j.kb_jog)
    c.bit_out("wheel-jog-active", &j.wheel_jog)
    c.bit_out("active", &j.active)
    c.bit_out("in-position", &j.inpos)
    c.bit_out("error", &j.error)
    c.bit_out("faulted", &j.faulted)
    c.bit_out("f-errored", &j.ferrored)
    c.bit_out("pos-hard-limit", &j.on_pos_limit)
    c.bit_out("neg-hard-limit", &j.on_neg_limit)
    c.bit_out("amp-enable-out", &j.amp_enable)
    c.bit_out("homed", &j.home.homed)
    c.bit_out("homing", &j.home.homing)
    c.s32_out("home-state", &j.home.state)


cdef void axis_pins(Collector c, Axis* a) except *:
    c.s32_in("jog-counts", &a.jog_counts)
    c.bit_in("jog-enable", &a.jog_enable)
    c.bit_in("jog-vel-mode", &a.jog_vel_mode)
    c.float_in("jog-scale", &a.jog_scale)
    c.float_in("jog-accel-fraction", &a.jog_accel_fraction)
    c.bit_in("eoffset-enable", &a.eoffset_enable)
    c.bit_in("eoffset-clear", &a.eoffset_clear)
    c.s32_in("eoffset-counts", &a.eoffset_counts)
    c.float_in("eoffset-scale", &a.eoffset_scale)
    c.float_out("eoffset", &a.eoffset.pos)
    c.float_out("eoffset-request", &a.eoffset_request)
    c.float_out("pos-cmd", &a.pos_cmd)
    c.float_out("teleop-pos-cmd", &a.teleop.target)
    c.float_out("teleop-vel-cmd", &a.teleop.vel)
    c.float_out("teleop-vel-lim", &a.teleop.vel_limit)
    c.bit_out("teleop-tp-enable", &a.teleop.enabled)
    c.bit_out("kb-jog-active", &a.kb_jog)
    c.bit_out("wheel-jog-active", &a.wheel_jog)


cdef void spindle_pins(Collector c, Spindle* s) except *:
    c.float_in("revs", &s.revs)
    c.float_in("speed-in", &s.speed_in)
    c.bit_in("at-speed", &s.at_speed)
    c.bit_in("amp-fault-in", &s.amp_fault_in)
    c.bit_in("is-oriented", &s.is_oriented)
    c.s32_in("orient-fault", &s.orient_fault)
    c.bit_in("inhibit", &s.inhibit)
    c.add("index-enable", "bit", "IO", &s.index_enable)
    c.bit_out("on", &s.on)
    c.bit_out("forward", &s.forward)
    c.bit_out("reverse", &s.reverse)
    c.bit_out("brake", &s.brake)
    c.bit_out("locked", &s.locked)
    c.bit_out("orient", &s.orient)
    c.float_out("orient-angle", &s.orient_angle)
    c.s32_out("orient-mode", &s.orient_mode)
    c.float_out("speed-out", &s.speed_out)
    c.float_out("speed-out-abs", &s.speed_out_abs)
    c.float_out("speed-out-rps", &s.speed_out_rps)
    c.float_out("speed-out-rps-abs", &s.speed_out_rps_abs)
    c.float_out("speed-cmd-rps", &s.speed_cmd_rps)


cdef void machine_pins(Collector c, Motion* m) except *:
    c.bit_in("enable", &m.enable_in)
    c.bit_in("feed-hold", &m.feed_hold)
    c.bit_in("feed-inhibit", &m.feed_inhibit)
    c.bit_in("homing-inhibit", &m.homing_inhibit)
    c.bit_in("jog-inhibit", &m.jog_inhibit)
    c.bit_in("jog-stop", &m.jog_stop)
    c.bit_in("jog-stop-immediate", &m.jog_stop_immediate)
    c.bit_in("probe-input", &m.probe_input)
    c.float_in("adaptive-feed", &m.adaptive_feed)
    if m.kins.ways > 1:
        c.float_in("switchkins-type", &m.switchkins_type)
    c.bit_out("motion-enabled", &m.motion_enabled_out)
    c.bit_out("coord-mode", &m.coord_mode_out)
    c.bit_out("teleop-mode", &m.teleop_mode_out)
    c.bit_out("coord-error", &m.coord_error_out)
    c.bit_out("in-position", &m.in_position)
    c.bit_out("is-all-homed", &m.all_homed)
    c.bit_out("jog-is-active", &m.jog_active)
    c.bit_out("on-soft-limit", &m.on_soft_limit)
    c.bit_out("tp-reverse", &m.tp_reverse_out)
    c.bit_out("eoffset-active", &m.eoffset_active)
    c.bit_out("eoffset-limited", &m.eoffset_limited)
    c.s32_out("motion-type", &m.motion_type_out)
    c.s32_out("program-line", &m.program_line)
    c.float_out("current-vel", &m.current_vel)
    c.float_out("requested-vel", &m.requested_vel)
    c.float_out("distance-to-go", &m.distance_to_go)
    c.float_out("feed-upm", &m.feed_upm)
    c.float_out("feed-inches-per-minute", &m.feed_ipm)
    c.float_out("feed-inches-per-second", &m.feed_ips)
    c.float_out("feed-mm-per-minute", &m.feed_mmpm)
    c.float_out("feed-mm-per-second", &m.feed_mmps)
    c.add("servo.last-period", "u32", "OUT", &m.last_period)
    for n in range(9):
        c.float_out(f"tooloffset.{AXES[n]}", &m.tool_offset[n])
    for n in range(m.num_misc_error):
        c.bit_in(f"misc-error-{n:02d}", &m.misc_error[n])
    for n in range(m.num_dio):
        c.bit_in(f"digital-in-{n:02d}", &m.digital_in[n])
        c.bit_out(f"digital-out-{n:02d}", &m.digital_out[n])
    for n in range(m.num_aio):
        c.float_in(f"analog-in-{n:02d}", &m.analog_in[n])
        c.float_out(f"analog-out-{n:02d}", &m.analog_out[n])


cdef list pins_of(Motion* m, int unlock_mask):
    """All pins of this machine; joints in ``unlock_mask`` have a lock."""
    cdef Collector c = Collector()
    c.prefix = "motion."
    machine_pins(c, m)
    for n in range(m.max_joints):
        c.prefix = f"joint.{n}."
        joint_pins(c, &m.joint[n], unlock_mask >> n & 1, n >= m.max_joints - m.num_extra_joints)
    for n in range(9):
        c.prefix = f"axis.{AXES[n]}."
        axis_pins(c, &m.axis[n])
    for n in range(m.max_spindles):
        c.prefix = f"spindle.{n}."
        spindle_pins(c, &m.spindle[n])
    return c.pins
