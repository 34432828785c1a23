"""What the HAL pages show: the tree, live values, the net graph, threads. Reads shared memory; no I/O, no waiting."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from hal._records import Item, Signal
from hal._shm import IN, OUT, PARAM, PIN, RW
from hal.core import Hal
from hal.report import owner_of
from hal.values import PARAM_DIR_NAMES, PIN_DIR_NAMES, TYPE_NAMES
from nml.errors import HalError

MOST_ITEMS = 2000
KINDS = ("pin", "sig", "param")
JS_SAFE = 2**53
NO_FEEDBACK = {"actual_speed": None, "at_speed": None}


class HalView:
    """One look into the HAL of this machine."""

    def __init__(self, hal: Hal, may_write: bool) -> None:
        self._hal = hal
        self._may_write = may_write

    # --- the tree --------------------------------------------------------------------------------------------------

    def tree(self, words: str, kinds: Iterable[str]) -> dict[str, Any]:
        """The items whose names hold every word, up to `MOST_ITEMS`, and how many there are."""
        wanted = [word.lower() for word in words.split()]
        found = [row for row in self._rows(kinds) if all(word in row["name"].lower() for word in wanted)]
        return {"items": sorted(found, key=lambda row: row["name"])[:MOST_ITEMS], "total": len(found)}

    def _rows(self, kinds: Iterable[str]) -> Iterator[dict[str, Any]]:
        owners = {comp.id: comp.name for comp in self._hal.segment.comps()}
        for kind in kinds:
            if kind == "sig":
                yield from (self._signal_row(signal) for signal in self._hal.segment.signals())
            else:
                for item in self._hal.segment.items(PIN if kind == "pin" else PARAM):
                    yield self._item_row(item, kind, owners.get(item.owner, ""))

    def _item_row(self, item: Item, kind: str, owner: str) -> dict[str, Any]:
        signal = item.signal
        writable = item.dir == RW if kind == "param" else item.dir != OUT and signal is None
        names = PARAM_DIR_NAMES if kind == "param" else PIN_DIR_NAMES
        return {
            "name": item.shown, "kind": kind, "type": TYPE_NAMES[item.type], "dir": names[item.dir],
            "signal": signal.name if signal is not None else None, "owner": owner, "value": plain(item.get()),
            "writable": self._may_write and writable,
        }  # fmt: skip

    def _signal_row(self, signal: Signal) -> dict[str, Any]:
        writer = signal.writer()
        return {
            "name": signal.name, "kind": "sig", "type": TYPE_NAMES[signal.type], "dir": "",
            "signal": writer.shown if writer is not None else None, "owner": "", "value": plain(signal.get()),
            "writable": self._may_write and writer is None,
        }  # fmt: skip

    # --- values ----------------------------------------------------------------------------------------------------

    def cells(self, names: Iterable[str]) -> dict[str, Item | Signal]:
        """What lies behind names; unknown ones are left out."""
        found: dict[str, Item | Signal] = {}
        for name in names:
            known = self._hal.find(name)
            cell = known[1] if known is not None else self._hal.segment.find_signal(name)
            if cell is not None:
                found[name] = cell
        return found

    def spindle(self, number: int) -> dict[str, Any]:
        """What a spindle feeds back: ``actual_speed`` in rpm and ``at_speed``; None what is not wired."""
        speed = self._hal.segment.find_item(PIN, f"spindle.{number}.speed-in")
        at_speed = self._hal.segment.find_item(PIN, f"spindle.{number}.at-speed")
        return {
            "actual_speed": speed.get() * 60.0 if speed is not None and speed.signal is not None else None,
            "at_speed": at_speed.get() if at_speed is not None else None,
        }

    def set(self, name: str, value: Any) -> None:
        """Set a pin, parameter or signal; HalError where it is not allowed."""
        text = str(int(value)) if isinstance(value, bool) else repr(value) if isinstance(value, float) else str(value)
        if self._hal.find(name) is not None:
            self._hal.set_item(name, text)
        else:
            self._hal.set_signal(name, text)

    # --- nets and threads ------------------------------------------------------------------------------------------

    def nets(self, words: str) -> dict[str, Any]:
        """Instances as nodes, signals as edges from writer to reader."""
        wanted = [word.lower() for word in words.split()]
        edges: list[dict[str, Any]] = []
        for signal in self._hal.segment.signals():
            pins = signal.pins()
            named = [signal.name.lower(), *(pin.shown.lower() for pin in pins)]
            if all(any(word in name for name in named) for word in wanted):
                edges += self._edges(signal, pins)
        nodes: dict[str, set[str]] = {}
        for edge in edges:
            nodes.setdefault(edge["from"], set()).add(edge["from_pin"])
            nodes.setdefault(edge["to"], set()).add(edge["to_pin"])
        return {"nodes": [{"id": node, "pins": sorted(pins)} for node, pins in nodes.items()], "edges": edges}

    def _edges(self, signal: Signal, pins: list[Item]) -> Iterator[dict[str, Any]]:
        sources = [(owner_of(pin), pin.shown) for pin in pins if pin.dir != IN] or [(f"signal {signal.name}", "")]
        for owner, source in sources:
            for pin in pins:
                if pin.dir != OUT and pin.shown != source:
                    yield {
                        "from": owner, "to": owner_of(pin), "signal": signal.name, "from_pin": source,
                        "to_pin": pin.shown,
                    }  # fmt: skip

    def threads(self) -> list[dict[str, Any]]:
        """Threads with their functions in order, and how long they take, ns."""
        return [
            {
                "name": thread.name,
                "period": thread.period_ns,
                **self._times(thread.name),
                "overruns": thread.overruns,
                "functs": [{"name": funct.name, **self._times(funct.name)} for funct in thread.functs()],
            }
            for thread in self._hal.segment.threads()
        ]

    def _times(self, name: str) -> dict[str, Any]:
        """``time`` and ``tmax`` of a thread or function, None where it has none."""
        return {what: self._value(f"{name}.{what}") for what in ("time", "tmax")}

    def _value(self, name: str) -> Any:
        try:
            return self._hal.value(name)
        except HalError:
            return None


def plain(value: Any) -> Any:
    """A HAL value for the page; whole numbers beyond what a browser holds exactly become texts."""
    return str(value) if isinstance(value, int) and abs(value) > JS_SAFE else value
