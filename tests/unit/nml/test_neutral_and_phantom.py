"""Buffers that hold encoded messages, buffers without memory, and options that have no effect on Linux."""

from pathlib import Path

import pytest

from nml.channel import Channel
from nml.config import NmlConfig
from nml.emc import EMC_NULL, EMC_OPERATOR_TEXT, EMC_STAT
from nml.errors import BufferError_, DecodeError, EncodeError
from nml.segment import segments

ENCODINGS = ["xdr", "ascii", "disp", "msgpack"]
FILE = "".join(
    f"B {name} SHMEM localhost 65536 1 0 {number} 4 {4000 + number} {name} serial\n"
    for number, name in enumerate(ENCODINGS)
)
FILE += """
B queue SHMEM localhost 4096 1 0 8 4 4008 queue enc_max_size=300
B ghost PHANTOM localhost 128 0 0 9 4 4009
B old GLOBMEM localhost 1024 0 0 10 4 4010 mutex=no_switching
B free SHMEM localhost 1024 0 0 11 4 4011 mutex=none
P a default LOCAL localhost RW 0 1.0 1 0
"""


@pytest.fixture
def config(tmp_path: Path) -> NmlConfig:
    path = tmp_path / "test.nml"
    path.write_text(FILE)
    return NmlConfig(path)


@pytest.mark.parametrize("name", ENCODINGS)
def test_a_neutral_buffer_holds_the_encoded_message(config: NmlConfig, name: str):
    writer, reader = Channel(config, name, "a"), Channel(config, name, "a")
    writer.write(EMC_NULL())
    writer.write(EMC_OPERATOR_TEXT(text="a, b", id=7))
    message = reader.read()
    assert message == EMC_OPERATOR_TEXT(text="a, b", id=7, serial_number=2)
    assert reader.read() is None


@pytest.mark.parametrize("name", ENCODINGS)
def test_a_status_in_a_neutral_buffer_is_polled_like_any_other(config: NmlConfig, name: str):
    writer, reader = Channel(config, name, "a"), Channel(config, name, "a")
    status, mirror = EMC_STAT(), EMC_STAT()
    status.motion.joint[3].homed = 1
    writer.write(status)
    assert reader.poll_into(mirror.data) is True
    assert mirror == status
    assert reader.poll_into(mirror.data) is False
    writer.write(status)
    with pytest.raises(BufferError_, match="has 10784 bytes, the reader 24"):
        reader.poll_into(bytearray(24))


def test_what_is_encoded_wrongly_is_an_error_and_the_buffer_goes_on(config: NmlConfig):
    channel = Channel(config, "queue", "a")
    channel.raw.write(b"\1\2\3")
    channel.write(EMC_NULL())
    with pytest.raises(DecodeError, match="buffer queue: 3 bytes are no message"):
        channel.read()
    assert isinstance(channel.read(), EMC_NULL)


def test_the_encoded_length_is_limited_where_the_file_says_so(config: NmlConfig):
    channel = Channel(config, "queue", "a")
    channel.write(EMC_OPERATOR_TEXT())
    with pytest.raises(EncodeError, match="EMC_STAT has 3876 bytes encoded, enc_max_size is 300"):
        channel.write(EMC_STAT())


def test_a_phantom_counts_and_forgets(config: NmlConfig):
    channel = Channel(config, "ghost", "a")
    assert [channel.write(EMC_NULL()), channel.write(EMC_NULL())] == [1, 2]
    assert channel.read() is None
    assert channel.peek() is None
    assert channel.blocking_read(10.0) is None
    assert channel.check_if_read()
    assert (channel.queue_length(), channel.space(), channel.age()) == (0, 128, None)
    assert channel.poll_into(bytearray(1)) is False
    assert segments() == []
    channel.close()
    with pytest.raises(BufferError_, match="the channel is closed"):
        channel.write(EMC_NULL())


def test_obsolete_options_are_served_and_remarked(config: NmlConfig, tmp_path: Path):
    channel = Channel(config, "old", "a")
    channel.write(EMC_NULL())
    assert isinstance(channel.read(), EMC_NULL)
    place = f"{tmp_path / 'test.nml'}:8: buffer old:"
    assert config.remarks == [
        f"{place} GLOBMEM is obsolete and served as SHMEM",
        f"{place} mutex=no_switching does not exist on Linux; os_sem is used",
    ]


def test_a_buffer_without_a_mutex_is_written_while_another_holds_the_lock(config: NmlConfig):
    channel = Channel(config, "free", "a")
    channel.raw.hold_lock()
    assert channel.write(EMC_NULL()) == 1
