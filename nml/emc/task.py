"""Task: modes, states, programs and MDI. Manual, chapter 4.7."""

from __future__ import annotations

from nml.emc.constants import ACTIVE_G_CODES, ACTIVE_M_CODES, ACTIVE_SETTINGS, LINELEN
from nml.emc.structs import EmcPose
from nml.message import Command, Status, boolean, char, double, integer, struct, uint


class EMC_TASK_CMD_MSG(Command):
    """A command to task."""


class EMC_TASK_INIT(EMC_TASK_CMD_MSG, type_id=501):
    """Initialise task."""


class EMC_TASK_HALT(EMC_TASK_CMD_MSG, type_id=502):
    """Shut task down."""


class EMC_TASK_ABORT(EMC_TASK_CMD_MSG, type_id=503):
    """Stop what the machine is doing."""


class EMC_TASK_SET_MODE(EMC_TASK_CMD_MSG, type_id=504):
    """Change between manual, MDI and auto."""

    mode = integer(doc="EMC_TASK_MODE_ENUM")


class EMC_TASK_SET_STATE(EMC_TASK_CMD_MSG, type_id=505):
    """Set or reset E-stop, turn the machine on or off."""

    state = integer(doc="EMC_TASK_STATE_ENUM")


class EMC_TASK_PLAN_OPEN(EMC_TASK_CMD_MSG, type_id=506):
    """Open a program."""

    file = char(LINELEN, wire=LINELEN + 1, doc="path")


class EMC_TASK_PLAN_RUN(EMC_TASK_CMD_MSG, type_id=507):
    """Run the open program."""

    line = integer(doc="line to start at; 0: the first; -1: check the program only")


class EMC_TASK_PLAN_READ(EMC_TASK_CMD_MSG, type_id=508):
    """Read the next block of the program."""


class EMC_TASK_PLAN_EXECUTE(EMC_TASK_CMD_MSG, type_id=509):
    """Execute an MDI command; without text, the block that was read."""

    command = char(LINELEN, wire=LINELEN + 1, doc="a block of G-code")


class EMC_TASK_PLAN_PAUSE(EMC_TASK_CMD_MSG, type_id=510):
    """Pause the program."""


class EMC_TASK_PLAN_STEP(EMC_TASK_CMD_MSG, type_id=511):
    """Run one line of the program."""


class EMC_TASK_PLAN_RESUME(EMC_TASK_CMD_MSG, type_id=512):
    """Go on after a pause."""


class EMC_TASK_PLAN_END(EMC_TASK_CMD_MSG, type_id=513):
    """The program has ended."""


class EMC_TASK_PLAN_CLOSE(EMC_TASK_CMD_MSG, type_id=514):
    """Close the program."""


class EMC_TASK_PLAN_INIT(EMC_TASK_CMD_MSG, type_id=515):
    """Reset the interpreter."""


class EMC_TASK_PLAN_SYNCH(EMC_TASK_CMD_MSG, type_id=516):
    """Let the interpreter take over the machine's state."""


class EMC_TASK_PLAN_SET_OPTIONAL_STOP(EMC_TASK_CMD_MSG, type_id=517):
    """Whether M1 stops."""

    state = boolean()


class EMC_TASK_PLAN_SET_BLOCK_DELETE(EMC_TASK_CMD_MSG, type_id=518):
    """Whether lines that begin with / are left out."""

    state = boolean()


class EMC_TASK_PLAN_OPTIONAL_STOP(EMC_TASK_CMD_MSG, type_id=519):
    """The program has come to an M1."""


class EMC_TASK_PLAN_REVERSE(EMC_TASK_CMD_MSG, type_id=520):
    """Run the path backwards."""


class EMC_TASK_PLAN_FORWARD(EMC_TASK_CMD_MSG, type_id=521):
    """Run the path forwards again."""


class EMC_TASK_STAT_MSG(Status):
    """What the status of task begins with."""

    heartbeat = uint(doc="counts cycles")


class EMC_TASK_STAT(EMC_TASK_STAT_MSG, type_id=599):
    """The status of task and the interpreter."""

    wire_order = (
        "heartbeat", "mode", "state", "execState", "interpState", "callLevel", "motionLine", "currentLine",
        "readLine", "file", "command", "ini_filename", "g5x_offset", "g92_offset", "toolOffset", "g5x_index",
        "activeGCodes", "activeMCodes", "activeSettings", "programUnits", "interpreter_errcode",
        "input_timeout", "rotation_xy",
    )

    mode = integer(doc="EMC_TASK_MODE_ENUM")
    state = integer(doc="EMC_TASK_STATE_ENUM")
    execState = integer(doc="EMC_TASK_EXEC_ENUM")
    interpState = integer(doc="EMC_TASK_INTERP_ENUM")
    callLevel = integer(doc="depth of subroutine calls")
    motionLine = integer(doc="line of the executing move")
    currentLine = integer(doc="line being executed")
    readLine = integer(doc="line that the interpreter has read")
    optional_stop_state = boolean(doc="M1 stops", local=True)
    block_delete_state = boolean(doc="lines with / are left out", local=True)
    input_timeout = boolean(doc="M66 has timed out")
    file = char(LINELEN, wire=LINELEN + 1, cut=True, doc="path")
    command = char(LINELEN, wire=LINELEN + 1, cut=True, doc="block being executed")
    ini_filename = char(LINELEN, wire=LINELEN + 1, cut=True, doc="path")
    g5x_offset = struct(EmcPose, unit="lu, deg")
    g5x_index = integer(doc="1: G54 to 9: G59.3")
    g92_offset = struct(EmcPose, unit="lu, deg")
    rotation_xy = double(unit="deg")
    toolOffset = struct(EmcPose, unit="lu, deg")
    activeGCodes = integer(ACTIVE_G_CODES, doc="line number, then ten times each active code")
    activeMCodes = integer(ACTIVE_M_CODES, doc="line number, then each active code")
    activeSettings = double(ACTIVE_SETTINGS, doc="line number, feed, speed, path and naive-cam tolerance")
    programUnits = integer(doc="CANON_UNITS")
    interpreter_errcode = integer()
    task_paused = integer(local=True)
    delayLeft = double(unit="s", doc="of a G4 or M66", local=True)
    queuedMDIcommands = integer(local=True)
