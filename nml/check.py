"""Finds contradictions in an NML file: lines that are well formed, but cannot all be meant. Used by ``nmlcheck``.

Each rule is a function from the configuration to findings, each ``file:line: what is wrong; what would be right``.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterator

import nml.emc.emcmot
from nml.config import ANY_BUFFER, OWN_BUFFERS, BufferLine, BufferType, NmlConfig, ProcessLine, ProcessType
from nml.message import Command, Message

Rule = Callable[[NmlConfig], Iterator[str]]

RECORD_HEAD = 32
"""Bytes that stand before every message of a queue."""


def _is_command(cls: object) -> bool:
    return isinstance(cls, type) and issubclass(cls, Command) and cls.TYPE_ID != 0


MESSAGES: dict[str, tuple[type[Message], ...]] = {
    "emcCommand": tuple(cls for name, cls in vars(nml.emc).items() if name.startswith("EMC_") and _is_command(cls)),
    "emcStatus": (nml.emc.EMC_STAT,),
    "emcError": (nml.emc.EMC_OPERATOR_ERROR, nml.emc.EMC_OPERATOR_TEXT, nml.emc.EMC_OPERATOR_DISPLAY),
    "toolCmd": (nml.emc.EMC_TOOL_SET_OFFSET, nml.emc.EMC_TOOL_LOAD_TOOL_TABLE),
    "toolSts": (nml.emc.EMC_IO_STAT,),
    "toolTable": (nml.emc.EMC_TOOL_TABLE,),
    "callStacks": (nml.emc.EMC_CALL_STACKS,),
    "emcmotCommand": (nml.emc.emcmot.EMCMOT_COMMAND,),
    "emcmotStatus": (nml.emc.emcmot.EMCMOT_STATUS,),
    "emcmotError": (nml.emc.emcmot.EMCMOT_ERROR,),
    "emcOrders": (nml.emc.EMC_ORDER_NOTE,),
    "emcResults": (nml.emc.EMC_ORDER_RESULT, nml.emc.EMC_OPERATOR_ERROR),
}
"""What each buffer of a controller must be able to carry."""

_NATIVE = OWN_BUFFERS - {"toolTable", "callStacks", "emcOrders", "emcResults"}
"""Buffers that the servo thread uses without Python: plain C layout in shared memory."""


def contradictions(config: NmlConfig) -> list[str]:
    """Everything that is wrong, in the order of the rules."""
    return [finding for rule in RULES for finding in rule(config)]


def users(config: NmlConfig, buffer: BufferLine) -> list[ProcessLine]:
    """The process lines that apply to a buffer: its own, and 'default' ones of processes without."""
    own = [line for line in config.process_lines if line.buffer == buffer.name]
    named = {line.process for line in own}
    others = (line for line in config.process_lines if line.buffer == ANY_BUFFER and line.process not in named)
    return own + list(others)


def _declared(config: NmlConfig) -> Iterator[BufferLine]:
    """The buffers that the file itself declares; ours that were added to it need no lines of its processes."""
    return (line for line in config.buffer_lines if line.place.file == str(config.path))


def _names(config: NmlConfig) -> Iterator[str]:
    first: dict[str, BufferLine] = {}
    for line in config.buffer_lines:
        if line.name in first:
            yield f"{line.place}: buffer {line.name} is declared twice; first at {first[line.name].place}"
        first.setdefault(line.name, line)
    seen: dict[tuple[str, str], ProcessLine] = {}
    known = set(first) | {ANY_BUFFER}
    for user in config.process_lines:
        where = (user.process, user.buffer)
        if where in seen:
            yield f"{user.place}: process {user.process} has two lines for {user.buffer}; first at {seen[where].place}"
        seen.setdefault(where, user)
        if user.buffer not in known:
            yield f"{user.place}: process {user.process} uses buffer {user.buffer}, which no B line declares"


def _keys(config: NmlConfig) -> Iterator[str]:
    by_key: dict[int, BufferLine] = {}
    by_number: dict[tuple[int, int], BufferLine] = {}
    for line in config.buffer_lines:
        if line.type in (BufferType.SHMEM, BufferType.GLOBMEM):
            other = by_key.setdefault(line.key, line)
            if other is not line and other.name != line.name:
                yield f"{line.place}: buffers {other.name} and {line.name} have one key, {line.key}"
        for port in {line.tcp, line.udp, line.stcp} - {None}:
            other = by_number.setdefault((port or 0, line.number), line)
            if other is not line and other.name != line.name:
                names = f"{other.name} and {line.name}"
                yield f"{line.place}: buffers {names} have one number, {line.number}, on port {port}"


def _connections(config: NmlConfig) -> Iterator[str]:
    for buffer in config.buffer_lines:
        by_number: dict[int, ProcessLine] = {}
        for user in users(config, buffer):
            if user.type is ProcessType.REMOTE:
                continue
            if user.c_num >= buffer.max_procs:
                yield (
                    f"{user.place}: c_num {user.c_num} of {user.process}; "
                    f"buffer {buffer.name} has max_procs {buffer.max_procs}"
                )
            other = by_number.setdefault(user.c_num, user)
            if other is not user:
                yield f"{user.place}: {other.process} and {user.process} both have c_num {user.c_num} in {buffer.name}"


def _masters(config: NmlConfig) -> Iterator[str]:
    for buffer in _declared(config):
        local = [user for user in users(config, buffer) if user.type is not ProcessType.REMOTE]
        masters = [user for user in local if user.master]
        if local and not masters:
            yield f"{buffer.place}: buffer {buffer.name} has no master; one process line needs master 1"
        if len(masters) > 1:
            names = ", ".join(user.process for user in masters)
            yield f"{masters[1].place}: buffer {buffer.name} has {len(masters)} masters: {names}"


def _traffic(config: NmlConfig) -> Iterator[str]:
    for buffer in _declared(config):
        ops = Counter(letter for user in users(config, buffer) for letter in user.ops)
        if not ops:
            yield f"{buffer.place}: no process uses buffer {buffer.name}"
            continue
        for letter, what in (("R", "read"), ("W", "write")):
            if not ops[letter] and not any(user.type is ProcessType.REMOTE for user in users(config, buffer)):
                yield f"{buffer.place}: no process may {what} buffer {buffer.name}"


def _links(config: NmlConfig) -> Iterator[str]:
    for buffer in _declared(config):
        reachable = buffer.tcp or buffer.udp or buffer.stcp or buffer.serial_port
        here = users(config, buffer)
        remote = [user for user in here if user.type is ProcessType.REMOTE]
        if remote and not reachable:
            yield (
                f"{remote[0].place}: {remote[0].process} is REMOTE, but buffer {buffer.name} has no "
                "TCP=, UDP=, STCP= or serialPortDevName="
            )
        local = [user for user in here if user.type is not ProcessType.REMOTE]
        if reachable and local and not any(user.server for user in local):
            yield f"{buffer.place}: buffer {buffer.name} has a port, but no process serves it (server 1)"


def _options(config: NmlConfig) -> Iterator[str]:
    for buffer in config.buffer_lines:
        if buffer.broadcast and not buffer.queue:
            yield f"{buffer.place}: buffer {buffer.name} is broadcast, but no queue"
        if buffer.name in _NATIVE:
            plain = buffer.type in (BufferType.SHMEM, BufferType.GLOBMEM) and not buffer.neutral
            if not plain or buffer.broadcast or buffer.queue == (buffer.name == "emcmotStatus"):
                yield (
                    f"{buffer.place}: buffer {buffer.name} is used by the servo thread; it must be SHMEM, neut 0, "
                    + ("no queue" if buffer.name == "emcmotStatus" else "queue, not broadcast")
                )


def _sizes(config: NmlConfig) -> Iterator[str]:
    for buffer in config.buffer_lines:
        room = buffer.size - (RECORD_HEAD if buffer.queue else 0)
        for cls in MESSAGES.get(buffer.name, ()):
            if room < cls.SIZE:
                yield (
                    f"{buffer.place}: {cls.__name__} has {cls.SIZE} bytes, "
                    f"messages of buffer {buffer.name} at most {room}; a larger size is needed"
                )


RULES: tuple[Rule, ...] = (_names, _keys, _connections, _masters, _traffic, _links, _options, _sizes)


def topology(config: NmlConfig) -> Iterator[str]:
    """The file as a picture in text: each buffer, who writes it and who reads it."""
    readers: dict[str, list[str]] = defaultdict(list)
    writers: dict[str, list[str]] = defaultdict(list)
    for buffer in config.buffer_lines:
        for user in users(config, buffer):
            label = user.process + {ProcessType.REMOTE: "@" + buffer.host}.get(user.type, "")
            label += "*" if user.master else ""
            if user.may_write:
                writers[buffer.name].append(label)
            if user.may_read:
                readers[buffer.name].append(label)
    for buffer in config.buffer_lines:
        kind = "broadcast queue" if buffer.queue and buffer.broadcast else "queue" if buffer.queue else "single slot"
        ports = (("TCP", buffer.tcp), ("UDP", buffer.udp), ("STCP", buffer.stcp))
        facts = [buffer.type.value, kind, f"{buffer.size} bytes", f"key {buffer.key}", f"number {buffer.number}"]
        facts += [f"{word}={port}" for word, port in ports if port]
        if buffer.neutral:
            facts.append(buffer.encoding.value)
        yield f"{buffer.name}: {', '.join(facts)}"
        yield f"    {' '.join(writers[buffer.name]) or '-'}  ->  {' '.join(readers[buffer.name]) or '-'}"
