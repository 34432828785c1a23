"""Commutation of three-phase motors: bldc. See ``declare.py``. Angles are in electrical revolutions, 0 to 1."""

from libc.math cimport M_PI, ceil, cos, fabs, floor
from libc.stdint cimport int8_t, int32_t, uint8_t, uint32_t

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import BIT, FLOAT, S32, U32, declare, param_ro, param_rw, pin_in, pin_io, pin_out
from nml.errors import HalError

cdef enum:
    HALLS = 0x01  # the personality: what feeds back, and what drives
    ABSOLUTE = 0x02
    COUNTS = 0x04
    INDEX = 0x08
    GRAY = 0x10
    BITS = 0x100
    SIX = 0x200
    HALLS_OUT = 0x400
    GRAY_OUT = 0x800
    TRAPEZOIDAL = 0x1000
    PATTERNS = 48
    ALIGNMENT = 2400  # periods
    RAMP = 400  # the first of them

LETTERS = {"n": 0, "h": HALLS, "a": ABSOLUTE, "q": COUNTS, "i": INDEX, "f": GRAY, "B": BITS, "6": SIX, "H": HALLS_OUT,
           "F": GRAY_OUT, "T": TRAPEZOIDAL}

cdef double SEARCH = 0.001  # turn in a period of the search for the index
cdef double QUARTER = 0.25

# By pattern, the readings H1 H2 H3 as a digit, in the order of the phases B-A C-A C-B A-B A-C B-C.
HALL_PATTERNS = (
    "013764 102675 023754 132645 231546 320457 201576 310467 "
    "015762 104673 026751 137640 237540 326451 204573 315462 "
    "045732 154623 046731 157620 267510 376401 264513 375402 "
    "457320 546231 467310 576201 675102 764013 645132 754023 "
    "451326 540237 462315 573204 673104 762015 640137 751026 "
    "401376 510267 402375 513264 623154 732045 620157 731046 "
).split()

cdef int8_t place_of[PATTERNS][8]  # by pattern and reading; -1 where no place has it
cdef uint8_t reading_at[PATTERNS][6]
cdef int[6][3] DRIVEN = [[-1, 1, 0], [-1, 0, 1], [0, -1, 1], [1, -1, 0], [1, 0, -1], [0, 1, -1]]  # A, B, C by place

cdef int pattern_number, reading_number, place_number
for pattern_number, readings in enumerate(HALL_PATTERNS):
    for reading_number in range(8):
        place_of[pattern_number][reading_number] = <int8_t>readings.find(str(reading_number))
    for place_number in range(6):
        reading_at[pattern_number][place_number] = <uint8_t>int(readings[place_number])

cdef enum Stage:
    UNREADY  # the rotor's place is not known
    ALIGNING
    KNOWN

cdef struct Bldc:
    hal_pin hall[3]
    hal_pin hall_error
    hal_pin C[4]
    hal_pin value, lead_angle, rev, frequency, initvalue, rawcounts, index_enable, init, init_done
    hal_pin each_value[3]
    hal_pin each_on[3]
    hal_pin each_high[3]
    hal_pin each_low[3]
    hal_pin each_high_on[3]
    hal_pin each_low_on[3]
    hal_pin hall_out[3]
    hal_pin C_out[4]
    hal_pin phase_angle, rotor_angle, out, out_dir, out_abs, in_type, out_type, scale, poles, encoder_offset
    hal_pin offset_measured, drive_offset, output_pattern, pattern
    size_t personality
    double turned  # by the free-running angle and the search for the index
    int32_t counts, periods  # of the last period; of the alignment so far
    uint32_t seen_pattern
    int8_t place  # from 0 to 5 in the order of the phases; -1 unknown
    uint8_t stage, begun, was_init, index_wanted


cdef double wrapped(double angle) noexcept nogil:
    return angle - floor(angle)

cdef double counts_per_turn(Bldc* s) noexcept nogil:
    """Encoder counts of an electrical revolution."""
    cdef int pairs = at(s.poles).s // 2
    return <double>at(s.scale).s / pairs if pairs > 0 and at(s.scale).s else 1.0

cdef int sixth(double rotor) noexcept nogil:
    """The place of a rotor's angle in the order of the phases; at an edge still the one before."""
    return (<int>ceil((rotor + QUARTER) * 6.0) + 4) % 6

cdef double lead(Bldc* s) noexcept nogil:
    return at(s.lead_angle).f / 360.0 if s.lead_angle != NULL else QUARTER

cdef double by_counts(Bldc* s, int32_t zero) noexcept nogil:
    """The angle by the encoder, half a period on, in whole counts."""
    cdef int32_t counts = at(s.rawcounts).s
    return wrapped((counts + (counts - s.counts) // 2 - zero) / counts_per_turn(s))

cdef int read_halls(Bldc* s) noexcept nogil:
    """The place that the sensors tell; a reading, or a step, that cannot be is an error until the pattern changes."""
    cdef uint32_t pattern = at(s.pattern).u, i
    cdef int reading = 0, place = -1, step
    for i in range(3):
        reading = reading << 1 | (at(s.hall[i]).b != 0)
    if pattern != s.seen_pattern:
        s.seen_pattern = pattern
        s.place = -1
        at(s.hall_error).b = 0
    if pattern < PATTERNS:
        place = place_of[pattern][reading]
    step = (place - s.place + 6) % 6
    if place < 0 or (s.place >= 0 and step != 0 and step != 1 and step != 5):
        at(s.hall_error).b = 1
    return place

cdef double read_gray(Bldc* s) noexcept nogil:
    """The middle of the sixteenth of a turn that the Gray code tells."""
    cdef int i, code = 0
    for i in range(4):
        code |= (at(s.C[i]).b != 0) << i
    code ^= code >> 2
    code ^= code >> 1
    return (code + 0.5) / 16.0

cdef bint find_rotor(Bldc* s, int place, double* rotor) noexcept nogil:
    """Whether the first edge of a sensor, or the index, tells where the encoder's zero is; with the angle at an edge."""
    cdef int edge
    if s.personality & INDEX:
        if s.index_wanted and not at(s.index_enable).b:
            at(s.offset_measured).s = at(s.rawcounts).s + at(s.encoder_offset).s
            s.stage = KNOWN
    elif s.place >= 0 and place >= 0 and place != s.place:
        edge = place if (place - s.place + 6) % 6 == 1 else s.place
        rotor[0] = (edge + 0.5) / 6.0
        at(s.offset_measured).s = at(s.rawcounts).s - <int32_t>floor(rotor[0] * counts_per_turn(s) + 0.5)
        s.stage = KNOWN
        return True
    return False

cdef double align(Bldc* s) noexcept nogil:
    """One period of the alignment: the angle to which the motor is pulled; the last one is the rotor's zero."""
    cdef double angle = 0.0
    cdef int now = s.periods
    if s.personality & INDEX:
        s.turned = wrapped(s.turned + (-SEARCH if at(s.rev).b else SEARCH))
        at(s.out).f = at(s.initvalue).f
        if s.index_wanted and not at(s.index_enable).b:
            at(s.offset_measured).s = at(s.rawcounts).s + at(s.encoder_offset).s
            s.stage = KNOWN
            at(s.init_done).b = 1
        return s.turned
    at(s.out).f = at(s.initvalue).f * (now / <double>RAMP if now < RAMP else 1.0)
    if RAMP < now <= 1200:
        angle = -QUARTER * (now - RAMP) / 800.0
    elif 1200 < now <= 1600:
        angle = -QUARTER + 2.0 * QUARTER * (now - 1200) / 400.0
    elif 1600 < now <= 2000:
        angle = QUARTER - QUARTER * (now - 1600) / 400.0
    s.periods += 1
    if now >= ALIGNMENT:
        at(s.offset_measured).s = at(s.rawcounts).s
        s.stage = KNOWN
        at(s.init_done).b = 1
    return wrapped(angle)

cdef void start_aligning(Bldc* s) noexcept nogil:
    s.stage = ALIGNING
    s.periods = 0
    s.turned = 0.0
    at(s.init_done).b = 0
    if s.index_enable != NULL:
        at(s.index_enable).b = 1
        s.index_wanted = 1

cdef void drive_halls(Bldc* s, int place) noexcept nogil:
    cdef uint32_t pattern = at(s.output_pattern).u
    cdef int i
    for i in range(3):
        at(s.hall_out[i]).b = pattern < PATTERNS and place >= 0 and reading_at[pattern][place] >> (2 - i) & 1

cdef void drive_gray(Bldc* s, double rotor) noexcept nogil:
    cdef int i, number = max(<int>ceil(rotor * 16.0) - 1, 0)
    for i in range(4):
        at(s.C_out[i]).b = (number ^ number >> 1) >> i & 1

cdef void drive_phase(Bldc* s, int i, double value) noexcept nogil:
    """One phase, by the kind of output; without a sign a single bit stays as it was."""
    if s.personality & BITS and s.personality & SIX:
        at(s.each_high_on[i]).b = value > 0.0
        at(s.each_low_on[i]).b = value < 0.0
    elif s.personality & BITS:
        if value != 0.0:
            at(s.each_on[i]).b = value > 0.0
    elif s.personality & SIX:
        at(s.each_high[i]).f = max(value, 0.0)
        at(s.each_low[i]).f = max(-value, 0.0)
    else:
        at(s.each_value[i]).f = value

cdef void drive(Bldc* s, double rotor, double phase, int place, bint sine) noexcept nogil:
    """All outputs: sines of the phase's angle, or the two phases that belong to the rotor's place."""
    cdef double out = at(s.out).f
    cdef int i
    at(s.rotor_angle).f, at(s.phase_angle).f = rotor, phase
    if s.personality & HALLS_OUT:
        drive_halls(s, place)
    elif s.personality & GRAY_OUT:
        drive_gray(s, rotor)
    else:
        for i in range(3):
            if sine:
                drive_phase(s, i, fabs(out) * cos(2.0 * M_PI * (phase - i / 3.0)))
            else:
                drive_phase(s, i, out * DRIVEN[place][i] if place >= 0 else 0.0)

cdef void commutate(Bldc* s, double rotor) noexcept nogil:
    """A rotor whose angle is known: the field leads it by a quarter turn or so, to the side to which it is to turn."""
    cdef bint sine = not s.personality & (TRAPEZOIDAL | BITS)
    cdef bint back = at(s.out).f < 0.0 and not s.personality & TRAPEZOIDAL
    cdef int place = sixth(rotor)
    drive(s, rotor, wrapped(rotor - lead(s) if back else rotor + lead(s)), place, sine)

cdef void by_halls(Bldc* s, int place) noexcept nogil:
    """Commutation by the sensors alone."""
    cdef double rotor = (place + 1) % 6 / 6.0 if place >= 0 else 0.0
    drive(s, rotor, wrapped(rotor + lead(s) if at(s.out).f < 0.0 else rotor - lead(s)), place, False)

cdef void begin(Bldc* s) noexcept nogil:
    """The first period: nothing is driven yet."""
    at(s.in_type).s = s.personality & 0xFF
    if s.personality & HALLS_OUT:
        at(s.out_type).s = HALLS_OUT
    elif s.personality & GRAY_OUT:
        at(s.out_type).s = GRAY_OUT
    else:
        at(s.out_type).s = s.personality & (BITS | SIX)
    s.begun, s.place = 1, -1
    if s.pattern != NULL:
        s.seen_pattern = at(s.pattern).u
        s.place = read_halls(s)
    if s.index_enable != NULL and s.personality & HALLS:
        at(s.index_enable).b = 1
        s.index_wanted = 1

cdef void turn(Bldc* s, long period) noexcept nogil:
    """One period, by what feeds back; the most exact goes first."""
    cdef size_t fed_by = s.personality & 0xFF
    cdef int place
    cdef double rotor
    if fed_by & ABSOLUTE:
        commutate(s, by_counts(s, at(s.encoder_offset).s))
    elif fed_by & HALLS:
        place = read_halls(s)
        if fed_by & COUNTS and s.stage != KNOWN and not s.personality & TRAPEZOIDAL and find_rotor(s, place, &rotor):
            drive(s, rotor, wrapped(rotor - lead(s) if at(s.out).f < 0.0 else rotor + lead(s)), place, False)
        elif s.stage != KNOWN:
            by_halls(s, place)
        else:
            commutate(s, by_counts(s, at(s.offset_measured).s))
        s.place = place
    elif fed_by & GRAY:
        commutate(s, read_gray(s))
    elif fed_by & COUNTS:
        if at(s.init).b and not s.was_init:
            start_aligning(s)
        s.was_init = at(s.init).b
        if s.stage == KNOWN:
            commutate(s, by_counts(s, at(s.offset_measured).s))
        elif s.stage == ALIGNING and at(s.init).b:
            rotor = align(s)
            at(s.out_abs).f = fabs(at(s.out).f)
            drive(s, wrapped(rotor - at(s.drive_offset).f / 360.0), rotor, 0, True)
    elif not fed_by & INDEX:
        s.turned = wrapped(s.turned + at(s.frequency).f * period * 1e-9)
        drive(s, s.turned, s.turned, sixth(s.turned), not s.personality & (TRAPEZOIDAL | BITS))

cdef void bldc(Bldc* s, long period) noexcept nogil:
    cdef bint back = (at(s.value).f < 0.0) != (at(s.rev).b != 0)
    at(s.out_dir).b = back
    at(s.out_abs).f = fabs(at(s.value).f)
    if not s.begun:
        begin(s)
    else:
        if s.init == NULL or s.stage == KNOWN:
            at(s.out).f = -at(s.out_abs).f if back else at(s.out_abs).f
        turn(s, period)
    if s.rawcounts != NULL:
        s.counts = at(s.rawcounts).s

def kinds(dict args) -> list:
    """``cfg=qi6,aH`` as personalities."""
    found = []
    for word in args.get("cfg", "").split(","):
        wrong = [letter for letter in word if letter not in LETTERS]
        if wrong or not word:
            raise HalError(f"bldc: cfg={args.get('cfg', '')}: letters of {', '.join(LETTERS)} for each motor would be right, "
                           "as in cfg=qi6,aH", -22)
        bits = 0
        for letter in word:
            bits |= LETTERS[letter]
        found.append(bits)
    return found

def where(mask, *wanted, count=1):
    """How many pins there are: `count` where those bits of the personality are one of the wanted values."""
    return lambda p: count if (p & mask) in wanted else 0

def some(mask, count=1):
    """The same, where any of the bits is set."""
    return lambda p: count if p & mask else 0

PHASES = ("A", "B", "C")
DRIVES = BITS | SIX | HALLS_OUT | GRAY_OUT
CODES = ("1", "2", "4", "8")

declare("bldc", "Commutation of brushless DC motors and AC servos. `cfg=qi6,aH` makes one motor for each word, of the letters: "
        "feedback n none, h Hall sensors, a absolute encoder, q incremental encoder, i its index, f Fanuc's 4-bit Gray code; "
        "output B bits, 6 high and low side apart, H emulated Hall sensors, F emulated Gray code, T trapezoidal", sizeof(Bldc), [
    pin_in(BIT, "hall{word}", "Hall sensor; with h", count=3, words=("1", "2", "3"), personal=some(HALLS, 3)),
    pin_out(BIT, "hall-error", "the sensors read what they cannot with this pattern; with h", personal=some(HALLS)),
    pin_in(BIT, "C{word}", "Gray code; with f", count=4, words=CODES, personal=some(GRAY, 4)),
    pin_in(FLOAT, "value", "amplitude; the motor turns back where it is negative"),
    pin_in(FLOAT, "lead-angle", "of the field before the rotor, degrees; with a, q", 90.0, personal=some(ABSOLUTE | COUNTS)),
    pin_in(BIT, "rev", "turn the other way"),
    pin_in(FLOAT, "frequency", "Hz; without feedback", personal=where(HALLS | ABSOLUTE | COUNTS | INDEX, 0)),
    pin_in(FLOAT, "initvalue", "amplitude of the alignment; with q", 0.2, personal=some(COUNTS)),
    pin_in(S32, "rawcounts", "the encoder's rawcounts; with a, q", personal=some(ABSOLUTE | COUNTS)),
    pin_io(BIT, "index-enable", "the encoder's index-enable; with i", personal=some(INDEX)),
    pin_in(BIT, "init", "its rising edge starts the alignment, which waits while it is false; with q without h",
           personal=where(HALLS | COUNTS, COUNTS)),
    pin_out(BIT, "init-done", "the rotor is aligned; with q without h", personal=where(HALLS | COUNTS, COUNTS)),
    pin_out(FLOAT, "{word}-value", "amplitude of the phase", count=3, words=PHASES, personal=where(DRIVES, 0, count=3)),
    pin_out(BIT, "{word}-on", "the phase; with B", count=3, words=PHASES, personal=where(DRIVES, BITS, count=3)),
    pin_out(FLOAT, "{word}-high", "with 6", count=3, words=PHASES, personal=where(DRIVES, SIX, count=3)),
    pin_out(FLOAT, "{word}-low", "with 6", count=3, words=PHASES, personal=where(DRIVES, SIX, count=3)),
    pin_out(BIT, "{word}-high-on", "with B6", count=3, words=PHASES, personal=where(DRIVES, BITS | SIX, count=3)),
    pin_out(BIT, "{word}-low-on", "with B6", count=3, words=PHASES, personal=where(DRIVES, BITS | SIX, count=3)),
    pin_out(BIT, "hall{word}-out", "with H", count=3, words=("1", "2", "3"), personal=some(HALLS_OUT, 3)),
    pin_out(BIT, "C{word}-out", "with F", count=4, words=CODES, personal=some(GRAY_OUT, 4)),
    pin_out(FLOAT, "phase-angle", "of the field, electrical revolutions from 0 to 1"),
    pin_out(FLOAT, "rotor-angle", "electrical revolutions from 0 to 1"),
    pin_out(FLOAT, "out", "amplitude with its sign, and that of the alignment"),
    pin_out(BIT, "out-dir", "true where the motor turns back"), pin_out(FLOAT, "out-abs", "amplitude without its sign"),
    param_ro(S32, "in-type", "the feedback as a number", -1), param_ro(S32, "out-type", "the output as a number", -1),
    param_rw(S32, "scale", "counts of a revolution of the rotor; with a, q", 512, personal=some(ABSOLUTE | COUNTS)),
    param_rw(S32, "poles", "of the motor; with a, q", 4, personal=some(ABSOLUTE | COUNTS)),
    param_rw(S32, "encoder-offset", "counts from the encoder's zero to the motor's; with a, i", personal=some(ABSOLUTE | INDEX)),
    param_ro(S32, "offset-measured", "the same, as the alignment found it; with q", personal=some(COUNTS)),
    param_rw(FLOAT, "drive-offset", "degrees that the drive adds itself, left out of rotor-angle during the alignment"),
    param_rw(U32, "output-pattern", "of the emulated Hall sensors; with H", 25, personal=some(HALLS_OUT)),
    param_rw(U32, "pattern", "of the Hall sensors, 0 to 47; with h", 25, personal=some(HALLS)),
], {"": <size_t>&bldc}, counted_by="cfg", sizes=True, most=8, takes_names=False, decode=kinds, keep_personality=True)
