"""Drawing symbols as lines: projection, surface texture, geometric tolerances, datums, cutting arrows.

All sizes are millimetres on paper, from the symbol's own origin. A symbol consists of lines, circles and
filled corners, not of letters of a font, so it looks the same in every program.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import cos, hypot, pi, sin, sqrt

from cad.drafting.curves import Point, Polyline

Circle = tuple[Point, float]


@dataclass(frozen=True)
class Symbol:
    """The lines, thin dash-dotted lines, circles and filled triangles of a symbol."""

    lines: Sequence[Polyline] = ()
    centres: Sequence[Polyline] = ()
    circles: Sequence[Circle] = ()
    filled: Sequence[Polyline] = field(default_factory=list)

    def moved(self, x: float, y: float) -> Symbol:
        """Return the symbol moved by a vector."""

        def move(line: Polyline) -> Polyline:
            return [(a + x, b + y) for a, b in line]

        return Symbol(
            [move(line) for line in self.lines],
            [move(line) for line in self.centres],
            [((a + x, b + y), radius) for (a, b), radius in self.circles],
            [move(line) for line in self.filled],
        )

    def joined(self, *others: Symbol) -> Symbol:
        """Return this symbol and others combined into one."""
        every = (self, *others)
        return Symbol(
            [line for one in every for line in one.lines],
            [line for one in every for line in one.centres],
            [circle for one in every for circle in one.circles],
            [line for one in every for line in one.filled],
        )


def first_angle(height: float) -> Symbol:
    """Return the symbol of first-angle projection (ISO 5456-2).

    It shows a truncated cone from its side, and on the right the cone as seen from its left.
    """
    small, large, half = height / 4, height / 2, height / 2
    right = 1.25 * height
    cone = [
        (-height - half / 2, -small),
        (-half / 2, -large),
        (-half / 2, large),
        (-height - half / 2, small),
    ]
    over = height / 8
    return Symbol(
        lines=[[*cone, cone[0]]],
        centres=[
            [(cone[0][0] - over, 0.0), (right + over, 0.0)],
            [(right - large, -large - over), (right - large, large + over)],
        ],
        circles=[((right - large, 0.0), small), ((right - large, 0.0), large)],
    )


def texture(height: float, reach: float) -> Symbol:
    """Return the symbol for required machining, with its tip at the origin (ISO 21920-1).

    It is a hook at 60° with a bar, and a line above the text.
    """
    rise = 1.4 * height
    low, high = rise / sqrt(3), 2 * rise / sqrt(3)
    return Symbol(
        lines=[
            [(-low, rise), (0.0, 0.0), (high, 2 * rise), (high + reach, 2 * rise)],
            [(-low, rise), (low, rise)],
        ]
    )


def basic_texture(height: float) -> Symbol:
    """Return the basic texture symbol in brackets, which refers to surfaces that have their own symbol."""
    rise = height
    low, high = rise / sqrt(3), 1.6 * rise / sqrt(3)
    return Symbol(lines=[[(-low, rise), (0.0, 0.0), (high, 1.6 * rise)]])


def geometric(form: str, size: float) -> Symbol:
    """Return the symbol of a geometric tolerance (ISO 1101) in a square of the given size about the origin.

    Raises
    ------
    KeyError
        If there is no symbol with that name.
    """
    half, r = size * 0.36, size * 0.24
    signs = {
        "cylindricity": Symbol(
            lines=[
                [(-r - half * 0.7, -half), (-r + half * 0.3, half)],
                [(r - half * 0.3, -half), (r + half * 0.7, half)],
            ],
            circles=[((0.0, 0.0), r)],
        ),
        "perpendicularity": Symbol(lines=[[(-half, -half), (half, -half)], [(0.0, -half), (0.0, half)]]),
        "parallelism": Symbol(
            lines=[
                [(-half, -half), (-half * 0.1, half)],
                [(half * 0.1, -half), (half, half)],
            ]
        ),
        "profile": Symbol(lines=[[(-half, -half / 2), (half, -half / 2)], _half_round(half)]),
        "circularity": Symbol(circles=[((0.0, 0.0), half * 0.8)]),
        "position": Symbol(
            lines=[[(-half, 0.0), (half, 0.0)], [(0.0, -half), (0.0, half)]],
            circles=[((0.0, 0.0), half * 0.6)],
        ),
        "flatness": Symbol(
            lines=[
                [
                    (-half, -half / 2),
                    (half / 2, -half / 2),
                    (half, half / 2),
                    (-half / 2, half / 2),
                    (-half, -half / 2),
                ]
            ]
        ),
        "concentricity": Symbol(circles=[((0.0, 0.0), half * 0.5), ((0.0, 0.0), half)]),
        "circular_runout": Symbol(
            lines=[[(-half, -half), (half, half)]],
            filled=[[(half, half), (half * 0.2, half * 0.5), (half * 0.5, half * 0.2)]],
        ),
    }
    return signs[form]


def _half_round(half: float) -> Polyline:
    """Return the half circle of the profile symbols, above the origin."""
    turns = (pi * step / 16 for step in range(17))
    return [(half * cos(turn), half * (sin(turn) - 0.5)) for turn in turns]


def arrow(tip: Point, start: Point, length: float = 3.0) -> Symbol:
    """Return a line with a filled arrowhead at its tip."""
    x, y = start[0] - tip[0], start[1] - tip[1]
    size = hypot(x, y) or 1.0
    x, y = x / size * length, y / size * length
    wings = [(tip[0] + x - y / 6, tip[1] + y + x / 6), (tip[0] + x + y / 6, tip[1] + y - x / 6)]
    return Symbol(lines=[[start, (tip[0] + x, tip[1] + y)]], filled=[[tip, *wings]])


def datum(tip: Point, angle: float, stem: float) -> tuple[Symbol, Point]:
    """Return a filled datum triangle at `tip` with a stem at an angle [rad], and the end of the stem."""
    u, v = cos(angle), sin(angle)
    top = tip[0] + 3.0 * u, tip[1] + 3.0 * v
    base = [(tip[0] - 1.7 * v, tip[1] + 1.7 * u), (tip[0] + 1.7 * v, tip[1] - 1.7 * u)]
    end = tip[0] + (3.0 + stem) * u, tip[1] + (3.0 + stem) * v
    return Symbol(lines=[[top, end]], filled=[[top, *base]]), end


UP, DOWN = pi / 2, -pi / 2
