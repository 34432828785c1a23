"""`plasmac` beside Debian's: with the same inputs on the same table every output is the same in every period."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from hal.realtime import REALTIME_VARIABLE, Host
from tests.peer.test_hal_behaviour import numbers
from tests.peer.test_hal_peer import PEER, peer
from tests.support.plasma import WIDEST, Scenario, Step, hal_file, output_names, run
from tests.support.shield import reason_to_skip

pytestmark = [
    pytest.mark.peer,
    pytest.mark.process,
    pytest.mark.skipif(PEER is None, reason="/usr/bin/halrun (linuxcnc-uspace) is not installed"),
    pytest.mark.skipif(reason_to_skip() is not None, reason=reason_to_skip() or ""),
]

IDLE = {"program-is-idle": 1, "program-is-running": 0, "program-is-paused": 0}
RUNNING = {"program-is-idle": 0, "program-is-running": 1, "program-is-paused": 0}
PAUSED = {"program-is-paused": 1, "program-is-running": 0}
GOES_ON = {"program-is-paused": 0, "program-is-running": 1}
CUT = {"cutting-start": 1, "arc-voltage-in": 100}
NO_CUT = {"cutting-start": 0, "arc-voltage-in": 0, "arc-ok-in": 0, "current-velocity": 0}
AT_SPEED = {"current-velocity": 50, "motion-type": 2}
BEGIN: list[Step] = [
    (3, {**IDLE, "cutting-start": 0, "arc-voltage-in": 0, "arc-ok-in": 0, "current-velocity": 0, "motion-type": 0,
         "offsets-active": 0}),
    (3, {**RUNNING, "offsets-active": 1}),
]  # fmt: skip
PIERCED: list[Step] = [(180, {"cutting-start": 1}), (160, {"arc-voltage-in": 100, "arc-ok-in": 1}), (110, AT_SPEED)]
CUTTING: list[Step] = [(346, CUT), (110, AT_SPEED)]
END: list[Step] = [(100, NO_CUT), (60, IDLE), (10, {"offsets-active": 0})]
ERROR: list[Step] = [(300, CUT), (100, {**PAUSED, "arc-voltage-in": 0})]
OHMIC = {"ohmic-probe-enable": 1, "ohmic-max-attempts": 2, "ohmic-probe-offset": -0.2}
PLACE = {"axis-x-position": 100, "axis-y-position": 50, "xy-feed-rate": 6000}
PRINTED = 2e-6  # six digits after the point
NO_LOCK = {"voidlock-enable": 0}
VOLTS = (102, 104, 100, 98, 105, 99.3, 130, 200, 30)


def ramp(start: float, slope: float) -> Callable[[int], float]:
    """Volts that change in every period."""
    return lambda i: start + slope * i


def job(*steps: Step, **more: object) -> Scenario:
    """A program's steps."""
    return Scenario([*BEGIN, *steps], **more)  # type: ignore[arg-type]


def volts(*values: float) -> list[Step]:
    """Each for three periods."""
    return [(3, {"arc-voltage-in": value}) for value in values]


SCENARIOS = {
    "a cut, then another job": job(
        *PIERCED, *END, (5, {**RUNNING, "offsets-active": 1, "motion-type": 0}), *PIERCED, *END),
    "an arc by the power source": job(*PIERCED, *volts(*VOLTS), *END, given={"mode": 1}),
    "height control from outside": job(
        *PIERCED, (30, {"move-up": 1}), (30, {"move-up": 0, "move-down": 1}), (9, {"move-up": 1}), *END,
        given={"mode": 2, "pid-p-gain": 7.3},
    ),
    "half a period": job((600, CUT), (110, AT_SPEED), *volts(*VOLTS), period_ns=500_000),
    "half the resolution": job(*CUTTING, *volts(*VOLTS), given={**NO_LOCK, "resolution": 50, "pid-p-gain": 7.3}),
    "all gains": job(*CUTTING, *volts(*VOLTS), given={**NO_LOCK, "pid-i-gain": 30, "pid-d-gain": 0.02}),
    "puddle jump and a pause at the end": job(*PIERCED, *END, given={
        "puddle-jump-height": 80, "puddle-jump-delay": 0.0207, "pause-at-end": 0.0555, "pierce-delay": 0.0123}),
    "a pause at the end of a cut that did not begin": job(
        (150, {"cutting-start": 1}), (200, NO_CUT), given={"pause-at-end": 0.05, "cornerlock-enable": 0}),
    "a puddle jump to nowhere": job(*PIERCED, *END, given={"puddle-jump-delay": 0.02, "cornerlock-enable": 0}),
    "a puddle jump without a delay": job(*PIERCED, *END, given={"puddle-jump-height": 150}),
    "a dry run": job(*PIERCED, *END, given={"torch-enable": 0}),
    "no arc is wanted": job((340, {"cutting-start": 1}), (110, AT_SPEED), *END, given={"ignore-arc-ok-0": 1}),
    "a mesh": job(*PIERCED, (50, {"arc-voltage-in": 0}), *END, given={"mesh-enable": 1}),
    "no arc at all": job((800, {"cutting-start": 1}), (150, PAUSED), (300, GOES_ON), (20, IDLE)),
    "the arc is lost": job(
        *PIERCED, (30, {"arc-voltage-in": 0}), (100, PAUSED), (10, {"current-velocity": 0}),
        (300, {"arc-voltage-in": 100, **GOES_ON}), (50, {"current-velocity": 50}), *END),
    "the voltage drops too low": job(*CUTTING, *volts(95, 84, 101), given={**NO_LOCK, "low-cut-volts": 90}),
    "a pause in a cut": job(*PIERCED, (100, PAUSED), (300, GOES_ON), (50, {}), *END),
    "a pause, then the end": job(*PIERCED, (100, PAUSED), (30, IDLE), (10, NO_CUT), (20, {"offsets-active": 0})),
    "the program is aborted": job(*PIERCED, (60, IDLE), (60, NO_CUT), (20, {"offsets-active": 0})),
    "the machine goes off": job(
        *PIERCED, (50, {"machine-is-on": 0}), (60, NO_CUT), (20, {**IDLE, "offsets-active": 0}),
        (20, {"machine-is-on": 1})),
    "the torch is switched off": job(*PIERCED, (50, {"torch-off": 1}), (30, {"torch-off": 0}), *END),
    "nothing is there": job((400, {"cutting-start": 1}), (100, PAUSED), (100, GOES_ON), (20, NO_CUT), surface=-100.0),
    "a test of the probe": job((280, {**IDLE, "probe-test": 1}), (100, {"probe-test": 0}), (20, {"offsets-active": 0})),
    "a test of the probe on nothing": job((340, {**IDLE, "probe-test": 1}), (110, {"probe-test": 0}), surface=-100.0),
    "high material": job((380, {**IDLE, "probe-test": 1}), (100, {"probe-test": 0}), surface=30.0,
                         given={"probe-final-speed": 3}),
    "spots": job((380, {"spotting-start": 1}), (50, {"arc-voltage-in": 100}), (100, {"spotting-start": 0}), (100, IDLE),
                 given={"spotting-threshold": 50, "spotting-time": 51}),
    "a scribe": job(
        (80, {"scribe-start": 1}), (40, PAUSED), (90, GOES_ON), (20, {"scribe-start": 0}), (30, IDLE),
        given={"scribe-arm-delay": 0.02, "scribe-on-delay": 0.03}),
    "a pulse": job((3, IDLE), (50, {"torch-pulse-start": 1}), (90, {"torch-pulse-start": 0}),
                   (150, {"torch-pulse-start": 1}), (120, {"torch-pulse-start": 0})),
    "ohmic probing": job(
        (125, {"cutting-start": 1, "float-switch": 0, "ohmic-probe": 0}), (20, {"ohmic-probe": 1}),
        (40, {"ohmic-probe": 0}), given=OHMIC, surface=None),
    "ohmic probing fails": job(
        (125, {"cutting-start": 1, "float-switch": 0}), *[(n, {"float-switch": k}) for n, k in
        ((60, 1), (100, 0), (60, 1), (100, 0), (60, 1), (100, 0))], given=OHMIC, surface=None),
    "an ohmic short": job(
        (50, {"cutting-start": 1, "ohmic-probe": 1}), (60, {"ohmic-probe": 0}), given=OHMIC, surface=None),
    "a probe beside the torch": job(
        (150, {"cutting-start": 1, "ohmic-probe": 0}), (60, {"ohmic-probe": 1}), (150, {"ohmic-probe": 0}),
        surface=None, given={**OHMIC, **PLACE, "offset-probe-x": 5, "offset-probe-y": -3, "offset-probe-delay": 0.09}),
    "the torch breaks away": job(
        (300, {**CUT, "breakaway": 0}), (60, {"breakaway": 1}), (100, PAUSED), (20, {"breakaway": 0}), (50, GOES_ON)),
    "the torch touches something": job(
        (50, {"float-switch": 1}), (50, IDLE), (50, {"override-jog": 1}), (50, {"float-switch": 0}), surface=None),
    "a cut by hand": Scenario([(5, {**BEGIN[0][1], "offsets-active": 1}), (300, CUT), (90, AT_SPEED),
                               (60, {"cutting-start": 0}), (20, {"offsets-active": 0})]),
    "consumables are changed": job(
        *ERROR, (40, {"consumable-change": 1}), (20, GOES_ON), (20, {"consumable-change": 0}), (100, {}),
        given={**PLACE, "x-offset": 20000, "y-offset": -10000}),
    "motion on the path": job(
        *ERROR, (3, {"paused-motion-speed": 0.5}), (20, GOES_ON), (3, {"paused-motion-speed": 0}), (20, PAUSED),
        (5, {"paused-motion-speed": -0.3}), (20, GOES_ON), (3, {"paused-motion-speed": 0}), (20, PAUSED),
        (20, GOES_ON)),
    "recovery beside the cut": job(
        *ERROR, (5, {"cut-recovery": 1}), (30, {"x-offset": 20000, "y-offset": -10000}), (20, GOES_ON),
        (400, {"arc-voltage-in": 100}), given=PLACE),
    "recovery by the laser": job(
        *ERROR, (5, {"cut-recovery": 1}), (30, {"laser-recovery-start": 1}), (30, {"laser-recovery-start": 0}),
        (30, {"x-offset": 20000, "y-offset": -10000}), (60, {"cut-recovery": 0}),
        given={**PLACE, "laser-x-offset": -30000, "laser-y-offset": 5000}),
    "recovery is given up": job(
        *ERROR, (5, {"cut-recovery": 1}), (40, {"x-offset": 20000, "y-offset": -10000}), (30, IDLE), (10, NO_CUT),
        given=PLACE),
    "the material is known": job(
        *CUTTING, *volts(95, 95, 95, 100), (60, {**NO_CUT, "axis-x-position": 103}), (150, CUT),
        (60, {**NO_CUT, "axis-x-position": 125}), (60, CUT), given={**NO_LOCK, **PLACE, "skip-ihs-distance": 10}),
    "corners": job(*CUTTING, *[(9, {"current-velocity": v}) for v in (45, 44.9, 49, 49.94, 50, 20, 50)], given=NO_LOCK),
    "voids": job(*CUTTING, (8, {"arc-voltage-in": ramp(100, 5)}), (20, {"arc-voltage-in": 140}),
                 (8, {"arc-voltage-in": ramp(140, -5)}), (20, {"arc-voltage-in": 100})),
    "height control by itself": job(
        (300, CUT), (100, {"arc-voltage-in": ramp(100, 0.05)}), (60, AT_SPEED), given={"thc-auto": 1}),
    "the operator's height": job(
        *CUTTING, (15, {"height-override": 13}), (15, {"height-override": -20}), given=NO_LOCK),
    "height control is switched": job(*CUTTING, *[(20, {name: value, "arc-voltage-in": 104}) for name, value in (
        ("thc-enable", 0), ("thc-enable", 1), ("thc-disable", 1), ("thc-disable", 0), ("mesh-enable", 1),
        ("mesh-enable", 0))], given=NO_LOCK),
    "the feed rate is reduced": job(*CUTTING, *[(5, {"feed-reduction": share}) for share in (50, 5, 100, 150, 60, 0)],
                                    given=NO_LOCK),
    "readings of the voltage": job(
        *[(5, {"arc-voltage-in": v}) for v in (10, 0.05, -0.1, 5.05)], (10, {"lowpass-frequency": 100}),
        (10, {"arc-voltage-in": 10}), given={"arc-voltage-offset": 5, "arc-voltage-scale": 2, "lowpass-frequency": 0}),
    "an unsteady arc": job(
        (194, {"cutting-start": 1}),
        *[(1, {"arc-voltage-in": v}) for v in [100, 114] * 8 + [100] * 14 + [0] + [100] * 4],
        given={"arc-fail-delay": 5, "pierce-delay": 10}),
    "no safe height": job(*CUTTING, *END, given={"safe-height": 0}, z=25.0),
}  # fmt: skip


@pytest.mark.parametrize("name", SCENARIOS)
def test_plasmac_does_what_the_peer_does(name: str, own_namespace: str, monkeypatch: pytest.MonkeyPatch) -> None:
    scenario = SCENARIOS[name]
    monkeypatch.setenv(REALTIME_VARIABLE, "0")
    host = Host()
    try:
        ours = run(host, scenario)
        names = output_names(host)
        text, files = hal_file(host, scenario)
    finally:
        host.close()
    rows = numbers(peer(text, files))
    assert len(rows) == scenario.periods * -(-len(names) // WIDEST), "the peer did not run"
    theirs = [
        dict(zip(names, [v for k in range(i, len(rows), scenario.periods) for v in rows[k]], strict=True))
        for i in range(scenario.periods)
    ]
    for i, (mine, expected) in enumerate(zip(ours, theirs, strict=True)):
        different = {n: (mine[n], expected[n]) for n in names if abs(mine[n] - expected[n]) > PRINTED}
        assert not different, f"period {i}: ours, theirs"
