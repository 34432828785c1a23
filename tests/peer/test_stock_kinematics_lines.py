"""The kinematics of every sample configuration that comes with LinuxCNC load, with the arguments written there."""

from __future__ import annotations

from pathlib import Path

import pytest

from hal.realtime import Host
from nml.errors import ConfigError
from nml.inifile import IniFile

SAMPLES = Path("/usr/share/doc/linuxcnc/examples/sample-configs")

pytestmark = [
    pytest.mark.peer,
    pytest.mark.skipif(not SAMPLES.is_dir(), reason="LinuxCNC's sample configurations are not installed"),
]
WRONG = ("trivkins coordinates=xyza kinematics=BOTH",)  # there is no such argument, LinuxCNC refuses it too


def lines_of_samples() -> dict[tuple[str, int], str]:
    """[KINS]KINEMATICS and JOINTS of all samples, each pair with one file that has it."""
    found = {}
    for path in sorted(SAMPLES.rglob("*.ini")):
        try:
            ini = IniFile(path)
        except (ConfigError, OSError):
            continue  # pieces that are included by others
        kinematics = ini.find("KINS", "KINEMATICS")
        joints = ini.find("KINS", "JOINTS", "")
        if kinematics and kinematics not in WRONG and joints and joints.isdigit():
            found[kinematics, int(joints)] = str(path.relative_to(SAMPLES))
    return found


LINES = lines_of_samples() if SAMPLES.is_dir() else {}


@pytest.mark.parametrize(("kinematics", "joints"), sorted(LINES))
def test_the_kinematics_of_a_sample_loads_with_motion(kinematics: str, joints: int) -> None:
    name, *arguments = kinematics.split()
    host = Host()
    try:
        host.load(name, arguments)
        host.load("motmod", [f"num_joints={joints}"])
    finally:
        host.close()


def test_the_samples_have_all_kinds_of_kinematics() -> None:
    names = {kinematics.split()[0] for kinematics, _ in LINES}
    assert {"genhexkins", "pumakins", "5axiskins", "xyzac-trt-kins", "millturn", "scorbot-kins"} <= names
