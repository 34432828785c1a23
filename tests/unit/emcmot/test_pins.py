"""Motion's HAL pins and parameters are LinuxCNC's, by name, type, direction and first value."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from hal._shm import PARAM, PIN
from hal.realtime import Host
from hal.values import PARAM_DIR_NAMES, PIN_DIR_NAMES, TYPE_NAMES, show_value
from nml.errors import HalError

# kind, type, direction, name and first value of what LinuxCNC 2.9's motmod makes with these arguments (`halcmd show`)
LINUXCNC = Path(__file__).parent / "pins_linuxcnc_2_9.txt"
ARGUMENTS = ["num_joints=3", "num_dio=4", "num_aio=4", "num_spindles=1", "num_misc_error=2", "unlock_joints_mask=4"]
OF_2_10 = {("pin", "float", "OUT", f"joint.{n}.jerk-cmd", "0") for n in range(3)}
PLANNER_DEBUG = ("tc.", "traj.")  # parameters of LinuxCNC's own planner's insides


@pytest.fixture
def host() -> Iterator[Host]:
    host = Host()
    host.load("trivkins", ["coordinates=xyz"])
    yield host
    host.close()


def test_pins_and_parameters_are_those_of_linuxcnc(host: Host) -> None:
    host.load("motmod", ARGUMENTS)
    segment = host.hal.segment
    ours = {
        (kind, TYPE_NAMES[p.type], directions[p.dir], p.name, show_value(p.type, p.get()))
        for kind, number, directions in (("pin", PIN, PIN_DIR_NAMES), ("param", PARAM, PARAM_DIR_NAMES))
        for p in segment.items(number)
        if not p.name.startswith("servo-thread")
    }
    theirs = {tuple(row.split()) for row in LINUXCNC.read_text().splitlines()}
    theirs = {row for row in theirs if not row[3].startswith(PLANNER_DEBUG)}
    assert ours == theirs | OF_2_10


def test_names_of_inputs_and_outputs_can_be_given(host: Host) -> None:
    host.load("motmod", ["names_din=door,coolant", "names_dout=lamp"])
    names = {p.name for p in host.hal.segment.items(PIN)}
    assert {"motion.din-door", "motion.din-coolant", "motion.dout-lamp"} <= names


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (["num_joints=17"], "num_joints=17: 1 to 16 are allowed"),
        (["num_dio=x"], "num_dio=x: an integer is needed"),
        (["nonsense=1"], "unknown argument nonsense"),
        (["servo_period_nsec=5"], "servo_period_nsec=5"),
        (["base_period_nsec=2000000"], "base_period_nsec=2000000"),
        (["traj_period_nsec=10"], "traj_period_nsec=10"),
    ],
)
def test_a_bad_argument_is_named_and_leaves_nothing(host: Host, arguments: list[str], part: str) -> None:
    with pytest.raises(HalError, match=part):
        host.load("motmod", arguments)
    assert not [p.name for p in host.hal.segment.items(PIN) if p.name.startswith("motion")]


def test_the_periods_make_the_threads(host: Host) -> None:
    host.load("motmod", ["base_period_nsec=100000", "servo_period_nsec=1000000", "traj_period_nsec=10000000"])
    threads = {t.name: t.period_ns for t in host.hal.segment.threads()}
    assert threads == {"base-thread": 100_000, "servo-thread": 1_000_000}
