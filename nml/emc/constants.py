"""Numbers of the EMC vocabulary: lengths of arrays and enumerations, as in LinuxCNC 2.9."""

from __future__ import annotations

from enum import IntEnum, IntFlag

MAX_JOINTS = 16
MAX_AXES = 9
MAX_SPINDLES = 8
MAX_DIO = 64
MAX_AIO = 64
MAX_MISC_ERROR = 64
LINELEN = 255
SYSTEM_CMD_LEN = 256
ACTIVE_G_CODES = 17
ACTIVE_M_CODES = 10
ACTIVE_SETTINGS = 5


class EMC_TASK_MODE_ENUM(IntEnum):
    """Who gives commands to task."""

    MANUAL = 1
    AUTO = 2
    MDI = 3


class EMC_TASK_STATE_ENUM(IntEnum):
    """Whether the machine may move."""

    ESTOP = 1
    ESTOP_RESET = 2
    OFF = 3
    ON = 4


class EMC_TASK_EXEC_ENUM(IntEnum):
    """What task is waiting for."""

    ERROR = 1
    DONE = 2
    WAITING_FOR_MOTION = 3
    WAITING_FOR_MOTION_QUEUE = 4
    WAITING_FOR_IO = 5
    WAITING_FOR_MOTION_AND_IO = 7
    WAITING_FOR_DELAY = 8
    WAITING_FOR_SYSTEM_CMD = 9
    WAITING_FOR_SPINDLE_ORIENTED = 10


class EMC_TASK_INTERP_ENUM(IntEnum):
    """What the interpreter is doing."""

    IDLE = 1
    READING = 2
    PAUSED = 3
    WAITING = 4


class EMC_TRAJ_MODE_ENUM(IntEnum):
    """How motion takes commands: by joint, along paths, or by axis."""

    FREE = 1
    COORD = 2
    TELEOP = 3


class EMC_MOTION_TYPE(IntEnum):
    """What kind of move it is."""

    NONE = 0
    TRAVERSE = 1
    FEED = 2
    ARC = 3
    TOOLCHANGE = 4
    PROBING = 5
    INDEXROTARY = 6


class KINEMATICS_TYPE(IntEnum):
    """Which transformations between joints and axes there are."""

    IDENTITY = 1
    FORWARD_ONLY = 2
    INVERSE_ONLY = 3
    BOTH = 4


class EmcJointType(IntEnum):
    """What a joint does."""

    LINEAR = 1
    ANGULAR = 2


class CANON_UNITS(IntEnum):
    """Length units of a program."""

    INCHES = 1
    MM = 2
    CM = 3


class RCS_STATUS(IntEnum):
    """How a command went."""

    UNINITIALIZED_STATUS = -1
    RCS_DONE = 1
    RCS_EXEC = 2
    RCS_ERROR = 3


class EMC_TRAJ_TERM_COND(IntEnum):
    """How a move ends, as EMC_TRAJ_SET_TERM_COND says it."""

    STOP = 0
    EXACT = 1
    BLEND = 2


class ORDER_OUTCOME(IntEnum):
    """What became of a command."""

    DONE = 1
    REFUSED = 2
    FAILED = 3
    ABORTED = 4


class EMC_IO_ABORT_REASON_ENUM(IntEnum):
    """Why the I/O controller is told to abort."""

    TASK_EXEC_ERROR = 1
    AUX_ESTOP = 2
    MOTION_OR_IO_RCS_ERROR = 3
    TASK_STATE_OFF = 4
    TASK_STATE_ESTOP_RESET = 5
    TASK_STATE_ESTOP = 6
    TASK_STATE_NOT_ON = 7
    TASK_ABORT = 8
    INTERPRETER_ERROR = 9
    INTERPRETER_ERROR_MDI = 10
    USER = 100


class EMC_DEBUG_FLAGS(IntFlag):
    """What is logged ([EMC]DEBUG)."""

    CONFIG = 0x2
    VERSIONS = 0x8
    TASK_ISSUE = 0x10
    NML = 0x40
    MOTION_TIME = 0x80
    INTERP = 0x100
    RCS = 0x200
    INTERP_LIST = 0x800
    IOCONTROL = 0x1000
    OWORD = 0x2000
    REMAP = 0x4000
    PYTHON = 0x8000
    NAMEDPARAM = 0x10000
    GDBONSIGNAL = 0x20000
    PYTHON_TASK = 0x40000
    STATE_TAGS = 0x80000
    USER1 = 0x10000000
    USER2 = 0x20000000
    UNCONDITIONAL = 0x40000000
    ALL = 0x7fffffff


class EMCMOT_ORIENT_STATE(IntEnum):
    """How far M19 has come."""

    NONE = 0
    COMPLETE = 1
    IN_PROGRESS = 2
    FAULTED = 3
