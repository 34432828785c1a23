"""Time the servo cycle of motion in this process: average, spread and worst, idle and cutting, for 3 and 9 joints.

    python -m benchmarks.servo_bench [--periods 200000]

Only motion itself is timed (command handler and controller in the stepped simulator); `servo_time` in EMCMOT_STATUS
tells what a period takes in the realtime host, with pins and buffers.
"""

from __future__ import annotations

import argparse
import time

from emcmot.sim import Motion
from nml.emc.emcmot import MotCommand as C

CHUNK = 50  # periods timed together: one alone is near the clock's resolution


def machine(coordinates: str) -> Motion:
    """A homed machine in coordinated mode."""
    m = Motion(coordinates)
    for joint in range(len(coordinates)):
        m.send(C.SET_JOINT_POSITION_LIMITS, joint=joint, minLimit=-1000.0, maxLimit=1000.0)
        m.send(C.SET_JOINT_VEL_LIMIT, joint=joint, vel=100.0)
        m.send(C.SET_JOINT_ACC_LIMIT, joint=joint, acc=1000.0)
        m.send(C.SET_JOINT_HOMING_PARAMS, joint=joint, home_sequence=0)
        m.send(C.JOINT_ACTIVATE, joint=joint)
    m.send(C.ENABLE)
    m.step(2)
    m.send(C.JOINT_HOME, joint=-1)
    m.run_until_rest()
    m.send(C.COORD)
    m.step(2)
    return m


def feed(m: Motion, axes: int, first: int) -> int:
    """Keep the planner's queue filled with short blended moves."""
    for _ in range(max(0, m.status.queueFree - 1000)):
        first += 1
        pos = [0.3 * ((first * (axis + 3)) % 7) for axis in range(axes)] + [0.0] * (9 - axes)
        how = {"vel": 90.0, "ini_maxvel": 100.0, "acc": 1000.0, "termCond": 2, "tolerance": 0.1, "motion_type": 2}
        m.send(C.SET_LINE, id=first, pos=pos, **how)
    return first


def measure(coordinates: str, periods: int, cutting: bool) -> list[float]:
    """Microseconds a period, one figure for each CHUNK."""
    m = machine(coordinates)
    figures, move = [], 0
    for _ in range(periods // CHUNK):
        if cutting:
            move = feed(m, len(coordinates), move)
        start = time.perf_counter()
        m.step(CHUNK)
        figures.append((time.perf_counter() - start) * 1e6 / CHUNK)
    return figures


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--periods", type=int, default=200_000)
    periods = parser.parse_args().periods
    print(f"us a period, over {CHUNK} periods each")
    print(f"{'joints':>6}{'doing':>9}{'average':>10}{'median':>10}{'99.9 %':>10}{'worst':>10}")
    for coordinates in ("xyz", "xyzabcuvw"):
        for cutting in (False, True):
            figures = sorted(measure(coordinates, periods, cutting))
            average = sum(figures) / len(figures)
            marks = [average, figures[len(figures) // 2], figures[int(len(figures) * 0.999)], figures[-1]]
            doing = "cutting" if cutting else "idle"
            print(f"{len(coordinates):>6}{doing:>9}" + "".join(f"{value:10.2f}" for value in marks))


if __name__ == "__main__":
    main()
