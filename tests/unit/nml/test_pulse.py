"""The sign of life of a process: it counts while the process works, and no longer."""

import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from nml.channel import Channel
from nml.config import NmlConfig
from nml.pulse import Pulse

FILE = """
B orders SHMEM localhost 1024 0 0 2 4 2002 queue serial
P a default LOCAL localhost RW 0 1.0 1 0
"""
PATIENCE = 60.0  # s; a watchdog, not a claim about speed
HALTED = """
import sys
from nml.channel import Channel
from nml.config import NmlConfig
from nml.pulse import Pulse
pulse = Pulse(Channel(NmlConfig(sys.argv[1]), "orders", "a"), 0.002, 3600.0)
print("beats", flush=True)
sys.stdin.read()
"""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "test.nml"
    path.write_text(FILE)
    return path


@pytest.fixture
def channel(path: Path) -> Iterator[Channel]:
    with Channel(NmlConfig(path), "orders", "a") as made:
        yield made


def counts(channel: Channel) -> None:
    """Return as soon as the pulse has gone on; fail when it does not."""
    before, deadline = channel.pulse, time.monotonic() + PATIENCE
    while channel.pulse == before:
        assert time.monotonic() < deadline, "no sign of life"
        time.sleep(0.001)


def is_silent(channel: Channel) -> bool:
    before = channel.pulse
    time.sleep(0.05)
    return channel.pulse == before


def test_the_pulse_goes_on_while_the_process_does_something_else(channel: Channel) -> None:
    pulse = Pulse(channel, 0.002, 3600.0)
    for _ in range(3):
        counts(channel)
    pulse.close()


def test_a_closed_pulse_is_silent_and_may_be_closed_again(channel: Channel) -> None:
    pulse = Pulse(channel, 0.002, 3600.0)
    counts(channel)
    pulse.close()
    assert is_silent(channel)
    pulse.turn()
    pulse.close()


def test_a_main_loop_that_hangs_silences_the_pulse_until_it_turns_again(channel: Channel) -> None:
    pulse = Pulse(channel, 0.002, 0.02)
    time.sleep(0.1)
    assert is_silent(channel)
    deadline = time.monotonic() + PATIENCE
    before = channel.pulse
    while channel.pulse == before:
        pulse.turn()
        assert time.monotonic() < deadline
    pulse.close()


def test_a_killed_process_gives_no_more_signs_of_life(channel: Channel, path: Path) -> None:
    with subprocess.Popen([sys.executable, "-c", HALTED, path], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == b"beats\n"
        counts(channel)
        other.kill()
        other.wait()
        assert is_silent(channel)
