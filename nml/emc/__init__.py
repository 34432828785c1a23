"""The EMC vocabulary: every message of chapter 4 of the Developer Manual, under LinuxCNC's name.

``EMC_TASK_ABORT`` is the class, ``EMC_TASK_ABORT_TYPE`` its number. Each file declares one group; the wire form, the
formatter and the symbol table follow from the declarations, so that a new message is one class in one file.
"""

from __future__ import annotations

from nml.emc.auxiliary import *
from nml.emc.axis import *
from nml.emc.calls import *
from nml.emc.constants import *
from nml.emc.coolant import *
from nml.emc.io import *
from nml.emc.jog import *
from nml.emc.joint import *
from nml.emc.lube import *
from nml.emc.motion import *
from nml.emc.operator import *
from nml.emc.orders import *
from nml.emc.spindle import *
from nml.emc.stat import *
from nml.emc.structs import *
from nml.emc.task import *
from nml.emc.tool import *
from nml.emc.tooltable import *
from nml.emc.traj import *
from nml.message import Cms, Message, registry


def emc_format(type_id: int, message: Message, cms: Cms) -> int:
    """Pass the fields of a message of this vocabulary to ``cms``; 0 if the type is unknown (LinuxCNC's emcFormat)."""
    if registry.get(type_id) is not type(message):
        return 0
    message.update(cms)
    return 1


def emc_symbol_lookup(type_id: int) -> str:
    """Name of a message type, or ``UNKNOWN`` (LinuxCNC's emcSymbolLookup)."""
    cls = registry.get(type_id)
    return cls.__name__ if cls else "UNKNOWN"


def __getattr__(name: str) -> int:
    """``EMC_TASK_ABORT_TYPE``: the number of ``EMC_TASK_ABORT``."""
    cls = globals().get(name.removesuffix("_TYPE")) if name.endswith("_TYPE") else None
    if isinstance(cls, type) and issubclass(cls, Message) and cls.TYPE_ID:
        return cls.TYPE_ID
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
