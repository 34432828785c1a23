"""Each command in each mode and state: taken or refused, and a refused one does no harm."""

from __future__ import annotations

import math
import random

import pytest

from emcmot.commands import COMMANDS
from emcmot.sim import Motion
from nml.emc.emcmot import EMCMOT_COMMAND, MotCommand, MotCommandStatus
from tests.support.mill import configure, mill

STATES = ("off", "free", "homed", "teleop", "coord")
OK, UNKNOWN, INVALID, PARAMS = 0, 1, 2, 3

MOVE = {"id": 7, "pos": (1, 2, 3, 0, 0, 0, 0, 0, 0), "vel": 10.0, "ini_maxvel": 50.0, "acc": 500.0, "termCond": 2}
# command: (fields that make sense, the states in which it is taken)
EXPECTED = {
    "ABORT": ({}, STATES),
    "ENABLE": ({}, STATES),
    "DISABLE": ({}, STATES),
    "PAUSE": ({}, STATES),
    "REVERSE": ({}, ()),
    "FORWARD": ({}, STATES),
    "RESUME": ({}, STATES),
    "STEP": ({}, STATES),
    "FREE": ({}, STATES),
    "COORD": ({}, STATES),
    "TELEOP": ({}, STATES),
    "SPINDLE_SCALE": ({"scale": 0.5}, STATES),
    "SS_ENABLE": ({"mode": 1}, STATES),
    "FEED_SCALE": ({"scale": 0.5}, STATES),
    "RAPID_SCALE": ({"scale": 0.5}, STATES),
    "FS_ENABLE": ({"mode": 1}, STATES),
    "FH_ENABLE": ({"mode": 1}, STATES),
    "AF_ENABLE": ({"mode": 1}, STATES),
    "OVERRIDE_LIMITS": ({}, STATES),
    "SET_LINE": (MOVE | {"motion_type": 2}, ("coord",)),
    "SET_CIRCLE": (
        MOVE | {"pos": (2, 0, 0, 0, 0, 0, 0, 0, 0), "center": (1, 0, 0), "normal": (0, 0, 1), "motion_type": 3},
        ("coord",),
    ),
    "SET_TELEOP_VECTOR": ({"pos": (1, 0, 0, 0, 0, 0, 0, 0, 0)}, ("teleop",)),
    "CLEAR_PROBE_FLAGS": ({}, STATES),
    "PROBE": (MOVE, ("coord",)),
    "SET_VEL": ({"vel": 5.0, "ini_maxvel": 50.0}, STATES),
    "SET_VEL_LIMIT": ({"vel": 80.0}, STATES),
    "SET_ACC": ({"acc": 500.0}, STATES),
    "SET_TERM_COND": ({"termCond": 2, "tolerance": 0.1}, STATES),
    "SET_NUM_JOINTS": ({"joint": 3}, ("off",)),
    "SET_NUM_SPINDLES": ({"spindle": 1}, STATES),
    "SET_WORLD_HOME": ({}, STATES),
    "SET_DEBUG": ({}, STATES),
    "SET_DOUT": ({"now": 1, "out": 1, "start": 1}, STATES),
    "SET_AOUT": ({"now": 1, "out": 1, "minLimit": 2.5}, STATES),
    "SET_SPINDLESYNC": ({"spindlesync": 1.0}, STATES),
    "SPINDLE_ON": ({"vel": 600.0}, STATES),
    "SPINDLE_OFF": ({}, STATES),
    "SPINDLE_INCREASE": ({}, STATES),
    "SPINDLE_DECREASE": ({}, STATES),
    "SPINDLE_BRAKE_ENGAGE": ({}, STATES),
    "SPINDLE_BRAKE_RELEASE": ({}, STATES),
    "SPINDLE_ORIENT": ({"orientation": 90.0, "timeout": 1.0}, STATES),
    "SET_OFFSET": ({"tool_offset": (0, 0, 5, 0, 0, 0, 0, 0, 0)}, STATES),
    "SET_MAX_FEED_OVERRIDE": ({"scale": 1.5}, STATES),
    "SETUP_ARC_BLENDS": ({}, STATES),
    "SET_PROBE_ERR_INHIBIT": ({"flags": 3}, STATES),
    "ENABLE_WATCHDOG": ({}, STATES),
    "DISABLE_WATCHDOG": ({}, STATES),
    "JOG_CONT": ({"mode": 1, "vel": 10.0}, ("free", "homed")),
    "JOG_INCR": ({"mode": 1, "vel": 10.0, "offset": 1.0}, ("free", "homed")),
    "JOG_ABS": ({"mode": 1, "vel": 10.0, "offset": 1.0}, ("free", "homed")),
    "JOG_ABORT": ({"mode": 1}, STATES),
    "JOINT_ACTIVATE": ({}, STATES),
    "JOINT_DEACTIVATE": ({}, STATES),
    "JOINT_ENABLE_AMPLIFIER": ({}, STATES),
    "JOINT_DISABLE_AMPLIFIER": ({}, STATES),
    "JOINT_HOME": ({"joint": -1}, ("free", "homed")),
    "JOINT_UNHOME": ({"joint": -1}, ("off", "free", "homed")),
    "SET_JOINT_POSITION_LIMITS": ({"minLimit": -50.0, "maxLimit": 50.0}, STATES),
    "SET_JOINT_BACKLASH": ({"backlash": 0.01}, STATES),
    "SET_JOINT_MIN_FERROR": ({"minFerror": 0.1}, STATES),
    "SET_JOINT_MAX_FERROR": ({"maxFerror": 0.1}, STATES),
    "SET_JOINT_VEL_LIMIT": ({"vel": 50.0}, STATES),
    "SET_JOINT_ACC_LIMIT": ({"acc": 500.0}, STATES),
    "SET_JOINT_HOMING_PARAMS": ({"home_sequence": 1}, STATES),
    "UPDATE_JOINT_HOMING_PARAMS": ({"home_sequence": 1}, STATES),
    "SET_JOINT_MOTOR_OFFSET": ({"motor_offset": 1.0}, ("off",)),
    "SET_JOINT_COMP": ({"comp_nominal": 1.0, "comp_forward": 0.1, "comp_reverse": 0.1}, STATES),
    "SET_AXIS_POSITION_LIMITS": ({"minLimit": -50.0, "maxLimit": 50.0}, STATES),
    "SET_AXIS_VEL_LIMIT": ({"vel": 50.0}, STATES),
    "SET_AXIS_ACC_LIMIT": ({"acc": 500.0}, STATES),
    "SET_AXIS_LOCKING_JOINT": ({}, STATES),
    "SET_SPINDLE_PARAMS": ({"maxSpeed": 6000.0, "minLimit": -6000.0}, STATES),
    "SET_HEARTBEAT_TIMEOUT": ({"timeout": 0.0}, STATES),
    "HEARTBEAT": ({}, STATES),
    "SET_UNITS": ({"scale": 1.0}, STATES),
    "SET_JERK": ({"jerk": 1e5}, STATES),
    "SET_PLANNER_TYPE": ({"mode": 1}, STATES),
    "SET_JOINT_JERK_LIMIT": ({"jerk": 1e5}, STATES),
    "SET_AXIS_JERK_LIMIT": ({"jerk": 1e5}, STATES),
}
# what depends on more than the mode has its own tests: test_spindle_sync.py
ELSEWHERE = {"RIGID_TAP"}


def test_the_expectations_cover_every_command() -> None:
    known = {name for name, *_ in COMMANDS}
    assert known - ELSEWHERE == set(EXPECTED) - ELSEWHERE
    assert {member.name for member in MotCommand} - ELSEWHERE == known - ELSEWHERE


@pytest.mark.parametrize("state", STATES)
@pytest.mark.parametrize("name", [n for n in EXPECTED if n not in ELSEWHERE])
def test_a_command_is_taken_or_refused_as_its_mode_demands(name: str, state: str) -> None:
    fields, taken_in = EXPECTED[name]
    m = mill(state)
    status = m.send(MotCommand[name], **fields)
    m.step(200)
    if state in taken_in:
        assert (status, m.errors()) == (MotCommandStatus.OK, [])
    else:
        assert status in (MotCommandStatus.INVALID_COMMAND, MotCommandStatus.INVALID_PARAMS)
        assert len(m.errors()) == 1, "a refusal says why, once"
    assert m.worst_vel <= 1.0 + 1e-6
    assert m.worst_acc <= 1.0 + 1e-6
    assert m.status.commandEcho == MotCommand[name]


NUMBERS = [f.name for f in EMCMOT_COMMAND.FIELDS if f.c_type == "double"]


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("name", ["SET_LINE", "JOG_CONT", "SET_JOINT_VEL_LIMIT", "FEED_SCALE", "SPINDLE_ON", "ABORT"])
def test_a_number_that_is_none_is_refused_and_does_no_harm(name: str, bad: float) -> None:
    for number in NUMBERS:
        m = mill("coord")
        fields = EXPECTED[name][0] | {number: bad}
        assert m.send(MotCommand[name], **fields) == PARAMS
        assert "not a number" in m.errors()[0]
        m.step(10)
        assert m["joint.0.motor-pos-cmd"] == 0.0
        assert m["spindle.0.speed-out"] == 0.0
        assert m.status.motion_state == 3


@pytest.mark.parametrize("axis", range(9))
def test_a_position_beyond_any_machine_is_refused(axis: int) -> None:
    m = mill("coord")
    pos = [0.0] * 9
    pos[axis] = 1e12
    assert m.send(MotCommand.SET_LINE, **(MOVE | {"pos": pos})) == PARAMS
    m.step(10)
    assert m["motion.in-position"]


@pytest.mark.parametrize("code", [0, -1, 127, 128, 99, 2**31 - 1, -(2**31)])
def test_an_unknown_command_is_refused_by_its_number(code: int) -> None:
    m = configure(Motion("xyz"))
    assert m.send(code) == UNKNOWN
    assert m.errors() == [f"unknown motion command {code}"]


@pytest.mark.parametrize("index", [-3, 3, 16, 2**31 - 1, -(2**31)])
@pytest.mark.parametrize(
    "name", ["JOINT_HOME", "JOG_CONT", "SET_JOINT_VEL_LIMIT", "JOINT_UNHOME", "JOINT_ACTIVATE", "SET_JOINT_COMP"]
)
def test_a_joint_that_does_not_exist_is_refused(name: str, index: int) -> None:
    m = mill("homed")
    assert m.send(MotCommand[name], **(EXPECTED[name][0] | {"joint": index})) == PARAMS
    assert m.errors() == [f"{name} refused: there is no such joint"]


def test_a_torn_record_is_refused_and_the_next_command_works() -> None:
    m = configure(Motion("xyz"))
    whole = bytes(EMCMOT_COMMAND(command=int(MotCommand.ENABLE), serial_number=5).data)
    for size in (0, 1, 20, len(whole) - 1):
        assert m.send_bytes(whole[:size]) == UNKNOWN
    assert m.send_bytes(b"\0" * len(whole)) == UNKNOWN
    assert m.send_bytes(whole) == OK
    m.step(2)
    assert m.status.motion_state == 1


def test_random_bytes_in_the_command_buffer_do_no_harm() -> None:
    rng = random.Random(1)
    m = mill("homed")
    template = bytearray(EMCMOT_COMMAND(command=1).data)
    for _ in range(3000):
        record = bytearray(template)
        for _ in range(rng.randrange(1, 40)):
            record[rng.randrange(20, len(record))] = rng.randrange(256)
        record[20:24] = rng.randrange(1, 110).to_bytes(4, "little")
        m.send_bytes(bytes(record))
        m.step(3)
        m.errors()
    assert all(math.isfinite(m[f"joint.{joint}.motor-pos-cmd"]) for joint in range(3))
