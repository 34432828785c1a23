"""SIGKILL of halcmd, of a user component, of the realtime host: the rest works on or says what is gone."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from hal.client import HostClient
from hal.core import Hal
from hal.process import alive, start_time
from hal.realtime import REALTIME_VARIABLE
from nml.errors import HalError
from tests.support.halsession import environment, halcmd, run, script

pytestmark = pytest.mark.process

COMPONENT = """
import hal, sys, time
c = hal.component(sys.argv[1])
c.newpin("out", hal.HAL_FLOAT, hal.HAL_OUT, safe=-1.0)
c.ready()
c["out"] = 5.0
print("ready", flush=True)
time.sleep(600)
"""


def until(condition: Callable[[], object], seconds: float = 60.0) -> None:
    """Wait for something that must happen; the bound only ends a hung test."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it did not happen"
        time.sleep(0.005)


@pytest.fixture
def session(own_namespace: str) -> Iterator[tuple[Hal, HostClient]]:
    """A realtime session with one thread that counts."""
    hal = Hal()
    client = HostClient(hal)
    client.loadrt("threads", ["name1=t", "period1=1000000"])
    client.loadrt("siggen", [])
    client.addf("siggen.0.update", "t")
    hal.start_threads()
    yield hal, client
    client.quit()
    hal.close()


def test_a_killed_user_component_is_removed_and_its_pins_are_safe(session: tuple[Hal, HostClient]) -> None:
    hal, _ = session
    child = subprocess.Popen(
        [sys.executable, "-c", COMPONENT, "victim"], env=environment(), stdout=subprocess.PIPE, text=True
    )
    assert child.stdout is not None
    assert child.stdout.readline() == "ready\n"
    hal.net("s", ["victim.out"])
    until(lambda: hal.value("s") == 5.0)
    child.kill()
    child.wait()
    child.stdout.close()
    until(lambda: hal.segment.find_comp("victim") is None)  # the host sees to it
    until(lambda: hal.value("s") == -1.0)


def test_a_killed_host_is_noticed_and_another_can_start(session: tuple[Hal, HostClient]) -> None:
    hal, client = session
    pid, _ = hal.host_state()
    os.kill(pid, signal.SIGKILL)
    until(lambda: not hal.host_state()[1])
    hal.stop_threads()  # does not wait for threads that are no more
    with pytest.raises(HalError, match=f"the realtime host .*{pid}.* has died|the realtime host died"):
        client.addf("siggen.0.update", "t")
    client.close()
    client.loadrt("threads", ["name1=u", "period1=1000000"])
    assert [thread.name for thread in hal.segment.threads()] == ["u"]
    assert hal.segment.find_comp("siggen") is None


def test_a_command_killed_anywhere_leaves_the_session_working(session: tuple[Hal, HostClient]) -> None:
    hal, _ = session
    for tenth in range(8):
        command = subprocess.Popen(
            [sys.executable, "-m", "hal.halcmd", "-kf"], env=environment(), stdin=subprocess.PIPE, text=True,
            stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
        )  # fmt: skip
        assert command.stdin is not None
        lines = "".join(f"newsig k{i} float\nlinkps siggen.0.sine k{i}\nunlinkp siggen.0.sine\n" for i in range(300))
        command.stdin.write(lines)
        command.stdin.flush()
        until(lambda: hal.segment.signals())
        time.sleep(tenth * 0.001)
        command.kill()
        command.wait()
        command.stdin.close()
        if hal.pin("siggen.0.sine").signal is not None:
            hal.unlink("siggen.0.sine")
        hal.net("probe", ["siggen.0.sine"])
        first = hal.value("probe")
        until(lambda value=first: hal.value("probe") != value)
        hal.unlink("siggen.0.sine")
        for record in hal.segment.signals():
            hal.delete_signal(record.name)


def test_stop_means_that_no_function_runs_any_more(session: tuple[Hal, HostClient]) -> None:
    hal, _ = session
    until(lambda: hal.value("siggen.0.sine") != 0.0)
    hal.stop_threads()
    frozen = hal.value("siggen.0.sawtooth")
    thread = hal.segment.threads()[0]
    cycles = thread.cycles
    until(lambda: thread.cycles > cycles + 5)
    assert hal.value("siggen.0.sawtooth") == frozen


def test_a_component_in_a_running_thread_can_be_unloaded(session: tuple[Hal, HostClient]) -> None:
    hal, client = session
    until(lambda: hal.value("siggen.0.sine") != 0.0)
    client.unloadrt("siggen")
    thread = hal.segment.threads()[0]
    cycles = thread.cycles
    until(lambda: thread.cycles > cycles + 5)
    assert thread.functs() == []


def test_halrun_u_always_cleans_up(own_namespace: str) -> None:
    halcmd("loadrt", "threads")
    hal = Hal()
    pid, _ = hal.host_state()
    started = start_time(pid)
    os.kill(pid, signal.SIGSTOP)
    hal.close()
    os.kill(pid, signal.SIGKILL)
    until(lambda: not alive(pid, started))
    assert run("halrun", "-U").returncode == 0
    assert not list(Path("/dev/shm").glob(f"*{own_namespace}*"))


def test_halrun_leaves_nothing_behind(
    own_namespace: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(REALTIME_VARIABLE, "0")  # a busy machine may have delays to tell of
    done = script(tmp_path, "loadrt threads\nloadrt and2\nloadusr sleep 30\nstart\n")
    assert (done.returncode, done.stderr) == (0, "")
    assert not list(Path("/dev/shm").glob(f"*{own_namespace}*"))
