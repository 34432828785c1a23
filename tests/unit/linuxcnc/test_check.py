"""What ``linuxcnc --check`` finds in a configuration, and where."""

import re

import pytest

from linuxcnc.check import findings
from tests.support.machine import MILL, copy_mill


@pytest.mark.parametrize("units", ["mm", "inch"])
def test_our_samples_are_in_order(units):
    assert findings(MILL / f"mill_{units}.ini") == []


MISTAKES = [
    ("[TRAJ]", "[TRAJ", "no section"),
    ("[EMCIO]", "[EMCOI]", r"nobody reads section \[EMCOI\]; did you mean \[EMCIO\]\?"),
    ("SERVO_PERIOD = 1000000", "SERVOPERIOD = 1000000", r"\[EMCMOT\]SERVOPERIOD; did you mean SERVO_PERIOD\?"),
    ("HOME_SEQUENCE = 0", "HOME_SEQUENZ = 0", r"\[JOINT_2\]HOME_SEQUENZ; did you mean HOME_SEQUENCE\?"),
    ("HOME_SEQUENCE = 0", "COLOUR = 0", r"nobody reads \[JOINT_2\]COLOUR; leave it out"),
    ("CYCLE_TIME = 0.001", "CYCLE_TIME = often", r"\[TASK\]CYCLE_TIME: 'often' is not a number, at most 1"),
    ("LINEAR_UNITS = mm", "LINEAR_UNITS = furlong", r"\[TRAJ\]LINEAR_UNITS: 'furlong' is not one of mm"),
    ("COORDINATES = X Y Z", "COORDINATES = X Y Q", r"\[TRAJ\]COORDINATES: 'Q' is no axis; letters of XYZABCUVW"),
    ("COORDINATES = X Y Z", "COORDINATES = X Y", r"axis Z is not in \[TRAJ\]COORDINATES = X Y; leave the section"),
    ("JOINTS = 3", "JOINTS = 4", r"\[KINS\]JOINTS = 4, but there is no section \[JOINT_3\]; one is needed"),
    ("JOINTS = 3", "JOINTS = 2", r"\[JOINT_2\] is beyond \[KINS\]JOINTS = 2"),
    ("JOINTS = 3", "JOINTS = 2", "coordinates=XYZ is for 3 joints"),
    ("coordinates=XYZ", "coordinates=XYA", r"coordinates=XYA, but \[TRAJ\]COORDINATES = X Y Z; the same"),
    ("KINEMATICS = trivkins", "KINEMATICS = trivkin", "there is no module trivkin; did you mean trivkins"),
    ("MIN_LIMIT = -300", "MIN_LIMIT = 400", r"\[JOINT_0\]MIN_LIMIT = 400; a number below MAX_LIMIT = 300"),
    ("MAX_VELOCITY = 100", "MAX_VELOCITY = 0", r"\[AXIS_Z\]MAX_VELOCITY = 0 never moves"),
    ("[JOINT_2]", "[JOINT_2]\nHOME = 150", r"\[JOINT_2\]HOME = 150 is outside the limits; from -200 to 100"),
    ("[AXIS_Z]\n", "[AXIS_Z]\nMAX_LIMIT = 120\n", r"\[AXIS_Z\]MAX_LIMIT = 120 is more than joint 2 has; at most 100"),
    ("[JOINT_2]", "[JOINT_2]\nHOME_SEARCH_VEL = 5", r"\[JOINT_2\] searches its switch, but HOME_LATCH_VEL is 0"),
    ("MIN_FERROR = 0.1", "MIN_FERROR = 3", r"\[JOINT_0\]MIN_FERROR = 3; at most FERROR = 1 is needed"),
    ("HALFILE = mill.hal", "HALFILE = mil.hal", r"\[HAL\]HALFILE = mil.hal: no such file; one in .* is needed"),
    ("TASK = milltask", "TASK = windmill", r"\[TASK\]TASK = windmill: no such program; one of"),
    ("NML_FILE = local.nml", "NML_FILE = none.nml", r"\[EMC\]NML_FILE = none.nml: no such file; leave"),
    ("TOOL_TABLE = mill_mm.tbl", "TOOL_TABLE = none.tbl", r"\[EMCIO\]TOOL_TABLE = none.tbl: No such file"),
    ("[EMCMOT]", "[EMCMOT]\nHOMEMOD = homecomp", r"\[EMCMOT\]HOMEMOD = homecomp: no such module; use homemod"),
    ("[EMCMOT]", "[EMCMOT]\nBASE_PERIOD = 2000000", r"BASE_PERIOD = 2e\+06; at most SERVO_PERIOD = 1e\+06"),
    ("SERVO_PERIOD = 1000000", "SERVO_PERIOD = 1000", r"\[EMCMOT\]SERVO_PERIOD = 1000 ns; from 20000 to"),
    ("[JOINT_2]", "[JOINT_2]\nMAX_ACCELERATION = 60000", r"\[JOINT_2\]MAX_ACCELERATION = 60000 reaches .*; at most"),
]


@pytest.mark.parametrize(("right", "wrong", "said"), MISTAKES)
def test_a_mistake_in_the_ini_file_is_found_with_its_line(tmp_path, right, wrong, said):
    ini = copy_mill(tmp_path)
    text = ini.read_text()
    assert right in text
    ini.write_text(text.replace(right, wrong))
    found = findings(ini)
    assert any(re.match(rf"{tmp_path}/mill_mm.ini:\d+: .*{said}", line) for line in found), found


def test_the_line_is_the_right_one(tmp_path):
    ini = copy_mill(tmp_path, changes={"TASK.CYCLE_TIME": "often"})
    (line,) = findings(ini)
    assert ini.read_text().splitlines()[int(line.split(":")[1]) - 1] == "CYCLE_TIME = often"


def test_every_finding_says_what_would_be_right(tmp_path):
    ini = copy_mill(tmp_path)
    ini.write_text(ini.read_text().replace("JOINTS = 3", "JOINTS = 2").replace("[HAL]", "[HAL]\nHALFILE = none.hal"))
    found = findings(ini)
    assert len(found) >= 3
    assert all(re.fullmatch(r"\S+:\d+: .+; .+", line) for line in found)


def test_an_entry_that_a_hal_file_misses_is_found_in_the_hal_file(tmp_path):
    ini = copy_mill(tmp_path, hal="newsig a float\nsets a [JOINT_0]MAX_VELOCITI\n")
    (line,) = findings(ini)
    assert line == f"{tmp_path}/test.hal:2: [JOINT_0]MAX_VELOCITI is not in {ini}; did you mean [JOINT_0]MAX_VELOCITY?"


def test_an_entry_of_ones_own_is_fine_where_a_hal_file_uses_it(tmp_path):
    ini = copy_mill(tmp_path, hal="newsig a float\nsets a [JOINT_2]COLOUR\n")
    ini.write_text(ini.read_text().replace("[JOINT_2]", "[JOINT_2]\nCOLOUR = 3"))
    assert findings(ini) == []


@pytest.mark.parametrize(
    ("line", "said"),
    [("T9 P9 Z1.x", "'Z1.X' is no word"), ("P9 Z1", "0 tool numbers"), ("T1 P9", "T1 is in line"), ("T1 T2", "2 tool")],
)
def test_a_wrong_line_of_the_tool_table_is_found(tmp_path, line, said):
    ini = copy_mill(tmp_path)
    table = tmp_path / "mill_mm.tbl"
    table.write_text(table.read_text() + line + "\n")
    assert any(said in finding and finding.startswith(f"{table}:") for finding in findings(ini))


def test_contradictions_of_the_nml_file_are_found(tmp_path):
    ini = copy_mill(tmp_path)
    nml = tmp_path / "local.nml"
    nml.write_text(nml.read_text() + "P xemc nobuffer LOCAL localhost RW 0 10.0 0 10\n")
    assert any("nobuffer" in line and line.startswith(f"{nml}:") for line in findings(ini))


def test_a_file_that_is_not_there_is_the_only_finding(tmp_path):
    (line,) = findings(tmp_path / "none.ini")
    assert line.startswith(f"{tmp_path}/none.ini: ")
