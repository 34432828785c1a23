"""A graphics card that writes down what it is told: every OpenGL call of a script, as lines of text.

LinuxCNC's module finds OpenGL through libepoxy's variables, ours by name; the recorder is preloaded and serves both.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from tests.support.machine import ROOT

SOURCE = r"""
#include <stdio.h>
#define ROW(kind, at, stride, i) (const kind *)((const char *)at + i * stride)
static const void *places, *colours;
static int place_stride, colour_stride;
void glBegin(unsigned mode) { printf("begin %u\n", mode); }
void glEnd(void) { puts("end"); }
void glVertex3dv(const double *v) { printf("vertex %.6f %.6f %.6f\n", v[0] + 0.0, v[1] + 0.0, v[2] + 0.0); }
void glVertex3f(float x, float y, float z) { printf("vertex %.6f %.6f %.6f\n", x, y, z); }
void glColor4d(double r, double g, double b, double a) { printf("colour %g %g %g %g\n", r, g, b, a); }
void glLoadName(unsigned name) { printf("name %u\n", name); }
void glEnableClientState(unsigned array) { printf("enable %x\n", array); }
void glVertexPointer(int size, unsigned type, int stride, const void *first) {
    printf("places %d %x %d\n", size, type, stride); places = first; place_stride = stride; }
void glColorPointer(int size, unsigned type, int stride, const void *first) {
    printf("colours %d %x %d\n", size, type, stride); colours = first; colour_stride = stride; }
void glDrawArrays(unsigned mode, int first, int count) {
    printf("draw %u %d %d\n", mode, first, count);
    for (int i = first; i < first + count; i++) {
        const float *p = ROW(float, places, place_stride, i);
        const unsigned char *c = ROW(unsigned char, colours, colour_stride, i);
        printf("  %g %g %g  %d %d %d %d\n", p[0], p[1], p[2], c[0], c[1], c[2], c[3]);
    }
}
#define EPOXY(name) void *epoxy_##name = name;
EPOXY(glBegin) EPOXY(glEnd) EPOXY(glVertex3dv) EPOXY(glVertex3f) EPOXY(glColor4d) EPOXY(glLoadName)
EPOXY(glEnableClientState) EPOXY(glVertexPointer) EPOXY(glColorPointer) EPOXY(glDrawArrays)
"""


STDOUT = "ctypes.c_void_p.in_dll(libc, 'stdout')"
UNBUFFERED = 2


def recorder(folder: Path) -> Path:
    """The library to preload, compiled into ``folder``."""
    (folder / "recorder.c").write_text(SOURCE)
    library = folder / "recorder.so"
    subprocess.run(["gcc", "-shared", "-fPIC", "-w", "-o", library, folder / "recorder.c"], check=True)
    return library


def drawn(library: Path, script: str, python: str = sys.executable) -> list[str]:
    """The calls that a script makes, and what it prints (``flush=True``), in order."""
    environment = {**os.environ, "LD_PRELOAD": str(library)}
    if python == sys.executable:
        environment["PYTHONPATH"] = str(ROOT)
    else:
        environment.pop("PYTHONPATH", None)
    setting = f"import ctypes; libc = ctypes.CDLL(None); libc.setvbuf({STDOUT}, None, {UNBUFFERED}, 0)\n"
    done = subprocess.run(
        [python, "-c", setting + script], cwd="/", env=environment, check=True, capture_output=True, text=True
    )
    return done.stdout.splitlines()
