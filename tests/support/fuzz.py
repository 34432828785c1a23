"""A coverage-guided fuzzer of the interpreter: programs that reach new code are kept and changed further.

    gcc -O2 -shared -fPIC -o edges.so tests/support/fuzz.c
    cp -r rs274ngc instrumented/        # and compile its .c files anew into it, with -fsanitize-coverage=trace-pc
    LD_PRELOAD=./edges.so python tests/support/fuzz.py instrumented --seconds 600

A finding is whatever is neither a run nor an InterpError: another exception, or a program that takes longer than two
seconds for its first lines. Findings are written to the folder of ``--keep``; each of them gets a test.
"""

from __future__ import annotations

import argparse
import ctypes
import random
import signal
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).parents[2]
MAP_SIZE = 1 << 16
SLOW_S = 2
BLOCKS_MAX = 400


class Slow(Exception):
    """A program takes too long."""


class Fuzzer:
    """The corpus, the map of edges, and one program after another."""

    def __init__(self, keep: Path, seed: int) -> None:
        from rs274ngc.interp import Interpreter
        from rs274ngc.offline import OfflineCanon
        from rs274ngc.tooltable import DEFAULT
        from tests.support.gcode import FUNCTIONS, MISTAKES, OPERATORS, TOKENS, Generator

        self.make = lambda: Interpreter(OfflineCanon(tools=DEFAULT))
        self.map = (ctypes.c_uint8 * MAP_SIZE).in_dll(ctypes.CDLL(None), "edge_map")
        self.seen = np.zeros(MAP_SIZE, bool)
        self.random = random.Random(seed)
        flow = ("o1 sub", "o1 endsub", "o1 call", "o2 if [1]", "o2 endif")
        self.words = (*TOKENS, *MISTAKES, *FUNCTIONS, *OPERATORS, *flow)
        self.corpus = [Generator(k, 1).program(pieces=4, mistake=k % 2 == 0) for k in range(60)]
        self.folder = Path(tempfile.mkdtemp())
        self.keep = keep
        self.runs = self.findings = 0

    def changed(self, text: str) -> str:
        """A program with some lines and words exchanged."""
        chance, lines = self.random, text.splitlines()
        for _ in range(chance.randint(1, 4)):
            at = chance.randrange(len(lines) + 1)
            kind = chance.randrange(6)
            if kind == 0:
                lines.insert(at, " ".join(chance.choices(self.words, k=chance.randint(1, 3))))
            elif kind == 1 and lines:
                del lines[min(at, len(lines) - 1)]
            elif kind == 2:
                lines[at:at] = chance.choice(self.corpus).splitlines()[: chance.randint(1, 8)]
            elif lines:
                line = lines[min(at, len(lines) - 1)]
                cut = chance.randint(0, len(line))
                piece = chance.choice((*self.words, "-", ".", "9", "1e9", "0", "[", "]", "#", "\\0", "é", "(", ";"))
                lines[min(at, len(lines) - 1)] = line[:cut] + piece + line[cut + chance.randint(0, 3) :]
        return "\n".join(lines[:120]) + "\n"

    def run(self, text: str) -> str:
        """Execute a program; what was found, empty when it was taken or refused."""
        from nml.errors import InterpError

        path = self.folder / "program.ngc"
        path.write_text(text, errors="replace")
        interp = self.make()
        signal.alarm(SLOW_S)
        try:
            interp.init()
            interp.open(path)
            for _ in range(BLOCKS_MAX):
                if interp.read() == 3 or interp.execute() == 1:
                    break
        except InterpError:
            pass
        except Slow:
            return "slow"
        except Exception as error:
            return f"{type(error).__name__}: {error}"
        finally:
            signal.alarm(0)
        return ""

    def step(self) -> None:
        """One more program."""
        ctypes.memset(self.map, 0, MAP_SIZE)
        text = self.changed(self.random.choice(self.corpus[-200:] if self.runs % 2 else self.corpus))
        found = self.run(text)
        self.runs += 1
        if found:
            self.findings += 1
            (self.keep / f"finding-{self.findings}.ngc").write_text(f"({found})\n{text}", errors="replace")
            print(f"run {self.runs}: {found}", flush=True)
            return
        reached = np.frombuffer(self.map, np.uint8) > 0
        if (reached & ~self.seen).any():
            self.seen |= reached
            self.corpus.append(text)


def slow(*_: Any) -> None:
    raise Slow


def main() -> int:
    """Fuzz for a while and sum up; 0: nothing was found."""
    chosen = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    chosen.add_argument("instrumented", help="folder with the instrumented packages")
    chosen.add_argument("--seconds", type=float, default=600.0)
    chosen.add_argument("--seed", type=int, default=1)
    chosen.add_argument("--keep", type=Path, default=Path("findings"))
    options = chosen.parse_args()
    sys.path[:0] = [options.instrumented, str(ROOT)]
    options.keep.mkdir(parents=True, exist_ok=True)
    signal.signal(signal.SIGALRM, slow)
    fuzzer = Fuzzer(options.keep, options.seed)
    end = time.monotonic() + options.seconds
    while time.monotonic() < end:
        fuzzer.step()
    edges = int(fuzzer.seen.sum())
    print(f"{fuzzer.runs} programs, {len(fuzzer.corpus)} kept, {edges} edges, {fuzzer.findings} findings")
    return 1 if fuzzer.findings else 0


if __name__ == "__main__":
    sys.exit(main())
