"""The command ``milltask -ini FILE``: the task controller, one process of a machine."""

from __future__ import annotations

import argparse
import logging
import os
import signal
import sys
from collections.abc import Callable, Sequence

from emctask.callstacks import CallStacks
from emctask.config import MachineConfig, read_config
from emctask.inipins import IniPins
from emctask.ioclient import IoClient
from emctask.motion import MotionClient
from emctask.operatorline import OperatorLine
from emctask.setup import configure_motion
from emctask.status import StatusWriter
from emctask.task import Task
from nml import clock
from nml.channel import Channel
from nml.config import NmlConfig
from nml.emc.calls import CALLS_BUFFER
from nml.errors import ConfigError, PyemcError
from nml.inifile import IniFile

START_TIMEOUT_S = 120.0  # host time for motion and io to appear: HAL files may wait for hardware

stopping = False


def main(arguments: Sequence[str] | None = None) -> int:
    """Run task until SIGTERM or a halt command; the exit code."""
    parser = argparse.ArgumentParser(prog="milltask", description=__doc__)
    parser.add_argument("-ini", metavar="FILE", default=os.environ.get("INI_FILE_NAME"), help="the machine's INI file")
    options = parser.parse_args(arguments)
    if not options.ini:
        print("milltask: no INI file; give -ini FILE or set INI_FILE_NAME", file=sys.stderr)
        return 1
    os.environ["INI_FILE_NAME"] = options.ini
    logging.basicConfig(stream=sys.stderr, format="task: %(message)s", level=logging.WARNING)
    signal.signal(signal.SIGTERM, _stop)
    signal.signal(signal.SIGINT, _stop)
    try:
        ini = IniFile(options.ini)
        task = build(ini, read_config(ini))
    except PyemcError as error:
        print(error, file=sys.stderr)
        return 1
    try:
        task.run(lambda: stopping)
    finally:
        task.close()
    return 0


def _stop(number: int, frame: object) -> None:
    global stopping
    stopping = True


def build(ini: IniFile, config: MachineConfig) -> Task:
    """Connect to everybody, configure motion, start the interpreter; PyemcError when that does not work."""
    nml = NmlConfig.load()
    pins = IniPins(config)

    def channel(buffer: str) -> Channel:
        return Channel(nml, buffer, process="emc")

    motion = MotionClient(channel("emcmotCommand"), channel("emcmotStatus"), channel("emcmotError"), config.heartbeat_s)
    io = IoClient(channel("toolCmd"), channel("toolSts"), channel("toolTable"))
    _wait_until(lambda: motion.poll() or motion.known, "motion does not answer: is motmod loaded, its thread started?")
    _wait_until(lambda: io.poll() or io.known, "io does not answer: is it running?")
    configure_motion(motion, config)
    errors = channel("emcError")
    task = Task(
        config,
        ini,
        channel("emcCommand"),
        motion,
        io,
        StatusWriter(config, channel("emcStatus"), CallStacks(channel(CALLS_BUFFER))),
        OperatorLine(errors, Channel.connect(errors.line, nml.observer("emcError"))),
        channel("emcResults"),
        pins,
    )
    task.plan.startup(config.startup_code)
    return task


def _wait_until(arrived: Callable[[], bool], complaint: str) -> None:
    deadline = clock.host_now() + START_TIMEOUT_S
    while not arrived():
        if stopping:
            raise ConfigError("stopped before the machine was up")
        if clock.host_now() > deadline:
            raise ConfigError(complaint)
        clock.host_sleep(0.005)


if __name__ == "__main__":
    sys.exit(main())
