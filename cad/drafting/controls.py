"""Draw geometric tolerances, datums and surface textures at free places, with leaders to their faces.

Frames follow ISO 1101 and surface textures ISO 21920-1. Datums follow ISO 5459; the symbol of a datum axis is
in line with the dimension line of its feature.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from math import cos, dist, pi, radians, sin

from cad.drafting.curves import Point
from cad.drafting.declaration import Control, DrawingDeclaration
from cad.drafting.dimension_layout import TEXT, NoRoom, PlacedDimension
from cad.drafting.formats import FORMATS
from cad.drafting.frames import Frame
from cad.drafting.letter_width import width_of
from cad.drafting.page import Page
from cad.drafting.room import Rectangle, Room, around
from cad.drafting.symbols import Symbol, arrow, datum, texture

_HIGH = 2 * TEXT  # of a frame [mm on paper]
_INTO = 3.0  # from the corner of a face to where a leader points [mm on paper]
_ACROSS = 20.0  # a leader runs within a view, where another place is free [mm on paper]
_ROUND = 4.0  # radius of a balloon [mm on paper]
_STEMS = range(2, 90, 3)

BoxAt = Callable[[float, float], Rectangle]


class Controls:
    """Draws the tolerances, datums and surface textures that a model declares for dimensioned faces."""

    def __init__(self, page: Page, room: Room, *, is_last: bool) -> None:
        self.page, self.plan, self.room, self.is_last = page, page.plan, room, is_last

    def draw(self, declared: DrawingDeclaration, placed: Sequence[PlacedDimension]) -> str:
        """Draw all symbols that belong to drawn dimensions; return the letter of the first datum.

        Raises
        ------
        NoRoom
            If a symbol has no free place and this is not the last scale to be tried.
        """
        of: Mapping[str, PlacedDimension] = {one.dimension.name: one for one in placed if one.dimension.name}
        for name, letter in declared.datums.items():
            if name in of:
                self._datum(of[name], letter)
        drawn = [letter for name, letter in declared.datums.items() if name in of]
        for control in declared.controls:
            if control.parameter in of:
                self._frame(of[control.parameter], control)
        for name, height in declared.textures.items():
            if name in of:
                self._texture(of[name], f"Ra {height:g}")
        return drawn[0] if drawn else ""

    def _datum(self, placed: PlacedDimension, letter: str) -> None:
        tries = list(self._stems(placed))
        chosen = next((one for one in tries if self.room.is_free(one[0])), None)
        if chosen is None and not self.is_last:
            raise NoRoom
        box, symbol = chosen or tries[0]
        self.room.add(box)
        corners = [(box[0], box[1]), (box[2], box[1]), (box[2], box[3]), (box[0], box[3]), (box[0], box[1])]
        self.page.symbol(symbol.joined(Symbol(lines=[corners])))
        middle = (box[0] + box[2]) / 2
        self.page.write(letter, middle - width_of(letter, TEXT) / 2, box[1] + TEXT / 2, TEXT)

    def _stems(self, placed: PlacedDimension) -> Iterator[tuple[Rectangle, Symbol]]:
        """Yield possible positions of a datum symbol, in line with a dimension line if there is one."""
        if placed.ends is None:
            tip, turns = self._target(placed), [radians(turn) for turn in range(0, 360, 30)]
            starts = [(tip, turn) for turn in turns]
        else:
            low, high = sorted(placed.ends)
            turn = pi / 2 if low[0] == high[0] else 0.0
            starts = [(high, turn), (low, turn + pi)]
        for stem in _STEMS:
            for tip, turn in starts:
                symbol, end = datum(tip, turn, stem)
                middle = end[0] + _HIGH / 2 * cos(turn), end[1] + _HIGH / 2 * sin(turn)
                yield around(middle, _HIGH, _HIGH), symbol

    def _frame(self, placed: PlacedDimension, control: Control) -> None:
        """Draw a tolerance frame with its symbol, width and datum, and a leader to the face."""
        frame = Frame(control.form, control.width, control.to, TEXT)
        width, height = frame.width, frame.height
        target = self._target(placed)
        left, low = self._place(
            target, lambda x, y: (x - 0.5, y - 0.5, x + width + 0.5, y + height + 0.5), width
        )
        start = (left if target[0] < left + width / 2 else left + width), low + height / 2
        self.page.symbol(arrow(target, start))
        frame.draw(self.page, left, low)
        self.room.add_leader([target, start])

    def balloon(self, number: str, target: Point) -> None:
        """Draw the number of a part in a circle, with a leader that ends in a dot on the part."""
        x, y = self._place(target, lambda x, y: (x - _ROUND, y - _ROUND, x + _ROUND, y + _ROUND), 0.0)
        size = dist((x, y), target)
        foot = x + (target[0] - x) * _ROUND / size, y + (target[1] - y) * _ROUND / size
        drawn = Symbol(lines=[[target, foot]], circles=[((x, y), _ROUND), (target, 0.5)])
        self.page.symbol(drawn, "DIMENSIONS")
        self.page.write(number, x - width_of(number, TEXT) / 2, y - TEXT / 2, TEXT)
        self.room.add_leader([target, foot])

    def _texture(self, placed: PlacedDimension, text: str) -> None:
        reach = width_of(text, 2.5)
        target = self._target(placed)
        x, y = self._place(target, lambda x, y: (x - 3.5, y - 0.5, x + 6.5 + reach, y + 10.5), reach)
        self.page.symbol(texture(TEXT, reach).moved(x, y).joined(arrow(target, (x, y))))
        self.page.write(text, x + 5.5, y + 6.0, 2.5)
        self.room.add_leader([target, (x, y)])

    def _target(self, placed: PlacedDimension) -> Point:
        """Return the point on the paper to which a leader points; for a length, one away from the corner."""
        measure = placed.dimension.measure
        x, y = self.plan.paper(measure.points[1], placed.right)
        return (x, y + _INTO) if measure.sort == "length" else (x, y)

    def _place(self, target: Point, box_at: BoxAt, width: float) -> Point:
        """Occupy the nearest free place near a target, and return it."""
        tries = (
            _beside(target, away, radians(turn), width)
            for away in range(8, round(150 * self.plan.format.width / FORMATS[0].width), 4)
            for turn in range(0, 360, 10)
        )
        free = [place for place in tries if self.room.is_free(box_at(*place))]
        clear = [p for p in free if self.room.passes([target, p]) and self.room.is_apart([target, p])]
        if not clear and not self.is_last:
            raise NoRoom
        short = (place for place in clear if self.room.length_in_views(target, place) <= _ACROSS)
        place = next(short, (clear or free or [_beside(target, 8, 0.0, width)])[0])
        self.room.add(box_at(*place))
        return place


def _beside(target: Point, away: float, turn: float, width: float) -> Point:
    u, v = cos(turn), sin(turn)
    return target[0] + away * u - (width if u < 0 else 0.0), target[1] + away * v
