"""Components that watch and tell: watchdog, message, and the buttons of a pendant, xhc_hb04_util. See ``declare.py``."""

from libc.math cimport floor
from libc.stdint cimport int32_t, int64_t, uint8_t

from hal._messages cimport say
from hal.cell cimport hal_at as at, hal_pin

from hal._calls import Memory
from hal._shm import BIT as BIT_TYPE, IN, RW
from hal.components.declare import BIT, FLOAT, S32, declare, numbers, param_rw, pin_in, pin_out
from nml.errors import HalError


# ---- watchdog ----

cdef enum:
    INPUTS = 32

cdef struct Watchdog:
    hal_pin input[INPUTS]
    hal_pin enable_in, ok_out
    hal_pin timeout[INPUTS]
    size_t inputs  # the personality
    int64_t limit_ns[INPUTS]
    int64_t quiet_ns[INPUTS]  # since the input changed last
    uint8_t old[INPUTS]
    uint8_t old_enable, watching

cdef struct Watchdogs:
    size_t count
    Watchdog* one

cdef void watchdog_process(Watchdogs* all_, long period) noexcept nogil:
    cdef Watchdog* s = all_.one
    cdef size_t i
    cdef uint8_t now
    if not at(s.enable_in).b or not s.watching:
        at(s.ok_out).b = 0
        return
    for i in range(s.inputs):
        now = at(s.input[i]).b
        s.quiet_ns[i] = 0 if now != s.old[i] else s.quiet_ns[i] + period
        s.old[i] = now
        if s.quiet_ns[i] > s.limit_ns[i]:
            s.watching = 0
    at(s.ok_out).b = s.watching

cdef void watchdog_set_timeouts(Watchdogs* all_, long period) noexcept nogil:
    """Timeouts as whole numbers for the fast function; a rising enable-in begins again."""
    cdef Watchdog* s = all_.one
    cdef bint enable = at(s.enable_in).b != 0
    cdef size_t i
    for i in range(s.inputs):
        s.limit_ns[i] = <int64_t>(max(at(s.timeout[i]).f, 0.0) * 1e9)
        if enable and not s.old_enable:
            s.quiet_ns[i] = 0
            s.old[i] = at(s.input[i]).b
    if enable and not s.old_enable:
        s.watching = at(s.ok_out).b = 1
    s.old_enable = enable


def watched(dict args) -> list:
    """The one instance's personality: how many inputs."""
    found = numbers("watchdog", args, "num_inputs")
    if len(found) != 1 or not 1 <= found[0] <= INPUTS:
        raise HalError(f"watchdog: num_inputs={args.get('num_inputs', '')}: from 1 to {INPUTS} would be right")
    return found


declare("watchdog", "Watches that inputs keep changing", sizeof(Watchdog), [
    pin_in(BIT, "input-{}", "must change within its timeout", count=INPUTS, personal=lambda p: p),
    pin_in(BIT, "enable-in", "false: ok-out is false; its rising edge begins again after a timeout"),
    pin_out(BIT, "ok-out", "enabled, and no input was late"),
    param_rw(FLOAT, "timeout-{}", "s", count=INPUTS, personal=lambda p: p),
], {}, integer=("process",), shared={"process": <size_t>&watchdog_process, "set-timeouts": <size_t>&watchdog_set_timeouts},
   counted_by="num_inputs", sizes=True, most=1, takes_names=False, decode=watched, keep_personality=True, instance="watchdog")


# ---- message ----

cdef struct Message:
    hal_pin trigger, force, edge
    const char* text
    uint8_t old_trigger, old_force

cdef void message(Message* s, long period) noexcept nogil:
    cdef bint active = (at(s.trigger).b != 0) == (at(s.edge).b != 0)
    cdef bint force = at(s.force).b != 0
    if active and (not s.old_trigger or (force and not s.old_force)):
        say(s.text)
    s.old_trigger, s.old_force = active, force


texts = []  # of all messages ever loaded: the ring may still hold them


def load_message(host, dict args):
    """A text for the operator at an edge: `names=oil,air messages="Oil low,No air"` makes `oil` and `air`, each with the pins
    `.trigger` and `.force` (say it again), the parameter `.edge` (true: rising) and a function of its name; `count=` makes
    `message.N`.
    """
    cdef Message* s
    cdef size_t address
    unknown = sorted(set(args) - {"names", "count", "messages"})
    if unknown:
        raise HalError(f"message: unknown parameter '{unknown[0]}'; names, count and messages are known")
    given = [text for text in args.get("messages", "").split(",") if text]
    names = args["names"].split(",") if "names" in args else [
        f"message.{i}" for i in range((numbers("message", args, "count") or [1])[0])]
    if len(given) < len(names):
        raise HalError(f"message: {len(given)} messages for {len(names)} instances; messages=\"one,another\" would be right")
    comp = host.component("message")
    for name, text in zip(names, given):
        memory = Memory(sizeof(Message))
        comp.keep(memory)
        raw = text.encode()
        texts.append(raw)
        address = memory.address
        s = <Message*>address
        s.text = <const char*><bytes>raw
        address = comp.pin(f"{name}.trigger", BIT_TYPE, IN).address
        s.trigger = <hal_pin>address
        address = comp.pin(f"{name}.force", BIT_TYPE, IN).address
        s.force = <hal_pin>address
        address = comp.param(f"{name}.edge", BIT_TYPE, RW, True).address
        s.edge = <hal_pin>address
        comp.function(name, <size_t>&message, <size_t>s, uses_fp=False)
    comp.ready()


# ---- xhc_hb04_util ----

cdef enum:
    FILTERS = 4

cdef struct XhcHb04Util:
    hal_pin start_or_pause, is_paused, is_idle, is_running, pause, resume, run
    hal_pin in_[FILTERS]
    hal_pin out[FILTERS]
    hal_pin scale[FILTERS]
    hal_pin coef[FILTERS]
    hal_pin divide_by_k_in, divide_by_k_out, k
    double value[FILTERS]
    uint8_t old_pressed

cdef void xhc_hb04_util(XhcHb04Util* s, long period) noexcept nogil:
    """What the button means is decided when it goes down, and stays until it is let go."""
    cdef bint pressed = at(s.start_or_pause).b != 0
    cdef int i
    if not pressed:
        at(s.run).b = at(s.pause).b = at(s.resume).b = 0
    elif not s.old_pressed:
        at(s.run).b = at(s.is_idle).b
        at(s.pause).b = at(s.is_running).b and not at(s.is_idle).b
        at(s.resume).b = at(s.is_paused).b and not at(s.is_running).b and not at(s.is_idle).b
    s.old_pressed = pressed
    for i in range(FILTERS):
        s.value[i] += (at(s.in_[i]).s * at(s.scale[i]).f - s.value[i]) * at(s.coef[i]).f
        at(s.out[i]).s = <int32_t>floor(s.value[i] + 0.5)
    if at(s.k).f != 0.0:
        at(s.divide_by_k_out).f = at(s.divide_by_k_in).f / at(s.k).f

declare("xhc_hb04_util", "One button for start, pause and resume, and four filters", sizeof(XhcHb04Util), [
    pin_in(BIT, "start-or-pause", "the button"), pin_in(BIT, "is-paused", "from halui.program"), pin_in(BIT, "is-idle"),
    pin_in(BIT, "is-running"), pin_out(BIT, "pause", "to halui.program"), pin_out(BIT, "resume"), pin_out(BIT, "run"),
    pin_in(S32, "in{}", "", count=FILTERS), pin_out(S32, "out{}", "in * scale, smoothed", count=FILTERS),
    pin_in(FLOAT, "scale{}", "", 1.0, count=FILTERS), pin_in(FLOAT, "coef{}", "0 to 1, smaller is slower", 1.0, count=FILTERS),
    pin_in(FLOAT, "divide-by-k-in"), pin_out(FLOAT, "divide-by-k-out", "in / k"), pin_in(FLOAT, "k", "", 1.0),
], {"": <size_t>&xhc_hb04_util})
