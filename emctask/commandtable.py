"""The table of commands: for each message type, who handles it and in which states and modes it is allowed.

    @command(EMC_JOINT_HOME, on=True, modes=MANUAL)
    def home(task, message): ...

Handlers raise ``Refused`` with a reason; task tells the operator and answers the command with an error. A type that no
handler claims is refused, too, with the reason that ``refuse`` gave or as unknown.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from nml.emc.constants import EMC_TASK_INTERP_ENUM as Interp
from nml.emc.constants import EMC_TASK_MODE_ENUM as Mode
from nml.emc.constants import EMC_TASK_STATE_ENUM as State
from nml.message import Message

if TYPE_CHECKING:
    from emctask.task import Task

Handler = Callable[["Task", Any], None]

MANUAL = frozenset({Mode.MANUAL})
TYPED = frozenset({Mode.MDI, Mode.MANUAL})
AUTO = frozenset({Mode.AUTO})
ANY = frozenset(Mode)
NEVER: frozenset[Mode] = frozenset()

READING = frozenset({Interp.READING})
RUNNING = READING | {Interp.WAITING}
UNDER_WAY = RUNNING | {Interp.PAUSED}
"""States of the interpreter in which a program goes on, or is not over."""

MODE_NAMES = {Mode.MANUAL: "manual", Mode.MDI: "MDI", Mode.AUTO: "auto"}


class Refused(Exception):
    """A command cannot be carried out; the text says why, for the operator."""


class PassedOver(Refused):
    """Refused, too, but LinuxCNC calls it done: motion refuses it there, or nobody, and the status shows no error."""


def error(mode: Mode) -> type[Refused]:
    """Refused as an error, in whatever mode."""
    return Refused


def passed_over(mode: Mode) -> type[Refused]:
    """Passed over in whatever mode."""
    return PassedOver


def error_in_auto(mode: Mode) -> type[Refused]:
    """Refused as an error in auto mode, passed over in others."""
    return Refused if mode is Mode.AUTO else PassedOver


@dataclass(frozen=True, slots=True)
class Rule:
    """What a command needs. ``urgent(message)``: it overtakes everything and ends what is being waited for."""

    handler: Handler
    on: bool
    modes: frozenset[Mode]
    idle: bool
    urgent: Callable[[Any], bool]
    refusal: Callable[[Mode], type[Refused]] = error
    """How it is refused for the mode."""
    unless: frozenset[Interp] = frozenset()
    """States of the interpreter in which it is refused in auto mode: it is the program's to give."""


RULES: dict[int, Rule] = {}
REFUSALS: dict[int, str] = {}


def always(message: Message) -> bool:
    """An urgent command."""
    return True


def never(message: Message) -> bool:
    """A command that waits for its turn."""
    return False


def command(
    *types: type[Message],
    on: bool = False,
    modes: frozenset[Mode] = ANY,
    idle: bool = False,
    urgent: Callable[[Any], bool] = never,
    refusal: Callable[[Mode], type[Refused]] = error,
    unless: frozenset[Interp] = frozenset(),
) -> Callable[[Handler], Handler]:
    """Register a handler. ``on``: only while the machine is on; ``idle``: only while no program or MDI line runs.

    ``refusal``: how it is refused in a mode that it is not for. ``unless``: states of a program in which it is refused.
    """

    def register(handler: Handler) -> Handler:
        for message in types:
            RULES[message.TYPE_ID] = Rule(handler, on, modes, idle, urgent, refusal, unless)
        return handler

    return register


def refuse(types: Iterable[type[Message]], reason: str) -> None:
    """These commands are known, but not for clients to give; the reason names the way that works."""
    for message in types:
        REFUSALS[message.TYPE_ID] = reason


def check(rule: Rule, message: Message, state: State, mode: Mode, interp: Interp) -> None:
    """Refused with the reason, in LinuxCNC's words, when a command is not allowed now."""
    name = type(message).__name__
    if rule.on and state is not State.ON:
        raise Refused(f"command ({name}) cannot be executed until the machine is out of E-stop and turned on")
    busy = (rule.idle and interp is not Interp.IDLE) or (mode is Mode.AUTO and interp in rule.unless)
    if mode in rule.modes and not busy:
        return
    if mode is Mode.AUTO:
        raise rule.refusal(mode)(f"can't do that ({name}) in auto mode with the interpreter {interp.name.lower()}")
    raise rule.refusal(mode)(f"can't do that ({name}:{message.TYPE_ID}) in {MODE_NAMES[mode]} mode")
