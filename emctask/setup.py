"""Configures motion from the INI file: what ``emctask.config`` has read becomes commands of chapter 3.8."""

from __future__ import annotations

from emctask import positionfile
from emctask.config import AxisConfig, BlendConfig, JointConfig, MachineConfig
from emctask.motion import MotionClient
from nml.emc.emcmot import MotCommand


def configure_motion(motion: MotionClient, config: MachineConfig) -> None:
    """Send everything that motion must know before the machine may be switched on, in the order of LinuxCNC's task."""
    motion.send(MotCommand.SET_NUM_JOINTS, joint=len(config.joints))
    motion.send(MotCommand.SET_NUM_SPINDLES, spindle=len(config.spindles))
    motion.send(MotCommand.SET_HEARTBEAT_TIMEOUT, timeout=motion.watchdog_s)
    path_limits(motion, config)
    arc_blend(motion, config.arc_blend)
    motion.send(MotCommand.SET_MAX_FEED_OVERRIDE, scale=config.max_feed_override)
    inhibit = int(config.no_probe_jog_error) | int(config.no_probe_home_error) << 1
    motion.send(MotCommand.SET_PROBE_ERR_INHIBIT, flags=inhibit)
    motion.send(MotCommand.SET_WORLD_HOME, pos=config.world_home)
    for number, joint in enumerate(config.joints):
        _send_joint(motion, number, joint)
    for axis, values in config.axes.items():
        _send_axis(motion, axis, values)
    if config.position_file is not None:
        positionfile.restore(config.position_file, motion, len(config.joints))
    for number, spindle in enumerate(config.spindles):
        motion.send(
            MotCommand.SET_SPINDLE_PARAMS,
            spindle=number,
            minSpeed=spindle.min_forward,
            maxSpeed=spindle.max_forward,
            minLimit=-spindle.max_reverse,
            maxLimit=-spindle.min_reverse,
        )
        motion.send(MotCommand.SPINDLE_OFF, spindle=number)  # engages its brake


def path_limits(motion: MotionClient, config: MachineConfig) -> None:
    """Velocity, acceleration and jerk along the path."""
    motion.send(MotCommand.SET_VEL, vel=config.default_velocity, ini_maxvel=config.max_velocity)
    motion.send(MotCommand.SET_VEL_LIMIT, vel=config.max_velocity)
    motion.send(MotCommand.SET_ACC, acc=min(config.default_acceleration, config.max_acceleration))
    motion.send(MotCommand.SET_JERK, jerk=config.max_jerk)
    motion.send(MotCommand.SET_PLANNER_TYPE, mode=config.planner_type)


def arc_blend(motion: MotionClient, blend: BlendConfig) -> None:
    """How segments are joined."""
    flags = int(blend.enable) | int(blend.fallback_enable) << 1
    motion.send(MotCommand.SETUP_ARC_BLENDS, flags=flags, turn=blend.optimization_depth, vel=blend.ramp_freq)


def _send_joint(motion: MotionClient, number: int, joint: JointConfig) -> None:
    send = motion.send
    send(MotCommand.SET_JOINT_BACKLASH, joint=number, backlash=joint.backlash)
    send(MotCommand.SET_JOINT_POSITION_LIMITS, joint=number, minLimit=joint.min_limit, maxLimit=joint.max_limit)
    send(MotCommand.SET_JOINT_MAX_FERROR, joint=number, maxFerror=joint.ferror)
    send(MotCommand.SET_JOINT_MIN_FERROR, joint=number, minFerror=joint.min_ferror)
    send_homing(motion, number, joint)
    send(MotCommand.SET_JOINT_VEL_LIMIT, joint=number, vel=joint.max_velocity)
    send(MotCommand.SET_JOINT_ACC_LIMIT, joint=number, acc=joint.max_acceleration)
    send(MotCommand.SET_JOINT_JERK_LIMIT, joint=number, jerk=joint.max_jerk)
    send_compensation(motion, number, joint.compensation)
    send(MotCommand.JOINT_ACTIVATE, joint=number)


def send_homing(motion: MotionClient, number: int, joint: JointConfig) -> None:
    """How a joint homes."""
    motion.send(
        MotCommand.SET_JOINT_HOMING_PARAMS,
        joint=number,
        offset=joint.home_offset,
        home=joint.home,
        home_final_vel=joint.home_final_vel,
        search_vel=joint.home_search_vel,
        latch_vel=joint.home_latch_vel,
        flags=joint.home_flags,
        home_sequence=joint.home_sequence,
        volatile_home=int(joint.volatile_home),
    )


def send_compensation(motion: MotionClient, number: int, rows: list[tuple[float, float, float]]) -> None:
    """The screw errors of a joint, one row a command."""
    for nominal, forward, reverse in rows:
        motion.send(
            MotCommand.SET_JOINT_COMP, joint=number, comp_nominal=nominal, comp_forward=forward, comp_reverse=reverse
        )


def _send_axis(motion: MotionClient, axis: int, values: AxisConfig) -> None:
    axis_limits(motion, axis, values)
    axis_speeds(motion, axis, values)
    motion.send(MotCommand.SET_AXIS_JERK_LIMIT, axis=axis, jerk=values.max_jerk)
    motion.send(MotCommand.SET_AXIS_LOCKING_JOINT, axis=axis, joint=values.locking_joint)


def axis_limits(motion: MotionClient, axis: int, values: AxisConfig) -> None:
    """Where an axis may be."""
    motion.send(MotCommand.SET_AXIS_POSITION_LIMITS, axis=axis, minLimit=values.min_limit, maxLimit=values.max_limit)


def axis_speeds(motion: MotionClient, axis: int, values: AxisConfig) -> None:
    """How fast an axis may be; external offsets get their share of velocity and acceleration."""
    share = values.offset_ratio
    motion.send(
        MotCommand.SET_AXIS_VEL_LIMIT,
        axis=axis,
        vel=values.max_velocity * (1 - share),
        ext_offset_vel=values.max_velocity * share,
    )
    motion.send(
        MotCommand.SET_AXIS_ACC_LIMIT,
        axis=axis,
        acc=values.max_acceleration * (1 - share),
        ext_offset_acc=values.max_acceleration * share,
    )
