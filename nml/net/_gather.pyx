"""Puts the bytes of an image into another order: how the server encodes a status that changes every millisecond."""

from cpython.bytes cimport PyBytes_AS_STRING, PyBytes_FromStringAndSize


def gather(const unsigned char[::1] image not None, const int[::1] index not None, bytes template not None) -> bytes:
    """A copy of ``template`` in which byte ``i`` is ``image[index[i]]`` wherever ``index[i]`` is not negative.

    ValueError if the index has another length than the template or points behind the image.
    """
    cdef Py_ssize_t count = index.shape[0], size = image.shape[0], i
    cdef int source
    cdef bytes result
    cdef unsigned char* out
    cdef const unsigned char* fixed = <const unsigned char*>PyBytes_AS_STRING(template)
    if len(template) != count:
        raise ValueError(f"{count} places for {len(template)} bytes")
    result = PyBytes_FromStringAndSize(NULL, count)
    out = <unsigned char*>PyBytes_AS_STRING(result)
    for i in range(count):
        source = index[i]
        if source >= size:
            raise ValueError(f"byte {source} of an image of {size}")
        out[i] = image[source] if source >= 0 else fixed[i]
    return result
