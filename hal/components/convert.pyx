"""Conversions between HAL's types, conv_FROM_TO for each pair. See ``declare.py``."""

from libc.math cimport isnan
from libc.stdint cimport int32_t, int64_t, uint32_t, uint64_t

from hal.cell cimport hal_at as at, hal_cell, hal_pin

from hal.components.declare import BIT, FLOAT, S32, S64, U32, U64, declare, param_rw, pin_in, pin_out

cdef extern from *:
    ctypedef long long wide "__int128"  # holds the values of every whole type

cdef enum:
    T_BIT = 1
    T_FLOAT = 2
    T_S32 = 3
    T_U32 = 4
    T_S64 = 6
    T_U64 = 7

cdef struct Conv:
    hal_pin in_, out, out_of_range, clamp
    size_t source, target

cdef wide whole(hal_cell* cell, size_t type_) noexcept nogil:
    """The value of a cell, a float cut to a whole number."""
    if type_ == T_FLOAT:
        if isnan(cell.f):
            return 0
        return <wide>min(max(cell.f, -1e37), 1e37)
    if type_ == T_BIT:
        return cell.b != 0
    if type_ == T_S32:
        return cell.s
    if type_ == T_U32:
        return cell.u
    if type_ == T_S64:
        return cell.l
    return <wide>cell.k

cdef wide lowest(size_t type_) noexcept nogil:
    return -(<wide>1 << 31) if type_ == T_S32 else -(<wide>1 << 63) if type_ == T_S64 else 0

cdef wide highest(size_t type_) noexcept nogil:
    if type_ == T_BIT:
        return 1
    return (<wide>1 << (31 if type_ == T_S32 else 32 if type_ == T_U32 else 63 if type_ == T_S64 else 64)) - 1

cdef void store(hal_cell* cell, size_t type_, wide value) noexcept nogil:
    if type_ == T_BIT:
        cell.b = value != 0
    elif type_ == T_S32 or type_ == T_U32:
        cell.u = <uint32_t>value
    else:
        cell.k = <uint64_t>value

cdef void convert(Conv* s, long period) noexcept nogil:
    cdef wide value = whole(at(s.in_), s.source)
    cdef bint outside
    if s.target == T_FLOAT:
        at(s.out).f = <double>value
        return
    if s.out_of_range != NULL:
        outside = value < lowest(s.target) or value > highest(s.target)
        at(s.out_of_range).b = outside
        if outside and at(s.clamp).b:
            value = lowest(s.target) if value < lowest(s.target) else highest(s.target)
    store(at(s.out), s.target, value)

TYPES = {"bit": BIT, "float": FLOAT, "s32": S32, "u32": U32, "s64": S64, "u64": U64}
RANGES = {"bit": (0, 1), "s32": (-1 << 31, (1 << 31) - 1), "u32": (0, (1 << 32) - 1), "s64": (-1 << 63, (1 << 63) - 1),
          "u64": (0, (1 << 64) - 1), "float": (-1 << 200, 1 << 200)}


def fits(str source, str target) -> bool:
    """Whether every value of one type is a value of the other."""
    return RANGES[target][0] <= RANGES[source][0] and RANGES[source][1] <= RANGES[target][1]


for source in TYPES:
    for target in TYPES:
        if source != target:
            always = fits(source, target)
            declare(f"conv_{source}_{target}", f"Convert {source} to {target}", sizeof(Conv), [
                pin_in(TYPES[source], "in"), pin_out(TYPES[target], "out"),
                pin_out(BIT, "out-of-range", "in is no value of the other type", personal=lambda p, no=always: not no),
                param_rw(BIT, "clamp", "then take the nearest one; else it wraps", personal=lambda p, no=always: not no),
            ], {"": <size_t>&convert}, uses_fp="float" in (source, target), state=(TYPES[source], TYPES[target]))
