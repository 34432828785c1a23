"""Programs for the realtime component ``raster``: a line of pixels, sent through a port; see ``hal.components.raster``.

    programmer = RasterProgrammer("programmer")  # pins: program, run, enabled, fault-code
    programmer.begin(offset=1.0, bpp=8, ppu=10.0, count=100)
    programmer.data("00" * 100)
    programmer.start()
"""

from __future__ import annotations

from enum import Enum

import hal
from nml.errors import HalError


class FaultCodes(Enum):
    """What ``raster.N.fault-code`` says."""

    NoFault = 0
    InvalidOffset = 1
    InvalidBPP = 2
    InvalidPPU = 3
    InvalidCount = 4
    ProgramUnderrun = 5
    WrongDirection = 6
    BadPixelData = 7


class RasterProgrammer:
    """A user component that writes programs into its port and starts them."""

    def __init__(self, name: str) -> None:
        self._component = hal.component(name)
        self.port = self._component.newpin("program", hal.HAL_PORT, hal.HAL_OUT)
        self.run = self._component.newpin("run", hal.HAL_BIT, hal.HAL_OUT)
        self.enabled = self._component.newpin("enabled", hal.HAL_BIT, hal.HAL_IN)
        self.fault_code = self._component.newpin("fault-code", hal.HAL_S32, hal.HAL_IN)
        self._component.ready()

    def begin(self, offset: float, bpp: int, ppu: float, count: int, timeout: float = 2.0) -> None:
        """A new program: ``count`` pixels of ``bpp`` bits, ``ppu`` in a unit, the first at ``offset`` from here."""
        self.stop(timeout)
        self._write(f"{offset};{bpp};{ppu};{count};")

    def data(self, pixels: str) -> None:
        """Pixels in hexadecimal digits, ``bpp / 4`` for each."""
        self._write(pixels)

    def _write(self, text: str) -> None:
        if not self.port.write(text):
            raise HalError(f"the port has no room for {len(text)} bytes; 'sets' gives its signal a size")

    def start(self, timeout: float = 2.0) -> None:
        """Let it run; HalError with the fault where the program is wrong."""
        self.run.set(True)
        if not self.enabled.wait(True, timeout):
            raise HalError(f"the program was not accepted: {FaultCodes(self.fault_code.get()).name}")

    def stop(self, timeout: float = 2.0) -> None:
        """End the program; what is left of it is dropped."""
        self.run.set(False)
        if not self.enabled.wait(False, timeout):
            raise HalError(f"raster has not stopped in {timeout} s")

    def exit(self) -> None:
        self._component.exit()
