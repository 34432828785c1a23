"""Remote channels and a server process: every kind of link carries the same messages and lives through restarts."""

from __future__ import annotations

import contextlib
import re
import socket
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

import linuxcnc
from nml.channel import Channel
from nml.codecs import xdr
from nml.emc import (
    EMC_CALL_STACKS,
    EMC_OPERATOR_ERROR,
    EMC_ORDER_NOTE,
    EMC_SPINDLE_ON,
    EMC_STAT,
    EMC_TASK_PLAN_EXECUTE,
    EMC_TOOL_TABLE,
)
from nml.errors import BufferError_, ChannelTimeout, ConfigError, NmlError, QueueFull
from nml.net import wire
from nml.net.remote import RemoteChannel
from nml.net.server import Server as InProcess
from tests.support.nml_server import NullModem, Server, free_port, nml_text, running

pytestmark = pytest.mark.process

BUFFERS = ("emcCommand", "emcStatus", "emcError", "toolTable")


class Ends:
    """A server, the machine's channels on its side and a remote client's channels."""

    def __init__(self, server: Server, options: str = "") -> None:
        self.server = server
        self.machine = {name: Channel(server.config, name, "emc") for name in BUFFERS[:3]}
        self.tool = Channel(server.config, "toolTable", "tool")
        remote = server.remote(options)
        self.client = {name: Channel(remote, name, "xemc") for name in BUFFERS if remote.buffer(name)}

    def close(self) -> None:
        for channel in (*self.machine.values(), self.tool, *self.client.values()):
            channel.close()


def links(kind: str) -> str:
    if kind == "UDP":
        return f"UDP={free_port(socket.SOCK_DGRAM)}"
    return f"{kind}={free_port()}"


@pytest.fixture(params=["TCP", "STCP", "UDP", "serial"])
def ends(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Ends]:
    if request.param != "serial":
        with running(tmp_path, nml_text(links(request.param))) as server:
            both = Ends(server)
            yield both
            both.close()
        return
    with NullModem() as cable:
        text = nml_text(f"TCP={free_port()} serialPortDevName={cable.devices[0]}")
        with running(tmp_path, text) as server:
            both = Ends(server, f"serialPortDevName={cable.devices[1]}")
            yield both
            both.close()


def wait_until(what, seconds: float = 60.0):  # type: ignore[no-untyped-def]
    """The first true result of ``what``."""
    deadline = time.monotonic() + seconds
    while not (result := what()):
        assert time.monotonic() < deadline, "it did not happen"
        time.sleep(0.01)
    return result


def test_the_newest_status_arrives_once(ends: Ends) -> None:
    client = ends.client["emcStatus"]
    assert isinstance(client, RemoteChannel)
    assert client.peek() is None
    status = EMC_STAT(status=2)
    status.motion.traj.position.tran.x = -1.25
    status.task.file = "/tmp/ä, b.ngc"
    ends.machine["emcStatus"].write(status)
    got = client.peek()
    assert isinstance(got, EMC_STAT)
    assert got.motion.traj.position.tran.x == -1.25
    assert got.task.file == "/tmp/ä, b.ngc"
    assert client.peek() is None
    ends.machine["emcStatus"].write(status)
    assert client.has_news()
    assert client.peek() is not None


def test_commands_arrive_in_order_with_their_serial_numbers(ends: Ends) -> None:
    client, machine = ends.client["emcCommand"], ends.machine["emcCommand"]
    sent = []
    for turn in range(5):
        message = EMC_TASK_PLAN_EXECUTE(command=f"G0 X{turn}, Y\\2")
        assert client.write(message) == turn + 1
        sent.append(message)
    got = [machine.read() for _ in range(5)]
    assert [one.serial_number for one in sent] == [1, 2, 3, 4, 5]
    assert got == sent
    assert machine.read() is None


def test_each_remote_reader_gets_every_operator_message_whole(ends: Ends) -> None:
    text = "Linear move on line 42 would exceed joint 0's positive limit, " * 4
    other = Channel(ends.client["emcError"].line and ends.server.config, "emcError", "xemc")
    ends.machine["emcError"].write(EMC_OPERATOR_ERROR(error=text[:250]))
    for reader in (ends.client["emcError"], other):
        message = wait_until(reader.read)
        assert isinstance(message, EMC_OPERATOR_ERROR)
        assert message.error == text[:250]
        assert reader.read() is None
    other.close()


def test_the_questions_of_a_channel_are_answered(ends: Ends) -> None:
    client, machine = ends.client["emcCommand"], ends.machine["emcCommand"]
    assert (client.write_counter, client.queue_length(), client.check_if_read()) == (0, 0, True)
    client.write(EMC_TASK_PLAN_EXECUTE(command="G0 X1"))
    assert (client.write_counter, client.queue_length(), client.check_if_read()) == (1, 1, False)
    assert client.write_if_read(EMC_TASK_PLAN_EXECUTE(command="G0 X2")) == 0
    assert client.space() == machine.space()
    client.clear()
    assert machine.read() is None
    assert client.write_if_read(EMC_TASK_PLAN_EXECUTE(command="G0 X2")) == 2


def test_a_full_queue_is_reported_and_nothing_is_lost(ends: Ends) -> None:
    client, machine = ends.client["emcCommand"], ends.machine["emcCommand"]
    accepted = 0
    with contextlib.suppress(QueueFull):
        for accepted in range(100):
            client.write(EMC_TASK_PLAN_EXECUTE(command=f"G0 X{accepted}"))
    assert 20 < accepted < 99
    got = []
    while (message := machine.read()) is not None:
        got.append(message.command)
    assert got == [f"G0 X{number}" for number in range(accepted)]


def test_the_server_reads_only_what_its_process_line_lets_it(ends: Ends) -> None:
    with pytest.raises(BufferError_, match="may not read"):
        ends.client["emcCommand"].read()
    assert ends.client["emcCommand"].raw is not None
    with pytest.raises(BufferError_, match="process line"):
        ends.client["emcCommand"].raw.read()


@pytest.fixture
def tcp(tmp_path: Path) -> Iterator[Ends]:
    with running(tmp_path, nml_text(links("TCP"))) as server:
        both = Ends(server)
        yield both
        both.close()


def test_what_stock_programs_do_not_see_reaches_our_own(tcp: Ends) -> None:
    status = EMC_STAT()
    status.motion.traj.joints = 3
    status.motion.traj.rapid_scale = 0.5
    status.motion.analog_input[3] = 1.5
    tcp.machine["emcStatus"].write(status)
    got = tcp.client["emcStatus"].peek()
    assert (got.motion.traj.joints, got.motion.traj.rapid_scale, got.motion.analog_input[3]) == (3, 0.5, 1.5)
    tcp.client["emcCommand"].write(EMC_SPINDLE_ON(spindle=2, speed=100.0))
    assert tcp.machine["emcCommand"].read().spindle == 2
    tcp.tool.write(EMC_TOOL_TABLE(last_index=7))
    assert tcp.client["toolTable"].peek().last_index == 7
    calls = EMC_CALL_STACKS()
    calls.stacks[1].depth = 1
    calls.stacks[1].frames[0].subname = "outer"
    with (
        Channel(tcp.server.config, "callStacks", "emc") as task,
        Channel(tcp.server.remote(), "callStacks", "xemc") as client,
    ):
        task.write(calls)
        assert client.peek().stacks[1].frames[0].subname == "outer"


def test_a_status_is_copied_into_the_reader_s_own_memory(tcp: Ends) -> None:
    mine = EMC_STAT()
    client = tcp.client["emcStatus"]
    assert not client.poll_into(mine.data)
    tcp.machine["emcStatus"].write(EMC_STAT(echo_serial_number=9))
    assert client.poll_into(mine.data)
    assert mine.echo_serial_number == 9
    assert not client.poll_into(mine.data)


def test_a_reader_that_waits_gets_the_message(tcp: Ends) -> None:
    client = tcp.client["emcError"]
    assert not client.wait(0.02)
    tcp.machine["emcError"].write(EMC_OPERATOR_ERROR(error="joint 1 following error"))
    assert client.wait(60.0)


def test_channels_come_back_after_a_restart_of_the_server(tcp: Ends) -> None:
    status, command = tcp.client["emcStatus"], tcp.client["emcCommand"]
    tcp.machine["emcStatus"].write(EMC_STAT(line=1))
    assert status.peek().line == 1
    command.write(EMC_TASK_PLAN_EXECUTE(command="G0 X1"))
    tcp.server.stop()
    for channel in (status, tcp.client["emcError"]):
        with pytest.raises(NmlError, match=r"emc\w+ at localhost:\d+"):
            channel.peek()
    with pytest.raises(NmlError, match="emcCommand at localhost"):
        command.write(EMC_TASK_PLAN_EXECUTE(command="G0 X2"))
    tcp.server.start()
    tcp.machine["emcStatus"].write(EMC_STAT(line=2))

    def again():  # type: ignore[no-untyped-def]
        try:
            return status.peek()
        except BufferError_:
            return None

    assert wait_until(again).line == 2

    def written():  # type: ignore[no-untyped-def]
        try:
            return command.write(EMC_TASK_PLAN_EXECUTE(command="G0 X3"))
        except BufferError_:
            return 0

    assert wait_until(written) == 2
    machine = tcp.machine["emcCommand"]
    assert [machine.read().command for _ in range(2)] == ["G0 X1", "G0 X3"]


def test_a_restart_between_two_calls_goes_unnoticed(tcp: Ends) -> None:
    status, command = tcp.client["emcStatus"], tcp.client["emcCommand"]
    tcp.server.stop()
    tcp.server.start()
    tcp.machine["emcStatus"].write(EMC_STAT(line=5))
    assert status.peek().line == 5
    assert command.write(EMC_TASK_PLAN_EXECUTE(command="G0 X3")) == 1


def test_noreconnect_gives_up_with_the_reason(tcp: Ends) -> None:
    channel = Channel(tcp.server.remote("noreconnect"), "emcStatus", "xemc")
    tcp.server.stop()
    for _ in range(2):
        with pytest.raises(BufferError_, match=r"noreconnect|closed|lost|refused"):
            channel.peek()
    tcp.server.start()
    with pytest.raises(BufferError_, match="noreconnect"):
        channel.peek()
    channel.close()


def test_a_server_that_does_not_answer_is_a_timeout_after_the_time_of_the_process_line(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as silent:
        text = nml_text(f"TCP={silent.getsockname()[1]}").replace("10.0", "0.2")
        server = Server(tmp_path, text)
        with pytest.raises(ChannelTimeout, match=r"client.nml:\d+:.*no answer to .* within 0.2 s"):
            Channel(server.remote(), "emcStatus", "xemc")


def test_a_server_that_is_not_there_is_named(tmp_path: Path) -> None:
    port = free_port()
    server = Server(tmp_path, nml_text(f"TCP={port}"))
    with pytest.raises(BufferError_, match=f"emcStatus at localhost:{port}: cannot connect: Connection refused"):
        Channel(server.remote(), "emcStatus", "xemc")


def test_a_wrong_buffer_number_is_noticed(tcp: Ends) -> None:
    text = tcp.server.file.read_text().replace("0     0    2 ", "0     0    4 ", 1)
    with pytest.raises(BufferError_, match="buffer number 4: is 'toolCmd' there"):
        Channel(tcp.server.remote(text=text), "emcStatus", "xemc")


def test_a_buffer_without_a_link_is_a_configuration_error(tmp_path: Path) -> None:
    server = Server(tmp_path, nml_text(""))
    with pytest.raises(ConfigError, match="emcStatus has no TCP="):
        Channel(server.remote(), "emcStatus", "xemc")


@pytest.mark.parametrize("options", ["POLL", "sub=var", "sub=0.02"])
def test_reads_that_do_not_wait_bring_the_status_soon(tcp: Ends, options: str) -> None:
    channel = Channel(tcp.server.remote(options), "emcStatus", "xemc")
    for line in (1, 2, 3):
        tcp.machine["emcStatus"].write(EMC_STAT(line=line))
        assert wait_until(channel.peek).line == line
    assert channel.write_counter == 3
    tcp.server.stop()
    tcp.server.start()
    tcp.machine["emcStatus"].write(EMC_STAT(line=4))

    def again():  # type: ignore[no-untyped-def]
        try:
            return channel.peek()
        except BufferError_:
            return None

    assert wait_until(again).line == 4
    channel.close()


@pytest.mark.parametrize("kind", ["TCP", "STCP", "UDP"])
def test_a_password_opens_a_buffer(tmp_path: Path, kind: str) -> None:
    (tmp_path / "users.pwd").write_text("# who may\noperator:let me in\n")
    (tmp_path / "right.pwd").write_text("operator:let me in\n")
    (tmp_path / "wrong.pwd").write_text("operator:let him in\n")
    text = nml_text(links(kind), {"emcStatus": "passwd=users.pwd"})
    with running(tmp_path, text) as server:
        Channel(server.config, "emcStatus", "emc").write(EMC_STAT(line=3))
        machine = Channel(server.config, "emcStatus", "emc")
        machine.write(EMC_STAT(line=4))
        with pytest.raises(BufferError_, match="process line or password file"):
            Channel(server.remote(), "emcStatus", "xemc").peek()
        with pytest.raises(BufferError_, match=r"does not accept|wrong name or password"):
            Channel(server.remote("passwd=wrong.pwd"), "emcStatus", "xemc")
        assert Channel(server.remote("passwd=right.pwd"), "emcStatus", "xemc").peek().line == 4
        machine.close()


def test_a_noisy_serial_line_loses_no_command_and_takes_none_twice(tmp_path: Path) -> None:
    with NullModem() as cable:
        text = nml_text(f"TCP={free_port()} serialPortDevName={cable.devices[0]}")
        with running(tmp_path, text) as server:
            both = Ends(server, f"serialPortDevName={cable.devices[1]}")
            cable.lose = 701
            sent = [f"G0 X{number}" for number in range(12)]
            for line in sent:
                both.client["emcCommand"].write(EMC_TASK_PLAN_EXECUTE(command=line))
            got = []
            while (message := both.machine["emcCommand"].read()) is not None:
                got.append(message.command)
            assert got == sent
            both.close()


def test_a_port_serves_the_buffers_of_its_own_lines_only(tmp_path: Path) -> None:
    first, second = free_port(), free_port()
    text = nml_text(f"TCP={first}")
    lines = [line.replace(str(first), str(second)) if "B emcCommand" in line else line for line in text.splitlines()]
    text = "\n".join(lines)
    with running(tmp_path, text) as server:
        Channel(server.remote(), "emcCommand", "xemc").close()
        crossed = "\n".join(line.replace(str(second), str(first)) for line in lines)
        with pytest.raises(BufferError_, match="buffer number 1: the server does not have this buffer"):
            Channel(server.remote(text=crossed), "emcCommand", "xemc")


def test_two_buffers_of_one_number_on_a_port_are_an_error(tmp_path: Path) -> None:
    text = nml_text(f"TCP={free_port()}").replace("0     0    2 ", "0     0    1 ", 1)
    server = Server(tmp_path, text)
    with pytest.raises(ConfigError, match=r"server.nml:\d+:.* emcStatus has number 1, as emcCommand on TCP="):
        InProcess(server.config)


def test_a_neutral_buffer_travels_as_any_other(tmp_path: Path) -> None:
    text = nml_text(f"TCP={free_port()}")
    lines = [re.sub(r"localhost( +)(\d+)( +)0", r"localhost\1\2\g<3>1", line, count=1) for line in text.splitlines()]
    with running(tmp_path, "\n".join(lines)) as server:
        both = Ends(server)
        both.machine["emcStatus"].write(EMC_STAT(line=11))
        assert both.client["emcStatus"].peek().line == 11
        assert both.client["emcCommand"].write(EMC_TASK_PLAN_EXECUTE(command="G0 X1")) == 1
        got = both.machine["emcCommand"].read()
        assert (got.command, got.serial_number) == ("G0 X1", 1)
        both.close()


def test_a_stock_program_gets_exactly_the_bytes_of_the_stock_status(tcp: Ends) -> None:
    tcp.machine["emcStatus"].write(EMC_STAT(line=11))
    port = next(iter(tcp.server.ports))[1]
    with socket.create_connection(("127.0.0.1", port), 60.0) as sock:
        sock.sendall(wire.REQUEST.pack(0, wire.Request.READ, 2, wire.Access.PEEK, 0))
        reply = sock.recv(20 + 3876, socket.MSG_WAITALL)
        assert wire.READ_REPLY.unpack_from(reply) == (1, 2, 3876, 1, 0)
        assert reply[20:] == xdr.encode(EMC_STAT(line=11))
        assert reply[20:28] == bytes.fromhex("000007cf 00002a20")


def test_who_watches_here_sees_the_commands_from_elsewhere_and_where_they_come_from(ends: Ends) -> None:
    watcher = Channel(ends.server.config, "emcOrders", "xemc")
    ends.client["emcCommand"].write(EMC_TASK_PLAN_EXECUTE(command="G0 X1"))
    wait_until(watcher.has_news)
    note = watcher.read()
    assert (note.serial, note.order) == (1, "TASK_PLAN_EXECUTE command='G0 X1'")
    assert note.origin.startswith(("127.0.0.1:", "/dev/"))
    watcher.close()


def test_nobody_can_put_words_into_the_mouth_of_others_from_elsewhere(tcp: Ends) -> None:
    notes = Channel(tcp.server.remote(), "emcOrders", "xemc")
    notes.write(EMC_ORDER_NOTE(serial=1, origin="halui", order="TASK_ABORT"))  # a write without confirmation
    assert notes.queue_length() == 0
    watcher = Channel(tcp.server.config, "emcOrders", "xemc")
    assert watcher.read() is None
    for channel in (notes, watcher):
        channel.close()


def test_the_client_module_says_when_the_machine_is_out_of_reach(tcp: Ends, monkeypatch: pytest.MonkeyPatch) -> None:
    tcp.server.remote()
    monkeypatch.setattr(linuxcnc, "nmlfile", str(tcp.server.folder / "client.nml"))
    tcp.machine["emcStatus"].write(EMC_STAT(line=1))
    status, command, errors = linuxcnc.stat(), linuxcnc.command(), linuxcnc.error_channel()
    tcp.server.stop()
    for call in (status.poll, command.abort, errors.poll, linuxcnc.stat):
        with pytest.raises(linuxcnc.error, match=r"emc\w+ at localhost:\d+: "):
            call()
    tcp.server.start()

    def again() -> bool:
        try:
            status.poll()
        except linuxcnc.error:
            return False
        return True

    wait_until(again)
