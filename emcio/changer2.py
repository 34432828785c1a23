"""The tool changer of ``iov2``: the same requests, and a changer that may report faults and is told of aborts.

    start:   start-change rises at the beginning of an M6;  start-change-ack answers   (option -support-start-change)
    abort:   emc-abort rises with emc-reason;  emc-abort-ack answers;  emc-abort falls
    fault:   toolchanger-fault rises with toolchanger-reason;  toolchanger-fault-ack follows it

A fault ends the request under way. With a reason of 0 or more the program goes on and finds fault and reason in #5600
and #5601; below 0 the command fails, and so does every M6 until ``toolchanger-clear-fault`` has been given.
"""

from __future__ import annotations

from collections.abc import MutableMapping
from typing import Any

from emcio.changer import Changer
from emcio.toolstore import ToolStore

START = "start-change"
ACKNOWLEDGED = "start-change-ack"


class FaultingChanger(Changer):
    """See the module; ``announces``: M6 begins with start-change."""

    def __init__(self, store: ToolStore, pins: MutableMapping[str, Any], announces: bool) -> None:
        super().__init__(store, pins)
        self._announces = announces
        self._in_fault = False
        self._problem = ""

    def start_change(self) -> None:
        self.fault = self.reason = 0
        self._refuse_while_faulted()
        if self._announces:
            self.pins[START] = True
            self._waiting = START

    def load(self) -> None:
        self._refuse_while_faulted()
        super().load()

    def prepare(self, toolno: int) -> None:
        self.fault = self.reason = 0
        super().prepare(toolno)

    def _refuse_while_faulted(self) -> None:
        if self.pins["toolchanger-faulted"]:
            raise ValueError(f"the tool changer is in fault {self.reason}; clear it first")

    def poll(self) -> None:
        pins = self.pins
        if pins["emc-abort"] and pins["emc-abort-ack"]:
            pins["emc-abort"] = False
        self._look_for_fault()
        if self._waiting != START:
            super().poll()
        elif pins[ACKNOWLEDGED]:
            self._end_request()

    def _look_for_fault(self) -> None:
        pins, before = self.pins, self._in_fault
        self._in_fault = pins["toolchanger-fault-ack"] = bool(pins["toolchanger-fault"])
        if self._in_fault and not before:
            self.fault, self.reason = 1, pins["toolchanger-reason"]
            if self.reason < 0:
                pins["toolchanger-faulted"] = True
                if self._waiting:
                    self._problem = f"the tool changer reports fault {self.reason} during {self._waiting}"
            self._end_request()
        elif not self._in_fault and pins["toolchanger-clear-fault"]:
            pins["toolchanger-faulted"] = False
            self.fault = self.reason = 0

    def _end_request(self) -> None:
        if self._waiting:
            self.pins[self._waiting] = False
            self._waiting = ""

    def take_problem(self) -> str:
        problem, self._problem = self._problem, ""
        return problem

    def abort(self, reason: int) -> None:
        super().abort(reason)
        self.pins[START] = False
        self.pins["emc-reason"] = reason
        self.pins["emc-abort"] = True
