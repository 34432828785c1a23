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
OVERRIDE_STEP = 0.1  # override of one count until the scale pin says else


class Button:
    """Acts on each rising edge."""

    def __init__(self, pin: Any, action: Callable[[], None]) -> None:
        self._get = pin.get
        self._action = action
        self._was = False

    def scan(self) -> None:
        pressed, was = self._get(), self._was
        self._was = pressed
        if pressed and not was:
            self._action()


class Step:
    """Acts on each edge; the action is told whether the button was pressed or released."""

    def __init__(self, pin: Any, action: Callable[[bool], None]) -> None:
        self._get = pin.get
        self._action = action
        self._was = False

    def scan(self) -> None:
        pressed = self._get()
        if pressed != self._was:
            self._was = pressed
            self._action(pressed)


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
        wish = (self._index(), wanted) if wanted else None
        if wish == self._moving:
            return
        moved, self._moving = self._moving, wish
        if moved is not None and (wish is None or wish[0] != moved[0]):
            self._panel.jog(self._flag, moved[0], 0.0)
        if wish is not None:
            self._panel.jog(self._flag, *wish)


class Dial:
    """An override or the largest velocity: counts, buttons, and the value in force."""

    def __init__(
        self,
        name: str,
        new: NewPin,
        read: Callable[[], float],
        write: Callable[[float], None],
        limits: tuple[float, float],
        *,
        scale: float = OVERRIDE_STEP,
    ) -> None:
        """``read`` and ``write``: the value in the machine; ``scale``: value of one count until the pin says else.

        Without a scale of its own it is no override, and has no button that sets it to 100 %.
        """
        self._read, self._write = read, write
        self._limits = limits
        self._enabled = new(f"{name}.count-enable", hal.HAL_BIT, hal.HAL_IN)
        self._enabled.set(True)
        self._counts = new(f"{name}.counts", hal.HAL_S32, hal.HAL_IN)
        self._direct = new(f"{name}.direct-value", hal.HAL_BIT, hal.HAL_IN)
        self._scale = new(f"{name}.scale", hal.HAL_FLOAT, hal.HAL_IN)
        self._scale.set(scale)
        self._value = new(f"{name}.value", hal.HAL_FLOAT, hal.HAL_OUT)
        self._buttons = [
            Button(new(f"{name}.increase", hal.HAL_BIT, hal.HAL_IN), partial(self._change, 1)),
            Button(new(f"{name}.decrease", hal.HAL_BIT, hal.HAL_IN), partial(self._change, -1)),
        ]
        if scale:
            self._buttons.append(Button(new(f"{name}.reset", hal.HAL_BIT, hal.HAL_IN), partial(self._set, 1.0)))
        self._seen = 0

    def _set(self, value: float) -> None:
        low, high = self._limits
        self._write(min(max(low, value), high))

    def _change(self, counts: int) -> None:
        self._set(self._read() + counts * self._scale.get())

    def scan(self) -> None:
        self._value.set(self._read())
        for button in self._buttons:
            button.scan()
        counts, seen = self._counts.get(), self._seen
        self._seen = counts
        if counts != seen and self._enabled.get():
            if self._direct.get():
                self._set(counts * self._scale.get())
            else:
                self._change(counts - seen)
