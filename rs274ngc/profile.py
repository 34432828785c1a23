"""The geometry of the lathe cycles: a profile of lines and arcs, its offset, its roughing; no interpreter.

Points are complex numbers, *along* + *level* * 1j: the tool cuts along the real axis, at one level after another, and
levels fall towards the material. ``Frame`` turns a lathe's X and Z into this and back, so every quadrant, G71 and G72
are the same here.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil, sqrt, tau

SMALL = 1e-6            # lengths below this are rounding
TOUCH = 2e-3            # of a length: a line or circle that passes a circle this closely touches it
GAP = 0.01              # pieces whose ends lie no further apart are lengthened to meet, not joined by an arc
REACH = 0.1             # how far from their ends they may meet


class ProfileError(ValueError):
    """A profile that cannot be cut; the text says why."""


@dataclass(frozen=True, slots=True)
class Line:
    """A straight piece."""

    start: complex
    end: complex

    def side(self, distance: float) -> Line:
        """Moved to the left by ``distance``."""
        shift = self.heading(self.start) * 1j * distance
        return Line(self.start + shift, self.end + shift)

    def heading(self, _: complex) -> complex:
        """Direction at a point, length 1."""
        length = abs(self.end - self.start)
        return (self.end - self.start) / length if length else 1.0 + 0.0j

    def holds(self, point: complex) -> bool:
        """Is this point of the endless line within the piece?"""
        length = abs(self.end - self.start)
        where = ((point - self.start) * self.heading(self.start).conjugate()).real
        return -SMALL <= where <= length + SMALL

    def at_level(self, level: float) -> complex:
        """Where the piece, which reaches the level, does so first."""
        rise = self.end.imag - self.start.imag
        share = (level - self.start.imag) / rise if rise else 0.0
        return complex(self.start.real + share * (self.end.real - self.start.real), level)

    def monotonic(self) -> bool:
        """Does it never go back along the cut?"""
        return self.end.real >= self.start.real - SMALL

    def pieces(self) -> list[Segment]:
        """Pieces that only climb or only fall."""
        return [self]


@dataclass(frozen=True, slots=True)
class Arc:
    """A round piece; ``left``: counter-clockwise in the frame."""

    start: complex
    end: complex
    centre: complex
    left: bool

    @property
    def radius(self) -> float:
        return abs(self.start - self.centre)

    def swept(self, point: complex) -> float:
        """Angle from the start to a point, in the direction of the arc, 0 to a full turn."""
        angle = cmath.phase((point - self.centre) / (self.start - self.centre))
        angle = angle if self.left else -angle
        return angle % tau if angle < -SMALL else max(angle, 0.0)

    @property
    def sweep(self) -> float:
        """Angle of the whole arc."""
        return self.swept(self.end) or tau

    def side(self, distance: float) -> Arc:
        """Moved to the left by ``distance``."""
        outwards = -distance if self.left else distance
        if self.radius + outwards < SMALL:
            raise ProfileError("an arc of the profile is smaller than the distance to it")
        start, end = self.start - self.centre, self.end - self.centre
        return replace(
            self,
            start=self.start + start / abs(start) * outwards,
            end=self.end + end / abs(end) * outwards,
        )

    def heading(self, point: complex) -> complex:
        """Direction at a point, length 1."""
        ray = (point - self.centre) / abs(point - self.centre)
        return ray * 1j if self.left else ray * -1j

    def holds(self, point: complex) -> bool:
        """Is this point of the circle within the piece?"""
        slack = SMALL / self.radius
        swept = self.swept(point)
        return swept <= self.sweep + slack or swept >= tau - slack

    def at_level(self, level: float) -> complex:
        """Where the piece, which reaches the level, does so first."""
        height = level - self.centre.imag
        half = sqrt(max(0.0, self.radius**2 - height**2))
        points = [complex(self.centre.real + x, level) for x in (-half, half)]
        return min((point for point in points if self.holds(point)), key=self.swept, default=self.end)

    def monotonic(self) -> bool:
        """Does it never go back along the cut?"""
        if self.end.real < self.start.real - SMALL:
            return False
        middle = self.centre + (self.start - self.centre) * cmath.exp((1j if self.left else -1j) * self.sweep / 2)
        headings = (self.heading(point).real for point in (self.start, middle, self.end))
        return all(heading >= -SMALL for heading in headings)

    def pieces(self) -> list[Segment]:
        """Pieces that only climb or only fall: cut at the top or at the bottom of the circle."""
        for top in (self.centre + 1j * self.radius, self.centre - 1j * self.radius):
            inside = self.holds(top) and abs(top - self.start) > SMALL and abs(top - self.end) > SMALL
            if inside:
                return [replace(self, end=top), replace(self, start=top)]
        return [self]


Segment = Line | Arc


@dataclass(frozen=True, slots=True)
class Move:
    """What the tool does next, in the frame; ``centre``: of an arc."""

    end: complex
    rapid: bool = False
    centre: complex | None = None
    left: bool = False


@dataclass(frozen=True, slots=True)
class Frame:
    """How Z and X become along and level: exchanged for facing (G72), turned where the profile goes the other way."""

    facing: bool
    along: float = 1.0
    level: float = 1.0

    def inward(self, z: float, x: float) -> complex:
        return complex(self.along * x, self.level * z) if self.facing else complex(self.along * z, self.level * x)

    def outward(self, point: complex) -> tuple[float, float]:
        """Z and X."""
        along, level = point.real * self.along, point.imag * self.level
        return (level, along) if self.facing else (along, level)

    @property
    def mirrored(self) -> bool:
        """Are left and right exchanged with regard to the plane of Z and X?"""
        return (self.along * self.level < 0.0) != self.facing


# --- Intersections

def intersections(one: Segment, other: Segment) -> list[complex]:
    """Points that the endless lines and whole circles of two pieces have in common."""
    if isinstance(one, Line):
        return line_line(one, other) if isinstance(other, Line) else line_circle(one, other)
    return line_circle(other, one) if isinstance(other, Line) else circle_circle(one, other)


def crossings(one: Segment, other: Segment) -> list[complex]:
    """Points that both pieces have."""
    return [point for point in intersections(one, other) if one.holds(point) and other.holds(point)]


def line_line(one: Line, other: Line) -> list[complex]:
    a, b = one.end - one.start, other.end - other.start
    cross = (a.conjugate() * b).imag
    if abs(cross) < SMALL * SMALL:
        return []
    return [one.start + a * (((other.start - one.start).conjugate() * b).imag / cross)]


def line_circle(line: Line, arc: Arc) -> list[complex]:
    heading = line.heading(line.start)
    foot = line.start + heading * ((arc.centre - line.start) * heading.conjugate()).real
    rest = arc.radius**2 - abs(foot - arc.centre) ** 2
    if rest < -TOUCH * arc.radius:
        return []
    half = heading * sqrt(max(0.0, rest))
    return [foot - half, foot + half]


def circle_circle(one: Arc, other: Arc) -> list[complex]:
    between = other.centre - one.centre
    distance = abs(between)
    if distance < SMALL or distance > one.radius + other.radius + TOUCH:
        return []
    foot = (one.radius**2 - other.radius**2 + distance**2) / (2.0 * distance)
    rest = one.radius**2 - foot**2
    if rest < -TOUCH * one.radius:
        return []
    half = sqrt(max(0.0, rest))
    ray = between / distance
    return [one.centre + ray * complex(foot, side * half) for side in (-1.0, 1.0)]


# --- Corners and distances

def rounded(before: Segment, after: Segment, radius: float, chamfer: bool) -> list[Segment]:
    """Two pieces with a fillet, or a chamfer between the same points, at their corner."""
    turn = (before.heading(before.end).conjugate() * after.heading(after.start)).imag
    if radius <= 0.0 or abs(turn) < SMALL:
        return [before, after]
    left = turn > 0.0
    inner = radius if left else -radius
    centres = crossings(before.side(inner), after.side(inner))
    if not centres:
        raise ProfileError("Not monotonic")
    centre = min(centres, key=lambda point: abs(point - before.end))
    first, last = foot_of(before, centre), foot_of(after, centre)
    bridge: Segment = Line(first, last) if chamfer else Arc(first, last, centre, left)
    return [replace(before, end=first), bridge, replace(after, start=last)]


def foot_of(segment: Segment, point: complex) -> complex:
    """The point of the piece's line or circle that is nearest."""
    if isinstance(segment, Line):
        heading = segment.heading(segment.start)
        return segment.start + heading * ((point - segment.start) * heading.conjugate()).real
    ray = point - segment.centre
    return segment.centre + ray * (segment.radius / abs(ray))


def at_distance(profile: Sequence[Segment], distance: float) -> list[Segment]:
    """The profile moved to its left: round about outer corners, cut short at inner ones."""
    if distance == 0.0:
        return list(profile)
    moved = [profile[0].side(distance)]
    for before, segment in pairwise(profile):
        shifted = segment.side(distance)
        bend = before.heading(before.end).conjugate() * segment.heading(segment.start)
        turn = bend.imag
        if abs(moved[-1].end - shifted.start) < GAP and bend.real > 0.0:
            met = touching(moved[-1], shifted)
        elif turn * distance < 0.0:
            moved.append(Arc(moved[-1].end, shifted.start, segment.start, distance < 0.0))
            met = shifted.start
        else:
            found = meeting(moved, shifted)
            if found is None:
                continue
            met = found
        moved[-1] = replace(moved[-1], end=met)
        moved.append(replace(shifted, start=met))
    return moved


def touching(before: Segment, after: Segment) -> complex:
    """Where two pieces meet that go on in one direction but for rounding: on the first of them, if anywhere near."""
    points = [point for point in intersections(before, rounded_off(after)) if abs(point - after.start) < REACH]
    held = [point for point in points if before.holds(point)]
    if held:
        return min(held, key=lambda point: point.real)
    return min(points, key=lambda point: abs(point - after.start), default=after.start)


def rounded_off(segment: Segment) -> Segment:
    """The piece; an arc with the radius that it has at its end, where it is away from what the start was rounded to."""
    if isinstance(segment, Line):
        return segment
    factor = abs(segment.end - segment.centre) / segment.radius
    return replace(segment, start=segment.centre + (segment.start - segment.centre) * factor)


def meeting(moved: list[Segment], segment: Segment) -> complex | None:
    """Where the last piece that meets ``segment`` does so; the pieces after it lie beyond the corner and go."""
    for k in range(len(moved) - 1, -1, -1):
        points = crossings(moved[k], segment)
        if points:
            del moved[k + 1 :]
            return min(points, key=lambda point: abs(point - segment.start))
    return None


# --- The cycles

def check_monotonic(profile: Sequence[Segment]) -> None:
    """The tool must be able to follow without going back."""
    if not all(segment.monotonic() for segment in profile):
        raise ProfileError("Not monotonic")


def frame_of(points: Sequence[tuple[float, float]], facing: bool) -> Frame:
    """The frame in which a profile through these (Z, X) runs forwards and ends no lower than it begins."""
    plain = Frame(facing)
    first, last = plain.inward(*points[0]), plain.inward(*points[-1])
    return Frame(facing, -1.0 if last.real < first.real else 1.0, -1.0 if last.imag < first.imag else 1.0)


def follow(segment: Segment, rapid: bool = False) -> Move:
    """Along one piece to its end."""
    if isinstance(segment, Arc):
        return Move(segment.end, centre=segment.centre, left=segment.left)
    return Move(segment.end, rapid)


def falls(segment: Segment) -> bool:
    """Does the piece end nearer to the material than it begins?"""
    return segment.end.imag < segment.start.imag - SMALL


@dataclass(frozen=True, slots=True)
class Roughing:
    """G71 and G72: levels ``step`` apart, ``retract`` away from each cut before the way back."""

    step: float
    retract: float
    pockets: str = "all"    # all, first, later

    def moves(self, start: complex, profile: Sequence[Segment]) -> Iterator[Move]:
        """From the start over the material, layer by layer, and at last along the profile."""
        path: list[Segment] = [Line(start, profile[0].start)]
        path += [piece for segment in profile for piece in segment.pieces()]
        last = path[-1].end
        if start.imag > last.imag:
            path.append(Line(last, complex(last.real, start.imag)))
        top = start.imag
        fallen, skip_to = False, -1     # fallen: the first pocket has its bottom behind it
        for k, segment in enumerate(path):
            if k <= skip_to:
                continue
            if not falls(segment):
                fallen = True
                yield follow(segment)
            elif fallen and self.pockets == "first":
                skip_to, over = beyond(path, k, segment.start.imag)
                yield Move(over)
                if skip_to < len(path) and abs(path[skip_to].end - over) > SMALL:
                    yield follow(replace(path[skip_to], start=over))
            elif not fallen and self.pockets == "later":
                yield from self.to_the_end(path, k, segment)
            else:
                if self.pockets == "later" and not falls(path[k - 1]):
                    top = segment.start.imag
                depth = max(0.0, top - segment.start.imag - SMALL)
                yield from self.layers(path, k, top - self.step * ceil(depth / self.step))

    def layers(self, path: Sequence[Segment], k: int, level: float) -> Iterator[Move]:
        """Down the falling piece ``k``, with a cut at each level."""
        segment, rapid = path[k], k == 0
        here = segment.start
        while level > segment.end.imag + SMALL:
            entry = segment.at_level(level)
            if isinstance(segment, Line) or abs(entry - here) > SMALL:
                yield follow(replace(segment, start=here, end=entry), rapid)
            crossing, end = beyond(path, k + 1, level)
            if crossing < len(path):
                yield from self.cut(entry, end)
                yield Move(entry, rapid)
            here = entry
            level -= self.step
        yield from self.to_the_end(path, k, segment)

    def to_the_end(self, path: Sequence[Segment], k: int, segment: Segment) -> Iterator[Move]:
        """The rest of a falling piece; an arc that rises again goes on as the next piece."""
        following = path[k + 1] if k + 1 < len(path) else None
        if not (isinstance(segment, Arc) and isinstance(following, Arc) and following.centre == segment.centre):
            yield follow(segment, k == 0)

    def cut(self, entry: complex, end: complex) -> Iterator[Move]:
        """One layer, and back to where it began."""
        length = end.real - entry.real
        away = length / 2.0 if self.retract < 0.0 else min(self.retract, length / 2.0)
        yield Move(end)
        yield Move(end + complex(-away, away), rapid=True)
        yield Move(entry + complex(away, away), rapid=True)


def beyond(path: Sequence[Segment], k: int, level: float) -> tuple[int, complex]:
    """The first piece from ``k`` on that climbs to a level, and where; past the end: there is none."""
    for n in range(k, len(path)):
        segment = path[n]
        if segment.end.imag > segment.start.imag + SMALL and segment.start.imag < level <= segment.end.imag + SMALL:
            return n, segment.at_level(min(level, segment.end.imag))
    return len(path), path[-1].end


def finishing(start: complex, profile: Sequence[Segment], distances: Sequence[float]) -> Iterator[Move]:
    """G70: along the profile, once at each distance; ``start`` lies between the passes."""
    for distance in distances:
        moved = at_distance(profile, distance)
        yield Move(start, rapid=True)
        yield Move(moved[0].start, rapid=True)
        yield from (follow(segment) for segment in moved)


def passes(first: float, last: float, count: int) -> list[float]:
    """The distances of G70: from ``first`` to ``last`` in ``count`` passes, the first of them already a step nearer."""
    return [last + (left - 1) * (first - last) / count for left in range(count, 0, -1)]
