"""Fields by path (``motion.joint[2].homed``), and the arguments that all NML tools share."""

from __future__ import annotations

import argparse
import importlib
import os
import re
from collections.abc import Iterator
from typing import Any

from nml.channel import Channel
from nml.config import NmlConfig
from nml.errors import ConfigError, EncodeError
from nml.fields import BOOL, DOUBLE, FLOAT, ArrayField, CharField, CType, Scalar
from nml.message import Message, Struct, registry

VOCABULARY = ("nml.emc", "nml.emc.emcmot")

_PART = re.compile(r"(\w+)(?:\[(\d+)\])?")
_TRUE = {"1": True, "true": True, "on": True, "0": False, "false": False, "off": False}


def get(message: Struct, path: str) -> Any:
    """The value at a path; EncodeError if there is no such field."""
    value: Any = message
    for name, index in _parts(path):
        value = _member(value, name, path)
        if index is not None:
            value = _element(value, index, path)
    return value


def put(message: Struct, path: str, text: str) -> None:
    """Set the field at a path from text: a number, ``true``, a text, or numbers with commas for a whole structure."""
    *outer, (name, index) = _parts(path)
    owner: Any = message
    for part, at in outer:
        owner = _member(owner, part, path)
        if at is not None:
            owner = _element(owner, at, path)
    member = _member(owner, name, path)
    field = getattr(type(owner), name)
    try:
        if index is not None and isinstance(field, ArrayField):
            member[index] = _number(field.type, text)
        elif isinstance(field, Scalar):
            setattr(owner, name, _number(field.type, text))
        elif isinstance(field, CharField):
            setattr(owner, name, text)
        else:
            setattr(owner, name, [float(word) for word in text.split(",")])
    except ValueError as error:
        raise EncodeError(f"{path}: {text!r} is not a value of {field.c_type} ({error})") from None


def flat(message: Message) -> Iterator[tuple[str, Any]]:
    """Every field after the header as path and value."""
    for field in message.FIELDS:
        if field.part == "preamble":
            yield field.name, field.plain(message)
    yield from _flat("", message.to_dict())


def message_class(name: str) -> type[Message]:
    """The message class of a name, or of its number; ConfigError if there is none."""
    for number, cls in registry.items():
        if name in (cls.__name__, str(number)):
            return cls
    raise ConfigError(f"no message {name!r}; names are those of the manual, chapter 4, and of --vocabulary modules")


def common_arguments(parser: argparse.ArgumentParser) -> None:
    """Where to find the NML file, and what the messages are."""
    ini = os.environ.get("INI_FILE_NAME")
    parser.add_argument("-ini", metavar="FILE", default=ini, help="INI file of the controller")
    parser.add_argument("-nml", metavar="FILE", help="NML file instead of the one that the INI file names")
    help_ = "module that declares more messages"
    parser.add_argument("--vocabulary", metavar="MODULE", action="append", default=[], help=help_)


def configuration(arguments: argparse.Namespace) -> NmlConfig:
    """The NML file that the arguments name; declares the messages of this project and of the given modules."""
    for module in [*VOCABULARY, *arguments.vocabulary]:
        try:
            importlib.import_module(module)
        except ImportError as error:
            raise ConfigError(f"vocabulary {module}: {error}") from None
    if arguments.ini:
        os.environ["INI_FILE_NAME"] = arguments.ini
    return NmlConfig.load(arguments.nml)


def observe(config: NmlConfig, buffer: str, tool: str) -> Channel:
    """A channel that sees every message of a buffer and takes none from anybody."""
    return Channel.connect(config.buffer(buffer), config.observer(buffer, tool))


def _parts(path: str) -> list[tuple[str, int | None]]:
    parts = []
    for word in path.split("."):
        match = _PART.fullmatch(word)
        if match is None:
            raise EncodeError(f"{path!r} is no path to a field, such as motion.joint[2].homed")
        parts.append((match[1], int(match[2]) if match[2] is not None else None))
    return parts


def _member(value: Any, name: str, path: str) -> Any:
    if isinstance(value, Struct) and any(field.name == name for field in value.FIELDS):
        return getattr(value, name)
    raise EncodeError(f"{path}: {type(value).__name__} has no field {name!r}")


def _element(value: Any, index: int, path: str) -> Any:
    try:
        return value[index]
    except (IndexError, TypeError) as error:
        raise EncodeError(f"{path}: {error}") from None


def _number(ctype: CType, text: str) -> Any:
    if ctype is BOOL:
        if text.lower() not in _TRUE:
            raise ValueError("true or false is allowed")
        return _TRUE[text.lower()]
    return float(text) if ctype in (FLOAT, DOUBLE) else int(text, 0)


def _flat(prefix: str, value: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict):
        for name, item in value.items():
            yield from _flat(f"{prefix}.{name}" if prefix else name, item)
    elif isinstance(value, list):
        for index, item in enumerate(value):
            yield from _flat(f"{prefix}[{index}]", item)
    else:
        yield prefix, value
