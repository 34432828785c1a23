"""linuxcncrsh as a process before a stand-in for task: its options, its limits, and clients that behave badly."""

import socket
import subprocess
import sys
from contextlib import contextmanager

import pytest

import linuxcnc
from nml import namespace
from tests.support.fake_task import FakeTask
from tests.support.machine import ROOT, RshClient, wait_until


@pytest.fixture
def task():
    with FakeTask() as task:
        task.status.task.state = linuxcnc.STATE_ON
        task.publish()
        yield task


@contextmanager
def serving(*options):
    """A server on any free port; its port."""
    path = namespace.runtime_dir() / "linuxcncrsh.port"
    process = subprocess.Popen(
        [sys.executable, "-m", "gui.linuxcncrsh", "-p", "0", *options],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        wait_until(lambda: process.poll() is not None or (path.exists() and path.read_text().strip()), "port")
        assert process.poll() is None, process.communicate()
        yield int(path.read_text())
    finally:
        process.terminate()
        process.communicate(timeout=30)


def test_name_and_passwords_are_those_of_the_options(task):
    with serving("-n", "SHOP", "-w", "door", "-e", "key", "-q") as port, RshClient(port) as client:
        assert client.ask("hello EMC me") == "HELLO NAK"
        assert client.ask("hello door me") == "HELLO ACK SHOP 1.1"
        assert client.ask("set echo off") == "set echo off"
        assert client.ask("set enable EMCTOO") == "SET ENABLE NAK"
        client.send("set enable key")
        assert client.ask("get enable") == "ENABLE ON"


def test_more_connections_than_allowed_are_closed(task):
    with serving("-s", "1") as port:
        with RshClient(port) as first, RshClient(port) as second:
            assert first.ask("get plat") == "PLAT Linux"
            assert second.line() == ""
        wait_until(lambda: answers(port), "the place of the client that left")


def answers(port):
    with RshClient(port) as client:
        try:
            return client.ask("get plat") == "PLAT Linux"
        except ConnectionError:
            return False


def test_one_client_that_floods_and_never_reads_holds_up_nobody(task):
    with serving() as port:
        flood = socket.create_connection(("localhost", port), timeout=30)
        flood.setblocking(False)
        sent = 0
        try:
            while sent < 50_000_000:
                sent += flood.send(b"help set\r\n" * 1000)
        except BlockingIOError:
            pass
        with RshClient(port) as client:
            assert client.ask("get plat") == "PLAT Linux"
        flood.close()


def test_half_a_line_binary_and_a_megabyte_without_an_end_do_no_harm(task):
    with serving() as port:
        rude = [socket.create_connection(("localhost", port), timeout=30) for _ in range(3)]
        rude[0].sendall(b"hello EMC x\r\nset enable EMCTOO\r\nset abor")
        rude[1].sendall(bytes(range(256)) * 64)
        rude[2].sendall(b"x" * 1_000_000)
        with RshClient(port) as client:
            client.take_control()
            assert client.ask("get machine") == "MACHINE ON"
        for one in rude:
            one.close()
    assert task.taken == []


def test_a_port_in_use_is_one_clear_line(task):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        result = subprocess.run(
            [sys.executable, "-m", "gui.linuxcncrsh", "-p", str(taken.getsockname()[1]), "--bind", "127.0.0.1"],
            cwd=ROOT,
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
    assert result.returncode == 1
    assert len(result.stderr.splitlines()) == 1
    assert "in use" in result.stderr
