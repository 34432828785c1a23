"""The interpreter beside Debian's: same canonical calls, same refusals, for its own programs and for random ones.

``PYEMC_RS274_PROGRAMS`` sets the number of random programs of each generator (default 60), ``PYEMC_RS274_SEED`` the
first of them.
"""

import os
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from tests.support.differential import GENERATORS, PEER, Outcome, calls, ours, run, theirs

ROOT = Path(__file__).parents[2]
CONFIGURATIONS = Path("/usr/share/doc/linuxcnc/examples/sample-configs/sim/axis/remap")
SAMPLES = Path("/usr/share/linuxcnc/ncfiles")
COUNT = int(os.environ.get("PYEMC_RS274_PROGRAMS", "60"))
SEED = int(os.environ.get("PYEMC_RS274_SEED", "1"))

pytestmark = [
    pytest.mark.peer,
    pytest.mark.skipif(not PEER.exists(), reason="Debian's linuxcnc-uspace is not installed"),
]

CORPUS = (
    "3D_Chips", "spiral", "flowsnake", "cds", "arcspiral", "daisy", "comp", "polar", "m73-demo", "lathecomp",
    "retval", "lathe_g7x_quadrants", "lathe_g7x_face_boring",
)  # fmt: skip


STOCK_REMAPS = (
    ("getting-started/demo.ini", "examples.ngc"),
    ("manual-toolchange-with-tool-length-switch/manualtoolchange.ini", "tcdemo.ngc"),
    ("rack-toolchange/racktoolchange.ini", "tcdemo.ngc"),
)
"""Configurations whose codes are NGC procedures and Python functions, and their programs."""

AWKWARD = {
    "M99 in the main program": "g0 x1\nm99\ng0 x2",
    "rotating the active system while G92 is in force": """\
        g0 x3 y4 z1
        g92 x1 y2
        g10 l2 p1 r30
        (debug,#5420 #5421 #5422)
        g10 l2 p1 x2 y7 z1 r10
        g43.1 x1 y2 z5
        g10 l2 p1 x7 y.7 z1 r20
        (debug,#5420 #5421 #5422)
        g10 l20 p1 x7
        (debug,#5420 #5421 #5422)
        g55
        g91 g0 x1""",
    "changing units while a tool offset is in force": """\
        g43.1 z3 x1
        g20
        g0 x1 y1 z1
        g21
        (debug,#5420 #5421 #5422)
        g20
        g49
        (debug,#5420 #5421 #5422)
        g43 h1
        g21
        g91 g0 x1
        g28""",
    "a corner that would pull the entry move back": """\
        g0 x0 y0
        g41.1 d.3
        g1 x.2 y0
        g1 x-3.3 y-.5
        g1 x-5 y3
        g40
        g1 x0 y0""",
    "half a turn from a line into an arc beside which the tool goes": """\
        g0 x-5 y5
        g42.1 d.8
        g1 x-4 y0
        g1 x5
        g3 x1.79222 y-2.89347 i-.1047 j-2.99817
        g40
        g1 x30""",
    "cutting off a corner at a rapid": """\
        g41.1 d.3
        g1 x5
        g0 x5.1 y-3
        g0 x-3 y-2
        g40
        g1 x0 y0""",
    "a tool set to here along rotated axes": """\
        g10 l2 p9 x1 y2 z3 r30
        g10 l2 p1 x.5 y.7 r20
        g0 x3 y4 z5
        g10 l11 p1 x1
        g10 l10 p2 y1
        g92 x1 y1
        g10 l10 p2 x1""",
    "boring from behind in all planes": """\
        m3 s100
        g87 x1 y2 z-2 r2 i1 j.5 k-1
        g18
        g87 x1 z2 y-2 r2 i1 j.5 k-1
        g91 g19
        g87 y1 z2 x-2 r2 i1 j.5 k-1""",
    "leaving the tool in the hole to the operator": """\
        m3 s100
        g0 z9
        g98 g88 x1 y2 z-2 r2 p.5
        g80
        g1 x9""",
    "rotary tool offsets and machine coordinates": """\
        g43.1 a3 b4 c5 x1
        g10 l2 p1 x2 a10 b20 c30
        g0 x1 a4 b5 c6
        g28
        g53 g0 a1 x2
        g28.1
        g30 a9 x3""",
    "going on nearly straight after a corner that the tool cannot reach": """\
        g42 d1
        g1 x5 y0
        g1 x.08 y-1.84
        g1 x-6.64 y-4.29
        g40""",
    "a nearly flat corner that lengthens an arc": """\
        g18
        g42 d7
        g1 z5 x0
        g0 z2.07 x2.03
        g2 z4.16 x5.39 k1.045 i1.680
        g40""",
    "an inside corner with an arc whose radii differ by rounding": """\
        g18
        g42 d2
        g1 z-3.295 x8.375
        g3 z-6.474 x5.577 k-2.274 i-0.621
        g3 z2.166 x6.619 k3.397 i8.173
        g40""",
    "restoring feed, speed, coolant, overrides and the offset of another tool": """\
        t1 m6
        g43
        f12.345 s123.456 m3
        m7
        m52 p1
        m53 p0
        m49
        m70
        t2 m6
        g43.1 z4
        f3 s4 m4
        m9
        m48
        m52 p0
        m53 p1
        m72""",
    "restoring units, planes, distance modes and path control": """\
        g18 g91 g95 g55 g99 g90.1 g7 f7.16
        g64 p.1234567 q.056
        m70
        g20 g17 g90 g94 g54 g98 g91.1 g8 f3
        g61
        m72""",
    "restoring G96 with the speed that is set already": """\
        g96 s50
        m70
        g97 s50
        m72""",
    "restoring at return": """\
        o1 sub
          m73
          g20 f1.23
          g91 g18
          g92 x1
          s400 m3
        o1 endsub
        f3.456 s12
        o1 call
        g0 x1""",
    "restoring overrides, coolant and plane": """\
        m70
        m53 p0
        m50 p0
        g19
        m72
        m70
        m7
        g18 g91
        m72
        m52 p1
        m70
        m52 p0
        m72""",
    "the label of a condition at two lines": """\
        o1 if [1]
        o1 endif
        o1 if [1]
        o1 endif""",
    "a skipped loop with a label that is sought": """\
        o1 if [0]
        o1 repeat [2]
        o1 endrepeat
        o1 endif""",
    "one label in a subroutine and in the program": """\
        o1 sub
        o2 if [1]
        o2 endif
        o1 endsub
        o2 if [1]
        o2 endif
        o1 call
        o1 call
        g0 x1""",
    "path control under compensation": """\
        g41.1 d1
        g1 x20
        g64 p.1""",
    "another coordinate system set under compensation": """\
        g41.1 d1
        g1 x20
        g10 l2 p2 x1
        g1 x30
        g10 l2 p0 x1""",
    "an entry arc no longer than the radius of the tool": """\
        g42.1 d0.5
        g2 j2.486
        g1 x20 y-8""",
    "coordinate systems set in incremental mode": """\
        g10 l2 p1 x1
        g91
        g10 l2 p1 x1 y2
        g10 l2 p2 x3
        g10 l20 p1 x1
        g90 g55
        g0 x0""",
    "a line that is too long": "g1 x1 (" + "c" * 246 + ")",
    "an empty comment and a line number behind a slash": """\
        ()
        /n7 g0 x3
        g4 p-2""",
    "a motion beside G80": """\
        g81 x1 z-1 r1
        g80 g0 x2
        g1 g80 x3
        g80 g80""",
    "giving up G92 beside another code of group 0": """\
        g92 x4 y1
        g92.2 g53 g0 x1
        g92.3 g28 x2
        g10 l2 p1 x5 g92.1
        g0 x1 g92.1""",
    "two codes about G92 on a line": "g92.1 g92.2",
    "negative tolerances": """\
        g64 p-1
        g64 p-1 q.3
        g64 p.1 q-1""",
    "a turn of the spindle with a negative timeout": "m19 q-1 r2",
    "drilling along X in diameters": """\
        g7 g19 m3 s100
        g73 x-2.4 y-2 z-2.3 q1.8 r4.9
        g91 g86 x-2.4 y-2 z-2.3 p1 r4.9 l2""",
    "reading the tool table anew while a tool offset is in force": """\
        g43 h1
        g10 l0
        g91 g1 x1 z1
        g10 l11 p1 z3""",
    "what is said and prepared while a compensated move is held back": """\
        g41 d7
        g1 x7
        (msg,held)
        (debug,#5420)
        t1
        g17
        g10 l1 p1 x3
        g1 x9
        m62 p1""",
    "polar words in diameters": """\
        g7
        g0 @4 ^30
        @5
        g91 @1
        ^5
        g90 g7 ^55
        g81 @5 ^3 z-1 r1
        g91 g81 ^20 z-1 r1 l3""",
    "polar words where the line changes the plane": """\
        g0 x1 y1
        s5 g18 g0 @1 ^3
        g2 @1 ^3 r5""",
    "the last digit of functions": """\
        #1=[asin[sin[tan[atan[1.356]/[0]]]]]
        (debug,#1)
        #1=[[acos[.3456789]+atan[.123]/[.456]]*1000000000000]
        (debug,#1)
        #1=[[sin[-5.123]+cos[77.7]+tan[8.9]]*1000000000000]
        (debug,#1)""",
    "numbered parameters in EXISTS": """\
        #1=[exists[#1]+exists[#200]*10+exists[#9999]*100+exists[##2]*1000]
        (debug,#1)
        #1=exists[#1+#2]""",
    "what a definition and a return leave in #<_value>": """\
        o<a> sub
          (print,in a #<_value> #<_value_returned>)
        o<a> endsub [#1+4]
        (print,defined a #<_value> #<_value_returned>)
        o<a> call [7]
        o<a> call
        (print,called a #<_value> #<_value_returned>)
        m98 p9
        (print,called 9 #<_value> #<_value_returned>)
        o<b> sub
        o<b> endsub [#<only_in_a_call>]
        m2
        o9
        (print,in 9 #<_value> #<_value_returned>)
        m99""",
    "words that count as not written": """\
        m3 s100
        g82 x1 z-1 r1 p1
        x2 p-1
        g83 x1 z-1 r1 q1
        x2 q-1
        g80
        g76 z-1 p1 i-1 j.1 k.5 q-1
        g10 l1 p1 q-1
        x2 m66 p-1 l0""",
    "a peck of nothing": """\
        g83 x1 z-1 r1 q1
        x2 q0""",
    "numbers that are nearly whole": """\
        g10 l1 p1.6 x1
        g10 l2 p1.6 x1
        g10 l11 p.6 q2.00005 z1
        (debug,#5221 #5241)
        g10 l1 p1 q2.001""",
    "a control point without a weight": """\
        g17 g5.2 x1 y1 p1
        z1""",
    "an arc in a wrong plane without a feed": """\
        g94
        g2 z1 i1 k1""",
    "an arc without a feed per turn": """\
        g95
        g2 x1 r1""",
    "a user's code that is not there": """\
        m100 f1 s5""",
    "a lathe cycle without its words": """\
        g18
        s5 g71""",
    "a line that is too long, met by a search": "m98 p9\ng1 x1 (" + "c" * 246 + ")\no9\nm99",
    "the unit of length while a compensated move is held back": """\
        g41.1 d.1
        g1 x5
        g20
        g1 x1
        g1 y5
        g21
        g1 x60
        g40""",
    "an unused word beside G96 without S": "g96 i2",
    "machine coordinates beside a tool of no width": """\
        g41.1 d0
        g1 x5
        g53 g1 x1""",
    "compensation on and off without a move": """\
        g41.1 d.1
        g40
        g2 x1 i.5""",
    "a spline without a feed per turn": """\
        g95
        g5.1 x1 y1 i1 j2""",
    "giving up G92 beside a compensated path": """\
        g92 x1
        g41.1 d.1
        g92.1
        (debug,#5210 #5211)
        g92.3
        g1 x5""",
    "a word that G5.3 does not use": "g5.3 p1",
    "a lathe profile whose lines and arcs nearly touch": """\
        g18 g8 g0 x15 z4
        o1 sub
          g0 x.202 z3.041
          g2 x1.081 z.919 i3 k0
          g1 x3 z-1
          g1 z-4
          x2.268 z-5.268
          g2 x2 z-6.268 i1.73205 k-1
          g1 z-6.732
          g2 x4 z-8.732 i2 k0
          g1 x4.5
          g3 x6.285 z-12.982 i0 k-2.5
          g2 z-19.982 i3.57071 k-3.5
          g1 x10 a.2
        o1 endsub
        g71.2 q1 x15 z3.041 d.51 i.5 r.3
        g70 q1 x15 z3.041 e0 d.5 p2""",
    "words that some codes do not mind": """\
        m3 s100
        g33 z1 k1 e1
        g33.1 z2 k1 e1
        g42.1 d1 r2""",
    "orienting a spindle that turns": """\
        m3 s100
        m19 r10
        (debug,#<_spindle_on> #<_spindle_cw>)""",
}
"""Programs that random ones seldom write, and in which the two once differed."""


def both(program: Path) -> tuple[Outcome, Outcome]:
    return theirs(program.parent, program), ours(program.parent, program)


@pytest.mark.parametrize("what", AWKWARD)
def test_awkward_programs_give_the_same_calls(what: str, tmp_path: Path) -> None:
    program = tmp_path / "program.ngc"
    program.write_text(f"g21 g90 g17 g94 f100\n{textwrap.dedent(AWKWARD[what])}\nm2\n")
    their, our = both(program)
    assert our == their


@pytest.mark.parametrize("name", CORPUS)
def test_a_sample_program_gives_the_same_calls(name: str, tmp_path: Path) -> None:
    program = tmp_path / f"{name}.ngc"
    program.write_bytes((SAMPLES / f"{name}.ngc").read_bytes())
    their, our = both(program)
    assert our == their


@pytest.mark.parametrize(("configuration", "program"), STOCK_REMAPS)
def test_a_stock_configuration_with_remaps_gives_the_same_calls(
    configuration: str, program: str, tmp_path: Path
) -> None:
    shutil.copytree(CONFIGURATIONS, tmp_path / "remap")
    (tmp_path / "nc_files").mkdir()
    (tmp_path / "nc_files" / "remap_lib").symlink_to(SAMPLES / "remap_lib")
    folder = tmp_path / "remap" / Path(configuration).parent
    outputs = []
    for command in ([str(PEER)], [sys.executable, "-m", "rs274ngc"]):
        for name in ("sim.var", "sim_mm.var"):
            (folder / name).write_text("")
        done = subprocess.run(
            [*command, "-i", Path(configuration).name, "-t", "tool.tbl", "-g", f"nc_files/{program}"],
            env=dict(os.environ, PYTHONPATH=str(ROOT), HOME=str(folder)),
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
        outputs.append(calls(done.stdout))
    assert len(outputs[0]) > 50
    assert outputs[1] == outputs[0]


@pytest.mark.parametrize("generator", GENERATORS)
@pytest.mark.parametrize("seed", range(SEED, SEED + COUNT))
def test_a_random_program_gives_the_same_calls_refusals_and_parameters(generator: str, seed: int) -> None:
    unexplained = [found for found in run(range(seed, seed + 1), generator) if not found[1]]
    assert not unexplained
