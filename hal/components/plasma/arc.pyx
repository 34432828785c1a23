"""What `plasmac` senses: the arc's voltage, whether there is an arc, and whether the torch touches something."""

from libc.math cimport M_PI, exp, fabs, floor

from hal.cell cimport hal_at as at

from hal.components.plasma.moves cimport over
from hal.components.plasmac cimport Plasmac


cdef void read_voltage(Plasmac* s) noexcept nogil:
    cdef double volts = (fabs(at(s.arc_voltage_in).f) - at(s.arc_voltage_offset).f) * at(s.arc_voltage_scale).f
    cdef double frequency = at(s.lowpass_frequency).f
    if frequency > 0.0:
        s.volts += (volts - s.volts) * (1.0 - exp(-2.0 * M_PI * frequency * s.dt))
    else:
        s.volts = volts
    volts = floor(s.volts * 1000.0 + 0.5) / 1000.0
    at(s.arc_voltage_out).f = 0.0 if fabs(volts) < at(s.zero_window).f else volts

cdef bint arc_ignored(Plasmac* s) noexcept nogil:
    return at(s.ignore_arc_ok_0).b or at(s.ignore_arc_ok_1).b

cdef void sense_voltage(Plasmac* s) noexcept nogil:
    """Whether there is an arc by the voltage, whenever that was steady for so many readings; none if it is too high."""
    cdef double volts = at(s.arc_voltage_out).f
    if s.ok_readings == 0 or fabs(volts - s.ok_volts) > at(s.ok_sample_threshold).f:
        s.ok_volts = volts
        s.ok_readings = 0
    s.ok_readings = min(s.ok_readings + 1, max(at(s.ok_sample_counts).s, 1))
    if s.arc_ok and (at(s.mesh_enable).b or arc_ignored(s)):
        return
    if volts > at(s.arc_ok_high).f:
        s.arc_ok = 0
    elif s.ok_readings >= at(s.ok_sample_counts).s:
        s.arc_ok = volts >= at(s.arc_ok_low).f

cdef bint is_lost(Plasmac* s) noexcept nogil:
    """Whether an arc that was there is away for longer than arc-lost-delay."""
    if at(s.arc_lost_delay).f <= 0.0:
        return True
    if not s.losing:
        s.losing = 1
        s.lost_timer = at(s.arc_lost_delay).f
    return over(&s.lost_timer, s.dt)

cdef void read_arc(Plasmac* s) noexcept nogil:
    if at(s.torch_off).b:
        at(s.torch_on).b = 0
    if not at(s.torch_on).b:
        s.arc_ok = 0
        s.ok_readings = 0
        at(s.arc_ok_out).b = 0
    elif at(s.mode).s == 0:
        sense_voltage(s)
    else:
        s.arc_ok = at(s.arc_ok_in).b
    if s.arc_ok or not at(s.arc_ok_out).b:
        s.losing = 0
        at(s.arc_ok_out).b = s.arc_ok
    elif is_lost(s):
        at(s.arc_ok_out).b = 0

cdef void debounce_ohmic_sense(Plasmac* s) noexcept nogil:
    """A relay's answer that was the same for more periods than the delay."""
    cdef bint sensed = at(s.ohmic_sense_in).b and at(s.ohmic_enable).b
    cdef bint shown = at(s.ohmic_sense_out).b
    s.sensed_for = s.sensed_for + 1 if sensed != shown else 0
    if s.sensed_for > (at(s.ohmic_sense_off_delay).s if shown else at(s.ohmic_sense_on_delay).s):
        at(s.ohmic_sense_out).b = sensed
        s.sensed_for = 0

cdef void read_sensors(Plasmac* s) noexcept nogil:
    debounce_ohmic_sense(s)
    at(s.sensor_active).b = at(s.float_switch).b or at(s.breakaway).b or s.ohmic
    s.ohmic = at(s.ohmic_probe).b and at(s.ohmic_probe_enable).b
