"""Who orders what, and what becomes of it: two broadcast queues beside emcCommand, for whoever watches.

On emcOrders stands a note for each command that a client gives. Clients write it beside their command, the NML server
for those that come from elsewhere; nothing depends on it. On emcResults task tells of each command how it ended, after
copies of the operator messages that belong to it.
"""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

from nml.message import Command, Message, char, double, integer

__all__ = ["EMC_ORDER_NOTE", "EMC_ORDER_RESULT"]

NOTE_BUFFER = "emcOrders"
RESULT_BUFFER = "emcResults"
ORIGIN_LENGTH, ORDER_LENGTH = 64, 192


class EMC_ORDER_NOTE(Message, type_id=3011):
    """One command, who gave it, and when."""

    serial = integer(doc="number of the command in emcCommand, which operator messages about it carry as id")
    command_type = integer(doc="type number of the command")
    time = double(unit="s", doc="since 1970")
    origin = char(ORIGIN_LENGTH, cut=True, doc="program and process, or address of another computer")
    order = char(ORDER_LENGTH, cut=True, doc="the command in words")


class EMC_ORDER_RESULT(Message, type_id=3012):
    """The end of one command; the operator messages that belong to it came before, with its number as id."""

    serial = integer(doc="number of the command in emcCommand")
    command_type = integer(doc="type number of the command")
    outcome = integer(doc="ORDER_OUTCOME")


def program_name() -> str:
    """Origin of this process' commands until it says better: its program and process number."""
    name = Path(sys.argv[0]).name if sys.argv and sys.argv[0] not in ("", "-c", "-m") else "python"
    return f"{name.removesuffix('.py')}[{os.getpid()}]"


def describe(command: Command) -> str:
    """A command in words: its name and the members that are not at their default."""
    plain = type(command)()
    values = ((member.name, getattr(command, member.name), getattr(plain, member.name)) for member in command.BODY)
    words = (f"{name}={value!r}" for name, value, default in values if value != default)
    return " ".join([type(command).__name__.removeprefix("EMC_"), *words])


def note(command: Command, serial: int, origin: str) -> EMC_ORDER_NOTE:
    """The note about a command that was written as number ``serial``."""
    return EMC_ORDER_NOTE(
        serial=serial, command_type=command.TYPE_ID, time=time.time(), origin=origin, order=describe(command)
    )
