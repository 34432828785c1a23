"""What a machine must survive: a full disk, endless programs, a thousand repetitions, death at any instant.

PYEMC_LONG_TESTS=1 in the environment runs all thousand, and every death in every activity.
"""

from __future__ import annotations

import os
import random
import signal
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

import linuxcnc
from tests.support.desk import DONE, Desk, at_desk
from tests.support.machine import Run, copy_mill, processes, traces, wait_until

pytestmark = pytest.mark.process

TEN_GIGABYTES = 10 * 1024**3
ROOM = 32 * 1024**2  # bytes by which task may grow while it runs a program of any length
SMALL_DISK = "size=256k"
LONG = "PYEMC_LONG_TESTS" in os.environ
REPETITIONS = 1000 if LONG else 100


@contextmanager
def small_disk(folder: Path) -> Iterator[Path]:
    """A file system that is easily filled; skipped where nothing may be mounted."""
    folder.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", SMALL_DISK, "none", str(folder)], capture_output=True)
    if mounted.returncode:
        pytest.skip("needs the right to mount a file system")
    try:
        yield folder
    finally:
        subprocess.run(["umount", "--lazy", str(folder)], check=True)


def fill(disk: Path) -> Path:
    """Use up all of a disk."""
    ballast = disk / "ballast"
    with ballast.open("wb", buffering=0) as stream:
        try:
            while True:
                stream.write(bytes(4096))
        except OSError:
            pass
    return ballast


def test_a_full_disk_is_told_and_costs_nothing_that_was_saved(tmp_path):
    with small_disk(tmp_path / "disk") as disk:
        table, parameters = disk / "mill.tbl", disk / "mill.var"
        table.write_text("T1 P1 D3 Z1 ;first\n")
        changes = {"EMCIO.TOOL_TABLE": "disk/mill.tbl", "RS274NGC.PARAMETER_FILE": "disk/mill.var"}
        with at_desk(tmp_path, changes=changes) as desk:
            desk.ready(linuxcnc.MODE_MDI)
            assert desk.mdi("G10 L2 P1 X1") == DONE
            wait_until(lambda: parameters.exists() and "5221\t1.0" in parameters.read_text(), "parameters on the disk")
            saved = parameters.read_text()
            ballast = fill(disk)
            assert desk.mdi("G10 L2 P1 X2") == DONE
            desk.until(lambda _: any("parameter file cannot be written" in text for text in desk.texts), "a text")
            desk.mdi("G10 L1 P1 Z2")
            desk.until(lambda _: any("tool table cannot be written" in text for text in desk.texts), "a text")
            assert (parameters.read_text(), table.read_text()) == (saved, "T1 P1 D3 Z1 ;first\n")
            assert desk.mdi("G53 G0 X3") == DONE
            ballast.unlink()
            assert desk.mdi("G10 L1 P1 Z3") == DONE
            wait_until(lambda: "Z+3.0" in table.read_text(), "the table on the disk")
            wait_until(lambda: "5221\t2.0" in parameters.read_text(), "the parameters on the disk")


def memory(pid: int) -> int:
    """Bytes of a process that are in memory."""
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


def task_pid() -> int:
    return next(pid for pid, _ in processes() if Path(f"/proc/{pid}/comm").read_text().strip() == "milltask")


def run_to_its_end(desk: Desk, program: Path) -> None:
    assert desk.do(desk.command.mode, linuxcnc.MODE_AUTO) == DONE
    assert desk.do(desk.command.program_open, str(program)) == DONE
    assert desk.do(desk.command.auto, linuxcnc.AUTO_RUN, 0, timeout=120.0) == DONE


def test_a_program_of_ten_gigabytes_runs_in_flat_memory(tmp_path):
    program = tmp_path / "huge.ngc"
    with at_desk(tmp_path) as desk:
        desk.ready(linuxcnc.MODE_AUTO)
        program.write_text("G0 X1\nM2\n")
        run_to_its_end(desk, program)
        before = memory(task_pid())
        long_part = "".join(f"#1 = {n % 1000} (a line among many)\n" for n in range(20_000))
        with program.open("w") as stream:
            for _ in range(4):
                stream.write(long_part)
            stream.write("G0 X2\nM2\n")
            stream.truncate(TEN_GIGABYTES)
        run_to_its_end(desk, program)
        assert desk.look().position[0] == pytest.approx(2.0)
        assert memory(task_pid()) - before < ROOM


PROBE = """\
loadrt comp names=touch
addf touch servo-thread
setp touch.in0 7.5
net x-position => touch.in1
net probe touch.out => motion.probe-input
net twelve motion.digital-out-00 => motion.digital-in-00
"""
BUSTERS = """\
G21 G90 G64 P0.05 F2400
(LOGOPEN,{log})
o1 repeat [{repetitions}]
  G0 X5
  G38.2 X10
  #1 = #5061
  T1 M6
  #2 = #5400
  T2 M6
  #3 = #5400
  M62 P0
  G1 X6
  M66 P0 L3 Q5
  #4 = #5399
  M63 P0
  G1 X5
  M66 P0 L0
  #5 = #5399
  G10 L2 P1 X0.5
  #6 = #5420
  G10 L2 P1 X0
  G4 P0
  (LOG,#1 #2 #3 #4 #5 #6 #5420)
o1 endrepeat
M2
"""


def test_a_thousand_repetitions_of_every_queue_buster_give_one_result(tmp_path):
    log = tmp_path / "results"
    with at_desk(tmp_path, hal=PROBE) as desk:
        desk.ready(linuxcnc.MODE_AUTO)
        desk.program(BUSTERS.format(log=log, repetitions=REPETITIONS))
        assert desk.do(desk.command.auto, linuxcnc.AUTO_RUN, 0, timeout=600.0) == DONE, desk.texts
    lines = log.read_text().splitlines()
    assert len(lines) == REPETITIONS
    places = [float(line.split()[0]) for line in lines]
    assert max(places) - min(places) < 0.1, "the probe trips within a servo period's way"
    assert {" ".join(line.split()[1:]) for line in lines} == {"1.000000 2.000000 1.000000 0.000000 4.500000 5.000000"}


ACTIVITIES = {
    "off": lambda desk: None,
    "idle": lambda desk: desk.ready(linuxcnc.MODE_MANUAL),
    "jogging": lambda desk: (
        desk.ready(linuxcnc.MODE_MANUAL),
        desk.command.jog(linuxcnc.JOG_CONTINUOUS, False, 0, 20.0),
    ),
    "typed": lambda desk: (desk.ready(linuxcnc.MODE_MDI), desk.command.mdi("G1 X50 F600")),
    "cutting": lambda desk: (desk.ready(linuxcnc.MODE_AUTO), desk.program("G1 X50 F600\nM2\n"), desk.run()),
    "paused": lambda desk: (
        desk.ready(linuxcnc.MODE_AUTO),
        desk.program("G1 X50 F600\nM2\n"),
        desk.run(),
        desk.command.auto(linuxcnc.AUTO_PAUSE),
    ),
}


VICTIMS = ("task", "io", "launcher", "display")
DEATHS = [(victim, activity) for victim in VICTIMS for activity in ACTIVITIES]
FEW_DEATHS = [("task", "jogging"), ("io", "typed"), ("launcher", "paused"), ("display", "cutting")]


@pytest.mark.parametrize(("victim", "activity"), DEATHS if LONG else FEW_DEATHS)
def test_a_death_at_any_instant_leaves_nothing_and_the_next_start_works(tmp_path, activity, victim):
    chance = random.Random(f"{activity} {victim}")
    ini = copy_mill(tmp_path)
    run = Run(ini, speed=5.0)
    try:
        run.port()
        desk = Desk(tmp_path)
        ACTIVITIES[activity](desk)
        desk.stat.wait(chance.uniform(0.0, 0.5))
        os.kill(run.process.pid if victim == "launcher" else run.pids()[victim], signal.SIGKILL)
        wait_until(lambda: not processes(), "the end of all processes")
        assert run.finish() != 0
        wait_until(lambda: not traces(), "no traces")
    finally:
        run.stop()
    (tmp_path / "again.ngc").write_text("G0 X1\nM2\n")
    again = Run(ini, "--run", str(tmp_path / "again.ngc"), speed=20.0)
    assert again.finish() == 0, again.errors
