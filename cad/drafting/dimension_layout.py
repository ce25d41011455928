"""The layout of dimensions and their texts: no texts overlap, and none lies across a view.

Dimensions beside a view are arranged in lanes; each takes the first lane with room. The texts of arcs,
oblique holes and angles stand at the nearest free place outside the views, with a leader.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice, product
from math import atan2, cos, dist, hypot, pi, radians, sin

import numpy as np

from cad.drafting.curves import Point
from cad.drafting.formats import FORMATS
from cad.drafting.labels import TEXT, Label, label_of
from cad.drafting.lanes import Lane
from cad.drafting.parameter_match import Dimension
from cad.drafting.plan import LANE, Plan
from cad.drafting.room import Rectangle, Room, around, crossed, overlap
from cad.drafting.symbols import Symbol, datum

GAP = 0.9  # between a dimension line and its words [mm on paper]
EXTENSION = 1.5  # of an extension line beyond its dimension line [mm on paper]
ASIDE = 4.0  # from an oblique size to its dimension line [mm on paper]
CROSSING = 12.0  # length that a leader may add in order to cross one line less [mm on paper]

_ARROWS = 7.0  # shortest dimension line with its arrows within [mm on paper]
_NARROW = radians(15)  # angle whose words stand beside it
_TAIL = 6.5  # of a line with its arrows outside [mm on paper]
_BEYOND = (1.5, 4.5, 7.5, 10.5, 13.5, 16.5, 19.5, 22.5, 25.5, 28.5)
"""From an end of a line to a text beyond it [mm on paper]."""

_CENTRED = 1e-6  # of a text in the middle of its line [mm on paper]
_OFF_LINES = 0.6  # from a text to the extension line of another dimension [mm on paper]
_BELOW = 0.6  # of the line under the words of a leader, which other lines keep off [mm on paper]
_FIRST = 10.0  # from the view to its first dimension line [mm on paper]
_MOST_LANES = 40
_MORE_LANES = 5  # that are looked at for words that no line crosses
_STEMS = range(2, 40, 3)  # lengths of a datum's stem that are tried [mm on paper]
_MOST_ALIKE = 8  # other arcs that are tried
_AT_ONCE = 120  # places whose room is looked up at once
_LOOKS = 4  # so often places are looked up from the first clear one on
_NEAREST, _FARTHEST, _STEP = 5.0, 150.0, 3.0  # from what is measured to its words [mm on A3]


@dataclass(frozen=True)
class DatumPlace:
    """A datum's triangle with its stem, and the square of its letter, on the paper."""

    box: Rectangle
    symbol: Symbol
    stem: tuple[Point, Point]

    @staticmethod
    def at(tip: Point, turn: float, reach: float) -> DatumPlace:
        """Return the datum whose triangle stands on a point, with a stem away at an angle [rad]."""
        symbol, end = datum(tip, turn, reach)
        middle = end[0] + TEXT * cos(turn), end[1] + TEXT * sin(turn)
        foot = tip[0] + cos(turn), tip[1] + sin(turn)
        return DatumPlace(around(middle, 2 * TEXT, 2 * TEXT), symbol, (foot, end))

    def take(self, room: Room) -> None:
        """Occupy the place of the letter, the stem and the triangle."""
        room.add(self.box)
        room.add_line(self.stem, is_drawn=True)
        for corners in self.symbol.filled:
            room.add_line([*corners, corners[0]], is_drawn=True)


@dataclass(frozen=True)
class PlacedDimension:
    """A dimension with its place, in the drawing's coordinates.

    Attributes
    ----------
    base
        A point on its dimension line; for an arc or circle, the end of its leader.
    words
        The centre of its text, if the text does not stand on the dimension line.
    right
        The distance by which its view is moved to the right.
    ends
        The ends of its dimension line on the paper [mm], if it stands in a lane.
    datum
        The place of its datum symbol, if its feature is a datum and it stands in a lane.
    leader
        The tip, the bend and the end of the leader of an arc or circle, on the paper [mm].
    """

    dimension: Dimension
    label: Label
    base: Point
    words: Point | None
    right: float
    ends: tuple[Point, Point] | None = None
    leader: tuple[Point, Point, Point] | None = None
    datum: DatumPlace | None = None


@dataclass(frozen=True)
class LanePlace:
    """The place of a dimension in a lane: its line's level, its words' middle, and what crosses the words."""

    number: int
    level: float
    middle: float
    crossings: int
    box: Rectangle
    stem: DatumPlace | None


Try = tuple[Rectangle, PlacedDimension, list[list[Point]]]
"""A place of words, the dimension with it, and the lines that it draws on the paper."""


class NoRoom(Exception):
    """The sheet has no free place at this scale."""


class DimensionLayout:
    """Finds a place for each dimension of a plan; `faults` counts those that have no free one.

    `datums` are the parameters whose features are datums: their dimension lines have room for the letter.
    """

    def __init__(self, plan: Plan, room: Room, datums: Collection[str]) -> None:
        self.plan, self.room, self.datums, self.faults = plan, room, datums, 0

    def all(self) -> list[PlacedDimension]:
        """Return every dimension with its place, those in lanes first."""
        placed = [one for lane in self.plan.lanes.sides() for one in self.lane(lane)]
        return placed + self.local(self.plan.lanes.local)

    def local(self, dimensions: Iterable[Dimension]) -> list[PlacedDimension]:
        """Return dimensions of arcs, oblique holes and angles, which have no lanes; angles last."""
        ordered = sorted(dimensions, key=lambda one: one.measure.form == "angle")
        return [self._local(one) for one in ordered]

    def lane(self, lane: Lane) -> list[PlacedDimension]:
        """Return the dimensions on one side of a view with their places."""
        placed = list(self._in_lanes(lane))
        for one in placed:
            self._take_lines(one)
        return placed

    def within(self, one: Dimension, along: float, high: float) -> PlacedDimension:
        """Return a vertical dimension whose line runs within a view, with its text above the view.

        Parameters
        ----------
        one
            The dimension.
        along
            The horizontal position of its line [mm].
        high
            The height of the upper side of the view [mm].
        """
        label = label_of(one)
        points = tuple((along, y) for _, y in one.measure.points)
        moved = replace(one, measure=replace(one.measure, points=points))
        ends = sorted(y for _, y in self._on_paper(moved, 0.0))
        half = label.width(TEXT) / 2
        place, top = self.plan.paper((along, high))
        middle = top + 2.5 + half
        self.room.add((place - GAP - label.height(TEXT) - 0.5, middle - half, place + 0.5, middle + half))
        return self._laned(moved, 1, place, (ends[0], ends[1]), middle, 0.0)

    def _in_lanes(self, lane: Lane) -> Iterator[PlacedDimension]:
        right = self.plan.beside if lane.is_of_end else 0.0
        points = ([p[lane.along] for p in self._on_paper(one, right)] for one in lane.dimensions)
        ends = [(min(some), max(some)) for some in points]
        reached = [_MOST_LANES] * len(ends)  # the lanes up to which extension lines lead; at first all
        for n, (one, span) in enumerate(zip(lane.dimensions, ends, strict=True)):

            def others(number: int) -> list[float]:
                pairs = (pair for pair, reach in zip(ends, reached, strict=True) if reach >= number)
                return [end for pair in pairs for end in pair]

            every = (
                self._lane_place(one, lane, number, span, others(number)) for number in range(_MOST_LANES)
            )
            chosen = _least_crossed(each for each in every if each)
            if chosen is None:
                self.faults += 1
                chosen = self._lane_place(one, lane, _MOST_LANES, span, [], is_forced=True)
            assert chosen
            reached[n] = chosen.number
            self.room.add(chosen.box)
            laned = self._laned(one, lane.along, chosen.level, span, chosen.middle, right)
            yield self._with_datum(laned, chosen.stem) if chosen.stem else laned

    def _lane_place(
        self,
        one: Dimension,
        lane: Lane,
        number: int,
        span: tuple[float, float],
        others: Sequence[float],
        *,
        is_forced: bool = False,
    ) -> LanePlace | None:
        """Return the place of a dimension in a lane if it is clear, or forced."""
        right, label = self.plan.beside if lane.is_of_end else 0.0, label_of(one)
        away = lane.edge + lane.out * (_FIRST + LANE * number) / self.plan.scale
        level = self.plan.paper((away, away), right)[1 - lane.along]
        crossings, middle = self._middle(label, lane.along, level, span, others)
        box = self._box_in_lane(label, lane.along, level, span, middle)
        stem = self._stem(lane, level, span, box, others) if one.name in self.datums else None
        is_clear = self.room.is_clear(box, 0.1) and (stem or one.name not in self.datums)
        return LanePlace(number, level, middle, crossings, box, stem) if is_clear or is_forced else None

    def _middle(
        self, label: Label, along: int, place: float, ends: tuple[float, float], others: Sequence[float]
    ) -> tuple[int, float]:
        """Return how many lines cross a text on its dimension line, and its centre along that line.

        The centre is between the ends, or beyond one end: the nearest place at which the fewest lines cross
        the text. These are extension lines of the same side, at `others`, and lines that the sheet holds.
        """
        (low, high), width = ends, label.width(TEXT)
        half, tries = width / 2, list[float]()
        if width + 2 * _OFF_LINES <= high - low:
            middle, spare = (low + high) / 2, (high - low - width) / 2 - _OFF_LINES
            tries = [middle + share * spare for share in (0.0, 0.5, -0.5, 1.0, -1.0)]
        tries += [at for beyond in _BEYOND for at in (high + beyond + half, low - beyond - half)]
        reach, top = half + _OFF_LINES - _CENTRED, GAP + label.height(TEXT)

        def crossings(at: float) -> int:
            sides = (place - top, place - GAP) if along else (place + GAP, place + top)
            (x, u), (y, v) = (sides, (at - half, at + half))[:: 1 if along else -1]
            return _crossings(at - reach, at + reach, others) + self.room.is_crossed((x, y, u, v))

        return min((crossings(at), number, at) for number, at in enumerate(tries))[::2]

    def _stem(
        self, lane: Lane, place: float, ends: tuple[float, float], own: Rectangle, others: Sequence[float]
    ) -> DatumPlace | None:
        """Return a free place for a datum in line with a dimension line, between other extension lines."""
        along = lane.along
        starts = (ends[1], pi / 2 * along), (ends[0], pi / 2 * along + pi)
        for reach, (end, turn) in product(_STEMS, starts):
            one = DatumPlace.at((place, end) if along else (end, place), turn, reach)
            if overlap(one.box, own) or _crossings(one.box[along], one.box[along + 2], others):
                continue
            if self.room.is_free(one.box) and self.room.passes(one.stem):
                return one
        return None

    def _with_datum(self, placed: PlacedDimension, datum: DatumPlace) -> PlacedDimension:
        datum.take(self.room)
        return replace(placed, datum=datum)

    def _on_paper(self, one: Dimension, right: float) -> list[Point]:
        return [self.plan.paper(point, right) for point in one.measure.points]

    def _laned(
        self,
        one: Dimension,
        along: int,
        place: float,
        ends: tuple[float, float],
        middle: float,
        right: float,
    ) -> PlacedDimension:
        """Return a dimension with its line at a given position in its lane."""
        label = label_of(one)
        line = tuple((place, end) if along else (end, place) for end in ends)
        words = None
        if label.upper or abs(middle - (ends[0] + ends[1]) / 2) > _CENTRED:
            above = GAP + label.height(TEXT) / 2
            words = self.plan.at(*((place - above, middle) if along else (middle, place + above)))
        return PlacedDimension(one, label, self.plan.at(*line[0]), words, right, (line[0], line[1]))

    def _box_in_lane(
        self, label: Label, along: int, place: float, ends: tuple[float, float], middle: float
    ) -> Rectangle:
        """Return the area that a dimension line and its text occupy on the paper."""
        half = label.width(TEXT) / 2 + 0.5
        is_narrow = ends[1] - ends[0] < _ARROWS
        tail = _TAIL if is_narrow else 0.0
        begin, stop = min(ends[0] - tail, middle - half), max(ends[1] + tail, middle + half)
        height = GAP + label.height(TEXT) + 0.8
        if along:
            return place - height, begin, place + 1.0, stop
        return begin, place - 1.0, stop, place + height

    def _take_lines(self, placed: PlacedDimension) -> None:
        """Occupy the dimension line and extension lines, so that no later text crosses them."""
        assert placed.ends is not None
        self.room.add_line(placed.ends, is_drawn=True)
        points = sorted(self._on_paper(placed.dimension, placed.right))
        for end in placed.ends:
            along = 1 if placed.ends[0][0] == placed.ends[1][0] else 0
            nearest = min(points, key=lambda point: abs(point[along] - end[along]))
            self.room.add_line([nearest, end])

    def _local(self, one: Dimension) -> PlacedDimension:
        right = self.plan.beside if one.measure.place == "end" else 0.0
        label = label_of(one)
        match one.measure.form:
            case "circle" | "arc":
                tries = self._beyond_arc(one, label, right)
            case "angle":
                tries = self._across_angle(one, label, right)
            case _:
                tries = self._around(one, label, right)
        box, placed, lines = self._chosen(iter(tries), one, right)
        self.room.add(box)
        for line in lines:
            self.room.add_line(line, is_drawn=True)
        return placed

    def _chosen(self, tries: Iterator[Try], one: Dimension, right: float) -> Try:
        """Return the first clear place, or one soon after it whose leader is shorter or crosses less."""
        is_within = one.measure.form == "angle"
        about = self._on_paper(one, right)[-1] if is_within else None
        first, found, looks = None, list[tuple[float, int, Try]](), 0
        while looks < _LOOKS and (some := [*islice(tries, _AT_ONCE)]):
            first = first or some[0]
            for each in self._free(some, is_within=is_within):
                if self._is_clear(each, about):
                    if is_within:
                        return each
                    found.append((self._cost(each[2][0]), len(found), each))
            looks += bool(found)
        self.faults += not found
        assert first is not None, "there are places on every sheet"
        return min(found)[2] if found else first

    def _cost(self, leader: Sequence[Point]) -> float:
        """Return the length of a leader, where each line that it crosses counts as some more length."""
        return dist(*leader) + CROSSING * self.room.lines_met(*leader)

    def _free(self, some: Sequence[Try], *, is_within: bool) -> Iterator[Try]:
        """Yield the places whose words have room, perhaps also within a view."""
        free = self.room.free(np.array([box for box, _, _ in some]))
        return (
            each
            for each, is_free in zip(some, free, strict=True)
            if is_free or (is_within and self.room.is_free_within(each[0]))
        )

    def _is_clear(self, each: Try, about: Point | None) -> bool:
        """Return whether the first line crosses neither words nor dimensions, and none a foreign view."""
        _, _, (first, *others) = each
        if not self.room.passes(first) or not self.room.is_apart(first, about):
            return False
        return all(self.room.is_at_home(line, about or first[0]) for line in others)

    def _beyond_arc(self, one: Dimension, label: Label, right: float) -> Iterator[Try]:
        """Yield the words at the end of a leader along a radius, of any arc that shows the parameter.

        The leader comes from outside or, of an arc that is not a whole circle, across its centre.
        """
        whole = one.measure.form == "circle"
        turns = sorted(range(-180, 180, 15), key=abs) if whole else (0, 10, -10, 20, -20)
        width, height = label.width(TEXT) + 1.0, label.height(TEXT)
        arcs = [replace(one, measure=measure) for measure in (one.measure, *one.alike[:_MOST_ALIKE])]
        for away in self._distances():
            for arc in arcs:
                centre, on = self._on_paper(arc, right)
                radius = hypot(on[0] - centre[0], on[1] - centre[1])
                angle = atan2(on[1] - centre[1], on[0] - centre[0])
                for turn, side in product(turns, (1,) if whole else (1, -1)):
                    u, v = cos(angle + radians(turn)), sin(angle + radians(turn))
                    reach = radius + away if side > 0 else -away
                    x, y = centre[0] + reach * u, centre[1] + reach * v
                    tip = centre[0] + radius * u, centre[1] + radius * v
                    left = x - width if x < tip[0] else x
                    low = y + GAP + TEXT / 2 - height / 2
                    box = left - 0.5, min(low, y - _BELOW), left + width + 0.5, low + height
                    end = left if x < tip[0] else left + width, y
                    words = self.plan.at(left + width / 2, y + GAP + TEXT / 2)
                    placed = PlacedDimension(
                        arc, label, self.plan.at(x, y), words, right, None, (tip, (x, y), end)
                    )
                    yield box, placed, [[tip, (x, y)], [(x, y), end]]

    def _across_angle(self, one: Dimension, label: Label, right: float) -> Iterator[Try]:
        """Yield places for the text outside a dimension arc between two legs or their extensions."""
        yield from self._beside_angle(one, label, right)
        corner, *legs = self._on_paper(one, right)
        turns = [atan2(y - corner[1], x - corner[0]) for x, y in legs]
        opening = (turns[1] - turns[0]) % (2 * pi)
        if opening > pi:
            turns, opening = turns[::-1], 2 * pi - opening
        middle = turns[0] + opening / 2
        shortest = min(hypot(x - corner[0], y - corner[1]) for x, y in legs)
        size = max(label.width(TEXT), 2 * TEXT)
        start = max(0.5 * shortest, 8.0)
        for away in self._distances():
            radius = start + away
            beyond = radius + GAP + TEXT / 2
            words = corner[0] + beyond * cos(middle), corner[1] + beyond * sin(middle)
            base = corner[0] + radius * cos(middle), corner[1] + radius * sin(middle)
            height = abs(size * cos(middle)) + abs(TEXT * sin(middle)) + 2 * EXTENSION
            width = abs(size * sin(middle)) + abs(TEXT * cos(middle)) + 2 * EXTENSION
            steps = [turns[0] + opening * (i / 24 * 1.2 - 0.1) for i in range(25)]
            arc = [(corner[0] + radius * cos(t), corner[1] + radius * sin(t)) for t in steps]
            lines = [arc, [legs[0], arc[2]], [legs[0], arc[-3]], [legs[1], arc[2]], [legs[1], arc[-3]]]
            placed = PlacedDimension(one, label, self.plan.at(*base), None, right)
            yield around(words, width, height), placed, lines[:1] + _nearest(lines[1:])

    def _beside_angle(self, one: Dimension, label: Label, right: float) -> Iterator[Try]:
        """Yield the words above the dimension arc of a narrow angle, which is extended beyond one leg."""
        corner, *legs = self._on_paper(one, right)
        low, high = sorted(atan2(y - corner[1], x - corner[0]) for x, y in legs)
        middle = dist(corner, legs[0])
        if high - low > _NARROW:
            return
        width, above = label.width(TEXT), GAP + label.height(TEXT) / 2
        for away in self._distances():
            for radius in (middle + away - _NEAREST, middle - away):
                tail, end = _TAIL / radius, (_TAIL + width) / radius
                base = self.plan.at(*_polar(corner, radius, (low + high) / 2))
                for start, stop in ((low - tail, high + end), (low - end, high + tail)):
                    arc = [_polar(corner, radius, start + (stop - start) * i / 24) for i in range(25)]
                    far = (_TAIL + width / 2) / radius
                    turn = high + far if stop > high + tail else low - far
                    words = _polar(corner, radius + (above if sin(turn) > 0 else -above), turn)
                    placed = PlacedDimension(one, label, base, self.plan.at(*words), right)
                    yield _turned(words, width, label.height(TEXT), turn), placed, [arc]

    def _distances(self) -> Iterator[float]:
        """Yield distances from a feature to its text [mm on paper], more of them on a larger sheet."""
        away, farthest = _NEAREST, _FARTHEST * self.plan.format.width / FORMATS[0].width
        while away < farthest:
            yield away
            away += _STEP

    def _around(self, one: Dimension, label: Label, right: float) -> Iterator[Try]:
        """Yield places for the text all around an oblique dimension, clear of its own line."""
        (x, y), (u, v) = sorted(self._on_paper(one, right))
        size = dist((x, y), (u, v)) or 1.0
        way = (u - x) / size, (v - y) / size
        middle = (x + u) / 2 + ASIDE * way[1], (y + v) / 2 - ASIDE * way[0]
        half = size / 2 + _TAIL
        ends = [c + side * half * w for side in (-1, 1) for c, w in zip(middle, way, strict=True)]
        own = np.array([ends, [x, y, u, v]])
        width, height = label.width(TEXT), label.height(TEXT)
        for away in self._distances():
            for turn in range(90, 450, 15):
                x = middle[0] + (away + width / 2) * cos(radians(turn))
                y = middle[1] + (away + height / 2) * sin(radians(turn))
                box = around((x, y), width + 1.0, height + 1.0)
                if not crossed(own, box, GAP).any():
                    placed = PlacedDimension(one, label, self.plan.at(*middle), self.plan.at(x, y), right)
                    yield box, placed, [[middle, (x, y)]]


def _least_crossed(places: Iterable[LanePlace]) -> LanePlace | None:
    """Return the first place whose words no line crosses, or of the first few that with the fewest lines."""
    best: LanePlace | None = None
    for place in islice(places, _MORE_LANES):
        if best is None or place.crossings < best.crossings:
            best = place
        if best.crossings == 0:
            break
    return best


def _polar(corner: Point, radius: float, turn: float) -> Point:
    return corner[0] + radius * cos(turn), corner[1] + radius * sin(turn)


def _turned(centre: Point, width: float, height: float, turn: float) -> Rectangle:
    """Return the rectangle about words that stand on an arc, in a direction from its centre [rad]."""
    level, upright = abs(sin(turn)), abs(cos(turn))
    return around(centre, width * level + height * upright, width * upright + height * level)


def _crossings(low: float, high: float, others: Sequence[float]) -> int:
    """Return how many extension lines are within a range."""
    return sum(low < end < high for end in others)


def _nearest(lines: list[list[Point]]) -> list[list[Point]]:
    """Return the two shortest of four lines: an extension line from each leg to the nearer end of the arc."""
    return sorted(lines, key=lambda line: hypot(line[0][0] - line[1][0], line[0][1] - line[1][1]))[:2]
