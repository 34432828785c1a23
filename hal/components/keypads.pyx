"""Keys in rows and columns: matrix_kb. See ``declare.py``."""

from libc.stdint cimport int64_t, uint32_t

from hal.cell cimport hal_at as at, hal_pin

from hal._shm import IN, OUT
from hal.components.declare import BIT, U32, declare, param_rw, pin_in, pin_out
from nml.errors import HalError

cdef enum:
    LINES = 32
    KEYS = 1024
    PRESSED = 0xC0  # what the keycode of an event begins with
    RELEASED = 0x80
    NOTHING = 0x40
    KEY_MASK = 0x3F
    USUAL_ROLLOVER = 2

cdef struct MatrixKb:
    hal_pin keycode, key_rollover, negative_logic
    hal_pin row_out[LINES]
    hal_pin col_in[LINES]
    hal_pin key_rc[KEYS]
    int64_t personality  # as `sizes_of` makes it
    uint32_t row  # that is driven
    uint32_t down  # keys that are held
    uint32_t seen[LINES]  # columns of each row when it was scanned last, bit by bit
    uint32_t held[LINES]  # the same, of two scans that agreed


cdef int column_bits(int columns) noexcept nogil:
    """Bits of a keycode that tell the column."""
    cdef int bits = 0
    while 1 << bits < columns:
        bits += 1
    return bits

cdef void set_key(MatrixKb* s, uint32_t number, bint pressed, uint32_t rollover) noexcept nogil:
    """A key goes down, unless as many as may be are held, or up."""
    cdef bint was = at(s.key_rc[number]).b != 0
    if pressed and not was and s.down < rollover:
        at(s.key_rc[number]).b = 1
        s.down += 1
    elif was and not pressed:
        at(s.key_rc[number]).b = 0
        s.down -= 1

cdef void scan(MatrixKb* s, uint32_t rows, uint32_t columns) noexcept nogil:
    """Read the row that is driven, then drive the next one; a key counts when two scans of its row agree."""
    cdef uint32_t row = s.row, column, now = 0, settled  # columns, bit by bit
    cdef bint negative = at(s.negative_logic).b != 0
    for column in range(columns):
        if (at(s.col_in[column]).b != 0) != negative:
            now |= 1u << column
    settled = now ^ s.held[row] if now == s.seen[row] else 0
    at(s.keycode).u = NOTHING
    for column in range(columns):
        if settled >> column & 1:
            set_key(s, row * columns + column, now >> column & 1, at(s.key_rollover).u)
            at(s.keycode).u = (PRESSED if now >> column & 1 else RELEASED) + (row << column_bits(columns) | column)
    s.held[row] ^= settled
    s.seen[row] = now
    s.row = (row + 1) % rows
    at(s.row_out[row]).b = negative
    at(s.row_out[s.row]).b = not negative

cdef void decode(MatrixKb* s, uint32_t rows, uint32_t columns) noexcept nogil:
    """Act on the event that the keycode tells."""
    cdef uint32_t code = at(s.keycode).u, kind = code & ~<uint32_t>KEY_MASK, bits = column_bits(columns)
    cdef uint32_t row = (code & KEY_MASK) >> bits, column = code & KEY_MASK & ((1 << bits) - 1)
    if row < rows and column < columns and (kind == PRESSED or kind == RELEASED):
        set_key(s, row * columns + column, kind == PRESSED, USUAL_ROLLOVER)

cdef void matrix_kb(MatrixKb* s, long period) noexcept nogil:
    cdef uint32_t rows = s.personality & 0xFF, columns = s.personality >> 8 & 0xFF
    if s.personality >> 16:
        scan(s, rows, columns)
    else:
        decode(s, rows, columns)

def sizes_of(dict args) -> list:
    """``config=4x8,2x3s`` as personalities: rows, columns, and whether the rows are scanned."""
    found = []
    text = args.get("config", "")
    for word in text.lower().split(",") if text else []:
        rows, _, columns = word.removesuffix("s").partition("x")
        if not (rows.isdecimal() and columns.isdecimal() and 0 < int(rows) <= LINES and 0 < int(columns) <= LINES):
            raise HalError(f"matrix_kb: config={text}: sizes such as 4x8 or, with s for scanning, 2x3s would be right, "
                           f"with up to {LINES} rows and columns", -22)
        found.append(int(rows) | int(columns) << 8 | word.endswith("s") << 16)
    names = [name for name in args.get("names", "").split(",") if name]
    if names and len(names) != len(found):
        raise HalError(f"matrix_kb: {len(names)} names for {len(found)} sizes; one for each would be right", -22)
    return found

def rows_of(int p) -> int:
    return p & 0xFF

def columns_of(int p) -> int:
    return p >> 8 & 0xFF

def scanned(int p) -> int:
    return p >> 16

declare("matrix_kb", "Keys in rows and columns as pins; config=4x8,2x3s makes one of four rows of eight keys whose events come "
        "in by `keycode`, and one of two rows of three keys that scans them itself", sizeof(MatrixKb), [
    pin_in(U32, "keycode", "0xC0 and the key's number when it is pressed, 0x80 and its number when it is released; with s an "
           "output", dir_of=lambda p: OUT if scanned(p) else IN),
    param_rw(U32, "key_rollover", "keys that may be held at a time; with s", USUAL_ROLLOVER, personal=scanned),
    param_rw(BIT, "negative-logic", "a row is driven, and a key felt, as false; with s", True, personal=scanned),
    pin_out(BIT, "row-{:02}-out", "drives a row; with s", count=LINES, personal=lambda p: rows_of(p) * scanned(p)),
    pin_in(BIT, "col-{:02}-in", "a column; with s", count=LINES, personal=lambda p: columns_of(p) * scanned(p)),
    pin_out(BIT, "key.r{row:x}c{column:x}", "true while the key is held", count=KEYS,
            personal=lambda p: rows_of(p) * columns_of(p), columns=columns_of),
], {"": <size_t>&matrix_kb}, counted_by="config", sizes=True, decode=sizes_of, keep_personality=True, instance="matrix_kb.{}",
   names_beside=True)
