"""What task reads from the INI file: LinuxCNC's defaults, and one line for what cannot be."""

import math

import pytest

from emctask.compensation import read_compensation
from emctask.config import HOME_ABSOLUTE_ENCODER, HOME_NO_REHOME, HOME_USE_INDEX, UNLIMITED, read_config
from emctask.positionfile import restore
from nml.emc.emcmot import MotCommand
from nml.errors import ConfigError
from nml.inifile import IniFile

LEAST = "[TRAJ]\nCOORDINATES = X Y Y Z A\nLINEAR_UNITS = mm\n[KINS]\nJOINTS = 5\n"


def config(tmp_path, text):
    path = tmp_path / "test.ini"
    path.write_text(text)
    return read_config(IniFile(path))


def test_a_short_ini_file_gets_linuxcncs_defaults(tmp_path):
    machine = config(tmp_path, LEAST)
    assert machine.axis_mask == 0b1111
    assert sorted(machine.axes) == [0, 1, 2, 3]
    joint = machine.joints[0]
    assert (joint.max_velocity, joint.max_acceleration, joint.ferror, joint.min_ferror) == (1.0, 1.0, 1.0, 1.0)
    assert (joint.min_limit, joint.max_limit, joint.home_sequence, joint.home_final_vel) == (-1e99, 1e99, 999, -1.0)
    assert (machine.max_feed_override, machine.max_velocity, len(machine.spindles)) == (1.0, UNLIMITED, 1)
    assert machine.cycle_s == 0.01


def test_units_may_be_named_in_linuxcncs_ways(tmp_path):
    machine = config(tmp_path, LEAST.replace("mm", "inch") + "[JOINT_4]\nTYPE = ANGULAR\n")
    assert machine.length_units == pytest.approx(1 / 25.4)
    machine = config(tmp_path, LEAST.replace("LINEAR_UNITS", "ANGULAR_UNITS = rad\nLINEAR_UNITS"))
    assert machine.angle_units == pytest.approx(math.pi / 180)


def test_homing_switches_become_the_bits_that_motion_knows(tmp_path):
    machine = config(tmp_path, LEAST + "[JOINT_0]\nHOME_USE_INDEX = YES\nHOME_ABSOLUTE_ENCODER = 1\n")
    assert machine.joints[0].home_flags == HOME_USE_INDEX | HOME_ABSOLUTE_ENCODER | HOME_NO_REHOME


@pytest.mark.parametrize(
    ("lines", "complaint"),
    [
        ("[JOINT_1]\nMAX_VELOCITY = fast\n", ":7: [JOINT_1]MAX_VELOCITY: 'fast' is not a number"),
        ("[JOINT_1]\nMAX_VELOCITY = 0\n", ":7: [JOINT_1]MAX_VELOCITY: 0 would never move"),
        ("[AXIS_X]\nMIN_LIMIT = 5\nMAX_LIMIT = 1\n", ":7: [AXIS_X]MIN_LIMIT: 5 is not below MAX_LIMIT = 1"),
        ("[EMCIO]\nTOOL_CHANGE_POSITION = 1 2\n", ":7: [EMCIO]TOOL_CHANGE_POSITION: 2 numbers; 0, 3, 6, 9 are allowed"),
        ("[EMCIO]\nTOOL_CHANGE_POSITION = 1 2 z\n", "TOOL_CHANGE_POSITION: '1 2 z': up to nine numbers are needed"),
        ("[JOINT_1]\nTYPE = ROUND\n", ":7: [JOINT_1]TYPE: 'ROUND' is not one of LINEAR, ANGULAR"),
    ],
)
def test_a_wrong_value_is_named_with_its_line_and_what_would_be_right(tmp_path, lines, complaint):
    with pytest.raises(ConfigError) as caught:
        config(tmp_path, LEAST + lines)
    assert complaint in str(caught.value)


def test_an_unknown_axis_letter_is_refused(tmp_path):
    with pytest.raises(ConfigError, match="'Q' is no axis"):
        config(tmp_path, LEAST.replace("X Y Y Z A", "XQ"))


def test_measured_positions_of_a_screw_become_corrections(tmp_path):
    path = tmp_path / "x.comp"
    path.write_text("# nominal forward reverse\n-1 -1.005 -0.995\n0 0.002 -0.003\n")
    assert read_compensation(path, 0)[0] == pytest.approx((-1.0, 0.005, -0.005))
    assert read_compensation(path, 1)[1] == (0.0, 0.002, -0.003)


def test_a_compensation_file_that_does_not_rise_is_refused_with_its_line(tmp_path):
    path = tmp_path / "x.comp"
    path.write_text("0 0 0\n0 1 1\n")
    with pytest.raises(ConfigError, match=r"x\.comp:2: 0 does not rise"):
        read_compensation(path, 0)


class Motion:
    """Motion as far as the position file goes."""

    def __init__(self):
        self.sent = []

    def send(self, command, *, joint, motor_offset):
        assert command is MotCommand.SET_JOINT_MOTOR_OFFSET
        self.sent.append((joint, motor_offset))


def test_a_position_file_with_words_is_refused_with_its_line(tmp_path):
    path = tmp_path / "position.txt"
    path.write_text("1.5\nhere\n")
    with pytest.raises(ConfigError, match=r"position\.txt:2: 'here': one number"):
        restore(path, Motion(), 3)


def test_a_position_file_comes_back_as_motor_offsets_of_the_joints_there_are(tmp_path):
    path = tmp_path / "position.txt"
    path.write_text("1.5\n-2.25\n0\n7\n")
    motion = Motion()
    restore(path, motion, 2)
    restore(tmp_path / "none.txt", motion, 2)
    assert motion.sent == [(0, -1.5), (1, 2.25)]
