"""A client at the desk of a whole machine: gives commands, waits for their end, notes every text for the operator."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import linuxcnc
from tests.support.machine import PATIENCE, copy_mill, running, wait_until

SPEED = 5.0
DONE, ERROR = linuxcnc.RCS_DONE, linuxcnc.RCS_ERROR
TOOLS = "T1 P1 D3 Z1\nT2 P2 D6 Z-12.5\n"


def switched_on_and_homed() -> tuple[linuxcnc.stat, linuxcnc.command]:
    """Channels to the machine of this namespace, once it is on and homed."""
    status, command = linuxcnc.stat(), linuxcnc.command()
    command.state(linuxcnc.STATE_ESTOP_RESET)
    command.state(linuxcnc.STATE_ON)
    wait_until(lambda: status.poll() or status.task_state == linuxcnc.STATE_ON, "machine on")
    command.home(-1)
    wait_until(lambda: status.poll() or all(status.homed[: status.joints]), "home")
    return status, command


class Desk:
    """A client that notes every text for the operator."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.stat, self.command, self.errors = linuxcnc.stat(), linuxcnc.command(), linuxcnc.error_channel()
        self.texts: list[str] = []

    def do(self, method, *arguments, timeout: float = PATIENCE) -> int:
        """Give a command and wait for its end."""
        method(*arguments)
        result = self.command.wait_complete(timeout)
        self.look()
        return result

    def look(self) -> linuxcnc.stat:
        self.stat.poll()
        while (message := self.errors.poll()) is not None:
            self.texts.append(message[1])
        return self.stat

    def mdi(self, line: str) -> int:
        return self.do(self.command.mdi, line)

    def until(self, condition, what: str) -> None:
        wait_until(lambda: condition(self.look()), what)

    def ready(self, mode: int) -> None:
        """On, homed, in this mode."""
        assert self.do(self.command.state, linuxcnc.STATE_ESTOP_RESET) == DONE
        assert self.do(self.command.state, linuxcnc.STATE_ON) == DONE
        assert self.do(self.command.home, -1) == DONE
        assert self.stat.homed[:3] == (1, 1, 1)
        assert self.do(self.command.mode, mode) == DONE

    def program(self, text: str) -> None:
        """Open a program; auto mode."""
        path = self.folder / "part.ngc"
        path.write_text(text)
        assert self.do(self.command.mode, linuxcnc.MODE_AUTO) == DONE
        assert self.do(self.command.program_open, str(path)) == DONE

    def run(self) -> None:
        self.command.auto(linuxcnc.AUTO_RUN, 0)


@contextmanager
def at_desk(
    folder: Path, *, changes: dict[str, str] | None = None, tools: str = TOOLS, hal: str = ""
) -> Iterator[Desk]:
    """The simulated mill with these tools and INI lines, running."""
    ini = copy_mill(folder, changes=changes, hal=hal)
    (folder / "mill_mm.tbl").write_text(tools)
    with running(ini, speed=SPEED) as run:
        run.port()
        yield Desk(folder)
