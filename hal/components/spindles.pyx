"""Components for spindles and torches: spindle, spindle_monitor, thc, thcud, ohmic. See ``declare.py``."""

from libc.math cimport fabs
from libc.stdint cimport uint8_t, uint32_t

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import BIT, FLOAT, U32, declare, numbers, param_rw, pin_in, pin_out


# ---- spindle ----

cdef enum:
    GEARS = 16

cdef struct Spindle:
    hal_pin select_gear, commanded_speed, actual_speed, simulate_encoder, enable, spindle_lpf
    hal_pin spindle_rpm, spindle_rpm_abs, output, current_gear, at_speed, forward, reverse, brake, zero_speed, limited
    hal_pin scale[GEARS]
    hal_pin min_[GEARS]
    hal_pin max_[GEARS]
    hal_pin accel[GEARS]
    hal_pin decel[GEARS]
    hal_pin speed_tolerance[GEARS]
    hal_pin zero_tolerance[GEARS]
    hal_pin offset[GEARS]
    hal_pin select[GEARS]
    size_t gears  # the personality
    double simulated  # RPM
    double smooth  # RPM, for the display

cdef size_t chosen_gear(Spindle* s) noexcept nogil:
    """The highest gear that is selected, by its bit or by number."""
    cdef size_t gear = min(<size_t>at(s.select_gear).u, s.gears - 1)
    cdef size_t i
    for i in range(s.gears):
        if at(s.select[i]).b:
            gear = i
    return gear

cdef double wanted_speed(Spindle* s, size_t gear) noexcept nogil:
    """The command within the gear's speeds, 0 where the spindle must stop."""
    cdef double speed = at(s.commanded_speed).f, size = fabs(speed)
    at(s.limited).b = 0
    if not at(s.enable).b or speed == 0.0:
        return 0.0
    if at(s.max_[gear]).f > 0.0 and size > at(s.max_[gear]).f:
        size = at(s.max_[gear]).f
    size = max(size, at(s.min_[gear]).f)
    at(s.limited).b = size != fabs(speed)
    return -size if speed < 0.0 else size

cdef void spindle(Spindle* s, long period) noexcept nogil:
    cdef double dt = period * 1e-9
    cdef size_t gear = chosen_gear(s)
    cdef double target = wanted_speed(s, gear)
    cdef double actual = s.simulated if at(s.simulate_encoder).b else at(s.actual_speed).f * 60.0
    cdef bint faster = fabs(target) > fabs(actual) and target * actual >= 0.0
    cdef double rate = fabs(at(s.accel[gear]).f if faster else at(s.decel[gear]).f)
    cdef double step = rate * dt if at(s.simulate_encoder).b else rate
    cdef double goal = 0.0 if target * actual < 0.0 and fabs(actual) > at(s.zero_tolerance[gear]).f else target
    cdef double speed = goal if step == 0.0 else min(max(goal, actual - step), actual + step)
    s.simulated = speed
    at(s.current_gear).u = gear
    at(s.spindle_rpm).f = actual
    at(s.zero_speed).b = fabs(actual) <= at(s.zero_tolerance[gear]).f
    at(s.at_speed).b = fabs(actual - target) <= at(s.speed_tolerance[gear]).f
    if at(s.at_speed).b and at(s.spindle_lpf).f > 0.0:
        s.smooth += (fabs(actual) - s.smooth) * min(dt * at(s.spindle_lpf).f, 1.0)
    else:
        s.smooth = fabs(actual)
    at(s.spindle_rpm_abs).f = s.smooth
    at(s.brake).b = not faster and not at(s.at_speed).b and not at(s.zero_speed).b
    at(s.forward).b = speed > 0.0
    at(s.reverse).b = speed < 0.0
    at(s.output).f = 0.0 if speed == 0.0 else (fabs(speed) + at(s.offset[gear]).f) * at(s.scale[gear]).f


def gear_in(int type_, str name, str doc = "", default = 0, **more):
    """An input for each gear."""
    return pin_in(type_, name, doc, default, count=GEARS, personal=lambda p: min(max(p, 1), GEARS), **more)


def numgears(dict args) -> list:
    """Personalities: the numbers of gears."""
    return numbers("spindle", args, "numgears") or [1] * 64


declare("spindle", "Speed of a spindle with ramps, gears and separate directions; numgears=N,... are the gears", sizeof(Spindle), [
    pin_in(U32, "select-gear", "where no select bit is true"), pin_in(FLOAT, "commanded-speed", "RPM"),
    pin_in(FLOAT, "actual-speed", "revolutions per s, by an encoder"), pin_in(BIT, "simulate-encoder", "there is no encoder"),
    pin_in(BIT, "enable", "false: slow down to rest"), pin_in(FLOAT, "spindle-lpf", "smoothing at speed, 1/s; 0 is none"),
    pin_out(FLOAT, "spindle-rpm", "RPM, negative backwards"), pin_out(FLOAT, "spindle-rpm-abs", "for a display"),
    pin_out(FLOAT, "output", "(speed + offset) * scale"), pin_out(U32, "current-gear"), pin_out(BIT, "at-speed"),
    pin_out(BIT, "forward"), pin_out(BIT, "reverse"), pin_out(BIT, "brake", "slowing down"), pin_out(BIT, "zero-speed"),
    pin_out(BIT, "limited", "the command is beyond min or max"),
    gear_in(FLOAT, "scale.{}", "of output", 1.0), gear_in(FLOAT, "min.{}", "RPM"), gear_in(FLOAT, "max.{}", "RPM; 0 is no limit"),
    gear_in(FLOAT, "accel.{}", "RPM per s; with an encoder RPM above the actual speed"), gear_in(FLOAT, "decel.{}", "the same downwards"),
    gear_in(FLOAT, "speed-tolerance.{}", "RPM, for at-speed", 20.0),
    gear_in(FLOAT, "zero-tolerance.{}", "RPM, for zero-speed", 20.0), gear_in(FLOAT, "offset.{}", "RPM, of output"),
    gear_in(BIT, "select.{}", "take this gear", default_of=lambda i, gears: gears <= 1),
], {"": <size_t>&spindle}, options=("numgears",), decode=numgears, keep_personality=True)


# ---- spindle_monitor ----

cdef struct SpindleMonitor:
    hal_pin spindle_is_on, spindle_command, spindle_feedback, spindle_at_speed, spindle_underspeed, level, threshold

cdef void spindle_monitor(SpindleMonitor* s, long period) noexcept nogil:
    """level: 0 off, 1 coming up to speed, 2 it was at speed; both outputs stay until the spindle is switched off."""
    cdef double short = at(s.spindle_command).f - at(s.spindle_feedback).f
    if not at(s.spindle_is_on).b:
        at(s.level).u = at(s.spindle_at_speed).b = at(s.spindle_underspeed).b = 0
        return
    if at(s.level).u == 0:
        at(s.level).u = 1
    if at(s.level).u == 1 and fabs(short) < at(s.threshold).f:
        at(s.level).u = 2
        at(s.spindle_at_speed).b = 1
    if at(s.level).u == 2 and short > at(s.threshold).f:
        at(s.spindle_underspeed).b = 1

declare("spindle_monitor", "Whether a spindle reached its speed, and keeps it", sizeof(SpindleMonitor), [
    pin_in(BIT, "spindle-is-on"), pin_in(FLOAT, "spindle-command"), pin_in(FLOAT, "spindle-feedback"),
    pin_out(BIT, "spindle-at-speed", "it has reached its speed"), pin_out(BIT, "spindle-underspeed", "and was too slow since"),
    param_rw(U32, "level", "0 off, 1 coming up, 2 it was at speed"), param_rw(FLOAT, "threshold", "largest difference of the two"),
], {"": <size_t>&spindle_monitor})


# ---- thc ----

cdef struct Thc:
    hal_pin encoder_vel, current_vel, requested_vel, volts_requested, vel_tol, torch_on, arc_ok, enable, z_pos_in
    hal_pin z_pos_out, z_fb_out, volts, vel_status, offset_value, vel_scale, scale_offset, velocity_tol, voltage_tol, correction_vel
    double offset  # of Z
    double old_z

cdef void thc(Thc* s, long period) noexcept nogil:
    cdef double z = at(s.z_pos_in).f, error, slow
    at(s.volts).f = max((at(s.encoder_vel).f - at(s.scale_offset).f) * at(s.vel_scale).f, 0.0)
    at(s.offset_value).f = s.offset
    slow = at(s.requested_vel).f * (1.0 - at(s.velocity_tol).f * 0.01)
    at(s.vel_status).b = at(s.requested_vel).f > 0.0 and at(s.current_vel).f >= slow
    if at(s.enable).b and at(s.torch_on).b and at(s.arc_ok).b and at(s.vel_status).b:
        error = at(s.volts_requested).f - at(s.volts).f  # too few volts: the torch is too low
        if error > at(s.voltage_tol).f:
            s.offset += at(s.correction_vel).f
        elif error < -at(s.voltage_tol).f:
            s.offset -= at(s.correction_vel).f
    elif not at(s.torch_on).b and z > s.old_z:  # give back the correction on the way up, no faster than Z moves
        s.offset -= min(max(s.offset, s.old_z - z), z - s.old_z)
    s.old_z = z
    at(s.z_pos_out).f = z + s.offset
    at(s.z_fb_out).f = z

declare("thc", "Height of a plasma torch by its voltage", sizeof(Thc), [
    pin_in(FLOAT, "encoder-vel", "frequency that stands for the voltage"), pin_in(FLOAT, "current-vel", "from motion.current-vel"),
    pin_in(FLOAT, "requested-vel", "from motion.requested-vel"), pin_in(FLOAT, "volts-requested"),
    pin_in(FLOAT, "vel-tol", "without effect; velocity-tol counts"), pin_in(BIT, "torch-on", "from spindle.N.on"),
    pin_in(BIT, "arc-ok"), pin_in(BIT, "enable", "false: no correction"), pin_in(FLOAT, "z-pos-in", "from axis.N.motor-pos-cmd"),
    pin_out(FLOAT, "z-pos-out", "z-pos-in with the correction"), pin_out(FLOAT, "z-fb-out", "feedback without it"),
    pin_out(FLOAT, "volts"), pin_out(BIT, "vel-status", "fast enough to correct"), pin_out(FLOAT, "offset-value", "correction of the period before"),
    param_rw(FLOAT, "vel-scale", "volts for a Hz"), param_rw(FLOAT, "scale-offset", "Hz at 0 volts"),
    param_rw(FLOAT, "velocity-tol", "percent that the torch may be slower and still correct"),
    param_rw(FLOAT, "voltage-tol", "volts off without correction"), param_rw(FLOAT, "correction-vel", "units of Z in a period"),
], {"": <size_t>&thc}, most=1, takes_names=False, instance="thc")


# ---- thcud ----

cdef struct ThcUpDown:
    hal_pin torch_up, torch_down, current_vel, requested_vel, torch_on, arc_ok, enable, z_pos_in
    hal_pin z_pos_out, z_fb_out, cur_offset, vel_status, removing_offset, velocity_tol, correction_vel
    double offset  # of Z
    double old_z

cdef void thcud(ThcUpDown* s, long period) noexcept nogil:
    cdef double z = at(s.z_pos_in).f, slow, back
    if at(s.enable).b:
        slow = at(s.requested_vel).f * (1.0 - at(s.velocity_tol).f * 0.01)
        at(s.vel_status).b = at(s.current_vel).f > 0.0 and at(s.current_vel).f >= slow
        at(s.removing_offset).b = 0
        if at(s.torch_on).b and at(s.arc_ok).b and at(s.vel_status).b:
            if at(s.torch_up).b:
                s.offset += at(s.correction_vel).f
            if at(s.torch_down).b:
                s.offset -= at(s.correction_vel).f
        elif not at(s.torch_on).b and z > s.old_z and s.offset != 0.0:
            back = z - s.old_z  # give the correction back on the way up, no faster than Z moves
            at(s.removing_offset).b = 1
            s.offset -= min(max(s.offset, -back), back)
    s.old_z = z
    at(s.z_pos_out).f = z + s.offset if at(s.enable).b else z
    at(s.z_fb_out).f = z

declare("thcud", "Height of a plasma torch by an up and a down signal", sizeof(ThcUpDown), [
    pin_in(BIT, "torch-up", "the torch is too low"), pin_in(BIT, "torch-down", "the torch is too high"),
    pin_in(FLOAT, "current-vel", "from motion.current-vel"), pin_in(FLOAT, "requested-vel", "from motion.requested-vel"),
    pin_in(BIT, "torch-on", "from spindle.N.on"), pin_in(BIT, "arc-ok"),
    pin_in(BIT, "enable", "false: Z passes through"), pin_in(FLOAT, "z-pos-in", "from axis.N.motor-pos-cmd"),
    pin_out(FLOAT, "z-pos-out", "z-pos-in with the correction"), pin_out(FLOAT, "z-fb-out", "feedback without it"),
    pin_out(FLOAT, "cur-offset", "always 0"), pin_out(BIT, "vel-status", "fast enough to correct"),
    pin_out(BIT, "removing-offset", "the correction is given back now"),
    param_rw(FLOAT, "velocity-tol", "percent that the torch may be slower and still correct"),
    param_rw(FLOAT, "correction-vel", "units of Z in a period"),
], {"": <size_t>&thcud}, most=1, takes_names=False, instance="thcud")


# ---- ohmic ----

cdef struct Ohmic:
    hal_pin thcad_0_volt_freq, thcad_max_volt_freq, thcad_divide, thcad_fullscale, velocity_in, volt_divider
    hal_pin ohmic_threshold, ohmic_low, arc_on, thcad_volts, ohmic_volts, ohmic_on, is_probing

cdef void ohmic(Ohmic* s, long period) noexcept nogil:
    cdef double span = at(s.thcad_max_volt_freq).f - at(s.thcad_0_volt_freq).f
    cdef double share = 0.0
    if span != 0.0:
        share = (at(s.velocity_in).f * at(s.thcad_divide).f - at(s.thcad_0_volt_freq).f) / span
    at(s.thcad_volts).f = share * at(s.thcad_fullscale).f
    at(s.ohmic_volts).f = at(s.thcad_volts).f * at(s.volt_divider).f
    at(s.arc_on).b = at(s.thcad_volts).f >= at(s.thcad_fullscale).f
    if at(s.is_probing).b and at(s.ohmic_volts).f >= at(s.ohmic_threshold).f:
        at(s.ohmic_on).b = 1
    elif at(s.is_probing).b and at(s.ohmic_volts).f <= at(s.ohmic_low).f:
        at(s.ohmic_on).b = 0

declare("ohmic", "Contact of a torch with the sheet, by the voltage that a THCAD card measures", sizeof(Ohmic), [
    pin_in(FLOAT, "thcad-0-volt-freq", "of the card at 0 V, Hz"),
    pin_in(FLOAT, "thcad-max-volt-freq", "at its full scale, Hz"),
    pin_in(FLOAT, "thcad-divide", "1, 32, 64 or 128, as its links say", 32.0),
    pin_in(FLOAT, "thcad-fullscale", "5, 10 or 300 V", 5.0),
    pin_in(FLOAT, "velocity-in", "of the encoder that counts it, Hz"),
    pin_in(FLOAT, "volt-divider", "before the card", 4.9), pin_in(FLOAT, "ohmic-threshold", "contact from here on, V", 18.0),
    pin_in(FLOAT, "ohmic-low", "no contact down from here, V", 5.0), pin_out(BIT, "arc-on", "full scale is reached"),
    pin_out(FLOAT, "thcad-volts", "at the card"), pin_out(FLOAT, "ohmic-volts", "before the divider"),
    pin_out(BIT, "ohmic-on", "contact"), pin_in(BIT, "is-probing", "contact is looked at"),
], {"": <size_t>&ohmic})
