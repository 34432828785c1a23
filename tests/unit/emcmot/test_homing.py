"""Homing against simulated switches and index pulses, from thousands of random places."""

from __future__ import annotations

import random

import pytest

from emcmot.sim import Motion
from nml.emc.emcmot import MotCommand as C
from tests.support.mill import bring_to, configure, line, mill

IGNORE_LIMITS, USE_INDEX, SHARED, UNLOCK_FIRST, ABSOLUTE, NO_REHOME, NO_FINAL_MOVE, NO_RESET = (
    1 << bit for bit in range(8)
)
DT = 0.001


def homing(m: Motion, joint: int = 0, **entries: float) -> None:
    """Set HOME_* entries: offset, home, search, latch, final, flags, sequence."""
    names = {"search": "search_vel", "latch": "latch_vel", "final": "home_final_vel", "sequence": "home_sequence"}
    fields = {names.get(key, key): value for key, value in entries.items()}
    m.send(C.SET_JOINT_HOMING_PARAMS, joint=joint, **fields)


def home(m: Motion, joint: int = 0) -> list[str]:
    m.send(C.JOINT_HOME, joint=joint)
    m.run_until_rest(200_000)
    return m.errors()


def within_limits(m: Motion) -> bool:
    return m.worst_vel <= 1.0 + 1e-6 and m.worst_acc <= 1.0 + 1e-6


def test_immediate_homing_names_the_place_and_moves_to_home() -> None:
    m = mill("free")
    homing(m, offset=5.0, home=8.0, final=20.0)
    assert home(m) == []
    assert m["joint.0.homed"]
    assert m["joint.0.pos-cmd"] == 8.0
    assert m["joint.0.motor-pos-cmd"] == pytest.approx(3.0)
    assert m["joint.0.motor-offset"] == pytest.approx(-5.0)
    assert within_limits(m)


@pytest.mark.parametrize("latch_with_search", [True, False])
@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("index", [False, True])
def test_a_switch_gives_the_position_wherever_the_joint_starts(
    latch_with_search: bool, direction: int, index: bool
) -> None:
    rng = random.Random(f"{latch_with_search}{direction}{index}")
    for _ in range(250):
        m = mill("free")
        search, latch = rng.uniform(5, 80), rng.uniform(0.5, 5)
        edge = direction * rng.uniform(60, 80)  # where the switch closes, coming from the middle
        end = edge + direction * 40.0
        start = rng.uniform(-55, 55) if rng.random() < 0.8 else edge + direction * rng.uniform(0.5, 15)
        offset, where_home = rng.uniform(-20, 20), rng.uniform(-20, 20)
        pitch = rng.uniform(1.0, 6.0) if index else 0.0
        m.place(0, start, pitch, rng.uniform(-3, 3))
        m.add_switch(0, "home", min(edge, end), max(edge, end))
        homing(
            m,
            offset=offset,
            home=where_home,
            final=rng.choice([-1.0, 10.0, 60.0]),
            search=direction * search,
            latch=direction * latch * (1 if latch_with_search else -1),
            flags=USE_INDEX if index else 0,
        )
        assert home(m) == []
        assert m["joint.0.homed"]
        assert m["joint.0.pos-cmd"] == where_home
        home_place = m.true_position(0) - (where_home - offset)  # where the joint would read HOME_OFFSET
        if index:
            # the encoder was reset by a pulse within one turn behind the edge
            assert abs(home_place - edge) <= pitch + 1.0
        else:
            assert abs(home_place - edge) <= 2 * latch * DT + 1e-9
        assert within_limits(m)


def test_index_homing_repeats_exactly_whatever_the_start() -> None:
    places = []
    rng = random.Random(3)
    for _ in range(60):
        m = mill("free")
        m.place(0, rng.uniform(-50, 50), 4.0, 1.0)
        m.add_switch(0, "home", 70.0, 120.0)
        homing(m, offset=0.0, home=0.0, search=40.0, latch=2.0, flags=USE_INDEX)
        assert home(m) == []
        places.append(m.true_position(0))
    assert max(places) - min(places) < 1e-9


def test_an_encoder_that_keeps_its_count_is_homed_to_the_index_within_one_period() -> None:
    m = mill("free")
    m.place(0, 10.3, 5.0, 0.0)
    homing(m, offset=2.0, home=2.0, latch=3.0, flags=USE_INDEX | NO_RESET)
    assert home(m) == []
    assert m.true_position(0) == pytest.approx(15.0, abs=2 * 3.0 * DT)
    assert m["joint.0.motor-pos-fb"] == pytest.approx(4.7, abs=0.01)
    assert within_limits(m)


def test_index_alone_homes_a_joint_without_a_switch() -> None:
    m = mill("free")
    m.place(0, 10.3, 5.0, 0.0)
    homing(m, offset=2.0, home=2.0, search=0.0, latch=3.0, flags=USE_INDEX)
    assert home(m) == []
    assert m.true_position(0) == pytest.approx(15.0)
    assert m["joint.0.pos-cmd"] == 2.0


def test_a_limit_switch_serves_as_home_switch_where_limits_are_ignored() -> None:
    m = mill("free")
    m.place(0, 20.0)
    m.add_switch(0, "home+pos", 70.0, 120.0)
    homing(m, offset=70.0, home=60.0, search=30.0, latch=1.0, flags=IGNORE_LIMITS)
    assert home(m) == []
    assert m["joint.0.homed"]
    assert m.status.motion_state == 1


def test_a_limit_switch_ends_homing_and_switches_off_where_limits_are_not_ignored() -> None:
    m = mill("free")
    m.place(0, 20.0)
    m.add_switch(0, "pos", 70.0, 120.0)
    homing(m, search=30.0, latch=1.0)
    errors = home(m)
    assert "joint 0 on limit switch error" in errors
    assert not m["joint.0.homed"]
    assert m.status.motion_state == 0
    assert within_limits(m)


def test_a_search_without_a_switch_ends_after_the_joints_travel() -> None:
    m = mill("free", limit=50.0)
    m.place(0, 0.0)
    homing(m, search=50.0, latch=1.0)
    assert home(m) == [
        "Homing of joint 0 failed in state INITIAL_SEARCH_WAIT: end of move without the event that was searched"
    ]
    assert m.true_position(0) <= 1.25 * 100.0 + 1e-6
    assert not m["joint.0.homed"]
    assert m["joint.0.home-state"] == 0


@pytest.mark.parametrize(
    ("entries", "reason"),
    [
        ({"search": 10.0, "latch": 0.0}, "HOME_SEARCH_VEL needs a HOME_LATCH_VEL that is not 0"),
        ({"search": 0.0, "latch": 1.0}, "HOME_LATCH_VEL needs a HOME_SEARCH_VEL or HOME_USE_INDEX"),
    ],
)
def test_entries_that_do_not_fit_each_other_are_named(entries: dict[str, float], reason: str) -> None:
    m = mill("free")
    homing(m, **entries)
    (error,) = home(m)
    assert reason in error
    assert "joint 0" in error


def test_a_closed_shared_switch_refuses_to_start() -> None:
    m = mill("free")
    m["joint.0.home-sw-in"] = 1
    homing(m, search=10.0, latch=1.0, flags=SHARED)
    (error,) = home(m)
    assert "shared home switch is closed already" in error


def test_an_absolute_encoder_gives_the_position_without_a_move() -> None:
    m = mill("off")
    m.loopback = False
    m["joint.0.motor-pos-fb"] = 12.5
    m.step(500)
    m.loopback = True
    bring_to(m, "free")
    homing(m, offset=2.0, flags=ABSOLUTE | NO_REHOME | NO_FINAL_MOVE)
    assert home(m) == []
    assert m["joint.0.homed"]
    assert m["joint.0.pos-cmd"] == pytest.approx(14.5)
    assert m["joint.0.motor-pos-cmd"] == pytest.approx(12.5)
    assert home(m) == []
    assert m["joint.0.pos-cmd"] == pytest.approx(14.5)


def test_home_all_goes_through_the_sequence_in_order() -> None:
    m = mill("free")
    for joint, sequence in ((2, 0), (0, 1), (1, 1)):
        m.place(joint, 0.0)
        m.add_switch(joint, "home", 30.0, 200.0)
        homing(m, joint, search=40.0, latch=-2.0, sequence=sequence)
    m.send(C.JOINT_HOME, joint=-1)
    seen = []
    for _ in range(20_000):
        m.step()
        active = tuple(j for j in range(3) if m[f"joint.{j}.homing"])
        if active and (not seen or seen[-1] != active):
            seen.append(active)
        if m["motion.is-all-homed"]:
            break
    assert seen[0] == (2,)
    assert (0, 1) in seen
    assert m.errors() == []


def test_from_the_first_step_of_home_all_to_the_last_some_joint_homes_in_every_period() -> None:
    m = mill("free")
    for joint in range(3):
        homing(m, joint, sequence=joint)
    m.send(C.JOINT_HOME, joint=-1)
    while not m["motion.is-all-homed"]:
        m.step()
        assert m["motion.is-all-homed"] or any(m[f"joint.{joint}.homing"] for joint in range(3))


@pytest.mark.parametrize(
    ("sequences", "homed", "complaint"),
    [
        ((1, 2, 3), (True, True, True), None),
        ((-1, 1, 2), (True, True, True), None),
        ((0, 1, 1), (True, True, True), None),
        ((0, 1, 100), (True, True, False), None),
        ((0, 1, 3), (True, True, False), "Joint 2 is not homed with the others: no joint has HOME_SEQUENCE 2"),
        ((2, 3, 4), (False, False, False), "Joint 0 is not homed with the others: no joint has HOME_SEQUENCE 1"),
    ],
)
def test_home_all_starts_with_0_or_1_and_ends_at_the_first_gap(
    sequences: tuple[int, ...], homed: tuple[bool, ...], complaint: str | None
) -> None:
    m = mill("free")
    for joint, sequence in enumerate(sequences):
        homing(m, joint, sequence=sequence)
    assert home(m, -1) == ([complaint] if complaint else [])
    assert tuple(m[f"joint.{j}.homed"] for j in range(3)) == homed


def test_a_joint_with_a_positive_number_is_homed_alone_and_one_with_a_negative_with_its_partners() -> None:
    m = mill("free")
    for joint, sequence in enumerate((0, -1, 1)):
        homing(m, joint, sequence=sequence)
    assert home(m, 2) == []
    assert [m[f"joint.{j}.homed"] for j in range(3)] == [False, False, True]
    assert home(m, 1) == []
    assert [m[f"joint.{j}.homed"] for j in range(3)] == [False, True, True]


def test_a_wheel_does_not_move_one_side_of_a_gantry_and_says_so_once() -> None:
    m = mill("free")
    homing(m, 1, sequence=-1)
    m["joint.1.jog-enable"] = 1
    m["joint.1.jog-scale"] = 0.1
    for _ in range(5):
        m["joint.1.jog-counts"] += 3
        m.step()
    assert m["joint.1.pos-cmd"] == 0.0
    assert m.errors() == ["Cannot wheel jog joint 1 because home_sequence synchronized (-1)"]


def test_a_failed_joint_stops_the_rest_of_the_sequence() -> None:
    m = mill("free", limit=20.0)
    homing(m, 2, search=40.0, latch=2.0, sequence=0)  # there is no switch
    for joint in (0, 1):
        homing(m, joint, sequence=1)
    errors = home(m, -1)
    assert len(errors) == 1
    assert "joint 2" in errors[0]
    assert not m["joint.0.homed"]
    assert not m["joint.1.homed"]


def test_a_gantry_makes_its_final_move_together() -> None:
    m = configure(Motion("xyy"), axes=2)
    bring_to(m, "free")
    for joint, edge in ((1, 40.0), (2, 43.0)):
        m.place(joint, 0.0)
        m.add_switch(joint, "home", edge, 200.0)
        homing(m, joint, offset=50.0, home=10.0, search=30.0, latch=-2.0, final=20.0, sequence=-1)
    homing(m, 0, sequence=0)
    m.send(C.JOINT_HOME, joint=1)
    together = True
    for _ in range(30_000):
        m.step()
        moving = [m[f"joint.{j}.home-state"] == 21 for j in (1, 2)]
        together = together and moving[0] == moving[1]
        if m["joint.1.homed"] and m["joint.2.homed"]:
            break
    assert together
    assert m["joint.1.pos-cmd"] == m["joint.2.pos-cmd"] == 10.0
    assert m.true_position(2) - m.true_position(1) == pytest.approx(3.0, abs=0.01)
    assert not m["joint.0.homed"]
    assert m.send(C.JOG_CONT, joint=1, mode=1, vel=5.0) != 0, "one side of a gantry is not jogged alone"


@pytest.mark.parametrize("how", [C.ABORT, C.DISABLE, C.JOG_ABORT])
def test_homing_can_be_stopped_in_any_state_under_the_limits(how: C) -> None:
    rng = random.Random(int(how))
    for _ in range(150):
        m = mill("free")
        m.place(0, rng.uniform(-50, 50), 3.0, 0.0)
        m.add_switch(0, "home", 60.0, 200.0)
        homing(m, home=-30.0, search=70.0, latch=rng.choice([-5.0, 5.0]), flags=rng.choice([0, USE_INDEX]))
        m.send(C.JOINT_HOME, joint=0)
        m.step(rng.randrange(1, 6000))
        finished = m["joint.0.homed"]
        m.send(how, joint=0, mode=1)
        m.run_until_rest(200_000)
        assert within_limits(m)
        if how != C.JOG_ABORT:
            assert m["joint.0.home-state"] == 0
            assert m["joint.0.homed"] == finished
            assert not m["joint.0.index-enable"]
        else:
            assert m["joint.0.homed"], "a released jog key does not stop homing"


def test_homing_is_refused_while_inhibited_and_outside_of_joint_mode() -> None:
    m = mill("free")
    m["motion.homing-inhibit"] = 1
    assert "homing-inhibit" in home(m)[0]
    m = mill("coord")
    assert home(m) == ["must be in joint mode to home"]


def test_a_jog_is_refused_while_a_joint_is_homing_and_homing_goes_on() -> None:
    m = mill("free")
    homing(m, home=20.0)
    m.send(C.JOINT_HOME, joint=0)
    m.step(100)
    for joint in (0, 1):
        assert m.send(C.JOG_CONT, joint=joint, mode=1, vel=-20.0) != 0
        assert m.errors() == ["Can't jog any joints while homing."]
    m.run_until_rest()
    assert m["joint.0.pos-cmd"] == 20.0
    assert m["joint.0.homed"]


def test_homing_ends_the_jogs_that_are_running() -> None:
    m = mill("free")
    m.send(C.JOG_CONT, joint=1, mode=1, vel=50.0)
    m.step(200)
    homing(m, home=1.0)
    m.send(C.JOINT_HOME, joint=0)
    m.run_until_rest()
    assert m["joint.0.homed"]
    assert m["joint.1.vel-cmd"] == 0.0
    assert within_limits(m)


def test_an_inactive_joint_is_not_homed() -> None:
    m = configure(Motion("xyz"))
    m.send(C.JOINT_DEACTIVATE, joint=1)
    bring_to(m, "free")
    assert home(m, 1) == ["can't home a joint that is not active"]


def test_an_extra_joint_is_homed_and_then_led_by_its_pin() -> None:
    m = configure(Motion("xyz", num_extrajoints=1))
    for code, value in ((C.SET_JOINT_VEL_LIMIT, {"vel": 50.0}), (C.SET_JOINT_ACC_LIMIT, {"acc": 500.0})):
        m.send(code, joint=3, **value)
    m.send(C.SET_JOINT_HOMING_PARAMS, joint=3, offset=3.0, home=0.0, home_sequence=0)
    m.send(C.JOINT_ACTIVATE, joint=3)
    bring_to(m, "homed")
    assert m["joint.3.homed"]
    m["joint.3.posthome-cmd"] = 0.25
    m.step()
    assert m["joint.3.motor-pos-cmd"] == pytest.approx(0.25 - 3.0)
    m["joint.3.motor-pos-fb"] = 99.0
    m.loopback = False
    m.step(5)
    assert m.status.motion_state == 1, "its feedback does not count"
    assert m.send(C.JOINT_UNHOME, joint=3) != 0
    assert m.errors() == ["Cannot unhome extrajoint <3> with motion enabled"]
    assert m["joint.3.homed"]
    m.send(C.DISABLE)
    m.step(5)
    assert m.send(C.JOINT_UNHOME, joint=3) == 0
    assert not m["joint.3.homed"]


def test_unhome_forgets_one_all_or_the_volatile_joints() -> None:
    m = mill("homed")
    m.send(C.SET_JOINT_HOMING_PARAMS, joint=1, home_sequence=1, volatile_home=1)
    m.send(C.JOINT_UNHOME, joint=-2)
    m.step()
    assert [m[f"joint.{j}.homed"] for j in range(3)] == [True, False, True]
    m.send(C.JOINT_UNHOME, joint=0)
    m.step()
    assert [m[f"joint.{j}.homed"] for j in range(3)] == [False, False, True]
    m.send(C.JOINT_UNHOME, joint=-1)
    m.step()
    assert not m["motion.is-all-homed"]


def test_a_locking_indexer_is_unlocked_for_homing_and_locked_after() -> None:
    m = bring_to(configure(Motion("xyz", unlock_joints_mask=4)), "free")
    homing(m, 2, home=3.0, flags=UNLOCK_FIRST)
    m.send(C.JOINT_HOME, joint=2)
    m.step(10)
    assert m["joint.2.unlock"]
    assert not m["joint.2.homed"]
    m["joint.2.is-unlocked"] = 1
    m.step(2000)
    assert not m["joint.2.unlock"]
    assert m["joint.2.pos-cmd"] == 3.0
    assert not m["joint.2.homed"]
    m["joint.2.is-unlocked"] = 0
    m.step(10)
    assert m["joint.2.homed"]


def test_after_homing_the_tool_position_is_known() -> None:
    m = mill("coord")
    assert m.status.carte_pos_cmd_ok
    assert line(m, 1, 2, 3) == 0
    m.run_until_rest()
    assert [m[f"axis.{a}.pos-cmd"] for a in "xyz"] == [1.0, 2.0, 3.0]
