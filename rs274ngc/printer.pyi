"""Types of the printing canon: see printer.pyx."""

from typing import Any

from rs274ngc.canon import Canon

class PrintCanon(Canon):
    state: Any
    def __init__(self, fd: int = 1, **machine: Any) -> None: ...
    def flush(self) -> None: ...
