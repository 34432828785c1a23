"""``import hal``: components in Python with the names and meanings of LinuxCNC's module of that name.

    import hal

    with hal.component("blinker") as c:
        c.newpin("out", hal.HAL_BIT, hal.HAL_OUT, safe=False)
        c.ready()
        c["out"] = True

A component whose process dies is removed by the realtime host or by the next HAL command; its pins take their ``safe``
values, if they declared any.
"""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Callable
from enum import IntEnum
from operator import attrgetter
from typing import TYPE_CHECKING, Any

from hal import _shm
from hal._items import Items
from hal._ports import Port
from hal._records import Item
from hal._shm import BIT, FLOAT, PARAM, PIN, PORT, S32, S64, U32, U64
from hal.core import LOCK_ALL, LOCK_CONFIG, LOCK_LOAD, LOCK_NONE, LOCK_PARAMS, LOCK_RUN, LOCK_TUNE, Hal
from hal.stream import Stream
from hal.values import TYPE_NAMES
from nml import clock
from nml.errors import HalError
from nml.namespace import namespace

HAL_BIT, HAL_FLOAT, HAL_S32, HAL_U32, HAL_PORT, HAL_S64, HAL_U64 = BIT, FLOAT, S32, U32, PORT, S64, U64
HAL_IN, HAL_OUT, HAL_IO = _shm.IN, _shm.OUT, _shm.IO
HAL_RO, HAL_RW = _shm.RO, _shm.RW
HAL_LOCK_NONE, HAL_LOCK_LOAD, HAL_LOCK_CONFIG, HAL_LOCK_PARAMS = LOCK_NONE, LOCK_LOAD, LOCK_CONFIG, LOCK_PARAMS
HAL_LOCK_RUN, HAL_LOCK_TUNE, HAL_LOCK_ALL = LOCK_RUN, LOCK_TUNE, LOCK_ALL


class Type(IntEnum):
    """Types of pins and signals. SINT and UINT are as wide as LinuxCNC's own integer pins, to be linked with them."""

    BOOL = BIT = _shm.BIT
    REAL = FLOAT = _shm.FLOAT
    SINT = S32 = _shm.S32
    UINT = U32 = _shm.U32
    PORT = _shm.PORT
    S64 = _shm.S64
    U64 = _shm.U64


class Dir(IntEnum):
    """Directions of pins and parameters."""

    IN = _shm.IN
    OUT = _shm.OUT
    IO = _shm.IO
    RO = _shm.RO
    RW = _shm.RW


MSG_NONE, MSG_ERR, MSG_WARN, MSG_INFO, MSG_DBG, MSG_ALL = range(6)
is_kernelspace, is_userspace, is_rt, is_sim = 0, 1, 1, 1

error = HalError
_msg_level = MSG_ERR
_doors: dict[tuple[int, str], Hal] = {}


def door() -> Hal:
    """This process's attachment to the HAL of its namespace, made at first use, after a fork and after its end."""
    key = os.getpid(), namespace()
    hal = _doors.get(key)
    if hal is None or not hal.segment.current:
        _doors.clear()
        hal = _doors[key] = Hal()
    return hal


class NotPossible(HalError, RuntimeError):
    """What LinuxCNC's module raises as RuntimeError."""


class NotThere(HalError, NameError):
    """What LinuxCNC's module raises as NameError."""


class Duplicate(HalError, ValueError):
    """What LinuxCNC's module raises as ValueError."""


class item(Port):
    """A pin or parameter of a component. ``get``, ``set`` and, for type HAL_PORT, what moves bytes are native."""

    __slots__ = ("_is_pin", "_name")

    def __init__(self, item: Item, name: str, is_pin: bool) -> None:
        self.show_same(item)
        self._name = name
        self._is_pin = is_pin

    @property
    def name(self) -> str:
        """As it was given to ``newpin``, without the component's prefix."""
        return self._name

    def get_name(self) -> str:
        return self._name

    def get_type(self) -> int:
        return self.type

    def get_dir(self) -> int:
        return self.dir

    def is_pin(self) -> bool:
        return self._is_pin

    def wait(self, value: Any, timeout: float | None = None) -> bool:
        """Wait until the pin has this value; False after ``timeout`` seconds of host time."""
        return self._wait(lambda: self.get() == value, timeout)

    def wait_change(self, timeout: float | None = None) -> bool:
        """Wait until the pin has another value than now; False after ``timeout`` seconds of host time."""
        before = self.get()
        return self._wait(lambda: self.get() != before, timeout)

    def _wait(self, fulfilled: Callable[[], bool], timeout: float | None) -> bool:
        """Sleep until somebody has changed a value, and look again."""
        segment = door().segment
        end = math.inf if timeout is None else clock.host_now() + timeout
        while True:
            seen = segment.changes()
            if fulfilled():
                return True
            left = end - clock.host_now()
            if left <= 0:
                return False
            segment.sleep_unchanged(seen, min(left, 1.0))

    def __repr__(self) -> str:
        return f"<hal.{'Pin' if self._is_pin else 'Param'} {self._name} {TYPE_NAMES[self.type]}>"


_FORWARDED = (
    "clear", "get_dir", "get_name", "get_type", "is_pin", "peek", "peek_commit", "read", "readable", "size", "wait",
    "wait_change", "writable", "write",
)  # fmt: skip


class _ItemWrap:
    """A pin or parameter in plain Python, so that a class may have other bases besides, as GObject's in ``hal_glib``.

    What the ``item`` has, this has too; a call of ``get`` or ``set`` goes straight to it.
    """

    def __init__(self, native: item | _ItemWrap) -> None:
        self._item_wrap(native._item if isinstance(native, _ItemWrap) else native)

    def _item_wrap(self, native: item) -> None:
        self._item = native
        self.get, self.set = native.get, native.set

    @property
    def name(self) -> str:
        """As it was given to ``newpin``, without the component's prefix."""
        return self._item.name

    @property
    def type(self) -> int:
        return self._item.type

    @property
    def dir(self) -> int:
        return self._item.dir

    @property
    def value(self) -> Any:
        return self._item.get()

    @value.setter
    def value(self, value: Any) -> None:
        self._item.set(value)

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any: ...

    def __repr__(self) -> str:
        return repr(self._item)


for _name in _FORWARDED:  # no __getattr__: each look for `get` and `set` would pay for it
    setattr(_ItemWrap, _name, property(attrgetter(f"_item.{_name}")))


class Pin(_ItemWrap):
    """What ``newpin`` returns."""


class Param(_ItemWrap):
    """What ``newparam`` returns."""


class component(Items):
    """A user component. Pins are items and attributes: ``c["in"]``, ``c.out = 1`` (names with ``-``: items only)."""

    def __init__(self, name: str, prefix: str | None = None) -> None:
        self.__dict__["_hal"] = door()
        self.__dict__["_record"] = self._hal.add_component(name)
        self.__dict__["_pins"] = {}
        self.__dict__["_prefix"] = name if prefix is None else prefix

    def newpin(self, name: str, type: int, dir: int, safe: Any = None) -> Pin:
        """A pin ``PREFIX.name``; ``safe``: the value that it takes when this process dies."""
        self._check_alive()
        self._check_free(name)
        item = self._hal.add_pin(self._record, f"{self._prefix}.{name}", type, dir)
        if safe is not None:
            item.set_safe(safe)
        pin = self._pins[name] = Pin(self._keep(name, item, True))
        return pin

    def newparam(self, name: str, type: int, dir: int) -> Param:
        """A parameter ``PREFIX.name``."""
        self._check_alive()
        self._check_free(name)
        item = self._hal.add_param(self._record, f"{self._prefix}.{name}", type, dir)
        param = self._pins[name] = Param(self._keep(name, item, False))
        return param

    def _check_free(self, name: str) -> None:
        if name in self:
            raise Duplicate(f"Duplicate pin name '{name}'")

    def _keep(self, name: str, record: Item, is_pin: bool) -> item:
        self.keep(name, record)
        return item(record, name, is_pin)

    def getpin(self, name: str) -> Pin | Param:
        if name not in self:
            raise AttributeError(f"Pin '{name}' does not exist in component '{self._prefix}'")
        pin: Pin | Param = self._pins[name]
        return pin

    getitem = getparam = getpin

    def getpins(self) -> dict[str, Any]:
        """All values by name."""
        return {name: item.get() for name, item in self.items.items()}

    def setprefix(self, prefix: str) -> None:
        """The first part of the names of pins made from now on."""
        self.__dict__["_prefix"] = prefix

    def getprefix(self) -> str:
        return self._prefix

    def ready(self) -> None:
        """All pins are there."""
        self._check_alive()
        self._record.ready = True

    def unready(self) -> None:
        """More pins are to come."""
        self._check_alive()
        self._record.ready = False

    def exit(self) -> None:
        """Leave the HAL; the pins are gone."""
        if self._record is not None and self._record.exists:
            self._hal.remove_component(self._record)
        self.__dict__["_record"] = None
        self.forget()
        self._pins.clear()

    @property
    def name(self) -> str:
        self._check_alive()
        return self._record.name

    @property
    def id(self) -> int:
        self._check_alive()
        return self._record.id

    def _check_alive(self) -> None:
        if self._record is None:
            raise NotPossible("Invalid operation on closed HAL component")

    def __getattr__(self, name: str) -> Any:
        return self[name]

    def __setattr__(self, name: str, value: Any) -> None:
        self[name] = value

    def __enter__(self) -> component:
        return self

    def __exit__(self, *exc: object) -> None:
        self.exit()

    def __repr__(self) -> str:
        return f"<hal component {self._prefix} with {len(self)} pins and parameters>"


sampler_base, streamer_base = 0x48535430, 0x48535340  # keys of the first sampler and streamer channel


def stream(comp: component, key: int, *rest: int | str) -> Stream:
    """A queue of samples: ``stream(comp, key, depth, types)`` makes it, ``stream(comp, key[, types])`` attaches."""
    names = {base + n: f"{name}.{n}" for base, name in ((sampler_base, "sampler"), (streamer_base, "streamer"))
             for n in range(8)}  # fmt: skip
    depth = rest[0] if rest and isinstance(rest[0], int) else 0
    types = rest[-1] if rest and isinstance(rest[-1], str) else ""
    return Stream(names.get(key, str(key)), depth, types)


def component_exists(name: str) -> bool:
    """Whether a living component of that name is loaded."""
    hal = door()
    hal.reap()
    return hal.segment.find_comp(name) is not None


def component_is_ready(name: str) -> bool:
    hal = door()
    hal.reap()
    comp = hal.segment.find_comp(name)
    return comp is not None and comp.ready


def _failed(action: Callable[[], None]) -> bool:
    """What LinuxCNC's functions return: False where it is done; True where not, with the reason on standard error."""
    try:
        action()
    except HalError as refusal:
        print(f"HAL: ERROR: {refusal}", file=sys.stderr, flush=True)
        return True
    return False


def new_sig(name: str, type: int) -> bool:
    """Make a signal; False where it is done, True where it exists already."""
    if type not in TYPE_NAMES:
        raise NotPossible("not a valid HAL signal type")
    return _failed(lambda: _make_signal(name, type))


def _make_signal(name: str, type: int) -> None:
    door().new_signal(name, type)


def connect(pin: str, signal: str) -> bool:
    """Link a pin to a signal; False where it is done, True where that is not possible."""
    return _failed(lambda: door().link(pin, signal))


def disconnect(pin: str) -> bool:
    """Unlink a pin; False where it is done, True where there is none."""
    return _failed(lambda: door().unlink(pin))


def pin_has_writer(name: str) -> bool:
    """Whether an output drives the signal that the pin is linked to."""
    pin = door().segment.find_item(PIN, name)
    if pin is None:
        raise NotThere(f"Pin `{name}' does not exist")
    signal = pin.signal
    return signal is not None and signal.writer() is not None


def get_value(name: str) -> Any:
    """The value of a pin, parameter or signal."""
    try:
        return door().value(name)
    except HalError as refusal:
        raise NotPossible(str(refusal)) from None


def get_p(name: str) -> Any:
    """The value of a pin or parameter."""
    found = door().find(name)
    if found is None:
        raise NotPossible(f"pin or parameter '{name}' not found")
    return found[1].get()


def get_s(name: str) -> Any:
    """The value of a signal."""
    signal = door().segment.find_signal(name)
    if signal is None:
        raise NotPossible(f"signal '{name}' not found")
    return signal.get()


def set_p(name: str, value: Any) -> bool:
    """Set a pin or parameter, as ``halcmd setp`` does; False where it is done."""
    return _set(door().set_item, name, value)


def set_s(name: str, value: Any) -> bool:
    """Set a signal, as ``halcmd sets`` does; False where it is done."""
    return _set(door().set_signal, name, value)


def _set(setter: Callable[[str, str], None], name: str, value: Any) -> bool:
    try:
        setter(name, str(value))
    except HalError as refusal:
        raise NotPossible(str(refusal)) from None
    return False


def get_info_pins() -> list[dict[str, Any]]:
    """NAME, VALUE, TYPE and DIRECTION of every pin."""
    return [_info(item, "DIRECTION") for item in door().segment.items(PIN)]


def get_info_params() -> list[dict[str, Any]]:
    """NAME, VALUE, TYPE and DIRECTION of every parameter."""
    return [_info(item, "DIRECTION") for item in door().segment.items(PARAM)]


def _info(item: Item, direction: str) -> dict[str, Any]:
    return {"NAME": item.shown, "VALUE": item.get(), "TYPE": item.type, direction: item.dir}


def get_info_signals() -> list[dict[str, Any]]:
    """NAME, VALUE, TYPE and DRIVER (None where no output drives it) of every signal."""
    found = []
    for signal in door().segment.signals():
        writer = signal.writer()
        driver = writer.shown if writer else None
        found.append({"NAME": signal.name, "VALUE": signal.get(), "TYPE": signal.type, "DRIVER": driver})
    return found


def get_msg_level() -> int:
    return _msg_level


def set_msg_level(level: int) -> None:
    """How much the HAL says, MSG_NONE to MSG_ALL."""
    global _msg_level
    _msg_level = level

