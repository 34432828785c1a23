"""The map that all clients see: key to plain value. Knows what has changed, nothing of machines or sockets."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

Listener = Callable[[dict[str, Any]], None]


class State:
    """All keys with their values; listeners are told the keys that changed, with the new values."""

    def __init__(self) -> None:
        self.values: dict[str, Any] = {}
        self._listeners: list[Listener] = []

    def __getitem__(self, key: str) -> Any:
        return self.values[key]

    def get(self, key: str, default: Any = None) -> Any:
        return self.values.get(key, default)

    def listen(self, listener: Listener) -> None:
        """Call ``listener`` with each change from now on."""
        self._listeners.append(listener)

    def update(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Take new values over; returns those that differ from what was there."""
        mine = self.values
        changed = {key: value for key, value in values.items() if key not in mine or mine[key] != value}
        if changed:
            mine.update(changed)
            for listener in self._listeners:
                listener(changed)
        return changed

    def bump(self, key: str) -> None:
        """Count up a key that says 'read it again'."""
        self.update({key: self.values.get(key, 0) + 1})
