"""``linuxcnc.order_channel``: what the clients of a machine order, and who ordered it; LinuxCNC has nothing like it."""

from __future__ import annotations

from typing import NamedTuple

from linuxcnc._connection import error, open_channel
from nml.emc import EMC_ORDER_NOTE
from nml.emc.orders import NOTE_BUFFER
from nml.errors import NmlError


class order(NamedTuple):
    """One command that was given to the machine."""

    serial: int
    """Its number; of the client who gave it, ``command.serial``."""
    origin: str
    """Program and process number, what a program says of itself, or the address of a client elsewhere."""
    text: str
    """The command and its values in words."""
    time: float
    """When it was given, in s since 1970."""


class order_channel:
    """Connection to the notes about commands; it begins with the oldest one that is still kept."""

    def __init__(self) -> None:
        self._channel = open_channel(NOTE_BUFFER)

    def poll(self) -> order | None:
        """The next command; None if there is none."""
        try:
            note = self._channel.read()
        except NmlError as reason:
            raise error(str(reason)) from reason
        if not isinstance(note, EMC_ORDER_NOTE):
            return None
        return order(note.serial, note.origin, note.order, note.time)

    def wait(self, timeout: float) -> bool:
        """Wait up to ``timeout`` s for something new; at once true when there is."""
        return self._channel.wait(timeout)
