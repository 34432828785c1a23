"""A whole machine driven by its clients: the Python interface and linuxcncrsh, alone and at once."""

import subprocess
import sys

import pytest

import linuxcnc
from nml import namespace
from tests.support.desk import switched_on_and_homed
from tests.support.machine import PATIENCE, ROOT, RshClient, copy_mill, running, traces, wait_until

pytestmark = pytest.mark.process


@pytest.fixture
def mill(tmp_path):
    """A mill that is up; its linuxcncrsh listens on ``mill.port()``."""
    with running(copy_mill(tmp_path), speed=10.0) as run:
        run.port()
        yield run
    assert traces() == []


def test_a_machine_goes_through_its_states(mill):
    status, command = linuxcnc.stat(), linuxcnc.command()
    assert (status.task_state, status.estop) == (linuxcnc.STATE_ESTOP, 1)
    command.state(linuxcnc.STATE_ESTOP_RESET)
    wait_until(lambda: status.poll() or (status.task_state, status.estop) == (linuxcnc.STATE_ESTOP_RESET, 0), "reset")
    command.state(linuxcnc.STATE_ON)
    wait_until(lambda: status.poll() or status.enabled, "on")
    command.state(linuxcnc.STATE_ESTOP)
    wait_until(lambda: status.poll() or (status.estop and not status.enabled), "E-stop")


def test_mdi_moves_the_machine_and_is_done_when_it_says_so(mill):
    status, command = switched_on_and_homed()
    command.mode(linuxcnc.MODE_MDI)
    command.wait_complete()
    command.mdi("G21 G90 G0 X10 Y-5 Z2")
    assert command.wait_complete(PATIENCE) == linuxcnc.RCS_DONE
    status.poll()
    assert status.position[:3] == pytest.approx((10.0, -5.0, 2.0))
    for number in range(50):
        command.mdi(f"G0 X{number % 2}")
        assert command.wait_complete(PATIENCE) == linuxcnc.RCS_DONE
        status.poll()
        assert status.position[0] == pytest.approx(number % 2)


def test_jogging_moves_a_joint_by_the_increment(mill):
    status, command = switched_on_and_homed()
    command.mode(linuxcnc.MODE_MANUAL)
    command.teleop_enable(0)
    wait_until(lambda: status.poll() or status.motion_mode == linuxcnc.TRAJ_MODE_FREE, "free mode")
    command.jog(linuxcnc.JOG_INCREMENT, True, 1, 20.0, 3.0)
    wait_until(lambda: status.poll() or abs(status.joint_position[1] - 3.0) < 1e-9, "increment")
    command.jog(linuxcnc.JOG_CONTINUOUS, True, 0, -10.0)
    wait_until(lambda: status.poll() or status.joint_position[0] < -1.0, "jog")
    command.jog(linuxcnc.JOG_STOP, True, 0)
    wait_until(lambda: status.poll() or status.inpos, "stop")


def test_a_program_is_paused_stepped_resumed_and_aborted(mill, tmp_path):
    status, command = switched_on_and_homed()
    part = tmp_path / "part.ngc"
    part.write_text("G21 G90 G94 G61\n" + "\n".join(f"G1 X{x} F60" for x in range(1, 200)) + "\nM2\n")
    command.mode(linuxcnc.MODE_AUTO)
    command.wait_complete()
    command.program_open(str(part))
    command.auto(linuxcnc.AUTO_RUN, 0)
    wait_until(lambda: status.poll() or status.motion_line > 5, "line 5")
    command.auto(linuxcnc.AUTO_PAUSE)
    wait_until(lambda: status.poll() or (status.paused and status.current_vel == 0.0), "pause")
    line = status.motion_line
    command.auto(linuxcnc.AUTO_STEP)
    wait_until(lambda: status.poll() or (status.motion_line > line and status.current_vel == 0.0), "step")
    assert status.motion_line <= line + 2
    command.auto(linuxcnc.AUTO_RESUME)
    wait_until(lambda: status.poll() or status.motion_line > line + 5, "resume")
    command.abort()
    wait_until(lambda: status.poll() or (status.interp_state == linuxcnc.INTERP_IDLE and status.inpos), "abort")
    assert status.position[0] < 199.0


def test_the_feed_override_scales_the_feed(mill):
    status, command = switched_on_and_homed()
    command.mode(linuxcnc.MODE_MDI)
    command.wait_complete()
    command.feedrate(0.5)
    command.mdi("G21 G90 G94 G1 X100 F60")
    wait_until(lambda: status.poll() or status.current_vel == pytest.approx(0.5, abs=1e-4), "half the feed")
    command.feedrate(1.0)
    wait_until(lambda: status.poll() or status.current_vel == pytest.approx(1.0, abs=1e-4), "full feed")
    command.abort()
    command.wait_complete()


def test_a_refused_command_comes_with_its_message(mill):
    command, errors = linuxcnc.command(), linuxcnc.error_channel()
    command.mode(linuxcnc.MODE_MDI)
    command.mdi("G0 X1")
    assert command.wait_complete(PATIENCE) == linuxcnc.RCS_ERROR
    wait_until(lambda: errors.wait(0.0), "message")
    kind, text = errors.poll()
    assert kind == linuxcnc.OPERATOR_ERROR
    assert text


def test_the_main_job_over_linuxcncrsh(mill, tmp_path):
    part = tmp_path / "part.ngc"
    part.write_text("G21 G90 G94\nG1 X12.5 F3000\nG1 Y-7\nM2\n")
    with RshClient(mill.port()) as client:
        client.take_control()
        for line in ("set estop off", "set machine on", "set wait_mode done", "set mode manual", "set home -1"):
            assert client.ask(line) == f"SET {line.split()[1].upper()} ACK"
        wait_until(lambda: client.ask("get joint_homed").startswith("JOINT_HOMED YES YES YES"), "home")
        assert client.ask("set mode auto") == "SET MODE ACK"
        assert client.ask(f"set open {part}") == "SET OPEN ACK"
        assert client.ask("get program") == f"PROGRAM {part}"
        assert client.ask("set run") == "SET RUN ACK"
        assert client.ask("get program_status") == "PROGRAM_STATUS IDLE"
        end = pytest.approx([12.5, -7.0, 0.0], abs=1e-6)
        wait_until(lambda: [float(word) for word in client.ask("get abs_act_pos").split()[1:4]] == end, "at the end")
        assert client.ask("get error") == "ERROR OK"


def test_shutdown_over_linuxcncrsh_ends_the_machine(tmp_path):
    with running(copy_mill(tmp_path), speed=10.0) as run, RshClient(run.port()) as client:
        client.take_control()
        client.send("shutdown")
        assert run.finish() == 0
    assert traces() == []


def test_clients_of_linuxcncrsh_do_not_disturb_each_other(mill):
    port = mill.port()
    with RshClient(port) as slow, RshClient(port) as rude, RshClient(port) as good:
        slow.send("hello EMC slow 1.0\r\n" + "help get\r\n" * 3000)  # never reads the answers
        rude.socket.sendall(bytes(range(256)) * 16 + b"x" * 1_000_000)
        good.take_control()
        assert good.ask("get estop") == "ESTOP ON"
        assert good.ask("set estop off") == "SET ESTOP ACK"
        wait_until(lambda: good.ask("get estop") == "ESTOP OFF", "E-stop reset")


def test_a_client_that_dies_in_the_middle_of_a_line_gives_no_order(mill):
    with RshClient(mill.port()) as client:
        client.take_control()
        client.socket.sendall(b"set estop off")
    with RshClient(mill.port()) as client:
        client.take_control()
        assert client.ask("get estop") == "ESTOP ON"


def test_two_machines_run_side_by_side(tmp_path, monkeypatch):
    folders = [tmp_path / "a", tmp_path / "b"]
    names = [f"{namespace.namespace()}a", f"{namespace.namespace()}b"]
    runs = []
    try:
        for folder, name in zip(folders, names, strict=True):
            folder.mkdir()
            monkeypatch.setenv(namespace.VARIABLE, name)
            runs.append(running(copy_mill(folder), speed=10.0))
            runs[-1].__enter__().port()
        for name, target in zip(names, (5.0, 7.0), strict=True):
            monkeypatch.setenv(namespace.VARIABLE, name)
            _, command = switched_on_and_homed()
            command.mode(linuxcnc.MODE_MDI)
            command.mdi(f"G21 G90 G0 X{target}")
            assert command.wait_complete(PATIENCE) == linuxcnc.RCS_DONE
        for name, target in zip(names, (5.0, 7.0), strict=True):
            monkeypatch.setenv(namespace.VARIABLE, name)
            assert linuxcnc.stat().position[0] == pytest.approx(target)
    finally:
        for run, name in zip(runs, names, strict=False):
            monkeypatch.setenv(namespace.VARIABLE, name)
            run.__exit__(None, None, None)
            assert traces() == []


def test_the_manuals_status_script_prints_every_attribute(mill):
    script = (
        "import linuxcnc\ns = linuxcnc.stat()\ns.poll()\n"
        "for x in dir(s):\n    if not x.startswith('_'):\n        print(x, getattr(s, x))\n"
    )
    result = subprocess.run(
        [sys.executable, "-c", script], cwd=ROOT, check=True, capture_output=True, text=True
    )
    assert "task_state" in result.stdout
