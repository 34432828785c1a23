"""Puts the bytes of an image into another order: how the server encodes a status that changes every millisecond."""

from cpython.bytes cimport PyBytes_AS_STRING, PyBytes_FromStringAndSize
from libc.stdint cimport uint32_t, uint64_t
from libc.string cimport memcpy

cdef extern from *:
    uint32_t __builtin_bswap32(uint32_t value) nogil
    uint64_t __builtin_bswap64(uint64_t value) nogil


def gather(const unsigned char[::1] image not None, const int[:, ::1] runs not None, bytes template not None) -> bytes:
    """A copy of ``template`` in which each run has put elements of the image.

    A run is (width, place in the result, place in the image, number of elements); elements of 4 and 8 bytes come out in
    the other byte order, those of one byte as they are. ValueError if a run leaves the image or the template.
    """
    cdef Py_ssize_t size = image.shape[0], length = len(template), run, count, width, target, source, i
    cdef bytes result = PyBytes_FromStringAndSize(PyBytes_AS_STRING(template), length)
    cdef unsigned char* out = <unsigned char*>PyBytes_AS_STRING(result)
    cdef const unsigned char* start = &image[0] if size else NULL
    cdef const int* row = &runs[0, 0] if runs.shape[0] else NULL
    cdef uint32_t four
    cdef uint64_t eight
    if runs.shape[1] != 4:
        raise ValueError(f"runs of {runs.shape[1]} numbers, 4 are needed")
    for run in range(runs.shape[0]):
        width, target, source, count = row[0], row[1], row[2], row[3]
        row += 4
        if min(target, source, count) < 0 or source + width * count > size or target + width * count > length:
            raise ValueError(f"{count} elements of {width} bytes from {source} to {target} leave an image of {size}")
        if width == 4:
            for i in range(count):
                memcpy(&four, start + source + 4 * i, 4)
                four = __builtin_bswap32(four)
                memcpy(out + target + 4 * i, &four, 4)
        elif width == 8:
            for i in range(count):
                memcpy(&eight, start + source + 8 * i, 8)
                eight = __builtin_bswap64(eight)
                memcpy(out + target + 8 * i, &eight, 8)
        elif width == 1:
            memcpy(out + target, start + source, count)
        else:
            raise ValueError(f"elements of {width} bytes; 1, 4 and 8 are known")
    return result
