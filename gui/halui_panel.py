"""What the buttons of halui do: orders to the machine, with the modes that they need.

A panel never waits for the end of an order: a button that is pressed while another order runs must act at once.
"""

from __future__ import annotations

import math

import linuxcnc

DEFAULT_SPEED = 500.0  # rpm of a spindle that is started before any S word
JOINT, AXIS = 1, 0  # jog flags


class Panel:
    """The machine as a button sees it."""

    def __init__(self, mdi_commands: list[str]) -> None:
        self.status = linuxcnc.stat()
        self.command = linuxcnc.command()
        self.joint = 0  # selected
        self.axis = 0
        self._mdi_commands = mdi_commands
        self._mode_before_mdi: int | None = None

    # --- modes -----------------------------------------------------------------------------------------------------

    @property
    def on(self) -> bool:
        return self.status.task_state == linuxcnc.STATE_ON

    @property
    def homed(self) -> bool:
        return all(self.status.homed[: self.status.joints])

    @property
    def idle(self) -> bool:
        return self.status.interp_state == linuxcnc.INTERP_IDLE

    def mode(self, mode: int) -> None:
        if self.status.task_mode != mode:
            self.command.mode(mode)

    def teleop(self, on: bool) -> None:
        """Jog axes or joints from now on."""
        self.mode(linuxcnc.MODE_MANUAL)
        self.command.teleop_enable(on)

    # --- jogging ---------------------------------------------------------------------------------------------------

    def _ready_to_jog(self, flag: int) -> bool:
        """Whether jogs of this kind are possible now; switches between joints and axes where that is allowed."""
        if not self.on or self.status.task_mode != linuxcnc.MODE_MANUAL:
            return False
        teleop = self.status.motion_mode == linuxcnc.TRAJ_MODE_TELEOP
        if flag == JOINT and teleop:
            return False
        if flag == AXIS and not teleop:
            if not self.homed:
                return False
            self.command.teleop_enable(1)
        return True

    def jog(self, flag: int, index: int, speed: float) -> None:
        """Jog on at ``speed`` machine units per minute; 0 stops."""
        if speed == 0.0:
            self.command.jog(linuxcnc.JOG_STOP, flag, index)
        elif self._ready_to_jog(flag):
            self.command.jog(linuxcnc.JOG_CONTINUOUS, flag, index, speed / 60.0)

    def jog_by(self, flag: int, index: int, speed: float, distance: float) -> None:
        """Jog by a distance; the sign of the distance is the direction."""
        if distance != 0.0 and self._ready_to_jog(flag):
            velocity = math.copysign(abs(speed) / 60.0, distance)
            self.command.jog(linuxcnc.JOG_INCREMENT, flag, index, velocity, abs(distance))

    # --- programs and MDI ------------------------------------------------------------------------------------------

    def run(self) -> None:
        self.mode(linuxcnc.MODE_AUTO)
        self.command.auto(linuxcnc.AUTO_RUN, 0)

    def step(self) -> None:
        self.mode(linuxcnc.MODE_AUTO)
        self.command.auto(linuxcnc.AUTO_STEP)

    def mdi(self, number: int) -> None:
        """Run one of [HALUI]MDI_COMMAND; afterwards the machine returns to the mode that it was in."""
        if not self.on or (self.status.task_mode == linuxcnc.MODE_AUTO and not self.idle):
            return
        if self.status.task_mode != linuxcnc.MODE_MDI:
            self._mode_before_mdi = self.status.task_mode
            self.command.mode(linuxcnc.MODE_MDI)
        self.command.mdi(self._mdi_commands[number])

    def finish_mdi(self) -> None:
        """Go back to the mode from before an MDI command once that is done."""
        status, before = self.status, self._mode_before_mdi
        if before is None or status.echo_serial_number < self.command.serial:
            return
        if status.state != linuxcnc.RCS_EXEC and self.idle and not status.queued_mdi_commands:
            self._mode_before_mdi = None
            if status.task_mode == linuxcnc.MODE_MDI:
                self.command.mode(before)

    # --- spindles --------------------------------------------------------------------------------------------------

    def turn(self, spindle: int, direction: int) -> None:
        """Start a spindle with the speed of the last S word."""
        speed = abs(self.status.settings[2]) or DEFAULT_SPEED
        self.command.spindle(direction, speed, spindle)
