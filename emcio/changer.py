"""The tool changer as io sees it: prepare, change, unload, set, each a handshake over two HAL pins.

    prepare:  tool-prepare rises with tool-prep-number, -pocket and -index;  tool-prepared answers;  tool-prepare falls
    change:   tool-change rises;  tool-changed answers;  the table is updated;  tool-change falls

A command is under way from its start until ``poll`` has seen the answer; an abort takes the request back. A request
does not rise while the answer to an earlier one still stands, for at most ``SETTLE_S``: a pin tied to TRUE is allowed.
"""

from __future__ import annotations

from collections.abc import MutableMapping
from typing import Any

from emcio.toolstore import NO_TOOL, ToolStore
from nml import clock

NONE_PREPARED = -1
SETTLE_S = 0.2  # host time

ANSWERS = {"tool-prepare": "tool-prepared", "tool-change": "tool-changed"}


class Changer:
    """Drives the pins; ``pins`` is the HAL component, ``changed`` is set when the table must be saved and published."""

    def __init__(self, store: ToolStore, pins: MutableMapping[str, Any]) -> None:
        self.store = store
        self.pins = pins
        self.prepared = NONE_PREPARED
        self.from_pocket = 0
        self.table_changed = True
        self.must_save = False
        self.spindle_events: list[tuple[str, int, int]] = []
        """Loads and unloads for a tool data base: (letter, tool number, pocket)."""
        self.fault = self.reason = 0
        """What a changer that can tell reports: is there a fault, and its number."""
        self._waiting = ""
        self._target = 0
        self._settle_until = 0.0
        pins["tool-number"] = store.in_spindle

    @property
    def busy(self) -> bool:
        """Is a handshake under way?"""
        return bool(self._waiting)

    @property
    def in_spindle(self) -> int:
        """Number of the tool in the spindle."""
        return self.store.in_spindle

    def start_change(self) -> None:
        """M6 begins."""

    def take_problem(self) -> str:
        """Why the request under way failed, told once."""
        return ""

    def prepare(self, toolno: int) -> None:
        """T word. ValueError for a tool that is not in the table."""
        index = self.store.index_of(toolno)
        if index < 0:
            raise ValueError(f"T{toolno} is not in the tool table; add it, or reload the table")
        self._announce(index, toolno)
        if index == 0:
            self.prepared = 0
            if self.store.random:  # it is in the spindle already
                return
        self._target = index
        self._begin("tool-prepare")

    def load(self) -> None:
        """M6. ValueError when no tool was prepared."""
        index = self.prepared
        if index == NONE_PREPARED:
            raise ValueError("no tool is prepared; a T word must come before M6")
        same = index > 0 and self.store.entries[index].toolno == self.store.in_spindle
        if (self.store.random and index == 0) or (not self.store.random and same):
            return
        self._target = index
        self._begin("tool-change")

    def unload(self) -> None:
        """The spindle is empty from now on."""
        if not self.store.random:
            self._put(0)
        self.pins["tool-number"] = 0

    def set_number(self, index: int) -> None:
        """M61: the tool of ``index`` is in the spindle, without a change. ValueError for an index without a tool."""
        entries = self.store.entries
        if not 0 <= index < len(entries) or (index and entries[index].toolno == NO_TOOL):
            raise ValueError(f"index {index} of the tool table holds no tool")
        if index or not self.store.random:
            self._put(index)
        if self.store.in_spindle <= 0:
            self.from_pocket = 0
        self.pins["tool-from-pocket"] = self.from_pocket

    def poll(self) -> None:
        """Look whether the changer has answered."""
        if not self._waiting:
            return
        answered = self.pins[ANSWERS[self._waiting]]
        if not self.pins[self._waiting]:
            if not answered or clock.host_now() > self._settle_until:
                self.pins[self._waiting] = True
        elif answered:
            self._finish()

    def _finish(self) -> None:
        if self._waiting == "tool-prepare":
            self.prepared = self._target
        else:
            pocket = self.store.pocket_of(self._target)
            self._put(self._target)
            self.from_pocket = pocket if self.store.in_spindle > 0 else 0
            self.pins["tool-from-pocket"] = self.from_pocket
            self.prepared = NONE_PREPARED
            self._announce(0, 0)
        self.pins[self._waiting] = False
        self._waiting = ""

    def abort(self, reason: int) -> None:
        """Take requests back; a prepared tool stays prepared, one that was being changed stays where it was."""
        self._waiting = ""
        self.pins["tool-prepare"] = False
        self.pins["tool-change"] = False

    def _announce(self, index: int, toolno: int) -> None:
        self.pins["tool-prep-index"] = index
        self.pins["tool-prep-number"] = toolno
        self.pins["tool-prep-pocket"] = self.store.pocket_of(index)

    def _begin(self, request: str) -> None:
        self._waiting = request
        self._settle_until = clock.host_now() + SETTLE_S
        self.poll()

    def _put(self, index: int) -> None:
        old = self.store.in_spindle
        if self.store.random:
            self.spindle_events.append(("u", old, self.store.pocket_of(index)))
        self.must_save |= self.store.load_spindle(index)
        self.table_changed = True
        new = self.store.in_spindle
        self.spindle_events.append(("l", new, 0) if index or self.store.random else ("u", 0, 0))
        self.pins["tool-number"] = new
