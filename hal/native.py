"""Components in C as the HAL's: who answers their calls, in the realtime host and in a program of their own.

``halcompile`` makes the libraries; ``hal._native`` has their C side. `load` is `loadrt` of one, `run` the program of
one for ``loadusr``.
"""

from __future__ import annotations

import ctypes
import errno
import os
import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hal._native import Library, SharedMemory, print_messages
from hal._records import Item
from hal.core import Hal
from nml.errors import HalError

if TYPE_CHECKING:
    from hal.realtime import Component, Host


class Owner:
    """Answers the calls of one library: makes components, pins, parameters and functions for it."""

    def __init__(self, hal: Hal) -> None:
        self.hal = hal
        self.error = ""  # why the last call was refused
        self.blocks: list[SharedMemory] = []

    def refused(self, error: BaseException) -> None:
        """Keep the reason, which the component sees as a number only."""
        self.error = str(error)

    def init(self, name: str) -> int:
        raise NotImplementedError

    def ready(self, comp_id: int) -> int:
        raise NotImplementedError

    def leave(self, comp_id: int) -> int:
        raise NotImplementedError

    def memory(self, size: int) -> int:
        """``hal_malloc``: an address."""
        self.blocks.append(SharedMemory(self.hal.segment, size))
        return self.blocks[-1].address

    def make(self, what: str, comp_id: int, name: str, type_: int, direction: int) -> Item:
        """A new pin or parameter (``what``) of value 0."""
        raise NotImplementedError

    def pin(self, comp_id: int, name: str, type_: int, direction: int, where: int) -> int:
        self._check(name, where)
        self.make("pin", comp_id, name, type_, direction).show_to(where)
        return 0

    def param(self, comp_id: int, name: str, type_: int, direction: int, where: int) -> int:
        self._check(name, where)
        self.make("param", comp_id, name, type_, direction).lie_at(where)
        return 0

    def _check(self, name: str, where: int) -> None:
        if not any(block.holds(where) for block in self.blocks):
            raise HalError(f"'{name}': its variable is not in memory of hal_malloc()")

    def function(self, comp_id: int, name: str, code: int, arg: int, uses_fp: bool, reentrant: bool) -> int:
        raise HalError(f"'{name}': only realtime components have functions")


class RealtimeOwner(Owner):
    """In the realtime host."""

    def __init__(self, host: Host) -> None:
        super().__init__(host.hal)
        self.host = host
        self.components: dict[int, Component] = {}

    def init(self, name: str) -> int:
        component = self.host.component(name)
        component.keep(self)
        self.components[component.record.id] = component
        return component.record.id

    def ready(self, comp_id: int) -> int:
        self.components[comp_id].ready()
        return 0

    def leave(self, comp_id: int) -> int:
        """The host takes the component out of the HAL when its module is unloaded."""
        return 0

    def make(self, what: str, comp_id: int, name: str, type_: int, direction: int) -> Item:
        component = self.components[comp_id]
        return (component.pin if what == "pin" else component.param)(name, type_, direction)

    def function(self, comp_id: int, name: str, code: int, arg: int, uses_fp: bool, reentrant: bool) -> int:
        self.components[comp_id].function(name, code, arg, uses_fp=uses_fp, reentrant=reentrant)
        return 0


def load(path: Path, host: Host, args: dict[str, str]) -> None:
    """``loadrt`` of a component in C."""
    name = path.stem
    library, owner = Library(str(path)), RealtimeOwner(host)
    code = -errno.EINVAL
    try:
        library.set_parameters(name, args)
        code = library.call(owner, "rtapi_app_main")
    finally:
        if code < 0:
            library.close()
    if code < 0:
        raise HalError(owner.error or f"{name}: rtapi_app_main: {os.strerror(-code)}", code)
    for component in list(owner.components.values())[:1]:
        component.keep(library)
        if library.has("rtapi_app_exit"):
            component.on_unload(lambda: library.end(owner))


class ProgramOwner(Owner):
    """In a program of its own."""

    def __init__(self) -> None:
        super().__init__(Hal())
        self.components: dict[int, Any] = {}

    def init(self, name: str) -> int:
        record = self.hal.add_component(name)
        self.components[record.id] = record
        return record.id

    def ready(self, comp_id: int) -> int:
        self.components[comp_id].ready = True
        return 0

    def leave(self, comp_id: int) -> int:
        record = self.components.pop(comp_id, None)
        if record is None:
            return -errno.EINVAL
        self.hal.remove_component(record)
        return 0

    def make(self, what: str, comp_id: int, name: str, type_: int, direction: int) -> Item:
        add = self.hal.add_pin if what == "pin" else self.hal.add_param
        return add(self.components[comp_id], name, type_, direction)


def run(library: str, argv: list[str]) -> int:
    """Run the library's ``main`` with these arguments, the program's name first; returns its exit code.

    Signals act on it as on any program in C.
    """
    for number in (signal.SIGINT, signal.SIGPIPE):
        signal.signal(number, signal.SIG_DFL)
    words = (ctypes.c_char_p * (len(argv) + 1))(*[os.fsencode(word) for word in argv], None)
    print_messages()
    owner = ProgramOwner()
    try:
        code = Library(library).call(owner, "main", len(argv), words)
    except HalError as error:
        print(f"{argv[0]}: {error}", file=sys.stderr)
        return 1
    if code and owner.error:
        print(f"{argv[0]}: {owner.error}", file=sys.stderr)
    owner.hal.close()
    return code & 0xFF
