"""The log of the tool's path."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager

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


@contextmanager
def running(logger: linuxcnc.positionlogger) -> Iterator[linuxcnc.positionlogger]:
    """The logger at work; where the machine stands at first is logged already."""
    thread = threading.Thread(target=logger.start, args=(0.001,))
    thread.start()
    try:
        wait_until(lambda: logger.npts > 0, "the first point")
        yield logger
    finally:
        logger.stop()
        thread.join()


@pytest.fixture
def logger(task):
    with running(linuxcnc.positionlogger(linuxcnc.stat(), *COLOURS, "XYZ")) as logger:
        yield logger


def move(task, logger, position, motion_type=linuxcnc.MOTION_TYPE_FEED, offset=(0.0,) * 9, straight=False):
    """Put the machine somewhere and wait until it is logged, as a new point or further on the same straight."""
    known, last = logger.npts, logger.last(0)
    task.status.motion.traj.position = (*position, *[0.0] * (9 - len(position)))
    task.status.motion.traj.motion_type = motion_type
    task.status.task.toolOffset = offset
    task.publish()
    wait_until(lambda: logger.npts > known or (straight and logger.last(0) != last), "a new point")


def test_points_are_the_tool_tip_in_machine_units_and_the_rotations(task, logger):
    move(task, logger, (25.4, 50.8, 0.0, 90.0, 10.0, 5.0), offset=(0.0, 0.0, 25.4, *[0.0] * 6))
    assert logger.last(0) == pytest.approx((25.4, 50.8, -25.4, 90.0, -10.0, 5.0))


@pytest.mark.parametrize(
    ("geometry", "is_xyuv", "point"),
    [
        ("XYZ", 0, (1, 2, 3, 4, -5, 6)),
        ("-XY-Z", 0, (-1, 2, -3, 4, -5, 6)),
        ("XYZUVW", 0, (8, 10, 12, 4, -5, 6)),
        ("AXZ", 0, (1, 0, 3, 4, -5, 6)),
        ("UVW", 0, (7, 8, 9, 4, -5, 6)),
        ("XYUV", 1, (1, 2, 0.5, 7, 8, 2.5)),
    ],
)
def test_the_geometry_makes_the_picture(task, geometry, is_xyuv, point):
    logger = linuxcnc.positionlogger(linuxcnc.stat(), *COLOURS, geometry, is_xyuv)
    logger.set_depth(0.5, 2.5)
    task.status.motion.traj.position = tuple(map(float, range(1, 10)))
    task.publish()
    with running(logger):
        assert logger.last(0) == point


def test_the_inner_points_of_a_straight_are_left_out_and_corners_kept(task, logger):
    move(task, logger, (1.0, 0.0))
    for x in (2.0, 3.0, 4.0):
        move(task, logger, (x, x - 1.0), straight=x > 2.0)
    move(task, logger, (4.0, 0.0))
    assert [point[:2] for point, _ in logger.points[-3:]] == [(1.0, 0.0), (4.0, 3.0), (4.0, 0.0)]


def test_colours_can_be_changed(task, logger):
    logger.set_colors(*COLOURS[::-1])
    assert logger.get_colors() == tuple(COLOURS[::-1])
    move(task, logger, (1.0,), linuxcnc.MOTION_TYPE_TRAVERSE)
    assert logger.points[-1][1] == COLOURS[4]


def test_lines_have_the_colour_of_their_motion(task, logger):
    move(task, logger, (1.0,), linuxcnc.MOTION_TYPE_TRAVERSE)
    move(task, logger, (2.0,), linuxcnc.MOTION_TYPE_ARC)
    assert [colour for _, colour in logger.points[-2:]] == [COLOURS[1], COLOURS[3]]


def test_standing_still_adds_no_points(task, logger):
    move(task, logger, (1.0,))
    move(task, logger, (1.0, 1.0))
    assert len({point for point, _ in logger.points}) == logger.npts


def test_cleared_points_are_gone(task):
    logger = linuxcnc.positionlogger(linuxcnc.stat(), *COLOURS, "XYZ")
    with running(logger):
        move(task, logger, (1.0,))
    assert logger.npts > 1
    logger.clear()
    assert (logger.npts, logger.last(0)) == (0, None)
