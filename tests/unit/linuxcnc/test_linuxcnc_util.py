"""The helpers for scripts that drive a machine."""

import pytest

import linuxcnc
import linuxcnc_util
from tests.support.fake_task import FakeTask


def answer(command, status):
    if type(command).__name__ == "EMC_JOG_INCR":
        pose = status.motion.traj.position
        x = pose.tran.x + (command.incr if command.vel > 0 else -command.incr)
        status.motion.traj.position = (x, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    return linuxcnc.RCS_DONE


@pytest.fixture
def task():
    with FakeTask(answer) as task:
        yield task


def test_the_start_is_over_when_the_status_is_filled(task):
    machine = linuxcnc_util.LinuxCNC()
    with pytest.raises(RuntimeError, match="start of the machine"):
        machine.wait_for_linuxcnc_startup(timeout=0.05)
    traj = task.status.motion.traj
    traj.axis_mask, traj.cycleTime, traj.linearUnits, traj.angularUnits = 7, 0.001, 1.0, 1.0
    traj.maxVelocity, traj.maxAcceleration, traj.rapid_scale, traj.inpos = 100.0, 1000.0, 1.0, True
    task.status.task.programUnits = 2
    task.status.task.execState, task.status.task.interpState = linuxcnc.EXEC_DONE, linuxcnc.INTERP_IDLE
    task.publish()
    machine.wait_for_linuxcnc_startup()


def test_only_the_named_joints_must_be_homed(task):
    task.status.motion.joint[0].homed = task.status.motion.joint[2].homed = 1
    task.publish()
    machine = linuxcnc_util.LinuxCNC()
    machine.wait_for_home([1, 0, 1])
    with pytest.raises(linuxcnc_util.LinuxCNC_Exception):
        machine.wait_for_home([1, 1, 1], timeout=0.05)


def test_a_jog_goes_to_the_position_and_waits_there(task):
    machine = linuxcnc_util.LinuxCNC()
    machine.jog_axis("x", 3.0)
    machine.jog_axis("X", 1.0, vel=2.0)
    assert [(jog.vel, jog.incr) for jog in task.taken] == [(5.0, 3.0), (-2.0, 2.0)]
    machine.wait_for_axis_to_stop("x")


def test_a_tool_that_does_not_come_is_named(task):
    with pytest.raises(linuxcnc_util.LinuxCNC_Exception, match="tool 7"):
        linuxcnc_util.LinuxCNC().wait_for_tool_in_spindle(7, timeout=0.05)
