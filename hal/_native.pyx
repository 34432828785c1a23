"""Components in C: the table of functions that their headers (``hal/include``) call, and the library that one is.

A component's shared library has ``rtapi_app_main`` and ``rtapi_app_exit``. Its calls arrive here and go on to the
`Owner` (``hal.native``) that loaded it. A pin is a pointer in the component's memory, which lies in the HAL's segment: whoever
links the pin aims the pointer at the signal's cell, as `hal._mapping.point` does.
"""

from libc.stdio cimport fputs, stderr
from libc.string cimport memset, strlen

from hal._mapping cimport Mapping
from hal._messages cimport say_copy
from hal.port cimport hal_port

import _ctypes
import ctypes
import errno
import os
import traceback

from nml.errors import HalError

cdef extern from "include/hal_host.h":
    ctypedef void (*hal_host_code)(void* arg, long period_ns) noexcept nogil
    ctypedef struct hal_host:
        int (*init)(const char* name) noexcept nogil
        int (*ready)(int comp_id) noexcept nogil
        int (*leave)(int comp_id) noexcept nogil
        void* (*memory)(long size) noexcept nogil
        int (*pin)(int type, int dir, void** where, int comp_id, const char* name) noexcept nogil
        int (*param)(int type, int dir, void* where, int comp_id, const char* name) noexcept nogil
        int (*function)(
            const char* name, hal_host_code code, void* arg, int uses_fp, int reentrant, int comp_id) noexcept nogil
        void (*say)(const char* text) noexcept nogil
        int msg_level
    ctypedef struct hal_parameter:
        const char* name
        char type
        void* at
        long most
        const char* doc

cdef enum:
    MESSAGE_LEVEL = 1  # RTAPI_MSG_ERR

cdef hal_host table
cdef object owner = None  # an Owner: whose code runs

PARAMETER_TYPES = {"i": ctypes.c_int, "u": ctypes.c_uint, "l": ctypes.c_long, "s": ctypes.c_char_p}


cdef class SharedMemory:
    """Zeroed memory in the HAL's segment; free again when this object goes."""

    cdef Mapping segment
    cdef hal_port* block
    cdef readonly size_t size

    def __cinit__(self, Mapping segment not None, size_t size):
        self.segment, self.size = segment, max(size, 1)
        with segment:
            self.block = segment.new_port(<unsigned int>self.size)
        memset(self.block.bytes, 0, self.size)

    @property
    def address(self) -> int:
        return <size_t>&self.block.bytes[0]

    def holds(self, size_t address) -> bool:
        """Whether the address lies in it."""
        return 0 <= <ssize_t>(address - self.address) < <ssize_t>self.size

    def __dealloc__(self):
        if self.block != NULL:
            self.block.size = 0


cdef object answer(call):
    """What the owner says; a negative errno, and the text with the owner, where it refuses."""
    try:
        return call()
    except HalError as error:
        owner.refused(error)
        return error.errno if error.errno < 0 else -errno.EINVAL
    except BaseException as error:
        traceback.print_exc()
        owner.refused(error)
        return -errno.EINVAL


cdef str text_of(const char* text):
    return text[:strlen(text)].decode(errors="replace")


cdef int host_init(const char* name) noexcept with gil:
    return answer(lambda: owner.init(text_of(name)))


cdef int host_ready(int comp_id) noexcept with gil:
    return answer(lambda: owner.ready(comp_id))


cdef int host_leave(int comp_id) noexcept with gil:
    return answer(lambda: owner.leave(comp_id))


cdef void* host_memory(long size) noexcept with gil:
    made = answer(lambda: owner.memory(size))
    return <void*><size_t>made if made > 0 else NULL


cdef int host_pin(int type, int dir, void** where, int comp_id, const char* name) noexcept with gil:
    return answer(lambda: owner.pin(comp_id, text_of(name), type, dir, <size_t>where))


cdef int host_param(int type, int dir, void* where, int comp_id, const char* name) noexcept with gil:
    return answer(lambda: owner.param(comp_id, text_of(name), type, dir, <size_t>where))


cdef int host_function(
    const char* name, hal_host_code code, void* arg, int uses_fp, int reentrant, int comp_id
) noexcept with gil:
    return answer(lambda: owner.function(
        comp_id, text_of(name), <size_t><void*>code, <size_t>arg, uses_fp != 0, reentrant != 0))


table.init, table.ready, table.leave, table.memory = host_init, host_ready, host_leave, host_memory
table.pin, table.param, table.function, table.say = host_pin, host_param, host_function, say_copy
table.msg_level = MESSAGE_LEVEL


cdef void print_text(const char* text) noexcept nogil:
    fputs(text, stderr)


def print_messages() -> None:
    """Let messages go to stderr at once: in a program of its own, where no host passes them on."""
    table.say = print_text


class Library:
    """A component's shared library; its code runs for the ``owner`` that is given with each call."""

    def __init__(self, str path) -> None:
        self.path = path
        try:
            self._library = ctypes.CDLL(os.path.abspath(path))
        except OSError as error:
            raise HalError(f"{path} cannot be loaded: {error}", -errno.ENOENT) from None
        self._kept = []  # what parameters point to
        if not self.has("hal_host_table"):
            raise HalError(f"{path} is no component in C: it was not compiled with our hal.h (halcompile does that)")
        ctypes.c_void_p.in_dll(self._library, "hal_host_table").value = <size_t>&table

    def close(self) -> None:
        """Out of this process, so that the next load begins afresh; nothing may run in it, nor begin to."""
        if self._library is not None:
            _ctypes.dlclose(self._library._handle)
            self._library = None

    def __del__(self) -> None:
        if hasattr(self, "_library"):
            self.close()

    def has(self, str symbol) -> bool:
        return hasattr(self._library, symbol)

    def call(self, whose, str symbol, *arguments) -> int:
        """Call an ``int`` or ``void`` function, without the GIL."""
        global owner
        owner = whose
        return getattr(self._library, symbol)(*arguments)

    def end(self, whose) -> None:
        """Let a realtime component go."""
        self.call(whose, "rtapi_app_exit")

    def _parameters(self) -> dict:
        cdef hal_parameter* row
        cdef size_t first, last
        if not self.has("hal_parameters_begin"):
            return {}
        first = ctypes.c_size_t.in_dll(self._library, "hal_parameters_begin").value
        last = ctypes.c_size_t.in_dll(self._library, "hal_parameters_end").value
        found = {}
        while first < last:
            row = <hal_parameter*>first
            found[text_of(row.name)] = (chr(row.type), <size_t>row.at, row.most)
            first += sizeof(hal_parameter)
        return found

    def set_parameters(self, str component, dict args) -> None:
        """Give the module parameters their values; HalError for an unknown one or a bad value."""
        known = self._parameters()
        for name, text in args.items():
            if name not in known:
                raise HalError(f"{component}: unknown parameter '{name}'; {', '.join(sorted(known)) or 'none'} are known")
            type_, at, most = known[name]
            words = text.split(",") if most > 1 else [text]
            if len(words) > most:
                raise HalError(f"{component}: {name}={text}: {len(words)} values; up to {most} are possible")
            self._store(component, name, PARAMETER_TYPES[type_], at, words)

    def _store(self, str component, str name, kind, size_t at, list words) -> None:
        values = (kind * len(words)).from_address(at)
        for i, word in enumerate(words):
            if kind is ctypes.c_char_p:
                kept = ctypes.create_string_buffer(word.encode())
                self._kept.append(kept)
                values[i] = ctypes.addressof(kept) if word else None
                continue
            try:
                values[i] = int(word or "0", 0)
            except ValueError:
                raise HalError(f"{component}: {name}={word}: a whole number would be right") from None
