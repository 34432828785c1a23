"""The realtime module ``motmod``: motion with its HAL pins, its two functions, its threads and its NML buffers.

``motion-command-handler`` takes the commands that task has queued, ``motion-controller`` runs one period and
publishes the status. Both are native and never wait: commands, status and error texts go through the lock-free side
of the NML buffers.
"""

from libc.stdint cimport int32_t, int64_t, uint64_t, uintptr_t
from libc.stdlib cimport calloc, free
from libc.string cimport memmove, memset
from posix.time cimport CLOCK_MONOTONIC, clock_gettime, timespec

from emcmot._messages cimport EMCMOT_COMMAND, EMCMOT_ERROR, EMCMOT_STATUS
from emcmot.commands cimport run, sign_of_life
from emcmot.controller cimport controller
from emcmot.core cimport Core
from emcmot.kins.kinematics cimport KinematicsModule
from emcmot.modules cimport HomingModule, PlannerModule
from emcmot.state cimport Motion
from emcmot.status cimport fill_status
from hal.cell cimport hal_at, hal_pin
from nml._layout cimport SLOTS
from nml._shm cimport pulse_count, queue_pop, queue_push, slot_begin, slot_commit

from operator import itemgetter

from emcmot.core import LIMITS
from emcmot.layout import same_size
from emcmot.modules import HOMING, PLANNER
from hal import HAL_BIT, HAL_FLOAT, HAL_IN, HAL_IO, HAL_OUT, HAL_RO, HAL_S32, HAL_U32
from nml.channel import Channel
from nml.errors import HalError

same_size(__name__, "Motion", sizeof(Motion))

cdef int COMMANDS_PER_PERIOD = 256
cdef int64_t LONGEST_STEP = 10_000_000  # ns that count between two periods: a host that was held up held task up as well
cdef int64_t COMMAND_SHARE = 4     # the handler stops taking commands after this part of a period

NAME_LISTS = ("names_din", "names_dout", "names_ain", "names_aout", "names_misc_errors")
PERIODS = {"base_period_nsec": 0, "servo_period_nsec": 1_000_000, "traj_period_nsec": 0}
IGNORED = ("base_thread_fp",)
TYPES = {"float": HAL_FLOAT, "bit": HAL_BIT, "s32": HAL_S32, "u32": HAL_U32}
DIRECTIONS = {"IN": HAL_IN, "OUT": HAL_OUT, "IO": HAL_IO}
DEBUG_PARAMETERS = (
    *((f"motion.debug-bit-{n}", HAL_BIT) for n in range(2)),
    *((f"motion.debug-float-{n}", HAL_FLOAT) for n in range(4)),
    *((f"motion.debug-s32-{n}", HAL_S32) for n in range(2)),
)

cdef enum:                # how a pin and its member are copied
    WIDTH_FLOAT
    WIDTH_INT
    WIDTH_BIT
    WIDTH_NUMBER         # a double, of a pin that is a whole number or a bit
    ALL_WIDTHS

WIDTHS = {"float": WIDTH_FLOAT, "bit": WIDTH_BIT, "s32": WIDTH_INT, "u32": WIDTH_INT}

ctypedef struct Binding:
    hal_pin pin
    void* at             # a double, or an int32_t

ctypedef struct Bindings:    # the pins of one direction, those of a width side by side
    Binding* rows
    int end[ALL_WIDTHS]      # of the rows of each width

ctypedef struct Both:    # an IO pin, which is a bit
    Binding binding
    int32_t seen         # what was read; written back only where motion changed it

ctypedef struct Servo:   # everything that the two functions touch
    Motion* m
    void* commands
    void* status
    void* errors
    Bindings inputs
    Bindings outputs
    Both* both
    int both_count
    int64_t last_ns
    int64_t handled_ns   # when commands were taken last
    uint64_t pulse       # task's sign of life seen last
    EMCMOT_COMMAND record


cdef int64_t now_ns() noexcept nogil:
    cdef timespec t
    clock_gettime(CLOCK_MONOTONIC, &t)
    return t.tv_sec * 1000000000LL + t.tv_nsec


cdef void read_pins(Servo* s) noexcept nogil:
    cdef const Binding* rows = s.inputs.rows
    cdef const int* end = s.inputs.end
    cdef Binding* bit
    cdef int n
    for n in range(end[WIDTH_FLOAT]):
        (<double*>rows[n].at)[0] = hal_at(rows[n].pin).f
    for n in range(end[WIDTH_FLOAT], end[WIDTH_INT]):
        (<int32_t*>rows[n].at)[0] = hal_at(rows[n].pin).s
    for n in range(end[WIDTH_INT], end[WIDTH_BIT]):
        (<int32_t*>rows[n].at)[0] = hal_at(rows[n].pin).b != 0
    for n in range(end[WIDTH_BIT], end[WIDTH_NUMBER]):
        (<double*>rows[n].at)[0] = hal_at(rows[n].pin).s
    for n in range(s.both_count):
        bit = &s.both[n].binding
        s.both[n].seen = (<int32_t*>bit.at)[0] = hal_at(bit.pin).b != 0


cdef void write_pins(Servo* s) noexcept nogil:
    cdef const Binding* rows = s.outputs.rows
    cdef const int* end = s.outputs.end
    cdef Binding* bit
    cdef int n
    for n in range(end[WIDTH_FLOAT]):
        hal_at(rows[n].pin).f = (<double*>rows[n].at)[0]
    for n in range(end[WIDTH_FLOAT], end[WIDTH_INT]):
        hal_at(rows[n].pin).s = (<int32_t*>rows[n].at)[0]
    for n in range(end[WIDTH_INT], end[WIDTH_BIT]):
        hal_at(rows[n].pin).b = (<int32_t*>rows[n].at)[0] != 0
    for n in range(end[WIDTH_BIT], end[WIDTH_NUMBER]):
        hal_at(rows[n].pin).s = <int32_t>(<double*>rows[n].at)[0]
    for n in range(s.both_count):
        bit = &s.both[n].binding
        if (<int32_t*>bit.at)[0] != s.both[n].seen:
            hal_at(bit.pin).b = (<int32_t*>bit.at)[0] != 0


cdef void send_errors(Servo* s) noexcept nogil:
    """Texts that find no room wait for the next period."""
    cdef Motion* m = s.m
    cdef int sent = 0
    while sent < m.error_count and queue_push(s.errors, &m.errors[sent], sizeof(EMCMOT_ERROR)) == 0:
        sent += 1
    m.error_count -= sent
    if sent and m.error_count:
        memmove(&m.errors[0], &m.errors[sent], m.error_count * sizeof(EMCMOT_ERROR))


cdef void command_handler(void* arg, long period_ns) noexcept nogil:
    """HAL function motion-command-handler."""
    cdef Servo* s = <Servo*>arg
    cdef int taken = 0
    cdef size_t size
    cdef int64_t start = now_ns()
    cdef uint64_t pulse = pulse_count(s.commands)
    s.m.host_now += min(start - s.handled_ns, LONGEST_STEP) * 1e-9
    s.handled_ns = start
    if pulse != s.pulse:
        s.pulse = pulse
        sign_of_life(s.m)
    while taken < COMMANDS_PER_PERIOD and (taken & 15 or now_ns() - start < period_ns // COMMAND_SHARE):
        size = queue_pop(s.commands, &s.record, sizeof(EMCMOT_COMMAND))
        if size == 0:
            break
        run(s.m, &s.record, size)
        taken += 1


cdef void publish(Servo* s) noexcept nogil:
    """Write the status where its readers find it. What this machine does not have is cleared once in every slot."""
    cdef void* slot = slot_begin(s.status)
    if s.m.heartbeat <= SLOTS:
        memset(slot, 0, sizeof(EMCMOT_STATUS))
    fill_status(<EMCMOT_STATUS*>slot, s.m)
    slot_commit(s.status, sizeof(EMCMOT_STATUS))


cdef void motion_controller(void* arg, long period_ns) noexcept nogil:
    """HAL function motion-controller."""
    cdef Servo* s = <Servo*>arg
    cdef Motion* m = s.m
    cdef int64_t start = now_ns()
    m.last_period = <int32_t>(start - s.last_ns)
    s.last_ns = start
    read_pins(s)
    controller(m)
    write_pins(s)
    send_errors(s)
    publish(s)
    m.servo_time = (now_ns() - start) * 1e-9
    if m.servo_time > m.servo_time_max:
        m.servo_time_max = m.servo_time


cdef class Motmod(Core):
    """Motion as a loaded module: the core, its bindings and its buffers."""

    cdef Servo servo
    cdef list channels

    def __cinit__(self):
        self.channels = []

    def __dealloc__(self):
        free(self.servo.inputs.rows)
        free(self.servo.outputs.rows)
        free(self.servo.both)

    def connect(self):
        """Open the buffers between task and motion."""
        addresses = []
        for name in ("emcmotCommand", "emcmotStatus", "emcmotError"):
            channel = Channel(None, name, "emcmot")
            self.channels.append(channel)
            addresses.append(channel.address)
        self.servo.m = self.m
        self.servo.commands = <void*><uintptr_t>addresses[0]
        self.servo.status = <void*><uintptr_t>addresses[1]
        self.servo.errors = <void*><uintptr_t>addresses[2]
        self.servo.last_ns = self.servo.handled_ns = now_ns()

    def disconnect(self):
        for channel in self.channels:
            channel.close()
        self.channels.clear()

    def bind(self, comp, dict renamed):
        """Make the HAL pins, and bind them and those of the kinematics."""
        groups = {"IN": [], "OUT": [], "IO": []}
        for pin in self.pins:
            value = self._value(pin)
            made = comp.pin(renamed.get(pin.name, pin.name), TYPES[pin.type], DIRECTIONS[pin.direction], value=value)
            groups[pin.direction].append((made.address, pin.address, WIDTHS[pin.type]))
        for cell, at, kind, direction in self.kinematics.bindings:
            groups[direction].append((cell, at, WIDTH_FLOAT if kind == "float" else WIDTH_NUMBER))
        sort_by_width(&self.servo.inputs, groups["IN"])
        sort_by_width(&self.servo.outputs, groups["OUT"])
        self.servo.both, self.servo.both_count = both(groups["IO"]), len(groups["IO"])
        for name, kind in DEBUG_PARAMETERS:
            comp.param(name, kind, HAL_RO)

    def _value(self, pin):
        """What a pin starts with: the state's own default."""
        if pin.type == "float":
            return (<double*><uintptr_t>pin.address)[0]
        value = (<int32_t*><uintptr_t>pin.address)[0]
        return bool(value) if pin.type == "bit" else value

    def functions(self, comp):
        arg = <uintptr_t>&self.servo
        comp.function("motion-command-handler", <uintptr_t><void*>command_handler, arg)
        comp.function("motion-controller", <uintptr_t><void*>motion_controller, arg)


cdef void sort_by_width(Bindings* made, list rows) except *:
    """Bindings of (address of the HAL pin, address of the member, Width)."""
    made.rows = <Binding*>calloc(len(rows) + 1, sizeof(Binding))
    if made.rows == NULL:
        raise MemoryError
    rows = sorted(rows, key=itemgetter(2))
    for n, (pin, at, width) in enumerate(rows):
        made.rows[n] = Binding(<hal_pin><uintptr_t>pin, <void*><uintptr_t>at)
    for width in range(ALL_WIDTHS):
        made.end[width] = sum(row[2] <= width for row in rows)


cdef Both* both(list rows) except? NULL:
    """Those of the pins that motion and others write."""
    cdef Both* made = <Both*>calloc(len(rows) + 1, sizeof(Both))
    if made == NULL:
        raise MemoryError
    for n, (pin, at, width) in enumerate(rows):
        if width != WIDTH_BIT:
            raise HalError(f"motmod: IO pin {n} is no bit")
        made[n].binding = Binding(<hal_pin><uintptr_t>pin, <void*><uintptr_t>at)
    return made


def integer(name, text):
    try:
        return int(text, 0)
    except ValueError:
        raise HalError(f"motmod: {name}={text}: an integer is needed") from None


def periods_of(args: dict) -> dict:
    """The three periods in ns; HalError where they do not divide each other."""
    periods = {name: integer(name, args.get(name, str(default))) for name, default in PERIODS.items()}
    base, servo, traj = periods["base_period_nsec"], periods["servo_period_nsec"], periods["traj_period_nsec"]
    if not 10_000 <= servo <= 1_000_000_000:
        raise HalError(f"motmod: servo_period_nsec={servo}: 10000 to 1000000000 are allowed")
    if base and not 1000 <= base <= servo:
        raise HalError(f"motmod: base_period_nsec={base}: 0, or 1000 to servo_period_nsec={servo}, are allowed")
    if traj and traj < servo:
        raise HalError(f"motmod: traj_period_nsec={traj}: 0, or at least servo_period_nsec={servo}, are allowed")
    return periods


def renamed_pins(args: dict, numbers: dict) -> dict:
    """Pin names that ``names_din=coolant,door`` and its like give; they also set the number of such pins."""
    renamed = {}
    lists = {key: [n for n in args[key].split(",") if n] for key in NAME_LISTS if key in args}
    if "names_din" in lists or "names_dout" in lists:
        numbers["num_dio"] = max(len(lists.get("names_din", [])), len(lists.get("names_dout", [])))
    if "names_ain" in lists or "names_aout" in lists:
        numbers["num_aio"] = max(len(lists.get("names_ain", [])), len(lists.get("names_aout", [])))
    if "names_misc_errors" in lists:
        numbers["num_misc_error"] = len(lists["names_misc_errors"])
    for key, stem, prefix in (
        ("names_din", "digital-in", "din"),
        ("names_dout", "digital-out", "dout"),
        ("names_ain", "analog-in", "ain"),
        ("names_aout", "analog-out", "aout"),
        ("names_misc_errors", "misc-error", "err"),
    ):
        for n, name in enumerate(lists.get(key, [])):
            renamed[f"motion.{stem}-{n:02d}"] = f"motion.{prefix}-{name}"
    return renamed


def load(host, args: dict) -> None:
    """``loadrt motmod``: needs a kinematics, makes the threads that its periods ask for."""
    known = (*LIMITS, *PERIODS, *NAME_LISTS, *IGNORED)
    for name in args:
        if name not in known:
            raise HalError(f"motmod: unknown argument {name}; known: {', '.join(known)}")
    kinematics = host.require("kinematics")
    if not isinstance(kinematics, KinematicsModule):
        raise HalError("motmod: what was loaded as kinematics is none")
    planner, homing = host.require("planner", PLANNER), host.require("homing", HOMING)
    for what, module, kind in (("planner", planner, PlannerModule), ("homing", homing, HomingModule)):
        if not isinstance(module, kind):
            raise HalError(f"motmod: what was loaded as {what} is none")
    periods = periods_of(args)
    numbers = {name: integer(name, args[name]) for name in LIMITS if name in args}
    renamed = renamed_pins(args, numbers)
    comp = host.component("motmod")
    module = Motmod(kinematics, periods["servo_period_nsec"] * 1e-9, planner, homing, **numbers)
    comp.keep(module)
    module.connect()
    comp.on_unload(module.disconnect)
    module.bind(comp, renamed)
    if periods["base_period_nsec"]:
        host.thread("base-thread", periods["base_period_nsec"])
    module.functions(comp)
    host.thread("servo-thread", periods["servo_period_nsec"])
    comp.ready()
