"""Kinds of inputs of halui: buttons that act when pressed, jogs that go on while held, and dials.

Each has ``scan``, called some 50 times a second; what a panel does with it is in ``halui_panel``.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import hal
from gui.halui_panel import Panel

NewPin = Callable[[str, int, int], Any]


class Button:
    """Acts on each rising edge."""

    def __init__(self, pin: Any, action: Callable[[], None]) -> None:
        self._get = pin.get
        self._action = action
        self._was = False

    def scan(self) -> None:
        pressed = self._get()
        if pressed and not self._was:
            self._action()
        self._was = pressed


class Jog:
    """The jog pins of one joint or axis, or of the selected one."""

    def __init__(self, panel: Panel, flag: int, name: str, index: Callable[[], int], new: NewPin, shared: Any) -> None:
        """``shared``: the pins jog-speed and jog-deadband; ``index``: which joint or axis it is now."""
        self._panel = panel
        self._flag = flag
        self._index = index
        self._speed, self._deadband = shared
        self._held = {
            sign: new(f"{name}.{word}", hal.HAL_BIT, hal.HAL_IN) for sign, word in ((-1.0, "minus"), (1.0, "plus"))
        }
        self._increment = new(f"{name}.increment", hal.HAL_FLOAT, hal.HAL_IN)
        self._steps = [
            Button(new(f"{name}.increment-{word}", hal.HAL_BIT, hal.HAL_IN), partial(self._step, sign))
            for sign, word in ((-1.0, "minus"), (1.0, "plus"))
        ]
        selected = name.endswith("selected")
        self._analog = None if selected else new(f"{name}.analog", hal.HAL_FLOAT, hal.HAL_IN)
        self._moving: tuple[int, float] | None = None

    def _step(self, sign: float) -> None:
        self._panel.jog_by(self._flag, self._index(), self._speed.get(), sign * self._increment.get())

    def _wanted(self) -> float:
        """The speed that the pins ask for, 0 for none."""
        buttons = sum(sign for sign, pin in self._held.items() if pin.get())
        if buttons:
            return buttons * self._speed.get()
        if self._analog is not None:
            lever = self._analog.get()
            if abs(lever) > self._deadband.get():
                return lever * self._speed.get()
        return 0.0

    def scan(self) -> None:
        for step in self._steps:
            step.scan()
        wanted = self._wanted()
        if self._moving is None and wanted == 0.0:
            return
        index = self._moving[0] if self._moving else self._index()
        if self._moving == (index, wanted):
            return
        self._panel.jog(self._flag, index, wanted)
        self._moving = (index, wanted) if wanted else None


class Dial:
    """An override or the largest velocity: counts, buttons, and the value in force."""

    def __init__(
        self,
        name: str,
        new: NewPin,
        *,
        read: Callable[[], float],
        write: Callable[[float], None],
        scale: float,
        reset: bool = True,
    ) -> None:
        """``read`` and ``write``: the value in the machine; ``scale``: value of one count until the pin says else."""
        self._read, self._write = read, write
        self._enabled = new(f"{name}.count-enable", hal.HAL_BIT, hal.HAL_IN)
        self._enabled.set(True)
        self._counts = new(f"{name}.counts", hal.HAL_S32, hal.HAL_IN)
        self._direct = new(f"{name}.direct-value", hal.HAL_BIT, hal.HAL_IN)
        self._scale = new(f"{name}.scale", hal.HAL_FLOAT, hal.HAL_IN)
        self._scale.set(scale)
        self._value = new(f"{name}.value", hal.HAL_FLOAT, hal.HAL_OUT)
        self._buttons = [
            Button(new(f"{name}.increase", hal.HAL_BIT, hal.HAL_IN), lambda: self._change(1)),
            Button(new(f"{name}.decrease", hal.HAL_BIT, hal.HAL_IN), lambda: self._change(-1)),
        ]
        if reset:
            self._buttons.append(Button(new(f"{name}.reset", hal.HAL_BIT, hal.HAL_IN), lambda: self._write(1.0)))
        self._seen = 0

    def _change(self, counts: int) -> None:
        self._write(max(0.0, self._read() + counts * self._scale.get()))

    def scan(self) -> None:
        for button in self._buttons:
            button.scan()
        counts = self._counts.get()
        if counts != self._seen and self._enabled.get():
            if self._direct.get():
                self._write(max(0.0, counts * self._scale.get()))
            else:
                self._change(counts - self._seen)
        self._seen = counts
        self._value.set(self._read())
