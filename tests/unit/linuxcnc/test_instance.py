"""The lock of a namespace, its record of processes, and the removal of leftovers."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from linuxcnc.instance import AlreadyRunning, Instance, ProcessRecord, end_processes
from nml import namespace


def sleeper(ignore_term: bool = False) -> subprocess.Popen[bytes]:
    prelude = "import signal; signal.signal(signal.SIGTERM, signal.SIG_IGN); " if ignore_term else ""
    process = subprocess.Popen(
        [sys.executable, "-c", f"{prelude}print(flush=True); import time; time.sleep(60)"], stdout=subprocess.PIPE
    )
    assert process.stdout is not None
    process.stdout.readline()
    return process


def test_a_namespace_is_taken_once():
    first = Instance()
    with pytest.raises(AlreadyRunning, match=f"process {os.getpid()}"):
        Instance()
    first.release()
    Instance().release()


def test_a_released_namespace_has_no_trace():
    instance = Instance()
    folder = instance.folder
    Path("/dev/shm" + namespace.shm_name("test")).touch()
    (folder / "task.log").write_text("log")
    instance.release()
    assert not folder.exists()
    assert not Path("/dev/shm" + namespace.shm_name("test")).exists()


def test_another_namespace_keeps_its_memory():
    other = Path("/dev/shm" + namespace.shm_name("nml.1").replace(namespace.namespace(), namespace.namespace() + "x"))
    other.touch()
    try:
        Instance().release()
        assert other.exists()
    finally:
        other.unlink()


def test_a_process_that_ended_is_no_longer_recorded():
    instance = Instance()
    with sleeper() as process:
        instance.add(ProcessRecord.of(process.pid, "task"))
        assert [record.name for record in instance.recorded()] == ["task"]
        process.kill()
    assert instance.recorded() == []
    instance.release()


def test_leftovers_are_ended_by_the_next_start():
    with sleeper() as process:
        first = Instance()
        first.add(ProcessRecord.of(process.pid, "task"))
        os.close(first._file)
        second = Instance()
        assert [record.pid for record in second.remove_leftovers()] == [process.pid]
        assert process.wait() == -signal.SIGTERM
        second.release()


def test_a_process_with_a_reused_number_is_left_alone():
    with sleeper() as process:
        record = ProcessRecord(process.pid, 1, "task")
        assert not record.alive
        assert end_processes([record]) == []
        assert process.poll() is None
        process.kill()


def test_a_stubborn_process_is_killed():
    with sleeper(ignore_term=True) as process:
        record = ProcessRecord.of(process.pid, "task")
        assert end_processes([record], grace=0.2) == [record]
        assert process.wait() == -signal.SIGKILL


@pytest.mark.parametrize("line", ["", "x 1 task", "12 y task", "12 13"])
def test_a_damaged_record_is_no_process(line):
    assert ProcessRecord.parse(line) is None
