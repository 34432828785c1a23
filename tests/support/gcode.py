"""Random programs in RS274/NGC: legal ones of every modal group, and ones with a single wrong line.

A program is a list of lines from a seed. Lengths stay in a range in which both interpreters round alike.
"""

from __future__ import annotations

import random
from collections.abc import Callable

TOOLS = "T1 P1 Z1.5 D0.25\nT2 P2 Z2 D0.5\nT7 P5 X1 Z0.1 D0.1\n"

MISTAKES = (
    "g1 x1 g0", "g2 x1", "g99.5", "m7 m8", "x1 y2 q3", "g4", "g10 x1", "g43 h77", "t55", "g0 x[1/0]",
    "g0 x#<nothing>", "g53 g91 g0 x1", "g0 x1 x2", "f-1", "s-1", "m66", "g81 x1", "g38.2", "g0 x1..2", "g0 x[1",
    "#0=1", "m200", "g33 z1", "g41.1", "g92", "g2 x1 r0.001", "%%", "g0 n5", "m62", "g0 x sqrt[-1]", "g5.3",
    "m19 p7", "g3 x1 i1 r1", "o9 endif", "g82 x1 z-1 r1", "g83 z-1 r1", "g76 z1", "m61", "g10 l2 p12 x1", "g64 r1",
    "g0 x1 l2", "m98",
)  # fmt: skip
"""Lines that both interpreters must refuse, wherever they stand."""


MODES = (
    "g20", "g21", "g90", "g91", "g98", "g99", "g61", "g61.1", "g64", "g94", "g40", "g64 p0.1", "g64 p.2 q.1",
)  # fmt: skip

CYCLES = (("g81", ""), ("g82", "p.5"), ("g83", "q.7"), ("g73", "q.9"), ("g85", ""), ("g89", "p1"))

MACHINE = (
    "m3 s100", "m4 s50", "m5", "m7", "m8", "m9", "m48", "m49", "m50 p0", "m51 p1", "m52 p1", "m53 p0", "m0", "m1",
    "m60", "t1 m6", "t2", "m6", "m62 p1", "m63 p2", "m64 p3", "m65 p4", "m67 e1 q2.5", "m68 e0 q1", "g4 p.5",
    "m66 p1 l0", "f50", "(remark)", "(msg,hello)", "(debug,#1 #<_x> %d#2)", "s70", "g97 s10", "g96 d100 s20", "g97",
)  # fmt: skip
"""Lines about the machine rather than its motion."""


class Generator:
    """Writes one program."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        self.lines: list[str] = []
        self.labels = 100

    def number(self, low: float = -20.0, high: float = 20.0) -> str:
        value = round(self.random.uniform(low, high), 3)
        return self.random.choice((f"{value}", f"[{value}]", f"[{value - 1:.3f} + 1]", f"{value:.3f}"))

    def axes(self, letters: str = "xyz") -> str:
        chosen = [letter for letter in letters if self.random.random() < 0.6] or [letters[0]]
        return " ".join(letter + self.number() for letter in chosen)

    # --- One kind of line each

    def straight(self) -> list[str]:
        return [f"{self.random.choice(('g0', 'g1'))} {self.axes('xyzabc' if self.random.random() < 0.1 else 'xyz')}"]

    def modal(self) -> list[str]:
        mode = self.random.choice(MODES)
        return ["g49", mode] if mode in ("g20", "g21") else [mode]

    def arc(self) -> list[str]:
        code = self.random.choice(("g2", "g3"))
        plane, words = self.random.choice((("g17", "xyzij"), ("g18", "zxyki"), ("g19", "yzxjk")))
        first, second, third, one, two = words
        a, b = self.random.uniform(1, 9), self.random.uniform(1, 9)
        turns = f" p{self.random.randint(1, 3)}" if self.random.random() < 0.3 else ""
        helix = f" {third}{self.number()}" if self.random.random() < 0.4 else ""
        if self.random.random() < 0.4:
            return [f"{plane} g91", f"{code} {first}{a:.3f} {second}{b:.3f}{helix} r{a + b:.3f}{turns}", "g90"]
        return [f"{plane} g91", f"{code} {first}{2 * a:.3f} {one}{a:.3f} {two}0{helix}{turns}", "g90"]

    def offsets(self) -> list[str]:
        choices = (
            f"g10 l2 p{self.random.randint(1, 9)} {self.axes()} r{self.number(0, 90)}",
            f"g10 l20 p{self.random.randint(1, 9)} {self.axes()}",
            f"g92 {self.axes()}",
            f"g52 {self.axes()}",
            "g92.1",
            "g92.2",
            "g92.3",
            f"g43.1 {self.axes()}",
            f"g43 h{self.random.choice((1, 2, 7))}",
            "g49",
            f"g5{self.random.randint(4, 9)}",
            "g59.2",
            "g28",
            f"g30 {self.axes()}",
            f"g53 g0 {self.axes()}",
        )
        line = self.random.choice(choices)
        return ["g90", line] if line.startswith("g53") else [line]

    def machine(self) -> list[str]:
        return [self.random.choice(MACHINE)]

    def cycle(self) -> list[str]:
        plane, axes = self.random.choice((("g17", "xyz"), ("g17", "xyz"), ("g18", "zxy"), ("g19", "yzx")))
        first, second, third = axes
        code, extra = self.random.choice(CYCLES)
        repeat = f" l{self.random.randint(1, 3)}" if self.random.random() < 0.3 else ""
        mode = self.random.choice(("g90", "g91"))
        r, bottom = (2.0, -2.0) if mode == "g90" else (0.5, -1.5)
        return [
            f"{plane} {mode} g94 f100",
            f"{code} {first}{self.number()} {second}{self.number()} {third}{bottom} r{r} {extra}{repeat}",
            f"{first}{self.number()}",
            "g80",
            "g90",
        ]

    def polar(self) -> list[str]:
        return ["g17 g90 g0 x3 y2", f"g0 @{self.number(1, 9)} ^{self.number(0, 360)}", f"^{self.number(0, 360)}"]

    def inverse(self) -> list[str]:
        return ["g93", f"g1 {self.axes()} f{self.number(1, 9)}", f"x{self.number()} f2", "g94 f100"]

    def flow(self) -> list[str]:
        self.labels += 3
        n = self.labels
        body = self.straight()
        return self.random.choice(
            (
                [f"#7={self.random.randint(0, 3)}", f"o{n} while [#7 gt 0]", "#7=[#7-1]", *body, f"o{n} endwhile"],
                [f"o{n} if [#1 gt {self.random.randint(-3, 3)}]", *body, f"o{n} else", *self.straight(), f"o{n} endif"],
                [f"o{n} repeat [{self.random.randint(0, 3)}]", *body, f"o{n} endrepeat"],
                ["#8=0", f"o{n} do", "#8=[#8+1]", *body, f"o{n} while [#8 lt 2]"],
                [f"o{n} sub", "g0 x[#1] y#2", f"o{n} return [#1]", f"o{n} endsub", f"o{n} call [{self.number()}] [2]"],
            )
        )

    def parameter(self) -> list[str]:
        target = self.random.choice(("#1", "#31", "#<a>", "#<_g>"))
        operator = self.random.choice(("+", "-", "*"))
        return ["#<a>=1 #<_g>=2", f"{target}=[{self.number()} {operator} #1]", "g0 x[#<a> mod 10]"]

    def compensation(self) -> list[str]:
        lines = ["g90 g17 g0 x0 y0", f"{self.random.choice(('g41.1', 'g42.1'))} d{self.number(0.1, 0.4)}", "g1 x5 y0"]
        x, y = 5.0, 0.0
        for _ in range(self.random.randint(2, 5)):
            x, y = x + self.random.uniform(-9, 9), y + self.random.uniform(-9, 9)
            lines.append(f"g1 x{x:.3f} y{y:.3f}")
        return [*lines, "g40", f"g1 x{x + 9:.3f} y{y + 9:.3f}"]

    KINDS: tuple[tuple[Callable[[Generator], list[str]], int], ...] = (
        (straight, 8), (modal, 4), (arc, 4), (offsets, 4), (machine, 5), (cycle, 2), (polar, 1), (inverse, 1),
        (flow, 2), (parameter, 1), (compensation, 1),
    )  # fmt: skip

    def program(self, pieces: int = 25, mistake: bool = False) -> str:
        """The text of a program; with ``mistake`` one of its lines is wrong."""
        makers = [maker for maker, weight in self.KINDS for _ in range(weight)]
        lines = ["g21 g90 g17 g94 f100"]
        for _ in range(pieces):
            lines += self.random.choice(makers)(self)
            if mistake and self.random.random() < 0.1:
                lines.append(self.random.choice(MISTAKES))
        return "\n".join([*lines, "m2", ""])
