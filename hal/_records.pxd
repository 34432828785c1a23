"""Typed views of the records of the HAL's segment; see ``_records.pyx``. Threads and Python's items cimport it."""

from libc.stdint cimport uint32_t

from hal._mapping cimport Mapping, hal_comp, hal_funct, hal_item, hal_record, hal_signal, hal_thread, hal_word
from hal.cell cimport hal_cell
from hal.port cimport hal_port

cdef enum:
    TYPE_BIT = 1
    TYPE_FLOAT = 2
    TYPE_S32 = 3
    TYPE_U32 = 4
    TYPE_PORT = 5
    TYPE_S64 = 6
    TYPE_U64 = 7
    DIR_IN = 16
    DIR_OUT = 32
    DIR_IO = 48


cdef class Record:
    cdef Mapping mapping
    cdef hal_record* head


cdef class Item(Record):
    cdef hal_item* item
    cdef hal_word* word

    cdef hal_cell* cell(self) noexcept


cdef class Signal(Record):
    cdef hal_signal* signal
    cdef hal_cell* cell


cdef class Comp(Record):
    cdef hal_comp* comp


cdef class Funct(Record):
    cdef hal_funct* funct


cdef class Thread(Record):
    cdef hal_thread* thread


cdef hal_port* port_at(hal_cell* cell) noexcept
cdef object cell_value(hal_cell* cell, int type)
cdef int set_cell(hal_cell* cell, int type, object value) except -1

cdef uint32_t hash_name(const char* name) noexcept nogil
cdef int set_name(char* field, uint32_t* hash, str name) except -1
cdef Item view_item(Mapping mapping, hal_item* item)
cdef Signal view_signal(Mapping mapping, hal_signal* signal)
cdef Comp view_comp(Mapping mapping, hal_comp* comp)
cdef Funct view_funct(Mapping mapping, hal_funct* funct)
cdef Thread view_thread(Mapping mapping, hal_thread* thread)
