"""Command and status channels, Timer, Semaphore, and waiting in asyncio programs."""

import asyncio
from pathlib import Path

import pytest

from nml import aio, clock
from nml.channel import Channel
from nml.config import NmlConfig
from nml.emc import EMC_NULL, EMC_OPERATOR_TEXT, EMC_STAT
from nml.errors import EncodeError, NmlError
from nml.rcs import RCS_CMD_CHANNEL, RCS_STAT_CHANNEL, Semaphore, Timer

FILE = """
B command SHMEM localhost 20480 0 0 1 4 5001 queue serial
B status SHMEM localhost 20480 0 0 2 4 5002
P a default LOCAL localhost RW 0 1.0 1 0
"""


@pytest.fixture
def config(tmp_path: Path) -> NmlConfig:
    path = tmp_path / "test.nml"
    path.write_text(FILE)
    return NmlConfig(path)


def test_a_command_channel_carries_commands_and_a_status_channel_status(config: NmlConfig):
    commands, status = RCS_CMD_CHANNEL(config, "command", "a"), RCS_STAT_CHANNEL(config, "status", "a")
    assert commands.write(EMC_NULL()) == 1
    assert status.write(EMC_STAT()) == 1
    with pytest.raises(EncodeError, match="buffer command: EMC_STAT is no command"):
        commands.write(EMC_STAT())
    with pytest.raises(EncodeError, match="buffer status: EMC_NULL is no status"):
        status.write(EMC_NULL())


def test_a_timer_keeps_its_period_whatever_the_work_takes(monkeypatch: pytest.MonkeyPatch):
    now = [100.0]
    monkeypatch.setattr(clock, "now", lambda: now[0])

    def sleep(seconds: float) -> None:
        now[0] += max(0.0, seconds)

    monkeypatch.setattr(clock, "sleep", sleep)
    timer = Timer(5.0)
    assert timer.wait() == 0
    assert now[0] == 105.0
    now[0] += 2.0
    assert timer.wait() == 0
    assert now[0] == 110.0
    now[0] += 12.0
    assert timer.wait() == 1
    assert now[0] == 122.0
    timer.sync()
    timer.wait()
    assert now[0] == 127.0


def test_a_timer_needs_an_interval():
    with pytest.raises(ValueError, match=r"an interval of 0\.0 s"):
        Timer(0.0)


def test_a_semaphore_excludes_within_its_timeout():
    first, second = Semaphore(7), Semaphore(7, timeout=0.0)
    with first:
        assert second.trywait() is False
        assert second.wait() is False
        with pytest.raises(NmlError, match=r"semaphore 7: not free within 0\.0 s"), second:
            pass
    with second:
        assert first.trywait() is False
    first.close()
    second.destroy()
    second.destroy()


def test_an_asyncio_program_waits_without_stopping_its_loop(config: NmlConfig):
    async def scenario() -> list[str]:
        writer, reader = Channel(config, "command", "a"), Channel(config, "command", "a")
        assert await aio.wait(reader, 0.01) is False
        assert await aio.read(reader, 0.0) is None
        received = []

        async def listen() -> None:
            async for message in aio.messages(reader):
                assert isinstance(message, EMC_OPERATOR_TEXT)
                received.append(message.text)

        listener = asyncio.create_task(listen())
        for text in ("one", "two"):
            await asyncio.sleep(0)
            writer.write(EMC_OPERATOR_TEXT(text=text))
        while len(received) < 2:
            await asyncio.sleep(0.001)
        listener.cancel()
        with pytest.raises(asyncio.CancelledError):
            await listener
        return received

    assert asyncio.run(scenario()) == ["one", "two"]
