"""The tables of the HAL's segment; see ``_shm.pyx``. Threads cimport it."""

from libc.stdint cimport int32_t

from hal._mapping cimport Mapping, hal_record


cdef class Segment(Mapping):
    cdef hal_record* _slot(self, hal_record* first, size_t stride, int32_t* used, int limit, str what) except NULL
    cdef hal_record* _find(self, hal_record* first, size_t stride, int used, str name)
