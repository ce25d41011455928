"""Draw geometric tolerances, datums and surface textures at free places, with leaders to their faces.

Frames follow ISO 1101 and surface textures ISO 21920-1. Datums follow ISO 5459; the symbol of a datum axis is
in line with the dimension line of its feature. A leader ends on an edge of its face, or on an extension line
of that edge.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import product
from math import cos, dist, pi, radians, sin

import numpy as np

from cad.drafting.curves import Point
from cad.drafting.declaration import Control, DrawingDeclaration
from cad.drafting.dimension_layout import CROSSING, DatumPlace, NoRoom, PlacedDimension
from cad.drafting.formats import FORMATS
from cad.drafting.frames import Frame
from cad.drafting.labels import TEXT
from cad.drafting.letter_width import width_of
from cad.drafting.page import Page
from cad.drafting.room import Rectangle, Room
from cad.drafting.symbols import Symbol, arrow, texture
from cad.drafting.targets import hidden_targets, targets
from cad.drafting.views import View

_ROUND = 4.0  # radius of a balloon [mm on paper]
_DOT = 0.6  # radius of the dot at the end of a balloon's leader [mm on paper]
_SHELF = 8.0  # length of the line on which the symbol of a texture stands [mm on paper]
_STEMS = range(2, 90, 3)
_FIRST, _RING = 8, 4
"""Length of the shortest leader, and the step to the next [mm on paper]."""

_SEVERAL = 3  # lines that a leader crosses only if there is no hidden edge to which it crosses fewer
_MOST_MET = 6  # lines that a leader crosses on a sheet that is large enough

_SLANT = 0.4
"""Of a leader's length: how far it leads away from the line of the edge on which it ends, at least."""

_TURNS = np.radians(np.arange(0, 360, 10))
_WAYS = np.stack([np.cos(_TURNS), np.sin(_TURNS)], axis=1)

BoxesAt = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""The rectangles (n, 4) of something whose leader starts at points (n, 2), and leads to the left or not."""


class Controls:
    """Draws the tolerances, datums and surface textures that a model declares for dimensioned faces.

    `faults` counts symbols without a free place, `crossed` those whose leaders cross many lines.

    `views` are the views of the sheet, each with the distance by which it is moved to the right.
    """

    def __init__(self, page: Page, room: Room, views: Sequence[tuple[View, float]], most: int) -> None:
        self.most = most
        self.page, self.plan, self.room, self.views = page, page.plan, room, views
        self.faults = self.crossed = 0

    def draw(self, declared: DrawingDeclaration, placed: Sequence[PlacedDimension]) -> str:
        """Draw all symbols that belong to drawn dimensions; return the letter of the first datum.

        Raises
        ------
        NoRoom
            If as many symbols as on another sheet have no free place.
        """
        of: Mapping[str, PlacedDimension] = {one.dimension.name: one for one in placed if one.dimension.name}
        for name, letter in declared.datums.items():
            if name in of:
                self._datum(of[name], letter)
        drawn = [letter for name, letter in declared.datums.items() if name in of]
        stacks = defaultdict[str, list[Control]](list)
        for control in declared.controls:
            stacks[control.parameter].append(control)
        for name, stack in stacks.items():
            if name in of:
                self._frames(of[name], stack)
                self._checked()
        for name, height in declared.textures.items():
            if name in of:
                self._texture(of[name], f"Ra {height:g}")
                self._checked()
        return drawn[0] if drawn else ""

    def _checked(self) -> None:
        if self.faults >= self.most:
            raise NoRoom

    def _datum(self, placed: PlacedDimension, letter: str) -> None:
        if (one := placed.datum) is None:
            one = self._datum_nearby(placed)
            one.take(self.room)
        left, low, right, high = one.box
        corners = [(left, low), (right, low), (right, high), (left, high), (left, low)]
        self.page.symbol(one.symbol.joined(Symbol(lines=[corners])))
        middle = (left + right) / 2
        self.page.write(letter, middle - width_of(letter, TEXT) / 2, low + TEXT / 2, TEXT)

    def _datum_nearby(self, placed: PlacedDimension) -> DatumPlace:
        """Return the place of a datum whose dimension has no line with room for it."""
        tip = self._targets(placed)[0]
        turns = [radians(turn) for turn in range(0, 360, 30)]
        tries = [DatumPlace.at(tip, turn, stem) for stem, turn in product(_STEMS, turns)]
        free = (one for one in tries if self.room.is_free(one.box) and self.room.passes(one.stem))
        chosen = next(free, None)
        self.faults += chosen is None
        return chosen or tries[0]

    def _frames(self, placed: PlacedDimension, stack: Sequence[Control]) -> None:
        """Draw the frames of one feature above each other, with one leader."""
        frames = [Frame(one.form, one.width, one.to, TEXT) for one in stack]
        width, height = max(frame.width for frame in frames), sum(frame.height for frame in frames)
        boxes_at = _boxes(width, height, height - frames[0].height / 2)
        target, start, is_left = self._beside(placed, boxes_at)
        left = start[0] - width if is_left else start[0]
        top = start[1] + frames[0].height / 2
        for frame in frames:
            top -= frame.height
            frame.draw(self.page, left + width - frame.width if is_left else left, top)
        self.page.symbol(arrow(target, start))
        self.room.add_leader([target, start])

    def balloon(self, number: str, targets: Sequence[Point]) -> None:
        """Draw the number of a part in a circle, with a leader that ends in a dot at one of the targets."""

        def boxes(starts: np.ndarray, _is_left: np.ndarray) -> np.ndarray:
            return np.concatenate([starts - _ROUND, starts + _ROUND], axis=1)

        target, (x, y), _ = self._place(targets, boxes, targets[0])
        size = dist((x, y), target)
        foot = x + (target[0] - x) * _ROUND / size, y + (target[1] - y) * _ROUND / size
        turns = [pi * step / 4 for step in range(8)]
        dot = [(target[0] + _DOT * cos(turn), target[1] + _DOT * sin(turn)) for turn in turns]
        halves = [
            [dot[0], dot[1], dot[3], dot[2]],
            [dot[4], dot[5], dot[7], dot[6]],
            [dot[3], dot[4], dot[0], dot[7]],
        ]
        self.page.symbol(Symbol([[target, foot]], circles=[((x, y), _ROUND)], filled=halves), "DIMENSIONS")
        self.page.write(number, x - width_of(number, TEXT) / 2, y - TEXT / 2, TEXT)
        self.room.add_leader([target, foot])

    def _texture(self, placed: PlacedDimension, text: str) -> None:
        """Draw the symbol of a texture on the last piece of its leader, which is level."""
        reach = width_of(text, 2.5)
        boxes_at = _boxes(_SHELF + 4.0 + reach, 11.0, 0.5)
        target, start, is_left = self._beside(placed, boxes_at)
        left = start[0] - (_SHELF + 4.0 + reach if is_left else 0.0)
        shelf = (start[0], start[1]), (left if is_left else left + _SHELF, start[1])
        x, y = left + _SHELF / 2, start[1]
        symbol = texture(TEXT, reach).moved(x, y).joined(arrow(target, start), Symbol(lines=[[*shelf]]))
        self.page.symbol(symbol)
        self.page.write(text, x + 5.5, y + 6.0, 2.5)
        self.room.add_leader([target, start])

    def _targets(self, placed: PlacedDimension) -> list[Point]:
        return targets(placed, self.views, self.plan, self.room)

    def _beside(self, placed: PlacedDimension, boxes_at: BoxesAt) -> tuple[Point, Point, bool]:
        """Return where a leader to the face of a dimension ends and starts, and whether it leads right."""
        about = self.plan.paper(placed.dimension.measure.points[0], placed.right)
        if placed.ends is None:
            return self._place(self._targets(placed), boxes_at, about)
        across = int(placed.dimension.measure.form == "up")  # its edges lie across what it measures
        ways = _WAYS[np.abs(_WAYS[:, across]) > _SLANT]
        hidden = hidden_targets(placed, self.views, self.plan)
        return self._place(self._targets(placed), boxes_at, about, ways, hidden)

    def _place(
        self,
        ends: Sequence[Point],
        boxes_at: BoxesAt,
        about: Point,
        ways: np.ndarray = _WAYS,
        spare: Sequence[Point] = (),
    ) -> tuple[Point, Point, bool]:
        """Return where a leader ends and starts, and whether it leads to the right; occupy its start.

        Of the free places the nearest is taken, where each line that the leader crosses counts as some more
        length. The leader crosses no view but that of the point `about`. It ends at one of the `spare` points
        only if it would cross several lines otherwise.
        """
        found = self._found(ends, boxes_at, about, ways)
        if spare and (not found or min(found)[1] > _SEVERAL):
            found += self._found(spare, boxes_at, about, ways)
        self.faults += not found
        self.crossed += bool(found) and min(found)[1] > _MOST_MET
        _, _, end, start, is_left = (
            min(found) if found else (0, 0, ends[0], (ends[0][0] + 8.0, ends[0][1]), False)
        )
        self.room.add(_box(boxes_at, start, is_left=is_left))
        return end, start, is_left

    def _found(
        self, ends: Sequence[Point], boxes_at: BoxesAt, about: Point, ways: np.ndarray
    ) -> list[tuple[float, int, Point, Point, bool]]:
        """Return free places: their cost, the lines that the leader crosses, its end and its start."""
        found: list[tuple[float, int, Point, Point, bool]] = []
        farthest = round(150 * self.plan.format.width / FORMATS[0].width)
        for away in range(_FIRST, farthest, _RING):
            if found and away > min(found)[0]:
                break
            for end in ends:
                ring = self._ring(end, away * ways, boxes_at, about)
                found += ((away + CROSSING * met, met, end, start, left) for met, start, left in ring)
        return found

    def _ring(
        self, end: Point, away: np.ndarray, boxes_at: BoxesAt, about: Point
    ) -> Iterator[tuple[int, Point, bool]]:
        """Yield the free starts of leaders about their end, with the number of lines that they cross."""
        starts, is_left = end + away, away[:, 0] < -1e-9
        for place in np.flatnonzero(self.room.free(boxes_at(starts, is_left))):
            start = float(starts[place, 0]), float(starts[place, 1])
            if self.room.passes([end, start]) and self.room.is_apart([end, start], about):
                yield self.room.lines_met(end, start), start, bool(is_left[place])


def _boxes(width: float, height: float, foot: float) -> BoxesAt:
    """Return the rectangles of a thing beside the start of its leader, which is so far above its foot."""

    def boxes(starts: np.ndarray, is_left: np.ndarray) -> np.ndarray:
        left, low = starts[:, 0] - is_left * width, starts[:, 1] - foot
        return np.stack([left - 0.5, low - 0.5, left + width + 0.5, low + height + 0.5], axis=1)

    return boxes


def _box(boxes_at: BoxesAt, start: Point, *, is_left: bool) -> Rectangle:
    left, low, right, high = boxes_at(np.array([start]), np.array([is_left]))[0].tolist()
    return left, low, right, high
