"""nmlstat: looks into the buffers of a running controller without taking a message from anybody.

    nmlstat                                   every buffer: messages, rate, newest type, age
    nmlstat emcStatus                         every field of the newest message
    nmlstat emcStatus --watch task.mode       a line whenever the field changes
    nmlstat emcError --follow                 every message as it comes
    nmlstat emcCommand --diag                 what each process did with a buffer declared diag
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator
from typing import Any

from nml import clock
from nml.channel import Channel
from nml.config import BufferLine, BufferType, NmlConfig
from nml.errors import PyemcError
from nml.message import Message
from nml.segment import segments
from nml.tools.paths import common_arguments, configuration, flat, get, observe

Row = dict[str, Any]


def main(argv: list[str] | None = None) -> int:
    """Show what the arguments ask for."""
    arguments = _arguments(argv)
    try:
        config = configuration(arguments)
        for row in rows(config, arguments):
            print(json.dumps(row) if arguments.json else _text(row), flush=True)
    except PyemcError as error:
        print(error, file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 0
    return 0


def rows(config: NmlConfig, arguments: argparse.Namespace) -> Iterator[Row]:
    """What to print, a line each."""
    if not arguments.buffer:
        yield from overview(config, arguments.interval)
        return
    with observe(config, arguments.buffer, "nmlstat") as channel:
        if arguments.diag:
            yield from channel.diagnostics()
        elif arguments.watch:
            yield from watch(channel, arguments.watch, arguments.count)
        elif arguments.follow:
            yield from follow(channel, arguments.count)
        else:
            message = channel.read()
            if message is None:
                raise PyemcError(f"buffer {channel.name}: no message")
            yield heading(channel, message) | dict(flat(message))


def overview(config: NmlConfig, interval: float) -> Iterator[Row]:
    """One row for each buffer; the rate is measured over ``interval`` s."""
    present = {name.rpartition(".")[2] for name in segments()}
    lines = [line for line in config.buffer_lines if line.type is not BufferType.LOCMEM]
    channels = {line.name: observe(config, line.name, "nmlstat") for line in lines if str(line.key) in present}
    before = {name: channel.write_counter for name, channel in channels.items()}
    clock.host_sleep(interval)
    for line in lines:
        channel = channels.get(line.name)
        if channel is None:
            yield {"buffer": line.name, "kind": _kind(line), "state": "not in use"}
            continue
        written = channel.write_counter
        row = {"buffer": line.name, "kind": _kind(line), "messages": written}
        row["per_s"] = round((written - before[line.name]) / interval, 1)
        row["waiting"] = channel.queue_length()
        newest = _newest(channel)
        if newest is not None:
            row |= {"type": type(newest).__name__, "age_s": _age(channel)}
        yield row
        channel.close()


def watch(channel: Channel, paths: list[str], count: int) -> Iterator[Row]:
    """A row whenever one of the fields changes; messages without these fields are passed over."""
    shown: list[Any] | None = None
    for message in _messages(channel, count):
        try:
            values = [_plain(get(message, path)) for path in paths]
        except PyemcError:
            if channel.queue_length() == 0 and not channel.line.queue:
                raise
            continue
        if values != shown:
            shown = values
            yield {"number": channel.raw.last} | dict(zip(paths, values, strict=True))


def follow(channel: Channel, count: int) -> Iterator[Row]:
    """A row for each message."""
    for message in _messages(channel, count):
        set_fields = {path: value for path, value in flat(message) if value}
        yield heading(channel, message) | set_fields


def heading(channel: Channel, message: Message) -> Row:
    """What a message is, and how old."""
    kind = type(message)
    return {"buffer": channel.name, "type": kind.__name__, "number": channel.raw.last, "age_s": _age(channel)}


def _messages(channel: Channel, count: int) -> Iterator[Message]:
    """Messages as they come: ``count`` of them, or for ever if 0."""
    given = 0
    while not count or given < count:
        message = channel.read()
        if message is None:
            channel.wait(1.0)
            continue
        given += 1
        yield message


def _newest(channel: Channel) -> Message | None:
    """The newest message that can still be seen."""
    newest = None
    while (message := channel.read()) is not None:
        newest = message
        if not channel.line.queue:
            break
    return newest


def _age(channel: Channel) -> float | None:
    """s since the message was written; None where it came over a network, which does not say."""
    written = channel.raw.last_time_ns
    return round(clock.host_now() - written * 1e-9, 6) if written else None


def _kind(line: BufferLine) -> str:
    return "broadcast" if line.queue and line.broadcast else "queue" if line.queue else "slot"


def _plain(value: Any) -> Any:
    return value.to_dict() if hasattr(value, "to_dict") else value.tolist() if hasattr(value, "tolist") else value


def _text(row: Row) -> str:
    """A row for people: a heading and fields below each other, or all in one line when they are few."""
    words = [f"{name}={value}" for name, value in row.items()]
    return "  ".join(words) if len(words) <= 16 else "\n".join(words)


def _arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="nmlstat", description="Look into the buffers of a running controller.")
    common_arguments(parser)
    parser.add_argument("buffer", nargs="?", help="one buffer; without it an overview of all")
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    parser.add_argument("--watch", metavar="FIELD", action="append", help="print a line whenever this field changes")
    parser.add_argument("--follow", action="store_true", help="print every message")
    parser.add_argument("--diag", action="store_true", help="print the counts of each process")
    parser.add_argument("-n", "--count", type=int, default=0, help="end after so many messages")
    parser.add_argument("-i", "--interval", type=float, default=0.5, help="time over which rates are measured, s")
    return parser.parse_args(argv)


if __name__ == "__main__":
    sys.exit(main())
