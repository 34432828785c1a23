"""Slow, silent, hostile and dying clients: none crashes, hangs or delays the server, another client or the machine."""

from __future__ import annotations

import contextlib
import random
import socket
import struct
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from nml.channel import Channel
from nml.emc import EMC_STAT, EMC_TASK_ABORT
from nml.errors import ConfigError
from nml.net import wire
from nml.net.server import Server as InProcess
from nml.net.streams import Limits
from tests.support.nml_server import Server, free_port, nml_text, running

pytestmark = pytest.mark.process

WAIT = 60.0  # s; a watchdog, not a claim about speed


@pytest.fixture
def server(tmp_path: Path) -> Iterator[Server]:
    with running(tmp_path, nml_text(f"TCP={free_port()}")) as one:
        yield one


def port_of(server: Server) -> int:
    return next(iter(server.ports))[1]


class Raw:
    """A client that sends what it likes."""

    def __init__(self, server: Server, receive_buffer: int = 0) -> None:
        self.sock = socket.socket()
        if receive_buffer:
            self.sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.sock.settimeout(WAIT)
        self.sock.connect(("127.0.0.1", port_of(server)))

    def send(self, data: bytes) -> None:
        self.sock.sendall(data)

    def receive(self, size: int) -> bytes:
        data = b""
        while len(data) < size:
            more = self.sock.recv(size - len(data))
            if not more:
                raise ConnectionError("closed by the server")
            data += more
        return data

    def name(self, serial: int = 0, number: int = 2) -> bytes:
        """The name of a buffer: proof that the server is well."""
        self.send(wire.REQUEST.pack(serial, wire.Request.GET_NAME, number, 0, 0))
        reply = self.receive(40)
        assert reply[:8] == struct.pack(">II", serial + 1, 0)
        return reply[8:].rstrip(b"\0")

    def close(self) -> None:
        self.sock.close()


def is_well(server: Server) -> None:
    """The server answers a new client."""
    client = Raw(server)
    assert client.name() == b"emcStatus"
    client.close()


def request(kind: int, number: int = 2, word3: int = 0, word4: int = 0, serial: int = 0) -> bytes:
    return wire.REQUEST.pack(serial, kind, number, word3, word4)


FATAL_TO_THE_STOCK_SERVER = {
    "a write to an unknown buffer": request(2, 77, 4, 16) + bytes(16),
    "a body of five times the buffer": request(2, 1, 4, 5 * 8192) + bytes(5 * 8192),
    "a body of four gigabytes": request(2, 1, 4, 0xFFFF_FFFF) + bytes(100),
    "clean, which ends the process": request(4),
    "sixty serial errors": b"".join(request(16, serial=900) for _ in range(60)),
    "sixty unknown requests": b"".join(request(99) for _ in range(60)),
    "a subscription ended before the connection": request(9, 2, 1, 100) + request(9, 2, 2, serial=1),
    "half a request": request(1)[:11],
    "half a body": request(2, 1, 4, 272) + bytes(100),
    "a blocking read for ever": request(11, 3, 1) + b"\xff\xff\xff\xff",
}


@pytest.mark.parametrize("traffic", FATAL_TO_THE_STOCK_SERVER.values(), ids=FATAL_TO_THE_STOCK_SERVER)
def test_what_stops_the_stock_server_does_not_stop_ours(server: Server, traffic: bytes) -> None:
    attacker, bystander = Raw(server), Raw(server)
    assert bystander.name() == b"emcStatus"
    attacker.send(traffic)
    assert bystander.name(1) == b"emcStatus"
    attacker.close()
    assert bystander.name(2) == b"emcStatus"
    is_well(server)


def test_a_remote_clear_or_write_does_not_touch_what_the_server_may_only_read(server: Server) -> None:
    machine = Channel(server.config, "emcStatus", "emc")
    machine.write(EMC_STAT(line=7))
    client = Raw(server)
    client.send(request(5, 2))
    assert client.receive(8) == struct.pack(">Ii", 1, -9)
    client.send(request(2, 2, 4, 4, serial=1) + bytes(4))
    assert client.name(2) == b"emcStatus"
    reader = Channel(server.config, "emcStatus", "xemc")
    assert reader.peek().line == 7
    for channel in (machine, reader):
        channel.close()


def test_garbage_writes_put_nothing_into_the_command_queue(server: Server) -> None:
    machine = Channel(server.config, "emcCommand", "emc")
    client = Raw(server)
    source = random.Random(1)
    bodies = [source.randbytes(source.randint(0, 300)) for _ in range(100)]
    bodies += [struct.pack(">II", 999_999, 24) + bytes(4), struct.pack(">II", 504, 24), b""]
    for serial, body in enumerate(bodies):
        client.send(request(2, 1, 4, len(body), serial=serial) + body)
        _, status, _ = struct.unpack(">IiI", client.receive(12))
        assert status < 0
    assert machine.read() is None
    machine.close()


def test_a_client_that_takes_no_replies_delays_nobody(server: Server) -> None:
    machine = Channel(server.config, "emcStatus", "emc")
    machine.write(EMC_STAT())
    lazy = Raw(server, receive_buffer=4096)
    lazy.sock.settimeout(0.2)
    flood = b"".join(request(1, 2, 3, serial=serial) for serial in range(2000))
    with contextlib.suppress(TimeoutError):
        while True:
            lazy.send(flood)
    other = Raw(server)
    for serial in range(100):
        assert other.name(serial) == b"emcStatus"
    assert memory_kb(server) < 200_000
    machine.close()


def memory_kb(server: Server) -> int:
    assert server.process is not None
    line = next(one for one in Path(f"/proc/{server.process.pid}/status").read_text().splitlines() if "VmRSS" in one)
    return int(line.split()[1])


def test_three_thousand_connections_come_and_go(server: Server) -> None:
    bystander = Raw(server)
    bystander.name()
    serial = 1
    for _ in range(30):
        clients = [Raw(server) for _ in range(100)]
        for client in clients[::3]:
            client.name()
        assert bystander.name(serial) == b"emcStatus"
        serial += 1
        for client in clients:
            client.close()
    is_well(server)


def test_many_connections_at_once_are_all_served(server: Server) -> None:
    clients = [Raw(server) for _ in range(400)]
    for client in clients:
        assert client.name() == b"emcStatus"
    for client in clients:
        client.close()
    is_well(server)


def test_a_client_that_dies_in_a_write_has_written_nothing(server: Server) -> None:
    machine = Channel(server.config, "emcCommand", "emc")
    body = struct.pack(">IIi", EMC_TASK_ABORT.TYPE_ID, EMC_TASK_ABORT.SIZE, 0)
    for cut in range(1, 20 + len(body)):
        victim = Raw(server)
        victim.send((request(2, 1, 4, len(body)) + body)[:cut])
        victim.sock.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        victim.close()
    is_well(server)
    assert machine.read() is None
    whole = Raw(server)
    whole.send(request(2, 1, 4, len(body)) + body)
    assert whole.receive(12) == struct.pack(">IiI", 1, 3, 0)
    assert isinstance(machine.read(), EMC_TASK_ABORT)
    machine.close()


@contextlib.contextmanager
def stepping(folder: Path, limits: Limits) -> Iterator[tuple[InProcess, int]]:
    """A server in this process, run step by step."""
    port = free_port()
    config_server = Server(folder, nml_text(f"TCP={port}"))
    server = InProcess(config_server.config, limits=limits)
    try:
        yield server, port
    finally:
        server.close()


def steps(server: InProcess, seconds: float) -> None:
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        server.step(0.01)


def steps_until(server: InProcess, connections: int) -> None:
    """Let the server work until it has so many connections."""
    until = time.monotonic() + WAIT
    while server.connection_count != connections:
        assert time.monotonic() < until, f"{server.connection_count} connections, not {connections}"
        server.step(0.01)


def dismissed(client: socket.socket) -> bool:
    """Whether the server has closed a connection on which it sends nothing."""
    client.setblocking(False)
    try:
        return client.recv(1) == b""
    except BlockingIOError:
        return False


@pytest.mark.parametrize(
    ("limits", "traffic"),
    [
        (Limits(silent=0.5), b""),
        (Limits(unfinished=0.5), request(12) + request(1)[:7]),
        (Limits(unfinished=0.5), request(2, 1, 4, 100) + bytes(50)),
    ],
    ids=["silent from the start", "half a request", "half a body"],
)
def test_clients_that_are_not_worth_it_are_dismissed(tmp_path: Path, limits: Limits, traffic: bytes) -> None:
    with stepping(tmp_path, limits) as (server, port):
        client = socket.create_connection(("127.0.0.1", port), WAIT)
        client.sendall(traffic)
        steps_until(server, 1)
        steps_until(server, 0)
        client.close()


def test_a_client_that_takes_no_replies_is_dismissed_in_the_end(tmp_path: Path) -> None:
    with stepping(tmp_path, Limits(stalled=0.1)) as (server, port):
        client = socket.create_connection(("127.0.0.1", port), WAIT)
        steps_until(server, 1)
        client.setblocking(False)
        until = time.monotonic() + WAIT
        while server.connection_count != 0:
            with contextlib.suppress(OSError):
                client.send(request(12) * 1000)
            server.step(0.001)
            assert time.monotonic() < until, "it is still there"
        client.close()


def test_a_client_that_asks_rarely_is_kept(tmp_path: Path) -> None:
    with stepping(tmp_path, Limits(silent=1.0, unfinished=0.1, stalled=0.1)) as (server, port):
        client = socket.create_connection(("127.0.0.1", port), WAIT)
        client.sendall(request(12))
        steps(server, 2.5)
        assert server.connection_count == 1
        client.close()


def test_a_new_client_replaces_the_quietest_when_there_are_too_many(tmp_path: Path) -> None:
    with stepping(tmp_path, Limits(connections=3)) as (server, port):
        clients = []
        for number in range(5):
            clients.append(socket.create_connection(("127.0.0.1", port), WAIT))
            steps_until(server, min(number + 1, 3))
            until = time.monotonic() + WAIT
            while number >= 3 and not dismissed(clients[number - 3]):
                assert time.monotonic() < until, "the quietest is still there"
                server.step(0.01)
        assert server.connection_count == 3
        assert not any(dismissed(client) for client in clients[2:])
        for client in clients:
            client.close()


def test_a_busy_port_is_an_error_that_names_the_line(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        one = Server(tmp_path, nml_text(f"TCP={other.getsockname()[1]}"))
        with pytest.raises(ConfigError, match=r"server.nml:\d+:.*cannot serve TCP=\d+: Address already in use"):
            InProcess(one.config)


def test_a_file_without_links_is_an_error(tmp_path: Path) -> None:
    one = Server(tmp_path, nml_text(""))
    with pytest.raises(ConfigError, match="has no buffer to serve"):
        InProcess(one.config)


@given(st.lists(st.binary(max_size=200), max_size=20))
@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_random_bytes_in_random_pieces_leave_the_server_well(server: Server, pieces: list[bytes]) -> None:
    client = Raw(server)
    with contextlib.suppress(OSError):
        for piece in pieces:
            client.send(piece)
    client.close()
    is_well(server)


def listening(port: int) -> set[str]:
    """Addresses on which somebody listens at a port, as the kernel writes them."""
    rows = [line.split() for line in Path("/proc/net/tcp").read_text().splitlines()[1:]]
    return {row[1].split(":")[0] for row in rows if row[3] == "0A" and int(row[1].split(":")[1], 16) == port}


def test_only_this_host_reaches_the_server_unless_told_otherwise(tmp_path: Path) -> None:
    port = free_port()
    with running(tmp_path, nml_text(f"TCP={port}")):
        assert listening(port) == {"0100007F"}


def test_the_ini_file_opens_the_server_to_an_address(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    port = free_port()
    (tmp_path / "machine.ini").write_text("[EMC]\nNML_FILE = server.nml\n[NML]\nLISTEN = 127.0.0.2\n")
    monkeypatch.setenv("INI_FILE_NAME", str(tmp_path / "machine.ini"))
    with running(tmp_path, nml_text(f"TCP={port}"), host="127.0.0.2"):
        assert listening(port) == {"0200007F"}


def test_the_process_ends_cleanly_with_clients_connected(server: Server) -> None:
    client = Raw(server)
    client.name()
    assert server.stop() == 0
    assert client.sock.recv(1) == b""
    client.close()


def test_an_optional_port_that_is_busy_is_left_out(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        with running(tmp_path, nml_text(f"TCP={port}"), "--optional") as one:
            assert one.process is not None
            assert one.process.poll() is None
