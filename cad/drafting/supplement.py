"""Add dimensions that no parameter gives: positions derived by the model, and overall lengths."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, pairwise
from math import atan2, cos, degrees, dist, hypot, radians, sin

from cad.drafting.curves import Point
from cad.drafting.definition import AXIS, Definition, Station, hole_stations, nearest
from cad.drafting.measures import Measure, foot
from cad.drafting.parameter_match import Dimension
from cad.drafting.parts_features import Hole
from cad.drafting.views import View

_CLEAR = 1e-4  # [mm, deg]
_NEAR, _BESIDE = 0.05, 2.0  # from a direction to the end of an edge, and to a point of an outline [deg]
_MOST = 60
"""Dimensions that are added: a sheet with more of them could not be read."""


@dataclass(frozen=True)
class Supplement:
    """Adds dimensions to a definition until nothing is missing that the two views can show."""

    definition: Definition
    section: View
    end: View
    shown: Sequence[Measure]
    repeated: Mapping[str, Sequence[Point]]

    def complete(self, taken: Sequence[Dimension]) -> list[Dimension]:
        """Return the given dimensions and the missing ones; redundant ones become reference dimensions."""
        every = [self.judged(one) for one in taken]
        for measure in self._missing():
            if len(every) >= len(taken) + _MOST:
                break
            if self.definition.add(measure):
                every.append(Dimension(measure, None))
        return [*every, *self._overall(every)]

    def judged(self, one: Dimension) -> Dimension:
        """Add a dimension; return it, as a reference if it is redundant and has no tolerance."""
        is_new = self.definition.add(one.measure)
        joined_spans(self.definition, self.repeated.get(one.name or "", ()))
        return one if is_new or one.limits else replace(one, is_reference=True)

    def _missing(self) -> Iterator[Measure]:
        yield from self._own()
        yield from self._round()
        for direction in ("across", "up"):
            yield from self._levels(direction)
        for direction in ("across", "up"):
            yield from self._pitch(direction)
        for hole in self.definition.features.holes:
            yield from self._axis(hole)
        yield from self._turns()
        yield from self._whole_length()
        yield from self._levels("along")

    def _own(self) -> Iterator[Measure]:
        """Yield the missing sizes of features that the views show."""
        for sort, value in self.definition.own:
            if self.definition.has_own((sort, value)):
                continue
            fitting = (m for m in self.shown if m.sort == sort and abs(m.value - value) < _CLEAR)
            if measure := next((m for m in fitting if self.definition.span(m) is None), None):
                yield measure

    def _round(self) -> Iterator[Measure]:
        """Yield missing radii about the shaft, each as a diameter, radius, wall thickness or height."""
        for group in self.definition.components("round")[1:]:
            for radius in (at for _, at in group):
                if self.definition.joined(("round", radius), AXIS):
                    break
                found = [m for m in self.shown if self._gives(m, ("round", radius))]
                order = {("diameter", "up"): 0, ("radius", "arc"): 1, ("gap", "up"): 2}
                if measure := min(found, key=lambda m: order.get((m.sort, m.form), 3), default=None):
                    yield measure
                else:
                    yield from self._drawn_radius(radius)

    def _gives(self, measure: Measure, wanted: Station) -> bool:
        span = self.definition.span(measure)
        if span is None or wanted not in span:
            return False
        return any(self.definition.joined(one, AXIS) for one in span)

    def _drawn_radius(self, radius: float) -> Iterator[Measure]:
        """Yield the diameter of a groove's root, or the height at which a slope begins."""
        features = self.definition.features
        near = [at for at in features.round_at if abs(at - radius) < _CLEAR]
        if not near:
            return
        z = features.round_at[near[0]]
        if "groove" in features.round[near[0]]:
            yield Measure("diameter", 2 * near[0], "section", "up", ((z, -near[0]), (z, near[0])))
        else:
            yield Measure("offset", near[0], "section", "up", ((z, 0.0), (z, near[0])))

    def _levels(self, direction: str) -> Iterator[Measure]:
        """Yield the distances that connect separate groups of planes and axes, the nearest first."""
        for _ in range(_MOST):
            groups = self.definition.components(direction)  # type: ignore[arg-type]
            placed, others = groups[0] if groups else [], groups[1:]
            if not others:
                return
            pairs = groups if direction == "along" else others  # nothing is on the axis along the shaft
            yield self._between(*(self._mirrored(pairs) or self._pair(direction, placed, others)))

    def _whole_length(self) -> Iterator[Measure]:
        """Yield the overall length if it is loose: the smaller lengths beside it then close no chain."""
        ends = sorted(one for one in self.definition.needed if one[0] == "along")
        if len(ends) > 1 and not self.definition.joined(ends[0], ends[-1]):
            yield self._level(ends[0][1], ends[-1][1])

    def _mirrored(self, others: Sequence[Sequence[Station]]) -> tuple[Station, Station] | None:
        """Return the widest pair of stations that are symmetric about a centre line and not yet located."""
        groups = combinations(others, 2)
        pairs = [
            (a, b) for one, other in groups for a in one for b in other if self.definition.is_symmetric(a, b)
        ]
        return max(pairs, key=lambda pair: abs(pair[0][1] - pair[1][1]), default=None)

    def _pair(
        self, direction: str, placed: Sequence[Station], others: Sequence[Sequence[Station]]
    ) -> tuple[Station, Station]:
        """Return the two stations to connect.

        Along the shaft, stations on a centre line come first; otherwise the nearest pair is taken.
        """
        if direction == "along":
            on_centre = [
                [one for one in group if any(abs(one[1] - c) < _CLEAR for c in self.definition.centres)]
                for group in others
            ]
            pair = nearest([group for group in on_centre if group], placed)
        else:
            known = (one for one in self.definition.optional if one[0] == direction)
            located = [one for one in known if self.definition.joined(one, AXIS)]
            placed, pair = [*placed, *located, (direction, 0.0)], None  # type: ignore[list-item]
        pair = pair or nearest(others, placed)
        assert pair is not None
        return pair

    def _between(self, one: Station, other: Station) -> Measure:
        low, high = sorted((one[1], other[1]))
        if one[0] == "along":
            return self._level(low, high)
        along = int(other[0] == "up")
        side = self.end.box[0][1 - along]
        ends = ((at, self._place(along, at, side)) for at in (low, high))
        points = tuple((across, at) if along else (at, across) for at, across in ends)
        return Measure("width", high - low, "end", "up" if along else "across", points)

    def _place(self, along: int, at: float, side: float) -> float:
        """Return the other coordinate of a level: that of a hole on it, or of the side of the view."""
        features = self.definition.features
        places = [hole.axis[1 - along] for hole in features.holes if abs(hole.axis[along] - at) < _CLEAR]
        places += [x for height, x in features.bars.items() if along and abs(height - at) < _CLEAR]
        return places[0] if places else side

    def _level(self, low: float, high: float) -> Measure:
        points = (low, foot(self.section, low)), (high, foot(self.section, high))
        return Measure("length", high - low, "section", "across", points)

    def _pitch(self, direction: str) -> Iterator[Measure]:
        """Yield the distance of holes in rows at equal distances, with its count, as for a grid of holes."""
        along = int(direction == "up")
        holes = self.definition.features.holes
        loose = [h for h in holes if not self.definition.is_even(h) and not self.definition.is_located(h)]
        at = sorted({round(hole.axis[along], 4) for hole in loose})
        steps = [high - low for low, high in pairwise(at)]
        if len(steps) > 1 and max(steps) - min(steps) < _CLEAR:
            one, other = ((direction, level) for level in at[:2])
            yield replace(self._between(one, other), sort="pitch", count=len(steps))  # type: ignore[arg-type]

    def _axis(self, hole: Hole) -> Iterator[Measure]:
        """Yield the dimensions that locate an axis along the shaft: pitch circle and angle, or offsets."""
        if self.definition.is_located(hole):
            return
        across, up, around, turn = hole_stations(hole)
        if not self.definition.joined(around, AXIS) and self.definition.is_even(hole):
            yield Measure("diameter", 2 * hypot(*hole.axis), "end", "circle", ((0.0, 0.0), hole.axis))
        if self.definition.joined(around, AXIS):
            if not self.definition.is_located(hole):
                yield self._turn(turn)
            return
        x, y = hole.axis
        if not self.definition.joined(up, AXIS):
            yield Measure("offset", abs(y), "end", "up", ((x, min(y, 0.0)), (x, max(y, 0.0))))
        if not self.definition.joined(across, AXIS):
            yield Measure("offset", abs(x), "end", "across", ((min(x, 0.0), y), (max(x, 0.0), y)))

    def _turns(self) -> Iterator[Measure]:
        """Yield the missing angles about the shaft.

        Each is the step of a pattern, or the angle from the nearest located direction.
        """
        for _ in range(_MOST):
            loose = [one for group in self.definition.components("turn")[1:] for one in group]
            if not loose:
                return
            pairs = sorted(combinations(loose, 2), key=lambda pair: abs(_apart(*pair)))
            step = [pair for pair in pairs if abs(abs(_apart(*pair)) - abs(_apart(*pairs[0]))) < _CLEAR]
            if len(step) > 1:
                off = (pair for pair in step if not self.definition.is_symmetric(*pair))
                yield self._angle(*next(off, step[0]), count=len(step))
                continue
            mirrored = any(self.definition.is_mirrored(loose[0], other) for other in loose[1:])
            yield self._turn(loose[0], count=2 if mirrored else 1)

    def _turn(self, one: Station, count: int = 1) -> Measure:
        """Return the angle between a direction and the nearest direction that is already located."""
        known: list[Station] = [("turn", at) for at in (0.0, 90.0, 180.0, 270.0)]
        others = self.definition.optional if one in self.definition.optional else self.definition.needed
        if count == 1:
            known += [o for o in others if o[0] == "turn" and self.definition.joined(o, ("turn", 0.0))]
        apart = [(abs(_apart(one, other)), other) for other in known if abs(_apart(one, other)) > _CLEAR]
        return self._angle(min(apart)[1], one, count)

    def _angle(self, one: Station, other: Station, count: int = 1) -> Measure:
        legs = [self._at(turn) for _, turn in (one, other)]
        if _apart(one, other) < 0:
            legs.reverse()
        points: tuple[Point, ...] = ((0.0, 0.0), *legs)
        return Measure("angle", abs(_apart(one, other)), "end", "angle", points, count)

    def _at(self, turn: float) -> Point:
        """Return the point in a direction from the shaft [deg] at which something is that lies there.

        It is the centre of a hole, the end of an edge, or else the outline of the part.
        """
        curves = (*self.end.visible, *self.end.hidden)
        open_ = (curve for curve in curves if dist(curve.points[0], curve.points[-1]) > _CLEAR)
        ends = (point for curve in open_ for point in (curve.points[0], curve.points[-1]))
        every = [circle.centre for circle in self.end.circles], [*ends], [p for c in curves for p in c.points]
        for some, near in zip(every, (_NEAR, _NEAR, _BESIDE), strict=True):
            along = [hypot(x, y) for x, y in some if hypot(x, y) > _CLEAR and _is_near((x, y), turn, near)]
            if along:
                break
        reach = max(along, default=max(abs(value) for corner in self.end.box for value in corner) / 2)
        return reach * cos(radians(turn)), reach * sin(radians(turn))

    def _overall(self, every: Iterable[Dimension]) -> Iterator[Dimension]:
        """Yield the overall length, for reference, if no dimension shows it."""
        levels = [at for direction, at in self.definition.needed if direction == "along"]
        spans = [sorted(x for x, _ in one.measure.points) for one in every
                 if (one.measure.form, one.measure.place) == ("across", "section")]  # fmt: skip
        if len(levels) > 2:
            low, high = min(levels), max(levels)
            if not any(abs(span[0] - low) + abs(span[-1] - high) < _CLEAR for span in spans):
                yield Dimension(self._level(low, high), None, is_reference=True)


def _apart(one: Station, other: Station) -> float:
    """Return the angle from one direction to another [deg], from -180 to 180."""
    return (other[1] - one[1] + 180) % 360 - 180


def _is_near(point: Point, turn: float, near: float) -> bool:
    """Return whether the direction to a point from the origin is a given one, within an angle [deg]."""
    return abs(_apart(("turn", degrees(atan2(point[1], point[0]))), ("turn", turn))) < near


def joined_spans(definition: Definition, spans: Iterable[Point]) -> None:
    """Join the stations at the ends of spans along the shaft that repeated dimensions or other views give."""
    for low, high in spans:
        one, other = definition.known("along", low), definition.known("along", high)
        if one and other:
            definition.join(one, other)
    definition.settle()
