"""Fills EMC_STAT from what task, motion, io and the interpreter know, and writes it to emcStatus.

Every cycle copies motion's status over; texts and offsets are written when they change. Numbers, units and meanings are
LinuxCNC's.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from emctask.config import MachineConfig
from emctask.layout import image
from emctask.places import Modes
from nml import clock
from nml.channel import Channel
from nml.emc import EMC_STAT
from nml.emc.emcmot import (
    EMCMOT_STATUS,
    Enables,
    JointFlag,
    MotionFlag,
    MotionState,
)

if TYPE_CHECKING:
    from emctask.task import Task

REPORT_S = 0.1  # host time between two reports when nothing changes
TRAJ_FREE, TRAJ_COORD, TRAJ_TELEOP = 1, 2, 3
TRAJ_MODES = {
    MotionState.DISABLED: TRAJ_FREE,
    MotionState.FREE: TRAJ_FREE,
    MotionState.TELEOP: TRAJ_TELEOP,
    MotionState.COORD: TRAJ_COORD,
}
DONE, EXEC, ERROR = 1, 2, 3


class StatusWriter:
    """The EMC_STAT of one machine."""

    def __init__(self, config: MachineConfig, channel: Channel) -> None:
        self._config = config
        self._channel = channel
        self.message = EMC_STAT()
        self._last = 0.0
        self._written = bytearray(EMC_STAT.SIZE)
        self._modes: Modes | None = None
        self._offsets: dict[str, object] = {}
        self._texts: dict[str, str] = {}
        stat = self.message
        traj = stat.motion.traj
        traj.linearUnits = config.length_units
        traj.angularUnits = config.angle_units
        traj.cycleTime = config.cycle_s
        traj.axis_mask = config.axis_mask
        traj.joints = len(config.joints)
        traj.spindles = len(config.spindles)
        stat.task.ini_filename = str(config.ini_path)[:254]
        for number, joint in enumerate(config.joints):
            target = stat.motion.joint[number]
            target.joint = number
            target.jointType = joint.kind
            target.units = joint.units
        for axis in range(9):
            stat.motion.axis[axis].axis = axis
        self._joints = [stat.motion.joint[number] for number in range(len(config.joints))]
        self._axes = [(axis, stat.motion.axis[axis]) for axis in config.axes]
        self._spindles = [stat.motion.spindle[number] for number in range(len(config.spindles))]

    def write(self, task: Task) -> None:
        """Fill the message; write it when something changed, and as a sign of life."""
        self._fill_motion(task.motion.status)
        self._fill_task(task)
        stat = self.message
        io = task.io.status
        stat.io.data[:] = io.data
        stat.debug = task.debug
        now = clock.host_now()
        if image(stat) != self._written or now - self._last >= REPORT_S:
            stat.task.heartbeat = (stat.task.heartbeat + 1) & 0xFFFFFFFF
            self._channel.write(stat)
            self._written[:] = image(stat)
            self._last = now

    # --- Task

    def _fill_task(self, task: Task) -> None:
        stat, plan = self.message, task.plan
        stat.command_type = task.command_type
        stat.echo_serial_number = task.echo
        stat.status = task.rcs_status
        t = stat.task
        t.mode = task.mode
        t.state = task.state
        t.execState = task.sequencer.exec_state
        t.interpState = task.interp_state
        t.task_paused = int(task.paused)
        t.delayLeft = task.sequencer.delay_left
        t.queuedMDIcommands = len(task.mdi_queue)
        t.optional_stop_state = task.optional_stop
        t.block_delete_state = task.block_delete
        t.input_timeout = task.input_timeout
        t.interpreter_errcode = plan.interpreter_code
        t.programUnits = task.canon.coords.units
        executing = task.motion.status.id
        place = task.canon.places.at(executing) if executing else None
        active = plan.active
        t.motionLine = place.line if place else 0
        t.currentLine = task.sequencer.current_line if active else 0
        t.readLine = plan.interp.line if active else 0
        t.callLevel = place.block.level if place else plan.interp.call_level
        self._fill_modes((place.block.modes if place else None) or plan.modes)
        if task.offsets != self._offsets:
            self._offsets = dict(task.offsets)
            for name, value in self._offsets.items():
                setattr(t, name, value)
        for name, text in (("file", plan.file), ("command", task.mdi_text)):
            if self._texts.get(name) != text:
                self._texts[name] = text
                setattr(t, name, text[:254])

    def _fill_modes(self, modes: Modes) -> None:
        if modes is self._modes or not modes.g_codes:
            return
        self._modes = modes
        task = self.message.task
        task.activeGCodes = modes.g_codes
        task.activeMCodes = modes.m_codes
        task.activeSettings = modes.settings

    # --- Motion

    def _fill_motion(self, motion: EMCMOT_STATUS) -> None:
        stat = self.message.motion
        stat.heartbeat = motion.heartbeat & 0xFFFFFFFF
        flags = motion.motionFlag
        traj = stat.traj
        traj.mode = TRAJ_MODES[MotionState(motion.motion_state)]
        traj.enabled = bool(flags & MotionFlag.ENABLE)
        traj.inpos = bool(flags & MotionFlag.INPOS)
        traj.queue = motion.depth
        traj.activeQueue = motion.activeDepth
        traj.queueFull = bool(motion.queueFull)
        traj.id = motion.id
        traj.paused = bool(motion.paused)
        traj.scale = motion.feed_scale
        traj.rapid_scale = motion.rapid_scale
        traj.position.data[:] = motion.carte_pos_cmd.data
        traj.actualPosition.data[:] = motion.carte_pos_fb.data
        traj.probedPosition.data[:] = motion.probedPos.data
        traj.dtg.data[:] = motion.dtg.data
        traj.velocity = motion.requested_vel
        traj.acceleration = motion.acc
        traj.maxVelocity = motion.vel
        traj.maxAcceleration = self._config.max_acceleration
        traj.current_vel = motion.current_vel
        traj.distance_to_go = motion.distance_to_go
        traj.probe_tripped = bool(motion.probeTripped)
        traj.probing = bool(motion.probing)
        traj.probeval = motion.probeVal
        traj.kinematics_type = motion.kinematics_type
        traj.motion_type = motion.motionType
        enables = motion.enables_new
        traj.feed_override_enabled = bool(enables & Enables.FS)
        traj.adaptive_feed_enabled = bool(enables & Enables.AF)
        traj.feed_hold_enabled = bool(enables & Enables.FH)
        stat.on_soft_limit = motion.on_soft_limit
        stat.jogging_active = bool(motion.jogging_active)
        stat.external_offsets_applied = motion.external_offsets_applied
        stat.eoffset_pose.data[:] = motion.eoffset_pose.data
        self._fill_joints(motion)
        self._fill_axes(motion)
        self._fill_spindles(motion)
        stat.synch_di = tuple(motion.synch_di)
        stat.synch_do = tuple(motion.synch_do)
        stat.analog_input = tuple(motion.analog_input)
        stat.analog_output = tuple(motion.analog_output)

    def _fill_joints(self, motion: EMCMOT_STATUS) -> None:
        overridden = motion.overrideLimitMask
        for number, target in enumerate(self._joints):
            source = motion.joint_status[number]
            flag = source.flag
            target.backlash = source.backlash
            target.minPositionLimit = source.min_pos_limit
            target.maxPositionLimit = source.max_pos_limit
            target.minFerror = source.min_ferror
            target.maxFerror = source.max_ferror
            target.ferrorCurrent = source.ferror
            target.ferrorHighMark = source.ferror_high_mark
            target.output = source.pos_cmd
            target.input = source.pos_fb
            target.velocity = source.vel_cmd
            target.inpos = int(bool(flag & JointFlag.INPOS))
            target.homing = int(bool(source.homing))
            target.homed = int(bool(source.homed))
            target.fault = int(bool(flag & JointFlag.FAULT))
            target.enabled = int(bool(flag & JointFlag.ENABLE))
            target.minSoftLimit = int(bool(source.on_soft_limit_neg))
            target.maxSoftLimit = int(bool(source.on_soft_limit_pos))
            target.minHardLimit = int(bool(flag & JointFlag.MIN_HARD_LIMIT))
            target.maxHardLimit = int(bool(flag & JointFlag.MAX_HARD_LIMIT))
            target.overrideLimits = int(bool(overridden))

    def _fill_axes(self, motion: EMCMOT_STATUS) -> None:
        for axis, target in self._axes:
            source = motion.axis_status[axis]
            target.minPositionLimit = source.min_pos_limit
            target.maxPositionLimit = source.max_pos_limit
            target.velocity = source.teleop_vel_cmd

    def _fill_spindles(self, motion: EMCMOT_STATUS) -> None:
        enables = motion.enables_new
        for number, target in enumerate(self._spindles):
            source = motion.spindle_status[number]
            target.speed = source.speed
            target.spindle_scale = source.scale
            target.css_maximum = source.css_maximum
            target.css_factor = source.css_factor
            target.state = source.state
            target.direction = source.direction
            target.brake = source.brake
            target.increasing = source.increasing
            target.enabled = int(source.state != 0)
            target.orient_state = source.orient_state
            target.orient_fault = source.orient_fault
            target.spindle_override_enabled = bool(enables & Enables.SS)
            target.homed = False

    def close(self) -> None:
        """Close the channel."""
        self._channel.close()
