"""Coordinated moves with all that hangs on them: limits, overrides, pause, probing, spindles, outputs."""

from __future__ import annotations

import pytest

from emcmot.sim import Motion
from nml.emc.emcmot import MotCommand as C
from tests.support.mill import bring_to, configure, line, mill

TYPES = {"traverse": 1, "feed": 2, "arc": 3, "probe": 5}


def arc(m: Motion, x: float, y: float, cx: float, cy: float, turn: int = 0, id: int = 1, vel: float = 30.0) -> int:
    return int(
        m.send(
            C.SET_CIRCLE,
            id=id,
            pos=(x, y, 0, 0, 0, 0, 0, 0, 0),
            center=(cx, cy, 0),
            normal=(0, 0, 1),
            turn=turn,
            vel=vel,
            ini_maxvel=100.0,
            acc=1000.0,
            termCond=2,
            motion_type=3,
        )
    )


def probe(m: Motion, z: float, probe_type: int = 0, id: int = 1) -> int:
    pos = (0, 0, z, 0, 0, 0, 0, 0, 0)
    return int(m.send(C.PROBE, id=id, pos=pos, vel=10.0, ini_maxvel=100.0, acc=1000.0, probe_type=probe_type))


@pytest.mark.parametrize(
    ("pos", "text"),
    [
        ((0, 150), "Linear move on line 9 would exceed Y's positive limit: 150.0000, limit 100.0000"),
        ((-100.5,), "Linear move on line 9 would exceed X's negative limit: -100.5000, limit -100.0000"),
    ],
)
def test_an_end_point_beyond_an_axis_limit_is_refused_with_its_numbers(pos: tuple[float, ...], text: str) -> None:
    m = mill("coord")
    assert line(m, *pos, id=9) != 0
    assert m.errors() == [text]
    m.step(10)
    assert m.status.depth == 0


def test_an_end_point_beyond_a_joint_limit_names_the_joint() -> None:
    m = mill("coord")
    m.send(C.SET_JOINT_POSITION_LIMITS, joint=1, minLimit=-10.0, maxLimit=10.0)
    assert line(m, 0, 11, id=4) != 0
    assert m.errors() == ["Linear move on line 4 would exceed joint 1's positive limit: 11.0000, limit 10.0000"]


def test_an_arc_that_bulges_over_a_limit_is_refused() -> None:
    m = mill("coord")
    line(m, 90, 0, vel=100.0)
    m.run_until_rest()
    assert arc(m, 90, 30, 90, 15, id=12) != 0
    assert m.errors() == ["Circular move on line 12 would exceed X's positive limit: 105.0000, limit 100.0000"]
    m.send(C.ABORT)
    m.run_until_rest()
    assert arc(m, 90, 30, 90, 15, turn=-1) == 0, "clockwise it bulges the other way"
    m.run_until_rest()
    assert m.errors() == []


def test_no_move_behind_a_refused_one_is_taken_until_an_abort() -> None:
    m = mill("coord")
    line(m, 5, id=1)
    assert line(m, 900, id=2) != 0
    assert line(m, 7, id=3) != 0
    m.run_until_rest()
    assert m["motion.coord-error"]
    assert m.status.carte_pos_cmd.tran.x == 5.0
    m.send(C.ABORT)
    m.run_until_rest()
    m.errors()
    assert line(m, 7, id=4) == 0
    m.run_until_rest()
    assert m.status.carte_pos_cmd.tran.x == 7.0
    assert m.errors() == []


def test_moves_end_exactly_where_they_say() -> None:
    m = mill("coord")
    line(m, 10, 20, 5, id=1)
    line(m, 30, 20, 5, id=2)
    m.run_until_rest()
    line(m, 0, 0, 0, id=3)
    m.run_until_rest()
    arc(m, 20, 0, 10, 0, id=4)
    m.run_until_rest()
    assert [m[f"axis.{a}.pos-cmd"] for a in "xyz"] == pytest.approx([20, 0, 0], abs=1e-9)
    assert m.status.distance_travelled > 0
    assert m.worst_acc <= 1.0 + 1e-6


def test_distance_travelled_is_the_way_of_the_tool() -> None:
    m = mill("coord")
    line(m, 30, 40)
    m.run_until_rest()
    line(m, 0, 0)
    m.run_until_rest()
    assert m.status.distance_travelled == pytest.approx(100.0)


def test_a_pause_holds_on_the_path_and_resume_goes_on() -> None:
    m = mill("coord")
    line(m, 50)
    m.step(500)
    m.send(C.PAUSE)
    m.step(200)
    there = m["joint.0.pos-cmd"]
    m.step(200)
    assert m.status.paused
    assert m["joint.0.pos-cmd"] == there
    m.send(C.RESUME)
    m.run_until_rest()
    assert m["joint.0.pos-cmd"] == pytest.approx(50.0)


def test_steps_go_from_move_to_move() -> None:
    m = mill("coord")
    for n in range(1, 4):
        line(m, 10.0 * n, id=n)
    m.send(C.PAUSE)
    m.step(20)
    seen = []
    for _ in range(3):
        m.send(C.STEP)
        m.step(1500)
        seen.append(round(m["joint.0.pos-cmd"]))
    assert seen == [10, 20, 30]


def test_an_abort_while_paused_clears_queue_and_pause() -> None:
    m = mill("coord")
    for n in range(1, 20):
        line(m, 5.0 * n, id=n)
    m.step(300)
    m.send(C.PAUSE)
    m.step(100)
    m.send(C.ABORT)
    m.run_until_rest()
    assert (m.status.paused, m.status.depth, m.status.id) == (0, 0, 0)
    assert line(m, 1.0) == 0
    m.run_until_rest()
    assert m["joint.0.pos-cmd"] == pytest.approx(1.0)


def test_queue_free_holds_after_all_commands_echoed() -> None:
    m = mill("coord")
    free = m.status.queueFree
    echoed = m.status.commandNumEcho
    for n in range(100):
        line(m, (n + 1) * 0.5, id=n + 1)
    m.step()
    assert m.status.queueFree == free - 100
    assert m.status.commandNumEcho == echoed + 100


def test_a_full_queue_refuses_with_the_line() -> None:
    m = mill("coord")
    m.send(C.PAUSE)
    free = m.status.queueFree
    for n in range(free):
        assert line(m, (n % 2) * 5.0 + 0.1, id=n + 1) == 0
    assert line(m, 3, id=77) != 0
    assert m.errors() == ["Can't add linear move on line 77: the motion queue is full"]


@pytest.mark.parametrize(("scale", "speed"), [(0.5, 15.0), (1.0, 30.0), (2.0, 60.0), (9.0, 60.0)])
def test_the_feed_override_scales_a_feed_up_to_its_maximum(scale: float, speed: float) -> None:
    m = mill("coord")
    m.send(C.SET_MAX_FEED_OVERRIDE, scale=2.0)
    m.send(C.FEED_SCALE, scale=scale)
    line(m, 90)
    m.step(500)
    assert m["joint.0.vel-cmd"] == pytest.approx(speed)
    assert m["motion.feed-upm"] == pytest.approx(speed * 60)


@pytest.mark.parametrize(("units", "mm"), [(0, 25.4), (1, 25.4), (2, 1.0), (3, 10.0)])
def test_feed_pins_show_the_programs_inches_and_millimetres(units: int, mm: float) -> None:
    m = mill("coord")
    m.send(C.SET_UNITS, scale=25.4)  # a machine in inches
    m.send(C.FEED_SCALE, scale=0.5)
    line(m, 90, vel=10.0, mode=units)
    m.step(300)
    assert m["motion.feed-upm"] == pytest.approx(10.0 * 0.5 * 60 * 25.4 / mm)
    assert m["motion.feed-inches-per-minute"] == pytest.approx(300.0)
    assert m["motion.feed-inches-per-second"] == pytest.approx(5.0)
    assert m["motion.feed-mm-per-minute"] == pytest.approx(7620.0)
    assert m["motion.feed-mm-per-second"] == pytest.approx(127.0)


def test_the_status_shows_the_override_that_was_asked_for() -> None:
    m = mill("coord")
    m.send(C.FEED_SCALE, scale=3.0)
    m.step()
    assert (m.status.feed_scale, m.status.max_feed_scale) == (3.0, 1.0)


def test_an_abort_with_nothing_queued_ends_a_pause_too() -> None:
    m = mill("coord")
    m.send(C.PAUSE)
    m.step(2)
    m.send(C.ABORT)
    m.step(2)
    assert not m.status.paused
    line(m, 1)
    m.run_until_rest()
    assert m["joint.0.pos-cmd"] == pytest.approx(1.0)


def test_feed_hold_acts_only_on_moves_that_enable_it_and_feed_inhibit_on_all() -> None:
    m = mill("coord")
    m.send(C.FH_ENABLE, mode=0)
    line(m, 90)
    m["motion.feed-hold"] = 1
    m.step(300)
    assert m["joint.0.vel-cmd"] == pytest.approx(30.0)
    m["motion.feed-inhibit"] = 1
    m.step(300)
    assert m["joint.0.vel-cmd"] == 0.0
    assert m["motion.feed-upm"] == 0.0
    m["motion.feed-inhibit"] = 0
    m.step(300)
    assert m["joint.0.vel-cmd"] == pytest.approx(30.0)


def test_adaptive_feed_scales_where_it_is_enabled() -> None:
    m = mill("coord")
    m.send(C.AF_ENABLE, mode=1)
    m["motion.adaptive-feed"] = 0.5
    line(m, 90)
    m.step(500)
    assert m["joint.0.vel-cmd"] == pytest.approx(15.0)


def test_a_probe_contact_is_kept_in_the_period_that_sees_it() -> None:
    m = mill("coord")
    assert probe(m, -50) == 0
    m.step(1000)
    m["motion.probe-input"] = 1
    expected = m["joint.2.motor-pos-fb"]
    m.run_until_rest()
    status = m.status
    assert status.probeTripped
    assert not status.probing
    assert status.probedPos.tran.z == pytest.approx(expected)
    assert m["joint.2.pos-cmd"] < expected
    assert m.errors() == []
    assert m.worst_acc <= 1.0 + 1e-6


@pytest.mark.parametrize(
    ("probe_type", "text"),
    [
        (0, ["G38.2 move finished without making contact."]),
        (1, []),
        (2, ["G38.4 move finished without breaking contact."]),
        (3, []),
    ],
)
def test_a_probe_that_finds_nothing_complains_where_it_should(probe_type: int, text: list[str]) -> None:
    m = mill("coord")
    m["motion.probe-input"] = bool(probe_type & 2)
    m.step(2)
    probe(m, -5, probe_type)
    m.run_until_rest()
    assert m.errors() == text
    assert not m.status.probeTripped
    assert not m.status.probing
    assert m["joint.2.pos-cmd"] == pytest.approx(-5.0)
    assert m.status.probedPos.tran.z == pytest.approx(-5.0, abs=0.02)


@pytest.mark.parametrize(
    ("probe_type", "contact", "text"),
    [
        (0, 1, "Probe is already tripped when starting G38.2 or G38.3 move"),
        (2, 0, "Probe is already clear when starting G38.4 or G38.5 move"),
    ],
)
def test_a_probe_does_not_start_where_it_would_end(probe_type: int, contact: int, text: str) -> None:
    m = mill("coord")
    m["motion.probe-input"] = contact
    m.step(2)
    probe(m, -5, probe_type)
    m.run_until_rest()
    assert m.errors() == [text]
    assert abs(m["joint.2.pos-cmd"]) < 0.01


def test_a_trip_while_not_probing_stops_moves_jogs_and_homing() -> None:
    m = mill("coord")
    line(m, 50)
    m.step(300)
    m["motion.probe-input"] = 1
    m.run_until_rest()
    assert m.errors() == ["Probe tripped during non-probe move."]
    m["motion.probe-input"] = 0
    m.send(C.FREE)
    m.step(3)
    m.send(C.JOG_CONT, mode=1, vel=20.0)
    m.step(100)
    m["motion.probe-input"] = 1
    m.run_until_rest()
    assert m.errors() == ["Probe tripped during a jog."]
    m["motion.probe-input"] = 0
    m.send(C.SET_JOINT_HOMING_PARAMS, joint=0, home=50.0)
    m.send(C.JOINT_HOME, joint=0)
    m.step(300)
    m["motion.probe-input"] = 1
    m.run_until_rest()
    assert m.errors() == ["Probe tripped during homing motion."]
    assert not m["joint.0.homed"]


def test_the_alarms_of_a_probe_can_be_inhibited() -> None:
    m = mill("homed")
    m.send(C.SET_PROBE_ERR_INHIBIT, flags=3)
    m.send(C.JOG_INCR, mode=1, vel=20.0, offset=10.0)
    m.step(100)
    m["motion.probe-input"] = 1
    m.run_until_rest()
    assert m.errors() == []
    assert m["joint.0.pos-cmd"] == 10.0


def test_the_first_feed_move_waits_for_the_spindle_and_a_rapid_does_not() -> None:
    m = mill("coord")
    m["spindle.0.at-speed"] = 0
    m.send(C.SPINDLE_ON, vel=1000.0, wait_for_spindle_at_speed=1)
    line(m, 5, id=1, motion_type=TYPES["traverse"])
    line(m, 10, id=2)
    line(m, 20, id=3)
    m.step(3000)
    assert m["joint.0.pos-cmd"] == pytest.approx(5.0)
    m["spindle.0.at-speed"] = 1
    m.run_until_rest()
    assert m["joint.0.pos-cmd"] == pytest.approx(20.0)


def test_an_abort_ends_the_wait_for_a_spindle() -> None:
    m = mill("coord")
    m["spindle.0.at-speed"] = 0
    m.send(C.SPINDLE_ON, vel=1000.0, wait_for_spindle_at_speed=1)
    line(m, 10)
    m.step(100)
    m.send(C.ABORT)
    m.run_until_rest(100)
    assert m.status.depth == 0


@pytest.mark.parametrize(
    ("speed", "scale", "out", "forward"),
    [(600.0, 1.0, 600.0, True), (-600.0, 0.5, -300.0, False), (90.0, 1.0, 100.0, True)],
)
def test_spindle_pins_tell_speed_and_direction(speed: float, scale: float, out: float, forward: bool) -> None:
    m = mill("coord")
    m.send(C.SET_SPINDLE_PARAMS, minSpeed=100.0, maxSpeed=2000.0, maxLimit=0.0, minLimit=-2000.0)
    m.send(C.SPINDLE_SCALE, scale=scale)
    m.send(C.SPINDLE_ON, vel=speed)
    m.step()
    assert m["spindle.0.speed-out"] == out
    assert m["spindle.0.speed-out-rps-abs"] == abs(out) / 60.0
    assert (m["spindle.0.on"], m["spindle.0.forward"], m["spindle.0.reverse"]) == (True, forward, not forward)
    assert not m["spindle.0.brake"]
    m["spindle.0.inhibit"] = 1
    m.step()
    assert m["spindle.0.speed-out"] == 0.0
    m.send(C.SPINDLE_OFF)
    m.step()
    assert m["spindle.0.brake"]
    assert not m["spindle.0.on"]


def test_constant_surface_speed_follows_the_radius() -> None:
    m = mill("coord")
    line(m, 50)
    m.run_until_rest()
    m.send(C.SPINDLE_ON, vel=3000.0, ini_maxvel=3000.0, acc=10000.0, offset=0.0)
    m.step()
    assert m["spindle.0.speed-out"] == pytest.approx(200.0)
    line(m, 1)
    m.run_until_rest()
    m.step()
    assert m["spindle.0.speed-out"] == 3000.0


def test_orient_waits_for_its_acknowledgement_and_knows_faults() -> None:
    m = mill("coord")
    m.send(C.SPINDLE_ORIENT, orientation=90.0, timeout=5.0)
    m.step()
    assert m["spindle.0.orient"]
    assert m["spindle.0.orient-angle"] == 90.0
    assert m.status.spindle_status[0].orient_state == 2
    m["spindle.0.is-oriented"] = 1
    m.step()
    assert (m["spindle.0.orient"], m["spindle.0.locked"], m["spindle.0.brake"]) == (False, True, True)
    m["spindle.0.is-oriented"] = 0
    m.send(C.SPINDLE_ORIENT, orientation=10.0, timeout=5.0)
    m["spindle.0.orient-fault"] = 7
    m.step()
    assert m.errors() == ["Spindle 0: fault 7 during orient"]
    assert m.status.spindle_status[0].orient_state == 3


def test_one_command_reaches_all_spindles() -> None:
    m = bring_to(configure(Motion("xyz", num_spindles=3)), "coord")
    m.send(C.SPINDLE_ON, spindle=-1, vel=100.0)
    m.step()
    assert [m[f"spindle.{n}.speed-out"] for n in range(3)] == [100.0] * 3
    m.send(C.SPINDLE_INCREASE, spindle=1)
    m.step()
    assert [m[f"spindle.{n}.speed-out"] for n in range(3)] == [100.0, 200.0, 100.0]


def test_outputs_change_at_once_or_when_their_move_starts() -> None:
    m = mill("coord")
    m.send(C.SET_DOUT, now=1, out=2, start=1)
    m.step()
    assert m["motion.digital-out-02"]
    line(m, 5, id=1)
    m.send(C.SET_DOUT, now=0, out=0, start=1)
    m.send(C.SET_AOUT, now=0, out=1, minLimit=3.5)
    line(m, 5, 5, id=2, termCond=1)
    while m.status.id != 2:
        assert not m["motion.digital-out-00"]
        m.step()
    assert m["motion.digital-out-00"]
    assert m["motion.analog-out-01"] == 3.5
    assert m.status.synch_do[0] == 1


def test_an_abort_drops_outputs_that_wait_for_a_move() -> None:
    m = mill("coord")
    m.send(C.SET_DOUT, now=0, out=0, start=1)
    m.send(C.ABORT)
    m.step(2)
    line(m, 5)
    m.run_until_rest()
    assert not m["motion.digital-out-00"]


def test_a_rotary_waits_for_the_lock_of_its_indexer() -> None:
    m = bring_to(configure(Motion("xyza", unlock_joints_mask=8), axes=4), "coord")
    assert line(m, 0, 0, 0, 30, id=1, motion_type=6, turn=3, vel=30.0) == 0
    m.step(500)
    assert m["joint.3.unlock"]
    assert m["joint.3.pos-cmd"] == 0.0
    m["joint.3.is-unlocked"] = 1
    m.run_until_rest()
    assert m["joint.3.pos-cmd"] == pytest.approx(30.0)
    m.step(2)
    assert not m["joint.3.unlock"]


def test_a_cap_on_the_tool_speed_holds() -> None:
    m = mill("coord")
    m.send(C.SET_VEL_LIMIT, vel=12.0)
    line(m, 50, vel=90.0)
    m.step(500)
    assert m["motion.current-vel"] == pytest.approx(12.0)


def test_tool_offsets_are_shown_on_their_pins() -> None:
    m = mill("coord")
    m.send(C.SET_OFFSET, tool_offset=(1, 2, 3, 4, 5, 6, 7, 8, 9))
    assert [m[f"motion.tooloffset.{a}"] for a in "xyzabcuvw"] == [1, 2, 3, 4, 5, 6, 7, 8, 9]
