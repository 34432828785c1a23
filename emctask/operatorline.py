"""Texts for the operator: written to emcError, where every display reads them."""

from __future__ import annotations

import logging
from collections.abc import Callable

from emctask.places import Places
from nml.channel import Channel
from nml.emc import EMC_OPERATOR_DISPLAY, EMC_OPERATOR_ERROR, EMC_OPERATOR_TEXT
from nml.emc.emcmot import EMCMOT_ERROR
from nml.errors import NmlError

OperatorMessage = EMC_OPERATOR_ERROR | EMC_OPERATOR_TEXT | EMC_OPERATOR_DISPLAY

MAX_BYTES = 254
log = logging.getLogger(__name__)


class OperatorLine:
    """The way to the operator. A full buffer loses the text, but never stops the machine's controller.

    ``serial`` is the number of the command that is being carried out, 0 if there is none; texts carry it as ``id``,
    and ``also_tell`` gets the text for those who wait for that command's result.
    """

    def __init__(self, channel: Channel, everybodys: Channel) -> None:
        self._channel = channel
        self._everybodys = everybodys
        self.serial = 0
        self.also_tell: Callable[[OperatorMessage], None] | None = None

    def error(self, text: str) -> None:
        """Something went wrong."""
        log.error("%s", text)
        self._write(EMC_OPERATOR_ERROR(id=self.serial, error=_cut(text)))

    def text(self, text: str) -> None:
        """Something the operator asked to know."""
        self._write(EMC_OPERATOR_TEXT(id=self.serial, text=_cut(text)))

    def display(self, text: str) -> None:
        """Something the operator should know."""
        self._write(EMC_OPERATOR_DISPLAY(id=self.serial, display=_cut(text)))

    def from_motion(self, error: EMCMOT_ERROR, places: Places, order: int) -> None:
        """Forward a text of motion; a move's id becomes the line of the program that asked for it.

        ``order``: the command that it belongs to, 0: the one that is being carried out.
        """
        serial, self.serial = self.serial, order or self.serial
        text = error.text
        if error.id:
            place = places.find(error.id)
            where = f"line {place.line}" if place and place.block.file else "the MDI line"
            text = text.replace(f"line {error.id}", where)
        {11: self.error, 12: self.text, 13: self.display}.get(error.kind, self.error)(text)
        self.serial = serial

    def from_io(self, order_of: Callable[[int], int]) -> None:
        """Io tells the operator by itself; who waits for the result of the order behind it is told, too.

        Io's texts carry the number of its command, below 0; ``order_of`` knows the order of each.
        """
        while (message := self._everybodys.read()) is not None:
            if isinstance(message, EMC_OPERATOR_ERROR) and message.id < 0 and self.also_tell is not None:
                self.also_tell(EMC_OPERATOR_ERROR(id=order_of(-message.id), error=message.error))

    def _write(self, message: OperatorMessage) -> None:
        if self.also_tell is not None:
            self.also_tell(message)
        try:
            self._channel.write(message)
        except NmlError as error:
            log.warning("a text for the operator was lost: %s", error)

    def close(self) -> None:
        """Close the channels."""
        self._everybodys.close()
        self._channel.close()


def _cut(text: str) -> str:
    return text.encode()[:MAX_BYTES].decode(errors="ignore")
