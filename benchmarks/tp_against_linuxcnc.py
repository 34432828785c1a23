#!/usr/bin/env python3
"""Machining times of the corpus: ours, LinuxCNC's and the time-optimal bound, in servo periods of the same machine.

    python benchmarks/tp_against_linuxcnc.py [--user NAME] [--only NAME ...]

Every job of tp_corpus is written as G-code. LinuxCNC (Debian's package; run as an ordinary user in namespaces of its
own) runs it for real, and its joint commands are sampled in every servo period, so a slow host does not count. Ours is
the forecast of the same program and INI file: the same planner that motion steps.
"""

from __future__ import annotations

import argparse
import json
import os
import pwd
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table
from tp_corpus import AMAX, CORPUS, DT, VMAX, Job, bound

from emcmot.forecast import forecast
from emcmot.forecast_machine import Machine
from emcmot.tp.verifier import Arc, Line, verify
from nml.inifile import IniFile

Array = NDArray[np.float64]
AXES = "XYZABC"
STOCK = Path("/usr/bin/linuxcnc")
SAMPLES = "samples.txt"
CHECKED = 1500  # positions of LinuxCNC that are compared with the path

INI = """\
[EMC]
MACHINE = corpus
VERSION = 1.1
[DISPLAY]
DISPLAY = {folder}/run.py
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[RS274NGC]
PARAMETER_FILE = {folder}/corpus.var
[EMCMOT]
EMCMOT = motmod
COMM_TIMEOUT = 1.0
SERVO_PERIOD = 1000000
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.1
TOOL_TABLE = {folder}/corpus.tbl
[HAL]
HALFILE = {folder}/corpus.hal
[TRAJ]
COORDINATES = X Y Z A B C
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
MAX_LINEAR_VELOCITY = 100
MAX_LINEAR_ACCELERATION = 1e9
[KINS]
KINEMATICS = trivkins coordinates=XYZABC
JOINTS = 6
"""

AXIS = """\
[{section}]
TYPE = {type}
HOME = 0
MAX_VELOCITY = {vel}
MAX_ACCELERATION = {acc}
MIN_LIMIT = -1e6
MAX_LIMIT = 1e6
FERROR = 1000
MIN_FERROR = 1000
HOME_SEQUENCE = 0
"""

HAL = """\
loadrt [KINS]KINEMATICS
loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS
loadrt sampler depth=20000 cfg=ffffffb
addf motion-command-handler servo-thread
addf motion-controller servo-thread
addf sampler.0 servo-thread
net estop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
net prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared
net change iocontrol.0.tool-change => iocontrol.0.tool-changed
net job motion.digital-out-00 => sampler.0.pin.6
"""

RUN = """\
#!/usr/bin/python3
import json, os, subprocess, time
import linuxcnc
folder = os.path.dirname(os.path.abspath(__file__))
stat, command = linuxcnc.stat(), linuxcnc.command()
def wait(condition, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        stat.poll()
        if condition():
            return
        time.sleep(0.01)
    raise SystemExit("timeout")
def mdi(text):
    command.mode(linuxcnc.MODE_MDI)
    command.wait_complete()
    command.mdi(text)
    command.wait_complete(120)
    wait(idle, 120)
    time.sleep(0.3)
idle = lambda: stat.interp_state == linuxcnc.INTERP_IDLE and stat.inpos and stat.queue == 0
command.state(linuxcnc.STATE_ESTOP_RESET)
wait(lambda: stat.task_state != linuxcnc.STATE_ESTOP, 20)
command.state(linuxcnc.STATE_ON)
wait(lambda: stat.task_state == linuxcnc.STATE_ON, 20)
command.home(-1)
wait(lambda: all(stat.homed[:6]), 30)
sampler = subprocess.Popen(["halsampler", "-t", os.path.join(folder, "samples.txt")])
done = []
for name in json.load(open(os.path.join(folder, "jobs.json"))):
    mdi("G53 G0 X0 Y0 Z0 A0 B0 C0")
    mdi("M64 P0")
    command.mode(linuxcnc.MODE_AUTO)
    command.wait_complete()
    command.program_open(os.path.join(folder, name + ".ngc"))
    command.auto(linuxcnc.AUTO_RUN, 0)
    wait(lambda: stat.interp_state != linuxcnc.INTERP_IDLE, 30)
    wait(idle, 900)
    mdi("M65 P0")
    done.append(name)
    json.dump(done, open(os.path.join(folder, "done.json"), "w"))
time.sleep(1)
sampler.terminate()
sampler.wait()
"""

ENTER = """\
ip link set lo up && mount -t tmpfs tmpfs /tmp || exit 77
cd "$1" && export HOME="$1" USER="$2" PATH=/usr/bin:/bin:/usr/sbin:/sbin
exec su "$2" -s /bin/sh -c 'HOME=$PWD exec linuxcnc -r corpus.ini' > machine.log 2>&1
"""


def g_code(job: Job) -> str:
    """A job as a program; the machine stands at the origin."""
    lines = ["G21 G90 G94 G17", f"G64 P{job.tolerance}", f"F{60 * job.feed}"]
    at = np.zeros(3)
    for move in job.moves:
        end = move[0]
        words = " ".join(f"{AXES[axis]}{value:.6f}" for axis, value in enumerate(end))
        if len(move) == 1:
            lines.append(f"G1 {words}")
        else:
            center = move[1] - at
            lines.append(f"{'G3' if move[2] >= 0 else 'G2'} {words} I{center[0]:.6f} J{center[1]:.6f}")
        at = end[:3]
    return "\n".join([*lines, "M2", ""])


def write(folder: Path, jobs: list[Job]) -> Path:
    """Configuration and programs; the INI file."""
    sections = "".join(
        AXIS.format(
            section=name, type="ANGULAR" if axis > 2 else "LINEAR", vel=VMAX[axis], acc=AMAX[axis]
        )
        for axis, letter in enumerate(AXES)
        for name in (f"AXIS_{letter}", f"JOINT_{axis}")
    )  # fmt: skip
    echo = [f"net j{n} joint.{n}.motor-pos-cmd => joint.{n}.motor-pos-fb sampler.0.pin.{n}" for n in range(len(AXES))]
    files = {
        "corpus.ini": INI.format(folder=folder) + sections,
        "corpus.hal": "\n".join([HAL, *echo, ""]),
        "corpus.tbl": "T1 P1 Z0\n",
        "corpus.var": "",
        "run.py": RUN,
        "jobs.json": json.dumps([slug(job) for job in jobs]),
    } | {f"{slug(job)}.ngc": g_code(job) for job in jobs}
    for name, text in files.items():
        (folder / name).write_text(text)
    (folder / "run.py").chmod(0o755)
    return folder / "corpus.ini"


def slug(job: Job) -> str:
    return "".join(c if c.isalnum() else "_" for c in job.name)


def moving(positions: Array) -> Array:
    """The positions from the period in which motion begins, at the origin, to the one in which it ends."""
    positions = np.vstack([0.0 * positions[:1], positions])
    changed = np.flatnonzero(np.any(np.diff(positions, axis=0) != 0.0, axis=1))
    return positions[changed[0] + 1 : changed[-1] + 2] if len(changed) else positions[:0]


def run_stock(folder: Path, user: str, jobs: list[Job]) -> dict[str, Array]:
    """Joint commands of LinuxCNC by job, one row each servo period."""
    for path in (folder, *folder.iterdir()):
        shutil.chown(path, user)
    folder.chmod(0o755)
    command = ["unshare", "--ipc", "--net", "--mount", "--pid", "--fork", "--kill-child", "--mount-proc"]
    subprocess.run([*command, "sh", "-c", ENTER, "sh", str(folder), user], timeout=3600, check=False)
    if not (folder / "done.json").exists():
        sys.stderr.write((folder / "machine.log").read_text(errors="replace")[-3000:])
        return {}
    with (folder / SAMPLES).open() as text:
        rows = np.array([line.split() for line in text if len(line.split()) == len(AXES) + 2], dtype=float)
    if np.any(np.diff(rows[:, 0]) != 1):
        sys.stderr.write(f"{np.count_nonzero(np.diff(rows[:, 0]) != 1)} gaps in the samples: times are too short\n")
    edges = np.flatnonzero(np.diff(rows[:, -1], prepend=0.0, append=0.0))
    runs = [rows[first:last, 1:-1] for first, last in edges.reshape(-1, 2)]
    names = json.loads((folder / "done.json").read_text())
    return {job.name: moving(run) for job, run in zip(jobs, runs, strict=False) if slug(job) in names}


def ideal(job: Job) -> list[Line | Arc]:
    path: list[Line | Arc] = []
    at = np.zeros(9)
    for move in job.moves:
        end = np.zeros(9)
        end[: len(move[0])] = move[0]
        path.append(Line(at, end) if len(move) == 1 else Arc(at, end, move[1], np.array([0.0, 0, 1]), move[2]))
        at = end
    return path


def judged(job: Job, positions: Array) -> list[str]:
    """Seconds, and the largest shares of acceleration and tolerance that were used."""
    nine = np.zeros((len(positions), 9))
    nine[:, : positions.shape[1]] = positions
    report = verify(nine, ideal(job), VMAX, AMAX, DT, job.tolerance, max(1, len(nine) // CHECKED))
    return [f"{report.seconds:.3f}", f"{report.worst_acceleration:.3f}", f"{report.deviation / job.tolerance:.2f}"]


def main() -> int:
    options = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    options.add_argument("--user", default="lcnc", help="ordinary user that runs LinuxCNC")
    options.add_argument("--only", nargs="*", default=[], help="names, or parts of them")
    chosen = options.parse_args()
    jobs = [make() for make in CORPUS]
    jobs = [job for job in jobs if not chosen.only or any(part in job.name for part in chosen.only)]
    users = {entry.pw_name for entry in pwd.getpwall()}
    columns = ("ours s", "acc", "err/P", "LinuxCNC s", "acc", "err/P", "ours/LinuxCNC", "bound s", "ours/bound")
    table = Table("job", "moves", *columns)
    with tempfile.TemporaryDirectory(prefix="pyemc-corpus-", dir="/var/tmp") as name:
        folder = Path(name)
        ini = IniFile(write(folder, jobs))
        stock: dict[str, Array] = {}
        if STOCK.exists() and os.getuid() == 0 and chosen.user in users:
            stock = run_stock(folder, chosen.user, jobs)
        else:
            print("LinuxCNC cannot be run here (needs Debian's package, root and --user): its columns stay empty")
        for job in jobs:
            ours = moving(forecast(ini, folder / f"{slug(job)}.ngc", Machine.from_ini(ini), trace=True).trace.positions)
            theirs = stock.get(job.name)
            best = bound(job) if job.curve else None
            row = judged(job, ours) + (judged(job, theirs) if theirs is not None else ["", "", ""])
            row.append(f"{len(ours) / len(theirs):.3f}" if theirs is not None else "")
            row += [f"{best:.3f}", f"{len(ours) * DT / best:.3f}"] if best else ["", ""]
            table.add_row(job.name, str(len(job.moves)), *row)
    Console(width=150).print(table)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
