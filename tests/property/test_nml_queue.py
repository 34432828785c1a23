"""A queue under random writes, reads, peeks and clears, against a list: order, numbers, room and observers."""

from __future__ import annotations

import uuid
from pathlib import Path
from tempfile import TemporaryDirectory

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from nml.channel import Channel
from nml.config import NmlConfig
from nml.errors import QueueFull
from nml.segment import cleanup

RING = 1024
RECORD_HEAD = 32
LONGEST = RING - RECORD_HEAD


def record_size(length: int) -> int:
    return -(-(RECORD_HEAD + length) // RECORD_HEAD) * RECORD_HEAD


class Queue(RuleBasedStateMachine):
    """Every channel of one queue at once; ``waiting`` is what it must hold."""

    kind = ""

    def __init__(self) -> None:
        super().__init__()
        key = uuid.uuid4().int % 2**31
        with TemporaryDirectory() as folder:
            path = Path(folder) / "test.nml"
            path.write_text(
                f"B q SHMEM localhost {RING} 0 0 1 4 {key} queue {self.kind}\n"
                "P a q LOCAL localhost RW 0 1.0 1 0\n"
                "P b q LOCAL localhost R 0 1.0 0 1\n"
            )
            config = NmlConfig(path)
        self.writer, self.reader = (Channel(config, "q", process).raw for process in "ab")
        self.observer = Channel.connect(config.buffer("q"), config.observer("q")).raw
        self.written: list[bytes] = []
        self.waiting: list[bytes] = []
        self.observed = 0

    def teardown(self) -> None:
        for channel in (self.writer, self.reader, self.observer):
            channel.close()
        cleanup()

    def message(self, length: int) -> bytes:
        return bytes((len(self.written) + index) % 251 for index in range(length))

    @rule()
    def observe(self) -> None:
        missed = self.observer.missed
        data = self.observer.read()
        self.observed += self.observer.missed - missed
        if data is None:
            assert self.observed == len(self.written)
        else:
            assert bytes(data) == self.written[self.observed]
            self.observed += 1
            assert self.observer.last == self.observed


class PlainQueue(Queue):
    """Each message goes to one reader; a full queue refuses."""

    @rule(length=st.integers(0, LONGEST))
    def write(self, length: int) -> None:
        data = self.message(length)
        used = sum(record_size(len(one)) for one in self.waiting)
        if record_size(length) <= RING - used:
            assert self.writer.write(data) == len(self.written) + 1
            self.written.append(data)
            self.waiting.append(data)
        else:
            try:
                self.writer.write(data)
            except QueueFull:
                return
            raise AssertionError("a full queue took a message")

    @rule()
    def read(self) -> None:
        data = self.reader.read()
        assert (None if data is None else bytes(data)) == (self.waiting.pop(0) if self.waiting else None)

    @rule()
    def peek(self) -> None:
        data = self.reader.peek()
        assert (None if data is None else bytes(data)) == (self.waiting[0] if self.waiting else None)

    @precondition(lambda self: self.waiting)
    @rule()
    def clear(self) -> None:
        self.reader.clear()
        self.waiting.clear()

    @invariant()
    def counts_agree(self) -> None:
        assert self.writer.queue_length() == len(self.waiting)
        assert self.writer.write_counter == len(self.written)
        assert self.reader.has_news() == bool(self.waiting)
        assert self.writer.was_read() == (not self.waiting)


class BroadcastQueue(Queue):
    """Each reader gets each message that is still there; a write always succeeds."""

    kind = "broadcast"

    def __init__(self) -> None:
        super().__init__()
        self.taken = 0

    @rule(length=st.integers(0, LONGEST))
    def write(self, length: int) -> None:
        data = self.message(length)
        assert self.writer.write(data) == len(self.written) + 1
        self.written.append(data)

    @rule()
    def read(self) -> None:
        missed = self.reader.missed
        data = self.reader.read()
        self.taken += self.reader.missed - missed
        if data is None:
            assert self.taken == len(self.written)
        else:
            assert bytes(data) == self.written[self.taken]
            self.taken += 1

    @invariant()
    def what_fits_is_kept(self) -> None:
        kept, room = 0, RING
        for one in reversed(self.written):
            room -= record_size(len(one))
            if room < 0:
                break
            kept += 1
        assert self.reader.queue_length() == min(kept, len(self.written) - self.taken)


BRIEF = settings(max_examples=40, stateful_step_count=60, deadline=None)
TestPlainQueue = PlainQueue.TestCase
TestPlainQueue.settings = BRIEF
TestBroadcastQueue = BroadcastQueue.TestCase
TestBroadcastQueue.settings = BRIEF
