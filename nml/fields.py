"""The fields of a message: descriptors that read and write one member of a C structure in a bytearray.

A field knows its C type, its unit and what it means; ``nml.message`` gives it a name and an offset when the class that
holds it is made. A view (``nml.message.Struct``) is a buffer and a position in it, so that every access decodes
one member only, and nested structures and arrays are live views of the same bytes.

Layout facts: System V ABI for 64-bit x86, which is what g++ does for LinuxCNC's message classes.
"""

from __future__ import annotations

import struct as packing
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, Protocol, TypeVar, overload

from nml.errors import EncodeError

if TYPE_CHECKING:
    from nml.message import Struct

_new = object.__new__

T = TypeVar("T", int, float, bool)
S = TypeVar("S", bound="Struct")


class CType(NamedTuple):
    """A scalar C type: its spelling in C and Cython, its code in Python's ``struct``, its size and alignment."""

    c: str
    code: str
    size: int


BOOL = CType("bool", "?", 1)
CHAR = CType("char", "s", 1)
UCHAR = CType("unsigned char", "B", 1)
INT = CType("int", "i", 4)
UINT = CType("unsigned int", "I", 4)
LONG = CType("long", "q", 8)
ULONG = CType("unsigned long", "Q", 8)
FLOAT = CType("float", "f", 4)
DOUBLE = CType("double", "d", 8)


class Cms(Protocol):
    """What walks a message: a codec. ``Struct.update`` calls one of these for every field that goes on the wire."""

    def scalar(self, view: Struct, field: Scalar[Any]) -> None: ...

    def array(self, view: Struct, field: ArrayField[Any]) -> None: ...

    def text(self, view: Struct, field: CharField) -> None: ...


class Field:
    """What all fields share. ``name``, ``owner`` and ``offset`` are filled in by the class that holds the field.

    ``part`` is 'header', 'preamble' or 'body'; ``local`` marks a member that stock LinuxCNC keeps off the wire.
    """

    __slots__ = ("align", "doc", "local", "name", "offset", "owner", "part", "size", "unit")

    def __init__(self, size: int, align: int, *, unit: str = "", doc: str = "", local: bool = False) -> None:
        self.size = size
        self.align = align
        self.unit = unit
        self.doc = doc
        self.local = local
        self.name = ""
        self.owner = ""
        self.offset = 0
        self.part = "body"

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name
        self.owner = owner.__name__

    def __repr__(self) -> str:
        return f"<field {self.owner}.{self.name}: {self.c_type}, offset {self.offset}, {self.size} bytes>"

    @property
    def c_type(self) -> str:
        """The type as a C programmer writes it, e.g. ``double[16]``."""
        raise NotImplementedError

    @property
    def stride(self) -> int:
        """Bytes from one element of an array to the next; 0 for what is no array."""
        return 0

    def flat(self) -> str:
        """The member in the notation of Python's ``struct`` (no byte order, no alignment)."""
        raise NotImplementedError

    def write_default(self, image: bytearray) -> None:
        """Put the value of a fresh message into ``image``, which is zero."""

    def plain(self, view: Struct) -> Any:
        """The value as numbers, strings, lists and dicts."""
        raise NotImplementedError

    def walk(self, view: Struct, cms: Cms) -> None:
        """Pass the member to a codec."""
        raise NotImplementedError

    def assign(self, view: Struct, value: Any) -> None:
        """Set the member, as an assignment to the attribute does (also where a subclass hides the name)."""
        type(self).__set__(self, view, value)  # type: ignore[attr-defined]

    def refuse(self, value: object, error: Exception) -> EncodeError:
        """The error for a value that this member cannot hold."""
        return EncodeError(f"{self.owner}.{self.name}: {value!r} does not fit into {self.c_type} ({error})")


class Scalar(Field, Generic[T]):
    """One number or truth value."""

    __slots__ = ("_pack_into", "_unpack_from", "default", "type")

    def __init__(self, ctype: CType, *, default: T, unit: str = "", doc: str = "", local: bool = False) -> None:
        super().__init__(ctype.size, ctype.size, unit=unit, doc=doc, local=local)
        packer = packing.Struct("<" + ctype.code)
        self._unpack_from = packer.unpack_from
        self._pack_into = packer.pack_into
        self.type = ctype
        self.default: T = default

    @overload
    def __get__(self, view: None, owner: type) -> Scalar[T]: ...
    @overload
    def __get__(self, view: Struct, owner: type | None = None) -> T: ...
    def __get__(self, view: Struct | None, owner: type | None = None) -> T | Scalar[T]:
        if view is None:
            return self
        return self._unpack_from(view._buf, view._at + self.offset)[0]

    def __set__(self, view: Struct, value: T) -> None:
        try:
            self._pack_into(view._buf, view._at + self.offset, value)
        except (packing.error, OverflowError) as error:
            raise self.refuse(value, error) from None

    @property
    def c_type(self) -> str:
        return self.type.c

    def flat(self) -> str:
        return self.type.code

    def write_default(self, image: bytearray) -> None:
        self._pack_into(image, self.offset, self.default)

    def plain(self, view: Struct) -> Any:
        return self.__get__(view)

    def walk(self, view: Struct, cms: Cms) -> None:
        cms.scalar(view, self)


class ArrayField(Field, Generic[T]):
    """A fixed number of numbers."""

    __slots__ = ("item", "length", "packer", "type")

    def __init__(self, ctype: CType, length: int, *, unit: str = "", doc: str = "", local: bool = False) -> None:
        super().__init__(ctype.size * length, ctype.size, unit=unit, doc=doc, local=local)
        self.type = ctype
        self.length = length
        self.item = packing.Struct("<" + ctype.code)
        self.packer = packing.Struct(f"<{length}{ctype.code}")

    @overload
    def __get__(self, view: None, owner: type) -> ArrayField[T]: ...
    @overload
    def __get__(self, view: Struct, owner: type | None = None) -> Array[T]: ...
    def __get__(self, view: Struct | None, owner: type | None = None) -> Array[T] | ArrayField[T]:
        if view is None:
            return self
        return Array(view._buf, view._at + self.offset, self)

    def __set__(self, view: Struct, value: Iterable[T]) -> None:
        try:
            self.packer.pack_into(view._buf, view._at + self.offset, *value)
        except (packing.error, OverflowError) as error:
            raise self.refuse(value, error) from None

    @property
    def c_type(self) -> str:
        return f"{self.type.c}[{self.length}]"

    @property
    def stride(self) -> int:
        return self.type.size

    def flat(self) -> str:
        return f"{self.length}{self.type.code}"

    def plain(self, view: Struct) -> Any:
        return list(self.packer.unpack_from(view._buf, view._at + self.offset))

    def walk(self, view: Struct, cms: Cms) -> None:
        cms.array(view, self)


class CharField(Field):
    """A zero-terminated text of at most ``length - 1`` bytes of UTF-8.

    ``wire`` is the length that LinuxCNC's encoder passes where it is not the declared one; ``cut`` shortens a text that
    is too long instead of refusing it.
    """

    __slots__ = ("cut", "length", "wire")

    def __init__(
        self, length: int, *, wire: int = 0, cut: bool = False, unit: str = "", doc: str = "", local: bool = False
    ) -> None:
        super().__init__(length, 1, unit=unit, doc=doc, local=local)
        self.length = length
        self.wire = wire or length
        self.cut = cut

    @overload
    def __get__(self, view: None, owner: type) -> CharField: ...
    @overload
    def __get__(self, view: Struct, owner: type | None = None) -> str: ...
    def __get__(self, view: Struct | None, owner: type | None = None) -> str | CharField:
        if view is None:
            return self
        start = view._at + self.offset
        raw = bytes(view._buf[start : start + self.length])
        return raw.partition(b"\0")[0].decode("utf-8", "surrogateescape")

    def __set__(self, view: Struct, value: str | bytes) -> None:
        raw = value.encode("utf-8", "surrogateescape") if isinstance(value, str) else bytes(value)
        if len(raw) >= self.length:
            if not self.cut:
                raise self.refuse(value, ValueError(f"{len(raw)} bytes, {self.length - 1} are allowed"))
            raw = raw[: self.length - 1].decode("utf-8", "ignore").encode("utf-8")
        if b"\0" in raw:
            raise self.refuse(value, ValueError("a zero byte would end it"))
        start = view._at + self.offset
        view._buf[start : start + self.length] = raw.ljust(self.length, b"\0")

    @property
    def c_type(self) -> str:
        return f"char[{self.length}]"

    def flat(self) -> str:
        return f"{self.length}s"

    def plain(self, view: Struct) -> Any:
        return self.__get__(view)

    def walk(self, view: Struct, cms: Cms) -> None:
        cms.text(view, self)


class StructField(Field, Generic[S]):
    """A nested structure; assign another one, or the flat sequence of its numbers."""

    __slots__ = ("struct",)

    def __init__(self, cls: type[S], *, unit: str = "", doc: str = "", local: bool = False) -> None:
        super().__init__(cls.SIZE, cls.ALIGN, unit=unit, doc=doc, local=local)
        self.struct = cls

    @overload
    def __get__(self, view: None, owner: type) -> StructField[S]: ...
    @overload
    def __get__(self, view: Struct, owner: type | None = None) -> S: ...
    def __get__(self, view: Struct | None, owner: type | None = None) -> S | StructField[S]:
        if view is None:
            return self
        nested = _new(self.struct)
        nested._buf = view._buf
        nested._at = view._at + self.offset
        return nested

    def __set__(self, view: Struct, value: S | Sequence[float]) -> None:
        put_struct(self, self.struct, view._buf, view._at + self.offset, value)

    @property
    def c_type(self) -> str:
        return self.struct.__name__

    def flat(self) -> str:
        return self.struct.FLAT.format[1:]

    def write_default(self, image: bytearray) -> None:
        image[self.offset : self.offset + self.size] = self.struct.TEMPLATE

    def plain(self, view: Struct) -> Any:
        return self.__get__(view).to_dict()

    def walk(self, view: Struct, cms: Cms) -> None:
        self.__get__(view).update(cms)


class StructArrayField(Field, Generic[S]):
    """A fixed number of nested structures."""

    __slots__ = ("length", "struct")

    def __init__(self, cls: type[S], length: int, *, unit: str = "", doc: str = "", local: bool = False) -> None:
        super().__init__(cls.SIZE * length, cls.ALIGN, unit=unit, doc=doc, local=local)
        self.struct = cls
        self.length = length

    @overload
    def __get__(self, view: None, owner: type) -> StructArrayField[S]: ...
    @overload
    def __get__(self, view: Struct, owner: type | None = None) -> StructArray[S]: ...
    def __get__(self, view: Struct | None, owner: type | None = None) -> StructArray[S] | StructArrayField[S]:
        if view is None:
            return self
        return StructArray(view._buf, view._at + self.offset, self)

    def __set__(self, view: Struct, value: Sequence[S | Sequence[float]]) -> None:
        if len(value) != self.length:
            raise self.refuse(value, ValueError(f"{len(value)} elements, {self.length} are needed"))
        elements = self.__get__(view)
        for index, element in enumerate(value):
            elements[index] = element

    @property
    def c_type(self) -> str:
        return f"{self.struct.__name__}[{self.length}]"

    @property
    def stride(self) -> int:
        return self.struct.SIZE

    def flat(self) -> str:
        return self.struct.FLAT.format[1:] * self.length

    def write_default(self, image: bytearray) -> None:
        image[self.offset : self.offset + self.size] = self.struct.TEMPLATE * self.length

    def plain(self, view: Struct) -> Any:
        return [element.to_dict() for element in self.__get__(view)]

    def walk(self, view: Struct, cms: Cms) -> None:
        for element in self.__get__(view):
            element.update(cms)


def put_struct(field: Field, cls: type[S], buffer: bytearray, at: int, value: S | Sequence[float]) -> None:
    """Copy a structure, or pack the flat sequence of its numbers, into ``buffer``."""
    if isinstance(value, cls):
        buffer[at : at + cls.SIZE] = value.data
        return
    try:
        cls.FLAT.pack_into(buffer, at, *value)  # type: ignore[misc]
    except (packing.error, OverflowError, TypeError) as error:
        raise field.refuse(value, error) from None


class Elements(ABC):
    """What live views of arrays share."""

    __slots__ = ("_at", "_buf")

    _buf: bytearray
    _at: int
    _field: Any

    @abstractmethod
    def __iter__(self) -> Iterator[Any]: ...

    def __len__(self) -> int:
        length: int = self._field.length
        return length

    def _position(self, index: int) -> int:
        """Where an element lies in the buffer; negative indices count from the end."""
        field = self._field
        if index < 0:
            index += field.length
        if not 0 <= index < field.length:
            raise IndexError(f"{field.owner}.{field.name}[{index}]: {field.length} elements")
        at: int = self._at + index * field.stride
        return at

    def __eq__(self, other: object) -> bool:
        if isinstance(other, (Elements, list, tuple)):
            return list(self) == list(other)
        return NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return repr(list(self))


class Array(Elements, Generic[T]):
    """Live view of an array of numbers."""

    __slots__ = ("_field",)

    def __init__(self, buffer: bytearray, at: int, field: ArrayField[T]) -> None:
        self._buf = buffer
        self._at = at
        self._field: ArrayField[T] = field

    def tolist(self) -> list[T]:
        """All elements, decoded at once."""
        return list(self._field.packer.unpack_from(self._buf, self._at))

    def __iter__(self) -> Iterator[T]:
        return iter(self._field.packer.unpack_from(self._buf, self._at))

    @overload
    def __getitem__(self, index: int) -> T: ...
    @overload
    def __getitem__(self, index: slice) -> list[T]: ...
    def __getitem__(self, index: int | slice) -> T | list[T]:
        if isinstance(index, slice):
            return self.tolist()[index]
        return self._field.item.unpack_from(self._buf, self._position(index))[0]

    def __setitem__(self, index: int, value: T) -> None:
        try:
            self._field.item.pack_into(self._buf, self._position(index), value)
        except (packing.error, OverflowError) as error:
            raise self._field.refuse(value, error) from None


class StructArray(Elements, Generic[S]):
    """Live view of an array of structures; so are its elements."""

    __slots__ = ("_field",)

    def __init__(self, buffer: bytearray, at: int, field: StructArrayField[S]) -> None:
        self._buf = buffer
        self._at = at
        self._field: StructArrayField[S] = field

    def __getitem__(self, index: int) -> S:
        return self._field.struct.view(self._buf, self._position(index))

    def __setitem__(self, index: int, value: S | Sequence[float]) -> None:
        put_struct(self._field, self._field.struct, self._buf, self._position(index), value)

    def __iter__(self) -> Iterator[S]:
        cls = self._field.struct
        return (cls.view(self._buf, self._at + index * cls.SIZE) for index in range(self._field.length))


class Maker(Generic[T]):
    """Makes fields of one scalar type: ``integer()`` one number, ``integer(16)`` an array."""

    def __init__(self, ctype: CType, zero: T) -> None:
        self.type = ctype
        self.zero: T = zero

    @overload
    def __call__(
        self, length: None = None, *, unit: str = "", doc: str = "", local: bool = False, default: T | None = None
    ) -> Scalar[T]: ...
    @overload
    def __call__(self, length: int, *, unit: str = "", doc: str = "", local: bool = False) -> ArrayField[T]: ...
    def __call__(
        self,
        length: int | None = None,
        *,
        unit: str = "",
        doc: str = "",
        local: bool = False,
        default: T | None = None,
    ) -> Scalar[T] | ArrayField[T]:
        if length is not None:
            return ArrayField(self.type, length, unit=unit, doc=doc, local=local)
        value = self.zero if default is None else default
        return Scalar(self.type, default=value, unit=unit, doc=doc, local=local)


boolean = Maker[bool](BOOL, False)
uchar = Maker[int](UCHAR, 0)
integer = Maker[int](INT, 0)
uint = Maker[int](UINT, 0)
long = Maker[int](LONG, 0)
ulong = Maker[int](ULONG, 0)
real32 = Maker[float](FLOAT, 0.0)
double = Maker[float](DOUBLE, 0.0)
char = CharField


@overload
def struct(
    cls: type[S], length: None = None, *, unit: str = "", doc: str = "", local: bool = False
) -> StructField[S]: ...
@overload
def struct(
    cls: type[S], length: int, *, unit: str = "", doc: str = "", local: bool = False
) -> StructArrayField[S]: ...
def struct(
    cls: type[S], length: int | None = None, *, unit: str = "", doc: str = "", local: bool = False
) -> StructField[S] | StructArrayField[S]:
    """A nested structure, or an array of ``length`` of them."""
    if length is None:
        return StructField(cls, unit=unit, doc=doc, local=local)
    return StructArrayField(cls, length, unit=unit, doc=doc, local=local)
