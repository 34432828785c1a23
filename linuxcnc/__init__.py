"""``import linuxcnc``: status, commands, operator messages and INI values of a machine, under LinuxCNC's names.

The classes talk to task through the NML buffers emcStatus, emcCommand and emcError of the namespace that the variable
``PYEMC_NAMESPACE`` names, and of the NML file ``nmlfile``. The constants have the numbers of LinuxCNC 2.9.
"""

from linuxcnc._command import command
from linuxcnc._connection import error
from linuxcnc._constants import *  # noqa: F403  every constant is public here
from linuxcnc._drawing import draw_dwells, draw_lines, gui_respect_offsets, gui_rot_offsets, line9, vertex9
from linuxcnc._error import error_channel
from linuxcnc._ini import ini
from linuxcnc._orders import order, order_channel
from linuxcnc._positionlogger import positionlogger
from linuxcnc._stat import stat
from linuxcnc._stat import tool_result as tool

__all__ = [
    "command",
    "draw_dwells",
    "draw_lines",
    "error",
    "error_channel",
    "gui_respect_offsets",
    "gui_rot_offsets",
    "ini",
    "line9",
    "order",
    "order_channel",
    "positionlogger",
    "stat",
    "tool",
    "vertex9",
]
