"""What the buttons of halui do: orders to the machine, with the modes that they need.

A panel never waits for the end of an order: a button that is pressed while another order runs must act at once.
"""

from __future__ import annotations

import math

import linuxcnc

JOINT, AXIS = 1, 0  # jog flags


class Panel:
    """The machine as a button sees it."""

    def __init__(self, mdi_commands: list[str], axes: list[int]) -> None:
        self.status = linuxcnc.stat()
        self.command = linuxcnc.command()
        self.command.origin = "halui"
        self.joint = 0  # selected
        self.axis = 0  # selected; X until a button chooses, also where there is no X, as LinuxCNC's
        self.axis_shown = axes[0] if axes else 0  # by the lamps
        self.mdi_runs = False
        self._axes = axes
        self._mdi_commands = mdi_commands
        self._mode_before_mdi = linuxcnc.MODE_MANUAL

    def select_joint(self, number: int) -> None:
        self.joint = number

    def select_axis(self, number: int) -> None:
        """Axes that the machine does not have cannot be selected."""
        if number in self._axes:
            self.axis = self.axis_shown = number

    # --- modes -----------------------------------------------------------------------------------------------------

    def mode(self, mode: int) -> None:
        if self.status.task_mode != mode:
            self.command.mode(mode)

    def teleop(self, on: bool) -> None:
        """Jog axes or joints from now on."""
        self.mode(linuxcnc.MODE_MANUAL)
        self.command.teleop_enable(on)

    # --- jogging ---------------------------------------------------------------------------------------------------

    def _ready_to_jog(self, flag: int, index: int) -> bool:
        """Joints are jogged in joint mode, the axes of the machine in teleop mode."""
        status = self.status
        if status.task_state != linuxcnc.STATE_ON or status.task_mode != linuxcnc.MODE_MANUAL:
            return False
        if flag == JOINT:
            return status.motion_mode == linuxcnc.TRAJ_MODE_FREE
        return index in self._axes and status.motion_mode == linuxcnc.TRAJ_MODE_TELEOP

    def jog(self, flag: int, index: int, speed: float) -> None:
        """Jog on at ``speed`` machine units per minute; 0 stops."""
        if not self._ready_to_jog(flag, index):
            return
        if speed == 0.0:
            self.command.jog(linuxcnc.JOG_STOP, flag, index)
        else:
            self.command.jog(linuxcnc.JOG_CONTINUOUS, flag, index, speed / 60.0)

    def jog_by(self, flag: int, index: int, speed: float, distance: float) -> None:
        """Jog by a distance; the sign of the distance is the direction."""
        if distance != 0.0 and self._ready_to_jog(flag, index):
            velocity = math.copysign(abs(speed) / 60.0, distance)
            self.command.jog(linuxcnc.JOG_INCREMENT, flag, index, velocity, abs(distance))

    # --- programs and MDI ------------------------------------------------------------------------------------------

    def run(self) -> None:
        """Run the program that is open, if there is one."""
        if self.status.file:
            self.mode(linuxcnc.MODE_AUTO)
            self.command.auto(linuxcnc.AUTO_RUN, 0)

    def step(self) -> None:
        self.mode(linuxcnc.MODE_AUTO)
        self.command.auto(linuxcnc.AUTO_STEP)

    def mdi(self, number: int) -> None:
        """Run one of [HALUI]MDI_COMMAND; once all of them are done, the mode is again what it was before."""
        if not self.mdi_runs:
            self.mdi_runs, self._mode_before_mdi = True, self.status.task_mode
        if self.status.task_mode != linuxcnc.MODE_MDI:
            self.command.mode(linuxcnc.MODE_MDI)
            if self.command.wait_complete(0.0) == linuxcnc.RCS_ERROR:
                return
        self.command.mdi(self._mdi_commands[number])

    def finish_mdi(self) -> None:
        """Go back to the mode from before the MDI commands once task has done everything; an error is not done."""
        status = self.status
        if not self.mdi_runs or status.echo_serial_number < self.command.serial:
            return
        if status.state == linuxcnc.RCS_DONE and not status.queued_mdi_commands:
            self.mdi_runs = False
            self.mode(self._mode_before_mdi)

    # --- spindles --------------------------------------------------------------------------------------------------

    def turn(self, spindle: int, direction: int) -> None:
        """Start a spindle with the speed of the last S word, at 1 rpm before any."""
        self.command.spindle(direction, abs(self.status.settings[2]) or 1.0, spindle)

    def change_speed(self, spindle: int, step: int, pressed: bool) -> None:
        """A step when the button is pressed; the speed stays when it is released."""
        self.command.spindle(step if pressed else linuxcnc.SPINDLE_CONSTANT, spindle)
