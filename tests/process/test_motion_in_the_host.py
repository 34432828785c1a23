"""Motion in the realtime host: HAL pins like LinuxCNC's, commands and status through the NML buffers."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pytest

from hal._shm import PIN
from nml.emc.emcmot import MotCommand as C
from nml.errors import HalError
from nml.pulse import Pulse
from tests.support.motion_host import MotionHost

pytestmark = pytest.mark.process

MISSED_POLLS = 2000  # servo periods in which a busy computer may keep the test from looking
SILENCE = 0.5  # s without a sign of life; a busy computer may hold up a healthy pulse for longer than 0.1 s


MACHINE = """\
loadrt trivkins coordinates=xyz
loadrt motmod num_joints=3
addf motion-command-handler servo-thread
addf motion-controller servo-thread
net x joint.0.motor-pos-cmd joint.0.motor-pos-fb
net y joint.1.motor-pos-cmd joint.1.motor-pos-fb
net z joint.2.motor-pos-cmd joint.2.motor-pos-fb
"""


@pytest.fixture
def machine() -> Iterator[MotionHost]:
    with MotionHost(MACHINE) as made:
        for joint in range(3):
            made.configure(joint)
        yield made


def test_a_program_of_lines_ends_where_it_says(machine: MotionHost) -> None:
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


def test_a_refused_command_sends_its_reason(machine: MotionHost) -> None:
    serial = machine.send(C.JOG_CONT, joint=0, mode=1, vel=1.0)
    machine.wait(lambda s: s.commandNumEcho >= serial, "command taken")
    error = machine.error.read()
    assert error is not None
    assert error.text == "Can't jog joint when not enabled."


def test_pins_follow_the_state(machine: MotionHost) -> None:
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


def test_without_a_heartbeat_motion_stops_and_switches_off(machine: MotionHost) -> None:
    machine.send(C.ENABLE)
    machine.wait(lambda s: s.motion_state == 1, "enabled")
    machine.send(C.JOG_CONT, joint=0, mode=1, vel=20.0)
    machine.send(C.SET_HEARTBEAT_TIMEOUT, timeout=0.1)
    status = machine.wait(lambda s: s.motion_state == 0, "switched off")
    assert status.task_lost
    assert status.joint_status[0].vel_cmd == 0.0


def test_motion_misses_the_pulse_of_task_after_the_time_it_was_told(machine: MotionHost) -> None:
    machine.send(C.ENABLE)
    machine.wait(lambda s: s.motion_state == 1, "enabled")
    pulse = Pulse(machine.command, 0.02, 60.0)
    machine.send(C.SET_HEARTBEAT_TIMEOUT, timeout=SILENCE)
    machine.send(C.JOG_CONT, joint=0, mode=1, vel=20.0)
    start = machine.wait(lambda s: s.joint_status[0].vel_cmd > 19.9, "at speed").heartbeat
    machine.wait(lambda s: s.heartbeat > start + 1500 and s.joint_status[0].vel_cmd > 19.9, "much longer")
    pulse.close()
    end = machine.wait(lambda s: s.joint_status[0].vel_cmd > 19.9, "the last sign of life").heartbeat
    status = machine.wait(lambda s: s.task_lost, "task missed")
    assert 0 < status.heartbeat - end < SILENCE * 1000 + MISSED_POLLS
    status = machine.wait(lambda s: s.motion_state == 0, "switched off")
    assert status.joint_status[0].vel_cmd == 0.0
    assert machine.errors() == ["Task has not answered for 0.500 s: motion stopped"]


TABLE = """\
loadrt xyzac-trt-kins sparm=identityfirst
loadrt motmod num_joints=5
addf motion-command-handler servo-thread
addf motion-controller servo-thread
net x joint.0.motor-pos-cmd joint.0.motor-pos-fb
net y joint.1.motor-pos-cmd joint.1.motor-pos-fb
net z joint.2.motor-pos-cmd joint.2.motor-pos-fb
net a joint.3.motor-pos-cmd joint.3.motor-pos-fb
net c joint.4.motor-pos-cmd joint.4.motor-pos-fb
net type motion.analog-out-03 motion.switchkins-type
setp xyzac-trt-kins.x-rot-point 10
"""


def test_an_analog_output_switches_the_kinematics_and_pins_give_its_geometry() -> None:
    with MotionHost(TABLE) as machine:
        for joint in range(5):
            machine.configure(joint)
        machine.send(C.ENABLE)
        machine.wait(lambda s: s.motion_state == 1, "enabled")
        machine.done(machine.send(C.JOINT_HOME, joint=-1))
        machine.done(machine.send(C.JOG_ABS, joint=4, mode=1, vel=90.0, offset=90.0))
        machine.send(C.COORD)
        machine.wait(lambda s: s.motion_state == 3, "coordinated mode")
        assert [machine.hal.value(f"kinstype.is-{n}") for n in range(3)] == [True, False, False]
        # the first status that shows the machine at rest again has the pose of the new kinematics
        status = machine.done(machine.send(C.SET_AOUT, out=3, now=1, minLimit=1.0))
        assert (status.carte_pos_cmd.tran.x, status.carte_pos_cmd.tran.y) == pytest.approx((10.0, 10.0))
        assert [machine.hal.value(f"kinstype.is-{n}") for n in range(3)] == [False, True, False]
        assert machine.errors() == []


TEMPLATE = """\
loadrt millturn
loadrt motmod num_joints=4
addf millturn.0.fdemo servo-thread
addf motion-command-handler servo-thread
addf motion-controller servo-thread
setp millturn.in 7
"""


def test_kinematics_of_the_template_have_its_pins_and_its_function() -> None:
    with MotionHost(TEMPLATE) as machine:
        machine.wait(lambda s: machine.hal.value("millturn.0.fpin") > 3, "a few periods")
        shown = {pin.name for pin in machine.hal.segment.items(PIN) if pin.name.startswith(("millturn.", "kinstype."))}
        assert shown == {
            *("millturn.in", "millturn.out", "millturn.0.fpin", "millturn.0.fdemo.time"),
            *("kinstype.is-0", "kinstype.is-1"),
        }
        assert (machine.hal.value("millturn.param-rw"), machine.hal.value("millturn.param-ro")) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (["xyzac-trt-kins", "coordinates=xyzab"], "coordinates=xyzab: c is missing"),
        (["5axiskins", "coordinates=xyzbcwq"], "1 to 16 letters"),
        (["pumakins", "sparm=last"], "only identityfirst is known"),
        (["millturn", "coordinates=xyz"], "unknown argument coordinates; it takes none"),
    ],
)
def test_a_wrong_argument_of_a_kinematics_is_named(words: list[str], complaint: str) -> None:
    with pytest.raises(HalError, match=complaint):
        MotionHost(f"loadrt {' '.join(words)}")


def test_a_function_that_overruns_its_period_is_counted_and_its_time_is_shown(machine: MotionHost) -> None:
    comp = machine.host.component("slow")
    comp.python_function("slow", lambda period: time.sleep(0.003))
    comp.ready()
    machine.host.add_function("slow", "servo-thread")
    [thread] = machine.hal.segment.threads()
    machine.wait(lambda s: thread.overruns > 0 and machine.hal.value("slow.tmax") > thread.period_ns, "an overrun")
    machine.host.remove_function("slow", "servo-thread")
