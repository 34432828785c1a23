"""PLAN: programs and MDI lines. Manual, chapter 4.7."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emctask.commandtable import AUTO, READING, PassedOver, Refused, command
from nml.emc import (
    EMC_TASK_PLAN_CLOSE,
    EMC_TASK_PLAN_END,
    EMC_TASK_PLAN_EXECUTE,
    EMC_TASK_PLAN_FORWARD,
    EMC_TASK_PLAN_INIT,
    EMC_TASK_PLAN_OPEN,
    EMC_TASK_PLAN_OPTIONAL_STOP,
    EMC_TASK_PLAN_PAUSE,
    EMC_TASK_PLAN_READ,
    EMC_TASK_PLAN_RESUME,
    EMC_TASK_PLAN_REVERSE,
    EMC_TASK_PLAN_RUN,
    EMC_TASK_PLAN_SET_BLOCK_DELETE,
    EMC_TASK_PLAN_SET_OPTIONAL_STOP,
    EMC_TASK_PLAN_STEP,
    EMC_TASK_PLAN_SYNCH,
)
from nml.emc.constants import EMC_TASK_INTERP_ENUM as Interp
from nml.emc.constants import EMC_TASK_MODE_ENUM as Mode
from nml.emc.emcmot import MotCommand
from nml.errors import PyemcError
from nml.message import Message

if TYPE_CHECKING:
    from emctask.task import Task


def _must_be_homed(task: Task, what: str) -> None:
    if not task.config.no_force_homing and not task.motion.all_homed:
        raise Refused(f"Can't {what} when not homed")


def _set_optional_stop(task: Task, on: bool) -> None:
    task.optional_stop = task.canon.optional_stop = on


def _set_block_delete(task: Task, on: bool) -> None:
    task.block_delete = task.canon.block_delete = on


@command(EMC_TASK_PLAN_OPEN, idle=True)
def open_program(task: Task, message: EMC_TASK_PLAN_OPEN) -> None:
    """Load a program."""
    try:
        task.plan.open(message.file)
    except (PyemcError, OSError) as error:
        raise Refused(f"can't open {message.file}: {error}") from None


@command(EMC_TASK_PLAN_CLOSE, idle=True)
def close_program(task: Task, message: EMC_TASK_PLAN_CLOSE) -> None:
    """Forget the program."""
    task.plan.close()


def _refusal_to_run(mode: Mode) -> type[Refused]:
    return PassedOver if mode is Mode.MANUAL else Refused


@command(EMC_TASK_PLAN_RUN, on=True, modes=AUTO, idle=True, refusal=_refusal_to_run)
def run(task: Task, message: EMC_TASK_PLAN_RUN) -> None:
    """Run the loaded program from a line; below 0: only check it."""
    if not task.plan.open_file:
        raise Refused("File not open")
    _must_be_homed(task, "run a program")
    task.runner.run_program(message.line)


@command(EMC_TASK_PLAN_EXECUTE, on=True, unless=READING)
def execute(task: Task, message: EMC_TASK_PLAN_EXECUTE) -> None:
    """Run an MDI line, after those before it."""
    _must_be_homed(task, "issue MDI command")
    if task.mode is not Mode.MDI:
        raise Refused("Must be in MDI mode to issue MDI command")
    if len(task.mdi_queue) >= task.config.mdi_queue:
        raise Refused(f"{len(task.mdi_queue)} MDI lines wait already; [TASK]MDI_QUEUED_COMMANDS allows no more")
    task.runner.run_mdi(message.command)


@command(EMC_TASK_PLAN_PAUSE, on=True)
def pause(task: Task, message: EMC_TASK_PLAN_PAUSE) -> None:
    """Hold the program."""
    task.runner.pause()


@command(EMC_TASK_PLAN_RESUME, on=True)
def resume(task: Task, message: EMC_TASK_PLAN_RESUME) -> None:
    """Go on after a pause."""
    if task.paused or task.motion.status.paused or task.runner.stepping:
        task.runner.resume()


@command(EMC_TASK_PLAN_STEP, on=True, modes=AUTO)
def step(task: Task, message: EMC_TASK_PLAN_STEP) -> None:
    """Run one block: of the program that is paused, or the first of the loaded one."""
    if task.interp_state is Interp.IDLE:
        if not task.plan.open_file:
            raise Refused("File not open")
        _must_be_homed(task, "run a program")
        task.runner.run_program(0)
        task.runner.stepping = True
    elif task.paused:
        task.runner.step()
    else:
        raise Refused("a running program cannot be stepped; pause it first")


@command(EMC_TASK_PLAN_SET_OPTIONAL_STOP)
def set_optional_stop(task: Task, message: EMC_TASK_PLAN_SET_OPTIONAL_STOP) -> None:
    """M1 stops, or does not; also for an M1 that was read already."""
    _set_optional_stop(task, bool(message.state))


@command(EMC_TASK_PLAN_SET_BLOCK_DELETE)
def set_block_delete(task: Task, message: EMC_TASK_PLAN_SET_BLOCK_DELETE) -> None:
    """Blocks with a slash are skipped, or not; acts on the blocks that are not read yet."""
    _set_block_delete(task, bool(message.state))


@command(EMC_TASK_PLAN_REVERSE, on=True)
def reverse(task: Task, message: EMC_TASK_PLAN_REVERSE) -> None:
    """Move back along the path; only while the program is paused. Without a program there is no way back."""
    if task.interp_state is Interp.IDLE:
        return
    if not task.paused:
        raise Refused("a program can run backwards only while it is paused; pause it first")
    task.motion.send(MotCommand.REVERSE)


@command(EMC_TASK_PLAN_FORWARD, on=True)
def forward(task: Task, message: EMC_TASK_PLAN_FORWARD) -> None:
    """Move along the path in its own direction again."""
    if task.interp_state is Interp.IDLE:
        return
    task.motion.send(MotCommand.FORWARD)


@command(EMC_TASK_PLAN_SYNCH, idle=True)
def synch(task: Task, message: EMC_TASK_PLAN_SYNCH) -> None:
    """The interpreter takes over the state of the machine; parameters are saved."""
    task.plan.must_synch = True
    task.runner.save_parameters()


@command(EMC_TASK_PLAN_INIT, idle=True)
def init(task: Task, message: EMC_TASK_PLAN_INIT) -> None:
    """The interpreter goes back to its first modes and forgets the program; M1 and slashes act."""
    _set_optional_stop(task, True)
    _set_block_delete(task, True)
    try:
        task.plan.reset(task.config.startup_code)
    except PyemcError as error:
        raise Refused(f"[RS274NGC]RS274NGC_STARTUP_CODE: {error}") from None


@command(EMC_TASK_PLAN_READ, EMC_TASK_PLAN_END, EMC_TASK_PLAN_OPTIONAL_STOP)
def nothing(task: Task, message: Message) -> None:
    """Task reads, ends and stops programs by itself."""
