"""The log of the tool's path."""

import threading

import pytest

import linuxcnc
from tests.support.fake_task import FakeTask
from tests.support.machine import wait_until

COLOURS = [(number, 0, 0, 255) for number in range(6)]


@pytest.fixture
def task():
    with FakeTask() as task:
        task.status.motion.traj.linearUnits = 1.0
        task.status.motion.traj.angularUnits = 1.0
        task.publish()
        yield task


@pytest.fixture
def logger(task):
    logger = linuxcnc.positionlogger(linuxcnc.stat(), *COLOURS, "XYZ")
    thread = threading.Thread(target=logger.start, args=(0.001,))
    thread.start()
    yield logger
    logger.stop()
    thread.join()


def move(task, logger, position, motion_type=linuxcnc.MOTION_TYPE_FEED, offset=(0.0,) * 9):
    """Put the machine somewhere and wait until it is logged."""
    known = logger.npts
    task.status.motion.traj.position = (*position, *[0.0] * (9 - len(position)))
    task.status.motion.traj.motion_type = motion_type
    task.status.task.toolOffset = offset
    task.publish()
    wait_until(lambda: logger.npts > known, "a new point")


def test_points_are_the_tool_tip_in_inches_and_degrees(task, logger):
    move(task, logger, (25.4, 50.8, 0.0, 90.0), offset=(0.0, 0.0, 25.4, *[0.0] * 6))
    assert logger.last() == pytest.approx((1.0, 2.0, -1.0, 90.0, 0.0, 0.0))


def test_lines_have_the_colour_of_their_motion(task, logger):
    move(task, logger, (1.0,), linuxcnc.MOTION_TYPE_TRAVERSE)
    move(task, logger, (2.0,), linuxcnc.MOTION_TYPE_ARC)
    assert [colour for _, colour in logger.points[-2:]] == [COLOURS[1], COLOURS[3]]


def test_standing_still_adds_no_points(task, logger):
    move(task, logger, (1.0,))
    move(task, logger, (2.0,))
    assert len({point for point, _ in logger.points}) == logger.npts


def test_cleared_points_are_gone(task):
    logger = linuxcnc.positionlogger(linuxcnc.stat(), *COLOURS, "XYZ")
    thread = threading.Thread(target=logger.start, args=(0.001,))
    thread.start()
    move(task, logger, (1.0,))
    logger.stop()
    thread.join()
    assert logger.npts > 0
    logger.clear()
    assert (logger.npts, logger.last()) == (0, None)


def test_drawing_is_refused(task):
    with pytest.raises(linuxcnc.error, match="OpenGL"):
        linuxcnc.positionlogger(linuxcnc.stat(), *COLOURS, "XYZ").call()
