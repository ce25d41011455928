"""Decide whether the dimensions of a sheet define its parts completely and without repetition (ISO 129-1).

Every face has stations: a plane has its position along its normal, a cylinder about the shaft its radius, any
other cylinder the position of its axis, and a plane oblique to the centre lines its direction about the
shaft. A dimension joins the two stations between which it is drawn. The sheet is complete if the stations of
each direction are connected. A dimension between two stations that are already connected would close a chain,
so it is shown in brackets.

Some relations need no number: features on a centre line, pairs placed symmetrically about one, equal features
(dimensioned once), holes spaced evenly on their circle, fillets tangent to their neighbours, right angles.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import combinations, pairwise
from math import atan2, degrees, dist, hypot
from typing import Literal

from cad.drafting.measures import Measure
from cad.drafting.parts_features import Features, Hole, Sort, Words
from cad.surfaces import Face

Direction = Literal["along", "across", "up", "round", "turn"]
"""Along the shaft; level and upright in the end view; radii about the shaft [mm]; angles about it [deg]."""

Station = tuple[Direction, float]
Own = tuple[Sort, float]

CLEAR = 1e-4  # [mm, deg]: stations that are nearer coincide
AXIS: Station = ("round", 0.0)
"""The axis of the shaft, on which the centre lines of the end view meet."""


def station(direction: Direction, at: float) -> Station:
    """Return the station at a coordinate.

    All coordinates on the axis of the shaft give one station, and so do all directions of the centre lines.
    Angles are reduced to one turn.
    """
    at = round(at % 360 if direction == "turn" else at, 4) + 0.0
    if direction == "turn":
        return ("turn", 0.0) if at % 90 < CLEAR or 90 - at % 90 < CLEAR else ("turn", at)
    return AXIS if direction != "along" and abs(at) < CLEAR else (direction, at)


@dataclass
class Definition:
    """The stations and sizes that a sheet must define, and those that its dimensions have defined so far.

    Attributes
    ----------
    needed, optional
        Stations with their descriptions; the optional ones belong to holes, which either two coordinates or a
        circle and an angle locate.
    centres
        Positions along the shaft at which the section has a centre line.
    """

    features: Features
    needed: dict[Station, str] = field(default_factory=dict)
    optional: set[Station] = field(default_factory=set)
    own: dict[Own, str] = field(default_factory=dict)
    given: set[Own] = field(default_factory=set)
    sized: set[tuple[str, Face]] = field(default_factory=set)
    widths: set[float] = field(default_factory=set)
    turns: dict[float, int] = field(default_factory=dict)
    centres: set[float] = field(default_factory=set)
    _symmetric: list[tuple[Station, Station]] = field(default_factory=list)
    _group: dict[Station, Station] = field(default_factory=dict)

    @staticmethod
    def of(features: Features) -> Definition:
        """Return the definition that the features require, without any dimension yet."""
        made = Definition(features)
        every: dict[Direction, Words] = {
            "along": features.along,
            "across": features.across,
            "up": features.up,
            "round": features.round,
            "turn": features.rays,
        }
        for direction, levels in every.items():
            made.needed |= {station(direction, at): words for at, words in levels.items()}
        made.needed.pop(AXIS, None)
        made.needed.pop(("turn", 0.0), None)
        made.own = {(sort, round(value, 4)): words for (sort, value), words in features.own.items()}
        made.centres = set(features.centres)
        for hole in features.holes:
            made.optional |= set(hole_stations(hole))
        for one in [*made.needed]:
            if one[0] in ("across", "up") and ("round", abs(one[1])) in made.needed:
                made.join(one, ("round", abs(one[1])))  # a plane that goes straight on from a cylinder
        return made

    def add(self, measure: Measure) -> bool:
        """Add a dimension; return whether it defines anything new instead of closing a chain."""
        span = self.span(measure)
        if measure.sort in ("width", "gap"):
            self.widths.add(round(measure.value, 4))
        if span is None:
            return self._adds_own(measure)
        is_new = measure.sort not in ("diameter", "width") and self._adds_own(measure)
        if span[0][0] == "turn":
            self.turns[round(measure.value, 4)] = measure.count
        if measure.sort == "pitch":
            return self._add_pattern(span, measure)
        if self.is_symmetric(*span):
            self._symmetric.append(span)
            fresh = not (self.joined(span[0], AXIS) and self.joined(span[1], AXIS))
            self.settle()
            return is_new or fresh
        fresh = not self.joined(*span)
        self.join(*span)
        self.settle()
        return is_new or fresh

    def _add_pattern(self, span: tuple[Station, Station], measure: Measure) -> bool:
        """Join the stations of holes at equal distances, which a pitch with a count describes."""
        direction = next(one[0] for one in span if one != AXIS)
        low = min(point[measure.form == "up"] for point in measure.points)
        run = [station(direction, low + n * measure.value) for n in range(measure.count + 1)]
        fresh = any(not self.joined(one, other) for one, other in pairwise(run))
        for one, other in pairwise(run):
            self.join(one, other)
        if self.is_symmetric(run[0], run[-1]):
            self._symmetric.append((run[0], run[-1]))
        self.settle()
        return fresh

    def _adds_own(self, measure: Measure) -> bool:
        sort = measure.sort
        if sort == "gap":
            return self._adds_wall(measure)
        if sort not in ("diameter", "radius", "angle", "chamfer", "width") or self.is_pitch_circle(measure):
            return False
        own: Own = (sort, round(measure.value, 4))
        faces = {(sort, face) for face in measure.first}
        is_new = not faces or not faces <= self.sized
        self.sized |= faces
        self.given.add(own)
        return is_new

    def _adds_wall(self, measure: Measure) -> bool:
        """Return whether a wall about an axis beside the shaft gives one diameter from another."""
        low, high = sorted(point[1] for point in measure.points)
        holes = self.features.holes
        inner, outer = (
            {
                (one.axis, round(one.diameter, 4))
                for one in holes
                if abs(one.axis[1] + one.diameter / 2 - at) < CLEAR
            }
            for at in (low, high)
        )
        for axis, diameter in inner:
            both = {("diameter", diameter), *(("diameter", d) for other, d in outer if other == axis)}
            if len(both) == 2 and len(new := both - self.given) == 1:
                self.given |= new  # type: ignore[arg-type]
                return True
        return False

    def is_pitch_circle(self, measure: Measure) -> bool:
        """Return whether a diameter is that of a circle about the shaft through the axes of holes."""
        on = (measure.sort, measure.form, measure.points[0]) == ("diameter", "circle", (0.0, 0.0))
        return on and any(dist(hole.axis, measure.points[1]) < CLEAR for hole in self.features.holes)

    def span(self, measure: Measure) -> tuple[Station, Station] | None:
        """Return the two stations that a dimension joins; None if it gives the size of a feature."""
        points = measure.points
        if measure.form == "angle":
            if measure.place != "end" or hypot(*points[0]) > CLEAR:
                return None
            one, other = (degrees(atan2(y, x)) for x, y in points[1:])
            return self._ray(one), self._ray(other)
        if measure.form in ("circle", "arc"):
            is_about = measure.place == "end" and hypot(*points[0]) < CLEAR
            radius = measure.value / (2 if measure.sort == "diameter" else 1)
            return self._ends("up", 0.0, radius) if is_about else None
        if measure.form == "across" and measure.place == "section":
            return self._ends("along", points[0][0], points[-1][0]) if measure.sort != "diameter" else None
        if measure.form == "aligned":
            return None
        along = int(measure.form == "up")
        low, high = points[0][along], points[-1][along]
        if measure.sort == "diameter":
            return self._ends("up", 0.0, high) if abs(low + high) < CLEAR else None
        return self._ends("up" if along else "across", low, high)

    def _ray(self, turn: float) -> Station:
        """Return the station of a direction, or the opposite one on its line if only that is needed."""
        here, opposite = station("turn", turn), station("turn", turn + 180)
        is_known = here in self.needed or here in self.optional
        return opposite if opposite in self.needed and not is_known else here

    def _ends(self, direction: Direction, low: float, high: float) -> tuple[Station, Station] | None:
        one, other = self.known(direction, low), self.known(direction, high)
        return (one, other) if one and other and one != other else None

    def known(self, direction: Direction, at: float) -> Station | None:
        """Return the known station at a coordinate, perhaps that of the radius of a cylinder."""
        found = [station(direction, at)]
        if direction in ("across", "up"):
            found.append(station("round", abs(at)))
        here = [one for one in found if one in self.needed or one in self.optional or one == AXIS]
        if direction == "along" and not here and any(abs(at - c) < CLEAR for c in self.centres):
            return found[0]
        for one in here[1:]:
            self.join(here[0], one)  # on one line of the drawing
        return here[0] if here else None

    def is_symmetric(self, one: Station, other: Station) -> bool:
        """Return whether two stations are symmetric about a centre line."""
        if one[0] == "turn":
            return other[0] == "turn" and self._centre_of(one[1], other[1]) is not None
        if one[0] == "along":
            middle = (one[1] + other[1]) / 2
            return any(abs(middle - centre) < CLEAR for centre in self.centres)
        return one[0] == other[0] != "round" and abs(one[1] + other[1]) < CLEAR

    def _centre_of(self, one: float, other: float) -> Station | None:
        """Return the station of the bisector of two directions, if the drawing shows that line."""
        middle = (one + other) / 2
        for turn in (0, 90, 180, 270):
            here = station("turn", middle + turn)
            if here == ("turn", 0.0) or (turn % 180 == 0 and here in self.needed):
                return here
        return None

    def settle(self) -> None:
        """Locate the members of symmetric pairs, whose distance is dimensioned, from their centre lines."""
        before = -1
        while before != len({self._root(one) for one in [*self.needed, AXIS]}):
            before = len({self._root(one) for one in [*self.needed, AXIS]})
            for one, other in self._symmetric:
                self.join(one, other)
                self.join(one, self._middle(one, other))
            self._alike_turns()

    def _middle(self, one: Station, other: Station) -> Station:
        if one[0] == "turn":
            return self._centre_of(one[1], other[1]) or one
        return station("along", (one[1] + other[1]) / 2) if one[0] == "along" else AXIS

    def _alike_turns(self) -> None:
        """Join the directions of a pattern, which one angle with a count describes, and mirrored pairs."""
        rays = [one for one in self.needed if one[0] == "turn"]
        zero: Station = ("turn", 0.0)
        for one, other in combinations(rays, 2):
            turn = abs((one[1] - other[1] + 180) % 360 - 180)
            given = [count for value, count in self.turns.items() if abs(turn - value) < 1e-3]
            if any(count > 1 for count in given):
                self.join(one, other)
            if given:
                self._about_located(one, other)
            if self.is_mirrored(one, other):
                away = min(one[1] % 90, 90 - one[1] % 90)
                twice = any(abs(away - value) < 1e-3 and count > 1 for value, count in self.turns.items())
                located = twice and (self.joined(one, zero) or self.joined(other, zero))
                if located or self.joined(one, other):
                    self.join(one, zero)
                    self.join(other, zero)

    def is_mirrored(self, one: Station, other: Station) -> bool:
        """Return whether two directions mirror each other about a centre line of the end view."""
        return station("turn", (one[1] + other[1]) / 2) == ("turn", 0.0)

    def _about_located(self, one: Station, other: Station) -> None:
        """Locate two directions if their bisector is located, as for the flanks of equal counterweights."""
        middle = one[1] + ((other[1] - one[1] + 180) % 360 - 180) / 2
        for turn in (0, 180):
            if self.joined(station("turn", middle + turn), ("turn", 0.0)):
                self.join(one, ("turn", 0.0))
                self.join(other, ("turn", 0.0))

    def join(self, one: Station, other: Station) -> None:
        """Connect two stations."""
        self._group[self._root(one)] = self._root(other)

    def joined(self, one: Station, other: Station) -> bool:
        """Return whether dimensions connect two stations."""
        return self._root(one) == self._root(other)

    def _root(self, one: Station) -> Station:
        while (next_ := self._group.get(one, one)) != one:
            one = next_
        return one

    def is_located(self, hole: Hole) -> bool:
        """Return whether the axis of a hole is located, by two coordinates or by a circle and an angle."""
        across, up, around, turn = hole_stations(hole)
        zero: Station = ("turn", 0.0)
        if self.joined(around, AXIS) and (self.joined(turn, zero) or self.is_spaced(hole)):
            return True
        return self.joined(across, AXIS) and self.joined(up, AXIS)

    def is_even(self, hole: Hole) -> bool:
        """Return whether a hole is one of at least three evenly round their circle."""
        turns = self._turns(hole)
        step = 360 / len(turns)
        return len(turns) > 2 and all(abs(turn - turns[0] - n * step) < 1e-2 for n, turn in enumerate(turns))

    def _turns(self, hole: Hole) -> list[float]:
        """Return the directions of the holes that are like one, ascending [deg]."""
        return sorted({round(one.turn, 3) % 360 for one in self.features.holes if one.is_like(hole)})

    def is_spaced(self, hole: Hole) -> bool:
        """Return whether a hole belongs to at least three that are evenly spaced on a circle.

        One of them, or the middle between two of them, must also lie on a located direction or a centre line.
        """
        if not self.is_even(hole):
            return False
        turns = self._turns(hole)
        known = any(self.joined(station("turn", turn), ("turn", 0.0)) for turn in turns)
        return known or station("turn", turns[0] + 180 / len(turns)) == ("turn", 0.0)

    def components(self, direction: Direction) -> list[list[Station]]:
        """Return the connected groups of stations of one direction, the located group first."""
        groups = defaultdict[Station, list[Station]](list)
        for one in self.needed:
            if one[0] == direction:
                groups[self._root(one)].append(one)
        origin = self._root(("turn", 0.0) if direction == "turn" else AXIS)
        ordered = sorted(groups.items(), key=lambda item: (item[0] != origin, -len(item[1]), item[1]))
        found = [sorted(stations) for _, stations in ordered]
        return found if direction == "along" or (ordered and ordered[0][0] == origin) else [[], *found]

    def has_own(self, own: Own) -> bool:
        """Return whether the size of a feature is given; the width of a slot also gives its round ends."""
        return own in self.given or (own[0] == "width" and own[1] in self.widths)

    def missing(self) -> Iterator[str]:
        """Yield a description of each size and position that no dimension gives."""
        for own, words in self.own.items():
            if not self.has_own(own):
                yield words
        directions: tuple[Direction, ...] = ("along", "across", "up", "round", "turn")
        for direction in directions:
            for group in self.components(direction)[1:]:
                yield f"position of {self.needed[group[0]]}"
        for hole in self.features.holes:
            if not self.is_located(hole):
                yield f"position of {hole.words}"


def hole_stations(hole: Hole) -> tuple[Station, Station, Station, Station]:
    """Return the stations of a hole: horizontal and vertical position, distance from the shaft, and angle."""
    x, y = hole.axis
    return (
        station("across", x), station("up", y), station("round", hypot(x, y)), station("turn", hole.turn)
    )  # fmt: skip


def nearest(groups: Sequence[Sequence[Station]], placed: Sequence[Station]) -> tuple[Station, Station] | None:
    """Return the closest pair of stations, one of them located and the other from one of the groups."""
    pairs = ((a, b) for a in placed for group in groups for b in group)
    return min(pairs, key=lambda pair: (abs(pair[0][1] - pair[1][1]), pair), default=None)
