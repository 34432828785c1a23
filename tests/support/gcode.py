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

CYCLES = (
    ("g81", ""), ("g82", "p.5"), ("g83", "q.7"), ("g73", "q.9"), ("g85", ""), ("g89", "p1"), ("g86", "p.3"),
    ("g88", "p.3"), ("g74", ""), ("g84", ""), ("g87", "i1 j.5 k-1"),
)  # fmt: skip

PLANES = (("g17", "xyz", "ij"), ("g18", "zxy", "ki"), ("g19", "yzx", "jk"))
"""Plane, first, second and helix axis, words of the centre."""

TOKENS = (
    "g0", "g1", "g2", "g3", "g4", "g5", "g5.1", "g5.2", "g5.3", "g7", "g8", "g10", "g17", "g18", "g19", "g20", "g21",
    "g28", "g28.1", "g30", "g30.1", "g33", "g33.1", "g38.2", "g38.3", "g40", "g41", "g41.1", "g42", "g42.1", "g43",
    "g43.1", "g49", "g52", "g53", "g54", "g55", "g59.3", "g61", "g64", "g73", "g76", "g80", "g81", "g82", "g83",
    "g85", "g86", "g87", "g88", "g89", "g90", "g90.1", "g91", "g91.1", "g92", "g92.1", "g92.2", "g92.3", "g93", "g94",
    "g95", "g96", "g97", "g98", "g99", "m0", "m1", "m3", "m4", "m5", "m6", "m7", "m8", "m9", "m19", "m48", "m49",
    "m50", "m51", "m52", "m53", "m60", "m61", "m62", "m63", "m64", "m65", "m66", "m67", "m68", "m70", "m71", "m72",
    "t1", "t2", "t3", "n7", "/", "(c)", "#1=2", "#<k>=[1]", "x#1", "y#<_x>", "z-#1", "x[2+", "y]", "g", "m", "x-",
    "q", "@1", "^30", "i#<no>", "g#1", "$0", "$1",
)  # fmt: skip
"""What a line of no sense is made of, beside words with random numbers."""

FUNCTIONS = ("abs", "sin", "cos", "tan", "asin", "acos", "exp", "ln", "round", "fix", "fup", "sqrt")
OPERATORS = ("+", "-", "*", "/", "**", "mod", "gt", "ge", "lt", "le", "eq", "ne", "and", "or", "xor")

MACHINE = (
    "m3 s100", "m4 s50", "m5", "m7", "m8", "m9", "m48", "m49", "m50 p0", "m51 p1", "m52 p1", "m53 p0", "m0", "m1",
    "m60", "t1 m6", "t2", "m6", "m62 p1", "m63 p2", "m64 p3", "m65 p4", "m67 e1 q2.5", "m68 e0 q1", "g4 p.5",
    "m66 p1 l0", "f50", "(remark)", "(msg,hello)", "(debug,#1 #<_x> %d#2)", "s70", "g97 s10", "g96 d100 s20", "g97",
)  # fmt: skip
"""Lines about the machine rather than its motion."""


class Generator:
    """Writes one program."""

    def __init__(self, seed: int, spindles: int = 1) -> None:
        self.random = random.Random(seed)
        self.spindles = spindles
        self.turns = seed % 20 == 7     # LinuxCNC takes long for some lathe profiles, and for ever for a few
        self.lines: list[str] = []
        self.labels = 100
        self.subprograms: list[str] = []

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
        plane, axes, _ = self.random.choice((PLANES[0], *PLANES))
        first, second, third = axes
        code, extra = self.random.choice(CYCLES)
        repeat = f" l{self.random.randint(1, 3)}" if self.random.random() < 0.3 and code not in ("g74", "g84") else ""
        mode = self.random.choice(("g90", "g91"))
        r, bottom = (2.0, -2.0) if mode == "g90" else (0.5, -1.5)
        if self.random.random() < 0.3:
            r, bottom = round(self.random.uniform(-5, 5), 2), round(self.random.uniform(-9, 2), 2)
        return [
            f"{plane} {mode} g94 f100",
            "m4 s100" if code == "g74" else "m3 s100",
            f"{code} {first}{self.number()} {second}{self.number()} {third}{bottom} r{r} {extra}{repeat}",
            f"{first}{self.number()}",
            *([f"{second}{self.number()} r{r + 0.1:.2f}"] if self.random.random() < 0.3 else []),
            "g80",
            "g90",
        ]

    def threading(self) -> list[str]:
        taper = self.random.choice(("", "", "e.5 l1", "e.3 l2", "e.4 l3", "q29.5", "h2 r1.5", "h1 q30 e.2 l3 r2"))
        return [
            self.random.choice(("g18", "g18", "g18 g7", "g17")) + " g90 m3 s100",
            f"g0 x{self.number(10, 12)} z{self.number(2, 4)}",
            self.random.choice(
                (
                    f"g76 p{self.number(0.5, 2)} z{self.number(-9, 0)} i{self.random.choice('- ')}"
                    f"{self.random.uniform(0.5, 2):.3f}"
                    f" j{self.random.uniform(0.1, 0.4):.3f} k{self.random.uniform(0.6, 2):.3f} {taper}",
                    f"g33 z{self.number()} k{self.number(0.5, 2)}",
                    f"g33.1 z{self.number()} k{self.number(0.5, 2)}",
                )
            ),
            "g17 g8",
        ]

    def several_spindles(self) -> list[str]:
        """Codes with a $ word; one spindle has only number 0."""
        n = self.random.randrange(self.spindles)
        return self.random.choice(
            (
                [f"m{self.random.choice((3, 4))} $-1 s{self.number(1, 99)}", f"m5 ${n}"],
                [f"m3 ${n} s{self.number(1, 99)}", *(f"g{g} z{self.number()} k.5 ${n}" for g in (33, 33.1))],
                [f"s100 ${n}", f"m3 ${n}", "s20 $-1"],
                [f"g96 d{self.number(100, 200)} s{self.number(1, 50)} ${n}", f"g97 s20 ${n}"],
                [f"m51 p0 ${n or 1}" if self.spindles > 1 else "m51 p0", "m51 p1"],
                [f"m19 r{self.number(0, 360)} q2 p{self.random.randrange(3)} ${n}"],
                [f"s{self.number(1, 99)} ${n}", f"m{self.random.choice((3, 4, 5))} ${self.random.choice((n, -1))}"],
            )
        )

    def other_planes(self) -> list[str]:
        plane = self.random.choice(("g17.1", "g18.1", "g19.1"))
        return [plane, *self.straight(), "g17"]

    def subprogram(self) -> list[str]:
        """M98 to a subprogram that stands after the end of the program."""
        self.labels += 3
        n = self.labels
        self.subprograms += [f"o{n}", "g91", f"g1 {self.axes()} f50", "g90", *self.parameter(), "m99"]
        return [f"m98 p{n}" + self.random.choice(("", " l2", " l1"))]

    def names(self) -> list[str]:
        """Named parameters, local and global, and the predefined ones."""
        name = self.random.choice(("one", "two words", "Mixed_Case", "_glob", "_Glob two"))
        known = self.random.choice(
            ("_x", "_y", "_abs_z", "_feed", "_rpm", "_metric", "_motion_mode", "_plane", "_ccomp", "_coord_system",
             "_tool_offset", "_current_tool", "_selected_tool", "_value", "_call_level", "_line", "_absolute",
             "_spindle_on", "_spindle_cw", "_mist", "_flood", "_speed_override", "_feed_override", "_retract_r_plane",
             "_ijk_absolute_mode", "_lathe_diameter_mode", "_units_per_rev")
        )  # fmt: skip
        return [
            f"#<{name}> = {self.number()}",
            f"(debug, {name} %.3f#<{name}> %d#<{known}> %f#<{name.upper()}> #<none>)",
            f"#<{name}>=[#<{name}>+1] g0 x[#<{name}>/2] f[#<_feed>+1]",
            f"o{self.label()} if [exists[#<{name}>]]\n(print,#<{known}>)\no{self.labels} endif",
        ]

    def lathe(self) -> list[str]:
        """A profile of lines and arcs, roughed and finished: outside or inside, in any direction."""
        n = self.label()
        z, x = 0.0, self.random.choice((4.0, 20.0))
        inside = x > 10.0
        forwards = self.random.choice((1, -1))
        lines = [f"g0 x{x} z0"]
        for _ in range(self.random.randint(2, 6)):
            dz = round(self.random.uniform(1.5, 4), 2)
            dx = round(self.random.uniform(-1.2, 2.5) * (-1 if inside else 1), 2)
            z, x = round(z + forwards * dz, 3), round(x + dx, 3)
            if self.random.random() < 0.2 and abs(dx) > 0.1:
                sign = self.random.choice("23")
                centre = f"i{dx} k0" if self.random.random() < 0.5 else f"i0 k{forwards * abs(dx)}"
                z = round(z - forwards * dz + forwards * abs(dx), 3)
                lines.append(f"g{sign} x{x} z{z} {centre}")
            else:
                lines.append(f"g1 x{x} z{z}")
        start = f"x{8 if inside else 30} z{-2 * forwards}"
        rough = self.random.choice(("g71", "g71", "g71.2", "g72" if not inside else "g71"))
        return [
            "g18 g90 g8 g94 f100 m3 s100", f"g0 {start}",
            f"o{n} sub", *lines, f"o{n} endsub",
            f"{rough} q{n} {start} d0 i{self.random.uniform(0.7, 3):.2f} r.2",
            f"g70 q{n} {start} d0 p{self.random.randint(1, 2)}",
            "g80 g17",
        ]  # fmt: skip

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
        """A path of lines and arcs beside which a tool goes, in the XY or the XZ plane."""
        plane, axes, words = self.random.choice((PLANES[0], PLANES[0], PLANES[1]))
        first, second, third = axes
        tool = self.random.choice((f".1 d{self.number(0.1, 0.4)}", f".1 d{self.number(0.5, 2)}", " d1", " d7"))
        lines = [f"g90 {plane} g0 x0 y0 z0", f"{self.random.choice(('g41', 'g42'))}{tool}", f"g1 {first}5 {second}0"]
        x, y = 5.0, 0.0
        for _ in range(self.random.randint(2, 6)):
            dx, dy = round(self.random.uniform(-9, 9), 2), round(self.random.uniform(-9, 9), 2)
            x, y = x + dx, y + dy
            high = f" {third}{self.number()}" if self.random.random() < 0.1 else ""
            arc = f"{words[0]}{dx / 2:.3f} {words[1]}{dy / 2:.3f}"
            kind = self.random.random()
            if kind < 0.3:
                lines.append(f"g{self.random.choice('23')} {first}{x:.2f} {second}{y:.2f} {arc}{high}")
            else:
                lines.append(f"g{1 if kind < 0.9 else 0} {first}{x:.2f} {second}{y:.2f}{high}")
        return [*lines, "g40", f"g1 {first}{x + 9:.3f} {second}{y + 9:.3f}", "g17"]

    def per_turn(self) -> list[str]:
        return ["m3 s100", f"g95 f{self.number(0.1, 1)}", f"g1 {self.axes()}", "g94 f100"]

    def spline(self) -> list[str]:
        def pair(letters: str) -> str:
            return " ".join(letter + self.number() for letter in letters)

        return self.random.choice(
            (
                ["g17 g90 g1 x0 y0", f"g5 {pair('ijpqxy')}", f"g5 {pair('pqxy')}"],
                ["g17", f"g5.1 {pair('xyij')}", f"g91 g5.1 {pair('xyij')}", "g90"],
                [
                    "g17 g90",
                    f"g5.2 {pair('xy')} p1 l{self.random.randint(2, 4)}",
                    *(f"{pair('xy')} p{weight}" for weight in (2, 1, 3)),
                    "g5.3",
                ],
            )
        )

    def tables(self) -> list[str]:
        l_word = self.random.choice(("l1", "l10", "l11"))
        tool = self.random.choice((1, 2, 7))
        extra = self.random.choice(("", "", f" r{self.number(0.1, 1)}", " q3", " i10 j20" if l_word == "l1" else ""))
        use = self.random.choice(("g43", f"g43 h{tool}", f"g43.2 h{tool}", f"t{tool} m6 g43", f"m61 q{tool}", "g49"))
        return [f"g10 {l_word} p{tool} {self.axes('xyzabc')}{extra}", use]

    def expression(self) -> list[str]:
        value = self.number(-2, 2)
        for _ in range(self.random.randint(1, 4)):
            other = self.random.choice((self.number(0, 3), "#1", "#<a>", "#<_y>", "#5420", "0", "2"))
            value = self.random.choice(
                (
                    f"[{value} {self.random.choice(OPERATORS)} {other}]",
                    f"{self.random.choice(FUNCTIONS)}[{value}]",
                    f"atan[{value}]/[{other}]",
                    f"-[{value}]",
                )
            )
        label = self.label()
        condition = f"o{label} if [exists[#<zz>] or [#2 lt 9]]"
        return ["#<a>=1.5 #1=2", f"#2={value}", "(debug,#2)", condition, "#2=1", f"o{label} endif", "g0 x[#2 mod 10]"]

    def label(self) -> int:
        self.labels += 3
        return self.labels

    def nested(self) -> list[str]:
        outer, inner = self.label(), self.label()
        return [
            f"#7=0\no{outer} while [#7 lt 4]",
            "#7=[#7+1]",
            f"o{inner} if [#7 eq {self.random.randint(1, 4)}]",
            *self.straight(),
            f"o{outer} continue",
            f"o{inner} elseif [#7 eq {self.random.randint(1, 4)}]",
            *self.machine(),
            f"o{inner} else",
            *self.straight(),
            f"o{inner} endif",
            f"o{outer} endwhile",
        ]

    def saved(self) -> list[str]:
        mode = self.random.choice(MODES[2:])
        return ["m70", mode, *self.straight(), f"f{self.random.randint(10, 99)}", "m72", *self.straight()]

    def probing(self) -> list[str]:
        return [f"g38.{self.random.randint(2, 5)} {self.axes()}", "(debug,#5061 #5062 #5070)", *self.straight()]

    def absolute_centre(self) -> list[str]:
        x, y, r = self.random.uniform(-9, 9), self.random.uniform(-9, 9), self.random.uniform(1, 5)
        arc = f"g2 x{x + r:.4f} y{y + r:.4f} i{x + r:.4f} j{y:.4f}"
        return ["g90 g17 g90.1", f"g0 x{x:.4f} y{y:.4f}", arc, "g91.1"]

    def diameter(self) -> list[str]:
        return ["g7", *self.random.choice((self.straight, self.offsets, self.tables))(), *self.straight(), "g8"]

    def soup(self) -> list[str]:
        """Words and codes in no order: most of it is refused."""
        count = self.random.randint(0, 3)
        words = [self.random.choice("xyzabcijkpqrldehfst") + self.number(-3, 5) for _ in range(count)]
        words += [self.random.choice(TOKENS) for _ in range(self.random.randint(1, 3))]
        self.random.shuffle(words)
        return [self.random.choice((" ", "")).join(words)]

    KINDS: tuple[tuple[Callable[[Generator], list[str]], int], ...] = (
        (straight, 8), (modal, 4), (arc, 4), (offsets, 4), (machine, 5), (cycle, 2), (polar, 1), (inverse, 1),
        (flow, 2), (parameter, 1), (compensation, 2), (threading, 1), (per_turn, 1), (spline, 1), (tables, 1),
        (expression, 2), (nested, 1), (saved, 1), (probing, 1), (absolute_centre, 1), (diameter, 1),
        (several_spindles, 1), (other_planes, 1), (subprogram, 1), (names, 2),
    )  # fmt: skip

    def program(self, pieces: int = 25, mistake: bool = False) -> str:
        """The text of a program; with ``mistake`` one of its lines is wrong."""
        makers = [maker for maker, weight in self.KINDS for _ in range(weight)]
        if self.turns:
            makers += [Generator.lathe] * 3
        lines = ["g21 g90 g17 g94 f100"]
        for _ in range(pieces):
            lines += self.random.choice(makers)(self)
            if mistake and self.random.random() < 0.1:
                lines += self.soup() if self.random.random() < 0.7 else [self.random.choice(MISTAKES)]
        return "\n".join([*lines, "m2", *self.subprograms, ""])
