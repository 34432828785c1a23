"""What task reads from the INI file, once at start: the machine as motion, canon and status must know it.

Defaults are LinuxCNC's. A value that cannot be is a ConfigError that names file, line and what would be right. Lengths
in machine units (lu), angles in machine angle units (deg by default), times in s.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, field
from pathlib import Path

from emctask.compensation import read_compensation
from nml import pulse
from nml.emc.emcmot import MAX_JOINTS, MAX_SPINDLES
from nml.inifile import IniFile

AXES = "XYZABCUVW"
UNLIMITED = 1e99
LINEAR, ANGULAR = 1, 2


def default_heartbeat_s() -> float:
    """How long motion waits for a sign of life of task, host time, where the INI file does not say.

    Where the system allows no realtime priority, a healthy task may be late by more than 0.1 s on a busy computer.
    """
    return 0.1 if pulse.has_priority() else 0.5


LENGTH_UNITS = {
    "mm": 1.0,
    "metric": 1.0,
    "inch": 1 / 25.4,
    "in": 1 / 25.4,
    "imperial": 1 / 25.4,
    "1.0": 1.0,
    "1": 1.0,
}
"""Machine length units in a millimetre."""

ANGLE_UNITS = {
    "degree": 1.0,
    "deg": 1.0,
    "grad": 400 / 360,
    "gon": 400 / 360,
    "radian": math.pi / 180,
    "rad": math.pi / 180,
    "1.0": 1.0,
    "1": 1.0,
}
"""Machine angle units in a degree."""

# Bits of EMCMOT_COMMAND.flags for SET_JOINT_HOMING_PARAMS, LinuxCNC's numbers.
HOME_IGNORE_LIMITS = 1
HOME_USE_INDEX = 2
HOME_IS_SHARED = 4
HOME_UNLOCK_FIRST = 8
HOME_ABSOLUTE_ENCODER = 16
HOME_NO_REHOME = 32
HOME_NO_FINAL_MOVE = 64
HOME_INDEX_NO_ENCODER_RESET = 128

NO_HOME_SEQUENCE = 999


@dataclass(slots=True)
class JointConfig:
    """One [JOINT_n] section."""

    kind: int
    units: float
    backlash: float
    min_limit: float
    max_limit: float
    ferror: float
    min_ferror: float
    max_velocity: float
    max_acceleration: float
    home: float
    home_offset: float
    home_search_vel: float
    home_latch_vel: float
    home_final_vel: float
    home_flags: int
    home_sequence: int
    volatile_home: bool
    max_jerk: float
    """0: no limit."""
    compensation: list[tuple[float, float, float]]


@dataclass(slots=True)
class AxisConfig:
    """One [AXIS_L] section."""

    min_limit: float
    max_limit: float
    max_velocity: float
    max_acceleration: float
    max_jerk: float
    """0: no limit."""
    offset_ratio: float
    locking_joint: int


@dataclass(slots=True)
class SpindleConfig:
    """One [SPINDLE_n] section; speeds in rpm, those of reverse turning as positive numbers."""

    min_forward: float
    max_forward: float
    min_reverse: float
    max_reverse: float
    increment: float
    """By how much an operator's order makes it faster or slower."""


@dataclass(slots=True)
class BlendConfig:
    """How segments are joined: [TRAJ]ARC_BLEND_*."""

    enable: bool
    fallback_enable: bool
    optimization_depth: int  # segments
    gap_cycles: float  # servo periods; motion's planner has no use for it
    ramp_freq: float  # Hz
    tangent_kink_ratio: float  # motion's planner has no use for it


@dataclass(slots=True)
class MachineConfig:
    """Everything."""

    ini_path: Path
    length_units: float
    angle_units: float
    axis_mask: int
    joints: list[JointConfig]
    axes: dict[int, AxisConfig]
    spindles: list[SpindleConfig]
    default_velocity: float
    max_velocity: float
    default_acceleration: float
    max_acceleration: float
    max_jerk: float
    """0: no limit."""
    planner_type: int
    max_feed_override: float
    no_force_homing: bool
    no_probe_jog_error: bool
    no_probe_home_error: bool
    world_home: tuple[float, ...]
    position_file: Path | None
    arc_blend: BlendConfig
    cycle_s: float
    mdi_queue: int
    startup_code: str
    program_prefix: Path
    m_code_folders: list[Path]
    on_abort: str
    debug: int
    random_toolchanger: bool
    tool_change_position: tuple[float, ...]
    """X Y Z, X to C or X to W, machine coordinates; empty: tools are changed where the machine stands."""
    comm_timeout_s: float
    heartbeat_s: float
    max_axis_velocities: list[float] = field(default_factory=list)
    max_axis_accelerations: list[float] = field(default_factory=list)


def read_config(ini: IniFile) -> MachineConfig:
    """The machine of an INI file; ConfigError names the first thing that is wrong."""
    length_units = ini.choice("TRAJ", "LINEAR_UNITS", LENGTH_UNITS)
    angle_units = ini.choice("TRAJ", "ANGULAR_UNITS", ANGLE_UNITS, 1.0)
    joint_count = ini.integer("KINS", "JOINTS", minimum=1, maximum=MAX_JOINTS)
    mask = _axis_mask(ini)
    axes = {axis: _axis(ini, AXES[axis], joint_count) for axis in range(9) if mask >> axis & 1}
    return MachineConfig(
        ini_path=ini.file,
        length_units=length_units,
        angle_units=angle_units,
        axis_mask=mask,
        joints=[_joint(ini, number, length_units, angle_units) for number in range(joint_count)],
        axes=axes,
        spindles=[_spindle(ini, n) for n in range(ini.integer("TRAJ", "SPINDLES", 1, minimum=0, maximum=MAX_SPINDLES))],
        default_velocity=ini.real("TRAJ", "DEFAULT_LINEAR_VELOCITY", 1.0, minimum=0.0),
        max_velocity=ini.real("TRAJ", "MAX_LINEAR_VELOCITY", UNLIMITED, minimum=0.0),
        default_acceleration=ini.real("TRAJ", "DEFAULT_LINEAR_ACCELERATION", UNLIMITED, minimum=0.0),
        max_acceleration=ini.real("TRAJ", "MAX_LINEAR_ACCELERATION", UNLIMITED, minimum=0.0),
        max_jerk=ini.real("TRAJ", "MAX_LINEAR_JERK", 0.0, minimum=0.0),
        planner_type=ini.integer("TRAJ", "PLANNER_TYPE", 0, minimum=0, maximum=1),
        max_feed_override=ini.real("DISPLAY", "MAX_FEED_OVERRIDE", 1.0, minimum=0.0),
        no_force_homing=ini.boolean("TRAJ", "NO_FORCE_HOMING", False),
        no_probe_jog_error=ini.boolean("TRAJ", "NO_PROBE_JOG_ERROR", False),
        no_probe_home_error=ini.boolean("TRAJ", "NO_PROBE_HOME_ERROR", False),
        world_home=(*_point(ini, "TRAJ", "HOME", range(10)), *[0.0] * 9)[:9],
        position_file=ini.path("TRAJ", "POSITION_FILE", None) if ini.find("TRAJ", "POSITION_FILE") else None,
        arc_blend=BlendConfig(
            enable=ini.boolean("TRAJ", "ARC_BLEND_ENABLE", True),
            fallback_enable=ini.boolean("TRAJ", "ARC_BLEND_FALLBACK_ENABLE", False),
            optimization_depth=ini.integer("TRAJ", "ARC_BLEND_OPTIMIZATION_DEPTH", 50, minimum=1),
            gap_cycles=ini.real("TRAJ", "ARC_BLEND_GAP_CYCLES", 4.0),
            ramp_freq=ini.real("TRAJ", "ARC_BLEND_RAMP_FREQ", 100.0, minimum=0.0),
            tangent_kink_ratio=ini.real("TRAJ", "ARC_BLEND_KINK_RATIO", 0.1),
        ),
        cycle_s=ini.real("TASK", "CYCLE_TIME", 0.01, maximum=1.0),
        mdi_queue=ini.integer("TASK", "MDI_QUEUED_COMMANDS", 10_000, minimum=1),
        startup_code=ini.find("RS274NGC", "RS274NGC_STARTUP_CODE", ""),
        program_prefix=ini.path("DISPLAY", "PROGRAM_PREFIX", ini.resolve("nc_files")),
        m_code_folders=_m_code_folders(ini),
        on_abort=ini.find("RS274NGC", "ON_ABORT_COMMAND", ""),
        debug=_as_int32(ini.integer("EMC", "DEBUG", 0)),
        random_toolchanger=ini.boolean("EMCIO", "RANDOM_TOOLCHANGER", False),
        tool_change_position=_point(ini, "EMCIO", "TOOL_CHANGE_POSITION", (0, 3, 6, 9)),
        heartbeat_s=ini.real("EMCMOT", "HEARTBEAT_TIMEOUT", default_heartbeat_s(), minimum=0.02, maximum=10.0),
        comm_timeout_s=ini.real("EMCMOT", "COMM_TIMEOUT", 1.0, minimum=0.01),
        max_axis_velocities=[axes[a].max_velocity if a in axes else UNLIMITED for a in range(9)],
        max_axis_accelerations=[axes[a].max_acceleration if a in axes else UNLIMITED for a in range(9)],
    )


def _as_int32(mask: int) -> int:
    """A bit mask as the C int that carries it: people write all bits as 0xFFFFFFFF."""
    return (mask & 0xFFFFFFFF ^ 0x80000000) - 0x80000000


def _axis_mask(ini: IniFile) -> int:
    text = ini.find("TRAJ", "COORDINATES")
    if text is None:
        raise ini.error("TRAJ", "COORDINATES", "missing; the letters of the axes are needed, like X Y Z")
    mask = 0
    for letter in text.upper().replace(",", " "):
        if letter.isspace():
            continue
        if letter not in AXES:
            raise ini.error("TRAJ", "COORDINATES", f"{letter!r} is no axis; letters of {AXES} are allowed")
        mask |= 1 << AXES.index(letter)
    return mask


def _axis(ini: IniFile, letter: str, joint_count: int) -> AxisConfig:
    section = f"AXIS_{letter}"
    ratio = ini.real(section, "OFFSET_AV_RATIO", 0.0, minimum=0.0, maximum=0.9)
    low, high = _limits(ini, section)
    return AxisConfig(
        min_limit=low,
        max_limit=high,
        max_velocity=_positive(ini, section, "MAX_VELOCITY", 1.0),
        max_acceleration=_positive(ini, section, "MAX_ACCELERATION", 1.0),
        max_jerk=ini.real(section, "MAX_JERK", 0.0, minimum=0.0),
        offset_ratio=ratio,
        locking_joint=ini.integer(section, "LOCKING_INDEXER_JOINT", -1, minimum=-1, maximum=joint_count - 1),
    )


def _limits(ini: IniFile, section: str) -> tuple[float, float]:
    low = ini.real(section, "MIN_LIMIT", -UNLIMITED)
    high = ini.real(section, "MAX_LIMIT", UNLIMITED)
    if low >= high:
        raise ini.error(section, "MIN_LIMIT", f"{low:g} is not below MAX_LIMIT = {high:g}")
    return low, high


def _positive(ini: IniFile, section: str, key: str, default: float) -> float:
    value = ini.real(section, key, default)
    if value <= 0.0:
        raise ini.error(section, key, f"{value:g} would never move; a number above 0 is needed")
    return value


def _joint(ini: IniFile, number: int, length_units: float, angle_units: float) -> JointConfig:
    section = f"JOINT_{number}"
    kind = ini.choice(section, "TYPE", {"LINEAR": LINEAR, "ANGULAR": ANGULAR}, LINEAR)
    units = {LINEAR: LENGTH_UNITS, ANGULAR: ANGLE_UNITS}[kind]
    ferror = ini.real(section, "FERROR", 1.0, minimum=0.0)
    low, high = _limits(ini, section)
    compensation = []
    table = ini.path(section, "COMP_FILE", None)
    if table is not None:
        compensation = read_compensation(table, ini.integer(section, "COMP_FILE_TYPE", 0, minimum=0, maximum=1))
    return JointConfig(
        kind=kind,
        units=ini.choice(section, "UNITS", units, length_units if kind == LINEAR else angle_units),
        backlash=0.0 if compensation else ini.real(section, "BACKLASH", 0.0),
        min_limit=low,
        max_limit=high,
        ferror=ferror,
        min_ferror=ini.real(section, "MIN_FERROR", ferror, minimum=0.0),
        max_velocity=_positive(ini, section, "MAX_VELOCITY", 1.0),
        max_acceleration=_positive(ini, section, "MAX_ACCELERATION", 1.0),
        max_jerk=ini.real(section, "MAX_JERK", 0.0, minimum=0.0),
        home=ini.real(section, "HOME", 0.0),
        home_offset=ini.real(section, "HOME_OFFSET", 0.0),
        home_search_vel=ini.real(section, "HOME_SEARCH_VEL", 0.0),
        home_latch_vel=ini.real(section, "HOME_LATCH_VEL", 0.0),
        home_final_vel=ini.real(section, "HOME_FINAL_VEL", -1.0),
        home_flags=_home_flags(ini, section),
        home_sequence=ini.integer(section, "HOME_SEQUENCE", NO_HOME_SEQUENCE, minimum=-100, maximum=NO_HOME_SEQUENCE),
        volatile_home=ini.boolean(section, "VOLATILE_HOME", False),
        compensation=compensation,
    )


def _home_flags(ini: IniFile, section: str) -> int:
    switches = {
        "HOME_IGNORE_LIMITS": HOME_IGNORE_LIMITS,
        "HOME_USE_INDEX": HOME_USE_INDEX,
        "HOME_IS_SHARED": HOME_IS_SHARED,
        "LOCKING_INDEXER": HOME_UNLOCK_FIRST,
        "HOME_INDEX_NO_ENCODER_RESET": HOME_INDEX_NO_ENCODER_RESET,
    }
    flags = sum(bit for key, bit in switches.items() if ini.boolean(section, key, False))
    encoder = ini.integer(section, "HOME_ABSOLUTE_ENCODER", 0, minimum=0, maximum=2)
    if encoder:
        flags |= HOME_ABSOLUTE_ENCODER | HOME_NO_REHOME
    if encoder == 2:
        flags |= HOME_NO_FINAL_MOVE
    return flags


def _spindle(ini: IniFile, number: int) -> SpindleConfig:
    section = f"SPINDLE_{number}"

    def speed(keys: tuple[str, ...], default: float) -> float:
        for key in keys:
            value = ini.real(section, key, None, minimum=0.0)
            if value is not None:
                return value
        return default

    low = speed(("MIN_FORWARD_VELOCITY", "MIN_VELOCITY"), 0.0)
    high = speed(("MAX_FORWARD_VELOCITY", "MAX_VELOCITY"), UNLIMITED)
    if low > high:
        raise ini.error(section, "MIN_FORWARD_VELOCITY", f"{low:g} is above the maximum, {high:g}")
    return SpindleConfig(
        min_forward=low,
        max_forward=high,
        min_reverse=speed(("MIN_REVERSE_VELOCITY",), low),
        max_reverse=speed(("MAX_REVERSE_VELOCITY",), high),
        increment=speed(("INCREMENT",), 100.0),
    )


def _point(ini: IniFile, section: str, key: str, lengths: Collection[int]) -> tuple[float, ...]:
    """Numbers for the first axes of X to W; empty where there is no such entry."""
    text = ini.find(section, key, "")
    try:
        values = tuple(float(word) for word in text.replace(",", " ").split())
    except ValueError:
        raise ini.error(section, key, f"{text!r}: up to nine numbers are needed, X to W") from None
    if len(values) not in lengths:
        allowed = ", ".join(map(str, lengths))
        raise ini.error(section, key, f"{len(values)} numbers; {allowed} are allowed, from X on")
    return values


def _m_code_folders(ini: IniFile) -> list[Path]:
    folders = [ini.path("DISPLAY", "PROGRAM_PREFIX", ini.resolve("nc_files"))]
    listed = ini.find("RS274NGC", "USER_M_PATH", "")
    folders += [ini.resolve(name) for name in listed.split(":") if name.strip()]
    return folders
