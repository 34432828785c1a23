"""Typed views of the records of the HAL's segment; see ``_shm.pyx``. Threads and Python's items cimport it."""

from libc.stdint cimport int32_t

from hal._mapping cimport Mapping, hal_comp, hal_funct, hal_item, hal_record, hal_segment, hal_signal, hal_thread, hal_word
from hal.cell cimport hal_cell
from hal.port cimport hal_port


cdef class Segment(Mapping):
    cdef hal_record* _slot(self, hal_record* first, size_t stride, int32_t* used, int limit, str what) except NULL
    cdef hal_record* _find(self, hal_record* first, size_t stride, int used, str name)
    cdef Item _item(self, hal_item* item)
    cdef Signal _signal(self, hal_signal* signal)
    cdef Comp _comp(self, hal_comp* comp)
    cdef Funct _funct(self, hal_funct* funct)
    cdef Thread _thread(self, hal_thread* thread)


cdef class Record:
    cdef Segment segment
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
