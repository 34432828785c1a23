"""Clients see each other's commands, with who gave them."""

import os
import time

import pytest

import linuxcnc
from nml.channel import Channel
from nml.emc import EMC_JOG_CONT, EMC_ORDER_NOTE, EMC_TASK_ABORT, EMC_TASK_PLAN_EXECUTE
from nml.emc.orders import NOTE_BUFFER, ORDER_LENGTH, describe
from tests.support.fake_task import FakeTask


@pytest.fixture
def task():
    with FakeTask() as task:
        yield task


def test_every_watcher_sees_the_commands_of_every_client(task):
    watchers = [linuxcnc.order_channel(), linuxcnc.order_channel()]
    here, pendant = linuxcnc.command(), linuxcnc.command()
    pendant.origin = "pendant"
    here.mdi("G0 X1")
    pendant.abort()
    for watcher in watchers:
        first, second = watcher.poll(), watcher.poll()
        assert (first.serial, first.text) == (here.serial, "TASK_PLAN_EXECUTE command='G0 X1'")
        assert f"[{os.getpid()}]" in first.origin
        assert first.time == pytest.approx(time.time(), abs=60.0)
        assert second[:3] == (pendant.serial, "pendant", "TASK_ABORT")
        assert watcher.poll() is None


def test_a_watcher_that_comes_later_sees_what_is_still_kept_and_waits_for_more(task):
    command = linuxcnc.command()
    command.abort()
    watcher = linuxcnc.order_channel()
    assert watcher.poll().text == "TASK_ABORT"
    assert not watcher.wait(0.0)
    command.mist(1)
    assert watcher.wait(60.0)
    assert watcher.poll().text == "COOLANT_MIST_ON"


def test_watchers_that_sleep_hold_up_nobody(task):
    watcher, command = linuxcnc.order_channel(), linuxcnc.command()
    for _ in range(300):
        command.abort()
    assert len(task.taken) == 300
    seen = 0
    while watcher.poll() is not None:
        seen += 1
    assert 0 < seen < 300


@pytest.mark.parametrize(
    ("command", "text"),
    [
        (EMC_TASK_ABORT(serial_number=5), "TASK_ABORT"),
        (EMC_JOG_CONT(joint_or_axis=2, vel=-1.5, jjogmode=1), "JOG_CONT joint_or_axis=2 vel=-1.5 jjogmode=1"),
        (EMC_TASK_PLAN_EXECUTE(command="G0 X1"), "TASK_PLAN_EXECUTE command='G0 X1'"),
    ],
)
def test_a_command_is_told_in_words(command, text):
    assert describe(command) == text


def test_a_long_command_is_cut_for_those_who_watch(task):
    watcher, command = linuxcnc.order_channel(), linuxcnc.command()
    command.mdi("(" + "x" * 250 + ")")
    assert len(watcher.poll().text) == ORDER_LENGTH - 1
    assert len(task.taken[0].command) == 252


def test_a_note_of_another_kind_is_no_order(task):
    watcher = linuxcnc.order_channel()
    with Channel(None, NOTE_BUFFER, "xemc") as notes:
        notes.write(EMC_ORDER_NOTE(serial=1, origin="me", order="x"))
    assert watcher.poll() == linuxcnc.order(1, "me", "x", 0.0)
