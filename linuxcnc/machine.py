"""The processes of one machine: started in their order, watched, and taken down together."""

from __future__ import annotations

import math
import os
import shlex
import sys
from collections.abc import Callable
from pathlib import Path

import linuxcnc
from hal._shm import USER
from hal.client import log_path
from linuxcnc import takedown
from linuxcnc.configuration import Configuration
from linuxcnc.guard import Guard
from linuxcnc.halsetup import SetupSession, set_up
from linuxcnc.instance import Instance, ProcessRecord
from linuxcnc.options import Talk
from linuxcnc.process import Child, Log, start
from linuxcnc.programs import Command
from nml import clock, signals
from nml.channel import Channel
from nml.errors import PyemcError

START_TIMEOUT = 15.0  # host seconds until a process must be ready
POLL = 0.002  # host seconds between looks at a condition


class MachineError(PyemcError):
    """The machine does not start, or lost a process; the text is for the user."""


class Machine:
    """All processes of one configuration; use as a context manager, whose end stops and ends everything."""

    def __init__(self, configuration: Configuration, report: Callable[[str], None], talk: Talk = Talk.PROBLEMS) -> None:
        self.configuration = configuration
        self.report = report
        self.talk = talk
        self.children: list[Child] = []
        self._beside: list[Child] = []  # programs that the machine can do without
        self._applications_due = math.inf  # host time
        self._nml_file = str(configuration.nml_file) if configuration.nml_file else None
        self._environment = configuration.environment()
        os.environ.update(self._environment)
        linuxcnc.nmlfile = self._nml_file or linuxcnc.nmlfile
        self._instance = Instance()
        for record in self._instance.remove_leftovers():
            report(f"ended {record.name} (process {record.pid}) of an earlier run that was killed")
        self._guard = Guard(self._instance, self._nml_file)
        self._session = SetupSession(configuration.ini, configuration.overrides.keep_going)
        self._session.echo = talk >= Talk.COMMANDS
        self._session.host.tells = False
        self._host_log: Log | None = None
        self._host_record: ProcessRecord | None = None
        self._hal_is_set_up = False

    def __enter__(self) -> Machine:
        return self

    def __exit__(self, *exc_info: object) -> None:
        self.stop()

    # --- starting --------------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Start everything but the display and wait until task is ready."""
        configuration = self.configuration
        self._record_host(self._session.host.start())
        self._host_log = Log(log_path())
        self._spawn("task", configuration.task)
        self._spawn("io", configuration.io)
        if configuration.halui is not None:
            self._spawn("halui", configuration.halui)
        if configuration.server is not None:
            self._spawn("server", configuration.server)
        self.wait_until(self._host_runs, "the realtime host")
        self.wait_until(self._component_ready("iocontrol"), "io")
        if configuration.halui is not None:
            self.wait_until(self._component_ready("halui"), "halui")
        set_up(self._session, configuration)
        self._hal_is_set_up = True
        self._record_user_components()
        status = Channel(self._nml_file, "emcStatus", "xemc")
        self.wait_until(lambda: status.peek() is not None, "task")
        self._beside = [self._spawn(name, command) for name, command in configuration.services().items()]
        self._applications_due = clock.host_now() + configuration.application_delay

    def start_display(self) -> Child:
        """Start the display that the INI names, in the foreground."""
        display = self._spawn("display", self.configuration.display(), foreground=True)
        self.children.remove(display)
        return display

    def _start_applications(self) -> None:
        """Each [APPLICATIONS]APP; the machine goes on without one that is missing."""
        self._applications_due = math.inf
        for number in range(1, len(self.configuration.ini.findall("APPLICATIONS", "APP")) + 1):
            try:
                command = self.configuration.programs.application(number)
                self._beside.append(self._spawn(f"application-{number}", command))
            except (PyemcError, OSError) as reason:
                self.report(f"{reason}; the machine goes on without it")

    def _spawn(self, name: str, command: Command, *, foreground: bool = False) -> Child:
        """Start one process of this machine."""
        if self.talk >= Talk.COMMANDS:
            self.report(f"starting {name}: {shlex.join(command.words)}")
        elif self.talk >= Talk.STEPS:
            self.report(f"starting {name}")
        child = start(name, command, self.configuration.folder, self._instance.folder, foreground=foreground)
        self._instance.add(ProcessRecord.of(child.process.pid, name))
        self.children.append(child)
        return child

    def _host_runs(self) -> bool:
        """Whether the realtime host has registered."""
        pid, alive = self._session.hal.host_state()
        if alive and self._host_record is None:
            self._record_host(pid)
        return alive

    def _record_host(self, pid: int | None) -> None:
        if pid is not None:
            self._host_record = ProcessRecord.of(pid, "host")
            self._instance.add(self._host_record)

    def _component_ready(self, name: str) -> Callable[[], bool]:
        def ready() -> bool:
            component = self._session.hal.segment.find_comp(name)
            return component is not None and component.ready

        return ready

    def _record_user_components(self) -> None:
        """Programs that HAL files started belong to the machine and end with it."""
        known = {child.process.pid for child in self.children} | {os.getpid()}
        for component in self._session.hal.segment.comps():
            if component.kind == USER and component.pid not in known:
                known.add(component.pid)
                self._instance.add(ProcessRecord.of(component.pid, component.name))

    def wait_until(self, condition: Callable[[], bool], what: str) -> None:
        """Wait for a condition while all processes live; MachineError after START_TIMEOUT."""
        deadline = clock.host_now() + START_TIMEOUT
        while not condition():
            self.check()
            if clock.host_now() > deadline:
                raise MachineError(f"{what} is not ready after {START_TIMEOUT:g} s")
            clock.host_sleep(POLL)

    # --- watching --------------------------------------------------------------------------------------------------

    def check(self) -> None:
        """Pass on what the processes say; MachineError when one of them has ended, Stopped when a signal came."""
        signals.check()
        self._guard.keep()
        self._tell_of_host()
        if self._host_record is not None and not self._host_record.alive:
            raise MachineError(f"the realtime host (process {self._host_record.pid}) died")
        if clock.host_now() >= self._applications_due:
            self._start_applications()
        ended = [child for child in self.children if child.process.poll() is not None]
        for child in [child for child in ended if child in self._beside]:
            self._do_without(child)
            ended.remove(child)
        if not ended:
            for child in self.children:
                for line in child.new_output():
                    self.report(line)
            return
        child = ended[0]
        for line in child.new_output():
            self.report(line)
        raise MachineError(child.farewell())

    def _tell_of_host(self) -> None:
        """Pass on what the realtime host and its components say."""
        for line in self._host_log.new_lines() if self._host_log else []:
            self.report(line)

    def _do_without(self, service: Child) -> None:
        """A program beside the machine has ended; the machine goes on."""
        for line in service.new_output():
            self.report(line)
        if service.process.returncode:
            self.report(f"{service.farewell() or f'{service.name} ended'}; the machine goes on without it")
        self.children.remove(service)
        self._beside.remove(service)

    # --- stopping --------------------------------------------------------------------------------------------------

    def stop(self) -> None:
        """Bring the machine to rest, end every process, remove every trace; no signal interrupts it."""
        signals.ignore()
        self._tell_of_host()
        for service in self._beside:
            for line in service.new_output():
                self.report(line)
        records = self._instance.recorded()
        records += self._programs_of_hal_files(records)
        problem = takedown.bring_to_rest(records, self._nml_file)
        if problem:
            self.report(problem)
        self._shut_down_hal()
        for record in takedown.end_all(records):
            self.report(f"{record.name} (process {record.pid}) did not end and was killed")
        for child in self.children:
            child.process.wait()
        self._session.close()
        self._guard.dismiss()
        self._instance.release()

    def _programs_of_hal_files(self, known: list[ProcessRecord]) -> list[ProcessRecord]:
        """What HAL files started and what is no component, or not yet one, when the end comes."""
        pids = map(int, Path(f"/proc/self/task/{os.getpid()}/children").read_text().split())
        others = set(pids) - {record.pid for record in known} - {self._guard.pid}
        return [record for pid in others if (record := ProcessRecord.of(pid, "program")).alive]

    def _shut_down_hal(self) -> None:
        """[HAL]SHUTDOWN, where the start came as far as the HAL files; a mistake in it is only reported."""
        file = self.configuration.shutdown
        if file is None or not self._hal_is_set_up:
            return
        try:
            os.chdir(self.configuration.folder)
            self._session.run_file(file.path, file.arguments)
        except (PyemcError, OSError) as reason:
            self.report(str(reason))


def to_stderr(line: str) -> None:
    """The plain way to report."""
    print(line, file=sys.stderr, flush=True)
