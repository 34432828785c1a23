"""The NML file: buffers (B lines) and the processes that use them (P lines), parsed once into typed objects.

    B name type host size neut RPC# buffer# max_procs key [options]
    P name buffer type host ops server timeout master c_num [options]

The tables below say what every field and option may hold; an error names file, line, column and what is allowed there.
Contradictions between lines are no errors here: ``nml.check`` finds them. The meaning of the fields: Developer Manual,
chapter 3.21.
"""

from __future__ import annotations

import contextlib
import os
import re
import socket
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from enum import Enum
from pathlib import Path
from typing import Any, NamedTuple

from nml.errors import ConfigError, Place
from nml.inifile import IniFile

DEFAULT_FILE = Path(__file__).with_name("linuxcnc.nml")
FOREVER = -1.0
ANY_BUFFER = "default"
"""A P line for this buffer name serves every buffer that has no P line of its own for the process."""

_WORD = re.compile(r"\S+")


class BufferType(Enum):
    SHMEM = "SHMEM"
    LOCMEM = "LOCMEM"
    FILEMEM = "FILEMEM"
    PHANTOM = "PHANTOM"
    GLOBMEM = "GLOBMEM"


class ProcessType(Enum):
    LOCAL = "LOCAL"
    REMOTE = "REMOTE"
    AUTO = "AUTO"


class Mutex(Enum):
    """How writers keep apart. Ours never hold up readers, so ``mao split`` asks for what every buffer does anyway."""

    OS_SEM = "os_sem"
    NONE = "none"
    NO_INTERRUPTS = "no_interrupts"
    NO_SWITCHING = "no_switching"
    MAO_SPLIT = "mao split"


class Encoding(Enum):
    XDR = "xdr"
    ASCII = "ascii"
    DISP = "disp"
    MSGPACK = "msgpack"


@dataclass(frozen=True, slots=True, kw_only=True)
class BufferLine:
    """A B line."""

    name: str
    type: BufferType = BufferType.SHMEM
    host: str = "localhost"
    size: int
    neutral: bool = False
    rpc: int = 0
    number: int
    max_procs: int
    key: int
    mutex: Mutex = Mutex.OS_SEM
    encoding: Encoding = Encoding.XDR
    queue: bool = False
    broadcast: bool = False
    confirm_write: bool = False
    serial: bool = False
    diag: bool = False
    tcp: int | None = None
    udp: int | None = None
    stcp: int | None = None
    serial_port: str | None = None
    baud: int = 115200
    passwd: str | None = None
    bsem: int | None = None
    subdivisions: int = 1
    enc_max_size: int | None = None
    version: float | None = None
    place: Place = field(compare=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessLine:
    """A P line. ``observer``, which no file can say: sees every message and takes none (``NmlConfig.observer``)."""

    process: str
    buffer: str
    type: ProcessType = ProcessType.LOCAL
    host: str = "localhost"
    ops: str
    server: bool = False
    timeout: float = FOREVER
    master: bool = False
    c_num: int
    shared: bool = False
    observer: bool = False
    poll: bool = False
    subscription: str = "none"
    reconnect: bool = True
    max_timeouts: int | None = None
    serial_port: str | None = None
    passwd: str | None = None
    place: Place = field(compare=False)

    @property
    def may_read(self) -> bool:
        return "R" in self.ops

    @property
    def may_write(self) -> bool:
        return "W" in self.ops


class _Kind(NamedTuple):
    """What a field or option may hold: the words for an error, and the conversion (ValueError or KeyError: wrong)."""

    allowed: str
    convert: Callable[[str], Any]


def _whole(minimum: int, maximum: int) -> _Kind:
    def convert(word: str) -> int:
        value = int(word, 0)
        if not minimum <= value <= maximum:
            raise ValueError(word)
        return value

    return _Kind(f"a whole number from {minimum} to {maximum}", convert)


def _one_of(cls: type[Enum]) -> _Kind:
    return _Kind("one of " + ", ".join(member.value for member in cls), lambda word: cls(word))


def _ops(word: str) -> str:
    if not word or set(word.upper()) - set("RW"):
        raise ValueError(word)
    return word.upper()


def _timeout(word: str) -> float:
    """Seconds; 0: only if nobody else is there; INF or negative: for ever."""
    if word.upper() in ("INF", "INFINITE"):
        return FOREVER
    seconds = float(word)
    if seconds != seconds:
        raise ValueError(word)
    return seconds if seconds >= 0.0 else FOREVER


def _count_or_inf(word: str) -> int | None:
    return None if word.upper() == "INF" else int(word)


def _positive_real(word: str) -> float:
    value = float(word)
    if not value >= 0.0:
        raise ValueError(word)
    return value


_NAME = _Kind("a name of at most 31 characters", lambda word: word if len(word) < 32 else int(""))
_TEXT = _Kind("a word", str)
_FLAG = _whole(0, 1)
_PORT = _whole(1, 65535)
_COUNT = _whole(0, 2**31 - 1)
_INT = _whole(-(2**31), 2**32 - 1)

_BUFFER_FIELDS: tuple[tuple[str, _Kind], ...] = (
    ("name", _NAME),
    ("type", _one_of(BufferType)),
    ("host", _TEXT),
    ("size", _whole(128, 2**31 - 1)),
    ("neutral", _FLAG),
    ("rpc", _INT),
    ("number", _COUNT),
    ("max_procs", _whole(1, 4096)),
    ("key", _INT),
)
_PROCESS_FIELDS: tuple[tuple[str, _Kind], ...] = (
    ("process", _NAME),
    ("buffer", _NAME),
    ("type", _one_of(ProcessType)),
    ("host", _TEXT),
    ("ops", _Kind("R, W or RW", _ops)),
    ("server", _whole(0, 2)),
    ("timeout", _Kind("seconds, a negative number or INF", _timeout)),
    ("master", _FLAG),
    ("c_num", _whole(0, 4095)),
)

_BUFFER_FLAGS: dict[str, tuple[str, Any]] = {
    "queue": ("queue", True),
    "broadcast": ("broadcast", True),
    "confirm_write": ("confirm_write", True),
    "serial": ("serial", True),
    "diag": ("diag", True),
    "xdr": ("encoding", Encoding.XDR),
    "ascii": ("encoding", Encoding.ASCII),
    "disp": ("encoding", Encoding.DISP),
    "msgpack": ("encoding", Encoding.MSGPACK),
}
_BUFFER_VALUES: dict[str, tuple[str, _Kind]] = {
    "mutex": ("mutex", _one_of(Mutex)),
    "TCP": ("tcp", _PORT),
    "UDP": ("udp", _PORT),
    "STCP": ("stcp", _PORT),
    "serialPortDevName": ("serial_port", _TEXT),
    "baud": ("baud", _whole(50, 4_000_000)),
    "passwd": ("passwd", _TEXT),
    "bsem": ("bsem", _INT),
    "subdiv": ("subdivisions", _whole(1, 100)),
    "enc_max_size": ("enc_max_size", _COUNT),
    "version": ("version", _Kind("a version number", _positive_real)),
}
_PROCESS_FLAGS: dict[str, tuple[str, Any]] = {
    "shared": ("shared", True),
    "POLL": ("poll", True),
    "noreconnect": ("reconnect", False),
}
_PROCESS_VALUES: dict[str, tuple[str, _Kind]] = {
    "sub": ("subscription", _Kind("none, var or seconds", lambda w: w if w in ("none", "var") else str(float(w)))),
    "max_timeouts": ("max_timeouts", _Kind("a whole number or INF", _count_or_inf)),
    "serialPortDevName": ("serial_port", _TEXT),
    "passwd": ("passwd", _TEXT),
}


class NmlConfig:
    """A parsed NML file. ConfigError for a file that cannot be read or a line that makes no sense."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        self.buffer_lines: list[BufferLine] = []
        self.process_lines: list[ProcessLine] = []
        self.remarks: list[str] = []
        """What is accepted but has no effect here, as ``file:line: ...``."""
        try:
            lines = self.path.read_text(encoding="utf-8", errors="replace").splitlines()
        except OSError as error:
            raise ConfigError(f"cannot read the NML file: {error.strerror}", Place(str(path))) from None
        for number, line in enumerate(lines, 1):
            self._take(line, number)

    @classmethod
    def load(cls, path: str | os.PathLike[str] | None = None) -> NmlConfig:
        """The configuration of this controller: ``path``, or the environment's NML_FILE, or [EMC]NML_FILE of the
        INI file that INI_FILE_NAME names, or the packaged file; with what a stock file lacks (``complete``)."""
        config = cls(path or _default_path())
        if config.path != DEFAULT_FILE:
            config.complete(cls(DEFAULT_FILE))
        return config

    def complete(self, packaged: NmlConfig) -> None:
        """Add our own buffers where the file lacks them, and let operator messages reach every reader.

        They go the way of emcStatus: same host and port, and for each process the same kind of line.
        """
        self.buffer_lines = [
            replace(line, broadcast=True) if line.name in BROADCAST_BUFFERS and line.queue else line
            for line in self.buffer_lines
        ]
        present = {line.name for line in self.buffer_lines}
        guide = next((line for line in self.buffer_lines if line.name == "emcStatus"), None)
        ways = {line.process: line for line in self.process_lines if line.buffer == "emcStatus"}
        for line in packaged.buffer_lines:
            if line.name in OWN_BUFFERS - present:
                if guide is not None:
                    links = {name: getattr(guide, name) for name in _LINKS} if line.tcp else {"tcp": None}
                    line = replace(line, host=guide.host, **links)
                self.buffer_lines.append(line)
        for user in packaged.process_lines:
            if user.buffer in OWN_BUFFERS - present:
                if way := ways.get(user.process):
                    user = replace(user, **{name: getattr(way, name) for name in _WAY})
                self.process_lines.append(user)

    def buffer(self, name: str) -> BufferLine:
        """The B line of a buffer."""
        for line in self.buffer_lines:
            if line.name == name:
                return line
        names = ", ".join(line.name for line in self.buffer_lines) or "none"
        raise ConfigError(f"no buffer {name!r}; the file has {names}", Place(str(self.path)))

    def process(self, process: str, buffer: str) -> ProcessLine:
        """The P line of a process for a buffer, or for 'default'."""
        own = [line for line in self.process_lines if line.process == process]
        for name in (buffer, ANY_BUFFER):
            for line in own:
                if line.buffer == name:
                    return line
        names = ", ".join(line.buffer for line in own) or "none"
        message = f"no P line of process {process!r} for buffer {buffer!r}; it has {names}"
        raise ConfigError(message, Place(str(self.path)))

    def observer(self, buffer: str, process: str = "observer") -> ProcessLine:
        """A line for a tool that looks on: it reads every message of a buffer and takes none from anybody."""
        users = [line for line in self.process_lines if line.buffer in (buffer, ANY_BUFFER)]
        remote = bool(users) and all(line.type is ProcessType.REMOTE for line in users)
        return ProcessLine(
            process=process,
            buffer=buffer,
            type=ProcessType.REMOTE if remote else ProcessType.LOCAL,
            ops="R",
            timeout=1.0,
            observer=True,
            c_num=0,
            place=Place(str(self.path)),
        )

    def _take(self, text: str, number: int) -> None:
        words = [(match[0], Place(str(self.path), number, match.start() + 1)) for match in _WORD.finditer(text)]
        if not words or words[0][0].startswith("#"):
            return
        kind, place = words[0]
        if kind == "B":
            values = _fields(words[1:], _BUFFER_FIELDS, place)
            values |= _options(words[1 + len(_BUFFER_FIELDS) :], _BUFFER_FLAGS, _BUFFER_VALUES)
            values["neutral"] = bool(values["neutral"])
            line = BufferLine(**values, place=Place(place.file, place.line))
            self.buffer_lines.append(line)
            self.remarks += [f"{line.place}: buffer {line.name}: {text}" for text in _remarks(line)]
        elif kind == "P":
            values = _fields(words[1:], _PROCESS_FIELDS, place)
            values |= _options(words[1 + len(_PROCESS_FIELDS) :], _PROCESS_FLAGS, _PROCESS_VALUES)
            values |= {"server": bool(values["server"]), "master": bool(values["master"])}
            self.process_lines.append(ProcessLine(**values, place=Place(place.file, place.line)))
        else:
            raise ConfigError(f"{kind!r} begins no line; B, P or a comment with # is allowed", place)


def _remarks(line: BufferLine) -> Iterator[str]:
    if line.type is BufferType.GLOBMEM:
        yield "GLOBMEM is obsolete and served as SHMEM"
    if line.mutex in (Mutex.NO_INTERRUPTS, Mutex.NO_SWITCHING):
        yield f"mutex={line.mutex.value} does not exist on Linux; os_sem is used"


_Words = list[tuple[str, Place]]


def _fields(words: _Words, fields: tuple[tuple[str, _Kind], ...], start: Place) -> dict[str, Any]:
    values = {}
    for index, (name, kind) in enumerate(fields):
        if index >= len(words):
            names = " ".join(name for name, _ in fields)
            raise ConfigError(f"{name} is missing: {kind.allowed}; the line needs {names}", start)
        values[name] = _converted(name, kind, *words[index])
    return values


def _options(
    words: _Words, flags: dict[str, tuple[str, Any]], values: dict[str, tuple[str, _Kind]]
) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for word, place in _joined(words):
        name, equals, text = word.partition("=")
        if not equals and word in flags:
            key, value = flags[word]
            found[key] = value
        elif equals and name in values:
            key, kind = values[name]
            found[key] = _converted(name, kind, text, place)
        else:
            allowed = ", ".join([*flags, *(f"{name}=" for name in values)])
            raise ConfigError(f"{word!r} is no option here; allowed are {allowed}", place)
    return found


def _joined(words: _Words) -> Iterator[tuple[str, Place]]:
    """The options; ``mutex=mao split`` is one, and everything after # a comment."""
    rest = iter(words)
    for word, place in rest:
        if word.startswith("#"):
            return
        if word == "mutex=mao":
            following, _ = next(rest, ("", place))
            word = f"{word} {following}"
        yield word, place


def _converted(name: str, kind: _Kind, word: str, place: Place) -> Any:
    try:
        return kind.convert(word)
    except (ValueError, KeyError):
        raise ConfigError(f"{name} is {word!r}; {kind.allowed} is allowed", place) from None


def _default_path() -> Path:
    if named := os.environ.get("NML_FILE"):
        return Path(named)
    if ini := os.environ.get("INI_FILE_NAME"):
        return IniFile(ini).path("EMC", "NML_FILE", DEFAULT_FILE)
    return DEFAULT_FILE


def is_this_host(host: str) -> bool:
    """Whether a B line's host is where this process runs (what AUTO asks): an address that can be bound here is."""
    if host.startswith("localhost"):
        return True
    try:
        addresses = socket.getaddrinfo(host, 0, type=socket.SOCK_DGRAM)
    except OSError:
        return False
    for family, kind, protocol, _, address in addresses:
        with contextlib.suppress(OSError), socket.socket(family, kind, protocol) as probe:
            probe.bind(address)
            return True
    return False


BROADCAST_BUFFERS = frozenset({"emcError"})
"""Queues in which every reader gets every message, also in a stock file; ``shared`` in a P line is stock behaviour."""

_LINKS = ("tcp", "udp", "stcp", "serial_port", "baud", "passwd")
_WAY = ("type", "host", "timeout", "reconnect", "max_timeouts", "serial_port", "passwd")
OWN_BUFFERS = frozenset(
    {"emcmotCommand", "emcmotStatus", "emcmotError", "emcOrders", "emcResults", "toolTable", "callStacks"}
)
"""Buffers that LinuxCNC does not have; added to every NML file."""
