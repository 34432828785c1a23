"""In position means that the feedback has arrived as well: the status that says done shows the end point."""

import time

import pytest

import linuxcnc
from tests.support.desk import switched_on_and_homed
from tests.support.machine import copy_mill, running, traces

pytestmark = pytest.mark.process

MOVES = 200
ENDS = [(3.0, 0.0), (0.25, -2.0), (3.0, 1e-5), (3.0, 0.0)]  # one of them is over within a servo period


def first_done_status(status, serial):
    """Poll as fast as a status may change until the order is done, so that no later status is taken for it."""
    deadline = time.monotonic() + 60.0
    while True:
        status.poll()
        if status.echo_serial_number == serial and status.state == linuxcnc.RCS_DONE:
            return
        assert time.monotonic() < deadline, "the order is not done"
        time.sleep(0.0001)


def test_the_first_status_that_says_done_shows_the_feedback_at_the_end_point(tmp_path):
    with running(copy_mill(tmp_path), speed=4.0) as run:
        run.port()
        status, command = switched_on_and_homed()
        command.mode(linuxcnc.MODE_MDI)
        command.wait_complete()
        for n in range(MOVES):
            x, y = ENDS[n % len(ENDS)]
            command.mdi(f"G0 X{x} Y{y:.6f}")
            first_done_status(status, command.serial)
            assert status.inpos
            assert status.actual_position[:2] == pytest.approx((x, y), abs=1e-9), f"move {n}"
            assert status.joint_actual_position[:2] == pytest.approx((x, y), abs=1e-9), f"move {n}"
    assert traces() == []
