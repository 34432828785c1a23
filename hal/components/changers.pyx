"""What turns tool changers and tells their place: carousel, modmath. See ``declare.py``."""

from libc.math cimport fabs, rint
from libc.stdint cimport int32_t, uint8_t

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import BIT, FLOAT, S32, U32, declare, numbers, param_ro, pin_in, pin_io, pin_out
from nml.errors import HalError

# ---- carousel ----

cdef enum:
    SENSES = 16
    CHANGERS = 8  # instances

cdef enum Encoding:
    GRAY
    BINARY
    BCD
    SINGLE
    INDEX
    EDGE
    COUNTS

cdef enum State:  # the numbers of LinuxCNC's parameter `state`
    AT_REST = 0
    TO_POCKET = 2
    AGAINST_STOP = 3
    SLOWING = 5
    OFF_MARKER = 7
    ON_MARKER = 8
    ARRIVED = 9
    HOMING = 11
    JOGGING = 20

cdef struct Layout:  # the personality, a byte each
    uint8_t pockets, encoding, senses, directions, odd

cdef struct Carousel:
    hal_pin pocket_number, enable, active, ready, strobe, parity
    hal_pin sense[SENSES]
    hal_pin rev_pulse, fwd_dc, rev_dc, hold_dc, align_dc, decel_time, counts, scale, width, home_offset, index_enable
    hal_pin jog_fwd, jog_rev, motor_fwd, motor_rev, parity_error, current_position, motor_vel, homed, unhome
    hal_pin state, homing, motor_dir, timer, debounce
    size_t personality
    double wait  # s, of what is timed
    int32_t home_counts, jog_target
    uint8_t marker, was_marker, armed


cdef Layout layout(Carousel* s) noexcept nogil:
    return Layout(s.personality & 255, s.personality >> 8 & 255, s.personality >> 16 & 255, s.personality >> 24 & 255,
                  s.personality >> 32 & 255)

cdef int32_t around(int32_t pocket, int32_t pockets) noexcept nogil:
    """The pocket's number from 1, where they begin again behind the last one."""
    pocket = (pocket - 1) % pockets
    return (pocket + pockets if pocket < 0 else pocket) + 1

cdef int reading(Carousel* s, Layout* of) noexcept nogil:
    """The place that the sensors tell."""
    cdef int i, bits = 0, highest = 0
    for i in range(of.senses):
        if at(s.sense[i]).b:
            bits |= 1 << i
            highest = i + 1
    if of.encoding == SINGLE:
        return highest
    if of.encoding == BCD:
        return 10 * (bits >> 4) + (bits & 15)
    if of.encoding == GRAY:
        bits ^= bits >> 8
        bits ^= bits >> 4
        bits ^= bits >> 2
        bits ^= bits >> 1
    return bits

cdef bint parity_is_wrong(Carousel* s, Layout* of) noexcept nogil:
    cdef int i, ones = at(s.parity).b != 0
    for i in range(of.senses):
        ones += at(s.sense[i]).b != 0
    return ones & 1 != of.odd

cdef void locate(Carousel* s, Layout* of) noexcept nogil:
    """Where it is now, and whether the marker of a pocket is seen."""
    cdef double way, nearest
    if of.encoding == COUNTS:
        if not at(s.homed).b or at(s.scale).s == 0:
            return
        way = at(s.counts).s - s.home_counts - at(s.home_offset).s
        nearest = rint(way / at(s.scale).s)
        s.marker = 2.0 * fabs(way - nearest * at(s.scale).s) <= at(s.width).s
        if s.marker:
            at(s.current_position).s = around(<int32_t>nearest + 1, of.pockets)
    elif of.encoding == INDEX or of.encoding == EDGE:
        s.marker = at(s.sense[1]).b != 0
        if at(s.homed).b and at(s.active).b and s.marker != s.was_marker and (s.marker or of.encoding == EDGE):
            at(s.current_position).s = around(at(s.current_position).s + at(s.motor_dir).s, of.pockets)
        s.was_marker = s.marker
    elif at(s.strobe).b:
        at(s.current_position).s = reading(s, of)
        if of.encoding != SINGLE:
            at(s.parity_error).b = parity_is_wrong(s, of)

cdef int32_t wanted(Carousel* s, Layout* of) noexcept nogil:
    """The pocket that is asked for; one below 1 is none, which it stands at already."""
    return around(at(s.pocket_number).s, of.pockets) if at(s.pocket_number).s > 0 else at(s.current_position).s

cdef int shortest(Carousel* s, Layout* of, int32_t target) noexcept nogil:
    cdef int32_t way = around(target - at(s.current_position).s + 1, of.pockets) - 1
    return -1 if of.directions == 2 and 2 * way > of.pockets else 1

cdef void go(Carousel* s, int state, int direction) noexcept nogil:
    at(s.state).s = state
    at(s.motor_dir).s = direction
    at(s.active).b = 1
    at(s.ready).b = 0

cdef void wait(Carousel* s, int state, double seconds) noexcept nogil:
    at(s.state).s = state
    s.wait = seconds

cdef void arrive(Carousel* s) noexcept nogil:
    at(s.state).s = ARRIVED
    at(s.active).b = 0
    at(s.ready).b = 1

cdef void rest(Carousel* s) noexcept nogil:
    at(s.state).s = AT_REST
    at(s.motor_dir).s = 0
    at(s.active).b = 0

cdef void begin(Carousel* s, Layout* of) noexcept nogil:
    """At rest: what is asked for."""
    cdef int way = (at(s.jog_fwd).b != 0) - (at(s.jog_rev).b != 0 and of.directions == 2)
    if at(s.enable).b and of.encoding >= INDEX and not at(s.homed).b:
        go(s, HOMING, 1)
        at(s.homing).b = at(s.index_enable).b = s.armed = 1
    elif at(s.enable).b and at(s.current_position).s == wanted(s, of):
        arrive(s)
    elif at(s.enable).b:
        go(s, TO_POCKET, shortest(s, of, wanted(s, of)))
    elif way != 0:
        s.jog_target = around(at(s.current_position).s + way, of.pockets)
        go(s, JOGGING, way)

cdef void search_home(Carousel* s, Layout* of) noexcept nogil:
    """Turn forwards to the index, whatever `enable` does meanwhile; then go on to the pocket."""
    cdef bint found = at(s.sense[0]).b and (of.encoding == COUNTS or at(s.sense[1]).b)
    if of.encoding == COUNTS and s.armed and not at(s.index_enable).b:
        found = True
    if not found:
        return
    at(s.current_position).s = 1
    s.home_counts = at(s.counts).s
    at(s.homed).b = s.was_marker = 1
    at(s.homing).b = at(s.index_enable).b = s.armed = 0
    if at(s.enable).b:
        go(s, TO_POCKET, shortest(s, of, wanted(s, of)))
    else:
        rest(s)

cdef void stop_at_pocket(Carousel* s, Layout* of) noexcept nogil:
    if at(s.current_position).s != wanted(s, of):
        return
    if at(s.rev_pulse).f > 0.0:
        wait(s, AGAINST_STOP, at(s.rev_pulse).f)
    elif at(s.align_dc).f != 0.0:
        wait(s, SLOWING, at(s.decel_time).f)
    else:
        arrive(s)

cdef bint at_marker(Carousel* s, Layout* of) noexcept nogil:
    return s.marker if of.encoding >= INDEX else at(s.current_position).s == wanted(s, of)

cdef void advance(Carousel* s, Layout* of, double dt) noexcept nogil:
    """One period."""
    cdef int state = at(s.state).s
    s.wait -= dt
    if state == AT_REST:
        begin(s, of)
    elif state == HOMING:
        search_home(s, of)
    elif state == JOGGING:
        if at(s.active).b and at(s.current_position).s == s.jog_target:
            at(s.active).b = 0
        if not (at(s.active).b or at(s.jog_fwd).b or at(s.jog_rev).b):
            rest(s)
    elif not at(s.enable).b:
        rest(s)
    elif state == TO_POCKET:
        stop_at_pocket(s, of)
    elif state == AGAINST_STOP and s.wait <= 0.0:
        arrive(s)
    elif state == SLOWING and s.wait <= 0.0 and (at(s.motor_dir).s < 0 or at_marker(s, of)):
        at(s.state).s = OFF_MARKER
    elif state == OFF_MARKER and not at_marker(s, of):
        at(s.state).s = ON_MARKER
    elif state == ON_MARKER and at_marker(s, of):
        arrive(s)

cdef void drive(Carousel* s) noexcept nogil:
    """The motor, by the state. To align, it creeps back over the marker and off it, then on to its near edge."""
    cdef int state = at(s.state).s, way = at(s.motor_dir).s if at(s.active).b else 0
    cdef double creep = 0.0
    if state == AGAINST_STOP:
        way = -1
    elif SLOWING <= state <= ON_MARKER:
        creep = 0.0 if s.wait > 0.0 else at(s.align_dc).f
        way = 0 if s.wait > 0.0 else 1 if state == ON_MARKER else -1
    at(s.motor_fwd).b = way > 0
    at(s.motor_rev).b = way < 0
    if SLOWING <= state <= ON_MARKER:
        at(s.motor_vel).f = way * creep
    else:
        at(s.motor_vel).f = at(s.hold_dc).f if way == 0 else at(s.fwd_dc).f if way > 0 else at(s.rev_dc).f

cdef void carousel(Carousel* s, long period) noexcept nogil:
    cdef Layout of = layout(s)
    if at(s.unhome).b:
        at(s.homed).b = 0
    locate(s, &of)
    advance(s, &of, period * 1e-9)
    at(s.timer).f = max(s.wait, 0.0)
    drive(s)


ENCODINGS = {
    "gray": GRAY, "binary": BINARY, "bcd": BCD, "single": SINGLE, "index": INDEX, "edge": EDGE, "counts": COUNTS,
}


def changers(dict args) -> list:
    """A personality for each number of `pockets`, one of 8 where none is given; what another list lacks is as before it."""
    pockets = numbers("carousel", args, "pockets") if "pockets" in args else [8]
    if not 1 <= len(pockets) <= CHANGERS or not all(1 <= count <= 255 for count in pockets):
        given = args.get("pockets", "")
        raise HalError(f"carousel: pockets={given}: up to {CHANGERS} numbers from 1 to 255 would be right")
    encodings = [word for word in args.get("encoding", "").split(",") if word] or ["gray"]
    for word in encodings:
        if word not in ENCODINGS:
            raise HalError(f"carousel: encoding={word}: {', '.join(ENCODINGS)} are known")
    lists = [pockets, [ENCODINGS[word] for word in encodings]]
    for key, default, low, high in (("num_sense", 4, 1, SENSES), ("dir", 2, 0, 2), ("parity", 0, 0, 1)):
        given = numbers("carousel", args, key) or [default]
        if not all(low <= number <= high for number in given):
            raise HalError(f"carousel: {key}={args[key]}: from {low} to {high} would be right")
        lists.append(given)
    made = []
    for i in range(len(pockets)):
        values = [values[min(i, len(values) - 1)] for values in lists]
        if values[1] == SINGLE:
            values[2] = min(values[0], SENSES)
        elif values[1] == INDEX or (values[1] == EDGE and values[2] < 2):
            values[2] = 2
        made.append(sum(value << 8 * place for place, value in enumerate(values)))
    return made


declare("carousel", "Turns a tool changer's carousel to a pocket", sizeof(Carousel), [
    pin_in(S32, "pocket-number", "to go to; those behind the last count on from the first"),
    pin_in(BIT, "enable", "true: go there; false: stop, but for homing"), pin_out(BIT, "active"),
    pin_out(BIT, "ready", "the pocket is in position"),
    pin_in(BIT, "strobe", "the sensors may be read", True), pin_in(BIT, "parity", "of the sensors"),
    pin_in(BIT, "sense-{}", "by the encoding; index, edge: 0 index, 1 pocket; counts: 0 index", count=SENSES,
           personal=lambda p: p >> 16 & 255),
    pin_in(FLOAT, "rev-pulse", "how long it is pressed backwards against a stop, s"),
    pin_in(FLOAT, "fwd-dc", "motor-vel forwards"), pin_in(FLOAT, "rev-dc", "motor-vel backwards"),
    pin_in(FLOAT, "hold-dc", "motor-vel in position"),
    pin_in(FLOAT, "align-dc", "motor-vel of the last slow move; 0: there is none"),
    pin_in(FLOAT, "decel-time", "until it has stopped and is aligned, s"),
    pin_in(S32, "counts", "of an encoder or stepgen"),
    pin_in(S32, "scale", "counts from pocket to pocket", 100), pin_in(S32, "width", "of a pocket, in counts"),
    pin_in(S32, "home-offset", "counts from the index to pocket 1"), pin_io(BIT, "index-enable", "of the encoder"),
    pin_in(BIT, "jog-fwd", "one pocket forwards"), pin_in(BIT, "jog-rev", "one pocket backwards, where dir=2"),
    pin_out(BIT, "motor-fwd"), pin_out(BIT, "motor-rev"), pin_out(BIT, "parity-error"),
    pin_out(S32, "current-position", "the pocket that the sensors tell"),
    pin_out(FLOAT, "motor-vel"), pin_out(BIT, "homed"),
    pin_in(BIT, "unhome", "home again before the next move"),
    param_ro(S32, "state", "0 rest, 2 to pocket, 3 against stop, 5 7 8 aligning, 9 arrived, 11 homing, 20 jog"),
    param_ro(BIT, "homing"), param_ro(S32, "motor-dir", "1 forwards, -1 backwards"),
    param_ro(FLOAT, "timer", "what is left of rev-pulse or decel-time, s"),
    param_ro(U32, "debounce", "0: a position counts in the period in which it is read"),
], {"": <size_t>&carousel}, counted_by="pockets", sizes=True, decode=changers, takes_names=False, keep_personality=True,
   options=("encoding", "num_sense", "dir", "parity"))


# ---- modmath ----

cdef struct ModDir:
    hal_pin actual, desired, up, down, on_target, min_num, max_num, wrap

cdef void mod_dir(ModDir* s, long period) noexcept nogil:
    """Which way is shorter, from one place of a ring to another; without `wrap` it is no ring."""
    cdef int32_t way = at(s.desired).s - at(s.actual).s
    cdef int32_t places = at(s.max_num).s - at(s.min_num).s + 1
    if at(s.wrap).b and places > 0:
        way = (at(s.desired).s - at(s.min_num).s) % places - (at(s.actual).s - at(s.min_num).s) % places
        if 2 * way > places:
            way -= places
        elif 2 * way < -places:
            way += places
    at(s.up).b = way > 0
    at(s.down).b = way < 0
    at(s.on_target).b = way == 0

declare("modmath", "Which way round is shorter", sizeof(ModDir), [
    pin_in(S32, "actual", "where it is"), pin_in(S32, "desired", "where it shall be"),
    pin_out(BIT, "up", "count upwards"), pin_out(BIT, "down"), pin_out(BIT, "on-target", "", True),
    pin_io(S32, "min-num", "the first place"), pin_io(S32, "max-num", "the last place", 15),
    pin_io(BIT, "wrap", "behind the last comes the first", True),
], {"": <size_t>&mod_dir}, counted_by="mod_dir", takes_names=False, instance="mod-dir.{}")
