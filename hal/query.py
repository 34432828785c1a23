"""``hal.query``: what the HAL holds, as dictionaries by name, under the names of LinuxCNC's module of 2026.

    hal.query.pin("joint.0.pos-cmd")["value"]
    [name for name, pin in hal.query.pins().items() if pin["signal"] is None]

Each function looks anew. One that is given a name returns None where there is nothing of that name. Pins and
parameters stand under their own names, not under their aliases.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import IntEnum
from typing import Any

from hal._records import Comp, Funct, Item, Signal, Thread
from hal._shm import IN, OUT, PARAM, PIN, USER
from hal.module import Dir, Type, door

Facts = dict[str, Any]


class CompType(IntEnum):
    """Kinds of components."""

    USER = 0
    REALTIME = 1


def pins() -> dict[str, Facts]:
    """All pins."""
    return _items(door().segment.items(PIN), _pin)


def params() -> dict[str, Facts]:
    """All parameters."""
    return _items(door().segment.items(PARAM), _param)


def signals() -> dict[str, Facts]:
    """All signals."""
    return {signal.name: _signal(signal) for signal in door().segment.signals()}


def comps() -> dict[str, Facts]:
    """All components, the one that was loaded last first."""
    return {comp.name: _comp(comp) for comp in door().segment.comps()}


def functs() -> dict[str, Facts]:
    """All functions."""
    names = _owners()
    return {funct.name: _funct(funct, names) for funct in door().segment.functs()}


def threads() -> dict[str, Facts]:
    """All threads."""
    names = _owners()
    return {thread.name: _thread(thread, names) for thread in door().segment.threads()}


def signalpins(name: str) -> dict[str, Facts] | None:
    """The pins of a signal."""
    signal = door().segment.find_signal(name)
    return None if signal is None else _items(signal.pins(), _pin)


def pin(name: str) -> Facts | None:
    """One pin, by its name or its alias."""
    found = door().segment.find_item(PIN, name)
    return None if found is None else _pin(found, _owners())


def param(name: str) -> Facts | None:
    """One parameter, by its name or its alias."""
    found = door().segment.find_item(PARAM, name)
    return None if found is None else _param(found, _owners())


def signal(name: str) -> Facts | None:
    """One signal."""
    found = door().segment.find_signal(name)
    return None if found is None else _signal(found)


def comp(name: str | int) -> Facts | None:
    """One component, by its name or its number."""
    return next((_comp(each) for each in door().segment.comps() if name in (each.name, each.id)), None)


def funct(name: str) -> Facts | None:
    """One function."""
    found = door().segment.find_funct(name)
    return None if found is None else _funct(found, _owners())


def thread(name: str) -> Facts | None:
    """One thread, with its functions in the order of their calls."""
    found = door().segment.find_thread(name)
    return None if found is None else _thread(found, _owners())


def _owners() -> dict[int, str]:
    return {each.id: each.name for each in door().segment.comps()}


def _items(found: Iterable[Item], facts: Any) -> dict[str, Facts]:
    names = _owners()
    return {item.name: facts(item, names) for item in found}


def _pin(item: Item, names: dict[int, str]) -> Facts:
    signal = item.signal
    return _item("pin", item) | {"signal": signal.name if signal else None} | _owner(item.owner, names)


def _param(item: Item, names: dict[int, str]) -> Facts:
    return _item("parameter", item) | _owner(item.owner, names)


def _item(haltype: str, item: Item) -> Facts:
    return {
        "haltype": haltype,
        "name": item.name,
        "type": Type(item.type),
        "dir": Dir(item.dir),
        "value": item.get(),
        "alias": item.alias or None,
    }


def _owner(number: int, names: dict[int, str]) -> Facts:
    return {"comp": names.get(number), "comp_id": number}


def _signal(signal: Signal) -> Facts:
    directions = [item.dir for item in signal.pins()]
    writer = signal.writer()
    return {
        "haltype": "signal",
        "name": signal.name,
        "type": Type(signal.type),
        "value": signal.get(),
        "writers": directions.count(OUT),
        "readers": directions.count(IN),
        "bidirs": len(directions) - directions.count(OUT) - directions.count(IN),
        "driver": writer.shown if writer else None,
    }


def _comp(comp: Comp) -> Facts:
    user = comp.kind == USER
    return {
        "haltype": "component",
        "name": comp.name,
        "type": CompType.USER if user else CompType.REALTIME,
        "id": comp.id,
        "pid": comp.pid if user else 0,
        "ready": comp.ready,
        "insmod": comp.args or None,
    }


def _funct(funct: Funct, names: dict[int, str]) -> Facts:
    facts = {"haltype": "function", "name": funct.name} | _owner(funct.owner, names)
    return facts | {"users": funct.users, "reentrant": funct.reentrant}


def _thread(thread: Thread, names: dict[int, str]) -> Facts:
    facts = {"haltype": "thread", "name": thread.name} | _owner(thread.owner, names)
    called = [
        {"haltype": "threadfunction", "name": funct.name, "index": index, "is_init": False}
        for index, funct in enumerate(thread.functs())
    ]
    return facts | {"priority": thread.priority, "period": thread.period_ns, "functions": called}
