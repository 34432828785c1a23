"""Task's side of io: sends commands one after the other, each when the one before was echoed, and follows its status.

toolCmd holds a single message, so a command that is not yet taken must not be overwritten; commands wait in line here.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from emctask.layout import image
from emctask.partner import SignOfLife
from nml import clock
from nml.channel import Channel
from nml.emc import EMC_IO_STAT
from nml.emc.tooltable import EMC_TOOL_TABLE
from nml.message import Command

DONE, EXEC, ERROR = 1, 2, 3
ORDERS_KEPT = 64


class IoClient:
    """Commands out, status and tool table in."""

    def __init__(self, commands: Channel, status: Channel, table: Channel) -> None:
        self._commands = commands
        self._status = status
        self._sign_of_life = SignOfLife(status)
        self._table = table
        self.status = EMC_IO_STAT()
        self.table = EMC_TOOL_TABLE()
        self.table_changed = False
        self.known = False
        self.order: Callable[[], int] = lambda: 0
        """Serial number of the order that is being carried out."""
        self._line: deque[tuple[Command, int]] = deque()
        self._orders: deque[tuple[int, int]] = deque(maxlen=ORDERS_KEPT)
        """Serial numbers of the commands sent last, and of the orders that they belong to."""
        self._serial = 0
        self._base = int(clock.host_now() * 1000) & 0x3FFFFFFF

    def poll(self) -> bool:
        """Take over a new status and a new tool table, send what may be sent; is there a new status?"""
        news = self._status.poll_into(image(self.status))
        self.known |= news
        if self._table.poll_into(image(self.table)):
            self.table_changed = True
        self._advance()
        return news

    @property
    def alive(self) -> bool:
        """Does io still write its status?"""
        return self._sign_of_life.seen()

    def send(self, command: Command) -> None:
        """Send a command after those before it."""
        self._line.append((command, self.order()))
        self._advance()

    def send_first(self, *commands: Command) -> None:
        """Drop what has not been sent yet and send these instead: an abort, an E-stop."""
        self._line.clear()
        self._line.extend((command, self.order()) for command in commands)
        self._advance()

    @property
    def sent(self) -> int:
        """How many commands were given to it, those that wait included."""
        return self._serial + len(self._line)

    def _advance(self) -> None:
        while self._line and self.echoed_last:
            command, order = self._line.popleft()
            self._serial += 1
            command.serial_number = self._base + self._serial
            self._orders.append((command.serial_number, order))
            self._commands.write(command)

    def order_of(self, serial: int) -> int:
        """The order that io's command of this number belongs to; 0: to none."""
        return dict(self._orders).get(serial, 0)

    def reconnected(self) -> None:
        """Io was gone and is back: what was on the way to it is lost."""
        self._line.clear()
        self._serial = 0

    @property
    def echoed_last(self) -> bool:
        """Was the command sent last taken?"""
        return self._serial == 0 or self.status.echo_serial_number == self._base + self._serial

    @property
    def done(self) -> bool:
        """Has io taken and finished everything?"""
        return not self._line and self.echoed_last and self.status.status != EXEC

    @property
    def failed(self) -> bool:
        """Did the command that io took last fail?"""
        return self.echoed_last and self.status.status == ERROR

    def close(self) -> None:
        """Close the channels."""
        for channel in (self._commands, self._status, self._table):
            channel.close()
