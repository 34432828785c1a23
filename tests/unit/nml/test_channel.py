"""Channels: what reading and writing mean for each kind of buffer, and what a process may do."""

import os
import stat
import threading
from pathlib import Path

import pytest

from nml.channel import Channel
from nml.config import NmlConfig
from nml.emc import EMC_NULL, EMC_OPERATOR_TEXT, EMC_SET_DEBUG, EMC_STAT
from nml.errors import BufferError_, ChannelTimeout, ConfigError, DecodeError, EncodeError, QueueFull
from nml.message import Message
from nml.segment import cleanup, segments

FILE = """
B slot  SHMEM localhost 20480 0 0 1 4 2001 diag
B queue SHMEM localhost 1024 0 0 2 4 2002 queue serial
B news  SHMEM localhost 1024 0 0 3 4 2003 queue broadcast
B own   LOCMEM localhost 1024 0 0 4 4 2004 queue
B file  FILEMEM localhost 1024 0 0 5 4 2005
B quiet SHMEM localhost 1024 0 0 6 4 2006 bsem=-1
B other SHMEM localhost 4096 0 0 7 4 2001
P a default LOCAL localhost RW 0 1.0 1 0
P b default LOCAL localhost R 0 0 0 1
P c default LOCAL localhost RW 0 0 0 2 shared
P d default LOCAL localhost W 0 0 0 4
P e default LOCAL localhost W 0 0 0 3
"""


@pytest.fixture
def config(tmp_path: Path) -> NmlConfig:
    path = tmp_path / "test.nml"
    path.write_text(FILE)
    return NmlConfig(path)


def text(number: int) -> EMC_OPERATOR_TEXT:
    return EMC_OPERATOR_TEXT(text=str(number))


def texts(channel: Channel) -> list[str]:
    found = []
    while message := channel.read():
        found.append(message.text)
    return found


def test_a_single_slot_shows_the_newest_message_once_to_each_reader(config: NmlConfig):
    writer, one, two = (Channel(config, "slot", process) for process in ("a", "b", "b"))
    assert one.read() is None
    writer.write(EMC_SET_DEBUG(debug=1))
    writer.write(EMC_SET_DEBUG(debug=2))
    assert one.peek() == EMC_SET_DEBUG(debug=2)
    assert one.read() is None
    assert two.read() == EMC_SET_DEBUG(debug=2)
    assert (writer.write_counter, writer.queue_length()) == (2, 0)


def test_peek_does_not_count_as_reading(config: NmlConfig):
    writer, reader = Channel(config, "slot", "a"), Channel(config, "slot", "b")
    assert writer.write_if_read(EMC_NULL()) == 1
    reader.peek()
    assert not writer.check_if_read()
    assert writer.write_if_read(EMC_NULL()) == 0
    second = Channel(config, "slot", "b")
    second.read()
    assert writer.check_if_read()
    assert writer.write_if_read(EMC_NULL()) == 2


def test_a_status_is_polled_into_a_buffer_of_the_readers(config: NmlConfig):
    writer, reader = Channel(config, "slot", "a"), Channel(config, "slot", "b")
    status = EMC_STAT()
    mirror = status.copy()
    assert reader.poll_into(mirror.data) is False
    status.motion.joint[1].homed = 1
    writer.write(status)
    assert reader.poll_into(mirror.data) is True
    assert mirror.motion.joint[1].homed == 1
    assert reader.poll_into(mirror.data) is False
    writer.write(status)
    with pytest.raises(BufferError_, match="the message has 10784 bytes, the reader 10"):
        reader.poll_into(bytearray(10))


def test_a_queue_gives_each_message_to_one_reader_in_order(config: NmlConfig):
    writer, one, two = (Channel(config, "queue", process) for process in ("a", "b", "b"))
    numbers = [writer.write(text(n)) for n in range(3)]
    assert numbers == [1, 2, 3]
    assert one.queue_length() == 3
    assert one.peek().text == "0"
    assert one.read().text == "0"
    assert two.read().text == "1"
    assert texts(one) == ["2"]
    assert writer.check_if_read()


def test_a_serial_buffer_numbers_its_commands(config: NmlConfig):
    writer, reader = Channel(config, "queue", "a"), Channel(config, "queue", "b")
    command = EMC_NULL()
    assert writer.write(command) == command.serial_number == 1
    assert writer.write(command) == 2
    assert [reader.read().serial_number, reader.read().serial_number] == [1, 2]


def test_a_full_queue_refuses_and_goes_on_when_somebody_reads(config: NmlConfig):
    writer, reader = Channel(config, "queue", "a"), Channel(config, "queue", "b")
    for written in range(3):
        writer.write(text(written))
    with pytest.raises(QueueFull, match="buffer queue: the queue has no room for 280 bytes"):
        writer.write(text(3))
    assert writer.space() < 280
    for round_ in range(50):
        assert reader.read().text == str(round_)
        writer.write(text(round_ + 3))
    assert texts(reader) == ["50", "51", "52"]


def test_a_broadcast_queue_gives_every_message_to_every_reader(config: NmlConfig):
    writer = Channel(config, "news", "a")
    writer.write(text(0))
    one, two = Channel(config, "news", "b"), Channel(config, "news", "b")
    assert texts(one) == ["0"]
    assert texts(two) == ["0"]
    late = Channel(config, "news", "b")
    twin = late.reader()
    writer.write(text(1))
    assert [texts(channel) for channel in (one, two, late, twin)] == [["1"]] * 4


def test_a_slow_reader_of_a_broadcast_queue_learns_what_it_missed(config: NmlConfig):
    writer, reader = Channel(config, "news", "a"), Channel(config, "news", "b")
    for number in range(10):
        writer.write(text(number))
    assert texts(reader) == ["7", "8", "9"]
    assert reader.missed == 7


def test_readers_that_share_a_cursor_behave_as_on_a_plain_queue(config: NmlConfig):
    writer, own, one, two = (Channel(config, "news", process) for process in ("a", "b", "c", "c"))
    for number in range(3):
        writer.write(text(number))
    assert one.read().text == "0"
    assert two.read().text == "1"
    assert not one.has_news() or one.read().text == "2"
    assert texts(two) == []
    assert texts(own) == ["0", "1", "2"]


@pytest.mark.parametrize("name", ["slot", "queue", "news"])
def test_an_observer_sees_every_message_and_takes_none(config: NmlConfig, name: str):
    writer, reader = Channel(config, name, "a"), Channel(config, name, "b")
    observer = Channel.connect(config.buffer(name), config.observer(name))
    for number in range(3):
        writer.write(text(number))
        assert observer.wait(0.0)
        assert observer.read().text == str(number)
        assert observer.raw.last == number + 1
        assert not writer.check_if_read()
        assert reader.read().text == str(number)
    assert observer.read() is None
    with pytest.raises(BufferError_, match="observer may not write"):
        observer.write(text(4))


def test_an_observer_still_sees_what_others_have_taken_until_it_is_overwritten(config: NmlConfig):
    writer, reader = Channel(config, "queue", "a"), Channel(config, "queue", "b")
    observer = Channel.connect(config.buffer("queue"), config.observer("queue"))
    for number in range(3):
        writer.write(text(number))
        reader.read()
    assert texts(observer) == ["0", "1", "2"]
    for number in range(3, 9):
        writer.write(text(number))
        if number < 7:
            reader.read()
    assert texts(observer) == ["7", "8"]
    assert observer.missed == 4


def test_clear_forgets_messages_but_not_numbers(config: NmlConfig):
    for name in ("slot", "queue"):
        writer, reader = Channel(config, name, "a"), Channel(config, name, "b")
        writer.write(EMC_NULL())
        writer.clear()
        assert reader.read() is None
        assert writer.write(EMC_NULL()) == 2
        assert isinstance(reader.read(), EMC_NULL)


def test_wait_wakes_on_a_write_and_ends_on_its_timeout(config: NmlConfig):
    writer, reader = Channel(config, "slot", "a"), Channel(config, "slot", "b")
    assert reader.wait(0.01) is False
    timer = threading.Timer(0.05, lambda: writer.write(EMC_NULL()))
    timer.start()
    assert reader.wait(30.0) is True
    assert isinstance(reader.blocking_read(0.0), EMC_NULL)
    timer.join()


def test_closing_ends_a_wait_in_another_thread(config: NmlConfig):
    reader = Channel(config, "slot", "b")
    results: list[bool] = []
    thread = threading.Thread(target=lambda: results.append(reader.wait(-1.0)))
    thread.start()
    while not reader.raw.sleepers:
        pass
    reader.close()
    thread.join(timeout=60.0)
    assert results == [False]


def test_a_buffer_without_a_blocking_semaphore_refuses_to_block(config: NmlConfig):
    with pytest.raises(BufferError_, match="bsem=-1 in the NML file forbids blocking reads"):
        Channel(config, "quiet", "b").blocking_read(0.1)


def test_a_process_may_only_do_what_its_line_allows(config: NmlConfig):
    with pytest.raises(BufferError_, match="b may not write slot, its ops are R"):
        Channel(config, "slot", "b").write(EMC_NULL())
    writer = Channel(config, "slot", "e")
    for call in (writer.read, writer.peek):
        with pytest.raises(BufferError_, match="e may not read slot, its ops are W"):
            call()
    assert not hasattr(writer, "poll_into")
    with pytest.raises(ConfigError, match="c_num 4 of d; buffer slot has max_procs 4"):
        Channel(config, "slot", "d")


def test_a_message_that_is_too_long_leaves_the_buffer_usable(config: NmlConfig):
    writer, reader = Channel(config, "queue", "a"), Channel(config, "queue", "b")
    with pytest.raises(EncodeError, match="buffer queue: EMC_STAT has 10784 bytes, the longest message has 992"):
        writer.write(EMC_STAT())
    writer.write(EMC_NULL())
    assert isinstance(reader.read(), EMC_NULL)


@pytest.mark.parametrize("image", [b"", b"abc", bytes(100), EMC_OPERATOR_TEXT().data[:30]])
def test_what_is_no_message_is_an_error_that_names_the_buffer(config: NmlConfig, image: bytes):
    writer, reader = Channel(config, "queue", "a"), Channel(config, "queue", "b")
    writer.raw.write(image)
    writer.write(EMC_NULL())
    with pytest.raises(DecodeError, match="buffer queue: "):
        reader.read()
    assert isinstance(reader.read(), EMC_NULL)


def test_a_lock_held_by_another_is_waited_for_no_longer_than_the_timeout(config: NmlConfig):
    holder = Channel(config, "queue", "a")
    holder.raw.hold_lock()
    for process in ("a", "c"):
        with pytest.raises(ChannelTimeout, match="buffer queue: in use by another process"):
            Channel(config, "queue", process).write(EMC_NULL())


def test_a_status_is_cleared_by_its_writers_a_queue_also_by_its_readers(config: NmlConfig):
    with pytest.raises(BufferError_, match="b may not clear slot, its ops are R"):
        Channel(config, "slot", "b").clear()
    Channel(config, "queue", "a").write(text(1))
    reader = Channel(config, "queue", "b")
    reader.clear()
    assert reader.queue_length() == 0


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("slot", "message 2 is not where it should be"),
        ("queue", "a record of 1099511627776 bytes cannot be; the queue was emptied"),
        ("news", "a record is not where it should be"),
    ],
)
def test_damaged_memory_is_an_error_and_the_buffer_goes_on(
    config: NmlConfig, own_namespace: str, name: str, problem: str
):
    writer, reader = Channel(config, name, "a"), Channel(config, name, "b")
    for number in range(2):
        writer.write(text(number))
    path = Path(f"/dev/shm/pyemc.{own_namespace}.nml.{config.buffer(name).key}")
    number = 2 if name == "slot" else 1
    head = number.to_bytes(8, "little") + (280).to_bytes(8, "little")
    wrong = (99).to_bytes(8, "little") if name == "slot" else head[:8]
    with path.open("r+b") as memory:
        at = memory.read().index(head)
        memory.seek(at)
        memory.write(wrong + (2**40).to_bytes(8, "little"))
    with pytest.raises(BufferError_, match=f"buffer {name} is damaged: {problem}"):
        reader.read()
    assert reader.read() is None
    writer.write(text(3))
    assert reader.read().text == "3"


def test_a_damaged_queue_stops_no_observer(config: NmlConfig, own_namespace: str):
    writer = Channel(config, "queue", "a")
    observer = Channel.connect(config.buffer("queue"), config.observer("queue"))
    writer.write(text(0))
    path = Path(f"/dev/shm/pyemc.{own_namespace}.nml.2002")
    head = (1).to_bytes(8, "little") + (280).to_bytes(8, "little")
    with path.open("r+b") as memory:
        memory.seek(memory.read().index(head))
        memory.write(bytes(16))
    with pytest.raises(BufferError_, match="buffer queue is damaged: no record 1 in the queue"):
        observer.read()
    writer.write(text(1))
    assert texts(observer) == ["1"]


def test_a_buffer_outlives_the_channel_that_it_came_from(config: NmlConfig):
    raw = Channel(config, "queue", "a").raw
    reader = Channel(config, "queue", "b")
    raw.write(text(1).data)
    assert texts(reader) == ["1"]
    reader.close()
    assert segments()
    del raw, reader
    assert segments() == []


def test_a_child_that_inherits_a_channel_leaves_the_segment_to_its_parent(config: NmlConfig):
    channel = Channel(config, "queue", "a")
    pid = os.fork()
    if pid == 0:
        channel.close()
        os._exit(0)
    assert os.waitpid(pid, 0)[1] == 0
    assert segments()
    other = Channel(config, "queue", "b")
    channel.write(text(1))
    assert texts(other) == ["1"]


def test_segments_belong_to_their_owner_and_go_with_the_last_user(config: NmlConfig, own_namespace: str):
    one, two = Channel(config, "slot", "a"), Channel(config, "slot", "b")
    assert segments() == [f"/pyemc.{own_namespace}.nml.2001"]
    assert stat.S_IMODE(os.stat(f"/dev/shm/pyemc.{own_namespace}.nml.2001").st_mode) == 0o600
    one.close()
    one.close()
    assert segments()
    two.close()
    assert segments() == []
    with pytest.raises(BufferError_, match="buffer slot: the channel is closed"):
        two.read()


def test_a_segment_that_nobody_uses_any_more_is_made_anew(config: NmlConfig, own_namespace: str):
    path = Path(f"/dev/shm/pyemc.{own_namespace}.nml.2002")
    with Channel(config, "queue", "a") as channel:
        channel.write(EMC_NULL())
        remains = path.read_bytes()
    path.write_bytes(remains)
    path.chmod(0o600)
    with Channel(config, "queue", "a") as channel:
        assert channel.queue_length() == 0


def test_a_segment_of_another_version_is_told_apart(
    config: NmlConfig, own_namespace: str, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("nml.segment.PATIENCE", 0.05)
    channel = Channel(config, "queue", "a")
    with Path(f"/dev/shm/pyemc.{own_namespace}.nml.2002").open("r+b") as memory:
        memory.write(bytes(8))
    with pytest.raises(BufferError_, match="is in use by another version of this program"):
        Channel(config, "queue", "b")
    channel.close()
    assert segments() == []


def test_two_declarations_of_one_key_are_told_apart(config: NmlConfig):
    with Channel(config, "slot", "a"), pytest.raises(BufferError_, match=r"buffer other: \d+ bytes by this NML file"):
        Channel(config, "other", "a")


def test_cleanup_orphans_whoever_is_still_there(config: NmlConfig):
    channel = Channel(config, "slot", "a")
    assert not channel.orphaned
    assert cleanup() == [f"/pyemc.{os.environ['PYEMC_NAMESPACE']}.nml.2001"]
    assert channel.orphaned
    channel.close()


def test_two_namespaces_never_meet(config: NmlConfig, monkeypatch: pytest.MonkeyPatch, own_namespace: str):
    here = Channel(config, "queue", "a")
    here.write(EMC_NULL())
    monkeypatch.setenv("PYEMC_NAMESPACE", own_namespace + "-2")
    there = Channel(config, "queue", "b")
    assert there.read() is None
    there.close()


def test_local_memory_is_shared_within_the_process_only(config: NmlConfig):
    Channel(config, "own", "a").write(text(5))
    assert texts(Channel(config, "own", "b")) == ["5"]
    assert segments() == []


def test_a_file_buffer_outlives_its_users(config: NmlConfig):
    with Channel(config, "file", "a") as writer:
        writer.write(text(6))
    with Channel(config, "file", "b") as reader:
        assert texts(reader) == ["6"]


def test_diagnostics_count_per_process(config: NmlConfig):
    writer, reader = Channel(config, "slot", "a"), Channel(config, "slot", "b")
    for _ in range(3):
        writer.write(EMC_NULL())
    reader.read()
    reader.read()
    counts = {str(entry["name"]): entry for entry in reader.diagnostics()}
    assert (counts["a"]["writes"], counts["a"]["bytes_written"]) == (3, 72)
    assert (counts["b"]["reads"], counts["b"]["new_reads"], counts["b"]["last_type"]) == (2, 1, EMC_NULL.TYPE_ID)
    assert counts["a"]["pid"] == os.getpid()


def test_the_age_of_a_status_tells_whether_its_writer_lives(config: NmlConfig):
    writer, reader = Channel(config, "slot", "a"), Channel(config, "slot", "b")
    assert reader.age() is None
    writer.write(EMC_NULL())
    age = reader.age()
    assert age is not None
    assert age >= 0.0


@pytest.mark.parametrize("name", ["slot", "queue", "news"])
def test_a_closed_channel_refuses_everything(config: NmlConfig, name: str):
    channel = Channel(config, name, "a")
    channel.close()
    calls = {
        "write": lambda: channel.write(EMC_NULL()),
        "read": channel.read,
        "peek": channel.peek,
        "poll_into": lambda: channel.poll_into(bytearray(8)),
        "wait": lambda: channel.wait(0.0),
        "has_news": channel.has_news,
        "check_if_read": channel.check_if_read,
        "queue_length": channel.queue_length,
        "space": channel.space,
        "clear": channel.clear,
        "age": channel.age,
        "diagnostics": channel.diagnostics,
        "address": lambda: channel.address,
        "write_counter": lambda: channel.write_counter,
        "mark_read": channel.raw.mark_read,
        "last_writer": channel.raw.last_writer,
    }
    for call in calls.values():
        with pytest.raises(BufferError_, match=f"buffer {name}: the channel is closed"):
            call()


def test_messages_are_of_their_class(config: NmlConfig):
    writer, reader = Channel(config, "queue", "a"), Channel(config, "queue", "b")
    writer.write(text(1))
    message: Message | None = reader.read()
    assert isinstance(message, EMC_OPERATOR_TEXT)
