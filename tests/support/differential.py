"""Many random programs through Debian's interpreter and ours: the recorded run, and the pieces of its test.

    python -m tests.support.differential --programs 10000 --first 1 --generator words

Each seed makes one program by one of three generators, which know nothing of each other: ``pieces`` (``gcode``:
meaningful pieces, every third program with wrong lines), ``words`` (``wordy``: words in any dress, on random machines)
and ``contours`` (cutter compensation). Calls, refusals and the parameter file afterwards are compared; a difference is
reported with its seed and the first line that differs. ``KNOWN`` names the differences that docs/gcode-differences.md
explains, by what they look like.
"""

from __future__ import annotations

import argparse
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import traceback
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path

from rs274ngc import __main__ as rs274
from tests.support.contours import Contour
from tests.support.gcode import TOOLS, Generator
from tests.support.wordy import Machine, Wordy, machine

PEER = Path("/usr/bin/rs274")
CPU_S = 5
PATIENCE_S = 120
"""Limits of one program: of computing, after which it counts as one that never ends, and of the clock."""
MEMORY_BYTES = 2 << 30
SPINDLES = 3
PLAIN = Machine(TOOLS, "", "", False)
SEVERAL_SPINDLES = Machine(TOOLS, "", f"[TRAJ]\nSPINDLES={SPINDLES}\n[RS274NGC]\nPARAMETER_FILE=machine.var\n", False)


@dataclass(frozen=True, slots=True)
class Outcome:
    """What an interpreter made of a program."""

    calls: list[str]
    refusal: tuple[str, str]  # the first error and the block it is about
    parameters: list[str]  # numbers and values of the parameter file afterwards


def calls(output: str) -> list[str]:
    """Canonical calls without what is known to differ: see docs/gcode-differences.md."""
    kept = []
    for line in output.splitlines():
        line = re.sub(r"^ *\d+ (?=N)", "", line)
        if line.endswith(" START_CHANGE()"):
            continue
        line = re.sub(r"CHANGE_TOOL\(\d+\)", "CHANGE_TOOL()", line)
        kept.append(re.sub(r"-(0\.0+)\b", r"\1", line))
    return kept


def refusal(errors: str) -> tuple[str, str]:
    """The first error and the block it is about."""
    lines = [line for line in errors.splitlines() if line and not line.startswith(("link (", "executing"))]
    lines = [re.sub(r"^\S+:\d+(:\d+)?: ", "", line) for line in lines]
    return (lines[0], lines[1].rstrip()) if len(lines) > 1 else ("", "")


def parameters(folder: Path) -> list[str]:
    """The parameter file in one form, -0 being 0."""
    words = (line.split() for line in (folder / "machine.var").read_text().splitlines())
    return [f"#{word[0]}={float(word[1]) or 0.0:.6f}" for word in words if len(word) == 2]


def prepare(folder: Path, machine: Machine) -> None:
    """The files that both read."""
    (folder / "test.tbl").write_text(machine.tools)
    (folder / "machine.ini").write_text(machine.ini)
    (folder / "machine.var").write_text(machine.parameters)


def options(machine: Machine) -> list[str]:
    settings = ["-i", "machine.ini"] if machine.ini else ["-v", "machine.var"]
    return ["-t", "test.tbl", *settings, *(["-b"] if machine.block_delete else []), "-g"]


class GivenUp(Exception):
    """An interpreter was stopped, or fell: says why."""


ENDLESS = "never ends"


def given_up(status: int) -> GivenUp:
    """For the exit status of a process that a signal ended, or that failed."""
    if status in (-signal.SIGXCPU, -signal.SIGKILL):
        return GivenUp(ENDLESS)
    return GivenUp(signal.Signals(-status).name if status < 0 else "failed")


def theirs(folder: Path, program: Path, machine: Machine = PLAIN) -> Outcome:
    """Debian's interpreter."""
    prepare(folder, machine)
    done = subprocess.run(
        ["prlimit", f"--cpu={CPU_S}", f"--as={MEMORY_BYTES}", str(PEER), *options(machine), str(program)],
        env=dict(os.environ, HOME=str(folder)),  # its tool data is a file there
        cwd=folder,
        capture_output=True,
        text=True,
        errors="replace",
        timeout=PATIENCE_S,
        check=False,
    )
    if done.returncode < 0:
        raise given_up(done.returncode)
    return Outcome(calls(done.stdout), refusal(done.stderr), parameters(folder))


def interpret(folder: Path, program: Path, machine: Machine) -> None:
    """Run our interpreter; output and errors go to files of the folder."""
    os.chdir(folder)
    with open("errors", "w") as errors, redirect_stderr(errors):
        rs274.main([*options(machine), str(program), "output"])


def ours(folder: Path, program: Path, machine: Machine = PLAIN) -> Outcome:
    """Ours, in a copy of this process that can be given up."""
    prepare(folder, machine)
    child = os.fork()
    if child == 0:
        try:
            resource.setrlimit(resource.RLIMIT_CPU, (CPU_S, CPU_S))
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
            interpret(folder, program, machine)
            os._exit(0)
        except BaseException:
            traceback.print_exc()
            os._exit(1)
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    if status:
        raise given_up(status)
    output, errors = (folder / name for name in ("output", "errors"))
    return Outcome(calls(output.read_text(errors="replace")), refusal(errors.read_text()), parameters(folder))


Interpreter = Callable[[Path, Path, Machine], Outcome]


def differing(one: Outcome, other: Outcome) -> tuple[str, str] | None:
    """The first line of each in which they differ; None: they do not."""
    for left, right in zip_longest(
        [*one.calls, *one.refusal, *one.parameters],
        [*other.calls, *other.refusal, *other.parameters],
        fillvalue="(nothing)",
    ):
        if left != right:
            return left, right
    return None


def pieces(seed: int) -> tuple[str, Machine]:
    spindles = seed % 4 == 1
    text = Generator(seed, SPINDLES if spindles else 1).program(mistake=seed % 3 == 0)
    return text, SEVERAL_SPINDLES if spindles else PLAIN


GENERATORS: dict[str, Callable[[int], tuple[str, Machine]]] = {
    "pieces": pieces,
    "words": lambda seed: (Wordy(seed, wrong=seed % 3 == 0).program(), machine(seed)),
    "contours": lambda seed: (Contour(seed).program(), PLAIN),
}
"""A program and its machine from a seed."""


KNOWN: tuple[tuple[str, re.Pattern[str], re.Pattern[str], re.Pattern[str]], ...] = tuple(
    (name, re.compile(their_line), re.compile(our_line), re.compile(program, re.DOTALL))
    for name, their_line, our_line, program in (
        ("axes of G5.2", "", "Splines may not have motion in Z, A, B, or C", r"g5\.2"),
        ("number of spindles in the error", r"^num_spindles =", "", r"\$"),
        ("place of an error in a lathe profile", r"\no\d+ endsub$", r"\ng7[012]", "g7[012]"),
        ("overrides after G76 while M49 or M50 P0 is in force", r"(EN|DIS)ABLE_FEED_OVERRIDE", "", "g76"),
        ("a word twice", "", r"Multiple [pq@^] words", ""),
        ("M98 without P beyond a search", "Found 'm98' code with no P-word", "", "m98"),
        ("a comment left open, met by a search", "(Unclosed|Nested) comment found", "", "m98"),
        ("ROUND of a number beyond whole ones", r"-2147483648\.0", "", r"round\["),
        ("$0 with M51", r"Invalid spindle \(\$\) number in M51", "", r"\$"),
        ("$ with G95 or G97", r"\$ \(spindle selection\) word with no", "", r"\$"),
        ("G5.2 under compensation", "", "Cannot convert spline with cutter radius compensation", r"g4[12].*g5\.2"),
        ("points of a curve that was never ended", r"^N\S* NURBS_FEED", r"^N\S* NURBS_FEED", r"g5\.2"),
        ("G17.1 under compensation", r"^N\S* SELECT_PLANE\(CANON_PLANE_UNKNOWN", "plane", r"g1[789]\.1"),
        ("G53 with G5.2", "", "Must use g0 or g1 with g53", r"g53.*g5\.2"),
        ("G43.2 with axis words", "Requested tool -1 not found in the tool table", "", r"g43\.2"),
        ("M6 of the tool that G10 wrote", r"^N\S* (USE_TOOL_LENGTH_OFFSET|MESSAGE)", "", "g10.*m6"),
        ("M61 under compensation", "", "Cannot change tools with cutter radius compensation on", "g4[12].*m61"),
        ("G7 under compensation", r'^N\S* COMMENT\("interpreter: Lathe diameter', "", "g4[12].*g[78]"),
        ("a stop under compensation", r"^N\S* (STRAIGHT|ARC)_", r"^N\S* (STRAIGHT|ARC)_", "g4[12].*m(0|1|60)"),
        ("an input or output that no machine has", "", "No valid P word|input selected out of bounds", "m6[2-8]"),
        ("do after a break", "", "", r"break.*do\n"),
        ("M6 without T", "", "Need tool prepared -Txx- for toolchange", "m6.*random_toolchanger=1"),
        ("the spindle of a random tool changer", "TOOL_LENGTH|MESSAGE|^-?[0-9]", "", "random_toolchanger=1"),
    )
)
"""(name, what LinuxCNC's line looks like, what ours looks like, what the program and the INI file, in
lower case without blanks, have in them) of the differences that are explained."""


LATHE_CORNER_MM = 0.05
"""How far the two may differ at a corner of a lathe profile."""
LAST_DIGIT = 0.000101
CALLS_OF_A_LINE = 4


def nearly(left: str, right: str, tolerance: float) -> bool:
    """The same call with nearly the same numbers?"""
    numbers = [[float(number) for number in re.findall(r"-?\d+(?:\.\d+)?", line)] for line in (left, right)]
    if left.partition("(")[0] != right.partition("(")[0] or len(numbers[0]) != len(numbers[1]):
        return False
    return all(abs(a - b) < tolerance for a, b in zip(*numbers, strict=True))


def half_way(left: str, right: str) -> bool:
    """The same call, whose numbers differ by one in the last digit printed?"""
    return nearly(left, right, LAST_DIGIT) and left.startswith("N")


def same_so_far(one: Outcome, other: Outcome) -> bool:
    """Are the calls the same but for some at the end, which a refused line made before it was refused?"""
    calls = ([call for call in outcome.calls if not call.endswith("ON_RESET()")] for outcome in (one, other))
    fewer, more = sorted(calls, key=len)
    return more[: len(fewer)] == fewer and len(more) - len(fewer) <= CALLS_OF_A_LINE


def explained(left: str, right: str, one: Outcome, other: Outcome, text: str) -> str:
    """The name of a known difference, empty for an unknown one; ``text``: the program and the INI file."""
    if is_lathe(text) and (nearly(left, right, LATHE_CORNER_MM) or one.refusal[0] != other.refusal[0]):
        return "a corner of a lathe profile"
    if half_way(left, right):
        return "a value half-way between two printed ones"
    if one.refusal[1] == other.refusal[1] != "" and one.refusal[0] != other.refusal[0] and same_so_far(one, other):
        return "another error of the same line"
    left, right = "\n".join((left, *one.refusal)), "\n".join((right, *other.refusal))
    text = re.sub(r"[ \t]", "", text.lower())
    for name, their_line, our_line, program in KNOWN:
        if their_line.search(left) and our_line.search(right) and program.search(text):
            return name
    return ""


def is_lathe(text: str) -> bool:
    """Has the program a lathe cycle?"""
    return " endsub\ng7" in text


def attempt(interpreter: Interpreter, folder: Path, program: Path, machine: Machine) -> Outcome | str:
    """What an interpreter makes of a program, or why it was stopped."""
    try:
        return interpreter(folder, program, machine)
    except GivenUp as why:
        return str(why)


def run(seeds: range, generator: str = "pieces") -> Iterator[tuple[int, str, str, str]]:
    """(seed, name of the known difference, their line, our line) of each program that differs."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        program = folder / "program.ngc"
        for seed in seeds:
            text, machine = GENERATORS[generator](seed)
            program.write_text(text)
            one, other = (attempt(interpreter, folder, program, machine) for interpreter in (theirs, ours))
            if isinstance(one, str) or isinstance(other, str):
                if one != other:  # a program without an end is the same in both
                    reason = "LinuxCNC never ends in a lathe cycle" if is_lathe(text) and one == ENDLESS else ""
                    yield seed, reason, one if isinstance(one, str) else "", other if isinstance(other, str) else ""
                continue
            found = differing(one, other)
            if found is not None:
                yield seed, explained(*found, one, other, text + machine.ini), *found


def main() -> int:
    """Run them, tell what differs as it is found, sum up; 0: nothing unexplained."""
    chosen = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    chosen.add_argument("--programs", type=int, default=10_000)
    chosen.add_argument("--first", type=int, default=1, help="first seed")
    chosen.add_argument("--generator", choices=sorted(GENERATORS), default="pieces")
    arguments = chosen.parse_args()
    reasons: Counter[str] = Counter()
    seeds = range(arguments.first, arguments.first + arguments.programs)
    for seed, reason, left, right in run(seeds, arguments.generator):
        reasons[reason or "unexplained"] += 1
        print(f"seed {seed} {reason}\n  LinuxCNC {left}\n  here     {right}", flush=True)
    print(f"{arguments.programs} programs, {reasons.total()} differ: {dict(reasons)}")
    return 1 if reasons["unexplained"] else 0


if __name__ == "__main__":
    sys.exit(main())
