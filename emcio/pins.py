"""The HAL pins of ``iocontrol.0``, with LinuxCNC's names, types and directions."""

from __future__ import annotations

from typing import Any

import hal

PINS = {
    "user-enable-out": (hal.HAL_BIT, hal.HAL_OUT),  # FALSE: this controller demands an E-stop
    "user-request-enable": (hal.HAL_BIT, hal.HAL_OUT),  # rises when the user asks to leave E-stop
    "emc-enable-in": (hal.HAL_BIT, hal.HAL_IN),  # FALSE: E-stop
    "coolant-flood": (hal.HAL_BIT, hal.HAL_OUT),
    "coolant-mist": (hal.HAL_BIT, hal.HAL_OUT),
    "lube": (hal.HAL_BIT, hal.HAL_OUT),
    "lube_level": (hal.HAL_BIT, hal.HAL_IN),
    "tool-prepare": (hal.HAL_BIT, hal.HAL_OUT),
    "tool-prepared": (hal.HAL_BIT, hal.HAL_IN),
    "tool-prep-number": (hal.HAL_S32, hal.HAL_OUT),
    "tool-prep-pocket": (hal.HAL_S32, hal.HAL_OUT),
    "tool-prep-index": (hal.HAL_S32, hal.HAL_OUT),
    "tool-from-pocket": (hal.HAL_S32, hal.HAL_OUT),
    "tool-number": (hal.HAL_S32, hal.HAL_OUT),
    "tool-change": (hal.HAL_BIT, hal.HAL_OUT),
    "tool-changed": (hal.HAL_BIT, hal.HAL_IN),
}

FAULT_PINS = {
    "emc-abort": (hal.HAL_BIT, hal.HAL_OUT),
    "emc-abort-ack": (hal.HAL_BIT, hal.HAL_IN),
    "emc-reason": (hal.HAL_S32, hal.HAL_OUT),
    "start-change": (hal.HAL_BIT, hal.HAL_OUT),
    "start-change-ack": (hal.HAL_BIT, hal.HAL_IN),
    "toolchanger-fault": (hal.HAL_BIT, hal.HAL_IN),
    "toolchanger-fault-ack": (hal.HAL_BIT, hal.HAL_OUT),
    "toolchanger-reason": (hal.HAL_S32, hal.HAL_IN),
    "toolchanger-faulted": (hal.HAL_BIT, hal.HAL_OUT),
    "toolchanger-clear-fault": (hal.HAL_BIT, hal.HAL_IN),
}
"""What ``iov2`` has besides."""


def make_component(faults: bool) -> Any:
    """The component ``iocontrol`` with its pins, ready; ``faults``: with those of ``iov2``."""
    component = hal.component("iocontrol", "iocontrol.0")
    for name, (kind, direction) in (PINS | FAULT_PINS if faults else PINS).items():
        component.newpin(name, kind, direction)
    component.ready()
    return component
