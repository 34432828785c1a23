"""The plasma torch's controller, plasmac: finds the material, lights the arc, keeps the height by the arc's voltage.

It moves the axes by external offsets: Z for everything between two cuts and for the height control, X and Y to change
consumables and to recover a cut. Each period reads the inputs (``plasma/arc.pyx``), sees what ends or holds a cut
(``plasma/stops.pyx``), counts times (``plasma/tally.pyx``) and does one step of the state that `state-out` shows
(``plasma/states.pyx``, ``plasma/recovery.pyx``; in a cut ``plasma/thc.pyx``). See ``declare.py``.
"""

from hal._messages cimport say
from hal.cell cimport hal_at as at

from hal.components.plasma.arc cimport read_arc, read_sensors, read_voltage
from hal.components.plasma.states cimport step
from hal.components.plasma.stops cimport see_end_of_cut, see_stops, switch_off, tell_jogging
from hal.components.plasma.tally cimport count_times, tell_feeds
from hal.components.plasma.thc cimport hear_voltage, tell_thc

from hal.components.declare import BIT, FLOAT, S32, declare, pin_in, pin_out

cdef const char** state_names = [
    b"IDLE", b"PROBE_HEIGHT", b"PROBE_DOWN", b"PROBE_UP", b"ZERO_HEIGHT", b"PIERCE_HEIGHT", b"TORCH_ON", b"ARC_OK",
    b"PIERCE_DELAY", b"PUDDLE_JUMP", b"CUT_HEIGHT", b"CUT_MODE_01", b"CUT_MODE_2", b"PAUSE_AT_END", b"SAFE_HEIGHT",
    b"MAX_HEIGHT", b"END_CUT", b"END_JOB", b"TORCHPULSE", b"PAUSED_MOTION", b"OHMIC_TEST", b"PROBE_TEST", b"SCRIBING",
    b"CONSUMABLE_CHANGE_ON", b"CONSUMABLE_CHANGE_OFF", b"CUT_RECOVERY_ON", b"CUT_RECOVERY_OFF",
]


cdef void set_scales(Plasmac* s, long period) noexcept nogil:
    """A count of the offsets is the way of a period at 1 mm/s, divided by `resolution`."""
    cdef double units = at(s.units_per_mm).f
    cdef int32_t resolution = at(s.resolution).s
    s.dt = period * 1e-9
    s.scale = units * s.dt / resolution if resolution != 0 else 0.0
    s.rate = <float>(resolution / (60.0 * units)) if units != 0.0 else 0.0
    at(s.offset_scale).f = s.scale

cdef void tell_state(Plasmac* s) noexcept nogil:
    if at(s.debug_print).b and (s.state != at(s.state_out).s or not s.told):
        say(state_names[s.state])
    s.told = 1
    at(s.state_out).s = s.state
    at(s.stop_type_out).s = s.stop

cdef void plasmac(Plasmac* s, long period) noexcept nogil:
    set_scales(s, period)
    read_voltage(s)
    read_sensors(s)
    tell_feeds(s)
    tell_thc(s)
    see_stops(s)
    hear_voltage(s)
    see_end_of_cut(s)
    tell_jogging(s)
    read_arc(s)
    count_times(s)
    if at(s.machine_is_on).b:
        step(s)
    else:
        switch_off(s)
    tell_state(s)


declare("plasmac", "A plasma torch's controller: probing, piercing, height control, recovery", sizeof(Plasmac), [
    pin_in(FLOAT, "arc-fail-delay", "how long the arc may take to start, s"),
    pin_in(FLOAT, "arc-lost-delay", "how long the arc may be lost in a cut, s"),
    pin_in(S32, "arc-max-starts", "how often the arc is tried"),
    pin_in(FLOAT, "arc-ok-high", "highest voltage of an arc [mode 0]"),
    pin_in(BIT, "arc-ok-in", "the power source sees an arc [modes 1 and 2]"),
    pin_in(FLOAT, "arc-ok-low", "lowest voltage of an arc [mode 0]"),
    pin_in(FLOAT, "arc-voltage-in", "what measures the arc's voltage [modes 0 and 1]"),
    pin_in(FLOAT, "arc-voltage-offset", "its reading at 0 V"),
    pin_in(FLOAT, "arc-voltage-scale", "V for 1 of it"),
    pin_in(FLOAT, "axis-x-max-limit"), pin_in(FLOAT, "axis-x-min-limit"), pin_in(FLOAT, "axis-x-position"),
    pin_in(FLOAT, "axis-y-max-limit"), pin_in(FLOAT, "axis-y-min-limit"), pin_in(FLOAT, "axis-y-position"),
    pin_in(FLOAT, "axis-z-max-limit"), pin_in(FLOAT, "axis-z-min-limit"),
    pin_in(FLOAT, "axis-z-position", "from joint.N.pos-fb"),
    pin_in(BIT, "breakaway", "the torch has left its holder"),
    pin_in(BIT, "consumable-change", "go to where consumables are changed"),
    pin_in(BIT, "cornerlock-enable", "lock the height at corners"),
    pin_in(FLOAT, "cornerlock-threshold", "% of the requested feed rate below which it is locked"),
    pin_in(FLOAT, "current-velocity", "from motion.current-vel"),
    pin_in(FLOAT, "cut-feed-rate", "units per minute; 0: feed-upm"),
    pin_in(FLOAT, "cut-height"),
    pin_in(BIT, "cut-recovery", "go on after an error beside the cut"),
    pin_in(FLOAT, "cut-volts", "the arc's voltage at cut height"),
    pin_in(BIT, "cutting-start", "from spindle.0.on"),
    pin_in(BIT, "debug-print", "say each change of state"),
    pin_in(BIT, "external-estop"),
    pin_in(FLOAT, "feed-override", "from halui.feed-override.value"),
    pin_in(FLOAT, "feed-reduction", "% of the feed rate, from motion.analog-out-03"),
    pin_in(FLOAT, "feed-upm", "from motion.feed-upm"),
    pin_in(BIT, "float-switch", "the torch touches the material; when not probing it has left its holder"),
    pin_in(FLOAT, "float-switch-travel", "until the switch turns on"),
    pin_in(FLOAT, "gcode-scale", "the program's unit in machine units", 1.0),
    pin_in(FLOAT, "height-override", "added to the target, V"),
    pin_in(FLOAT, "height-per-volt"),
    pin_in(BIT, "homed", "from motion.is-all-homed"),
    pin_in(BIT, "ignore-arc-ok-0", "cut without an arc"), pin_in(BIT, "ignore-arc-ok-1", "cut without an arc"),
    pin_in(FLOAT, "kerf-width", "for programs to read"),
    pin_in(S32, "laser-recovery-start", "put the laser where the torch is"),
    pin_in(S32, "laser-x-offset", "counts"), pin_in(S32, "laser-y-offset", "counts"),
    pin_in(S32, "low-cut-volts", "below it the arc is lost while the height is controlled, V"),
    pin_in(FLOAT, "lowpass-frequency", "of the arc's voltage, Hz; 0: none"),
    pin_in(BIT, "machine-is-on"),
    pin_in(S32, "max-offset", "distance kept from the Z axis' upper limit, mm", 5),
    pin_in(BIT, "mesh-arc-ok", "mesh mode needs no arc"),
    pin_in(BIT, "mesh-enable", "for expanded metal: a lost arc does not end the cut"),
    pin_in(S32, "mode", "0: arc and height by the voltage; 1: arc-ok-in; 2: and move-up, move-down"),
    pin_in(S32, "motion-type", "from motion.motion-type"),
    pin_in(BIT, "move-down", "[mode 2]"), pin_in(BIT, "move-up", "[mode 2]"),
    pin_in(BIT, "multi-tool", "there are a scribe and a spotting tool", True),
    pin_in(FLOAT, "offset-probe-delay", "until a probe is deployed, s"),
    pin_in(FLOAT, "offset-probe-x", "where the probe is"), pin_in(FLOAT, "offset-probe-y", "where the probe is"),
    pin_in(BIT, "offset-set-probe", "deploy the probe"), pin_in(BIT, "offset-set-scribe", "deploy the scribe"),
    pin_in(BIT, "offsets-active", "from motion.eoffset-active"),
    pin_in(S32, "ohmic-max-attempts", "of ohmic probing, then the float switch counts"),
    pin_in(BIT, "ohmic-probe", "the torch touches the material, by its resistance"),
    pin_in(BIT, "ohmic-probe-enable"),
    pin_in(FLOAT, "ohmic-probe-offset", "of the surface from where it was sensed"),
    pin_in(BIT, "ohmic-sense-in", "a relay that senses the material"),
    pin_in(S32, "ohmic-sense-off-delay", "periods", 3), pin_in(S32, "ohmic-sense-on-delay", "periods", 3),
    pin_in(BIT, "ohmic-test", "is the torch shorted?"),
    pin_in(S32, "ok-sample-counts", "readings that make an arc [mode 0]", 10),
    pin_in(FLOAT, "ok-sample-threshold", "by which they may differ, V [mode 0]", 10.0),
    pin_in(BIT, "override-jog", "jog though a sensor is on"),
    pin_in(FLOAT, "pause-at-end", "with the torch on, s"),
    pin_in(FLOAT, "paused-motion-speed", "of the adaptive feed while paused, from -1 to 1"),
    pin_in(FLOAT, "pid-d-gain"), pin_in(FLOAT, "pid-i-gain"), pin_in(FLOAT, "pid-p-gain"),
    pin_in(FLOAT, "pierce-delay", "s"), pin_in(FLOAT, "pierce-height"),
    pin_in(FLOAT, "probe-feed-rate", "units per minute"),
    pin_in(S32, "probe-final-speed", "thousandths of a mm in a period", 1),
    pin_in(FLOAT, "probe-start-height", "above the Z axis' lower limit"),
    pin_in(BIT, "probe-test", "probe and wait at pierce height"),
    pin_in(BIT, "program-is-idle"), pin_in(BIT, "program-is-paused"), pin_in(BIT, "program-is-running"),
    pin_in(FLOAT, "puddle-jump-delay", "s"), pin_in(FLOAT, "puddle-jump-height", "% of pierce height; 0: none"),
    pin_in(FLOAT, "requested-velocity", "not used"),
    pin_in(S32, "resolution", "of the offsets' counts", 100),
    pin_in(FLOAT, "restart-delay", "between two tries of the arc, s"),
    pin_in(FLOAT, "safe-height", "between two cuts; 0: the highest"),
    pin_in(FLOAT, "scribe-arm-delay", "s"), pin_in(FLOAT, "scribe-on-delay", "s"),
    pin_in(BIT, "scribe-start", "from spindle.1.on"),
    pin_in(FLOAT, "setup-feed-rate", "units per minute, of moves to the heights"),
    pin_in(FLOAT, "skip-ihs-distance", "from the last cut, within which the material is not probed again"),
    pin_in(BIT, "spotting-start", "from spindle.2.on"),
    pin_in(FLOAT, "spotting-threshold", "V at which its time begins; 0: with the torch"),
    pin_in(FLOAT, "spotting-time", "ms"),
    pin_in(S32, "target-samples", "readings that make the target", 6),
    pin_in(BIT, "thc-auto", "control the height when the voltage is steady"),
    pin_in(FLOAT, "thc-delay", "from full feed rate to height control, s"),
    pin_in(BIT, "thc-disable"), pin_in(BIT, "thc-enable"),
    pin_in(FLOAT, "thc-feed-rate", "units per minute"),
    pin_in(S32, "thc-sample-counts", "readings that make a steady voltage", 50),
    pin_in(FLOAT, "thc-sample-threshold", "by which they may differ, V", 1.0),
    pin_in(FLOAT, "thc-threshold", "differences that are not followed, V"),
    pin_in(BIT, "torch-enable", "false: a dry run"),
    pin_in(BIT, "torch-off", "go on without the torch"),
    pin_in(BIT, "torch-pulse-start"), pin_in(FLOAT, "torch-pulse-time", "s"),
    pin_in(FLOAT, "units-per-mm", "from halui.machine.units-per-mm"),
    pin_in(BIT, "use-auto-volts", "the voltage found at cut height is the target"),
    pin_in(BIT, "voidlock-enable", "lock the height above a void [modes 0 and 1]"),
    pin_in(S32, "voidlock-off-cycles", "", 10), pin_in(S32, "voidlock-on-cycles", "", 2),
    pin_in(S32, "voidlock-slope", "V/s", 500),
    pin_in(S32, "x-offset", "for consumables and recovery, counts"),
    pin_in(FLOAT, "x-offset-current", "from axis.x.eoffset"),
    pin_in(FLOAT, "xy-feed-rate", "units per minute, for consumables"),
    pin_in(S32, "y-offset", "for consumables and recovery, counts"),
    pin_in(FLOAT, "y-offset-current", "from axis.y.eoffset"), pin_in(FLOAT, "z-offset-current", "from axis.z.eoffset"),
    pin_in(FLOAT, "zero-window", "V that are shown as 0", 0.1),
    pin_out(FLOAT, "adaptive-feed", "to motion.adaptive-feed"),
    pin_out(BIT, "arc-ok-out"), pin_out(FLOAT, "arc-voltage-out", "V"),
    pin_out(BIT, "consumable-changing"), pin_out(BIT, "cornerlock-is-locked"),
    pin_out(FLOAT, "current-feed-rate", "units per minute"),
    pin_out(FLOAT, "cut-length"), pin_out(BIT, "cut-recovering"), pin_out(FLOAT, "cut-time", "s"),
    pin_out(BIT, "cutting-stop", "to halui.spindle.0.stop"),
    pin_out(BIT, "feed-hold", "to motion.feed-hold"), pin_out(BIT, "jog-inhibit", "to motion.jog-inhibit"),
    pin_out(S32, "laser-recovery-state"),
    pin_out(BIT, "led-down"), pin_out(BIT, "led-up"),
    pin_out(FLOAT, "offset-scale", "to axis.L.eoffset-scale"),
    pin_out(BIT, "ohmic-enable", "while probing"), pin_out(BIT, "ohmic-sense-out"),
    pin_out(BIT, "paused-motion"), pin_out(FLOAT, "paused-time", "s"),
    pin_out(S32, "pierce-count"), pin_out(BIT, "probe-test-error", "no material was found"),
    pin_out(FLOAT, "probe-time", "s"),
    pin_out(BIT, "program-pause", "to halui.program.pause"), pin_out(BIT, "program-resume", "to halui.program.resume"),
    pin_out(BIT, "program-run", "to halui.program.run"), pin_out(BIT, "program-stop", "to halui.program.stop"),
    pin_out(FLOAT, "rapid-time", "s"), pin_out(FLOAT, "requested-feed-rate", "units per minute"),
    pin_out(FLOAT, "run-time", "s"),
    pin_out(BIT, "safe-height-is-limited"),
    pin_out(BIT, "scribe-arm"), pin_out(BIT, "scribe-on"), pin_out(BIT, "sensor-active"),
    pin_out(S32, "state-out", "0 idle to 26; see hal.md"), pin_out(S32, "stop-type-out"),
    pin_out(FLOAT, "target-volts", "V"),
    pin_out(BIT, "thc-active"), pin_out(BIT, "thc-enabled"),
    pin_out(BIT, "torch-on"), pin_out(FLOAT, "torch-time", "s"), pin_out(BIT, "voidlock-is-locked"),
    pin_out(S32, "x-offset-counts"), pin_out(BIT, "xy-offset-enable"), pin_out(S32, "y-offset-counts"),
    pin_out(FLOAT, "z-height", "of the torch above the material"),
    pin_out(S32, "z-offset-counts"), pin_out(BIT, "z-offset-enable"), pin_out(FLOAT, "z-relative"),
], {"": <size_t>&plasmac}, takes_names=False, most=1, instance="plasmac")
