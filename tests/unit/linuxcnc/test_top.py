"""The status screen in the terminal."""

import io

import pytest
from rich.console import Console as Terminal

import linuxcnc
from linuxcnc import top
from linuxcnc.ctl import NO_MACHINE, Console
from tests.support.fake_task import FakeTask


@pytest.fixture
def task():
    with FakeTask() as task:
        task.status.task.ini_filename = "/machine.ini"
        task.status.task.state = linuxcnc.STATE_ON
        task.status.task.mode = linuxcnc.MODE_AUTO
        task.status.task.interpState = linuxcnc.INTERP_PAUSED
        task.status.task.file = "/parts/part.ngc"
        task.status.task.motionLine = 42
        task.status.task.g5x_offset = (100.0, *[0.0] * 8)
        traj = task.status.motion.traj
        traj.axis_mask, traj.joints, traj.spindles = 0b101, 2, 1
        traj.actualPosition = (123.5, 0.0, -7.25, *[0.0] * 6)
        traj.scale, traj.rapid_scale, traj.current_vel = 0.5, 1.0, 2.0
        task.status.motion.joint[0].homed = 1
        task.status.motion.spindle[0].speed = 1200.0
        task.status.motion.spindle[0].spindle_scale = 0.9
        task.status.io.tool.toolInSpindle = 7
        task.publish()
        yield task


def test_one_frame_shows_the_machine(task, capsys):
    assert top.main(["--once"]) == 0
    words = capsys.readouterr().out.split()
    text = " ".join(words)
    assert "on auto, paused /parts/part.ngc, line 42" in text
    assert "X 23.5000 123.5000 0.0000" in text
    assert "Z -7.2500 -7.2500 0.0000" in text
    assert "Y" not in words
    assert "homed 1 of 2 joints" in text
    assert "speed 120.0 /min" in text
    assert "feed 50%, rapids 100%" in text
    assert "spindle 0 1200 rpm at 90%" in text
    assert "tool T7" in text
    assert "coolant off" in text


def test_orders_and_messages_stand_below(task):
    console = Console()
    console.status.poll()
    terminal = Terminal(width=80, record=True, file=io.StringIO())
    messages = [(linuxcnc.OPERATOR_ERROR, "joint 0 following error"), (12, "coolant is low")]
    terminal.print(top.frame(console, messages, [linuxcnc.order(7, "halui", "COOLANT_FLOOD_ON", 0.0)]))
    shown = terminal.export_text().rstrip().splitlines()
    assert shown[-3:] == ["halui: COOLANT_FLOOD_ON", "error: joint 0 following error", "text: coolant is low"]


def test_without_a_machine_one_line_says_so(capsys):
    assert top.main(["--once"]) == NO_MACHINE
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_the_work_position_is_turned_with_the_coordinate_system(task, capsys):
    task.status.task.rotation_xy = 90.0
    task.status.task.g92_offset = (1.0, *[0.0] * 8)
    task.status.motion.traj.axis_mask = 0b111
    task.publish()
    assert top.main(["--once"]) == 0
    text = " ".join(capsys.readouterr().out.split())
    assert "X -1.0000 123.5000 0.0000" in text
    assert "Y -23.5000 0.0000 0.0000" in text
