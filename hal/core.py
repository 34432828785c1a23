"""The rules of the HAL: who may make, link, set and remove what. Everything that speaks HAL goes through `Hal`.

It works on the records of ``hal._shm``; the shell (``hal.commands``), the realtime host (``hal.realtime``) and
``import hal`` (``hal.module``) are its users. Each refusal is a HalError whose text names what is in the way, with
LinuxCNC's errno.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from hal import _shm
from hal._records import Comp, Item, Signal
from hal._shm import IN, IO, OUT, PARAM, PIN, PORT, RW, Segment
from hal.process import alive, own_identity
from hal.values import PIN_DIR_NAMES, TYPE_NAMES, parse_value
from nml import clock
from nml.errors import HalError

EINVAL, ENOMEM, EPERM, EBUSY, ENOENT, EFAULT = -22, -12, -1, -16, -2, -14

LOCK_NONE, LOCK_LOAD, LOCK_CONFIG, LOCK_PARAMS, LOCK_RUN = 0, 1, 2, 4, 8
LOCK_TUNE = LOCK_LOAD | LOCK_CONFIG
LOCK_ALL = 255
STOP_SECONDS = 2

NAME_LENGTH = 47

_UNWRITABLE = set("#$[\"'\\")  # a HAL file could not name such a thing


def suggest(name: str, known: Iterable[str]) -> str:
    """`"; did you mean 'x'?"` where a known name is close, else nothing."""
    from difflib import get_close_matches

    close = get_close_matches(name, list(known), n=1, cutoff=0.75)
    return f"; did you mean '{close[0]}'?" if close else ""


def check_name(name: str, what: str) -> None:
    """Refuse a name that is empty, too long, or that no HAL file could contain."""
    if not name:
        raise HalError(f"{what} name is empty")
    if len(name.encode()) > NAME_LENGTH:
        raise HalError(f"{what} name '{name}' is too long: {len(name)} characters, {NAME_LENGTH} are allowed")
    wrong = [c for c in name if c in _UNWRITABLE or not c.isprintable() or c.isspace()]
    if wrong:
        raise HalError(f"{what} name '{name}' contains {wrong[0]!r}, which a HAL file cannot hold")


class Hal:
    """One process's door to the HAL of its namespace."""

    def __init__(self) -> None:
        self.segment = Segment()

    def close(self) -> None:
        """Leave; the last process to do so ends the session's segment."""
        self.segment.detach()

    def _unlocked(self, bit: int, doing: str) -> None:
        if self.segment.locks & bit:
            raise HalError(f"HAL is locked, {doing} is not permitted; 'unlock all' would allow it", EPERM)

    # ---- components ----

    def add_component(self, name: str, kind: int = _shm.USER, identity: tuple[int, int] | None = None) -> Comp:
        """Register a component of this process (or of ``identity``); a dead one of the same name gives way."""
        check_name(name, "component")
        if kind != _shm.USER:
            self._unlocked(LOCK_LOAD, "loading of programs")
        with self.segment as segment:
            other = segment.find_comp(name)
            if other is not None:
                if alive(other.pid, other.start):
                    raise HalError(f"component '{name}' already exists (process {other.pid})", EINVAL)
                self._remove(other, safe=True)
            return segment.new_comp(name, kind, *(identity or own_identity()))

    def remove_component(self, comp: Comp, safe: bool = False) -> None:
        """Remove a component and all that is its own; ``safe``: its pins take their safe values first."""
        with self.segment:
            self._remove(comp, safe)

    def _remove(self, comp: Comp, safe: bool) -> None:
        for kind in (PIN, PARAM):
            for item in self.segment.items(kind):
                if item.owner == comp.id:
                    if safe:
                        item.fall_safe()
                    item.unlink()
                    item.free()
        mine = {funct for funct in self.segment.functs() if funct.owner == comp.id}
        for thread in self.segment.threads():
            called = thread.functs()
            if mine.intersection(called):
                thread.set_functs([funct for funct in called if funct not in mine])
            if thread.owner == comp.id:
                thread.set_functs([])
                thread.free()
        for funct in mine:
            funct.free()
        comp.free()

    def component(self, name: str) -> Comp:
        comp = self.segment.find_comp(name)
        if comp is None:
            known = [c.name for c in self.segment.comps()]
            raise HalError(f"component '{name}' is not loaded{suggest(name, known)}", EINVAL)
        return comp

    def reap(self) -> list[str]:
        """Remove the user components whose processes are gone; their names. Realtime ones belong to the host."""
        gone = []
        with self.segment:
            for comp in self.segment.comps():
                if comp.kind == _shm.USER and not alive(comp.pid, comp.start):
                    gone.append(comp.name)
                    self._remove(comp, safe=True)
        return gone

    def forget_realtime(self) -> None:
        """Remove all realtime components; for a host that has died."""
        with self.segment as segment:
            for comp in segment.comps():
                if comp.kind != _shm.USER:
                    self._remove(comp, safe=True)
            segment.threads_running = False
            segment.host = (0, 0)

    def host_state(self) -> tuple[int, bool]:
        """(pid, alive) of the realtime host; pid 0: none was started."""
        pid, start = self.segment.host
        return pid, alive(pid, start)

    # ---- pins and parameters ----

    def add_pin(self, comp: Comp, name: str, type_: int, direction: int) -> Item:
        if direction not in (IN, OUT, IO):
            raise HalError(f"pin '{name}': direction {direction} is none of HAL_IN, HAL_OUT, HAL_IO")
        if type_ == PORT and direction == IO:
            raise HalError(f"pin '{name}': a port is either HAL_IN or HAL_OUT")
        return self._add_item(PIN, comp, name, type_, direction)

    def add_param(self, comp: Comp, name: str, type_: int, direction: int) -> Item:
        if direction not in (_shm.RO, RW):
            raise HalError(f"parameter '{name}': direction {direction} is none of HAL_RO, HAL_RW")
        return self._add_item(PARAM, comp, name, type_, direction)

    def _add_item(self, kind: int, comp: Comp, name: str, type_: int, direction: int) -> Item:
        check_name(name, ("pin", "parameter")[kind])
        if type_ not in TYPE_NAMES:
            raise HalError(f"'{name}': {type_} is no HAL type")
        self._unlocked(LOCK_LOAD, "creating pins and parameters")
        with self.segment as segment:
            if segment.find_item(kind, name) is not None:
                raise HalError(f"duplicate variable '{name}'", EINVAL)
            return segment.new_item(kind, name, type_, direction, comp.id)

    def find(self, name: str) -> tuple[int, Item] | None:
        """(PARAM or PIN, item); a parameter goes before a pin of the same name."""
        for kind in (PARAM, PIN):
            item = self.segment.find_item(kind, name)
            if item is not None:
                return kind, item
        return None

    def item(self, name: str, order: str = "pin or parameter") -> tuple[int, Item]:
        """As `find`; HalError for an unknown name."""
        found = self.find(name)
        if found is None:
            known = [i.shown for kind in (PIN, PARAM) for i in self.segment.items(kind)]
            raise HalError(f"{order} '{name}' not found{suggest(name, known)}")
        return found

    def pin(self, name: str, text: str = "pin '{}' not found") -> Item:
        pin = self.segment.find_item(PIN, name)
        if pin is None:
            raise HalError(text.format(name) + suggest(name, (p.shown for p in self.segment.items(PIN))))
        return pin

    def set_item(self, name: str, text: str) -> None:
        """``setp``: a writable parameter, or a pin that no signal drives and that is no output."""
        self._unlocked(LOCK_PARAMS, "setting parameters")
        kind, item = self.item(name, "parameter or pin")
        if kind == PARAM and item.dir != RW:
            raise HalError(f"param '{name}' is not writable")
        if kind == PIN and item.dir == OUT:
            raise HalError(f"pin '{name}' is not writable: its component '{self._owner_name(item)}' drives it")
        if kind == PIN and item.signal is not None:
            raise HalError(f"pin '{name}' is connected to a signal: '{item.signal.name}'; 'sets' would set that")
        item.set(parse_value(item.type, text))

    def _owner_name(self, item: Item) -> str:
        return next((c.name for c in self.segment.comps() if c.id == item.owner), "?")

    def alias(self, kind: int, name: str, alias: str) -> None:
        what = ("pin", "parameter")[kind]
        self._unlocked(LOCK_CONFIG, "naming")
        check_name(alias, what)
        with self.segment as segment:
            item = segment.find_item(kind, name)
            if item is None:
                raise HalError(f"{what} '{name}' not found{suggest(name, (i.name for i in segment.items(kind)))}")
            if segment.find_item(kind, alias) is not None:
                raise HalError(f"{what} '{alias}' exists already")
            item.alias = alias

    def unalias(self, kind: int, name: str) -> None:
        what = ("pin", "parameter")[kind]
        self._unlocked(LOCK_CONFIG, "naming")
        with self.segment as segment:
            item = segment.find_item(kind, name)
            if item is None:
                raise HalError(f"{what} '{name}' not found")
            if not item.alias:
                raise HalError(f"{what} '{name}' has no alias")
            item.alias = ""

    # ---- signals ----

    def new_signal(self, name: str, type_: int) -> Signal:
        self._unlocked(LOCK_CONFIG, "making signals")
        check_name(name, "signal")
        if type_ not in TYPE_NAMES:
            raise HalError(f"signal '{name}': {type_} is no HAL type")
        with self.segment as segment:
            if segment.find_signal(name) is not None:
                raise HalError(f"duplicate signal '{name}'")
            return segment.new_signal(name, type_)

    def signal(self, name: str) -> Signal:
        signal = self.segment.find_signal(name)
        if signal is None:
            raise HalError(f"signal '{name}' not found{suggest(name, (s.name for s in self.segment.signals()))}")
        return signal

    def delete_signal(self, name: str) -> None:
        self._unlocked(LOCK_CONFIG, "deleting signals")
        with self.segment:
            signal = self.signal(name)
            for pin in signal.pins():
                pin.unlink()
            signal.free()

    def set_signal(self, name: str, text: str) -> None:
        """``sets``: only where no pin drives the signal; for a port the size of its buffer, once."""
        self._unlocked(LOCK_PARAMS, "setting signals")
        signal = self.signal(name)
        if signal.type == PORT:
            self._allot(signal, int(parse_value(PORT, text)))
            return
        writer = signal.writer()
        if writer is not None:
            raise HalError(f"signal '{name}' already has writer(s): pin '{writer.shown}'")
        signal.set(parse_value(signal.type, text))

    def _allot(self, signal: Signal, size: int) -> None:
        with self.segment:
            if signal.get():
                raise HalError(f"port is already allocated with {signal.get()} bytes.")
            if size:
                signal.allot(size)

    def link(self, pin_name: str, signal_name: str) -> None:
        """Join a pin to a signal. The first pin brings its value with it."""
        self._unlocked(LOCK_CONFIG, "linking")
        with self.segment:
            pin, signal = self.pin(pin_name), self.signal(signal_name)
            linked = pin.signal
            if linked == signal:
                return
            if linked is not None:
                raise HalError(f"pin '{pin_name}' is linked to '{linked.name}', cannot link to '{signal_name}'")
            self._check_net(signal_name, signal, [pin])
            if not signal.pins() and signal.type != PORT:
                signal.set(pin.get())
            pin.link(signal)

    @staticmethod
    def check_writers(pin: Item, signal_name: str, others: list[Item]) -> None:
        """One output drives a signal alone; I/O pins share one among themselves."""
        rivals = {IN: (), OUT: (OUT, IO), IO: (OUT,)}[pin.dir]
        for other in others:
            if other.dir in rivals and other != pin:
                raise HalError(
                    f"Signal '{signal_name}' can not add {PIN_DIR_NAMES[pin.dir]} pin '{pin.shown}', "
                    f"it already has {PIN_DIR_NAMES[other.dir]} pin '{other.shown}'"
                )

    def unlink(self, pin_name: str) -> None:
        self._unlocked(LOCK_CONFIG, "unlinking")
        with self.segment:
            self.pin(pin_name).unlink()

    def net(self, signal_name: str, pin_names: list[str]) -> None:
        """Link pins to a signal, which is made where it does not exist; nothing changes unless all of them fit."""
        self._unlocked(LOCK_CONFIG, "linking")
        with self.segment as segment:
            if segment.find_item(PIN, signal_name) is not None:
                raise HalError(
                    f"Signal name '{signal_name}' must not be the same as a pin.  Did you omit the signal name?"
                )
            signal = segment.find_signal(signal_name)
            if not pin_names:
                if signal is None:
                    raise HalError("'net' requires at least one pin, none given")
                return
            pins = [self._net_pin(name) for name in pin_names]
            for pin in pins:
                linked = pin.signal
                if linked is not None and linked.name != signal_name:
                    raise HalError(f"Pin '{pin.shown}' was already linked to signal '{linked.name}'")
            self._check_net(signal_name, signal, pins)
            if signal is None:
                self.new_signal(signal_name, pins[0].type)
            for name in pin_names:
                self.link(name, signal_name)

    def _net_pin(self, name: str) -> Item:
        if not name.strip("-=<>"):
            raise HalError(f"Pin '{name}' does not exist; '{name}' is no arrow; => would be right")
        return self.pin(name, "Pin '{}' does not exist")

    def _check_net(self, signal_name: str, signal: Signal | None, pins: list[Item]) -> None:
        type_ = signal.type if signal else pins[0].type
        members = signal.pins() if signal else []
        for pin in pins:
            if pin.type != type_:
                raise HalError(
                    f"Signal '{signal_name}' of type '{TYPE_NAMES[type_]}' cannot add pin '{pin.shown}' "
                    f"of type '{TYPE_NAMES[pin.type]}'"
                )
            self.check_writers(pin, signal_name, members)
            if type_ == PORT and pin.dir == IN and any(other.dir == IN and other != pin for other in members):
                raise HalError(f"Signal '{signal_name}' can not add pin '{pin.shown}', a port has one reader only")
            if pin not in members:
                members.append(pin)

    # ---- threads ----

    def start_threads(self) -> None:
        """Let the threads call their functions."""
        self._unlocked(LOCK_RUN, "starting")
        self.segment.threads_running = True

    def stop_threads(self) -> None:
        """Stop calling functions; on return none of them runs any more."""
        self._unlocked(LOCK_RUN, "stopping")
        self.halt_threads()

    def halt_threads(self) -> None:
        """As `stop_threads`, whatever is locked."""
        self.segment.threads_running = False
        patience = clock.host_now() + STOP_SECONDS
        while any(thread.running for thread in self.segment.threads()) and self.host_state()[1]:
            if clock.host_now() > patience:
                raise HalError(f"a realtime function has not returned for {STOP_SECONDS} s", EBUSY)
            clock.host_sleep(0.0002)

    # ---- values by name, for scripts ----

    def value(self, name: str) -> Any:
        """The value of a parameter, pin or signal."""
        found = self.find(name)
        if found is not None:
            return found[1].get()
        return self.signal(name).get()
