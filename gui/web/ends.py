"""What became of orders, by their serial numbers: for the gateway, whose programs may have many under way at once."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field

from linuxcnc._connection import open_channel
from linuxcnc._error import text_of
from nml.channel import Channel
from nml.emc import EMC_ORDER_RESULT
from nml.emc.constants import ORDER_OUTCOME
from nml.emc.orders import RESULT_BUFFER

LOOK = 0.01  # s between looks while somebody waits
KEPT = 1000  # ends of orders, those of other clients included


@dataclass(slots=True)
class End:
    """An order, and how it ended: done, refused, failed, aborted; empty while it goes on."""

    outcome: str = ""
    messages: list[str] = field(default_factory=list)


class Ends:
    """The ends of all orders from now on."""

    def __init__(self) -> None:
        self._channel: Channel = open_channel(RESULT_BUFFER)
        self._orders: dict[int, End] = {}

    async def of(self, serial: int) -> End:
        """The end of an order, waited for."""
        while not (end := self._orders.get(serial, End())).outcome:
            if not self._take():
                await asyncio.sleep(LOOK)
        return end

    def _take(self) -> bool:
        """Take over the next message; false if there is none."""
        message = self._channel.read()
        if message is None:
            return False
        if isinstance(message, EMC_ORDER_RESULT):
            self._order(message.serial).outcome = ORDER_OUTCOME(message.outcome).name.lower()
        else:
            self._order(int(getattr(message, "id", 0))).messages.append(text_of(message))
        return True

    def _order(self, serial: int) -> End:
        for old in list(self._orders)[:-KEPT]:
            del self._orders[old]
        return self._orders.setdefault(serial, End())

    def close(self) -> None:
        """Let go of the buffer."""
        self._channel.close()
