"""The module below LinuxCNC's ``hal``, for scripts that import it too, such as ``hal_glib``: the same names.

    pin = _hal.component.newpin(component, "lamp", _hal.HAL_BIT, _hal.HAL_OUT)
"""

from hal import *  # noqa: F403  every name of it is meant
from hal.module import item

__all__ = ["item"]  # and hal's
