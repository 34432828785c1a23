"""Port pins: streams of bytes between two components, as Python sees them."""

from libc.stdint cimport uint32_t

from hal._mapping cimport announce
from hal._records cimport TYPE_PORT, Item, port_at
from hal.port cimport (
    hal_port, port_clear, port_commit, port_peek, port_readable, port_write, port_writable,
)

from nml.errors import HalError


cdef class Port(Item):
    """A pin as one end of a stream of bytes, where its type is port; HalError for another."""

    cdef hal_port* port(self) except? NULL:
        if self.item.type != TYPE_PORT:
            raise HalError(f"'{self.head.name.decode()}' is no port")
        return port_at(self.cell())

    def readable(self) -> int:
        """Bytes that wait to be read."""
        return port_readable(self.port())

    def writable(self) -> int:
        """Bytes for which there is room."""
        return port_writable(self.port())

    def size(self) -> int:
        """Bytes of the buffer; 0 without one."""
        cdef hal_port* port = self.port()
        return 0 if port == NULL else port.size

    def peek(self, uint32_t count):
        """The next bytes, which stay where they are; False where there are not as many."""
        if port_readable(self.port()) < count:
            return False
        cdef bytearray into = bytearray(count)
        port_peek(self.port(), <char*>into, count)
        return bytes(into)

    def peek_commit(self, uint32_t count) -> bool:
        """Drop the next bytes; False where there are not as many."""
        done = bool(port_commit(self.port(), count))
        announce(self.mapping.at)
        return done

    def read(self, uint32_t count):
        """The next bytes; False where there are not as many."""
        found = self.peek(count)
        if found is not False:
            self.peek_commit(count)
        return found

    def write(self, data) -> bool:
        """Append bytes, or text as UTF-8; False, and nothing is written, where there is no room for all."""
        cdef bytes raw = data.encode() if isinstance(data, str) else bytes(data)
        done = bool(port_write(self.port(), raw, <uint32_t>len(raw)))
        announce(self.mapping.at)
        return done

    def clear(self) -> None:
        """Drop all that waits; for the reader."""
        port_clear(self.port())
