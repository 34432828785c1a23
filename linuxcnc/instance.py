"""One running machine per namespace: its lock, the record of its processes, and the removal of what it leaves.

The launcher holds an ``flock`` on ``lock`` in the namespace's runtime folder, together with its guard (see ``guard``),
so the lock is free exactly when both are gone. Beside it ``processes`` lists every process that was started, one line
``pid start-time name`` each; who gets the lock finds there what a killed earlier run left alive. The start time (field
22 of /proc/PID/stat) tells a process from a later one with the same number.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import shutil
import signal
from dataclasses import dataclass
from pathlib import Path

from hal.process import alive, start_time
from linuxcnc.systempython import LINKS
from nml import clock, namespace
from nml.errors import PyemcError

HAND_OVER = 20.0  # host seconds that a killed launcher's guard may need to stop its machine
POLL = 0.02  # host seconds between looks at a lock or a process that is ending
GRACE = 2.0  # host seconds from SIGTERM to SIGKILL
SHM_FOLDER = Path("/dev/shm")


class AlreadyRunning(PyemcError):
    """The namespace has a running machine."""


@dataclass(frozen=True, slots=True)
class ProcessRecord:
    """One started process."""

    pid: int
    started: int  # clock ticks since boot
    name: str

    @classmethod
    def of(cls, pid: int, name: str) -> ProcessRecord:
        return cls(pid, start_time(pid), name)

    @classmethod
    def parse(cls, line: str) -> ProcessRecord | None:
        parts = line.split(maxsplit=2)
        if len(parts) != 3 or not (parts[0].isdecimal() and parts[1].isdecimal()):
            return None
        return cls(int(parts[0]), int(parts[1]), parts[2])

    @property
    def alive(self) -> bool:
        """Whether this very process still runs; a zombie does not."""
        return alive(self.pid, self.started)

    def signal(self, number: int) -> None:
        if self.alive:
            with contextlib.suppress(ProcessLookupError):
                os.kill(self.pid, number)

    def __str__(self) -> str:
        return f"{self.pid} {self.started} {self.name}"


def wait_for_end(records: list[ProcessRecord], timeout: float) -> list[ProcessRecord]:
    """Wait up to ``timeout`` host seconds for processes to end; returns those that still run."""
    deadline = clock.host_now() + timeout
    while True:
        left = [record for record in records if record.alive]
        if not left or clock.host_now() >= deadline:
            return left
        clock.host_sleep(POLL)


def end_processes(records: list[ProcessRecord], grace: float = GRACE) -> list[ProcessRecord]:
    """SIGTERM, then SIGKILL after ``grace`` host seconds; returns those that had to be killed."""
    for record in records:
        record.signal(signal.SIGTERM)
    stubborn = wait_for_end(records, grace)
    for record in stubborn:
        record.signal(signal.SIGKILL)
    wait_for_end(stubborn, grace)
    return stubborn


class Instance:
    """The lock on the namespace; ``AlreadyRunning`` when it is taken."""

    def __init__(self) -> None:
        self.folder = namespace.runtime_dir()
        self._path = self.folder / "lock"
        self._record_path = self.folder / "processes"
        self._file = self._acquire()
        self.leftovers = self.recorded()

    def _acquire(self) -> int:
        """Take the lock, waiting while the guard of a killed launcher still stops its machine."""
        deadline = clock.host_now() + HAND_OVER
        while True:
            self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            file = os.open(self._path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                owner = ProcessRecord.parse(os.pread(file, 200, 0).decode(errors="replace"))
                os.close(file)
                if (owner and owner.alive) or clock.host_now() > deadline:
                    who = f"process {owner.pid}" if owner else "an unknown process"
                    raise AlreadyRunning(
                        f"namespace {namespace.namespace()!r} is already running ({who}); "
                        "stop it or choose another with --namespace"
                    ) from None
                clock.host_sleep(POLL)
                continue
            if self._is_current(file):
                self._sign(file)
                return file
            os.close(file)

    def _sign(self, file: int) -> None:
        """Note whose the lock is."""
        os.ftruncate(file, 0)
        try:
            os.pwrite(file, str(ProcessRecord.of(os.getpid(), "linuxcnc")).encode(), 0)
        except OSError as reason:
            raise OSError(reason.errno, reason.strerror, str(self._path)) from None

    def _is_current(self, file: int) -> bool:
        """Whether the locked file is still the one of that name; a former owner may have removed it meanwhile."""
        try:
            return os.path.samestat(os.fstat(file), os.stat(self._path))
        except FileNotFoundError:
            return False

    def recorded(self) -> list[ProcessRecord]:
        """The processes of the record that still run."""
        try:
            lines = self._record_path.read_text().splitlines()
        except FileNotFoundError:
            return []
        return [record for line in lines if (record := ProcessRecord.parse(line)) and record.alive]

    def remove_leftovers(self) -> list[ProcessRecord]:
        """End what an earlier run left alive and remove its shared memory; returns the processes that were ended."""
        end_processes(self.leftovers)
        remove_shared_memory()
        self._record_path.unlink(missing_ok=True)
        ended, self.leftovers = self.leftovers, []
        return ended

    def add(self, record: ProcessRecord) -> None:
        """Note a process that was started."""
        with self._record_path.open("a") as file:
            file.write(f"{record}\n")

    def release(self) -> None:
        """Remove every trace of the namespace and give the lock back."""
        remove_shared_memory()
        shutil.rmtree(self.folder / LINKS, ignore_errors=True)
        for path in self.folder.iterdir():
            if path != self._path and not path.is_dir():
                path.unlink(missing_ok=True)
        self._path.unlink(missing_ok=True)
        with contextlib.suppress(OSError):
            self.folder.rmdir()
        os.close(self._file)


def remove_shared_memory() -> None:
    """Remove every shared-memory object of this namespace."""
    prefix = namespace.shm_name("").lstrip("/")
    for path in SHM_FOLDER.glob(f"*{prefix}*"):
        if path.name.removeprefix("sem.").startswith(prefix):
            path.unlink(missing_ok=True)
