"""``linuxcnc.stat``: the state of the whole machine, as task last wrote it to emcStatus.

``poll`` copies the newest status message if there is a new one, and costs next to nothing if there is none. An
attribute decodes its own few bytes when it is read; a script that looks at two values pays for two. Lengths, speeds and
angles are in machine units (``linear_units`` per mm, ``angular_units`` per degree), times in s, spindle speeds in rpm.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import islice
from operator import attrgetter
from typing import Any, Generic, NamedTuple, TypeVar, cast, overload

from linuxcnc._connection import error, open_channel, pose_tuple
from nml.channel import Channel
from nml.emc import EMC_CALL_STACKS, EMC_STAT, EMC_TOOL_TABLE
from nml.emc.calls import CALLS_BUFFER, stack_at
from nml.errors import NmlError

T = TypeVar("T")


class tool_result(NamedTuple):
    """One tool of the tool table; offsets and diameter in machine units, angles in degrees."""

    id: int
    xoffset: float
    yoffset: float
    zoffset: float
    aoffset: float
    boffset: float
    coffset: float
    uoffset: float
    voffset: float
    woffset: float
    diameter: float
    frontangle: float
    backangle: float
    orientation: int


OFFSET_NAMES = tool_result._fields[1:10]
NO_TOOL = tool_result._make((-1, *[0.0] * 12, 0))

JOINT_KEYS = {
    "jointType": "jointType",
    "units": "units",
    "backlash": "backlash",
    "min_position_limit": "minPositionLimit",
    "max_position_limit": "maxPositionLimit",
    "max_ferror": "maxFerror",
    "min_ferror": "minFerror",
    "ferror_current": "ferrorCurrent",
    "ferror_highmark": "ferrorHighMark",
    "output": "output",
    "input": "input",
    "velocity": "velocity",
    "inpos": "inpos",
    "homing": "homing",
    "homed": "homed",
    "fault": "fault",
    "enabled": "enabled",
    "min_soft_limit": "minSoftLimit",
    "max_soft_limit": "maxSoftLimit",
    "min_hard_limit": "minHardLimit",
    "max_hard_limit": "maxHardLimit",
    "override_limits": "overrideLimits",
}

CALL_KEYS = ("subname", "filename", "line")
_call = attrgetter(*CALL_KEYS)

AXIS_KEYS = {
    "velocity": "velocity",
    "min_position_limit": "minPositionLimit",
    "max_position_limit": "maxPositionLimit",
}

SPINDLE_KEYS = {
    "brake": "brake",
    "direction": "direction",
    "enabled": "enabled",
    "increasing": "increasing",
    "override_enabled": "spindle_override_enabled",
    "speed": "speed",
    "override": "spindle_scale",
    "homed": "homed",
    "orient_state": "orient_state",
    "orient_fault": "orient_fault",
}

LIMIT_BITS = (("minHardLimit", 1), ("maxHardLimit", 2), ("minSoftLimit", 4), ("maxSoftLimit", 8))


class Value(Generic[T]):
    """One attribute of the status: where EMC_STAT holds it, how it becomes a Python value, what it means."""

    def __init__(self, path: str, convert: Callable[[Any], T] | None, doc: str) -> None:
        self.path = path
        self.__doc__ = doc
        self._get = attrgetter(path)
        self._convert = convert

    @overload
    def __get__(self, status: None, owner: type) -> Value[T]: ...
    @overload
    def __get__(self, status: stat, owner: type) -> T: ...
    def __get__(self, status: stat | None, owner: type) -> Value[T] | T:
        if status is None:
            return self
        value = self._get(status._message)
        return value if self._convert is None else self._convert(value)

    def __set__(self, status: stat, value: Any) -> None:
        raise AttributeError("the status is read-only")


def _integer(path: str, doc: str) -> Value[int]:
    return Value(path, None, doc)


def _real(path: str, doc: str) -> Value[float]:
    return Value(path, None, doc)


def _flag(path: str, doc: str) -> Value[bool]:
    return Value(path, bool, doc)


def _text(path: str, doc: str) -> Value[str]:
    return Value(path, None, doc)


def _pose(path: str, doc: str) -> Value[tuple[float, ...]]:
    return Value(path, pose_tuple, doc)


def _reals(path: str, doc: str) -> Value[tuple[float, ...]]:
    return Value(path, tuple, doc)


def _integers(path: str, doc: str) -> Value[tuple[int, ...]]:
    return Value(path, tuple, doc)


def _of_joints(field: str, doc: str) -> Value[tuple[Any, ...]]:
    """One value of each joint."""
    get = attrgetter(field)
    return Value("motion.joint", lambda joints: tuple([get(joint) for joint in joints]), doc)


def _dictionaries(path: str, keys: dict[str, str], doc: str) -> Value[tuple[dict[str, Any], ...]]:
    """One dictionary for each record of an array."""
    get = attrgetter(*keys.values())
    names = tuple(keys)
    return Value(path, lambda records: tuple([dict(zip(names, get(one), strict=True)) for one in records]), doc)


def _limit_masks(joints: Any) -> tuple[int, ...]:
    return tuple([sum(bit for name, bit in LIMIT_BITS if getattr(joint, name)) for joint in joints])


class stat:
    """Connection to the status channel; ``poll`` fetches the newest status."""

    acceleration = _real("motion.traj.acceleration", "default acceleration, [TRAJ]DEFAULT_LINEAR_ACCELERATION")
    active_queue = _integer("motion.traj.activeQueue", "moves that are blending")
    actual_position = _pose("motion.traj.actualPosition", "position of the controlled point from feedback")
    adaptive_feed_enabled = _flag("motion.traj.adaptive_feed_enabled", "M52 adaptive feed acts")
    ain = _reals("motion.analog_input", "motion.analog-in pins")
    angular_units = _real("motion.traj.angularUnits", "machine units per degree")
    aout = _reals("motion.analog_output", "motion.analog-out pins")
    axis = _dictionaries("motion.axis", AXIS_KEYS, "one dictionary for each axis")
    axis_mask = _integer("motion.traj.axis_mask", "axes: X=1 Y=2 Z=4 A=8 B=16 C=32 U=64 V=128 W=256")
    block_delete = _flag("task.block_delete_state", "lines that begin with '/' are skipped")
    call_level = _integer("task.callLevel", "subroutine depth, 0 in the main program")
    command = _text("task.command", "text of the executing MDI or program block")
    current_line = _integer("task.currentLine", "line that task executes")
    current_vel = _real("motion.traj.current_vel", "path velocity")
    cycle_time = _real("motion.traj.cycleTime", "servo period in s")
    debug = _integer("debug", "debug flags")
    delay_left = _real("task.delayLeft", "rest of a dwell in s")
    din = _integers("motion.synch_di", "motion.digital-in pins")
    distance_to_go = _real("motion.traj.distance_to_go", "rest of the executing move")
    dout = _integers("motion.synch_do", "motion.digital-out pins")
    dtg = _pose("motion.traj.dtg", "rest of the executing move for each axis")
    echo_serial_number = _integer("echo_serial_number", "serial number of the command that task took last")
    enabled = _flag("motion.traj.enabled", "motion is enabled")
    estop = _integer("io.aux.estop", "1 in E-stop")
    exec_state = _integer("task.execState", "EXEC_*")
    feed_hold_enabled = _flag("motion.traj.feed_hold_enabled", "feed hold acts")
    feed_override_enabled = _flag("motion.traj.feed_override_enabled", "M50 feed override acts")
    feedrate = _real("motion.traj.scale", "feed override, 1.0 = 100 %")
    file = _text("task.file", "path of the loaded program")
    flood = _integer("io.coolant.flood", "FLOOD_*")
    g5x_index = _integer("task.g5x_index", "coordinate system: G54 = 1 .. G59.3 = 9")
    g5x_offset = _pose("task.g5x_offset", "offset of the active coordinate system")
    g92_offset = _pose("task.g92_offset", "G92 offset")
    gcodes = _integers("task.activeGCodes", "active G-code of each modal group, times ten")
    heartbeat = _integer("motion.heartbeat", "servo periods since motion began, modulo 2**32; LinuxCNC's has it not")
    homed = _of_joints("homed", "1 for each homed joint")
    id = _integer("motion.traj.id", "id of the executing move")
    ini_filename = _text("task.ini_filename", "path of the INI file")
    inpos = _flag("motion.traj.inpos", "machine in position")
    input_timeout = _flag("task.input_timeout", "M66 ended by its timeout")
    interp_state = _integer("task.interpState", "INTERP_*")
    interpreter_errcode = _integer("task.interpreter_errcode", "last return code of the interpreter")
    joint = _dictionaries("motion.joint", JOINT_KEYS, "one dictionary for each joint")
    joint_actual_position = _of_joints("input", "joint positions from feedback")
    joint_position = _of_joints("output", "commanded joint positions")
    joints = _integer("motion.traj.joints", "number of joints")
    kinematics_type = _integer("motion.traj.kinematics_type", "KINEMATICS_*")
    limit = Value("motion.joint", _limit_masks, "limits of each joint: 1 min hard, 2 max hard, 4 min soft, 8 max soft")
    linear_units = _real("motion.traj.linearUnits", "machine units per mm")
    lube = _integer("io.lube.on", "1: lubrication on")
    lube_level = _integer("io.lube.level", "iocontrol.0.lube_level")
    max_acceleration = _real("motion.traj.maxAcceleration", "[TRAJ]MAX_LINEAR_ACCELERATION")
    max_velocity = _real("motion.traj.maxVelocity", "largest path velocity, [TRAJ]MAX_LINEAR_VELOCITY or maxvel()")
    mcodes = _integers("task.activeMCodes", "active M-codes")
    misc_error = _integers("motion.misc_error", "motion.misc-error pins")
    mist = _integer("io.coolant.mist", "MIST_*")
    motion_id = _integer("motion.traj.id", "id of the executing move")
    motion_line = _integer("task.motionLine", "program line of the executing move")
    motion_mode = _integer("motion.traj.mode", "TRAJ_MODE_*")
    motion_type = _integer("motion.traj.motion_type", "MOTION_TYPE_*, 0 at rest")
    num_extrajoints = _integer("motion.numExtraJoints", "joints beyond those of the kinematics")
    optional_stop = _flag("task.optional_stop_state", "M1 stops")
    paused = _flag("motion.traj.paused", "motion paused")
    pocket_prepped = _integer("io.tool.pocketPrepped", "tool table index of the prepared tool, -1: none")
    position = _pose("motion.traj.position", "commanded position of the controlled point")
    probe_tripped = _flag("motion.traj.probe_tripped", "the probe met something")
    probe_val = _integer("motion.traj.probeval", "motion.probe-input")
    probed_position = _pose("motion.traj.probedPosition", "where the probe tripped")
    probing = _flag("motion.traj.probing", "a probe move is under way")
    program_units = _integer("task.programUnits", "1 inch, 2 mm, 3 cm")
    queue = _integer("motion.traj.queue", "moves in the planner's queue")
    queue_full = _flag("motion.traj.queueFull", "the planner's queue is full")
    queued_mdi_commands = _integer("task.queuedMDIcommands", "MDI commands that wait")
    rapidrate = _real("motion.traj.rapid_scale", "rapid override, 1.0 = 100 %")
    read_line = _integer("task.readLine", "line that the interpreter has read")
    rotation_xy = _real("task.rotation_xy", "rotation of the coordinate system about Z in degrees")
    settings = _reals("task.activeSettings", "sequence number, feed, speed, G64 P and Q")
    spindle = _dictionaries("motion.spindle", SPINDLE_KEYS, "one dictionary for each spindle")
    spindles = _integer("motion.traj.spindles", "number of spindles")
    state = _integer("status", "RCS_* of the last command")
    task_mode = _integer("task.mode", "MODE_*")
    task_paused = _integer("task.task_paused", "1: the program is paused")
    task_state = _integer("task.state", "STATE_*")
    tool_from_pocket = _integer("io.tool.toolFromPocket", "pocket that the loaded tool came from")
    tool_in_spindle = _integer("io.tool.toolInSpindle", "number of the loaded tool, 0: none")
    tool_offset = _pose("task.toolOffset", "tool offset in force")
    velocity = _real("motion.traj.velocity", "default velocity, [TRAJ]DEFAULT_LINEAR_VELOCITY")

    def __init__(self) -> None:
        self._channel = open_channel("emcStatus")
        self._tools: Channel | None = None
        self._calls: Channel | None = None
        self._stacks = EMC_CALL_STACKS()
        self._tool_table: tuple[tool_result, ...] = (NO_TOOL,)
        self._tools_by_number: dict[int, dict[str, Any]] = {}
        self._message = EMC_STAT()
        self._data = cast(bytearray, self._message.data)
        self._poll_into = self._channel.poll_into
        self.poll()

    def poll(self) -> None:
        """Fetch the newest status; without a new one the old values stay. ``error``: the machine is out of reach."""
        try:
            self._poll_into(self._data)
        except NmlError as reason:
            raise error(str(reason)) from reason

    def wait(self, timeout: float) -> bool:
        """Wait up to ``timeout`` s for a status that ``poll`` has not fetched; at once true when there is one."""
        return self._channel.wait(timeout)

    @property
    def tool_table(self) -> tuple[tool_result, ...]:
        """The tool table, the loaded tool first; unused places have the id -1."""
        self._renew_tools()
        return self._tool_table

    def toolinfo(self, toolno: int) -> dict[str, Any]:
        """What the tool table has about a tool: toolno, pocketno, offsets, diameter, angles, orientation, comment."""
        self._renew_tools()
        if toolno not in self._tools_by_number:
            raise error(f"toolinfo({toolno}): there is no such tool in the tool table")
        return dict(self._tools_by_number[toolno])

    def _renew_tools(self) -> None:
        """Take over a tool table that io has written since the last look."""
        if self._tools is None:
            self._tools = open_channel("toolTable")
        table = self._tools.peek()
        if isinstance(table, EMC_TOOL_TABLE):
            self._tool_table = _tool_table(table)
            self._tools_by_number = _tools_by_number(table)

    @property
    def call_stack(self) -> tuple[dict[str, Any], ...]:
        """The calls that the executing move stands in, the outermost first: subname, filename and line of the call."""
        if self._calls is None:
            self._calls = open_channel(CALLS_BUFFER)
        stacks = self._calls.peek()
        if isinstance(stacks, EMC_CALL_STACKS):
            self._stacks = stacks
        stack = stack_at(self._stacks, self._message.task.heartbeat)
        return tuple([dict(zip(CALL_KEYS, _call(one), strict=True)) for one in islice(stack.frames, stack.depth)])

    @property
    def axes(self) -> int:
        """Number of axes of [TRAJ]COORDINATES."""
        return self._message.motion.traj.axis_mask.bit_count()

    def __repr__(self) -> str:
        return f"<linuxcnc.stat of {self._message.task.ini_filename or 'no machine'}>"


def _tool_table(message: EMC_TOOL_TABLE) -> tuple[tool_result, ...]:
    """The tools of io's table up to the last used place; index 0 is the spindle."""
    return tuple(
        [
            tool_result._make(
                (one.toolno, *pose_tuple(one.offset), one.diameter, one.frontangle, one.backangle, one.orientation)
            )
            for one in islice(message.tools, message.last_index + 1)
        ]
    )


def _tools_by_number(message: EMC_TOOL_TABLE) -> dict[int, dict[str, Any]]:
    """The same for each tool that has a number, with its pocket."""
    return {
        one.toolno: {
            "toolno": one.toolno,
            "pocketno": one.pocketno,
            "diameter": one.diameter,
            "frontangle": one.frontangle,
            "backangle": one.backangle,
            "orientation": one.orientation,
            **dict(zip(OFFSET_NAMES, pose_tuple(one.offset), strict=True)),
            "comment": remark.text,
        }
        for one, remark in islice(zip(message.tools, message.remarks, strict=True), 1, message.last_index + 1)
        if one.toolno > 0
    }
