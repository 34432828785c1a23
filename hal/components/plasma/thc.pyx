"""`plasmac`'s height control: the torch follows the arc's voltage, or move-up and move-down, while it cuts."""

from libc.math cimport fabs
from libc.stdint cimport int32_t

from hal.cell cimport hal_at as at

from hal.components.plasma.arc cimport arc_ignored
from hal.components.plasma.moves cimport counted, over, z_reached
from hal.components.plasmac cimport CUT_MODE_01, CUT_MODE_2, HISTORY, Plasmac

cdef double FULL_SPEED = 0.998  # share of the requested feed rate that counts as all of it


cdef bint at_full_speed(Plasmac* s) noexcept nogil:
    return at(s.current_feed_rate).f >= at(s.requested_feed_rate).f * FULL_SPEED

cdef void begin_cut(Plasmac* s) noexcept nogil:
    s.delay = at(s.thc_delay).f
    s.readings = 0
    s.reading_sum = 0.0
    s.has_target = 0

cdef void hear_voltage(Plasmac* s) noexcept nogil:
    """Keep the readings from which thc-auto tells a steady voltage."""
    s.newest = (s.newest + 1) % HISTORY
    s.history[s.newest] = at(s.arc_voltage_out).f
    s.heard = min(s.heard + 1, <int32_t>HISTORY)

cdef bint steady(Plasmac* s, double* mean) noexcept nogil:
    """Whether the last readings are within the threshold; with their mean."""
    cdef int32_t i, wanted = min(max(at(s.thc_sample_counts).s, 1), <int32_t>HISTORY)
    cdef double volts = s.history[s.newest], low = volts, high = volts, total = 0.0
    for i in range(wanted):
        volts = s.history[(s.newest - i + HISTORY) % HISTORY]
        low = min(low, volts)
        high = max(high, volts)
        total += volts
    mean[0] = total / wanted
    return s.heard >= wanted and high - low <= at(s.thc_sample_threshold).f

cdef bint take_target(Plasmac* s, double volts) noexcept nogil:
    at(s.target_volts).f = volts if at(s.use_auto_volts).b else at(s.cut_volts).f
    s.has_target = 1
    s.override = 0.0
    s.last_error = 0.0
    return True

cdef void find_target(Plasmac* s) noexcept nogil:
    """The voltage that is to be kept, once the torch is at its feed rate."""
    cdef double mean = 0.0
    if not at_full_speed(s) or not at(s.thc_enabled).b or not at(s.arc_ok_out).b:
        return
    if at(s.thc_auto).b and at(s.use_auto_volts).b:
        if steady(s, &mean):
            take_target(s, mean)
    elif over(&s.delay, s.dt):
        s.reading_sum += at(s.arc_voltage_out).f
        s.readings += 1
        if s.readings >= at(s.target_samples).s or not at(s.use_auto_volts).b:
            take_target(s, s.reading_sum / s.readings)

cdef double thc_step(Plasmac* s) noexcept nogil:
    """Counts of a period at the highest speed."""
    return <int32_t>(at(s.thc_feed_rate).f * s.rate)

cdef void move(Plasmac* s, double change) noexcept nogil:
    at(s.z_offset_counts).s = <int32_t><float>(at(s.z_offset_counts).s + change)
    if change > 0.0:
        at(s.led_up).b = 1
    elif change < 0.0:
        at(s.led_down).b = 1
    else:
        at(s.led_up).b = at(s.led_down).b = 0

cdef void correct(Plasmac* s, double error) noexcept nogil:
    """One period towards no error, in V; positive is up."""
    cdef double change, most = thc_step(s)
    change = (at(s.pid_p_gain).f * error + at(s.pid_i_gain).f * error * s.dt
              + at(s.pid_d_gain).f * (error - s.last_error) / s.dt) * 0.1 * at(s.resolution).s
    s.last_error = error
    move(s, min(max(change, -most), most))

cdef void tell_thc(Plasmac* s) noexcept nogil:
    at(s.thc_enabled).b = (
        at(s.thc_enable).b and not at(s.thc_disable).b and not arc_ignored(s) and not at(s.mesh_enable).b
        and not s.losing
    )
    at(s.thc_active).b = (
        at(s.thc_enabled).b and not at(s.cornerlock_is_locked).b and not at(s.voidlock_is_locked).b
        and ((s.state == CUT_MODE_2 and at(s.torch_on).b) or (s.state == CUT_MODE_01 and s.has_target))
    )

cdef bint overriding(Plasmac* s) noexcept nogil:
    """Whether the torch is on its way to where a new height-override wants it."""
    cdef double change = at(s.height_override).f - s.override
    if change != 0.0:
        s.override = at(s.height_override).f
        s.z_target = at(s.z_offset_counts).s + counted(s, change * at(s.height_per_volt).f)
        at(s.led_up).b = at(s.led_down).b = 0
        s.moving = 1
        return True
    if not s.moving:
        return False
    if at(s.z_offset_counts).s < s.z_target:
        at(s.z_offset_counts).s = s.z_target
    else:
        z_reached(s)
    s.moving = at(s.z_offset_counts).s != s.z_target
    return True

cdef void control_height(Plasmac* s) noexcept nogil:
    cdef double error
    cdef int direction
    if s.state == CUT_MODE_01 and not s.has_target:
        watch_corner(s)
        find_target(s)
        return
    if s.state == CUT_MODE_01 and overriding(s):
        return
    watch_corner(s)
    watch_void(s)
    if arc_ignored(s) or at(s.mesh_enable).b:
        return
    if not at(s.thc_enabled).b or at(s.cornerlock_is_locked).b or at(s.voidlock_is_locked).b:
        at(s.led_up).b = at(s.led_down).b = 0
    elif s.state == CUT_MODE_2:
        if not at(s.torch_on).b:
            return
        direction = -1 if at(s.move_down).b else at(s.move_up).b
        move(s, <int32_t>(at(s.pid_p_gain).f * 0.01 * thc_step(s)) * direction)
    else:
        error = at(s.target_volts).f + s.override - at(s.arc_voltage_out).f
        correct(s, error if fabs(error) >= at(s.thc_threshold).f else 0.0)

cdef void watch_corner(Plasmac* s) noexcept nogil:
    cdef double lowest = at(s.requested_feed_rate).f * at(s.cornerlock_threshold).f * 0.01
    if arc_ignored(s) or at(s.mesh_enable).b or not at(s.arc_ok_out).b:
        return
    if s.state == CUT_MODE_01 and not s.has_target:
        at(s.cornerlock_is_locked).b = 1
    elif not at(s.cornerlock_enable).b:
        at(s.cornerlock_is_locked).b = 0
    elif at(s.current_feed_rate).f < lowest:
        at(s.cornerlock_is_locked).b = 1
    elif at_full_speed(s):
        at(s.cornerlock_is_locked).b = 0

cdef void watch_void(Plasmac* s) noexcept nogil:
    cdef double slope = fabs(at(s.arc_voltage_out).f - s.last_volts)
    s.last_volts = at(s.arc_voltage_out).f
    if not at(s.voidlock_enable).b or s.state != CUT_MODE_01:
        at(s.voidlock_is_locked).b = 0
        s.void_on = s.void_off = 0
    elif slope > at(s.voidlock_slope).s * 0.002:
        s.void_off = 0
        s.void_on += 1
        if s.void_on > at(s.voidlock_on_cycles).s:
            at(s.voidlock_is_locked).b = 1
    else:
        s.void_on = 0
        s.void_off += 1
        if s.void_off >= at(s.voidlock_off_cycles).s:
            at(s.voidlock_is_locked).b = 0
