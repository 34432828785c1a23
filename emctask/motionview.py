"""EMC_STAT's view of motion: what the servo thread reports, in the layout and with the meanings that clients know.

This runs a thousand times a second, so numbers go over in a few ``struct`` calls: ``HEAD`` is the flat part of
EMCMOT_STATUS, joints, axes and spindles are packed one by one, poses and analog values are copied as bytes.
"""

from __future__ import annotations

from typing import Any

from emctask.config import MachineConfig
from emctask.layout import Copy, Span, image
from nml.emc import EMC_JOINT_STAT, EMC_STAT
from nml.emc.constants import EmcJointType
from nml.emc.emcmot import (
    EMCMOT_AXIS_STATUS,
    EMCMOT_JOINT_STATUS,
    EMCMOT_SPINDLE_STATUS,
    EMCMOT_STATUS,
    MAX_DIO,
    MAX_JOINTS,
    MAX_SPINDLES,
    Enables,
    JointFlag,
    MotionFlag,
    MotionState,
)

TRAJ_FREE, TRAJ_COORD, TRAJ_TELEOP = 1, 2, 3
TRAJ_MODES = {
    int(MotionState.DISABLED): TRAJ_FREE,
    int(MotionState.FREE): TRAJ_FREE,
    int(MotionState.TELEOP): TRAJ_TELEOP,
    int(MotionState.COORD): TRAJ_COORD,
}

HEAD = Span(EMCMOT_STATUS, "commandEcho", "servo_time_max")
JOINT_IN = Span(EMCMOT_JOINT_STATUS, "flag", "acc_limit")
JOINT_OUT = Span(EMC_JOINT_STAT, "joint", "overrideLimits")
SPINDLE_IN = Span(EMCMOT_SPINDLE_STATUS, "speed", "speed_in")
AXIS_IN = Span(EMCMOT_AXIS_STATUS, "teleop_vel_cmd", "min_pos_limit")

POSES = [
    Copy(EMCMOT_STATUS, source, EMC_STAT, target)
    for source, target in (
        ("carte_pos_cmd", "motion.traj.position"),
        ("carte_pos_fb", "motion.traj.actualPosition"),
        ("probedPos", "motion.traj.probedPosition"),
        ("dtg", "motion.traj.dtg"),
        ("eoffset_pose", "motion.eoffset_pose"),
        ("analog_input", "motion.analog_input"),
        ("analog_output", "motion.analog_output"),
    )
]
DIGITAL = [
    (EMCMOT_STATUS.field(name)[1], EMC_STAT.field(f"motion.{name}")[1]) for name in ("synch_di", "synch_do")
]
_JOINTS_IN = EMCMOT_STATUS.field("joint_status")[1]
_JOINTS_OUT = EMC_STAT.field("motion.joint")[1]
_AXES_IN = EMCMOT_STATUS.field("axis_status")[1]
_SPINDLES_IN = EMCMOT_STATUS.field("spindle_status")[1]
_ENABLE, _INPOS = int(MotionFlag.ENABLE), int(MotionFlag.INPOS)
_J_ENABLE, _J_INPOS, _J_FAULT = int(JointFlag.ENABLE), int(JointFlag.INPOS), int(JointFlag.FAULT)
_J_MIN_HARD, _J_MAX_HARD = int(JointFlag.MIN_HARD_LIMIT), int(JointFlag.MAX_HARD_LIMIT)
_FS, _AF, _FH, _SS = int(Enables.FS), int(Enables.AF), int(Enables.FH), int(Enables.SS)

ABSENT_JOINT = {
    "jointType": EmcJointType.LINEAR,
    "units": 1.0,
    "minPositionLimit": -1.0,
    "maxPositionLimit": 1.0,
    "maxFerror": 1.0,
    "minFerror": 1.0,
    "inpos": 1,
}
"""What clients see of a joint that the machine does not have; as in LinuxCNC, what such a joint begins with."""
ABSENT_SPINDLE = {"spindle_scale": 1.0, "brake": 1}


def _set(record: Any, fields: dict[str, Any]) -> None:
    for name, value in fields.items():
        setattr(record, name, value)


class MotionView:
    """Writes the ``motion`` part of one EMC_STAT."""

    def __init__(self, config: MachineConfig, stat: EMC_STAT) -> None:
        self._stat = stat.motion
        self._traj = stat.motion.traj
        self._target = image(stat)
        self._joints = [(number, joint.kind, joint.units) for number, joint in enumerate(config.joints)]
        self._axes = [(axis, stat.motion.axis[axis]) for axis in config.axes]
        self._spindles = [stat.motion.spindle[number] for number in range(len(config.spindles))]
        self._digital = [b""] * len(DIGITAL)
        self._traj.maxAcceleration = config.max_acceleration
        for axis in range(9):
            stat.motion.axis[axis].axis = axis
        for number in range(len(config.joints), MAX_JOINTS):
            _set(stat.motion.joint[number], ABSENT_JOINT)
        for number in range(len(config.spindles), MAX_SPINDLES):
            _set(stat.motion.spindle[number], ABSENT_SPINDLE)

    def fill(self, source: bytearray) -> None:
        """Take over motion's status."""
        head = HEAD.read(source)
        self._fill_traj(head)
        stat = self._stat
        stat.heartbeat = head.heartbeat & 0xFFFFFFFF
        stat.on_soft_limit = head.on_soft_limit
        stat.jogging_active = bool(head.jogging_active)
        stat.external_offsets_applied = head.external_offsets_applied
        for copy in POSES:
            copy(source, self._target)
        self._fill_joints(source, int(bool(head.overrideLimitMask)))
        self._fill_axes(source)
        self._fill_spindles(source, bool(head.enables_new & _SS))
        self._fill_digital(source)

    def _fill_traj(self, head: Any) -> None:
        traj = self._traj
        traj.mode = TRAJ_MODES[head.motion_state]
        traj.enabled = bool(head.motionFlag & _ENABLE)
        traj.inpos = bool(head.motionFlag & _INPOS)
        traj.queue = head.depth
        traj.activeQueue = head.activeDepth
        traj.queueFull = bool(head.queueFull)
        traj.id = head.id
        traj.paused = bool(head.paused)
        traj.scale = head.feed_scale
        traj.rapid_scale = head.rapid_scale
        traj.velocity = head.requested_vel
        traj.acceleration = head.acc
        traj.maxVelocity = head.vel
        traj.current_vel = head.current_vel
        traj.distance_to_go = head.distance_to_go
        traj.probe_tripped = bool(head.probeTripped)
        traj.probing = bool(head.probing)
        traj.probeval = head.probeVal
        traj.kinematics_type = head.kinematics_type
        traj.motion_type = head.motionType
        enables = head.enables_new
        traj.feed_override_enabled = bool(enables & _FS)
        traj.adaptive_feed_enabled = bool(enables & _AF)
        traj.feed_hold_enabled = bool(enables & _FH)

    def _fill_joints(self, source: bytearray, overridden: int) -> None:
        at = _JOINTS_IN
        to = _JOINTS_OUT + JOINT_OUT.offset
        for number, kind, units in self._joints:
            joint = JOINT_IN.read(source, at)
            flag = joint.flag
            JOINT_OUT.pack_into(
                self._target,
                to,
                number,
                kind,
                units,
                joint.backlash,
                joint.min_pos_limit,
                joint.max_pos_limit,
                joint.max_ferror,
                joint.min_ferror,
                joint.ferror,
                joint.ferror_high_mark,
                joint.pos_cmd,
                joint.pos_fb,
                joint.vel_cmd,
                flag & _J_INPOS != 0,
                joint.homing != 0,
                joint.homed != 0,
                flag & _J_FAULT != 0,
                flag & _J_ENABLE != 0,
                joint.on_soft_limit_neg != 0,
                joint.on_soft_limit_pos != 0,
                flag & _J_MIN_HARD != 0,
                flag & _J_MAX_HARD != 0,
                overridden,
            )
            at += EMCMOT_JOINT_STATUS.SIZE
            to += EMC_JOINT_STAT.SIZE

    def _fill_axes(self, source: bytearray) -> None:
        for axis, target in self._axes:
            at = _AXES_IN + axis * EMCMOT_AXIS_STATUS.SIZE + AXIS_IN.offset
            target.velocity, target.maxPositionLimit, target.minPositionLimit = AXIS_IN.unpack_from(source, at)

    def _fill_spindles(self, source: bytearray, override_enabled: bool) -> None:
        at = _SPINDLES_IN
        for target in self._spindles:
            spindle = SPINDLE_IN.read(source, at)
            target.speed = spindle.speed
            target.spindle_scale = spindle.scale
            target.css_maximum = spindle.css_maximum
            target.css_factor = spindle.css_factor
            target.state = spindle.state
            target.direction = spindle.direction
            target.brake = spindle.brake
            target.increasing = spindle.increasing
            target.enabled = int(spindle.state != 0)
            target.orient_state = spindle.orient_state
            target.orient_fault = spindle.orient_fault
            target.spindle_override_enabled = override_enabled
            at += EMCMOT_SPINDLE_STATUS.SIZE

    def _fill_digital(self, source: bytearray) -> None:
        for index, (at, to) in enumerate(DIGITAL):
            bits = bytes(source[at : at + MAX_DIO])
            if bits != self._digital[index]:
                self._digital[index] = bits
                for number, value in enumerate(bits):
                    self._target[to + 4 * number] = value

