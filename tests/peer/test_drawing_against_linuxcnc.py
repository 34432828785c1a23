"""What the drawing functions of the ``linuxcnc`` module tell OpenGL, beside what LinuxCNC's own module tells it."""

from __future__ import annotations

import random
import shutil

import pytest

from tests.support.opengl import drawn, recorder
from tests.support.stock import MODULE_FOUND, PYTHON

pytestmark = [
    pytest.mark.peer,
    pytest.mark.skipif(not MODULE_FOUND, reason="Debian's LinuxCNC is not installed"),
    pytest.mark.skipif(shutil.which("gcc") is None, reason="there is no compiler for the recorder"),
]

GEOMETRIES = (
    *("XYZ", "-XYZ", "AXYZ", "XYZA", "XYZ-B", "BCXYZ", "-A-B-CXYZ", "XYZABC", "XYZUVW", "UVWA"),
    *("X-!Y", "X- Y-;Z", "--X-", "xyz"),
)


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return recorder(tmp_path_factory.mktemp("opengl"))


def point(rng: random.Random, turning: bool) -> tuple[float, ...]:
    """Inches, and degrees where it is turning."""
    linear = [round(rng.uniform(-9, 9), 3) for _ in range(6)]
    rotary = [round(rng.uniform(-200, 200), 3) if turning else 0.0 for _ in range(3)]
    return (*linear[:3], *rotary, *linear[3:])


def moves(rng: random.Random) -> list[tuple[object, ...]]:
    """Moves with jumps, with repeated and new line numbers, some with rotary axes."""
    here, lines = point(rng, False), []
    for number in range(rng.randrange(12)):
        if rng.random() < 0.2:
            here = point(rng, False)
        there = point(rng, rng.random() < 0.3)
        lines.append((number // 2, here, there, 100.0))
        here = there
    return lines


def dwells(rng: random.Random) -> list[tuple[object, ...]]:
    colours = [(1.0, 0.5, 0.25), (0.0, 1.0, 0.0)]
    return [
        (n // 2, rng.choice(colours), *(rng.randrange(-9, 9) / 4 for _ in "xyz"), rng.randrange(3))
        for n in range(rng.randrange(5))
    ]


def script(seed: int) -> str:
    """Calls of every function, in random order and with random arguments."""
    rng = random.Random(seed)
    calls = []
    for _ in range(25):
        geometry, selecting = rng.choice(GEOMETRIES), rng.randrange(2)
        call = rng.choice(
            [
                f"line9({geometry!r}, {point(rng, True)}, {point(rng, rng.random() < 0.5)})",
                f"draw_lines({geometry!r}, {moves(rng)}, {selecting})",
                f"draw_dwells({geometry!r}, {dwells(rng)}, 0.5, {selecting}, {rng.randrange(2)})",
                f"gui_rot_offsets{point(rng, False)[:3]}",
                f"gui_respect_offsets({rng.choice(['XYZ', 'XYZA', 'XYZBC', 'XYZABC', 'xyza'])!r}, {rng.randrange(3)})",
            ]
        )
        calls.append(f"print({call!r}, flush=True); linuxcnc.{call}")
    return "import linuxcnc\n" + "\n".join(calls)


@pytest.mark.parametrize("seed", range(8))
def test_the_same_calls_reach_the_graphics_card(library, seed):
    ours, theirs = drawn(library, script(seed)), drawn(library, script(seed), PYTHON)
    assert len(theirs) > 25
    assert [line.replace("-0.000000", "0.000000") for line in ours] == [
        line.replace("-0.000000", "0.000000") for line in theirs
    ]
