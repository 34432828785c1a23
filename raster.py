"""``from raster import RasterProgrammer``: LinuxCNC's name for the Python end of the HAL component ``raster``."""

from hal.raster import FaultCodes, RasterProgrammer

__all__ = ["FaultCodes", "RasterProgrammer"]
