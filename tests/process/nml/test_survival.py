"""Processes are killed at random instants while others read and write: nothing is torn, stuck, lost or doubled.

``NML_KILLS`` sets how many are killed in each test (default 150); thousands for a long run.
"""

import mmap
import os
import random
import signal
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from nml.channel import Channel
from nml.config import NmlConfig
from nml.emc import EMC_JOG_ABS, EMC_STAT
from nml.errors import ChannelTimeout, QueueFull
from nml.segment import segments

pytestmark = pytest.mark.process

KILLS = int(os.environ.get("NML_KILLS", "150"))
LONGEST_LIFE = 0.006  # s
FILE = """
B status  SHMEM localhost 20480 0 0 1 4 3001
B command SHMEM localhost 8192  0 0 2 4 3002 queue
B news    SHMEM localhost 8192  0 0 3 4 3003 queue broadcast
P a default LOCAL localhost RW 0 5.0 1 0
P b default LOCAL localhost RW 0 0.2 0 1
"""


@pytest.fixture
def config(tmp_path: Path) -> NmlConfig:
    path = tmp_path / "test.nml"
    path.write_text(FILE)
    return NmlConfig(path)


class Notes:
    """Numbers that a process leaves for others and that its death does not take away."""

    def __init__(self) -> None:
        self.numbers = memoryview(mmap.mmap(-1, 4096)).cast("q")

    def __setitem__(self, index: int, value: int) -> None:
        self.numbers[index] = value  # one store, which no kill can split

    def __getitem__(self, index: int) -> int:
        return self.numbers[index]


def start(work: Callable[[], None]) -> int:
    """A child process that works until it is killed."""
    pid = os.fork()
    if pid == 0:
        try:
            work()
        finally:
            os._exit(1)
    return pid


def kill(pid: int) -> None:
    os.kill(pid, signal.SIGKILL)
    _, status = os.waitpid(pid, 0)
    assert os.WIFSIGNALED(status), "the child ended by itself"


def lives() -> list[float]:
    """How long each victim lives, s."""
    return [random.Random(number).uniform(0.0, LONGEST_LIFE) for number in range(KILLS)]


def test_no_acknowledged_command_is_lost_or_doubled_when_writers_die(config: NmlConfig):
    reader = Channel(config, "command", "a")
    for incarnation, life in enumerate(lives()):
        acknowledged = Notes()

        def write(incarnation: int = incarnation, acknowledged: Notes = acknowledged) -> None:
            channel = Channel(config, "command", "a")
            number = 0
            while True:
                try:
                    channel.write(EMC_JOG_ABS(joint_or_axis=incarnation, pos=number + 1, vel=number + 1))
                except QueueFull:
                    continue
                number += 1
                acknowledged[0] = number

        received = []
        pid = start(write)
        end = time.monotonic() + life
        while time.monotonic() < end:
            received += drain(reader, incarnation)
        kill(pid)
        received += drain(reader, incarnation)
        assert received == list(range(1, len(received) + 1))
        assert len(received) - acknowledged[0] in (0, 1)


def drain(reader: Channel, incarnation: int) -> list[int]:
    received = []
    while (message := reader.read()) is not None:
        assert isinstance(message, EMC_JOG_ABS)
        assert message.joint_or_axis == incarnation
        assert message.pos == message.vel
        received.append(int(message.pos))
    return received


def test_a_reader_that_dies_takes_at_most_the_command_in_its_hands(config: NmlConfig):
    writer = Channel(config, "command", "a")
    sent, taken = 0, Notes()

    def read() -> None:
        channel = Channel(config, "command", "a")
        while True:
            message = channel.read()
            if message is not None:
                assert message.pos == taken[0] + 1, "a command was lost or doubled"
                taken[0] = int(message.pos)

    for life in lives():
        pid = start(read)
        end = time.monotonic() + life
        while time.monotonic() < end:
            if writer.space() > 200:
                sent += 1
                writer.write(EMC_JOG_ABS(pos=sent, vel=sent))
        kill(pid)
        message = writer.peek()
        gone = int(message.pos) - 1 if message is not None else sent
        assert gone - taken[0] in (0, 1)
        taken[0] = gone


def test_no_reader_ever_sees_a_torn_status_when_writers_die(config: NmlConfig):
    status_size = EMC_STAT.SIZE
    seen = Notes()

    def read() -> None:
        channel = Channel(config, "status", "b")
        image = bytearray(status_size)
        while True:
            if channel.poll_into(image):
                assert image.count(image[100]) >= status_size - 8, "torn"
                seen[0] += 1

    def write() -> None:
        channel = Channel(config, "status", "a")
        number = 0
        while True:
            number = (number + 1) % 256
            channel.raw.write(bytes([number]) * status_size)

    reader = start(read)
    for life in lives():
        pid = start(write)
        time.sleep(life)
        kill(pid)
    final = Channel(config, "status", "a")
    final.raw.write(bytes([7]) * status_size)
    before = seen[0]
    deadline = time.monotonic() + 60.0
    while seen[0] == before and time.monotonic() < deadline:
        final.raw.write(bytes([8]) * status_size)
        time.sleep(0.001)
    assert seen[0] > before, "the reader is stuck"
    kill(reader)


def test_a_broadcast_queue_stays_whole_when_writers_die(config: NmlConfig):
    reader = Channel(config, "news", "a")
    last = 0
    for life in lives():

        def write() -> None:
            channel = Channel(config, "news", "a")
            while True:
                number = channel.write_counter + 1
                channel.write(EMC_JOG_ABS(pos=number, vel=number))

        missed = reader.missed
        pid = start(write)
        end = time.monotonic() + life
        while time.monotonic() < end:
            while (message := reader.read()) is not None:
                assert message.pos == message.vel == last + 1 + reader.missed - missed
                last, missed = int(message.pos), reader.missed
        kill(pid)
        while (message := reader.read()) is not None:
            assert message.pos == message.vel == last + 1 + reader.missed - missed
            last, missed = int(message.pos), reader.missed


def test_a_lock_whose_holder_died_is_taken_over_at_once(config: NmlConfig):
    writer = Channel(config, "command", "b")
    held = Notes()

    def hold() -> None:
        channel = Channel(config, "command", "b")
        channel.raw.hold_lock()
        held[0] = 1
        signal.pause()

    for _ in range(5):
        held[0] = 0
        pid = start(hold)
        wait_for(held)
        with pytest.raises(ChannelTimeout):
            writer.write(EMC_JOG_ABS())
        kill(pid)
        assert writer.write(EMC_JOG_ABS(pos=1.0)) == writer.write_counter


def test_a_stopped_holder_delays_others_no_longer_than_their_timeout(config: NmlConfig):
    writer = Channel(config, "command", "b")
    held = Notes()

    def hold() -> None:
        channel = Channel(config, "command", "a")
        channel.raw.hold_lock()
        held[0] = 1
        signal.pause()

    pid = start(hold)
    wait_for(held)
    os.kill(pid, signal.SIGSTOP)
    with pytest.raises(ChannelTimeout, match=r"in use by another process for 0\.2 s"):
        writer.write(EMC_JOG_ABS())
    kill(pid)


def wait_for(notes: Notes) -> None:
    deadline = time.monotonic() + 60.0
    while not notes[0]:
        assert time.monotonic() < deadline, "the child did not start"
        time.sleep(0.001)


def test_makers_of_a_segment_may_die_at_any_time(config: NmlConfig):
    def make() -> None:
        while True:
            with Channel(config, "status", "a") as channel:
                channel.raw.write(b"x" * 64)

    for life in lives():
        pids = [start(make) for _ in range(2)]
        time.sleep(life)
        with Channel(config, "status", "a") as channel:
            number = channel.raw.write(b"y" * 64)
            assert channel.write_counter >= number
        for pid in pids:
            kill(pid)
    with Channel(config, "status", "a"):
        assert len(segments()) == 1
    assert segments() == []
