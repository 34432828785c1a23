"""nmllog: records what goes through buffers, with the time of each message, and plays it back.

    nmllog record run.nmllog emcStatus emcError      until Ctrl-C, or --seconds
    nmllog show run.nmllog --json
    nmllog replay run.nmllog --speed 10

A log is a stream of msgpack objects: a heading, then ``[time in ns, buffer, number, message in C layout]``.
"""

from __future__ import annotations

import argparse
import json
import queue
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

import msgpack

from nml import clock
from nml.channel import Channel
from nml.codecs import raw
from nml.config import NmlConfig
from nml.errors import ConfigError, DecodeError, Place, PyemcError
from nml.message import Message
from nml.tools.paths import common_arguments, configuration, flat, observe

FORMAT = "nmllog 1"


class Entry(NamedTuple):
    """One message of a log; ``time_ns`` counts from an arbitrary start."""

    time_ns: int
    buffer: str
    number: int
    message: Message


def main(argv: list[str] | None = None) -> int:
    """Record, show or replay."""
    arguments = _arguments(argv)
    try:
        arguments.action(arguments)
    except PyemcError as error:
        print(error, file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 0
    return 0


def record(config: NmlConfig, file: BinaryIO, buffers: list[str], seconds: float | None) -> dict[str, int]:
    """Write every message of ``buffers`` to ``file``; how many each had, and how many came too fast to be recorded."""
    channels = [observe(config, buffer, "nmllog") for buffer in buffers]
    found: queue.SimpleQueue[list[Any]] = queue.SimpleQueue()
    stop = threading.Event()
    threads = [threading.Thread(target=_listen, args=(channel, found, stop), daemon=True) for channel in channels]
    file.write(msgpack.packb({"format": FORMAT, "buffers": buffers}))
    for thread in threads:
        thread.start()
    counts = dict.fromkeys(buffers, 0)
    end = None if seconds is None else clock.host_now() + seconds
    try:
        while any(thread.is_alive() for thread in threads):
            try:
                entry = found.get(timeout=0.05)
            except queue.Empty:
                if end is not None and clock.host_now() >= end:
                    stop.set()
                continue
            counts[entry[1]] += 1
            file.write(msgpack.packb(entry))
            if end is not None and clock.host_now() >= end:
                stop.set()
    finally:
        stop.set()
        for thread in threads:
            thread.join()
        while not found.empty():
            file.write(msgpack.packb(found.get()))
        for channel in channels:
            counts[f"{channel.name} missed"] = channel.missed
            channel.close()
    return counts


def entries(path: Path) -> Iterator[Entry]:
    """The messages of a log, in order; ConfigError if the file is none."""
    try:
        with path.open("rb") as file:
            stream = msgpack.Unpacker(file)
            heading = next(iter(stream), None)
            if not isinstance(heading, dict) or heading.get("format") != FORMAT:
                raise ConfigError(f"no log of this program ({FORMAT} is expected)", Place(str(path)))
            for time_ns, buffer, number, data in stream:
                yield Entry(time_ns, buffer, number, raw.decode(data))
    except OSError as error:
        raise ConfigError(f"cannot read the log: {error.strerror}", Place(str(path))) from None
    except (ValueError, TypeError) as error:
        if isinstance(error, PyemcError) and not isinstance(error, DecodeError):
            raise
        raise ConfigError(f"damaged log: {error}", Place(str(path))) from None


def replay(config: NmlConfig, path: Path, process: str, speed: float, only: list[str]) -> int:
    """Write the messages of a log to their buffers, as far apart as they were; how many."""
    channels: dict[str, Channel] = {}
    start_host, start_ns, count = clock.host_now(), None, 0
    for entry in entries(path):
        if only and entry.buffer not in only:
            continue
        start_ns = entry.time_ns if start_ns is None else start_ns
        clock.host_sleep(start_host + (entry.time_ns - start_ns) * 1e-9 / speed - clock.host_now())
        if entry.buffer not in channels:
            channels[entry.buffer] = Channel(config, entry.buffer, process)
        channels[entry.buffer].write(entry.message)
        count += 1
    for channel in channels.values():
        channel.close()
    return count


def _listen(channel: Channel, found: queue.SimpleQueue[list[Any]], stop: threading.Event) -> None:
    while not stop.is_set():
        message = channel.read()
        if message is None:
            channel.wait(0.05)
        else:
            written = channel.raw.last_time_ns or int(clock.host_now() * 1e9)
            found.put([written, channel.name, channel.raw.last, raw.encode(message)])


def _record(arguments: argparse.Namespace) -> None:
    with arguments.file.open("wb") as file:
        counts = record(configuration(arguments), file, arguments.buffers, arguments.seconds)
    print("  ".join(f"{name}={count}" for name, count in counts.items()), file=sys.stderr)


def _show(arguments: argparse.Namespace) -> None:
    first: int | None = None
    for entry in entries(arguments.file):
        first = entry.time_ns if first is None else first
        row = {
            "t": round((entry.time_ns - first) * 1e-9, 6),
            "buffer": entry.buffer,
            "number": entry.number,
            "type": type(entry.message).__name__,
        }
        row |= {path: value for path, value in flat(entry.message) if value}
        print(json.dumps(row) if arguments.json else "  ".join(f"{name}={value}" for name, value in row.items()))


def _replay(arguments: argparse.Namespace) -> None:
    config = configuration(arguments)
    count = replay(config, arguments.file, arguments.process, arguments.speed, arguments.buffer)
    print(f"{count} messages", file=sys.stderr)


def _arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="nmllog", description="Record the messages of buffers, and play them back.")
    common_arguments(parser)
    actions = parser.add_subparsers(required=True)
    recording = actions.add_parser("record", help="write every message to a file")
    recording.add_argument("file", type=Path)
    recording.add_argument("buffers", nargs="+", metavar="BUFFER")
    recording.add_argument("--seconds", type=float, help="end after this time")
    recording.set_defaults(action=_record)
    showing = actions.add_parser("show", help="print a log")
    showing.add_argument("file", type=Path)
    showing.add_argument("--json", action="store_true", help="one JSON object a line")
    showing.set_defaults(action=_show)
    playing = actions.add_parser("replay", help="write the messages of a log to their buffers again")
    playing.add_argument("file", type=Path)
    playing.add_argument("--process", default="emc", help="whose line of the NML file to use")
    playing.add_argument("--speed", type=float, default=1.0)
    playing.add_argument("--buffer", action="append", default=[], help="only this buffer")
    playing.set_defaults(action=_replay)
    return parser.parse_args(argv)


if __name__ == "__main__":
    sys.exit(main())
