"""The wall clock jumps by an hour, forth and back, while a program runs: nothing of the machine notices.

A library that is preloaded into every process of the machine adds an offset to what the C library tells of the wall
clock; the test changes it. Deadlines that were reckoned with the wall clock would be an hour early or late.
"""

from __future__ import annotations

import mmap
import shutil
import struct
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import linuxcnc
from tests.support.desk import DONE, Desk
from tests.support.machine import copy_mill, running

COMPILER = shutil.which("cc") or shutil.which("gcc")
pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(COMPILER is None, reason="there is no C compiler for the library that moves the clock"),
]

HOUR = 3600  # s
DWELL = 1.5  # s
JUMPS = (HOUR, -HOUR, 0)

SOURCE = r"""
#define _GNU_SOURCE
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

static volatile int64_t* offset;  /* s */

__attribute__((constructor)) static void open_offset(void) {
    int file = open(getenv("WALL_CLOCK_OFFSET"), O_RDONLY);
    offset = mmap(NULL, sizeof *offset, PROT_READ, MAP_SHARED, file, 0);
    close(file);
}
int clock_gettime(clockid_t clock, struct timespec* now) {
    int result = syscall(SYS_clock_gettime, clock, now);
    if (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE) now->tv_sec += *offset;
    return result;
}
int gettimeofday(struct timeval* now, void* zone) {
    struct timespec precise;
    clock_gettime(CLOCK_REALTIME, &precise);
    now->tv_sec = precise.tv_sec, now->tv_usec = precise.tv_nsec / 1000;
    return 0;
}
time_t time(time_t* now) {
    struct timespec precise;
    clock_gettime(CLOCK_REALTIME, &precise);
    if (now) *now = precise.tv_sec;
    return precise.tv_sec;
}
"""

PROGRAM = f"""\
G21 G90 G64 F300
G1 X2
G4 P{DWELL}
G1 X4
M66 P0 L3 Q{DWELL}
T2 M6
G1 X6
M3 S100
G4 P{DWELL}
M5
G1 X8
M2
"""


@pytest.fixture
def wall_clock(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[int], None]]:
    """Sets the wall clock of the processes that start from now on off by so many seconds."""
    assert COMPILER is not None
    library, source, offset = tmp_path / "wallclock.so", tmp_path / "wallclock.c", tmp_path / "offset"
    source.write_text(SOURCE)
    subprocess.run([COMPILER, "-shared", "-fPIC", "-O1", "-o", library, source], check=True)
    offset.write_bytes(bytes(8))
    monkeypatch.setenv("LD_PRELOAD", str(library))
    monkeypatch.setenv("WALL_CLOCK_OFFSET", str(offset))
    with offset.open("r+b") as file, mmap.mmap(file.fileno(), 8) as memory:
        yield lambda seconds: struct.pack_into("q", memory, 0, seconds)


def test_the_library_moves_the_wall_clock_and_no_other(wall_clock: Callable[[int], None]) -> None:
    ask = [sys.executable, "-c", "import time; print(int(time.time()), int(time.monotonic()))"]
    wall_clock(HOUR)
    wall, steady = map(int, subprocess.run(ask, capture_output=True, text=True, check=True).stdout.split())
    assert abs(wall - time.time() - HOUR) < HOUR / 2
    assert abs(steady - time.monotonic()) < HOUR / 2


def test_a_program_runs_through_jumps_of_the_wall_clock(tmp_path: Path, wall_clock: Callable[[int], None]) -> None:
    with running(copy_mill(tmp_path, hal="net never motion.digital-in-00\n")) as run:
        run.port()
        desk = Desk(tmp_path)
        desk.ready(linuxcnc.MODE_AUTO)
        desk.program(PROGRAM)
        began = time.monotonic()
        desk.run()
        jumps = 0
        while desk.look().interp_state != linuxcnc.INTERP_IDLE or desk.stat.position[0] < 8.0:
            wall_clock(JUMPS[jumps % len(JUMPS)])
            jumps += 1
            assert desk.stat.task_state == linuxcnc.STATE_ON, desk.texts
            assert time.monotonic() - began < 60.0, desk.stat.exec_state
            time.sleep(0.05)
        assert jumps > len(JUMPS)
        assert time.monotonic() - began >= 3 * DWELL
        assert desk.texts == []
        assert (desk.stat.tool_in_spindle, desk.stat.position[0]) == (2, 8.0)
        for jump in JUMPS:
            wall_clock(jump)
            assert desk.do(desk.command.mode, linuxcnc.MODE_MDI) == DONE
            assert desk.mdi(f"G0 X{8 + jump / HOUR}") == DONE
            assert desk.do(desk.command.mode, linuxcnc.MODE_MANUAL) == DONE
        assert desk.texts == []
    assert run.errors == "linuxcnc: stopped by SIGTERM\n"
