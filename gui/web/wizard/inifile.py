"""The INI file of a machine that was described to the wizard."""

from __future__ import annotations

from collections.abc import Iterator

from gui.web.wizard.answers import Axis, Machine

SERVO_PERIOD = 1_000_000  # ns
FERROR_MM, MIN_FERROR_MM = 1.0, 0.25
INCREMENTS = {"mm": "10 mm, 1 mm, 0.1 mm, 0.01 mm", "inch": "1 in, 0.1 in, 0.01 in, 0.001 in"}


def text(machine: Machine) -> str:
    """The whole file."""
    return "\n".join(_lines(machine)) + "\n"


def _lines(machine: Machine) -> Iterator[str]:
    linear = [axis for axis in machine.axes if not axis.rotary]
    fastest = max(axis.velocity for axis in linear)
    strongest = max(axis.acceleration for axis in linear)
    yield from _section("EMC", MACHINE=machine.name, VERSION="1.1", NML_FILE=f"{machine.name}.nml", DEBUG=0)
    yield from _section(
        "DISPLAY",
        DISPLAY="web",
        MACHINE_TYPE_HINT=machine.kind.upper(),
        **({"BACK_TOOL_LATHE": 1} if machine.back_tool else {}),
        CYCLE_TIME=0.05,
        POSITION_OFFSET="RELATIVE",
        POSITION_FEEDBACK="ACTUAL",
        MAX_FEED_OVERRIDE=1.5,
        MAX_SPINDLE_OVERRIDE=1.5,
        INCREMENTS=INCREMENTS[machine.units],
        DEFAULT_LINEAR_VELOCITY=_number(fastest / 4.0),
        MAX_LINEAR_VELOCITY=_number(fastest),
        PROGRAM_PREFIX="nc_files",
        MDI_HISTORY_FILE="mdi_history.txt",
    )
    yield from _section("TASK", TASK="milltask", CYCLE_TIME=0.001)
    yield from _section("RS274NGC", PARAMETER_FILE=f"{machine.name}.var", SUBROUTINE_PATH="nc_files")
    base = {"BASE_PERIOD": machine.base_period} if machine.drive == "steps" else {}
    yield from _section("EMCMOT", EMCMOT="motmod", **base, SERVO_PERIOD=SERVO_PERIOD)
    yield from _section("EMCIO", EMCIO="io", CYCLE_TIME=0.05, TOOL_TABLE="tool.tbl")
    yield from _section("HAL", HALFILE=f"{machine.name}.hal")
    yield from _section("KINS", KINEMATICS=f"trivkins coordinates={machine.letters}", JOINTS=len(machine.axes))
    yield from _section(
        "TRAJ",
        COORDINATES=" ".join(machine.letters),
        LINEAR_UNITS=machine.units,
        ANGULAR_UNITS="degree",
        SPINDLES=1,
        DEFAULT_LINEAR_VELOCITY=_number(fastest / 4.0),
        MAX_LINEAR_VELOCITY=_number(fastest),
        DEFAULT_LINEAR_ACCELERATION=_number(strongest),
        MAX_LINEAR_ACCELERATION=_number(strongest),
    )
    if machine.spindle_speed is not None:
        yield from _section("SPINDLE_0", MAX_FORWARD_VELOCITY=_number(machine.spindle_speed), MIN_FORWARD_VELOCITY=0)
    for axis in machine.axes:
        yield from _axis(machine, axis)


def _axis(machine: Machine, axis: Axis) -> Iterator[str]:
    common = {
        "MIN_LIMIT": _number(axis.min),
        "MAX_LIMIT": _number(axis.max),
        "MAX_VELOCITY": _number(axis.velocity),
        "MAX_ACCELERATION": _number(axis.acceleration),
    }
    size = 1.0 if axis.rotary else machine.mm
    yield from _section(f"AXIS_{axis.letter}", **common)
    yield from _section(
        f"JOINT_{axis.joint}",
        TYPE="ANGULAR" if axis.rotary else "LINEAR",
        **common,
        FERROR=_number(FERROR_MM / size),
        MIN_FERROR=_number(MIN_FERROR_MM / size),
        **({"SCALE": _number(axis.scale)} if machine.drive != "none" else {}),
        HOME=_number(axis.home),
        HOME_OFFSET=_number(axis.switch if machine.switches else axis.home),
        HOME_SEARCH_VEL=_number(axis.search if machine.switches else 0.0),
        HOME_LATCH_VEL=_number(axis.latch if machine.switches else 0.0),
        HOME_SEQUENCE=axis.home_sequence,
    )


def _section(name: str, **entries: object) -> Iterator[str]:
    yield f"[{name}]"
    for key, value in entries.items():
        yield f"{key} = {value}"
    yield ""


def _number(value: float) -> str:
    return f"{value:.6f}".rstrip("0").rstrip(".")
