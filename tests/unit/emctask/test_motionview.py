"""What EMC_STAT says of motion: joints and spindles that the machine has, and those that it has not."""

from emctask.config import read_config
from emctask.motionview import MotionView
from nml.emc import EMC_STAT
from nml.emc.emcmot import EMCMOT_STATUS, MAX_JOINTS, MAX_SPINDLES
from nml.inifile import IniFile

INI = "[TRAJ]\nCOORDINATES = X Y Z\nLINEAR_UNITS = inch\n[KINS]\nJOINTS = 3\n"


def filled(tmp_path):
    """The status of a machine of three joints whose motion has told nothing but zeros."""
    path = tmp_path / "test.ini"
    path.write_text(INI)
    stat = EMC_STAT()
    MotionView(read_config(IniFile(path)), stat).fill(bytearray(EMCMOT_STATUS().data))
    return stat


def test_a_joint_that_the_machine_does_not_have_is_linear_at_rest_and_has_limits_of_one_unit(tmp_path):
    stat = filled(tmp_path)
    for number in range(3, MAX_JOINTS):
        joint = stat.motion.joint[number]
        assert (joint.jointType, joint.units, joint.inpos) == (1, 1.0, 1)
        assert (joint.minPositionLimit, joint.maxPositionLimit) == (-1.0, 1.0)
        assert (joint.maxFerror, joint.minFerror) == (1.0, 1.0)


def test_a_joint_of_the_machine_shows_what_motion_tells(tmp_path):
    joint = filled(tmp_path).motion.joint[2]
    assert (joint.joint, joint.jointType, joint.units) == (2, 1, 1 / 25.4)
    assert (joint.maxPositionLimit, joint.maxFerror, joint.inpos) == (0.0, 0.0, 0)


def test_a_spindle_that_the_machine_does_not_have_is_braked_and_not_overridden(tmp_path):
    stat = filled(tmp_path)
    for number in range(1, MAX_SPINDLES):
        spindle = stat.motion.spindle[number]
        assert (spindle.brake, spindle.spindle_scale, spindle.speed, spindle.enabled) == (1, 1.0, 0.0, 0)
