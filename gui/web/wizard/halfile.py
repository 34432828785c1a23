"""The HAL file of a machine that was described to the wizard.

Simulated, every motor is in the file: one that is where it is told to be, step pulses that are counted, or a servo
loop around an ideal drive. For a card the signals are made and left open, named after the axis: x-step, x-dir,
x-enable, x-enc-a, x-home.
"""

from __future__ import annotations

from collections.abc import Iterator

from gui.web.wizard.answers import Axis, Machine

STEP_RESERVE = 1.25  # by which a step generator may be faster than the axis
PULSE_NS = 5000
SERVO_P = 50.0  # 1/s, position error to speed
SWITCH_LENGTH_MM = 2.0


def text(machine: Machine) -> str:
    """The whole file."""
    return "\n".join([*_head(machine), *_functions(machine), *_axes(machine), *_rest(machine)]) + "\n"


def _names(machine: Machine, kind: str) -> str:
    return ",".join(f"{kind}-{axis.letter.lower()}" for axis in machine.axes)


def _head(machine: Machine) -> Iterator[str]:
    base = " base_period_nsec=[EMCMOT]BASE_PERIOD" if machine.drive == "steps" else ""
    yield f"# {machine.name}: {machine.kind}, axes {' '.join(machine.letters)}, made by the configuration wizard"
    yield ""
    yield "loadrt [KINS]KINEMATICS"
    yield f"loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD{base} num_joints=[KINS]JOINTS"
    if machine.drive == "steps":
        yield f"loadrt stepgen step_type={','.join('0' for _ in machine.axes)}"
    if machine.drive == "encoders":
        yield f"loadrt pid names={_names(machine, 'pid')}"
        if machine.simulated:
            yield f"loadrt integ names={_names(machine, 'motor')}"
        else:
            yield f"loadrt encoder names={_names(machine, 'encoder')}"
            yield f"loadrt pwmgen output_type={','.join('0' for _ in machine.axes)}"
    if machine.switches and machine.simulated:
        yield f"loadrt sim_home_switch names={_names(machine, 'switch')}"
    yield ""


def _functions(machine: Machine) -> Iterator[str]:
    """The order of the servo thread: inputs, motion, outputs."""
    if machine.drive == "steps":
        yield "addf stepgen.make-pulses base-thread"
        yield "addf stepgen.capture-position servo-thread"
    if machine.drive == "encoders" and not machine.simulated:
        yield "addf encoder.update-counters servo-thread"
        yield "addf encoder.capture-position servo-thread"
    yield "addf motion-command-handler servo-thread"
    yield "addf motion-controller servo-thread"
    if machine.drive == "steps":
        yield "addf stepgen.update-freq servo-thread"
    if machine.drive == "encoders":
        for axis in machine.axes:
            letter = axis.letter.lower()
            yield f"addf pid-{letter}.do-pid-calcs servo-thread"
            if machine.simulated:
                yield f"addf motor-{letter} servo-thread"
        if not machine.simulated:
            yield "addf pwmgen.update servo-thread"
            yield "addf pwmgen.make-pulses servo-thread"
    if machine.switches and machine.simulated:
        yield from (f"addf switch-{axis.letter.lower()} servo-thread" for axis in machine.axes)
    yield ""


def _axes(machine: Machine) -> Iterator[str]:
    drives = {"none": _direct, "steps": _steps, "encoders": _servo}
    for axis in machine.axes:
        letter = axis.letter.lower()
        yield f"# {axis.letter}: joint {axis.joint}"
        yield from drives[machine.drive](machine, axis)
        if machine.switches:
            if machine.simulated:
                length = SWITCH_LENGTH_MM / (1.0 if axis.rotary else machine.mm)
                yield f"setp switch-{letter}.home-pos {axis.switch:.6f}"
                yield f"setp switch-{letter}.hysteresis {length / 10:.6f}"
                yield f"net {letter}-pos-fb => switch-{letter}.cur-pos"
                yield f"net {letter}-home switch-{letter}.home-sw => joint.{axis.joint}.home-sw-in"
            else:
                yield f"net {letter}-home => joint.{axis.joint}.home-sw-in"
        yield ""


def _direct(machine: Machine, axis: Axis) -> Iterator[str]:
    letter, joint = axis.letter.lower(), f"joint.{axis.joint}"
    yield f"net {letter}-pos-fb {joint}.motor-pos-cmd => {joint}.motor-pos-fb"


def _steps(machine: Machine, axis: Axis) -> Iterator[str]:
    letter, joint, generator = axis.letter.lower(), f"joint.{axis.joint}", f"stepgen.{axis.joint}"
    yield f"setp {generator}.position-scale [JOINT_{axis.joint}]SCALE"
    yield f"setp {generator}.steplen {PULSE_NS}"
    yield f"setp {generator}.stepspace {PULSE_NS}"
    yield f"setp {generator}.dirsetup {PULSE_NS}"
    yield f"setp {generator}.dirhold {PULSE_NS}"
    yield f"setp {generator}.maxaccel {axis.acceleration * STEP_RESERVE:.6f}"
    yield f"net {letter}-pos-cmd {joint}.motor-pos-cmd => {generator}.position-cmd"
    yield f"net {letter}-pos-fb {generator}.position-fb => {joint}.motor-pos-fb"
    yield f"net {letter}-enable {joint}.amp-enable-out => {generator}.enable"
    yield f"net {letter}-step <= {generator}.step"
    yield f"net {letter}-dir <= {generator}.dir"


def _servo(machine: Machine, axis: Axis) -> Iterator[str]:
    letter, joint = axis.letter.lower(), f"joint.{axis.joint}"
    yield f"setp pid-{letter}.Pgain {SERVO_P:g}"
    yield f"setp pid-{letter}.FF1 1"
    yield f"setp pid-{letter}.maxoutput {axis.velocity * STEP_RESERVE:.6f}"
    yield f"net {letter}-pos-cmd {joint}.motor-pos-cmd => pid-{letter}.command"
    yield f"net {letter}-enable {joint}.amp-enable-out => pid-{letter}.enable"
    if machine.simulated:
        yield f"net {letter}-speed pid-{letter}.output => motor-{letter}.in"
        yield f"net {letter}-pos-fb motor-{letter}.out => {joint}.motor-pos-fb pid-{letter}.feedback"
        return
    yield f"setp encoder-{letter}.position-scale [JOINT_{axis.joint}]SCALE"
    yield f"setp pwmgen.{axis.joint}.scale {axis.velocity * STEP_RESERVE:.6f}"
    yield f"net {letter}-enc-a => encoder-{letter}.phase-A"
    yield f"net {letter}-enc-b => encoder-{letter}.phase-B"
    yield f"net {letter}-speed pid-{letter}.output => pwmgen.{axis.joint}.value"
    yield f"net {letter}-enable => pwmgen.{axis.joint}.enable"
    yield f"net {letter}-pwm <= pwmgen.{axis.joint}.pwm"
    yield f"net {letter}-dir <= pwmgen.{axis.joint}.dir"
    yield f"net {letter}-pos-fb encoder-{letter}.position => {joint}.motor-pos-fb pid-{letter}.feedback"


def _rest(machine: Machine) -> Iterator[str]:
    yield "# E-stop: the chain of the machine belongs between these two pins"
    yield "net estop-loop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in"
    yield ""
    yield "net tool-prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared"
    if machine.manual_tools:
        yield "loadusr -W hal_manualtoolchange"
        yield "net tool-change iocontrol.0.tool-change => hal_manualtoolchange.change"
        yield "net tool-changed hal_manualtoolchange.changed => iocontrol.0.tool-changed"
        yield "net tool-number iocontrol.0.tool-prep-number => hal_manualtoolchange.number"
    else:
        yield "net tool-change iocontrol.0.tool-change => iocontrol.0.tool-changed"
    yield ""
    if machine.spindle_speed is not None:
        yield "setp spindle.0.at-speed 1"
        yield "net spindle-speed spindle.0.speed-out-rps => spindle.0.speed-in"
