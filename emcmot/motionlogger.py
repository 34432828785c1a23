"""``motion-logger [LOGFILE]``: stands in for motion and writes down each command that task gives it.

A user component for tests of task: ``loadusr -W motion-logger out.txt`` in the place of motmod and kinematics. Behind
it the stepped simulator moves, as fast as it can, so every order is done at once. The lines are LinuxCNC's; commands
that LinuxCNC 2.9 has not are obeyed but not written. ``motion-logger.reopen-log`` closes the file, and falls then; a
new one begins with the next command.
"""

from __future__ import annotations

import signal
import sys
from pathlib import Path
from typing import TextIO

import hal
from emcmot.commandlog import describe
from emcmot.sim import Motion
from nml.channel import Channel
from nml.emc.emcmot import EMCMOT_COMMAND, EMCMOT_ERROR, MotCommand
from nml.errors import PyemcError

C = MotCommand
LETTERS = "xyzabcuvw"
PATIENCE_S = 0.02  # host time between two statuses when there is nothing to do
PERIODS = 5000  # servo periods between two looks for commands


class Logger:
    """The component with its three buffers."""

    def __init__(self, path: Path | None) -> None:
        self._path = path
        self._file: TextIO | None = None
        self._commands, self._status, self._errors = (
            Channel(None, name, "emcmot") for name in ("emcmotCommand", "emcmotStatus", "emcmotError")
        )
        self._motion = _machine(len(LETTERS))
        self._pins = hal.component("motion-logger")
        self._pins.newpin("reopen-log", hal.HAL_BIT, hal.HAL_IO)
        self._pins.ready()

    def _write(self, text: str) -> None:
        """Append to the file, which is made for its first line: whoever had it closed may have renamed it since."""
        if self._file is None:
            self._file = sys.stdout if self._path is None else self._path.open("w")
        print(text, file=self._file, flush=True)

    def _close_file(self) -> None:
        if self._file is not None and self._path is not None:
            self._file.close()
        self._file = None

    def turn(self) -> None:
        """Take what has come, let the machine move, publish how it stands."""
        if self._pins["reopen-log"]:
            self._close_file()
            self._pins["reopen-log"] = False
        while (command := self._commands.read()) is not None:
            assert isinstance(command, EMCMOT_COMMAND)
            self._take(command)
        self._motion.step(PERIODS)
        for text in self._motion.errors():
            self._errors.write(EMCMOT_ERROR(text=text))
        self._status.write(self._motion.status)
        self._commands.wait(PATIENCE_S)

    def _take(self, command: EMCMOT_COMMAND) -> None:
        if text := describe(command):
            self._write(text)
        if command.command == C.SET_NUM_JOINTS and command.joint > 0:
            self._motion = _machine(command.joint)
        if command.command != C.SET_HEARTBEAT_TIMEOUT:  # simulated time runs ahead of task's
            self._motion.send_bytes(bytes(command.data))

    def close(self) -> None:
        """Let go of everything."""
        for channel in (self._commands, self._status, self._errors):
            channel.close()
        self._pins.exit()
        self._close_file()


def _machine(joints: int) -> Motion:
    """A machine whose joints are axes, with all spindles, inputs and outputs that there may be."""
    letters = LETTERS[:joints] + LETTERS[0] * (joints - len(LETTERS))
    return Motion(letters, num_spindles=8, num_dio=64, num_aio=64)


def main() -> int:
    """Run until SIGTERM or SIGINT; the exit code."""
    if len(sys.argv) > 2 or sys.argv[1:2] in (["-h"], ["--help"]):
        print("usage: motion-logger [LOGFILE]", file=sys.stderr)
        return 1
    ended: list[int] = []
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda number, frame: ended.append(number))
    try:
        logger = Logger(Path(sys.argv[1]) if len(sys.argv) == 2 else None)
    except (PyemcError, OSError) as error:
        print(f"motion-logger: {error}", file=sys.stderr)
        return 1
    try:
        while not ended:
            logger.turn()
    finally:
        logger.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
