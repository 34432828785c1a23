"""Task's side of motion: sends EMCMOT_COMMANDs, follows EMCMOT_STATUS, and knows what is on the way.

Two promises of the contract with motion live here. Never more moves are on the way than the planner has room for:
``room()`` counts ``queueFree`` less the moves sent after the last echo. And "motion is done" (``settled``) means that
it has echoed every command sent and stands still with an empty queue, all in one status: nobody who waits for it, a
probe or a tool change, can be fooled by a status from before.
"""

from __future__ import annotations

from collections import deque
from typing import Any

from emctask.layout import Span, image
from emctask.partner import SignOfLife
from nml.channel import Channel
from nml.emc.constants import KINEMATICS_TYPE as Kinematics
from nml.emc.emcmot import (
    EMCMOT_COMMAND,
    EMCMOT_ERROR,
    EMCMOT_STATUS,
    MotCommand,
    MotCommandStatus,
    MotionFlag,
    MotionState,
)
from nml.pulse import Pulse

MOVE = Span(EMCMOT_COMMAND, "command", "tolerance")
"""command, joint, axis, spindle, id, pos (9), center (3), normal (3), turn, motion_type, vel, ini_maxvel, acc, jerk,
termCond, mode, tolerance."""

BEATS = 5  # signs of life within the time that motion waits for one
HUNG_S = 3.0  # host time without a cycle after which task gives no more signs of life
RESERVE = 10  # places of the planner's queue that task leaves free


class MotionClient:
    """Commands out, status in."""

    def __init__(self, commands: Channel, status: Channel, errors: Channel, watchdog_s: float) -> None:
        self.watchdog_s = watchdog_s
        """Host time without a sign of life from task after which motion stops the machine."""
        self._commands = commands
        self._status = status
        self._sign_of_life = SignOfLife(status)
        self._errors = errors
        self.status = EMCMOT_STATUS()
        self.image = image(self.status)
        """The bytes of ``status``, live."""
        self._command = EMCMOT_COMMAND()
        self._blank = bytes(self._command.data)
        self._in_flight: deque[int] = deque()
        self._sent = 0
        self._pulse = Pulse(commands, watchdog_s / BEATS, HUNG_S)
        self._refused = 0
        self.known = False

    # --- Status

    def poll(self) -> bool:
        """Take over a new status; is there one?"""
        if not self._status.poll_into(self.image):
            return False
        self.known = True
        echo = self.status.commandNumEcho
        in_flight = self._in_flight
        while in_flight and in_flight[0] <= echo:
            in_flight.popleft()
        return True

    @property
    def alive(self) -> bool:
        """Does motion still write its status?"""
        return self._sign_of_life.seen()

    @property
    def sent(self) -> int:
        """Number of the last command that was sent, signs of life aside."""
        return self._sent

    @property
    def echoed(self) -> bool:
        """Has motion taken everything that was sent?"""
        return self.status.commandNumEcho >= self._sent

    @property
    def settled(self) -> bool:
        """Has motion taken everything, finished it, and does it stand still?"""
        status = self.status
        return (
            status.commandNumEcho >= self._sent and status.depth == 0 and bool(status.motionFlag & MotionFlag.INPOS)
        )

    @property
    def enabled(self) -> bool:
        """Is the machine on, as motion sees it?"""
        return bool(self.status.motionFlag & MotionFlag.ENABLE)

    @property
    def in_error(self) -> bool:
        """Did a move fail, a probe that found nothing for example?"""
        return bool(self.status.motionFlag & MotionFlag.ERROR)

    @property
    def state(self) -> MotionState:
        """Disabled, free, teleop or coordinated."""
        return MotionState(self.status.motion_state)

    @property
    def all_homed(self) -> bool:
        """Is every joint homed?"""
        joints = self.status.joint_status
        return all(joints[n].homed for n in range(self.status.num_joints))

    @property
    def may_coordinate(self) -> bool:
        """Can the tool be moved along a path? Where an axis is no joint, all joints must be homed for it."""
        return self.all_homed or self.status.kinematics_type == Kinematics.IDENTITY

    @property
    def homing(self) -> bool:
        """Does any joint home?"""
        joints = self.status.joint_status
        return any(joints[n].homing for n in range(self.status.num_joints))

    def room(self) -> int:
        """How many moves may be sent now."""
        return self.status.queueFree - len(self._in_flight) - RESERVE

    def refused(self) -> bool:
        """Did motion refuse the command that it took last? True once for each."""
        status = self.status
        if status.commandStatus == MotCommandStatus.OK or status.commandNumEcho == self._refused:
            return False
        self._refused = status.commandNumEcho
        return True

    @property
    def refused_last(self) -> bool:
        """Did motion take everything that was sent, and refuse the last?"""
        return self.echoed and self.status.commandStatus != MotCommandStatus.OK

    def reconnected(self) -> None:
        """Motion was gone and is back: what was on the way to it is lost."""
        self._in_flight.clear()

    def errors(self) -> list[EMCMOT_ERROR]:
        """The texts that motion wrote since the last call."""
        found: list[EMCMOT_ERROR] = []
        while (error := self._errors.read()) is not None:
            if isinstance(error, EMCMOT_ERROR):
                found.append(error)
        return found

    # --- Commands

    def send(self, command: MotCommand, **fields: Any) -> int:
        """Send a command with these fields, all others zero; its serial number."""
        message = self._command
        message.data[:] = self._blank
        message.command = command
        message.joint = message.axis = message.spindle = 0
        for name, value in fields.items():
            setattr(message, name, value)
        return self._write()

    def send_move(self, move: bytes, **fields: Any) -> None:
        """Send a queued move that was packed with ``MOVE``; counts as a place in the planner's queue."""
        message = self._command
        message.data[:] = self._blank
        message.data[MOVE.offset : MOVE.offset + MOVE.size] = move
        for name, value in fields.items():
            setattr(message, name, value)
        self._in_flight.append(self._write())

    def _write(self) -> int:
        self._sent = self._commands.write(self._command)
        return self._sent

    def beat(self) -> None:
        """Task's cycle goes round: the thread that tells motion so may go on."""
        self._pulse.turn()

    def close(self) -> None:
        """Close the channels."""
        self._pulse.close()
        for channel in (self._commands, self._status, self._errors):
            channel.close()
