"""Points on a NURBS curve in a plane, for canons that only know straight lines."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from math import hypot

SEGMENTS_PER_SPAN = 32


def knot_vector(count: int, order: int) -> list[float]:
    """Uniform and clamped: ``order`` times the first and the last parameter."""
    spans = count - order + 1
    return [0.0] * order + [float(k) for k in range(1, spans)] + [float(spans)] * order


def point(
    control: Sequence[tuple[float, float, float]], order: int, knots: Sequence[float], t: float
) -> tuple[float, float]:
    """The curve at parameter ``t``, by de Boor's recursion on homogeneous coordinates."""
    span = min(bisect_right(knots, t, order) - 1, len(control) - 1)
    work = [(x * w, y * w, w) for x, y, w in control[span - order + 1 : span + 1]]
    for level in range(1, order):
        for k in range(order - 1, level - 1, -1):
            low = span - order + 1 + k
            width = knots[low + order - level] - knots[low]
            share = (t - knots[low]) / width if width else 0.0
            work[k] = tuple(  # type: ignore[assignment]
                (1.0 - share) * before + share * after for before, after in zip(work[k - 1], work[k], strict=True)
            )
    x, y, weight = work[-1]
    return (x / weight, y / weight) if weight else (x, y)


def points(
    control: Sequence[tuple[float, float, float]], order: int, knots: Sequence[float]
) -> Iterator[tuple[float, float]]:
    """Points along the curve, the start left out, the end exact."""
    if not 2 <= order <= len(control):
        order = max(2, min(order, len(control)))
        knots = knot_vector(len(control), order)
    begin, end = knots[order - 1], knots[len(control)]
    steps = (len(control) - order + 1) * SEGMENTS_PER_SPAN
    last = control[0][:2]
    for step in range(1, steps):
        here = point(control, order, knots, begin + (end - begin) * step / steps)
        if hypot(here[0] - last[0], here[1] - last[1]) > 0.0:
            yield here
        last = here
    yield control[-1][0], control[-1][1]
