"""The states of `plasmac`: what it does in each of them for one period, and which comes next."""

from libc.math cimport sqrt
from libc.stdint cimport int32_t

from hal.cell cimport hal_at as at, hal_pin

from hal.components.plasma.arc cimport arc_ignored
from hal.components.plasma.moves cimport aim_xy, counted, counts_for, over, setup_step, xy_reached, z_reached
from hal.components.plasma.recovery cimport (
    busy_while_paused, end_recovery, go_to_change, laser_in_the_way, paused_motion, recover, return_from_change,
)
from hal.components.plasma.stops cimport hold
from hal.components.plasma.thc cimport begin_cut, control_height
from hal.components.plasmac cimport (
    ARC_OK, CONSUMABLE_CHANGE_OFF, CONSUMABLE_CHANGE_ON, CUT_ENDED, CUT_HEIGHT, CUT_HELD, CUT_MODE_01, CUT_MODE_2,
    CUT_RECOVERY_OFF, CUT_RECOVERY_ON, END_CUT, END_JOB, IDLE, MAX_HEIGHT, NO_STOP, OHMIC_TEST, PAUSED_MOTION,
    PAUSE_AT_END, PIERCE_DELAY, PIERCE_HEIGHT, PROBE_DOWN, PROBE_HEIGHT, PROBE_TEST, PROBE_UP, PUDDLE_JUMP,
    SAFE_HEIGHT, SCRIBING, STATES, TORCH_ON, TORCH_PULSE, ZERO_HEIGHT, Plasmac,
)

ctypedef void (*Action)(Plasmac* s) noexcept nogil

cdef Action actions[STATES]


cdef int32_t above(Plasmac* s, double height) noexcept nogil:
    """The offset at a height above the material, which may be other than where it was probed."""
    return <int32_t>(s.zero_counts + s.cut_change + height / s.scale) if s.scale != 0.0 else 0


# ---- waiting for work ----

cdef hal_pin asked(Plasmac* s) noexcept nogil:
    """Who asks for a cut, if anybody does and may."""
    if not at(s.homed).b:
        return NULL
    if at(s.cutting_start).b:
        return s.cutting_start
    if at(s.spotting_start).b and at(s.multi_tool).b:
        return s.spotting_start
    return s.probe_test if at(s.probe_test).b else NULL

cdef bint surface_known(Plasmac* s) noexcept nogil:
    """Whether the material was probed, or cut, so near that it need not be probed again."""
    cdef double dx = at(s.axis_x_position).f - s.known_x, dy = at(s.axis_y_position).f - s.known_y
    return s.zero_known and s.cut_well and sqrt(dx * dx + dy * dy) < at(s.skip_ihs_distance).f

cdef void start(Plasmac* s, hal_pin starter) noexcept nogil:
    cdef bint probing = starter == s.probe_test
    s.starter = starter
    s.stop = NO_STOP
    s.manual = not s.in_job
    at(s.feed_hold).b = 1
    s.ohmic_tries = 0
    s.retrying = 0
    s.starts = 0
    s.too_low = 0
    if surface_known(s) and not probing:
        s.z_target = above(s, at(s.pierce_height).f)
        s.state = PIERCE_HEIGHT
        return
    s.climbed = s.cut_change = 0
    s.z_target = counts_for(s, at(s.axis_z_min_limit).f + at(s.probe_start_height).f)
    s.probe_beside = at(s.ohmic_probe_enable).b and (at(s.offset_probe_x).f != 0.0 or at(s.offset_probe_y).f != 0.0)
    aim_xy(s, counted(s, at(s.offset_probe_x).f), counted(s, at(s.offset_probe_y).f), setup_step(s))
    s.deploying = at(s.offset_probe_delay).f
    s.state = PROBE_HEIGHT

cdef void idle(Plasmac* s) noexcept nogil:
    cdef hal_pin starter = asked(s)
    if s.held:
        s.held = at(s.sensor_active).b
        return
    if busy_while_paused(s):
        if not at(s.program_is_paused).b and at(s.program_is_running).b:
            s.stop = NO_STOP
    elif at(s.torch_pulse_start).b:
        at(s.feed_hold).b = 1
        s.state = TORCH_PULSE
    elif s.stop == CUT_HELD:
        if not at(s.program_is_paused).b:
            s.stop = NO_STOP
            at(s.feed_hold).b = at(s.feed_hold).b or starter != NULL
    elif laser_in_the_way(s):
        return
    elif at(s.program_is_paused).b or (at(s.program_pause).b and not at(s.program_is_idle).b):
        return
    elif starter != NULL and s.ohmic:
        at(s.program_pause).b = 1
        at(s.feed_hold).b = 1
        s.stop = CUT_HELD
    elif starter != NULL:
        start(s, starter)
    elif at(s.ohmic_test).b and at(s.ohmic_probe_enable).b and at(s.program_is_idle).b:
        at(s.feed_hold).b = 1
        at(s.ohmic_enable).b = 1
        s.state = OHMIC_TEST
    elif at(s.scribe_start).b and at(s.multi_tool).b:
        s.timer = at(s.scribe_arm_delay).f
        s.state = SCRIBING
    elif s.stop == NO_STOP:
        at(s.feed_hold).b = 0
        if at(s.program_is_idle).b:
            at(s.ohmic_enable).b = at(s.offset_set_probe).b
            at(s.scribe_arm).b = at(s.offset_set_scribe).b


# ---- probing ----

cdef bint touching(Plasmac* s) noexcept nogil:
    return at(s.float_switch).b or s.ohmic

cdef bint deployed(Plasmac* s) noexcept nogil:
    """Whether the probe is where the torch was; at once where the torch is the probe."""
    if not s.probe_beside:
        return True
    at(s.xy_offset_enable).b = 1
    return over(&s.deploying, s.dt) & xy_reached(s)

cdef bint withdrawn(Plasmac* s) noexcept nogil:
    """Whether the torch is back and the probe out of its way."""
    cdef bint there
    if not s.probe_beside:
        return True
    there = xy_reached(s)
    over(&s.deploying, s.dt)
    s.probe_beside = not there or s.deploying > 0.0
    return not s.probe_beside

cdef void probe_height(Plasmac* s) noexcept nogil:
    at(s.probe_time).f += s.dt
    at(s.z_offset_enable).b = 1
    at(s.ohmic_enable).b = at(s.ohmic_probe_enable).b
    deployed(s)
    if s.retrying:
        z_reached(s)
        s.retrying = touching(s)
    elif touching(s):
        s.early = 1
        s.state = PROBE_UP
    elif z_reached(s):
        s.early = 0
        s.state = PROBE_DOWN

cdef bint lowest(Plasmac* s, int32_t down) noexcept nogil:
    """Whether the next step would be too near to the lower limit."""
    cdef double margin = 0.25 * at(s.units_per_mm).f
    return at(s.axis_z_position).f - down * s.scale < at(s.axis_z_min_limit).f + margin

cdef void probe_down(Plasmac* s) noexcept nogil:
    cdef int32_t down = <int32_t>(at(s.probe_feed_rate).f * s.rate)
    if not deployed(s):
        return
    at(s.probe_time).f += s.dt
    if s.ohmic:
        s.by_ohmic = 1
        s.state = PROBE_UP
    elif at(s.float_switch).b:
        s.by_ohmic = 0
        if at(s.ohmic_probe_enable).b and s.ohmic_tries < at(s.ohmic_max_attempts).s:
            s.ohmic_tries += 1
            s.retrying = 1
            s.state = PROBE_HEIGHT
        else:
            s.state = PROBE_UP
    elif not lowest(s, down):
        at(s.z_offset_counts).s -= down
    elif not s.too_low:
        s.too_low = 1
    elif s.starter == s.probe_test:
        at(s.probe_test_error).b = 1
        s.state = PROBE_TEST
    else:
        hold(s)

cdef void probe_up(Plasmac* s) noexcept nogil:
    cdef int32_t thousandth = at(s.resolution).s  # of a mm
    cdef double travel
    if not touching(s) and s.early:
        s.early = 0
        s.state = PROBE_DOWN
        return
    at(s.probe_time).f += s.dt
    if touching(s):
        at(s.z_offset_counts).s += thousandth * (10 if s.early else at(s.probe_final_speed).s)
        return
    travel = at(s.ohmic_probe_offset).f if s.by_ohmic else at(s.float_switch_travel).f
    s.z_target = s.zero_counts = at(s.z_offset_counts).s + counted(s, travel)
    s.zero = at(s.axis_z_position).f + (s.z_target - at(s.z_offset_counts).s) * s.scale
    s.zero_known = 1
    s.cut_well = 1
    s.known_x = at(s.axis_x_position).f
    s.known_y = at(s.axis_y_position).f
    at(s.ohmic_enable).b = 0
    s.state = ZERO_HEIGHT

cdef void zero_height(Plasmac* s) noexcept nogil:
    if z_reached(s):
        aim_xy(s, 0, 0, setup_step(s))
        s.deploying = at(s.offset_probe_delay).f
        s.z_target = above(s, at(s.pierce_height).f)
        s.state = PIERCE_HEIGHT


# ---- piercing and cutting ----

cdef void pierce_height(Plasmac* s) noexcept nogil:
    if not withdrawn(s):
        return
    if z_reached(s):
        if s.starter == s.probe_test:
            s.state = PROBE_TEST
        elif at(s.torch_enable).b:
            s.state = TORCH_ON
        else:
            s.timer = at(s.pierce_delay).f
            s.state = PIERCE_DELAY

cdef void light(Plasmac* s) noexcept nogil:
    over(&s.restart, s.dt)
    if s.starts >= at(s.arc_max_starts).s:
        at(s.program_pause).b = 1
        return
    if s.restart > 0.0:
        return
    s.starts += 1
    at(s.pierce_count).s += 1
    at(s.torch_on).b = 1
    s.spotted = 0
    s.timer = at(s.arc_fail_delay).f
    s.state = ARC_OK

cdef void spot(Plasmac* s) noexcept nogil:
    """A short arc that marks a place."""
    if at(s.arc_voltage_out).f >= at(s.spotting_threshold).f and not s.spotted:
        s.spotted = 1
        s.timer = at(s.spotting_time).f * 1e-3
    elif s.spotted:
        over(&s.timer, s.dt)
        if s.timer <= 0.0:
            at(s.torch_on).b = 0
            s.stop = CUT_ENDED
            s.state = SAFE_HEIGHT

cdef void await_arc(Plasmac* s) noexcept nogil:
    if s.starter == s.spotting_start:
        spot(s)
        if s.spotted:
            return
    over(&s.timer, s.dt)
    if s.starter != s.spotting_start and (at(s.arc_ok_out).b or arc_ignored(s)):
        s.timer = at(s.pierce_delay).f
        s.state = PIERCE_DELAY
    elif s.timer <= 0.0:
        at(s.torch_on).b = 0
        s.restart = at(s.restart_delay).f
        s.state = TORCH_ON

cdef void pierce(Plasmac* s) noexcept nogil:
    cdef bint jump = at(s.puddle_jump_height).f > 0.0 or at(s.puddle_jump_delay).f > 0.0
    if not over(&s.timer, s.dt):
        return
    if jump and not at(s.cut_recovering).b:
        if at(s.puddle_jump_height).f > 0.0:
            s.z_target = above(s, at(s.pierce_height).f * at(s.puddle_jump_height).f * 0.01)
        s.timer = at(s.puddle_jump_delay).f
        s.state = PUDDLE_JUMP
    else:
        s.z_target = above(s, at(s.cut_height).f)
        s.state = CUT_HEIGHT

cdef void puddle_jump(Plasmac* s) noexcept nogil:
    at(s.feed_hold).b = 0
    if z_reached(s) and over(&s.timer, s.dt):
        s.z_target = above(s, at(s.cut_height).f)
        s.state = CUT_HEIGHT

cdef void cut_height(Plasmac* s) noexcept nogil:
    if z_reached(s):
        if at(s.cut_recovering).b:
            s.state = CUT_RECOVERY_OFF
            return
        at(s.feed_hold).b = 0
        begin_cut(s)
        s.state = CUT_MODE_2 if at(s.mode).s == 2 else CUT_MODE_01

cdef void tell_request(Plasmac* s) noexcept nogil:
    """The program's feed rate; a reduction that is not from 10 % to 100 % is none."""
    cdef double share = at(s.feed_reduction).f * 0.01
    at(s.adaptive_feed).f = share if 0.1 <= share <= 1.0 else 1.0
    if at(s.gcode_scale).f != 0.0:
        at(s.requested_feed_rate).f = at(s.feed_upm).f / at(s.gcode_scale).f / at(s.adaptive_feed).f

cdef void cut(Plasmac* s) noexcept nogil:
    at(s.cut_time).f += s.dt
    at(s.cut_length).f += at(s.current_velocity).f * s.dt
    tell_request(s)
    control_height(s)
    if at(s.thc_active).b:
        s.cut_change = s.cut_change + at(s.z_offset_counts).s - above(s, at(s.cut_height).f)
        s.climbed = max(s.climbed, s.cut_change)
        s.known_x = at(s.axis_x_position).f
        s.known_y = at(s.axis_y_position).f

cdef void pause_at_end(Plasmac* s) noexcept nogil:
    over(&s.timer, s.dt)
    if s.timer <= 0.0:
        at(s.torch_on).b = 0
        s.state = SAFE_HEIGHT


# ---- going away ----

cdef int32_t safe_counts(Plasmac* s) noexcept nogil:
    cdef double highest = at(s.axis_z_max_limit).f - at(s.max_offset).s * at(s.units_per_mm).f
    cdef int32_t top = at(s.z_offset_counts).s + counted(s, highest - at(s.axis_z_position).f)
    if not s.zero_known:
        return 0
    if at(s.safe_height).f <= 0.0:
        return top
    return min(top, above(s, at(s.safe_height).f) - s.cut_change + s.climbed)

cdef bint away(Plasmac* s) noexcept nogil:
    """Whether the Z axis, and then the others, are where they ought to be between two cuts."""
    if not z_reached(s):
        return False
    if s.probe_beside:
        if s.x_target != 0 or s.y_target != 0:
            aim_xy(s, 0, 0, setup_step(s))
        s.probe_beside = not xy_reached(s)
    return not s.probe_beside

cdef void safe_height(Plasmac* s) noexcept nogil:
    if s.entered:
        s.z_target = safe_counts(s)
    if away(s):
        at(s.feed_hold).b = 0
        s.state = END_CUT

cdef void max_height(Plasmac* s) noexcept nogil:
    at(s.z_offset_enable).b = 1
    if asked(s) != NULL:
        at(s.feed_hold).b = 1
    s.z_target = 0
    if not away(s):
        return
    if not at(s.program_is_paused).b:
        s.state = END_CUT
    elif at(s.consumable_change).b:
        s.state = CONSUMABLE_CHANGE_ON
    elif at(s.cut_recovery).b:
        s.state = CUT_RECOVERY_ON
    else:
        s.state = END_CUT

cdef void end_cut(Plasmac* s) noexcept nogil:
    at(s.target_volts).f = 0.0
    at(s.led_up).b = at(s.led_down).b = at(s.probe_test_error).b = 0
    at(s.ohmic_enable).b = at(s.voidlock_is_locked).b = 0
    s.state = END_JOB if at(s.program_is_idle).b else IDLE

cdef void end_job(Plasmac* s) noexcept nogil:
    if not at(s.offsets_active).b:
        s.stop = NO_STOP
        s.state = IDLE


# ---- by hand ----

cdef void torch_pulse(Plasmac* s) noexcept nogil:
    if not at(s.torch_on).b:
        at(s.torch_on).b = 1
        s.timer = at(s.torch_pulse_time).f
    elif over(&s.timer, s.dt):
        at(s.torch_on).b = 0
        if not at(s.torch_pulse_start).b:
            s.state = IDLE

cdef void probe_test(Plasmac* s) noexcept nogil:
    if at(s.probe_test).b:
        return
    s.z_target = 0
    z_reached(s)
    if at(s.z_offset_counts).s == 0:
        s.state = END_CUT

cdef void scribe(Plasmac* s) noexcept nogil:
    """Down, on, and then the program goes on; the same again after a pause."""
    if not at(s.scribe_start).b or at(s.program_is_paused).b:
        at(s.scribe_arm).b = at(s.scribe_on).b = 0
        s.timer = at(s.scribe_arm_delay).f
        if not at(s.scribe_start).b:
            s.state = IDLE
        return
    if not at(s.scribe_on).b:
        at(s.feed_hold).b = 1
    at(s.scribe_arm).b = 1
    if not over(&s.timer, s.dt):
        return
    if not at(s.scribe_on).b:
        at(s.scribe_on).b = 1
        s.timer = at(s.scribe_on_delay).f
    else:
        at(s.feed_hold).b = 0

cdef void ohmic_test(Plasmac* s) noexcept nogil:
    if not at(s.ohmic_test).b:
        at(s.ohmic_enable).b = 0
        s.state = IDLE


actions[IDLE] = idle
actions[PROBE_HEIGHT] = probe_height
actions[PROBE_DOWN] = probe_down
actions[PROBE_UP] = probe_up
actions[ZERO_HEIGHT] = zero_height
actions[PIERCE_HEIGHT] = pierce_height
actions[TORCH_ON] = light
actions[ARC_OK] = await_arc
actions[PIERCE_DELAY] = pierce
actions[PUDDLE_JUMP] = puddle_jump
actions[CUT_HEIGHT] = cut_height
actions[CUT_MODE_01] = cut
actions[CUT_MODE_2] = cut
actions[PAUSE_AT_END] = pause_at_end
actions[SAFE_HEIGHT] = safe_height
actions[MAX_HEIGHT] = max_height
actions[END_CUT] = end_cut
actions[END_JOB] = end_job
actions[TORCH_PULSE] = torch_pulse
actions[PAUSED_MOTION] = paused_motion
actions[OHMIC_TEST] = ohmic_test
actions[PROBE_TEST] = probe_test
actions[SCRIBING] = scribe
actions[CONSUMABLE_CHANGE_ON] = go_to_change
actions[CONSUMABLE_CHANGE_OFF] = return_from_change
actions[CUT_RECOVERY_ON] = recover
actions[CUT_RECOVERY_OFF] = end_recovery

cdef void step(Plasmac* s) noexcept nogil:
    if s.resting:
        s.resting = 0
        return
    s.entered = s.state != s.stepped
    s.stepped = s.state
    actions[s.state](s)
