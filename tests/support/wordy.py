"""Random programs put together word by word, on random machines: a second generator that knows nothing of the first.

Each line is a set of words that one entry of the manual's tables allows, in any order, written in any way that the
language allows: case, blanks within words, signs, points, expressions, parameters, comments, numbers, slashes. With
``wrong`` some lines get a word too many, too few or of no sense. ``Machine``: tool table, parameter file and INI file.
"""

from __future__ import annotations

import random
from dataclasses import dataclass

TOOL_TABLES = (
    "T1 P1 Z1.5 D0.25\nT2 P2 Z2 D0.5\nT7 P5 X1 Z0.1 D0.1\n",
    "; a lathe's tools\nT1 P1 X-.5 Z1.25 D.03125 I85 J-5 Q2 ;turning\n"
    "T2 P2 X.25 Z2 D.0625 Q3\nT3 P3 D.1 Q6\nT7 P7 D-.2 Q1\n",
    "T1 P3 Z+1.500 A1.5 D0.125;one\nT2 P1 X.1 Y.2 Z.3 A.4 B.5 C.6 U.7 V.8 W.9 D.5\nT7 P2 D1\nT99 P99 Z-4\n",
    "",
)

INI_LINES = {
    "EMCIO": (
        "RANDOM_TOOLCHANGER=1", "TOOL_CHANGE_QUILL_UP=1", "TOOL_CHANGE_WITH_SPINDLE_ON=1", "TOOL_CHANGE_AT_G30=1",
    ),
    "TRAJ": ("SPINDLES=3", "COORDINATES=XYZ", "COORDINATES=XZ"),
    "RS274NGC": (
        "ORIENT_OFFSET=30", "CENTER_ARC_RADIUS_TOLERANCE_MM=0.02", "FEATURES=1", "FEATURES=30",
        "DISABLE_G92_PERSISTENCE=1",
        "DISABLE_FANUC_STYLE_SUB=1", "NO_DOWNCASE_OWORD=1", "OWORD_NARGS=1", "INI_VARS=1",
    ),
    "AXIS_X": ("MAX_LIMIT=77.5", "HOME=1"),
    "AXIS_A": ("WRAPPED_ROTARY=1",),
    "AXIS_C": ("WRAPPED_ROTARY=1",),
}  # fmt: skip

PARAMETERS = (
    5161, 5162, 5163, 5164, 5181, 5182, 5183, 5211, 5212, 5213, 5221, 5222, 5223, 5230, 5241, 5242, 5243, 5250,
    5261, 5270, 5381, 5390, 31, 2000, 5399,
)  # fmt: skip

FUNCTIONS = ("abs", "acos", "asin", "cos", "exp", "fix", "fup", "ln", "round", "sin", "sqrt", "tan", "atan", "exists")
OPERATORS = (
    "+", "-", "*", "/", "**", " mod ", " and ", " or ", " xor ", " eq ", " ne ", " gt ", " ge ", " lt ", " le ",
)  # fmt: skip
PREDEFINED = [
    "_x",
    "_y",
    "_z",
    "_a",
    "_u",
    "_feed",
    "_rpm",
    "_metric",
    "_imperial",
    "_absolute",
    "_incremental",
    "_plane",
    "_ccomp",
    "_motion_mode",
    "_coord_system",
    "_tool_offset",
    "_current_tool",
    "_selected_tool",
    "_spindle_on",
    "_spindle_cw",
    "_mist",
    "_flood",
    "_speed_override",
    "_feed_override",
    "_adaptive_feed",
    "_feed_hold",
    "_inverse_time",
    "_units_per_minute",
    "_units_per_rev",
    "_spindle_rpm_mode",
    "_spindle_css_mode",
    "_ijk_absolute_mode",
    "_lathe_diameter_mode",
    "_lathe_radius_mode",
    "_retract_r_plane",
    "_retract_old_z",
    "_call_level",
    "_remap_level",
    "_line",
    "_value",
    "_value_returned",
    "_current_pocket",
    "_selected_pocket",
    "_vminor",
    "_task",
]
READABLE = (
    1, 2, 5, 30, 31, 5061, 5070, 5161, 5181, 5210, 5211, 5220, 5221, 5222, 5230, 5399, 5400, 5401, 5403, 5410,
    5411, 5420, 5421, 5422, 5423, 5426, 5427, 5599, 5600, 5601,
)  # fmt: skip

MODAL = [
    "g17",
    "g18",
    "g19",
    "g17.1",
    "g20",
    "g21",
    "g40",
    "g49",
    "g54",
    "g55",
    "g57",
    "g59.1",
    "g59.3",
    "g61",
    "g61.1",
    "g64",
    "g80",
    "g90",
    "g91",
    "g90.1",
    "g91.1",
    "g92.1",
    "g92.2",
    "g92.3",
    "g93",
    "g94",
    "g95",
    "g98",
    "g99",
    "g7",
    "g8",
    "m7",
    "m8",
    "m9",
    "m48",
    "m49",
    "m70",
    "m71",
    "m72",
    "m73",
    "m3",
    "m4",
    "m5",
    "m0",
    "m1",
    "m60",
    "m6",
    "g28.1",
    "g30.1",
    "m19",
]

NONSENSE = [
    *[
        "q",
        "x",
        "g",
        "m",
        "g1.5",
        "g100",
        "m200",
        "m-1",
        "g0",
        "g1",
        "g2",
        "g4",
        "g33",
        "g38.2",
        "g53",
        "g41.1",
        "g43.1",
        "g76",
        "x1",
        "y2",
        "z3",
        "a4",
        "i1",
        "j1",
        "k1",
        "r1",
        "p1",
        "q1",
        "l1",
        "d1",
        "h1",
        "e1",
        "f1",
        "s1",
        "t1",
        "n5",
        "$0",
        "$7",
        "@1",
        "^45",
        "#1=1",
        "#1",
        "[1",
        "1]",
        "=",
        "(un",
        ")",
        "%",
        "x1.1.1",
        "x--1",
        "x+-1",
        "x1e3",
        "p-1",
        "f-1",
        "s-1",
        "t-1",
        "t77",
        "h99",
        "d99",
        "m98",
        "m99",
        "m2",
        "o5",
        "l0",
        "l2.5",
        "&",
        "!",
        "x#",
        "x#0",
        "x#5603",
        "x#<no>",
        "x[1/0]",
        "x[ln[0]]",
        "x[sqrt[-1]]",
        "x[-1**.5]",
        "xmod",
        "x[]",
        "g38.6",
        "g5.4",
        "g59.4",
        "g92.4",
    ],
    "x acos[2]",
    "x atan[1]",
    "x[1 2]",
    "g64 p-1",
]


@dataclass(frozen=True, slots=True)
class Machine:
    """What both interpreters are started with."""

    tools: str
    parameters: str
    ini: str  # empty: none
    block_delete: bool


def machine(seed: int) -> Machine:
    """The machine of a seed; every other one is plain."""
    choice = random.Random(f"machine {seed}")
    if seed % 2:
        return Machine(TOOL_TABLES[0], "", "", False)
    parameters = "".join(
        f"{number}\t{choice.randint(1, 9) if number == 5220 else choice.uniform(-5, 5):.6f}\n"
        for number in sorted(PARAMETERS) if choice.random() < 0.3
    )  # fmt: skip
    ini = ""
    if choice.random() < 0.6:
        for section, lines in INI_LINES.items():
            chosen = [line for line in lines if choice.random() < 0.25]
            if section == "RS274NGC":
                chosen.append("PARAMETER_FILE=machine.var")
            ini += f"[{section}]\n" + "".join(f"{line}\n" for line in chosen)
    return Machine(choice.choice(TOOL_TABLES), parameters, ini, choice.random() < 0.3)


class Wordy:
    """Writes one program."""

    def __init__(self, seed: int, wrong: bool) -> None:
        self.random = random.Random(f"wordy {seed}")
        self.wrong = wrong
        self.label = 0
        self.depth = 0
        self.subs: list[str] = []

    # --- Values

    def chance(self, share: float) -> bool:
        return self.random.random() < share

    def plain(self, low: float, high: float) -> str:
        """A number as it may be typed."""
        value = self.random.uniform(low, high)
        text = f"{value:.{self.random.choice((0, 1, 2, 3, 3, 4, 6))}f}"
        if self.chance(0.2) and "." in text:
            text = text.rstrip("0")
        if self.chance(0.1) and "." not in text:
            text += "."
        if self.chance(0.2):
            text = text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) and not text.endswith("0.") else text
        if self.chance(0.1) and not text.startswith("-"):
            text = "+" + text
        return text

    def value(self, low: float = -9.0, high: float = 9.0, depth: int = 0) -> str:
        """Anything that may follow a letter and is about in this range."""
        how = self.random.random()
        if how < 0.75 or depth > 2:
            return self.plain(low, high)
        inner = self.value(low, high, depth + 1)
        if how < 0.80:
            return f"[{inner}]"
        if how < 0.85:
            return f"[{self.value(low / 2, high / 2, depth + 1)}+{self.plain(low / 2, high / 2)}]"
        if how < 0.88:
            return f"#[{self.random.randint(1, 4)}*10]" if low < 0 else f"abs[{inner}]"
        if how < 0.91:
            return f"#<{self.random.choice(('Here', 'there', '_World'))}>"
        if how < 0.94:
            return f"[{inner}{self.random.choice(OPERATORS)}{self.plain(1, 3)}]" if low < 0 else f"[{inner} * 1]"
        return f"-[{self.value(-high, -low, depth + 1)}]"

    def integer(self, low: int, high: int) -> str:
        number = self.random.randint(low, high)
        return self.random.choice((f"{number}", f"{number}", f"{number}.", f"[{number - 1}+1]", f"{number}.00001"))

    def expression(self, depth: int = 0) -> str:
        """Any expression, sensible or not."""
        how = self.random.random()
        if how < 0.25 or depth > 3:
            return self.plain(-9, 9)
        if how < 0.35:
            return f"#{self.random.choice(READABLE)}"
        if how < 0.45:
            return f"#<{self.random.choice(PREDEFINED)}>"
        if how < 0.65:
            name = self.random.choice(FUNCTIONS)
            if name == "exists":
                return f"exists[#<{self.random.choice(('here', 'nowhere', '_x', '_world'))}>]"
            if name == "atan":
                return f"atan[{self.expression(depth + 1)}]/[{self.expression(depth + 1)}]"
            return f"{name}[{self.expression(depth + 1)}]"
        terms = [self.expression(depth + 1) for _ in range(self.random.randint(2, 4))]
        text = terms[0]
        for term in terms[1:]:
            text += self.random.choice(OPERATORS) + term
        return f"[{text}]"

    # --- Words of one line

    def some(self, letters: str, share: float = 0.5, low: float = -9.0, high: float = 9.0) -> list[str]:
        """Words of some of these letters."""
        return [letter + self.value(low, high) for letter in letters if self.chance(share)]

    def axes(self) -> list[str]:
        letters = "xyz" if self.chance(0.8) else "xyzabcuvw"
        return self.some(letters) or ["x" + self.value()]

    def move(self) -> list[str]:
        words = [*self.axes(), *self.some("f", 0.2, 1, 200)]
        return [self.random.choice(("g0", "g1", "g1", "g53 g0", "g53 g1 g90")), *words] if self.chance(0.6) else words

    def arc(self) -> list[str]:
        radius = self.random.uniform(0.5, 8)
        plane, first, second, one, two, third = self.random.choice(
            (("g17", "x", "y", "i", "j", "z"), ("g18", "x", "z", "i", "k", "y"), ("g19", "y", "z", "j", "k", "x"))
        )
        words = [plane, "g91", "g91.1", self.random.choice(("g2", "g3")), *self.some(third, 0.3), *self.some("a", 0.05)]
        if self.chance(0.3):
            words.append("p" + self.integer(1, 4))
        if self.chance(0.4):
            dx, dy = self.random.uniform(-radius, radius), self.random.uniform(-radius, radius)
            big = self.random.choice((2, 1.5, -2, -1.5)) * radius
            return [*words, f"{first}{dx:.4f}", f"{second}{dy:.4f}", f"r{big:.4f}"]
        if self.chance(0.3):
            return [*words, f"{one}{radius:.3f}"]
        i = round(self.random.uniform(-radius, radius), 3)
        j = round(max(0.0, radius**2 - i**2) ** 0.5, 3)
        turn = self.random.choice(((2 * i, 2 * j), (i - j, j + i), (i + j, j - i)))
        return [*words, f"{first}{turn[0]:.3f}", f"{second}{turn[1]:.3f}", f"{one}{i}", f"{two}{j}"]

    def cycle(self) -> list[str]:
        code, extra = self.random.choice(
            (
                ("g81", ""),
                ("g82", "p"),
                ("g83", "q"),
                ("g73", "q"),
                ("g85", ""),
                ("g86", "p"),
                ("g89", "p"),
                ("g84", ""),
                ("g74", ""),
                ("g84", "p"),
            )
        )
        words = [*self.some("xyz", 0.7), *self.some(extra, 0.9, 0.1, 2), *self.some("r", 0.8, 0, 5)]
        if self.chance(0.2) and code not in ("g74", "g84"):
            words.append("l" + self.integer(1, 4))
        return [code, *self.random.choice((["m3", "s100"], ["m4", "s100"], [])), *words]

    def threading(self) -> list[str]:
        kind = self.random.randint(0, 3)
        if kind == 0:
            return [
                "g18",
                "g76",
                "p" + self.value(0.3, 2),
                "z" + self.value(-9, 0),
                "i" + self.value(-2, -0.1),
                "j" + self.value(0.1, 0.5),
                "k" + self.value(0.6, 2),
                *self.some("r", 0.3, 1, 3),
                *self.some("q", 0.3, 0, 40),
                *self.some("h", 0.2, 0, 3),
                *self.some("e", 0.3, 0, 1),
                *(["l" + self.integer(0, 3)] if self.chance(0.4) else []),
            ]
        return [
            ("g33", "g33", "g33.1")[kind - 1],
            *self.some("z", 0.9),
            *self.some("x", 0.3),
            "k" + self.value(0.1, 2),
            *self.some("i", 0.2, 1, 3),
            *self.some("$", 0.1, 0, 1),
        ]

    def spline(self) -> list[str]:
        kind = self.random.randint(0, 3)
        if kind == 0:
            return ["g17", "g5", *self.some("xy", 0.9), *self.some("ij", 0.9), *self.some("pq", 0.95)]
        if kind == 1:
            return ["g17", "g5.1", *self.some("xy", 0.9), *self.some("ij", 0.9)]
        if kind == 2:
            return [
                "g17",
                "g5.2",
                *self.some("xy", 0.95),
                *self.some("p", 0.8, 0.3, 3),
                *(["l3"] if self.chance(0.3) else []),
            ]
        return ["g5.3"]

    def set_data(self) -> list[str]:
        kind = self.random.choice((1, 1, 2, 2, 2, 10, 11, 20, 20, 0))
        words = ["g10", f"l{kind}", *self.some("xyzac" if kind else "", 0.4), *self.some("r", 0.2, 0, 60)]
        if kind in (2, 20):
            return [*words, "p" + self.integer(0, 9)]
        if kind == 0:
            return words
        if kind == 1 and self.chance(0.3):
            words += ["i" + self.value(0, 90), "j" + self.value(0, 90), "q" + self.integer(0, 9)]
        return [*words, "p" + self.random.choice("127")]

    def offset(self) -> list[str]:
        return self.random.choice(
            (
                ["g92", *self.axes()],
                ["g52", *self.axes()],
                ["g43"],
                ["g43", "h" + self.random.choice("0127")],
                ["g43.1", *self.axes()],
                ["g43.2", "h" + self.random.choice("127")],
                ["g28", *self.some("xyza", 0.3)],
                ["g30", *self.some("xyz", 0.3)],
            )
        )

    def compensation(self) -> list[str]:
        code = self.random.choice(("g41", "g42", "g41.1", "g42.1"))
        if "." in code:
            return [code, "d" + self.value(0.05, 1.5), *(["l" + self.integer(0, 9)] if self.chance(0.2) else [])]
        return [code, *self.random.choice((["d1"], ["d2"], ["d7"], []))]

    def probe(self) -> list[str]:
        return [self.random.choice(("g38.2", "g38.3", "g38.4", "g38.5")), *self.axes()]

    def spindle(self) -> list[str]:
        which = ["$" + self.integer(0, 2)] if self.chance(0.2) else []
        return self.random.choice(
            (
                ["m3", "s" + self.value(1, 5000), *which],
                ["m4", *which],
                ["m5", *which],
                ["s" + self.value(0, 99), *which],
                ["g96", "s" + self.value(1, 99), *self.some("d", 0.6, 1, 3000), *which],
                ["g97", "s" + self.value(1, 999), *which],
                [
                    "m19",
                    *self.some("r", 0.7, 0, 360),
                    *(["p" + self.integer(0, 2)] if self.chance(0.5) else []),
                    *self.some("q", 0.3, 1, 9),
                    *which,
                ],
                ["m51", "p" + self.integer(0, 1), *which],
            )
        )

    def switch(self) -> list[str]:
        return self.random.choice(
            (
                [f"m{self.random.randint(62, 65)}", "p" + self.integer(0, 9)],
                ["m50", "p" + self.integer(0, 1)],
                ["m52", "p" + self.integer(0, 1)],
                ["m53", "p" + self.integer(0, 1)],
                ["m50"],
                ["m52"],
                ["m53"],
                ["m67", "e" + self.integer(0, 3), *self.some("q", 0.9)],
                ["m68", "e" + self.integer(0, 3), *self.some("q", 0.9)],
                ["m66", "p" + self.integer(0, 3), "l0"],
                ["m66", "p" + self.integer(0, 3), "l" + self.integer(0, 4), "q" + self.value(0, 3)],
                ["m66", "e" + self.integer(0, 3), "l0"],
                ["m6", "t" + self.random.choice("127")],
                ["t" + self.random.choice("0127")],
                ["m61", "q" + self.random.choice("0127")],
                ["g4", "p" + self.value(0, 3)],
                [f"m{self.random.randint(100, 105)}"],
                ["g64", *self.some("pq", 0.6, 0, 1)],
            )
        )

    def modal(self) -> list[str]:
        return [self.random.choice(MODAL) for _ in range(1 if self.chance(0.7) else 2)]

    def setting(self) -> list[str]:
        target = self.random.choice(
            ("#1", "#2", "#10", "#20", "#[3*10]", "#40", "#<Here>", "#<there>", "#<_world>", "##1")
        )
        if target == "##1" and not self.wrong:
            target = "#5"
        return [f"{target} = {self.value()}" for _ in range(self.random.randint(1, 2))]

    def remark(self) -> list[str]:
        shown = (
            f"{self.expression()}"
            if self.chance(0.2)
            else f"#{self.random.choice(READABLE)} #<{self.random.choice(PREDEFINED)}>"
        )
        return [
            self.random.choice(
                (
                    f"(debug, a {shown})",
                    f"(DEBUG,%d#{self.random.choice(READABLE)} %.3f#<{self.random.choice(PREDEFINED)}> %f#2)",
                    "(msg, Hello World)",
                    "( MSG,Hello)",
                    f"(print,{shown})",
                    "(just so)",
                    "()",
                    "; (msg,no)",
                    ";(debug,#1)",
                    f"(debug,#1 #<here> #<Nowhere> {shown} %lf#1 %5#1 %)",
                )
            )
        ]

    KINDS = (
        (move, 10),
        (arc, 4),
        (cycle, 3),
        (threading, 1),
        (spline, 2),
        (set_data, 3),
        (offset, 3),
        (compensation, 1),
        (probe, 1),
        (spindle, 2),
        (switch, 3),
        (modal, 5),
        (setting, 3),
        (remark, 2),
    )

    # --- Lines

    def dressed(self, words: list[str]) -> str:
        """The words as somebody may type them."""
        words = [word for word in words if word]
        if self.chance(0.3):
            self.random.shuffle(words)
        joint = self.random.choice((" ", " ", " ", "", "  ", "\t"))
        line = joint.join(words)
        if "(" in line or ";" in line:
            return line
        if self.chance(0.15):
            line = line.upper()
        if self.chance(0.05):
            line = " ".join(line)
        if self.chance(0.05):
            line = f"n{self.random.randint(0, 99999)}{self.random.choice(('', '', '.5'))} {line}"
        if self.chance(0.05):
            line = "/" + line
        if self.chance(0.08):
            line += self.random.choice((" (comment)", ";comment", " ; with #1 and [", "(a)(b)", "(msg,in passing)"))
        return line

    def line(self) -> list[str]:
        makers = [maker for maker, weight in self.KINDS for _ in range(weight)]
        words = self.random.choice(makers)(self)
        if self.wrong and self.chance(0.12):
            how = self.random.randint(0, 2)
            if how == 0 and len(words) > 1:
                words.pop(self.random.randrange(len(words)))
            elif how == 1:
                words.append(self.random.choice(NONSENSE))
            else:
                words += self.random.choice(makers)(self)
        return [self.dressed(words)]

    def block(self) -> list[str]:
        """Lines, or a loop, a condition, a subroutine and its call about them."""
        if self.depth > 2 or self.chance(0.88):
            return self.line()
        self.depth += 1
        self.label += 1
        name = self.random.choice((f"o{100 + self.label}", f"o<Name{self.label}>", f"O{100 + self.label}"))
        body = [line for _ in range(self.random.randint(1, 3)) for line in self.block()]
        self.depth -= 1
        count = f"#<n{self.label}>"
        kind = self.random.randint(0, 5)
        if kind == 0:
            branch = [f"{name} else", *self.line()] if self.chance(0.5) else []
            return [f"{name} if [{self.expression()}]", *body, *branch, f"{name} endif"]
        if kind == 1:
            leave = (
                [
                    f"o{500 + self.label} if [{count} gt 2]",
                    f"{name} {self.random.choice(('break', 'continue'))}",
                    f"o{500 + self.label} endif",
                ]
                if self.chance(0.4)
                else []
            )
            return [
                f"{count}=0",
                f"{name} while [{count} lt 3]",
                f"{count}=[{count}+1]",
                *leave,
                *body,
                f"{name} endwhile",
            ]
        if kind == 2:
            return [f"{count}=0", f"{name} do", f"{count}=[{count}+1]", *body, f"{name} while [{count} lt 2]"]
        if kind == 3:
            return [f"{name} repeat [{self.random.randint(0, 3)}]", *body, f"{name} endrepeat"]
        arguments = " ".join(f"[{self.value()}]" for _ in range(self.random.randint(0, 3)))
        if kind == 4 or self.depth:
            end = self.random.choice(("endsub", "endsub [#1]", "endsub"))
            define = (
                [
                    f"{name} sub",
                    *self.random.choice(([], ["m73"], [f"{name} return [1]"] if self.chance(0.2) else [])),
                    *body,
                    f"{name} {end}",
                ]
                if not self.depth
                else []
            )
            return [*define, f"{name} call {arguments}"] if define else body
        number = 700 + self.label
        self.subs += [f"o{number}", *body, "m99"]
        return [f"m98 p{number}" + self.random.choice(("", " l2", " L3"))]

    def program(self, lines: int = 14) -> str:
        """The text of a program."""
        text = [self.random.choice(("g21 g90 g17 g94 f100", "g20 f10", "g21f200 g91", "f50", "g7 f20 g18"))]
        text += [
            f"#1=1 #2=2 #5=5 #10={self.plain(-5, 5)} #20=2.5 #30=-3 #40=4",
            "#<here>=1.5",
            "#<there>=-2",
            "#<_world>=3",
        ]
        for _ in range(lines):
            text += self.block()
        end = self.random.choice(("m2", "m30", "M2", "g40 m2", "%"))
        text += [*self.subs, end, ""] if end == "%" else [end, *self.subs, ""]
        if end == "%":
            text = ["%", *text]
        return "\n".join(text)
