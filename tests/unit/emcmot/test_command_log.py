"""The line that motion-logger writes for a command."""

from __future__ import annotations

import pytest

from emcmot.commandlog import describe
from nml.emc.emcmot import EMCMOT_COMMAND
from nml.emc.emcmot import MotCommand as C


@pytest.mark.parametrize(
    ("code", "fields", "line"),
    [
        (C.ABORT, {}, "ABORT"),
        (C.JOINT_HOME, {"joint": -1}, "JOINT_HOME joint=-1"),
        (C.JOINT_ENABLE_AMPLIFIER, {"joint": 1}, "ENABLE_AMPLIFIER"),
        (C.SET_PROBE_ERR_INHIBIT, {"flags": 2}, "SETUP_SET_PROBE_ERR_INHIBIT 0 1"),
        (C.SET_JOINT_BACKLASH, {"joint": 2, "backlash": 0.01234567}, "SET_JOINT_BACKLASH joint=2, backlash=0.0123457"),
        (C.SET_SPINDLE_PARAMS, {"maxSpeed": 1e99}, "SET_SPINDLE_PARAMS, 1.00e+99, 0.00e+00, 0.00e+00, 0.00e+00"),
        (C.SPINDLE_ON, {"vel": 100.0}, "SPINDLE_ON speed=100.000000, css_factor=0.000000, xoffset=0.000000"),
        (C.SET_HEARTBEAT_TIMEOUT, {"timeout": 0.1}, ""),
    ],
)  # fmt: skip
def test_a_command_is_written_as_linuxcnc_writes_it(code: C, fields: dict[str, float], line: str) -> None:
    assert describe(EMCMOT_COMMAND(command=int(code), **fields)) == line


def test_a_move_is_written_with_its_end_and_speeds() -> None:
    speeds = {"vel": 10.0, "ini_maxvel": 50.0, "acc": 500.0}
    end = (1, 2, 3, 0, 0, 0, 0, 0, 4.5)
    move = EMCMOT_COMMAND(command=int(C.SET_LINE), id=7, pos=end, turn=-1, motion_type=2, **speeds)
    assert describe(move) == (
        "SET_LINE x=1, y=2, z=3, a=0, b=0, c=0, u=0, v=0, w=4.5, id=7, motion_type=2, vel=10, ini_maxvel=50, "
        "acc=500, turn=-1"
    )


def test_every_command_of_linuxcnc_has_a_line_and_one_that_nobody_has_is_named() -> None:
    for code in C:
        text = describe(EMCMOT_COMMAND(command=int(code)))
        assert bool(text) == (code < C.SET_HEARTBEAT_TIMEOUT), code
    assert describe(EMCMOT_COMMAND(command=99)) == "ERROR: unknown command 99"
