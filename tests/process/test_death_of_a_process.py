"""A process dies while the machine cuts: the rest notices and stops under its limits; a new start works at once."""

import os
import signal

import numpy as np
import pytest

import linuxcnc
from emctask.config import default_heartbeat_s
from tests.process.test_running_programs import ACCELERATION, PERIOD, VELOCITY
from tests.support import verify
from tests.support.machine import HEARTBEAT, Run, copy_mill, processes, running, traces, wait_until
from tests.support.recorder import hal_text, recorded

pytestmark = pytest.mark.process

SPEED = 4.0
STILL_PERIODS = 100  # servo periods without a change: at rest
CATCHING_UP = 1.5  # a host that was held up makes good for the periods it missed
RECORDER_LAG_S = 2.0  # how far the file of the recorder may be behind on a busy computer
PROGRAM = "G21 G90 G94 G64 P0.1\no1 while [1]\nG1 X100 Y50 F9000\nG1 X-100 Y-50\no1 endwhile\nM2\n"


def cutting(samples_file) -> bool:
    """Whether the recorded machine moves at more than 50 mm/s."""
    samples = recorded(samples_file)
    return len(samples) > 50 and np.linalg.norm(samples[-1] - samples[-2]) / PERIOD > 50.0


@pytest.mark.parametrize("victim", ["task", "io", "launcher"])
def test_when_a_process_dies_the_machine_stops_under_its_limits(tmp_path, victim):
    data = tmp_path / "commands.bin"
    ini = copy_mill(tmp_path, hal=hal_text(data))
    part = tmp_path / "part.ngc"
    part.write_text(PROGRAM)
    with running(ini, "--run", str(part), speed=SPEED) as run:
        wait_until(lambda: run.process.poll() is not None or (data.exists() and cutting(data)), "cutting")
        assert run.process.poll() is None, run.errors
        pid = run.process.pid if victim == "launcher" else run.pids()[victim]
        before = len(recorded(data))
        os.kill(pid, signal.SIGKILL)
        wait_until(lambda: not processes(), "the end of all processes")
        code = run.finish()
    samples = recorded(data)
    assert len(samples) > before
    assert not verify.limits_exceeded(samples, PERIOD, VELOCITY, ACCELERATION)
    assert np.linalg.norm(samples[-1] - samples[-2]) == 0.0
    assert code != 0
    if victim != "launcher":
        assert victim in run.errors
        assert len(run.errors.strip().splitlines()) == 1, run.errors
    assert traces() == []
    second = Run(ini, "--run", str(_short(tmp_path)), speed=20.0)
    assert second.finish() == 0, second.errors


@pytest.mark.parametrize("blow", [signal.SIGKILL, signal.SIGSTOP])
def test_motion_alone_notices_that_task_is_dead_or_halted(tmp_path, blow):
    """The launcher is halted and cannot help."""
    data = tmp_path / "commands.bin"
    ini = copy_mill(tmp_path, changes={HEARTBEAT: str(default_heartbeat_s())}, hal=hal_text(data))
    part = tmp_path / "part.ngc"
    part.write_text(PROGRAM)
    with running(ini, "--run", str(part), speed=SPEED) as run:
        wait_until(lambda: run.process.poll() is not None or (data.exists() and cutting(data)), "cutting")
        assert run.process.poll() is None, run.errors
        run.process.send_signal(signal.SIGSTOP)
        task = run.pids()["task"]
        os.kill(task, blow)
        before = len(recorded(data))
        wait_until(lambda: np.ptp(recorded(data)[-STILL_PERIODS:], axis=0).max() == 0.0, "standstill")
        samples = recorded(data)
        if blow == signal.SIGSTOP:
            os.kill(task, signal.SIGCONT)
        run.process.send_signal(signal.SIGCONT)
        assert run.finish() == 1
    last_moved = np.flatnonzero(np.diff(samples, axis=0).any(axis=1))[-1]
    noticed, stopping = (
        (default_heartbeat_s() + RECORDER_LAG_S) * SPEED / PERIOD,
        max(VELOCITY) / min(ACCELERATION) / PERIOD,
    )
    assert before < last_moved < before + CATCHING_UP * noticed + stopping
    assert not verify.limits_exceeded(samples, PERIOD, VELOCITY, ACCELERATION)
    assert traces() == []


def test_when_the_realtime_host_dies_the_program_ends_with_an_error(tmp_path):
    ini = copy_mill(tmp_path)
    part = tmp_path / "part.ngc"
    part.write_text(PROGRAM)
    with running(ini, "--run", str(part), speed=SPEED) as run:
        wait_until(lambda: run.process.poll() is not None or "host" in run.pids(), "the host")
        status = linuxcnc.stat()
        wait_until(lambda: run.process.poll() is not None or status.poll() or status.current_vel > 50.0, "cutting")
        assert run.process.poll() is None, run.errors
        os.kill(run.pids()["host"], signal.SIGKILL)
        assert run.finish() == 1
    assert "realtime host" in run.errors
    assert traces() == []
    second = Run(ini, "--run", str(_short(tmp_path)), speed=20.0)
    assert second.finish() == 0, second.errors


def guards() -> set[int]:
    """The launcher's guards, by their process numbers."""
    return {pid for pid, command in processes() if command.startswith("linuxcnc-guard")}


def test_a_guard_that_dies_is_replaced(tmp_path):
    ini = copy_mill(tmp_path)
    with running(ini, speed=SPEED) as run:
        run.port()
        (guard,) = guards()
        os.kill(guard, signal.SIGKILL)
        wait_until(lambda: len(guards() - {guard}) == 1, "a new guard")
        run.process.kill()
        wait_until(lambda: not processes(), "the end of all processes")
    assert traces() == []


def test_leftovers_of_a_run_whose_launcher_and_guard_were_killed_are_removed(tmp_path):
    ini = copy_mill(tmp_path)
    with running(ini, speed=SPEED) as run:
        run.port()
        launchers = [run.process.pid, *guards()]
        for pid in launchers:
            os.kill(pid, signal.SIGSTOP)
        for pid in launchers:
            os.kill(pid, signal.SIGKILL)
        run.process.wait()
        assert processes()
    second = Run(ini, "--run", str(_short(tmp_path)), speed=20.0)
    assert second.finish() == 0, second.errors
    assert "earlier run" in second.errors
    assert traces() == []


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_to_the_launcher_stops_the_machine_under_its_limits(tmp_path, number, code):
    data = tmp_path / "commands.bin"
    ini = copy_mill(tmp_path, hal=hal_text(data))
    part = tmp_path / "part.ngc"
    part.write_text(PROGRAM)
    with running(ini, "--run", str(part), speed=SPEED) as run:
        wait_until(lambda: run.process.poll() is not None or (data.exists() and cutting(data)), "cutting")
        run.process.send_signal(number)
        assert run.finish() == code
    samples = recorded(data)
    assert not verify.limits_exceeded(samples, PERIOD, VELOCITY, ACCELERATION)
    assert np.linalg.norm(samples[-1] - samples[-2]) == 0.0
    assert run.errors.strip() == f"linuxcnc: stopped by {number.name}"
    assert traces() == []


def _short(folder):
    part = folder / "short.ngc"
    part.write_text("G21 G90 G94\nG1 X5 F3000\nM2\n")
    return part


@pytest.mark.parametrize("victim", ["display", "halui"])
def test_when_a_screen_dies_everything_ends_with_an_error(tmp_path, victim):
    ini = copy_mill(tmp_path)
    ini.write_text(ini.read_text().replace("[HAL]", "[HAL]\nHALUI = halui"))
    with running(ini, speed=SPEED) as run:
        run.port()
        os.kill(run.pids()[victim], signal.SIGKILL)
        assert run.finish() != 0
    assert victim in run.errors
    assert traces() == []
