"""Fills EMC_STAT from what task, motion, io and the interpreter know, and writes it to emcStatus.

Motion's part is copied by ``emctask.motionview``; texts, offsets and codes are written when they change. Numbers, units
and meanings are LinuxCNC's.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from emctask.callstacks import CallStacks
from emctask.config import MachineConfig
from emctask.layout import image
from emctask.motionview import MotionView
from emctask.places import Calls, Modes
from emctask.world import WorldModel
from nml import clock
from nml.channel import Channel
from nml.emc import EMC_STAT
from nml.emc.constants import EMC_TASK_MODE_ENUM as Mode
from nml.emc.constants import EMC_TRAJ_MODE_ENUM as TrajMode

if TYPE_CHECKING:
    from emctask.task import Task

REPORT_S = 0.1  # host time between two reports when nothing changes


class StatusWriter:
    """The EMC_STAT of one machine."""

    def __init__(self, config: MachineConfig, channel: Channel, stacks: CallStacks) -> None:
        self._config = config
        self._channel = channel
        self._stacks = stacks
        self._calls: Calls = ()
        self.message = EMC_STAT()
        self._last = 0.0
        self._written = bytearray(EMC_STAT.SIZE)
        self._modes: Modes | None = None
        self._line = 0
        self._forgotten = 0
        """The last move whose line is not shown any more."""
        self._mode_on: int = TrajMode.FREE
        """Motion's mode when the machine was on last."""
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
        self._motion = MotionView(config, stat)

    def write(self, task: Task) -> None:
        """Fill the message; write it when something changed, and as a sign of life."""
        self._motion.fill(task.motion.image)
        traj = self.message.motion.traj
        if task.motion.enabled:
            self._mode_on = traj.mode
        else:
            traj.mode = self._mode_when_on(task)
        self._fill_task(task)
        stat = self.message
        io = task.io.status
        stat.io.data[:] = io.data
        stat.debug = task.debug
        now = clock.host_now()
        if image(stat) != self._written or self._stacks.changed(self._calls) or now - self._last >= REPORT_S:
            stat.task.heartbeat = (stat.task.heartbeat + 1) & 0xFFFFFFFF
            self._stacks.write(self._calls, stat.task.heartbeat)
            self._channel.write(stat)
            self._written[:] = image(stat)
            self._last = now

    def forget_line(self, move: int) -> None:
        """The line of a move is not shown any more, even while the machine comes to rest on it."""
        self._forgotten = move
        self.message.task.motionLine = 0

    def jogs_when_on(self, mode: TrajMode) -> None:
        """What jogs move, axes or joints; a machine that is off shows it as well."""
        self._mode_on = mode

    def _mode_when_on(self, task: Task) -> int:
        """How motion will move once the machine is on."""
        if task.mode is not Mode.MANUAL:
            return TrajMode.COORD
        if self._mode_on != TrajMode.COORD:
            return self._mode_on
        return TrajMode.TELEOP if task.motion.all_homed else TrajMode.FREE

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
        place = task.canon.places.at(executing) if executing > self._forgotten else None
        t.currentLine = task.sequencer.current_line
        if place or not t.currentLine:
            t.motionLine = place.line if place else 0
        stat.motion.traj.id = place.line if place else 0
        t.readLine = plan.interp.line if plan.active else 0
        block = place.block if place else task.sequencer.current_block if plan.active else None
        self._calls = block.calls if block else plan.calls
        t.callLevel = len(self._calls)
        modes = (block.modes if block else None) or plan.modes
        self._fill_modes(modes, task.canon, t.motionLine if plan.runs_program else modes.line)
        if task.offsets != self._offsets:
            self._offsets = dict(task.offsets)
            for name, value in self._offsets.items():
                setattr(t, name, value)
        for name, text in (("file", plan.file), ("command", task.mdi_text or plan.program_line)):
            if self._texts.get(name) != text:
                self._texts[name] = text
                setattr(t, name, text[:254])

    def _fill_modes(self, modes: Modes, canon: WorldModel, line: int) -> None:
        """The codes in force; the first of each list is the line that they belong to."""
        if (modes is self._modes and line == self._line) or not modes.g_codes:
            return
        self._modes, self._line = modes, line
        task = self.message.task
        task.activeGCodes = (line, *modes.g_codes[1:])
        task.activeMCodes = (line, *modes.m_codes[1:])
        task.activeSettings = (line, *canon.shown_settings(modes.settings)[1:])

    def close(self) -> None:
        """Close the channels."""
        self._channel.close()
        self._stacks.close()
