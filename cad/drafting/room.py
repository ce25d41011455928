"""The free areas of a sheet: texts must not overlap each other, views or lines."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import hypot

import numpy as np

from cad.drafting.curves import Point

Rectangle = tuple[float, float, float, float]
"""Left, low, right, high [mm on paper]."""

_APART = 0.8  # between two texts, and between a text and a line [mm on paper]


class Room:
    """The areas and lines that a sheet holds so far, in millimetres on paper."""

    def __init__(self, area: Rectangle) -> None:
        self.area = area
        self.boxes: list[Rectangle] = []
        self.words: list[Rectangle] = []
        self.views: list[Rectangle] = []
        self.leaders: list[list[Point]] = []
        self._lines: list[tuple[float, float, float, float]] = []
        self._array = np.zeros((0, 4))
        self._drawn: list[tuple[float, float, float, float]] = []  # of dimensions, leaders and frames
        self._meeting = np.zeros((0, 4))
        self._outlines: list[tuple[float, float, float, float]] = []
        self._edges = np.zeros((0, 4))

    def add(self, box: Rectangle, *, is_view: bool = False) -> None:
        """Occupy a rectangle; a leader may cross it only if it is a view."""
        self.boxes.append(box)
        (self.views if is_view else self.words).append(box)

    def add_line(self, points: Sequence[Point], *, is_drawn: bool = False) -> None:
        """Occupy a polyline; no leader crosses one that is drawn for a dimension."""
        self._lines += [(*a, *b) for a, b in pairwise(points)]
        if is_drawn:
            self._drawn += [(*a, *b) for a, b in pairwise(points)]

    def add_leader(self, points: Sequence[Point]) -> None:
        """Occupy a leader, from its target to its text or frame."""
        self.leaders.append([*points])
        self.add_line(points, is_drawn=True)

    def add_outline(self, points: Sequence[Point]) -> None:
        """Record a line of a view, which texts within that view avoid."""
        self._outlines += [(*a, *b) for a, b in pairwise(points)]

    def is_free_within(self, box: Rectangle) -> bool:
        """Return whether a rectangle within a view is clear of its lines, of texts and of other lines."""
        if not self.holds(box) or any(overlap(box, other, _APART) for other in self.words):
            return False
        if len(self._edges) != len(self._outlines):
            self._edges = np.array(self._outlines)
        is_blank = not len(self._edges) or not crossed(self._edges, box, _APART).any()
        return is_blank and not self._is_crossed(box)

    def holds(self, box: Rectangle) -> bool:
        """Return whether a rectangle is within the area of the sheet."""
        left, low, right, high = self.area
        return box[0] >= left and box[1] >= low and box[2] <= right and box[3] <= high

    def is_clear(self, box: Rectangle, apart: float = _APART) -> bool:
        """Return whether a rectangle is within the area and clear of all occupied ones."""
        return self.holds(box) and not any(overlap(box, other, apart) for other in self.boxes)

    def is_free(self, box: Rectangle) -> bool:
        """Return whether a rectangle is within the area and clear of all occupied rectangles and lines."""
        return self.is_clear(box) and not self._is_crossed(box)

    def passes(self, line: Sequence[Point]) -> bool:
        """Return whether a straight line crosses no text."""
        piece = np.array([[*line[0], *line[-1]]])
        return not any(crossed(piece, box).any() for box in self.words)

    def is_apart(self, line: Sequence[Point], about: Point | None = None) -> bool:
        """Return whether a line crosses no drawn dimension, and no view other than that of its target.

        The target is the start of the line unless it is given.
        """
        pieces = np.array([(*a, *b) for a, b in pairwise(line)])
        if len(self._drawn) != len(self._meeting):
            self._meeting = np.array(self._drawn)
        if len(self._meeting) and any(_meet(piece, self._meeting).any() for piece in pieces):
            return False
        return self.is_at_home(line, about or line[0])

    def is_at_home(self, line: Sequence[Point], about: Point) -> bool:
        """Return whether a line crosses no view other than that of its target."""
        pieces = np.array([(*a, *b) for a, b in pairwise(line)])
        foreign = [box for box in self.views if not _is_in(about, box)]
        return not any(crossed(pieces, box).any() for box in foreign)

    def length_in_views(self, one: Point, other: Point) -> float:
        """Return the length of a straight line within the bounding boxes of views [mm on paper]."""
        return sum(_length_within(one, other, box) for box in self.views)

    def first(self, boxes: Iterable[tuple[Rectangle, Point]]) -> Point | None:
        """Occupy the first free rectangle, and return its point."""
        for box, point in boxes:
            if self.is_free(box):
                self.add(box)
                return point
        return None

    def _is_crossed(self, box: Rectangle) -> bool:
        if len(self._array) != len(self._lines):
            self._array = np.array(self._lines)
        return bool(len(self._array) and crossed(self._array, box, _APART).any())


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


def _length_within(one: Point, other: Point, box: Rectangle) -> float:
    """Return the length of a segment within a rectangle (Liang and Barsky)."""
    enter, leave = 0.0, 1.0
    for axis in (0, 1):
        away = other[axis] - one[axis]
        if abs(away) < 1e-12:
            if not box[axis] <= one[axis] <= box[axis + 2]:
                return 0.0
            continue
        low, high = sorted(((box[axis] - one[axis]) / away, (box[axis + 2] - one[axis]) / away))
        enter, leave = max(enter, low), min(leave, high)
    return max(leave - enter, 0.0) * hypot(other[0] - one[0], other[1] - one[1])


def overlap(one: Rectangle, other: Rectangle, apart: float = 0.0) -> bool:
    """Return whether two rectangles overlap, or are closer than a given distance."""
    is_beside = one[0] >= other[2] + apart or other[0] >= one[2] + apart
    return not (is_beside or one[1] >= other[3] + apart or other[1] >= one[3] + apart)


def crossed(lines: np.ndarray, box: Rectangle, apart: float = 0.0) -> np.ndarray:
    """Return which segments (n, 4) are closer to a rectangle than a given distance (Liang and Barsky)."""
    start, away = lines[:, :2], lines[:, 2:] - lines[:, :2]
    away = np.where(np.abs(away) < 1e-12, 1e-12, away)
    low = (np.array([box[0] - apart, box[1] - apart]) - start) / away
    high = (np.array([box[2] + apart, box[3] + apart]) - start) / away
    enter = np.minimum(low, high).max(axis=1)
    leave = np.maximum(low, high).min(axis=1)
    meets: np.ndarray = np.maximum(enter, 0.0) <= np.minimum(leave, 1.0)
    return meets


def around(centre: Point, width: float, height: float) -> Rectangle:
    """Return the rectangle with a given centre, width and height."""
    x, y = centre
    return x - width / 2, y - height / 2, x + width / 2, y + height / 2
