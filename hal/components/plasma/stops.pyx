"""What ends or holds what `plasmac` does: the program's end or pause, a cut's end, sensors, a lost arc, no machine."""

from hal.cell cimport hal_at as at

from hal.components.plasma.arc cimport arc_ignored
from hal.components.plasmac cimport (
    CONSUMABLE_CHANGE_OFF, CUT_ENDED, CUT_HELD, CUT_MODE_01, CUT_MODE_2, CUT_RECOVERY_OFF, CUT_RECOVERY_ON, IDLE,
    JOB_ENDED, MAX_HEIGHT, NO_STOP, PAUSE_AT_END, PIERCE_DELAY, PIERCE_HEIGHT, PROBE_DOWN, PROBE_HEIGHT, PROBE_TEST,
    PROBE_UP, SAFE_HEIGHT, Plasmac,
)


cdef bint cutting(Plasmac* s) noexcept nogil:
    return PROBE_HEIGHT <= s.state <= CUT_MODE_2

cdef void retract(Plasmac* s, int why) noexcept nogil:
    """To the height from which the program came; the step of this period begins it."""
    at(s.torch_on).b = 0
    at(s.feed_hold).b = 1
    s.cut_well = s.cut_well and why != CUT_HELD
    s.stop = why
    s.state = MAX_HEIGHT

cdef void hold(Plasmac* s) noexcept nogil:
    """An error: the program has to be paused."""
    at(s.program_pause).b = not at(s.program_is_paused).b
    retract(s, CUT_HELD)

cdef bint job_ended(Plasmac* s) noexcept nogil:
    """Whether an idle program leaves something to end: a cut of it, or a cut by hand that is let go."""
    if s.starter == NULL or s.starter == s.probe_test or s.held or s.state > SAFE_HEIGHT:
        return False
    if s.manual and cutting(s):
        return not at(s.starter).b
    return s.in_job and (s.state != IDLE or at(s.z_offset_enable).b)

cdef bint arc_lost(Plasmac* s) noexcept nogil:
    if not PIERCE_DELAY <= s.state <= CUT_MODE_2 or not at(s.torch_enable).b or at(s.torch_off).b or s.manual:
        return False
    if at(s.thc_active).b and at(s.arc_voltage_out).f < at(s.low_cut_volts).s:
        return True
    return not at(s.arc_ok_out).b and not arc_ignored(s) and not at(s.mesh_enable).b

cdef void see_stops(Plasmac* s) noexcept nogil:
    if at(s.program_is_paused).b:
        at(s.program_pause).b = 0
    if not at(s.program_is_idle).b:
        s.in_job = 1
    elif s.state == CUT_RECOVERY_ON:
        s.state = CUT_RECOVERY_OFF
    elif at(s.consumable_changing).b:
        if s.state == IDLE:
            s.state = CONSUMABLE_CHANGE_OFF
    elif job_ended(s):
        s.in_job = s.manual = 0
        retract(s, JOB_ENDED)
        return
    if cutting(s) and at(s.program_is_paused).b:
        retract(s, CUT_HELD)
    elif arc_lost(s):
        hold(s)
    elif at(s.sensor_active).b and not at(s.program_is_idle).b and (
            s.state == IDLE or PIERCE_HEIGHT <= s.state <= CUT_MODE_2 or (cutting(s) and at(s.breakaway).b)):
        s.held = 1
        hold(s)
    if not CUT_MODE_01 <= s.state <= PAUSE_AT_END:
        at(s.cornerlock_is_locked).b = 0

cdef void tell_jogging(Plasmac* s) noexcept nogil:
    """A machine that touches something is not to be jogged."""
    at(s.jog_inhibit).b = (
        at(s.sensor_active).b and at(s.program_is_idle).b and not at(s.override_jog).b
        and s.state != PROBE_DOWN and s.state != PROBE_UP
    )

cdef void see_end_of_cut(Plasmac* s) noexcept nogil:
    if not cutting(s) or s.starter == NULL or at(s.starter).b:
        return
    at(s.feed_hold).b = 1
    if s.starter == s.probe_test:
        s.resting = 1
        s.state = PROBE_TEST
        return
    s.stop = CUT_ENDED
    if at(s.pause_at_end).f > 0.0:
        s.timer = at(s.pause_at_end).f
        s.state = PAUSE_AT_END
    else:
        at(s.torch_on).b = 0
        s.resting = 1
        s.state = SAFE_HEIGHT

cdef void switch_off(Plasmac* s) noexcept nogil:
    at(s.torch_on).b = 0
    if at(s.program_is_idle).b:
        at(s.feed_hold).b = 0
    at(s.z_offset_counts).s = 0
    at(s.x_offset_counts).s = 0
    at(s.y_offset_counts).s = 0
    s.resting = 0
    s.stop = NO_STOP
    s.state = IDLE
