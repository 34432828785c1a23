"""``import linuxcnc_util``: waits and jogs for scripts that drive a machine, with the names of LinuxCNC's module."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import linuxcnc
from nml import clock

AXES = "xyzabcuvw"
TOLERANCE = 0.0001  # machine units
STILL_FOR = 0.1  # host seconds without movement that count as a stop


class LinuxCNC_Exception(RuntimeError):
    """Something did not happen in time."""


class LinuxCNC:
    """A machine, and what a script waits for; every wait polls ``status`` and raises LinuxCNC_Exception at its end."""

    def __init__(
        self,
        command: linuxcnc.command | None = None,
        status: linuxcnc.stat | None = None,
        error: linuxcnc.error_channel | None = None,
    ) -> None:
        self.command = command or linuxcnc.command()
        self.status = status or linuxcnc.stat()
        self.error = error or linuxcnc.error_channel()

    def _wait(self, condition: Callable[[], object], what: str, timeout: float) -> None:
        deadline = clock.host_now() + timeout
        while True:
            self.status.poll()
            if condition():
                return
            left = deadline - clock.host_now()
            if left <= 0.0:
                raise LinuxCNC_Exception(f"{what}: not within {timeout:g} s")
            self.status.wait(min(left, 0.05))

    def _axis(self, axis_letter: str) -> int:
        return AXES.index(axis_letter.lower())

    def wait_for_linuxcnc_startup(self, timeout: float = 10.0) -> None:
        """Wait until task has filled the status and waits for its first command."""
        status = self.status

        def filled() -> bool:
            settings = (status.axis_mask, status.cycle_time, status.linear_units, status.angular_units)
            limits = (status.max_velocity, status.max_acceleration, status.program_units, status.rapidrate)
            resting = status.exec_state == linuxcnc.EXEC_DONE and status.interp_state == linuxcnc.INTERP_IDLE
            return all(settings) and all(limits) and resting and status.inpos

        self._wait(filled, "start of the machine", timeout)

    def all_joints_homed(self, joints: Sequence[int]) -> bool:
        """Whether each joint is homed whose place in ``joints`` holds a true value."""
        self.status.poll()
        return all(self.status.homed[number] for number, wanted in enumerate(joints) if wanted)

    def wait_for_home(self, joints: Sequence[int], timeout: float = 10.0) -> None:
        """Wait until those joints are homed, as `all_joints_homed` counts them."""
        self._wait(lambda: self.all_joints_homed(joints), "homing", timeout)

    def wait_for_axis_to_stop(self, axis_letter: str, timeout: float = 10.0) -> None:
        """Wait until an axis has stood still for a moment."""
        index = self._axis(axis_letter)
        position, since = self.status.position[index], clock.host_now()

        def still() -> bool:
            nonlocal position, since
            now = self.status.position[index]
            if now != position:
                position, since = now, clock.host_now()
            return clock.host_now() - since >= STILL_FOR

        self._wait(still, f"axis {axis_letter} to stop", timeout)

    def wait_for_axis_to_stop_at(
        self, axis_letter: str, target: float, timeout: float = 10.0, tolerance: float = TOLERANCE
    ) -> None:
        """Wait until an axis stands still at ``target``."""
        index = self._axis(axis_letter)
        self._wait(
            lambda: abs(self.status.position[index] - target) < tolerance and self.status.current_vel == 0.0,
            f"axis {axis_letter} to stop at {target:g}",
            timeout,
        )

    def jog_axis(self, axis_letter: str, target: float, vel: float = 5.0, timeout: float = 10.0) -> None:
        """Jog an axis to a position at ``vel`` machine units per s and wait until it stands there."""
        index = self._axis(axis_letter)
        self.status.poll()
        distance = target - self.status.position[index]
        velocity = abs(vel) if distance > 0.0 else -abs(vel)
        self.command.jog(linuxcnc.JOG_INCREMENT, False, index, velocity, abs(distance))
        self.wait_for_axis_to_stop_at(axis_letter, target, timeout)

    def wait_for_interp_state(self, target_state: int, timeout: float = 10.0) -> None:
        """Wait for INTERP_IDLE, INTERP_READING, INTERP_PAUSED or INTERP_WAITING."""
        self._wait(lambda: self.status.interp_state == target_state, f"interpreter state {target_state}", timeout)

    def wait_for_tool_in_spindle(self, expected_tool: int, timeout: float = 10.0) -> None:
        """Wait until a tool is loaded."""
        self._wait(lambda: self.status.tool_in_spindle == expected_tool, f"tool {expected_tool}", timeout)
