"""The launcher's guard: a forked twin that ends the machine when the launcher is killed and cannot do it itself.

Both share the instance's lock and a pipe. The launcher writes one byte before a proper end; an end of the pipe without
it means that the launcher died, and the guard brings the machine to rest, ends its processes and removes every trace.
"""

from __future__ import annotations

import contextlib
import os
import signal

from linuxcnc import takedown
from linuxcnc.instance import Instance
from linuxcnc.process import show_as
from nml import signals

DISMISSED = b"."


class Guard:
    """Started and watched by the launcher; ``dismiss`` before a proper end."""

    def __init__(self, instance: Instance, nml_file: str | None) -> None:
        self._instance = instance
        self._nml_file = nml_file
        self._start()

    def _start(self) -> None:
        read_end, self._write_end = os.pipe()
        with signals.held():
            self.pid = os.fork()
            if self.pid == 0:
                os.close(self._write_end)
                self._watch(read_end)
        os.close(read_end)

    def _watch(self, read_end: int) -> None:
        """In the twin: wait for the launcher's end; never returns."""
        try:
            os.setsid()
            show_as(["linuxcnc-guard"])
            signals.ignore()
            signal.signal(signal.SIGQUIT, signal.SIG_IGN)
            if os.read(read_end, 1) != DISMISSED:
                records = self._instance.recorded()
                takedown.bring_to_rest(records, self._nml_file)
                takedown.end_all(records)
                self._instance.release()
        finally:
            os._exit(0)

    def keep(self) -> None:
        """Replace a guard that died."""
        with contextlib.suppress(ChildProcessError):
            if os.waitpid(self.pid, os.WNOHANG) == (0, 0):
                return
        os.close(self._write_end)
        self._start()

    def dismiss(self) -> None:
        """The launcher ends properly: the guard goes first."""
        with contextlib.suppress(BrokenPipeError):
            os.write(self._write_end, DISMISSED)
        os.close(self._write_end)
        with contextlib.suppress(ChildProcessError):
            os.waitpid(self.pid, 0)
