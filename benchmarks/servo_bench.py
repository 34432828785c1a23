"""Time the servo cycle of motion in this process: average, spread and worst, idle and cutting, for 3 and 9 joints.

    python -m benchmarks.servo_bench [--periods 200000]

The first rows time motion itself (the stepped simulator). The last are what motion-controller measures of itself in a
realtime host, an idle machine at 1 kHz: with its HAL pins copied in and out and its status published.
"""

from __future__ import annotations

import argparse
import os
import time

from emcmot.sim import Motion
from hal.realtime import Host
from nml.channel import Channel
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


def in_the_host(coordinates: str, seconds: float = 3.0) -> list[float]:
    """Microseconds of motion-controller, for as many periods as a reader of the status gets hold of."""
    os.environ["PYEMC_NAMESPACE"] = f"servo_bench_{os.getpid()}"
    host = Host()
    status = Channel(None, "emcmotStatus", "emc")
    try:
        host.load("trivkins", [f"coordinates={coordinates}"])
        host.load("motmod", [f"num_joints={len(coordinates)}"])
        for joint in range(len(coordinates)):
            host.hal.net(f"pos{joint}", [f"joint.{joint}.motor-pos-cmd", f"joint.{joint}.motor-pos-fb"])
        for function in ("motion-command-handler", "motion-controller"):
            host.add_function(function, "servo-thread")
        host.hal.start_threads()
        figures, end = [], time.monotonic() + seconds
        while time.monotonic() < end:
            message = status.read()
            if message is not None:
                figures.append(message.servo_time * 1e6)
            time.sleep(0.0005)
        return figures
    finally:
        host.close()
        status.close()


def show(coordinates: str, doing: str, figures: list[float]) -> None:
    """One row of a table."""
    figures = sorted(figures)
    marks = [sum(figures) / len(figures), figures[len(figures) // 2], figures[int(len(figures) * 0.999)], figures[-1]]
    print(f"{len(coordinates):>6}{doing:>9}" + "".join(f"{value:10.2f}" for value in marks))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--periods", type=int, default=200_000)
    periods = parser.parse_args().periods
    print(f"us a period, over {CHUNK} periods each")
    print(f"{'joints':>6}{'doing':>9}{'average':>10}{'median':>10}{'99.9 %':>10}{'worst':>10}")
    for coordinates in ("xyz", "xyzabcuvw"):
        for cutting in (False, True):
            show(coordinates, "cutting" if cutting else "idle", measure(coordinates, periods, cutting))
    for coordinates in ("xyz", "xyzabcuvw"):
        show(coordinates, "in host", in_the_host(coordinates))


if __name__ == "__main__":
    main()
