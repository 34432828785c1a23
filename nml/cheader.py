"""Writes message declarations as Cython structs, so that compiled code sees the very layout that Python declares.

``setup.py`` calls ``write_pxd`` for ``nml/emc/emcmot.py`` before Cython runs. Needs only the pure Python part of nml.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum
from pathlib import Path
from types import ModuleType

from nml.fields import ArrayField, CharField, Field, Scalar, StructArrayField, StructField
from nml.message import Message, Struct

_CYTHON_TYPES = {"bool": "unsigned char"}


def pxd(module: ModuleType) -> str:
    """The text of a ``.pxd`` with every structure, enumeration and integer constant that ``module`` defines."""
    own = [value for value in vars(module).values() if isinstance(value, type) and value.__module__ == module.__name__]
    parts = [f'"""Made by nml.cheader from {module.__name__}; change the declarations there."""\n']
    constants = {
        name: value
        for name, value in vars(module).items()
        if name.isupper() and isinstance(value, int) and not isinstance(value, bool)
    }
    parts.append(_enum(constants.items()))
    for cls in own:
        if issubclass(cls, Enum):
            parts.append(_enum((f"{cls.__name__}_{name}", int(m.value)) for name, m in cls.__members__.items()))
    messages = [cls for cls in own if issubclass(cls, Message)]
    parts.append(_enum((f"{cls.__name__}_TYPE", cls.TYPE_ID) for cls in messages))
    parts.extend(_struct(cls) for cls in own_structs(module))
    return "\n".join(parts)


def write_pxd(module: ModuleType, path: Path) -> None:
    """Write ``pxd(module)`` to ``path`` unless it stands there already, so that nothing is compiled again in vain."""
    text = pxd(module)
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


def own_structs(module: ModuleType) -> list[type[Struct]]:
    """The structures that ``module`` defines and whatever they contain, each after what it contains."""
    ordered: list[type[Struct]] = []

    def visit(cls: type[Struct]) -> None:
        for field in cls.FIELDS:
            if isinstance(field, (StructField, StructArrayField)):
                visit(field.struct)
        if cls not in ordered:
            ordered.append(cls)

    for value in vars(module).values():
        if isinstance(value, type) and issubclass(value, Struct) and value.__module__ == module.__name__:
            visit(value)
    return ordered


def _enum(members: Iterable[tuple[str, int]]) -> str:
    lines = [f"    {name} = {value}" for name, value in members]
    return "cdef enum:\n" + "\n".join(lines) + "\n" if lines else ""


def _struct(cls: type[Struct]) -> str:
    lines = [f"ctypedef struct {cls.__name__}:"]
    lines += [f"    {_declaration(field)}" for field in cls.FIELDS]
    return "\n".join(lines) + "\n"


def _declaration(field: Field) -> str:
    match field:
        case Scalar():
            return f"{_cython(field.type.c)} {field.name}"
        case ArrayField():
            return f"{_cython(field.type.c)} {field.name}[{field.length}]"
        case CharField():
            return f"char {field.name}[{field.length}]"
        case StructField():
            return f"{field.struct.__name__} {field.name}"
        case StructArrayField():
            return f"{field.struct.__name__} {field.name}[{field.length}]"
    raise TypeError(f"no C declaration for {field!r}")


def _cython(c_type: str) -> str:
    return _CYTHON_TYPES.get(c_type, c_type)
