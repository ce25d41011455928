"""The free areas of a sheet: texts must not overlap each other, views or lines."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import dist

import numpy as np

from cad.drafting.curves import Point

Rectangle = tuple[float, float, float, float]
"""Left, low, right, high [mm on paper]."""

_STRIPS = 40  # of a view, in which words keep off its lines
_APART = 0.8  # between two texts, and between a text and a line [mm on paper]
_BESIDE, _PARALLEL = 1.3, 0.06
"""A leader runs along a line that is so near [mm on paper], and leads away by so little of its length."""
_LONG = 5.0  # a piece of an outline along which a leader may run [mm on paper]
_LIKE = 3  # crossings: to run along a line is as bad


class _Rows:
    """Rows of four numbers that grow, as an array."""

    def __init__(self) -> None:
        self.rows: list[tuple[float, float, float, float]] = []
        self._array = np.zeros((0, 4))

    def add_line(self, points: Sequence[Point]) -> None:
        """Add the pieces of a line through points."""
        self.rows += [(*a, *b) for a, b in pairwise(points)]

    @property
    def array(self) -> np.ndarray:
        """Return all rows (n, 4)."""
        if len(self._array) != len(self.rows):
            self._array = np.array(self.rows)
        return self._array


class Room:
    """The areas and lines that a sheet holds so far, in millimetres on paper."""

    def __init__(self, area: Rectangle) -> None:
        self.area = area
        self.views: list[Rectangle] = []
        self.leaders: list[list[Point]] = []
        self._boxes, self._words, self._lines = _Rows(), _Rows(), _Rows()
        self._strips = _Rows()  # of views
        self._drawn = _Rows()  # lines of dimensions, leaders and frames
        self._outlines, self._long = _Rows(), _Rows()  # of views: all pieces, and the long ones

    @property
    def words(self) -> list[Rectangle]:
        """Return the rectangles of texts and symbols."""
        return self._words.rows

    @property
    def lowest(self) -> float:
        """Return the height of the lowest rectangle or line."""
        lows = (self._boxes.array[:, 1], self._lines.array[:, [1, 3]])
        return float(min(some.min(initial=self.area[3]) for some in lows))

    def add(self, box: Rectangle, *, is_view: bool = False) -> None:
        """Occupy a rectangle; lines to a part's faces cross only that of a view."""
        self._boxes.rows.append(box)
        (self.views if is_view else self.words).append(box)

    def add_view(self, box: Rectangle, lines: Iterable[Sequence[Point]]) -> None:
        """Occupy what a view covers: in strips across it, from its lowest to its highest line."""
        self.views.append(box)
        left, step = box[0], max((box[2] - box[0]) / _STRIPS, 1e-9)
        reach = [[np.inf, -np.inf] for _ in range(_STRIPS)]
        for line in lines:
            self.add_outline(line)
            for one, other in pairwise(line):
                (x, y), (u, v) = sorted((one, other))
                first, last = (min(max(int((at - left) / step), 0), _STRIPS - 1) for at in (x, u))
                for number in range(first, last + 1):
                    ends = (min(max(left + (number + n) * step, x), u) for n in (0, 1))
                    at = [y + (v - y) * (end - x) / (u - x) if u > x else y for end in ends]
                    low, high = reach[number]
                    reach[number] = [
                        min(low, *at, *([v] if u == x else [])),
                        max(high, *at, *([v] if u == x else [])),
                    ]
        strips = [
            (left + number * step, low, left + (number + 1) * step, high)
            for number, (low, high) in enumerate(reach)
            if low <= high
        ]
        self._strips.rows += strips
        self._boxes.rows += strips

    def add_line(self, points: Sequence[Point], *, is_drawn: bool = False) -> None:
        """Occupy a line through points; one that is drawn for a dimension is crossed by no leader."""
        self._lines.add_line(points)
        if is_drawn:
            self._drawn.add_line(points)

    def add_leader(self, points: Sequence[Point]) -> None:
        """Occupy a leader, from its target to its text or frame."""
        self.leaders.append([*points])
        self.add_line(points, is_drawn=True)

    def add_outline(self, points: Sequence[Point]) -> None:
        """Keep a line of a view, which words within that view avoid."""
        self._outlines.add_line(points)
        for one, other in pairwise(points):
            if dist(one, other) > _LONG:
                self._long.add_line([one, other])

    def is_in_view(self, point: Point) -> bool:
        """Return whether a point lies between the lowest and the highest line of a view."""
        return bool(_overlaps(np.array([(*point, *point)]), self._strips.array, 0.0).any())

    def is_free_within(self, box: Rectangle) -> bool:
        """Return whether a rectangle within a view is clear of its lines, of words and of other lines."""
        one = np.array([box])
        if not self.holds(box) or _overlaps(one, self._words.array, _APART).any():
            return False
        return not (crossed(self._outlines.array, box, _APART).any() or self._is_crossed(one).any())

    def holds(self, box: Rectangle) -> bool:
        """Return whether a rectangle is within the area of the sheet."""
        left, low, right, high = self.area
        return box[0] >= left and box[1] >= low and box[2] <= right and box[3] <= high

    def is_clear(self, box: Rectangle, apart: float = _APART) -> bool:
        """Return whether a rectangle is on the area and clear of all others."""
        return self.holds(box) and not _overlaps(np.array([box]), self._boxes.array, apart).any()

    def is_free(self, box: Rectangle) -> bool:
        """Return whether a rectangle is on the area and clear of all others and of all lines."""
        return bool(self.free(np.array([box]))[0])

    def free(self, boxes: np.ndarray) -> np.ndarray:
        """Return which rectangles (n, 4) are on the area and clear of all others and of all lines."""
        left, low, right, high = self.area
        within = (boxes[:, :2] >= (left, low)).all(axis=1) & (boxes[:, 2:] <= (right, high)).all(axis=1)
        free = np.zeros(len(boxes), dtype=bool)
        places = np.flatnonzero(within)
        places = places[~_overlaps(boxes[places], self._boxes.array, _APART).any(axis=1)]
        free[places[~self._is_crossed(boxes[places])]] = True
        return free

    def passes(self, line: Sequence[Point]) -> bool:
        """Return whether a line through points crosses no words."""
        words = self._words.array
        return not any(crossed(piece, words).any() for piece in _pieces(line))

    def is_apart(self, line: Sequence[Point], about: Point | None = None) -> bool:
        """Return whether a line meets no dimension, and no view but that of what it is about, its start."""
        if any(_meet(piece, self._drawn.array).any() for piece in _pieces(line)):
            return False
        return self.is_at_home(line, about or line[0])

    def is_at_home(self, line: Sequence[Point], about: Point) -> bool:
        """Return whether a line crosses no view but that of the point that it is about."""
        foreign = [box for box in self.views if not _is_in(about, box)]
        return not any(crossed(_pieces(line), box).any() for box in foreign)

    def lines_met(self, one: Point, other: Point) -> int:
        """Return how many outlines, extension lines and centre lines a straight line crosses.

        One that it runs along counts as several.
        """
        piece = np.array([*one, *other])
        met = sum(int(_meet(piece, some.array).sum()) for some in (self._outlines, self._lines))
        return met + _LIKE * any(_along(piece, some.array).any() for some in (self._long, self._lines))

    def first(self, boxes: Iterable[tuple[Rectangle, Point]]) -> Point | None:
        """Occupy the first free rectangle, and return its point."""
        for box, point in boxes:
            if self.is_free(box):
                self.add(box)
                return point
        return None

    def is_crossed(self, box: Rectangle) -> bool:
        """Return whether a line crosses a rectangle or comes near it."""
        return bool(self._is_crossed(np.array([box]))[0])

    def _is_crossed(self, boxes: np.ndarray) -> np.ndarray:
        """Return which rectangles a line crosses."""
        lines = self._lines.array[:, np.newaxis, :]
        result: np.ndarray = np.asarray(crossed(lines, boxes, _APART).any(axis=0))
        return result


def _pieces(line: Sequence[Point]) -> np.ndarray:
    """Return the straight pieces of a line (n, 4)."""
    return np.array([(*a, *b) for a, b in pairwise(line)])


def _is_in(point: Point, box: Rectangle) -> bool:
    """Return whether a point is in a rectangle or at its border."""
    return box[0] - _APART <= point[0] <= box[2] + _APART and box[1] - _APART <= point[1] <= box[3] + _APART


def _meet(piece: np.ndarray, lines: np.ndarray) -> np.ndarray:
    """Return which segments (n, 4) a segment crosses, apart from crossings at its own ends."""
    (x, y), away = piece[:2], piece[2:] - piece[:2]
    starts, ways = lines[:, :2] - (x, y), lines[:, 2:] - lines[:, :2]
    across = away[0] * ways[:, 1] - away[1] * ways[:, 0]
    across = np.where(np.abs(across) < 1e-12, 1e-12, across)
    own = (starts[:, 0] * ways[:, 1] - starts[:, 1] * ways[:, 0]) / across
    other = (starts[:, 0] * away[1] - starts[:, 1] * away[0]) / across
    result: np.ndarray = (own > 0.01) & (own < 0.99) & (other > 0.0) & (other < 1.0)
    return result


def _along(piece: np.ndarray, lines: np.ndarray) -> np.ndarray:
    """Return which segments (n, 4) a segment runs along: nearly parallel, and beside it for over 1 mm."""
    away = piece[2:] - piece[:2]
    size = max(float(np.hypot(*away)), 1e-12)
    way = away / size
    ends = (lines.reshape(-1, 2, 2) - piece[:2]) @ np.stack([way, (-way[1], way[0])], axis=1)
    along, off = ends[..., 0], ends[..., 1]
    shared = np.minimum(along.max(axis=1), size) - np.maximum(along.min(axis=1), 0.0)
    rise = np.abs(off[:, 1] - off[:, 0]) < _PARALLEL * np.abs(along[:, 1] - along[:, 0])
    result: np.ndarray = rise & (np.abs(off).min(axis=1) < _BESIDE) & (shared > 1.0)
    return result


def overlap(one: Rectangle, other: Rectangle, apart: float = 0.0) -> bool:
    """Return whether two rectangles overlap, or are closer than this distance."""
    return bool(_overlaps(np.array([one]), np.array([other]), apart)[0, 0])


def _overlaps(some: np.ndarray, others: np.ndarray, apart: float) -> np.ndarray:
    """Return which rectangles (n, 4) overlap which others (m, 4), or are closer to them than this."""
    one, other = some[:, np.newaxis, :], others[np.newaxis, :, :]
    is_beside = (one[..., :2] >= other[..., 2:] + apart) | (other[..., :2] >= one[..., 2:] + apart)
    result: np.ndarray = np.asarray(~is_beside.any(axis=2))
    return result


def crossed(lines: np.ndarray, boxes: Rectangle | np.ndarray, apart: float = 0.0) -> np.ndarray:
    """Return which straight pieces (…, 4) are closer to rectangles (…, 4) than this (Liang and Barsky)."""
    boxes = np.asarray(boxes)
    start, away = lines[..., :2], lines[..., 2:] - lines[..., :2]
    away = np.where(np.abs(away) < 1e-12, 1e-12, away)
    low, high = (boxes[..., :2] - apart - start) / away, (boxes[..., 2:] + apart - start) / away
    enter, leave = np.minimum(low, high).max(axis=-1), np.maximum(low, high).min(axis=-1)
    meets: np.ndarray = np.maximum(enter, 0.0) <= np.minimum(leave, 1.0)
    return meets


def around(centre: Point, width: float, height: float) -> Rectangle:
    """Return the rectangle with a given centre, width and height."""
    x, y = centre
    return x - width / 2, y - height / 2, x + width / 2, y + height / 2
