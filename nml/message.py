"""Messages are declared once, as a class whose fields stand in memory order; everything else follows from that.

    class EMC_JOINT_HOME(Command, type_id=123):
        \"\"\"Home a joint.\"\"\"

        joint = integer(doc="joint index, -1: all")

An object is a typed view of one bytearray in the C compiler's layout: ``nml_type`` (int32 at 0), ``nml_size`` (int64
at 8), then the preamble of its kind (``Command``, ``Status``) and the fields. Writing a message to a buffer is one
copy, and reading an attribute decodes that attribute. A subclass goes on where the last member of its base ends, as
g++ lays out a class with constructors. Used by every process; the makers of fields come from ``nml.fields``.
"""

from __future__ import annotations

import struct as packing
from typing import Any, ClassVar, TypeVar

from nml.errors import DecodeError, EncodeError
from nml.fields import (
    Array,
    Cms,
    Field,
    StructArray,
    boolean,
    char,
    double,
    integer,
    long,
    real32,
    struct,
    uchar,
    uint,
    ulong,
)

__all__ = [
    "Array",
    "Cms",
    "Command",
    "Message",
    "Status",
    "Struct",
    "StructArray",
    "boolean",
    "char",
    "decode",
    "double",
    "integer",
    "long",
    "real32",
    "registry",
    "struct",
    "uchar",
    "uint",
    "ulong",
]

V = TypeVar("V", bound="Struct")
M = TypeVar("M", bound="Message")

registry: dict[int, type[Message]] = {}
"""Every declared message by its type number."""


class StructMeta(type):
    """Lays out the fields of a class when it is made."""

    def __new__(mcls, name: str, bases: tuple[type, ...], namespace: dict[str, Any], **options: Any) -> Any:
        namespace.setdefault("__slots__", ())
        return super().__new__(mcls, name, bases, namespace, **options)


def _lay_out(cls: type[Struct]) -> None:
    """Give offsets to the fields that ``cls`` adds, and make its constants."""
    base = next(b for b in cls.__bases__ if issubclass(b, Struct))
    added = [value for value in cls.__dict__.values() if isinstance(value, Field)]
    end, align = base.END, base.ALIGN
    for field in added:
        end += -end % field.align
        field.offset = end
        field.part = cls.PART
        end += field.size
        align = max(align, field.align)
    cls.FIELDS = base.FIELDS + tuple(added)
    cls.END = end
    cls.ALIGN = align
    cls.SIZE = end + -end % align
    cls.FLAT = packing.Struct(_flat_format(cls.FIELDS, cls.SIZE))
    image = bytearray(cls.SIZE)
    for field in cls.FIELDS:
        field.write_default(image)
    cls.TEMPLATE = bytes(image)
    body = tuple(field for field in cls.FIELDS if field.part == "body")
    cls.BODY = body
    if "wire_order" in cls.__dict__:
        by_name = {field.name: field for field in body}
        cls.WIRE = tuple(by_name[name] for name in cls.wire_order)
    else:
        cls.WIRE = tuple(field for field in body if not field.local)


def _flat_format(fields: tuple[Field, ...], size: int) -> str:
    """The whole structure in the notation of Python's ``struct``, padding written out."""
    parts, at = ["<"], 0
    for field in fields:
        if field.offset > at:
            parts.append(f"{field.offset - at}x")
        parts.append(field.flat())
        at = field.offset + field.size
    if size > at:
        parts.append(f"{size - at}x")
    return "".join(parts)


class Struct(metaclass=StructMeta):
    """A C structure seen in a buffer; by itself it is a member of messages, not a message."""

    __slots__ = ("_at", "_buf")

    PART: ClassVar[str] = "body"
    FIELDS: ClassVar[tuple[Field, ...]] = ()
    """All members in memory order."""
    BODY: ClassVar[tuple[Field, ...]] = ()
    """The members after header and preamble."""
    WIRE: ClassVar[tuple[Field, ...]] = ()
    """The members of the body that go on the wire, in wire order (``wire_order`` where that is not memory order)."""
    wire_order: ClassVar[tuple[str, ...]] = ()
    END: ClassVar[int] = 0
    ALIGN: ClassVar[int] = 1
    SIZE: ClassVar[int] = 0
    """C's sizeof."""
    FLAT: ClassVar[packing.Struct] = packing.Struct("<")
    TEMPLATE: ClassVar[bytes] = b""

    _buf: bytearray
    _at: int

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        _lay_out(cls)

    def __init__(self, **values: Any) -> None:
        self._buf = bytearray(self.TEMPLATE)
        self._at = 0
        if values:
            self.set(**values)

    def set(self, **values: Any) -> None:
        """Assign several fields; EncodeError names a field that the class does not have."""
        for name, value in values.items():
            try:
                setattr(self, name, value)
            except AttributeError:
                names = ", ".join(field.name for field in self.FIELDS)
                raise EncodeError(f"{type(self).__name__} has no field {name!r}; it has {names}") from None

    @classmethod
    def view(cls: type[V], buffer: bytearray, at: int = 0) -> V:
        """The structure that lies at ``at`` in ``buffer``, live and unchecked."""
        self = cls.__new__(cls)
        self._buf = buffer
        self._at = at
        return self

    @classmethod
    def field(cls, path: str) -> tuple[Field, int]:
        """The field at a dotted path (``motion.joint[2].homed``) and its offset from the start of this structure."""
        at = 0
        here: Any = cls
        found: Field | None = None
        for part in path.split("."):
            name, _, index = part.rstrip("]").partition("[")
            found = getattr(here, name, None)
            if not isinstance(found, Field):
                raise EncodeError(f"{cls.__name__} has no field {path!r}")
            at += found.offset + (int(index) * found.stride if index else 0)
            here = getattr(found, "struct", None)
        assert found is not None
        return found, at

    @property
    def data(self) -> bytearray | memoryview:
        """The bytes of the structure, live."""
        if self._at == 0 and len(self._buf) == self.SIZE:
            return self._buf
        return memoryview(self._buf)[self._at : self._at + self.SIZE]

    def __bytes__(self) -> bytes:
        return bytes(self.data)

    def copy(self: V) -> V:
        """An independent copy."""
        return self.view(bytearray(self.data))

    def astuple(self) -> tuple[Any, ...]:
        """All numbers, nested ones too, in memory order; texts as bytes."""
        return self.FLAT.unpack_from(self._buf, self._at)

    def to_dict(self) -> dict[str, Any]:
        """The fields after header and preamble as numbers, strings, lists and dicts."""
        return {field.name: field.plain(self) for field in self.BODY}

    def update(self, cms: Cms) -> None:
        """Pass every field that goes on the wire to ``cms``, in order."""
        for field in self.WIRE:
            field.walk(self, cms)

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return self.astuple() == other.astuple()

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        shown = []
        for field in self.FIELDS:
            if field.part == "header":
                continue
            start = field.offset
            if self.data[start : start + field.size] != self.TEMPLATE[start : start + field.size]:
                shown.append(f"{field.name}={getattr(self, field.name)!r}")
        return f"{type(self).__name__}({', '.join(shown)})"


class Message(Struct):
    """What a buffer carries: a structure with a type number (NMLmsg)."""

    PART = "header"
    TYPE_ID: ClassVar[int] = 0
    """Type number on the wire and in memory; 0 for a class that only serves as a base."""

    nml_type = integer(doc="type number")
    nml_size = long(unit="bytes", doc="sizeof of the structure at the sender")

    def __init_subclass__(cls, type_id: int = 0, **options: Any) -> None:
        if "PART" not in cls.__dict__:
            cls.PART = "body"
        super().__init_subclass__(**options)
        cls.TYPE_ID = type_id
        if not type_id:
            return
        image = bytearray(cls.TEMPLATE)
        _HEADER.pack_into(image, 0, type_id, cls.SIZE)
        cls.TEMPLATE = bytes(image)
        known = registry.get(type_id)
        if known is not None and (known.__module__, known.__name__) != (cls.__module__, cls.__name__):
            raise EncodeError(f"{cls.__name__}: type number {type_id} belongs to {known.__name__}")
        registry[type_id] = cls

    @classmethod
    def from_bytes(cls: type[M], data: bytes | bytearray | memoryview) -> M:
        """The message in ``data``, copied; DecodeError if it is another one or too short."""
        if len(data) < cls.SIZE:
            raise DecodeError(f"{cls.__name__} needs {cls.SIZE} bytes, here are {len(data)}")
        type_id = _HEADER.unpack_from(data)[0]
        if type_id != cls.TYPE_ID:
            raise DecodeError(f"{cls.__name__} is type {cls.TYPE_ID}, here is type {type_id}")
        return cls.view(bytearray(data[: cls.SIZE]))


class Command(Message):
    """A command: carries the serial number that its sender waits for (RCS_CMD_MSG)."""

    PART = "preamble"
    serial_number = integer(doc="write counter of the buffer, stored by the write")


class Status(Message):
    """A status: says which command it has taken and how that went (RCS_STAT_MSG)."""

    PART = "preamble"
    command_type = integer(doc="type of the command taken last")
    echo_serial_number = integer(doc="its serial number")
    status = integer(doc="RCS_STATUS: 1 done, 2 executing, 3 error")
    state = integer()
    line = integer()
    source_line = integer()
    source_file = char(64)


_HEADER = packing.Struct("<i4xq")


def decode(data: bytearray) -> Message:
    """The message that a buffer delivered, as a view of ``data``; DecodeError if no class fits it."""
    if len(data) < _HEADER.size:
        raise DecodeError(f"{len(data)} bytes are no message, the header alone has {_HEADER.size}")
    type_id = _HEADER.unpack_from(data)[0]
    cls = registry.get(type_id)
    if cls is None:
        raise DecodeError(f"unknown message type {type_id} ({len(data)} bytes); no imported module declares it")
    if len(data) < cls.SIZE:
        raise DecodeError(f"{cls.__name__} (type {type_id}) needs {cls.SIZE} bytes, here are {len(data)}")
    return cls.view(data)
