"""``from pyhal import *``: LinuxCNC's second Python door to HAL, for scripts that use it; ``import hal`` can do more.

    c = component("lamp")
    on = c.pinNew("on", halType.BIT, pinDir.OUT)
    c.ready()
    c.sigNew("light", halType.BIT)
    c.sigLink("lamp.on", "light")
    on.value = True
"""

from __future__ import annotations

from enum import IntEnum

import hal
from nml import clock
from nml.errors import HalError

__all__ = ["HalException", "component", "halType", "pin", "pinDir", "port"]

HalException = HalError
LOOK_S = 0.001  # host time between two looks at a port that somebody waits for


class halType(IntEnum):
    """What a pin or signal carries."""

    BIT = hal.HAL_BIT
    FLOAT = hal.HAL_FLOAT
    SIGNED = hal.HAL_S32
    UNSIGNED = hal.HAL_U32
    PORT = hal.HAL_PORT


class pinDir(IntEnum):
    """Which way."""

    IN = hal.HAL_IN
    OUT = hal.HAL_OUT
    IO = hal.HAL_IO


class pin(hal.Pin):
    """A pin: its full name, and its ``value``."""

    def __init__(self, item: hal.Pin, fullname: str) -> None:
        super().__init__(item)
        self.fullname = fullname


class port(pin):
    """A pin of type PORT: bytes from one component to another, as many as its signal was given room for."""

    def size(self) -> int:
        """Bytes of room, one of which is never used; 0 while the signal has none."""
        return int(self._item.size())

    def readable(self) -> int:
        """Bytes that can be read."""
        return int(self._item.readable())

    def writable(self) -> int:
        """Bytes that can be written."""
        return int(self._item.writable())

    def read(self, count: int) -> bytes | str:
        """Take ``count`` bytes; an empty text, and nothing taken, while there are fewer."""
        return self._item.read(count) or ""

    def peek(self, count: int) -> bytes | str:
        """Look at the next ``count`` bytes, and leave them; an empty text while there are fewer."""
        return self._item.peek(count) or ""

    def peek_commit(self, count: int) -> bool:
        """Take bytes that were looked at."""
        return bool(self._item.peek_commit(count))

    def write(self, data: bytes | str) -> bool:
        """Write all of it; False, and nothing written, where the room is too small."""
        return bool(self._item.write(data))

    def clear(self) -> None:
        """Throw away what nobody has read."""
        self._item.clear()

    def waitReadable(self, count: int) -> None:
        """Wait until so many bytes can be read."""
        while self.readable() < count:
            clock.host_sleep(LOOK_S)

    def waitWritable(self, count: int) -> None:
        """Wait until so many bytes can be written."""
        while self.writable() < count:
            clock.host_sleep(LOOK_S)


class component:
    """A user component."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._component = hal.component(name)

    def pinNew(self, name: str, type: int, dir: int) -> pin:
        """A pin ``COMPONENT.name``."""
        item = self._component.newpin(name, int(type), int(dir))
        return (port if type == halType.PORT else pin)(item, f"{self.name}.{name}")

    def sigNew(self, name: str, type: int) -> None:
        """A signal; HalException where there is one of this name."""
        if hal.new_sig(name, int(type)):
            raise HalException(f"signal '{name}' cannot be made: is there one already?")

    def sigLink(self, pin_name: str, sig_name: str) -> None:
        """Link a pin, by its full name, to a signal; HalException where that cannot be."""
        if hal.connect(pin_name, sig_name):
            raise HalException(f"pin '{pin_name}' cannot be linked to signal '{sig_name}'")

    def ready(self) -> None:
        """All pins are there."""
        self._component.ready()

    def exit(self) -> None:
        """The component and its pins go."""
        self._component.exit()
