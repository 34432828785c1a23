#!/usr/bin/env python3
"""The display program of the benchmarks: drives a controller through ``import linuxcnc`` and writes what it measured.

Started by either controller's launcher as [DISPLAY]DISPLAY; uses nothing but the stock Python interface. Results go to
``results.json`` in the configuration's folder. Arguments: ``-ini FILE`` (from the launcher).
"""

import json
import os
import subprocess
import sys
import time

import linuxcnc

FOLDER = os.path.dirname(os.path.abspath(sys.argv[sys.argv.index("-ini") + 1])) if "-ini" in sys.argv else os.getcwd()


def wait(stat, condition, timeout):
    """Poll until ``condition(stat)``; SystemExit with its name when that takes longer than ``timeout`` s."""
    end = time.monotonic() + timeout
    while True:
        try:
            stat.poll()
        except linuxcnc.error:  # LinuxCNC's status buffer now and then refuses a read under load
            time.sleep(0.05)
            continue
        if condition(stat):
            return
        if time.monotonic() > end:
            raise SystemExit(f"timeout: state={stat.task_state} mode={stat.task_mode} interp={stat.interp_state}")
        time.sleep(0.005)


def switch_on(command, stat):
    """Out of E-stop, on, homed."""
    command.state(linuxcnc.STATE_ESTOP_RESET)
    wait(stat, lambda s: s.task_state == linuxcnc.STATE_ESTOP_RESET, 10)
    command.state(linuxcnc.STATE_ON)
    wait(stat, lambda s: s.task_state == linuxcnc.STATE_ON, 10)
    command.mode(linuxcnc.MODE_MANUAL)
    command.wait_complete()
    for joint in range(3):
        command.home(joint)
    wait(stat, lambda s: all(s.homed[:3]), 30)


def mdi_round_trips(command, count=60):
    """Times in s of ``mdi`` plus ``wait_complete`` for a block that moves nothing."""
    command.mode(linuxcnc.MODE_MDI)
    command.wait_complete()
    times = []
    for i in range(count):
        start = time.perf_counter()
        command.mdi(f"#100={i}")
        command.wait_complete()
        times.append(time.perf_counter() - start)
    return times


def run(command, stat, name):
    """Machining time of a program in s: from start of motion to idle."""
    command.mode(linuxcnc.MODE_MDI)
    command.wait_complete()
    first = "X100 Y0" if name.startswith("short") else "X30 Y0 Z-1" if name.startswith("wavy") else "X0 Y0 Z0"
    command.mdi(f"G0 {first}")
    command.wait_complete(60)
    wait(stat, lambda s: s.interp_state == linuxcnc.INTERP_IDLE and s.inpos, 60)
    command.mode(linuxcnc.MODE_AUTO)
    command.wait_complete()
    command.program_open(os.path.join(FOLDER, name))
    command.wait_complete()
    time.sleep(0.2)
    command.auto(linuxcnc.AUTO_RUN, 0)
    wait(stat, lambda s: s.interp_state != linuxcnc.INTERP_IDLE and not s.inpos, 30)
    start = time.perf_counter()
    wait(stat, lambda s: s.interp_state == linuxcnc.INTERP_IDLE and s.inpos, 300)
    return time.perf_counter() - start


def polls(stat, seconds=1.0):
    """Calls of ``poll`` in a second."""
    count, end = 0, time.perf_counter() + seconds
    while time.perf_counter() < end:
        for _ in range(1000):
            stat.poll()
        count += 1000
    return count / seconds


def servo_cycle():
    """Mean run time of the motion controller's function in ns, from its ``.time`` pin."""
    samples = []
    for _ in range(20):
        out = subprocess.run(["halcmd", "getp", "motion-controller.time"], capture_output=True, text=True)
        if out.returncode == 0:
            samples.append(float(out.stdout))
        time.sleep(0.02)
    return samples


def main():
    results = {"ready_at": time.time()}
    stat, command = linuxcnc.stat(), linuxcnc.command()
    wait(stat, lambda s: s.task_state in (1, 2, 3, 4), 20)
    results["ready_at"] = time.time()
    try:
        switch_on(command, stat)
        results["servo_ticks"] = servo_cycle()
        results["polls"] = polls(stat)
        results["mdi"] = mdi_round_trips(command)
        for name in ("zigzag.ngc", "wavy_curve.ngc", "short_circle.ngc"):
            results[name] = run(command, stat, name)
    finally:
        with open(os.path.join(FOLDER, "results.json"), "w") as out:
            json.dump(results, out)


main()
