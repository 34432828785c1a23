"""``hal_manualtoolchange``: ask the operator for a tool, through HAL pins between the tool changer and a person.

With a graphical display it shows a dialog; without one it writes the request to the terminal, and the pin
``change_button`` confirms it. ``--auto`` confirms at once, for simulations.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import signal
import sys
from collections.abc import Callable
from typing import NoReturn

import hal
from nml import clock

POLL_SECONDS = 0.02


class Asker:
    """Shows a request until it is confirmed or taken back."""

    def ask(self, text: str, confirmed: Callable[[], bool], wanted: Callable[[], bool]) -> bool:
        """True when confirmed, False when the change is no longer wanted."""
        print(f"hal_manualtoolchange: {text}; hal_manualtoolchange.change_button confirms", file=sys.stderr, flush=True)
        while wanted():
            if confirmed():
                return True
            clock.host_sleep(POLL_SECONDS)
        return False


class Dialog(Asker):
    """The request as a window."""

    def __init__(self) -> None:
        import tkinter

        self._tk = tkinter.Tk()
        self._tk.withdraw()
        self._tkinter = tkinter

    def ask(self, text: str, confirmed: Callable[[], bool], wanted: Callable[[], bool]) -> bool:
        pressed: list[bool] = []
        window = self._tkinter.Toplevel(self._tk)
        window.title("Tool change")
        self._tkinter.Label(window, text=text, padx=40, pady=20).pack()
        self._tkinter.Button(window, text="Continue", command=lambda: pressed.append(True), padx=20).pack(pady=10)
        window.protocol("WM_DELETE_WINDOW", lambda: None)
        try:
            while wanted():
                self._tk.update()
                if pressed or confirmed():
                    return True
                clock.host_sleep(POLL_SECONDS)
            return False
        finally:
            window.destroy()
            self._tk.update()


def _asker() -> Asker:
    if not os.environ.get("DISPLAY"):
        return Asker()
    try:
        return Dialog()
    except Exception as error:
        print(f"hal_manualtoolchange: no dialog ({error}); using the terminal", file=sys.stderr)
        return Asker()


def _terminated(number: int, frame: object) -> NoReturn:
    raise KeyboardInterrupt


def serve(comp: hal.component, asker: Asker, auto: bool) -> None:
    """Answer requests until the process is told to end."""
    while True:
        if not comp["change"]:
            comp["changed"] = False
        elif not comp["changed"]:
            number = comp["number"]
            text = f"Insert tool {number} and continue" if number else "Remove the tool and continue"
            comp["changed"] = auto or asker.ask(text, lambda: comp["change_button"], lambda: comp["change"])
        clock.host_sleep(POLL_SECONDS)


def main(argv: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="hal_manualtoolchange", description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--auto", action="store_true", help="confirm every change at once")
    options = parser.parse_args(argv)
    signal.signal(signal.SIGTERM, _terminated)
    with hal.component("hal_manualtoolchange") as comp:
        comp.newpin("number", hal.HAL_S32, hal.HAL_IN)
        comp.newpin("change", hal.HAL_BIT, hal.HAL_IN)
        comp.newpin("changed", hal.HAL_BIT, hal.HAL_OUT, safe=False)
        comp.newpin("change_button", hal.HAL_BIT, hal.HAL_IN)
        asker = Asker() if options.auto else _asker()
        comp.ready()
        with contextlib.suppress(KeyboardInterrupt):
            serve(comp, asker, options.auto)
    return 0


if __name__ == "__main__":
    sys.exit(main())
