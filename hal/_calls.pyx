"""What threads call, apart from any thread: functions in Python, single calls, and the memory of native instances.

``hal.realtime`` and the components make them; ``hal._threads`` knows only the addresses.
"""

from libc.stdlib cimport calloc, free

from hal.cell cimport hal_function


def call(size_t code, size_t arg, long period_ns) -> None:
    """Call a function once, here: a period without a thread, for tests and studies."""
    (<hal_function>code)(<void*>arg, period_ns)


cdef void call_python(void* arg, long period_ns) noexcept with gil:
    """Run a Python component's function; what it raises is shown once by `PythonCall`."""
    (<PythonCall>arg).run(period_ns)


cdef class PythonCall:
    """A Python function as a thread calls it. It takes the GIL, in the threads that it was added to only."""

    cdef object function
    cdef object on_error
    cdef bint failed

    def __init__(self, function, on_error):
        self.function, self.on_error, self.failed = function, on_error, False

    cdef void run(self, long period_ns) noexcept:
        if self.failed:
            return
        try:
            self.function(period_ns)
        except BaseException as error:
            self.failed = True
            self.on_error(error)

    @property
    def code(self) -> int:
        return <size_t>&call_python

    @property
    def arg(self) -> int:
        return <size_t><void*>self


cdef class Memory:
    """Zeroed memory that stays where it is as long as this object lives; instance data of native components."""

    cdef void* at
    cdef readonly size_t size

    def __cinit__(self, size_t size):
        self.at = calloc(1, size or 1)
        if self.at == NULL:
            raise MemoryError
        self.size = size

    @property
    def address(self) -> int:
        return <size_t>self.at

    def put(self, size_t offset, size_t word) -> None:
        """Store a machine word, e.g. a pin's address, `offset` bytes from the start."""
        if offset + sizeof(size_t) > self.size:
            raise IndexError(f"offset {offset} in {self.size} bytes")
        (<size_t*>(<char*>self.at + offset))[0] = word

    def __dealloc__(self):
        free(self.at)
