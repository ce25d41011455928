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
    """What a sheet holds so far, in millimetres on paper."""

    def __init__(self, area: Rectangle) -> None:
        self.area = area
        self.boxes: list[Rectangle] = []
        self.words: list[Rectangle] = []
        self.views: list[Rectangle] = []
        self._lines: list[tuple[float, float, float, float]] = []
        self._array = np.zeros((0, 4))

    def add(self, box: Rectangle, *, is_view: bool = False) -> None:
        """Occupy a rectangle; lines to a part's faces cross only that of a view."""
        self.boxes.append(box)
        (self.views if is_view else self.words).append(box)

    def add_line(self, points: Sequence[Point]) -> None:
        """Occupy a line through points."""
        self._lines += [(*a, *b) for a, b in pairwise(points)]

    def holds(self, box: Rectangle) -> bool:
        """Return whether a rectangle is on the sheet's area."""
        left, low, right, high = self.area
        return box[0] >= left and box[1] >= low and box[2] <= right and box[3] <= high

    def is_clear(self, box: Rectangle, apart: float = _APART) -> bool:
        """Return whether a rectangle is on the area and clear of all others."""
        return self.holds(box) and not any(overlap(box, other, apart) for other in self.boxes)

    def is_free(self, box: Rectangle) -> bool:
        """Return whether a rectangle is on the area and clear of all others and of all lines."""
        return self.is_clear(box) and not self._is_crossed(box)

    def passes(self, line: Sequence[Point]) -> bool:
        """Return whether a straight line crosses no words."""
        piece = np.array([[*line[0], *line[-1]]])
        return not any(crossed(piece, box).any() for box in self.words)

    def length_in_views(self, one: Point, other: Point) -> float:
        """Return the length of a straight line within the boxes of views [mm on paper]."""
        return sum(_length_within(one, other, box) for box in self.views)

    def first(self, boxes: Iterable[tuple[Rectangle, Point]]) -> Point | None:
        """Return the point of the first free rectangle, and occupy it."""
        for box, point in boxes:
            if self.is_free(box):
                self.add(box)
                return point
        return None

    def _is_crossed(self, box: Rectangle) -> bool:
        if len(self._array) != len(self._lines):
            self._array = np.array(self._lines)
        return bool(len(self._array) and crossed(self._array, box, _APART).any())


def _length_within(one: Point, other: Point, box: Rectangle) -> float:
    """Return the part of a straight line that lies within a rectangle (Liang and Barsky)."""
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
    """Return whether two rectangles overlap, or are closer than this distance."""
    is_beside = one[0] >= other[2] + apart or other[0] >= one[2] + apart
    return not (is_beside or one[1] >= other[3] + apart or other[1] >= one[3] + apart)


def crossed(lines: np.ndarray, box: Rectangle, apart: float = 0.0) -> np.ndarray:
    """Return which straight pieces (n, 4) are closer to a rectangle than this (Liang and Barsky)."""
    start, away = lines[:, :2], lines[:, 2:] - lines[:, :2]
    away = np.where(np.abs(away) < 1e-12, 1e-12, away)
    low = (np.array([box[0] - apart, box[1] - apart]) - start) / away
    high = (np.array([box[2] + apart, box[3] + apart]) - start) / away
    enter = np.minimum(low, high).max(axis=1)
    leave = np.maximum(low, high).min(axis=1)
    meets: np.ndarray = np.maximum(enter, 0.0) <= np.minimum(leave, 1.0)
    return meets


def around(centre: Point, width: float, height: float) -> Rectangle:
    """Return a rectangle by its middle."""
    x, y = centre
    return x - width / 2, y - height / 2, x + width / 2, y + height / 2
