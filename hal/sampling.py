"""``halsampler`` and ``halstreamer``: samples from a realtime queue to text, and text to samples.

One line for each sample, columns with a space behind each. The realtime ends are in ``hal.components.fifo``.
"""

from __future__ import annotations

import contextlib
import getopt
import signal
import sys
from typing import NoReturn, TextIO

from hal._shm import BIT, FLOAT
from hal.stream import TYPE_LETTERS, Stream
from hal.values import parse_value
from nml import clock
from nml.errors import HalError

POLL_SECONDS = 0.005


def _terminated(number: int, frame: object) -> NoReturn:
    raise KeyboardInterrupt


def _options(program: str, letters: str, argv: list[str] | None) -> tuple[dict[str, str], list[str]]:
    try:
        pairs, rest = getopt.getopt(sys.argv[1:] if argv is None else argv, letters)
    except getopt.GetoptError as error:
        raise HalError(str(error)) from None
    signal.signal(signal.SIGTERM, _terminated)
    return dict(pairs), rest


def _number(text: str, what: str) -> int:
    try:
        return int(text, 0)
    except ValueError:
        raise HalError(f"{what} '{text}' is no whole number") from None


# ---- halsampler ----


def format_sample(types: list[int], values: tuple[float | int | bool, ...]) -> str:
    """The columns as text."""
    return "".join(
        f"{value:f} " if type_ == FLOAT else f"{int(value)} " for type_, value in zip(types, values, strict=True)
    )


def copy_samples(stream: Stream, out: TextIO, count: int, tag: bool) -> None:
    """Write ``count`` samples (0: without end) as they come, and 'overrun' where some were lost."""
    types = [TYPE_LETTERS[letter] for letter in stream.element_types]
    expected = None
    done = 0
    while count == 0 or done < count:
        values = stream.read()
        if values is None:
            out.flush()
            if not stream.alive:
                raise HalError("the sampler was unloaded")
            clock.host_sleep(POLL_SECONDS)
            continue
        number = stream.sampleno
        if expected is not None and number != expected:
            out.write("overrun\n")
        expected = number + 1
        out.write((f"{number - 1} " if tag else "") + format_sample(types, values) + "\n")
        done += 1
    out.flush()


def sampler_main(argv: list[str] | None = None) -> int:
    """halsampler [-c CHANNEL] [-n COUNT] [-t] [FILE]"""
    try:
        options, rest = _options("halsampler", "c:n:t", argv)
        stream = Stream(f"sampler.{_number(options.get('-c', '0'), 'channel')}")
        count = _number(options.get("-n", "0"), "count")
        with contextlib.ExitStack() as stack:
            out = stack.enter_context(open(rest[0], "w", encoding="utf-8")) if rest else sys.stdout
            copy_samples(stream, out, count, "-t" in options)
    except (HalError, OSError) as error:
        print(f"halsampler: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 1
    return 0


# ---- halstreamer ----


def parse_sample(types: list[int], line: str) -> list[float | int | bool]:
    """The columns of a line; HalError says which is wrong."""
    words = line.split()
    if len(words) != len(types):
        raise HalError(f"{len(words)} columns; {len(types)} would be right")
    for type_, word in zip(types, words, strict=True):
        if type_ == BIT and word not in ("0", "1"):
            raise HalError(f"'{word}' is no bit; 0 or 1 would be right")
    return [parse_value(type_, word) for type_, word in zip(types, words, strict=True)]


def feed(stream: Stream, lines: TextIO, name: str) -> None:
    """Put each line's sample into the queue, waiting for room; a bad line is named and skipped."""
    types = [TYPE_LETTERS[letter] for letter in stream.element_types]
    for number, line in enumerate(lines, 1):
        if line.startswith("#") or not line.strip():
            continue
        try:
            values = parse_sample(types, line)
        except HalError as error:
            print(f"{name}:{number}: {error}; line skipped", file=sys.stderr)
            continue
        while not stream.writable:
            if not stream.alive:
                raise HalError("the streamer was unloaded")
            clock.host_sleep(POLL_SECONDS)
        stream.write(values)


def streamer_main(argv: list[str] | None = None) -> int:
    """halstreamer [-c CHANNEL] [FILE]"""
    try:
        options, rest = _options("halstreamer", "c:", argv)
        stream = Stream(f"streamer.{_number(options.get('-c', '0'), 'channel')}")
        with contextlib.ExitStack() as stack:
            lines = stack.enter_context(open(rest[0], encoding="utf-8")) if rest else sys.stdin
            feed(stream, lines, rest[0] if rest else "<stdin>")
    except (HalError, OSError) as error:
        print(f"halstreamer: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 1
    return 0
