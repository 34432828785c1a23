"""The status as clients see it: attributes, their types and where they come from."""

from pathlib import Path

import pytest

import linuxcnc
from nml.channel import Channel
from nml.emc import EMC_TOOL_TABLE
from tests.support.fake_task import FakeTask


@pytest.fixture
def task():
    with FakeTask() as task:
        yield task


def test_an_attribute_shows_what_was_polled_last(task):
    status = linuxcnc.stat()
    task.status.task.mode = linuxcnc.MODE_AUTO
    task.publish()
    assert status.task_mode != linuxcnc.MODE_AUTO
    status.poll()
    assert status.task_mode == linuxcnc.MODE_AUTO


def test_every_attribute_can_be_read(task):
    status = linuxcnc.stat()
    names = [name for name in dir(status) if not name.startswith("_")]
    values = {name: getattr(status, name) for name in names}
    assert len(values) > 80
    assert all(value is not None for value in values.values())


def test_a_pose_is_nine_numbers_in_axis_order(task):
    task.status.motion.traj.position = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0)
    task.publish()
    assert linuxcnc.stat().position == (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0)


def test_joints_axes_and_spindles_are_dictionaries(task):
    task.status.motion.joint[1].homed = 1
    task.status.motion.joint[1].ferrorHighMark = 0.25
    task.status.motion.axis[2].minPositionLimit = -50.0
    task.status.motion.spindle[0].speed = 1200.0
    task.publish()
    status = linuxcnc.stat()
    assert len(status.joint) == linuxcnc.MAX_JOINTS
    assert (status.joint[1]["homed"], status.joint[1]["ferror_highmark"]) == (1, 0.25)
    assert status.homed[:3] == (0, 1, 0)
    assert status.axis[2]["min_position_limit"] == -50.0
    assert status.spindle[0]["speed"] == 1200.0


def test_limits_are_one_mask_for_each_joint(task):
    task.status.motion.joint[0].minHardLimit = 1
    task.status.motion.joint[2].maxSoftLimit = 1
    task.status.motion.joint[2].maxHardLimit = 1
    task.publish()
    assert linuxcnc.stat().limit[:3] == (1, 0, 10)


def test_the_tool_table_ends_with_the_last_used_place(task):
    table = EMC_TOOL_TABLE(last_index=1)
    table.tools[0].toolno = -1
    table.tools[1].toolno = 5
    table.tools[1].offset.tran.z = 12.5
    with Channel(None, "toolTable", "tool") as channel:
        channel.write(table)
        tools = linuxcnc.stat().tool_table
    assert [tool.id for tool in tools] == [-1, 5]
    assert tools[1].zoffset == 12.5


def test_one_tool_is_found_by_its_number(task):
    table = EMC_TOOL_TABLE(last_index=1)
    table.tools[1].toolno, table.tools[1].pocketno, table.tools[1].diameter = 5, 12, 3.5
    table.tools[1].offset.tran.z = 12.5
    table.remarks[1].text = "long drill"
    with Channel(None, "toolTable", "tool") as channel:
        channel.write(table)
        info = linuxcnc.stat().toolinfo(5)
        assert (info["toolno"], info["pocketno"], info["zoffset"], info["diameter"]) == (5, 12, 12.5, 3.5)
        assert info["comment"] == "long drill"
        with pytest.raises(linuxcnc.error, match="toolinfo\\(6\\)"):
            linuxcnc.stat().toolinfo(6)


def test_the_status_cannot_be_changed_by_a_client(task):
    with pytest.raises(AttributeError):
        linuxcnc.stat().task_mode = 3


def test_every_attribute_says_what_it_is():
    values = [value for value in vars(linuxcnc.stat).values() if hasattr(value, "path")]
    assert values
    assert all(value.__doc__ for value in values)


def test_an_operator_message_reaches_every_client(task):
    from nml.emc import EMC_OPERATOR_ERROR

    first, second = linuxcnc.error_channel(), linuxcnc.error_channel()
    task.errors.write(EMC_OPERATOR_ERROR(error="joint 1 following error"))
    assert first.poll() == (linuxcnc.OPERATOR_ERROR, "joint 1 following error")
    assert second.poll() == (linuxcnc.OPERATOR_ERROR, "joint 1 following error")
    assert first.poll() is None


def test_every_attribute_has_linuxcncs_type_and_length(task):
    """The list was printed by Debian's module on a running machine; ``-`` stands for a length that varies."""
    status = linuxcnc.stat()
    for line in Path(__file__).with_name("stat_types.txt").read_text().splitlines():
        name, kind, *length = line.split()
        value = getattr(status, name)
        assert type(value).__name__ == kind, name
        if length and length != ["-"]:
            assert len(value) == int(length[0]), name


def test_the_dictionaries_have_linuxcncs_keys(task):
    status = linuxcnc.stat()
    joint = "jointType units backlash min_position_limit max_position_limit max_ferror min_ferror ferror_current "
    joint += "ferror_highmark output input velocity inpos homing homed fault enabled min_soft_limit max_soft_limit "
    joint += "min_hard_limit max_hard_limit override_limits"
    assert set(status.joint[0]) == set(joint.split())
    assert set(status.axis[0]) == {"velocity", "min_position_limit", "max_position_limit"}
    spindle = "brake direction enabled override_enabled speed override homed orient_state orient_fault"
    assert set(status.spindle[0]) == {*spindle.split(), "increasing"}
