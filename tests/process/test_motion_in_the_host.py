"""Motion in the realtime host: HAL pins like LinuxCNC's, commands and status through the NML buffers."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pytest

from hal.realtime import Host
from nml.channel import Channel
from nml.emc.emcmot import EMCMOT_COMMAND, MotCommand, MotionFlag
from nml.emc.emcmot import MotCommand as C

pytestmark = pytest.mark.process
PATIENCE = 20.0  # s; a watchdog, not a claim about speed


class Machine:
    """A host with motion whose motors follow at once, and the three buffers as task has them."""

    def __init__(self, *arguments: str, coordinates: str = "xyz") -> None:
        self.host = Host()
        self.host.load("trivkins", [f"coordinates={coordinates}"])
        self.host.load("motmod", [f"num_joints={len(coordinates)}", *arguments])
        self.hal = self.host.hal
        for joint in range(len(coordinates)):
            self.hal.net(f"pos{joint}", [f"joint.{joint}.motor-pos-cmd", f"joint.{joint}.motor-pos-fb"])
        self.host.add_function("motion-command-handler", "servo-thread")
        self.host.add_function("motion-controller", "servo-thread")
        self.command = Channel(None, "emcmotCommand", "emc")
        self.status = Channel(None, "emcmotStatus", "emc")
        self.error = Channel(None, "emcmotError", "emc")
        self.hal.start_threads()
        for joint in range(len(coordinates)):
            self.send(C.SET_JOINT_VEL_LIMIT, joint=joint, vel=100.0)
            self.send(C.SET_JOINT_ACC_LIMIT, joint=joint, acc=1000.0)
            self.send(C.SET_JOINT_HOMING_PARAMS, joint=joint, home_sequence=0)
            self.send(C.JOINT_ACTIVATE, joint=joint)
            self.send(C.SET_AXIS_VEL_LIMIT, axis=joint, vel=100.0)
            self.send(C.SET_AXIS_ACC_LIMIT, axis=joint, acc=1000.0)

    def send(self, code: MotCommand, **fields: object) -> int:
        return self.command.write(EMCMOT_COMMAND(command=int(code), **fields))

    def wait(self, condition: object, what: str):
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            status = self.status.peek() or self.status.read()
            if status is not None and condition(status):  # type: ignore[operator]
                return status
            time.sleep(0.002)
        raise AssertionError(f"{what}: not within {PATIENCE} s")

    def done(self, serial: int):
        return self.wait(
            lambda s: s.commandNumEcho >= serial and s.depth == 0 and s.motionFlag & MotionFlag.INPOS, "motion done"
        )

    def close(self) -> None:
        self.host.close()
        for channel in (self.command, self.status, self.error):
            channel.close()


@pytest.fixture
def machine() -> Iterator[Machine]:
    made = Machine()
    yield made
    made.close()


def test_a_program_of_lines_ends_where_it_says(machine: Machine) -> None:
    machine.send(C.ENABLE)
    machine.wait(lambda s: s.motion_state == 1, "enabled")
    machine.done(machine.send(C.JOINT_HOME, joint=-1))
    machine.send(C.COORD)
    machine.wait(lambda s: s.motion_state == 3, "coordinated mode")
    for n in range(50):
        pos = (n % 3 * 0.5, n % 2 * 0.5, 0.1, 0, 0, 0, 0, 0, 0)
        last = machine.send(C.SET_LINE, id=n + 1, pos=pos, vel=60.0, ini_maxvel=100.0, termCond=2, motion_type=2)
    status = machine.done(last)
    assert status.carte_pos_cmd.tran.x == pytest.approx(0.5)
    assert machine.hal.value("joint.1.motor-pos-cmd") == pytest.approx(0.5)
    assert machine.error.read() is None


def test_a_refused_command_sends_its_reason(machine: Machine) -> None:
    serial = machine.send(C.JOG_CONT, joint=0, mode=1, vel=1.0)
    machine.wait(lambda s: s.commandNumEcho >= serial, "command taken")
    error = machine.error.read()
    assert error is not None
    assert error.text == "JOG_CONT refused: motion is not enabled"


def test_pins_follow_the_state(machine: Machine) -> None:
    assert machine.hal.value("joint.0.amp-enable-out") is False
    machine.send(C.ENABLE)
    machine.wait(lambda s: s.motion_state == 1, "enabled")
    assert machine.hal.value("joint.0.amp-enable-out") is True
    machine.hal.set_item("motion.enable", "0")
    machine.wait(lambda s: s.motion_state == 0, "disabled by its pin")
    assert machine.hal.value("joint.0.amp-enable-out") is False
    error = machine.error.read()
    assert error is not None
    assert error.text == "motion stopped by enable input"


def test_without_a_heartbeat_motion_stops_and_switches_off(machine: Machine) -> None:
    machine.send(C.ENABLE)
    machine.wait(lambda s: s.motion_state == 1, "enabled")
    machine.send(C.JOG_CONT, joint=0, mode=1, vel=20.0)
    machine.send(C.SET_HEARTBEAT_TIMEOUT, timeout=0.1)
    status = machine.wait(lambda s: s.motion_state == 0, "switched off")
    assert status.task_lost
    assert status.joint_status[0].vel_cmd == 0.0
