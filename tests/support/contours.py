"""Random contours with cutter compensation: lines and arcs with corners flat, sharp, inside, outside, or nearly so."""

from __future__ import annotations

import random
from math import atan2, cos, hypot, pi, sin

PLANES = (("g17", "x", "y", "i", "j", "z"), ("g18", "z", "x", "k", "i", "y"))
"""Plane, its axes, its centre words, the axis across."""


class Contour:
    """Writes one program: an entry, moves that turn by chosen angles, an exit."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(f"contour {seed}")
        self.plane, self.a, self.b, self.i, self.j, self.across = self.random.choice(PLANES)
        self.u = self.v = self.heading = 0.0

    def turn(self) -> None:
        """A corner: hardly any, slight, any, square, nearly back, none."""
        choose = self.random
        self.heading += choose.choice((
            choose.uniform(-0.06, 0.06), choose.uniform(-0.3, 0.3), choose.uniform(-pi, pi), pi / 2, -pi / 2,
            choose.uniform(3.0, 3.3), 0.0,
        ))  # fmt: skip

    def line(self, shortest: float = 0.5, code: str = "") -> str:
        length = self.random.uniform(shortest, 15)
        self.u = round(self.u + length * cos(self.heading), 3)
        self.v = round(self.v + length * sin(self.heading), 3)
        rise = f" {self.across}{self.random.uniform(-3, 3):.3f}" if self.random.random() < 0.5 else ""
        return f"{code or self.random.choice(('g1', 'g1', 'g0'))} {self.a}{self.u} {self.b}{self.v}{rise}"

    def arc(self) -> str:
        """An arc that begins in the present direction, but for the rounding of its centre."""
        radius, angle = self.random.uniform(0.5, 12), self.random.choice((pi, pi / 2, self.random.uniform(0.05, 6.2)))
        left = self.random.choice((1, -1))
        i, j = round(-left * sin(self.heading) * radius, 3), round(left * cos(self.heading) * radius, 3)
        centre_u, centre_v, end = self.u + i, self.v + j, atan2(-j, -i) + left * angle
        self.u = round(centre_u + hypot(i, j) * cos(end), 3)
        self.v = round(centre_v + hypot(i, j) * sin(end), 3)
        self.heading += left * angle
        return f"{'g3' if left > 0 else 'g2'} {self.a}{self.u} {self.b}{self.v} {self.i}{i} {self.j}{j}"

    def program(self) -> str:
        """The text of a program."""
        choose = self.random
        self.heading = choose.uniform(0, 2 * pi)
        lines = ["g21 g90 f100", self.plane, f"{choose.choice(('g41', 'g42'))} {choose.choice(('d1', 'd2', 'd7'))}"]
        lines.append(self.line(8, "g1"))
        for _ in range(choose.randint(2, 6)):
            self.turn()
            kind = choose.random()
            if kind < 0.5:
                lines.append(self.line())
            elif kind < 0.6:
                lines.append(f"g1 {self.across}{choose.uniform(-3, 3):.3f}")
            else:
                lines.append(self.arc())
        lines.append(choose.choice(("g40", "g40", "(on)")))
        lines.append(f"g1 {self.a}{self.u + 40:.3f} {self.b}{self.v + 30:.3f}")
        return "\n".join([*lines, "m2", ""])
