"""What reaches the graphics card; beside LinuxCNC's module: tests/peer/test_drawing_against_linuxcnc.py."""

from __future__ import annotations

import shutil

import pytest

import linuxcnc
from tests.support.fake_task import FakeTask
from tests.support.opengl import drawn, recorder

pytestmark = pytest.mark.skipif(shutil.which("gcc") is None, reason="there is no compiler for the recorder")

ORIGIN = (0.0,) * 9
LOGGER = """
import linuxcnc, threading, time
logger = linuxcnc.positionlogger(linuxcnc.stat(), *[(number, 0, 0, 255) for number in range(6)], "XYZ", {foam})
print(logger.last(), flush=True)
threading.Thread(target=logger.start, args=(0.001,), daemon=True).start()
while not logger.npts: time.sleep(0.001)
logger.call()
print(logger.last(), flush=True)
logger.stop()
"""


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return recorder(tmp_path_factory.mktemp("opengl"))


@pytest.fixture
def task():
    with FakeTask() as task:
        task.status.motion.traj.position = (1.0, 2.0, 3.0, *(0.0,) * 3, 7.0, 8.0, 9.0)
        task.status.motion.traj.motion_type = linuxcnc.MOTION_TYPE_FEED
        task.publish()
        yield task


def at(*place: float) -> str:
    return "vertex " + " ".join(f"{value:.6f}" for value in place)


def test_moves_that_follow_each_other_are_one_strip(library):
    one, two = (1.0, *ORIGIN[1:]), (1.0, 2.0, *ORIGIN[2:])
    lines = [(5, ORIGIN, one, 600.0), (5, one, two, 600.0), (6, ORIGIN, two, 600.0)]
    script = f"import linuxcnc; linuxcnc.draw_lines('XYZ', {lines}, {{}})"
    strips = ["begin 3", at(0, 0, 0), at(1, 0, 0), at(1, 2, 0), "end", "begin 3", at(0, 0, 0), at(1, 2, 0), "end"]
    assert drawn(library, script.format(0)) == strips
    assert drawn(library, script.format(1)) == ["name 5", *strips[:5], "name 6", *strips[5:]]


def test_what_is_begun_is_ended_when_a_move_is_wrong(library):
    moves = [(5, ORIGIN, (1.0, *ORIGIN[1:])), (6, ORIGIN, (1.0, 2.0))]
    script = f"""
import linuxcnc
try: linuxcnc.draw_lines("XYZ", {moves}, 0)
except TypeError as problem: print(problem, flush=True)
"""
    assert drawn(library, script) == [
        "begin 3", at(0, 0, 0), at(1, 0, 0), "end", "a point has 9 numbers, not 2",
    ]  # fmt: skip


def test_rotary_axes_turn_the_picture_about_the_work_offset_where_they_are_asked_to():
    point = (1.0, 2.0, 3.0, 90.0, *ORIGIN[4:])
    assert linuxcnc.vertex9("XYZA", point) == (1.0, 2.0, 3.0)
    linuxcnc.gui_rot_offsets(0.0, 1.0, 1.0)
    linuxcnc.gui_respect_offsets("XYZA", 1)
    assert linuxcnc.vertex9("XYZA", point) == pytest.approx((1.0, -2.0, 1.0))
    linuxcnc.gui_respect_offsets("XYZA", 0)
    assert linuxcnc.vertex9("XYZA", point) == pytest.approx((1.0, -3.0, 2.0))
    assert linuxcnc.vertex9("-XUZ", point) == (-1.0, 0.0, 3.0)


STRIP = ["places 3 1406 32", "colours 4 1401 32", "enable 8076", "enable 8074", "draw 3 0 1", "  1 2 3  2 0 0 255"]
PAIRS = ["places 3 1406 16", "colours 4 1401 16", "enable 8076", "enable 8074", "draw 1 0 2", "  1 2 0  2 0 0 255"]


@pytest.mark.parametrize(
    ("foam", "calls", "last"),
    [
        (0, STRIP, "(1.0, 2.0, 3.0, 0.0, -0.0, 0.0)"),
        (1, [*PAIRS, "  7 8 1.5  2 0 0 255"], "(1.0, 2.0, 0.0, 7.0, 8.0, 1.5)"),
    ],
)
def test_the_log_of_the_path_is_drawn_and_says_where_the_drawing_ends(library, task, foam, calls, last):
    assert drawn(library, LOGGER.format(foam=foam)) == ["None", *calls, last]
