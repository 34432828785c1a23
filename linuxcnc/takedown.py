"""Brings a machine to rest and ends its processes, whichever still live; used by the launcher and by its guard."""

from __future__ import annotations

from collections.abc import Callable

import nml.emc as emc
from linuxcnc.instance import ProcessRecord, end_processes
from nml import clock
from nml.channel import Channel
from nml.emc.constants import EMC_TASK_STATE_ENUM
from nml.emc.emcmot import EMCMOT_COMMAND, EMCMOT_STATUS, MotCommand
from nml.errors import PyemcError

REST_TIMEOUT = 10.0  # host seconds that a machine gets to come to rest
REACTION_TIMEOUT = 1.0  # host seconds until a living process must react
STILL = 1e-9  # lu/s or deg/s, a joint at rest

# Who is ended together, first stage first; what is not named here ends with the displays
STAGES = (("task",), ("halui", "io"), ("host", "server"))


def bring_to_rest(records: list[ProcessRecord], nml_file: str | None) -> str | None:
    """Stop motion under its limits and switch the machine off; a text says why that could not be done."""
    alive = {record.name for record in records if record.alive}
    if "host" not in alive:
        return None if "task" not in alive else "the realtime host is gone; the motors stopped where they were"
    try:
        motion = Channel(nml_file, "emcmotStatus", "xemc")
        if motion.age() is None:
            return None  # motion was never loaded
        stop, off = (_through_task if "task" in alive else _through_motion)(nml_file)
        stop()
        if not _wait_for_rest(motion):
            return f"the machine did not come to rest within {REST_TIMEOUT:g} s"
        off()
    except (PyemcError, OSError) as reason:
        return f"no controlled stop: {reason}"
    return None


def _through_task(nml_file: str | None) -> tuple[Callable[[], None], Callable[[], None]]:
    commands = Channel(nml_file, "emcCommand", "xemc")
    status = Channel(nml_file, "emcStatus", "xemc")

    def stop() -> None:
        commands.write(emc.EMC_TASK_ABORT())

    def off() -> None:
        commands.write(emc.EMC_TASK_SET_STATE(state=EMC_TASK_STATE_ENUM.ESTOP))
        deadline = clock.host_now() + REACTION_TIMEOUT
        while clock.host_now() < deadline:
            message = status.peek()
            if isinstance(message, emc.EMC_STAT) and message.task.state != EMC_TASK_STATE_ENUM.ON:
                return
            status.wait(deadline - clock.host_now())

    return stop, off


def _through_motion(nml_file: str | None) -> tuple[Callable[[], None], Callable[[], None]]:
    """Task is gone, so the launcher may be the one writer of emcmotCommand."""
    commands = Channel(nml_file, "emcmotCommand", "emc")

    def stop() -> None:
        commands.write(EMCMOT_COMMAND(command=MotCommand.ABORT))

    def off() -> None:
        commands.write(EMCMOT_COMMAND(command=MotCommand.DISABLE))

    return stop, off


def _wait_for_rest(motion: Channel) -> bool:
    """Whether every joint stands still, or the servo thread does no longer run, before the time is over."""
    deadline = clock.host_now() + REST_TIMEOUT
    # The command just written is taken in the next period: look from the status after that one on
    for _ in range(3):
        motion.wait(REACTION_TIMEOUT)
        motion.peek()
    while clock.host_now() < deadline:
        if not motion.wait(REACTION_TIMEOUT):
            return True
        status = motion.peek()
        if isinstance(status, EMCMOT_STATUS) and _at_rest(status):
            return True
    return False


def _at_rest(status: EMCMOT_STATUS) -> bool:
    return all(abs(status.joint_status[number].vel_cmd) < STILL for number in range(status.num_joints))


def end_all(records: list[ProcessRecord]) -> list[ProcessRecord]:
    """End the processes, each stage before the next; returns those that had to be killed."""
    staged = {name for stage in STAGES for name in stage}
    killed = end_processes([record for record in records if record.name not in staged])
    for stage in STAGES:
        killed += end_processes([record for record in records if record.name in stage])
    return killed
