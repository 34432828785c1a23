"""A command from task to motion as a line of text, in the words of LinuxCNC's motion-logger.

``describe`` is all that others use: ``emcmot.motionlogger`` writes what it gives. A command that LinuxCNC does not have
(task's signs of life, for instance) has no line, so that two logs of one session may be compared.
"""

from __future__ import annotations

from collections.abc import Callable

from nml.emc.emcmot import EMCMOT_COMMAND, MotCommand
from nml.emc.structs import EmcPose, PmCartesian

C = MotCommand
Describe = Callable[[EMCMOT_COMMAND], str]

OTHER_NAMES = {
    C.JOINT_ENABLE_AMPLIFIER: "ENABLE_AMPLIFIER",
    C.JOINT_DISABLE_AMPLIFIER: "DISABLE_AMPLIFIER",
    C.SET_PROBE_ERR_INHIBIT: "SETUP_SET_PROBE_ERR_INHIBIT",
}
NOT_OF_LINUXCNC = frozenset(C(number) for number in range(C.SET_HEARTBEAT_TIMEOUT, C.SET_AXIS_JERK_LIMIT + 1))
AXES = "xyzabcuvw"


def _pose(pose: EmcPose, separator: str = ", ") -> str:
    values = (pose.tran.x, pose.tran.y, pose.tran.z, pose.a, pose.b, pose.c, pose.u, pose.v, pose.w)
    words = [f"{axis}={value:.6g}" for axis, value in zip(AXES, values, strict=True)]
    return ", ".join(words[:6]) + separator + ", ".join(words[6:])


def _point(point: PmCartesian) -> str:
    return f"x={point.x:.6g}, y={point.y:.6g}, z={point.z:.6g}"


def _move(c: EMCMOT_COMMAND) -> str:
    return (
        f"id={c.id}, motion_type={c.motion_type}, vel={c.vel:.6g}, ini_maxvel={c.ini_maxvel:.6g}, "
        f"acc={c.acc:.6g}, turn={c.turn}"
    )


def _circle(c: EMCMOT_COMMAND) -> str:
    lines = (f"pos: {_pose(c.pos)}", f"center: {_point(c.center)}", f"normal: {_point(c.normal)}", _move(c))
    return ":\n" + "\n".join(f"    {line}" for line in lines)


def _homing(c: EMCMOT_COMMAND) -> str:
    return (
        f" joint={c.joint}, offset={c.offset:.6g} home={c.home:.6g}, final_vel={c.home_final_vel:.6g}, "
        f"search_vel={c.search_vel:.6g}, latch_vel={c.latch_vel:.6g}, flags=0x{c.flags & 0xFFFFFFFF:08x}, "
        f"sequence={c.home_sequence}, volatile={c.volatile_home}"
    )


def _joint(c: EMCMOT_COMMAND) -> str:
    return f" joint={c.joint}"


def _spindle_limits(c: EMCMOT_COMMAND) -> str:
    return f", {c.maxSpeed:.2e}, {c.minSpeed:.2e}, {c.minLimit:.2e}, {c.maxLimit + 0.0:.2e}"


DETAILS: dict[MotCommand, Describe] = {
    C.JOG_ABORT: _joint,
    C.JOINT_ACTIVATE: _joint,
    C.JOINT_DEACTIVATE: _joint,
    C.JOINT_HOME: _joint,
    C.JOINT_UNHOME: _joint,
    C.SET_LINE: lambda c: f" {_pose(c.pos)}, {_move(c)}",
    C.SET_CIRCLE: _circle,
    C.SET_JOINT_POSITION_LIMITS: lambda c: f" joint={c.joint}, min={c.minLimit:.6g}, max={c.maxLimit:.6g}",
    C.SET_AXIS_POSITION_LIMITS: lambda c: f" axis={c.axis}, min={c.minLimit:.6g}, max={c.maxLimit:.6g}",
    C.SET_AXIS_LOCKING_JOINT: lambda c: f" axis={c.axis}, locking_joint={c.joint}",
    C.SET_JOINT_BACKLASH: lambda c: f" joint={c.joint}, backlash={c.backlash:.6g}",
    C.SET_JOINT_MIN_FERROR: lambda c: f" joint={c.joint}, minFerror={c.minFerror:.6g}",
    C.SET_JOINT_MAX_FERROR: lambda c: f" joint={c.joint}, maxFerror={c.maxFerror:.6g}",
    C.SET_VEL: lambda c: f" vel={c.vel:.6g}, ini_maxvel={c.ini_maxvel:.6g}",
    C.SET_VEL_LIMIT: lambda c: f" vel={c.vel:.6g}",
    C.SET_AXIS_VEL_LIMIT: lambda c: f" axis={c.axis} vel={c.vel:.6g}",
    C.SET_JOINT_VEL_LIMIT: lambda c: f" joint={c.joint}, vel={c.vel:.6g}",
    C.SET_ACC: lambda c: f" acc={c.acc:.6g}",
    C.SET_AXIS_ACC_LIMIT: lambda c: f" axis={c.axis}, acc={c.acc:.6g}",
    C.SET_JOINT_ACC_LIMIT: lambda c: f" joint={c.joint}, acc={c.acc:.6g}",
    C.SET_TERM_COND: lambda c: f" termCond={c.termCond}, tolerance={c.tolerance:.6g}",
    C.SET_NUM_JOINTS: lambda c: f" {c.joint}",
    C.SET_NUM_SPINDLES: lambda c: f" {c.spindle}",
    C.SET_WORLD_HOME: lambda c: f" {_pose(c.pos)}",
    C.SET_JOINT_HOMING_PARAMS: _homing,
    C.UPDATE_JOINT_HOMING_PARAMS: lambda c: (
        f" joint={c.joint}, offset={c.offset:.6g} home={c.home:.6g} home_sequence={c.home_sequence}"
    ),
    C.SET_SPINDLE_PARAMS: _spindle_limits,
    C.SET_SPINDLESYNC: lambda c: f" sync={c.spindlesync:06f}, flags=0x{c.flags & 0xFFFFFFFF:08x}",
    C.SPINDLE_ON: lambda c: f" speed={c.vel:f}, css_factor={c.acc:f}, xoffset={c.offset:f}",
    C.SET_OFFSET: lambda c: f" {_pose(c.tool_offset, separator=' ')}",
    C.SET_MAX_FEED_OVERRIDE: lambda c: f" {c.scale:.6g}",
    C.SET_PROBE_ERR_INHIBIT: lambda c: f" {c.flags & 1} {c.flags >> 1 & 1}",
}


def describe(command: EMCMOT_COMMAND) -> str:
    """The line or lines of a command, without the last newline; nothing for one that LinuxCNC does not have."""
    try:
        kind = MotCommand(command.command)
    except ValueError:
        return f"ERROR: unknown command {command.command}"
    if kind in NOT_OF_LINUXCNC:
        return ""
    details = DETAILS.get(kind)
    return OTHER_NAMES.get(kind, kind.name) + (details(command) if details else "")
