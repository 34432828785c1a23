"""``linuxcnc.error``, the exception of this module, and ``linuxcnc.error_channel``, the messages for the operator."""

from __future__ import annotations

from linuxcnc._connection import error, open_channel
from nml.errors import NmlError
from nml.message import Message

__all__ = ["error", "error_channel"]

# The text field of each message class that may come: errors, texts and displays
TEXT_FIELDS = ("error", "text", "display")


class error_channel:
    """Connection to the queue of operator messages."""

    def __init__(self) -> None:
        self._channel = open_channel("emcError")

    def poll(self) -> tuple[int, str] | None:
        """The next message as (kind, text), kind being NML_* or OPERATOR_*; None if there is none."""
        try:
            message = self._channel.read()
        except NmlError as reason:
            raise error(str(reason)) from reason
        return None if message is None else (message.TYPE_ID, text_of(message))

    def wait(self, timeout: float) -> bool:
        """Wait up to ``timeout`` s for something new; at once true when there is."""
        return self._channel.wait(timeout)


def text_of(message: Message) -> str:
    """The text that an operator message carries."""
    for name in TEXT_FIELDS:
        text = getattr(message, name, None)
        if text is not None:
            return str(text)
    return repr(message)
