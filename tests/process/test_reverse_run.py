"""A client runs a program of a whole machine backwards to its start, and forwards to its end."""

import pytest

import linuxcnc
from tests.support.desk import switched_on_and_homed
from tests.support.machine import copy_mill, running, traces, wait_until

pytestmark = pytest.mark.process


def pause(status, command):
    command.auto(linuxcnc.AUTO_PAUSE)
    wait_until(lambda: status.poll() or (status.paused and status.current_vel == 0.0), "rest")


def test_a_paused_program_is_run_back_to_its_start_and_on_to_its_end(tmp_path):
    part = tmp_path / "part.ngc"
    part.write_text("G21 G90 G94 G64 P0.01 F300\nG1 X5\nG1 Y100\nG2 X-95 Y0 I-100 F6000\nG1 X20\nM2\n")
    with running(copy_mill(tmp_path), speed=4.0) as run:
        run.port()
        status, command = switched_on_and_homed()
        command.mode(linuxcnc.MODE_AUTO)
        command.wait_complete()
        command.program_open(str(part))
        command.auto(linuxcnc.AUTO_RUN, 0)
        wait_until(lambda: status.poll() or status.position[1] > 2.0, "second move")
        pause(status, command)
        command.auto(linuxcnc.AUTO_REVERSE)
        command.auto(linuxcnc.AUTO_RESUME)
        wait_until(lambda: status.poll() or status.position[:2] == (0.0, 0.0), "start")
        pause(status, command)
        command.auto(linuxcnc.AUTO_FORWARD)
        command.auto(linuxcnc.AUTO_RESUME)
        wait_until(lambda: status.poll() or status.interp_state == linuxcnc.INTERP_IDLE, "end")
        status.poll()
        assert status.position[:2] == pytest.approx((20.0, 0.0), abs=1e-9)
    assert traces() == []
