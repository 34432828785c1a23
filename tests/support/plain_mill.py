"""A plain simulated mill of three axes in LinuxCNC's files, which Debian's LinuxCNC and ours run alike.

``stock_machine`` compares both on it, and the benchmarks measure both on it.
"""

from __future__ import annotations

from pathlib import Path

INI = """\
[EMC]
VERSION = 1.1
MACHINE = stock
DEBUG = 0
NML_FILE = {folder}/server.nml
[DISPLAY]
DISPLAY = {display}
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[RS274NGC]
PARAMETER_FILE = {folder}/stock.var
[EMCMOT]
EMCMOT = motmod
COMM_TIMEOUT = 1.0
SERVO_PERIOD = 1000000
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.1
TOOL_TABLE = {folder}/stock.tbl
[HAL]
HALFILE = {folder}/stock.hal
[TRAJ]
COORDINATES = X Y Z
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
DEFAULT_LINEAR_VELOCITY = 30
MAX_LINEAR_VELOCITY = 50
DEFAULT_LINEAR_ACCELERATION = 500
MAX_LINEAR_ACCELERATION = 500
[KINS]
KINEMATICS = trivkins
JOINTS = 3
"""
AXIS = """\
[AXIS_{letter}]
MAX_VELOCITY = 50
MAX_ACCELERATION = 500
MIN_LIMIT = -200
MAX_LIMIT = 200
[JOINT_{number}]
TYPE = LINEAR
HOME = 0
MAX_VELOCITY = 50
MAX_ACCELERATION = 500
MIN_LIMIT = -200
MAX_LIMIT = 200
FERROR = 1
MIN_FERROR = 0.5
HOME_OFFSET = 0
HOME_SEARCH_VEL = 0
HOME_LATCH_VEL = 0
HOME_SEQUENCE = {number}
"""
HAL = """\
loadrt [KINS]KINEMATICS
loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS
addf motion-command-handler servo-thread
addf motion-controller servo-thread
net x joint.0.motor-pos-cmd => joint.0.motor-pos-fb
net y joint.1.motor-pos-cmd => joint.1.motor-pos-fb
net z joint.2.motor-pos-cmd => joint.2.motor-pos-fb
net estop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
net prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared
net change iocontrol.0.tool-change => iocontrol.0.tool-changed
"""
TOOLS = "T1 P1 Z1.5 D3\n"


def write(folder: Path, display: str, changes: dict[str, str]) -> Path:
    """Write the files into ``folder``, but for the NML file; the INI file's path.

    ``display``: what [DISPLAY]DISPLAY names. ``changes``: pieces of the INI file and what stands in their place.
    """
    axes = "".join(AXIS.format(letter=letter, number=number) for number, letter in enumerate("XYZ"))
    text = INI.format(folder=folder, display=display) + axes
    for old, new in changes.items():
        assert old in text, old
        text = text.replace(old, new)
    ini = folder / "machine.ini"
    for path, content in {ini: text, "stock.hal": HAL, "stock.tbl": TOOLS, "stock.var": ""}.items():
        (folder / path).write_text(content)
    return ini
