"""Motion in the realtime host with simulated hardware: encoders with an index, step generators, switches, a spindle.

Commands are sampled every servo period through HAL.
"""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from nml.emc.emcmot import MotCommand as C
from tests.support.motion_host import MotionHost

pytestmark = pytest.mark.process

DT = 0.001
VEL, ACC = 8.0, 80.0
COUNTS_PER_MM = 1000

# joint 0: a position loop closed over a quadrature encoder of one turn per mm, with index and home switch
# joint 1: a step generator; joint 2: a motor that follows at once, with a switch that opens late
SERVOS = f"""\
loadrt trivkins coordinates=xyz
loadrt motmod servo_period_nsec=1000000 base_period_nsec=50000 num_joints=3
loadrt sim_encoder num_chan=1
loadrt encoder num_chan=1
loadrt pid num_chan=1
loadrt stepgen step_type=0 ctrl_type=p
loadrt sim_home_switch count=3
addf sim-encoder.make-pulses base-thread
addf encoder.update-counters base-thread
addf stepgen.make-pulses base-thread
addf encoder.capture-position servo-thread
addf stepgen.capture-position servo-thread
addf sim-home-switch.0 servo-thread
addf sim-home-switch.1 servo-thread
addf sim-home-switch.2 servo-thread
addf motion-command-handler servo-thread
addf motion-controller servo-thread
addf pid.0.do-pid-calcs servo-thread
addf stepgen.update-freq servo-thread
addf sim-encoder.update-speed servo-thread
setp sim-encoder.0.ppr {COUNTS_PER_MM // 4}
setp encoder.0.position-scale {COUNTS_PER_MM}
setp pid.0.Pgain 40
setp pid.0.FF1 1
setp pid.0.deadband 0
net a encoder.0.phase-A sim-encoder.0.phase-A
net b encoder.0.phase-B sim-encoder.0.phase-B
net z encoder.0.phase-Z sim-encoder.0.phase-Z
net x-cmd joint.0.motor-pos-cmd pid.0.command
net x-fb encoder.0.position pid.0.feedback joint.0.motor-pos-fb
net x-index joint.0.index-enable encoder.0.index-enable pid.0.index-enable
net x-on joint.0.amp-enable-out pid.0.enable
net x-speed pid.0.output sim-encoder.0.speed
net y-cmd joint.1.motor-pos-cmd stepgen.0.position-cmd
net y-fb stepgen.0.position-fb joint.1.motor-pos-fb
net y-on joint.1.amp-enable-out stepgen.0.enable
setp stepgen.0.position-scale 500
setp stepgen.0.maxaccel 100
setp stepgen.0.steplen 1
setp stepgen.0.stepspace 1
net z-cmd joint.2.motor-pos-cmd joint.2.motor-pos-fb sim-home-switch.2.cur-pos
setp sim-home-switch.0.home-pos 5.3
setp sim-home-switch.1.home-pos 7
setp sim-home-switch.2.home-pos -4
setp sim-home-switch.2.hysteresis 0.5
net x-true sim-home-switch.0.cur-pos
net y-fb sim-home-switch.1.cur-pos
net x-home sim-home-switch.0.home-sw joint.0.home-sw-in
net y-home sim-home-switch.1.home-sw joint.1.home-sw-in
net z-home sim-home-switch.2.home-sw joint.2.home-sw-in
loadrt conv_s32_float
loadrt mult2
net x-counts sim-encoder.0.rawcounts conv-s32-float.0.in
net x-turns conv-s32-float.0.out mult2.0.in0
setp mult2.0.in1 {1 / COUNTS_PER_MM}
net x-true mult2.0.out
addf conv-s32-float.0 servo-thread
addf mult2.0 servo-thread
"""
SAMPLED = [f"joint.{n}.{what}" for n in range(3) for what in ("vel-cmd", "acc-cmd", "f-error")]


@pytest.fixture
def machine() -> Iterator[MotionHost]:
    with MotionHost(SERVOS, SAMPLED, speed=4.0) as made:
        made.configure(0, vel=VEL, acc=ACC, limit=50.0, offset=5.0, home=1.0, search_vel=4.0, latch_vel=-1.0, flags=2)
        made.configure(1, vel=VEL, acc=ACC, limit=50.0, offset=7.5, home=2.0, search_vel=5.0, latch_vel=-0.5)
        made.configure(2, vel=VEL, acc=ACC, limit=50.0, offset=-3.0, home=0.0, search_vel=-5.0, latch_vel=-0.5)
        made.send(C.ENABLE)
        made.wait(lambda s: s.motion_state == 1, "enabled")
        yield made


def within_limits(rows: list[tuple[float, ...]]) -> None:
    for joint in range(3):
        vel, acc, ferror = (max(abs(row[3 * joint + n]) for row in rows) for n in range(3))
        assert vel <= VEL * (1 + 1e-6)
        assert acc <= ACC * (1 + 1e-6)
        assert ferror < 1.0


def test_joints_home_by_switches_and_by_the_index_of_an_encoder(machine: MotionHost) -> None:
    status = machine.done(machine.send(C.JOINT_HOME, joint=-1))
    rows = machine.samples()
    assert machine.errors() == []
    assert [status.joint_status[n].homed for n in range(3)] == [1, 1, 1]
    assert [status.joint_status[n].pos_cmd for n in range(3)] == [1.0, 2.0, 0.0]
    assert len(rows) > 1000
    within_limits(rows)
    # the index below the switch is at 5 turns of the encoder, and there the joint is at its HOME_OFFSET of 5
    true = machine.hal.value("sim-encoder.0.rawcounts") / COUNTS_PER_MM
    assert true - machine.hal.value("joint.0.pos-fb") == pytest.approx(0.0, abs=2.5 / COUNTS_PER_MM)
    # the stepper's switch opens 0.1 below where it closed, at the speed of the latch
    assert machine.hal.value("joint.1.motor-offset") == pytest.approx(6.9 - 7.5, abs=0.01)
    # the last joint's latch closes the switch at -4 once more
    assert machine.hal.value("joint.2.motor-offset") == pytest.approx(-4.0 + 3.0, abs=0.01)


def test_a_program_runs_on_pid_and_stepgen_under_the_limits(machine: MotionHost) -> None:
    machine.done(machine.send(C.JOINT_HOME, joint=-1))
    machine.send(C.COORD)
    machine.wait(lambda s: s.motion_state == 3, "coordinated mode")
    machine.samples()
    points = [(6, 2, 0), (6, 8, 1), (0, 8, 1), (0, 0, 0), (3, 3, 3)]
    for n, point in enumerate(points):
        machine.send(C.SET_LINE, id=n + 1, pos=(*point, *[0] * 6), vel=6.0, ini_maxvel=VEL, termCond=2, motion_type=2)
    status = machine.done(machine.send(C.HEARTBEAT))
    assert machine.errors() == []
    assert [status.joint_status[n].pos_fb for n in range(3)] == pytest.approx([3.0, 3.0, 3.0], abs=0.01)
    rows = machine.samples()
    assert len(rows) > 1000
    within_limits(rows)


def test_an_encoder_that_loses_its_feedback_stops_the_machine_by_its_following_error(machine: MotionHost) -> None:
    machine.send(C.JOG_CONT, joint=0, mode=1, vel=2.0)
    machine.wait(lambda s: s.joint_status[0].vel_cmd > 1.9, "jog")
    machine.hal.set_item("encoder.0.position-scale", "-1000")
    status = machine.wait(lambda s: s.motion_state == 0, "switched off")
    assert any("joint 0 following error" in text for text in machine.errors())
    assert not status.joint_status[0].flag & 1


SPINDLE = """\
loadrt trivkins coordinates=xz
loadrt motmod servo_period_nsec=1000000 num_joints=2
loadrt limit2
loadrt sim_spindle
loadrt near
loadrt ddt
addf limit2.0 servo-thread
addf sim-spindle.0 servo-thread
addf near.0 servo-thread
addf motion-command-handler servo-thread
addf motion-controller servo-thread
setp limit2.0.maxv 40
setp near.0.scale 1.02
setp near.0.difference 0.05
net rps spindle.0.speed-out-rps limit2.0.in near.0.in1
net turning limit2.0.out sim-spindle.0.velocity-cmd near.0.in2 spindle.0.speed-in
net revs sim-spindle.0.position-fb spindle.0.revs
net index sim-spindle.0.index-enable spindle.0.index-enable
net reached near.0.out spindle.0.at-speed
net x joint.0.motor-pos-cmd joint.0.motor-pos-fb
net z joint.1.motor-pos-cmd joint.1.motor-pos-fb
"""
MOTION = ["joint.1.pos-cmd", "spindle.0.revs", "joint.1.vel-cmd", "joint.1.acc-cmd", "spindle.0.speed-in"]


@pytest.fixture
def lathe() -> Iterator[MotionHost]:
    with MotionHost(SPINDLE, MOTION, speed=4.0) as made:
        for joint in (0, 1):
            made.configure(joint, vel=100.0, acc=1000.0, limit=200.0)
        made.send(C.SET_AXIS_VEL_LIMIT, axis=2, vel=100.0)
        made.send(C.SET_AXIS_ACC_LIMIT, axis=2, acc=1000.0)
        made.send(C.ENABLE)
        made.wait(lambda s: s.motion_state == 1, "enabled")
        made.done(made.send(C.JOINT_HOME, joint=-1))
        made.send(C.COORD)
        made.wait(lambda s: s.motion_state == 3, "coordinated mode")
        made.samples()
        made.send(C.SPINDLE_ON, vel=600.0, wait_for_spindle_at_speed=1)
        yield made


def degrees_behind(rows: list[tuple[float, ...]], pitch: float, low: float, high: float) -> list[float]:
    """By how much z leads the turns of the spindle, where z is between ``low`` and ``high``."""
    return [(-z / pitch - revs) * 360.0 for z, revs, *_ in rows if low < -z < high]


def test_a_thread_waits_for_the_speed_and_follows_a_heavy_spindle_within_half_a_degree(lathe: MotionHost) -> None:
    lathe.send(C.SET_SPINDLESYNC, spindlesync=1.5)
    lathe.done(lathe.send(C.SET_LINE, id=1, pos=(0, 0, -30, *[0] * 6), vel=90.0, ini_maxvel=100.0, motion_type=2))
    rows = lathe.samples()
    started = next(n for n, row in enumerate(rows) if row[2] != 0.0)
    assert rows[started][4] == pytest.approx(10.0, rel=0.03), "the spindle is at speed before the thread begins"
    assert rows[0][4] < 2.0, "and was not before"
    lead = degrees_behind(rows, 1.5, 4.0, 28.0)
    assert max(lead) - min(lead) < 0.5
    assert max(abs(row[3]) for row in rows) <= 1000.0 * (1 + 1e-6)
    assert lathe.errors() == []


def test_a_tap_follows_a_heavy_spindle_in_and_out(lathe: MotionHost) -> None:
    lathe.send(C.SET_SPINDLESYNC, spindlesync=1.0)
    lathe.done(
        lathe.send(C.RIGID_TAP, id=1, pos=(0, 0, -12, *[0] * 6), vel=90.0, ini_maxvel=100.0, acc=1000.0, motion_type=2)
    )
    rows = lathe.samples()
    turned = next(n for n, row in enumerate(rows) if row[4] < 0.0)
    for part in (rows[:turned], rows[turned:]):
        steady = [row for row in part if abs(row[4]) > 9.99]
        lead = degrees_behind(steady, 1.0, 4.0, 11.0)
        assert lead
        assert max(lead) - min(lead) < 0.5
    assert min(row[0] for row in rows) < -12.0
    assert lathe.hal.value("joint.1.pos-cmd") == pytest.approx(0.0, abs=1e-6)
    assert max(abs(row[3]) for row in rows) <= 1000.0 * (1 + 1e-6)
    assert lathe.errors() == []
