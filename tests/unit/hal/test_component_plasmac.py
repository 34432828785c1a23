"""The plasma torch's controller on a simulated table: what it must do, and what it must never do."""

from __future__ import annotations

import itertools
import random

import pytest

from hal._messages import hear
from hal.realtime import Host
from nml.errors import HalError
from tests.support.plasma import Scenario, Step, run
from tests.unit.hal.conftest import Bench

IDLE, CUTTING, PROBE_TEST = 0, 11, 21
BEGIN: Step = (5, {"program-is-idle": 0, "program-is-running": 1, "offsets-active": 1, "cutting-start": 0})
CUT: Step = (300, {"cutting-start": 1, "arc-voltage-in": 100})


def states(seen: list[dict[str, float]]) -> list[int]:
    """The states in their order, each once."""
    return [int(state) for state, _ in itertools.groupby(now["state-out"] for now in seen)]


def test_a_cut_goes_through_its_states_and_holds_the_feed_until_the_torch_cuts(host: Host) -> None:
    end: Step = (120, {"cutting-start": 0, "arc-voltage-in": 0})
    seen = run(host, Scenario([BEGIN, CUT, end], {"puddle-jump-height": 80, "pause-at-end": 0.02}))
    assert states(seen) == [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 14, 16, 0]
    cutting = [now for now in seen if now["state-out"] == CUTTING]
    assert all(now["z-height"] == pytest.approx(1.5, abs=1e-4) for now in cutting[1:])
    for now in seen:
        if 1 <= now["state-out"] <= 8 or 13 <= now["state-out"] <= 14:
            assert now["feed-hold"], now["state-out"]
    assert seen[-1]["z-height"] == pytest.approx(20.0, abs=1e-4), "the safe height"
    assert (seen[-1]["feed-hold"], seen[-1]["torch-on"], seen[-1]["pierce-count"]) == (0, 0, 1)


@pytest.mark.parametrize("change", [{"machine-is-on": 0}, {"program-is-idle": 1, "program-is-running": 0},
                                    {"program-is-paused": 1, "program-is-running": 0}, {"breakaway": 1},
                                    {"cutting-start": 0}])  # fmt: skip
@pytest.mark.parametrize("when", [190, 215, 260, 310])
def test_the_torch_is_off_in_the_period_of_a_stop(host: Host, when: int, change: dict[str, float]) -> None:
    seen = run(host, Scenario([BEGIN, (when, CUT[1]), (150, change)]))
    stop = BEGIN[0] + when
    assert seen[stop - 1]["torch-on"]
    assert [now["torch-on"] for now in seen[stop:]] == [0] * 150
    if "machine-is-on" in change:
        assert {now["z-offset-counts"] for now in seen[stop:]} == {0}


@pytest.mark.parametrize("feed", [600, 3000, 30000])
def test_a_probe_that_finds_nothing_stays_above_the_lower_limit(host: Host, feed: float) -> None:
    more: Step = (2500 if feed == 600 else 500, {"cutting-start": 1})
    seen = run(host, Scenario([BEGIN, more], {"axis-z-min-limit": 2, "probe-feed-rate": feed}, surface=-100.0, z=20.0))
    assert min(now["z-height"] for now in seen[2:]) >= 0.25, "above the limit, as nothing was felt"
    assert (seen[-1]["state-out"], seen[-1]["program-pause"], seen[-1]["z-offset-counts"]) == (IDLE, 1, 0)


def test_a_test_of_the_probe_that_finds_nothing_waits_below(host: Host) -> None:
    steps: list[Step] = [(1, {"probe-test": 0}), (399, {"probe-test": 1}), (200, {"probe-test": 0})]
    seen = run(host, Scenario(steps, surface=-100.0, z=25.0))
    assert (seen[399]["state-out"], seen[399]["probe-test-error"]) == (PROBE_TEST, 1)
    assert (seen[-1]["state-out"], seen[-1]["probe-test-error"], seen[-1]["z-offset-counts"]) == (IDLE, 0, 0)


def test_a_torch_that_probed_from_beside_is_back_before_the_program_goes_on(host: Host) -> None:
    given = {"ohmic-probe-enable": 1, "offset-probe-x": 5, "offset-probe-y": -3}
    seen = run(host, Scenario([BEGIN, (100, {"cutting-start": 1}), (150, {"cutting-start": 0})], given, surface=None))
    assert max(now["x-offset-counts"] for now in seen) > 490_000
    free = next(i for i, now in enumerate(seen) if i > BEGIN[0] and not now["feed-hold"])
    assert all(now["x-offset-counts"] == now["y-offset-counts"] == 0 for now in seen[free:])
    assert not seen[-1]["ohmic-enable"]


def test_a_relay_that_senses_the_material_is_debounced(host: Host) -> None:
    inputs = [1, 1, 0, 1, 1, 1, 1, 1, 0, 0, 1, 0, 0, 0, 0, 0]
    steps = [BEGIN, (100, {"cutting-start": 1}), *[(1, {"ohmic-sense-in": value}) for value in inputs]]
    seen = run(host, Scenario(steps, {"ohmic-probe-enable": 1, "ohmic-sense-off-delay": 2}, surface=None))
    shown = [int(now["ohmic-sense-out"]) for now in seen[-len(inputs) :]]
    assert shown == [0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0]


@pytest.mark.parametrize("counts", [0, -4, 1, 1000, 2_000_000_000])
def test_a_steady_voltage_of_any_number_of_readings_is_no_trouble(host: Host, counts: int) -> None:
    fast: Step = (900, {"current-velocity": 50})
    seen = run(host, Scenario([BEGIN, CUT, fast], {"thc-auto": 1, "thc-sample-counts": counts}))
    assert seen[-1]["target-volts"] == pytest.approx(100.0)


def test_no_units_and_no_resolution_move_nothing(host: Host) -> None:
    seen = run(host, Scenario([BEGIN, CUT], {"units-per-mm": 0, "resolution": 0}))
    assert {now["z-offset-counts"] for now in seen} == {0}


@pytest.mark.parametrize("seed", range(4))
def test_the_torch_is_never_on_where_it_must_not_be(host: Host, seed: int) -> None:
    chance = random.Random(seed)
    names = ["machine-is-on", "program-is-paused", "program-is-running", "cutting-start", "breakaway", "ohmic-probe",
             "torch-off", "probe-test", "cut-recovery", "consumable-change", "homed", "offsets-active"]  # fmt: skip
    steps: list[Step] = [BEGIN, (200, CUT[1])]
    steps += [(chance.randint(1, 60), {chance.choice(names): chance.randrange(2)}) for _ in range(120)]
    scenario = Scenario(steps, {"ohmic-probe-enable": 1, "x-offset": 90000, "xy-feed-rate": 6000})
    seen = run(host, scenario)
    for row, now in zip(scenario.rows(), seen, strict=True):
        given = dict(zip(scenario.streamed, row, strict=True))
        assert not now["torch-on"] or given.get("machine-is-on", 1), "the machine is off"
        assert not now["torch-on"] or not given.get("torch-off", 0), "the program wants it off"
        assert not now["torch-on"] or now["state-out"] in range(6, 14), now["state-out"]


def test_each_state_is_said_where_that_is_wanted(bench: Bench) -> None:
    bench.load("plasmac")
    bench.use("plasmac").set(debug_print=True, machine_is_on=True, units_per_mm=1.0, torch_pulse_start=True)
    hear()
    bench.run("plasmac", 3)
    bench.set(torch_pulse_start=False)
    bench.run("plasmac", 3)
    assert hear() == ["TORCHPULSE", "IDLE"]


def test_there_is_one(host: Host) -> None:
    with pytest.raises(HalError, match="plasmac: count=2: from 1 to 1 would be right"):
        host.load("plasmac", ["count=2"])
