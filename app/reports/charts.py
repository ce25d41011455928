"""Charts of a report as SVG: lines over linear or logarithmic axes, the same on screen and on paper.

Equal charts give equal bytes. The SVG has no scripts and no style attributes, which the pages' security
policy forbids.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from math import ceil, floor, isfinite, log10

from app.presentation import numbers

WIDTH, HEIGHT, SQUARE = 560, 280, 380  # size of the drawing
LEFT, RIGHT, TOP, BOTTOM = 70, 14, 12, 44  # margins
LEGEND = 18  # height of a line in the legend
MOST_POINTS = 1500  # points of a line; a cycle has about 720
TICKS = 6
COLOURS = ("#1b4f7f", "#b5651d", "#1d6b3a", "#8e2f6b", "#5a5f66", "#0f8a8a")
FONT = "Liberation Sans, Arial, sans-serif"


@dataclass(frozen=True)
class Series:
    """A line, with points if `marked`, or only points; a None among its values interrupts the line."""

    name: str
    x: Sequence[float | None]
    y: Sequence[float | None]
    dashed: bool = False
    marked: bool = False
    joined: bool = True


@dataclass(frozen=True)
class Chart:
    """Lines with a common pair of axes; a `square` chart has the same scale on both."""

    x: str
    y: str
    series: Sequence[Series]
    square: bool = False
    logarithmic: bool = False
    highest: float | None = None  # upper limit of y


@dataclass(frozen=True)
class _Axis:
    low: float
    high: float
    logarithmic: bool

    def share(self, value: float) -> float:
        """Return the position of a value between the ends of the axis [0 to 1]."""
        low, high = self._scaled(self.low), self._scaled(self.high)
        return (self._scaled(value) - low) / (high - low)

    def holds(self, value: float | None) -> bool:
        """Return whether the axis can show a value."""
        return value is not None and isfinite(value) and not (self.logarithmic and value <= 0)

    def ticks(self) -> list[float]:
        """Return round values between the ends of the axis."""
        if self.logarithmic:
            return [10.0**n for n in range(ceil(log10(self.low)), floor(log10(self.high)) + 1)]
        step = _round_step((self.high - self.low) / TICKS)
        return [n * step for n in range(ceil(self.low / step - 1e-9), floor(self.high / step + 1e-9) + 1)]

    def _scaled(self, value: float) -> float:
        return log10(value) if self.logarithmic else value


def _round_step(least: float) -> float:
    """Return the smallest step of 1, 2 or 5 times a power of ten that is not below `least`."""
    power = 10.0 ** floor(log10(least))
    return next(factor * power for factor in (1, 2, 5, 10) if factor * power >= least * (1 - 1e-9))


def svg(chart: Chart) -> str:
    """Return a chart as SVG; empty if there is nothing to draw."""
    across = [series.x for series in chart.series]
    upright = [series.y for series in chart.series]
    x, y = _axis(across, chart.logarithmic, None), _axis(upright, chart.logarithmic, chart.highest)
    if x is None or y is None:
        return ""
    named = len(chart.series) > 1
    height = (SQUARE if chart.square else HEIGHT) + LEGEND * named * ceil(len(chart.series) / 3)
    frame = _Frame(x, y, height, TOP + LEGEND * named * ceil(len(chart.series) / 3))
    frame = frame.with_equal_scales() if chart.square else frame
    inside = [*frame.grid(), *frame.labels(chart.x, chart.y), *_lines(frame, chart.series)]
    inside += _legend(chart.series) if named else []
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" font-family="{FONT}" '
    return f'{head}font-size="12" fill="#1b2733">{"".join(inside)}</svg>'


def _axis(values: Sequence[Sequence[float | None]], logarithmic: bool, highest: float | None) -> _Axis | None:
    whole = _Axis(0, 1, logarithmic)
    present = [value for line in values for value in line if value is not None and whole.holds(value)]
    if not present:
        return None
    low, high = min(present), max(present) if highest is None else highest
    if logarithmic:
        return _Axis(10.0 ** floor(log10(low)), 10.0 ** max(ceil(log10(high)), floor(log10(low)) + 1), True)
    if low == high:
        spread = abs(low) or 1.0
        return _Axis(low - spread / 2, high + spread / 2, False)
    return _Axis(low, high, False)


@dataclass(frozen=True)
class _Frame:
    """The area within the axes."""

    x: _Axis
    y: _Axis
    height: int
    top: int

    @property
    def width(self) -> float:
        return WIDTH - LEFT - RIGHT

    @property
    def depth(self) -> float:
        return self.height - self.top - BOTTOM

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Return the position of a point in the drawing."""
        return LEFT + self.x.share(x) * self.width, self.top + (1 - self.y.share(y)) * self.depth

    def with_equal_scales(self) -> _Frame:
        """Return a frame with one axis lengthened, so that both have the same scale and circles are round."""
        scale = max((self.x.high - self.x.low) / self.width, (self.y.high - self.y.low) / self.depth) * 1.05
        return _Frame(
            _around(self.x, scale * self.width), _around(self.y, scale * self.depth), self.height, self.top
        )

    def grid(self) -> Iterator[str]:
        """Yield the frame, and grid lines with numbers at the ticks."""
        for value in self.x.ticks():
            at, bottom = _text(self.place(value, self.y.low)[0]), _text(self.height - BOTTOM)
            yield f'<path d="M{at},{self.top}V{bottom}" stroke="#d6dde4"/>'
            below = self.height - BOTTOM + 15
            yield f'<text x="{at}" y="{below}" text-anchor="middle">{numbers.plain(value)}</text>'
        for value in self.y.ticks():
            level, number = self.place(self.x.low, value)[1], numbers.plain(value)
            yield f'<path d="M{LEFT},{_text(level)}H{WIDTH - RIGHT}" stroke="#d6dde4"/>'
            yield f'<text x="{LEFT - 6}" y="{_text(level + 4)}" text-anchor="end">{number}</text>'
        size = f'width="{_text(self.width)}" height="{_text(self.depth)}"'
        yield f'<rect x="{LEFT}" y="{self.top}" {size} fill="none" stroke="#7b8894"/>'

    def labels(self, x: str, y: str) -> Iterator[str]:
        """Yield the labels of the axes."""
        across = _text(LEFT + self.width / 2)
        yield f'<text x="{across}" y="{self.height - 8}" text-anchor="middle">{escape(x)}</text>'
        middle = _text(self.top + self.depth / 2)
        yield f'<text transform="translate(14 {middle}) rotate(-90)" text-anchor="middle">{escape(y)}</text>'


def _around(axis: _Axis, length: float) -> _Axis:
    middle = (axis.low + axis.high) / 2
    return _Axis(middle - length / 2, middle + length / 2, False)


def _lines(frame: _Frame, series: Sequence[Series]) -> Iterator[str]:
    for number, line in enumerate(series):
        colour = COLOURS[number % len(COLOURS)]
        dashed = ' stroke-dasharray="4 3"' if line.dashed else ""
        path = _path(frame, line)
        if path and line.joined:
            yield f'<path d="{path}" fill="none" stroke="{colour}" stroke-width="1.6"{dashed}/>'
        if line.marked:
            yield from (
                f'<circle cx="{_text(x)}" cy="{_text(y)}" r="3.5" fill="{colour}"/>'
                for x, y in _points(frame, line)
                if x is not None and y is not None
            )


def _path(frame: _Frame, line: Series) -> str:
    """Return the SVG path of a line, interrupted where values are missing."""
    pieces, down = [], False
    for x, y in _points(frame, line):
        if x is None or y is None:
            down = False
            continue
        pieces.append(f"{'L' if down else 'M'}{_text(x)},{_text(y)}")
        down = True
    return "".join(pieces)


def _points(frame: _Frame, line: Series) -> Iterator[tuple[float | None, float | None]]:
    every = ceil(len(line.x) / MOST_POINTS)
    for x, y in list(zip(line.x, line.y, strict=False))[::every]:
        inside = (
            x is not None and y is not None and frame.x.holds(x) and frame.y.holds(y) and y <= frame.y.high
        )
        yield frame.place(x, y) if inside and x is not None and y is not None else (None, None)


def _legend(series: Sequence[Series]) -> Iterator[str]:
    for number, line in enumerate(series):
        x, y = LEFT + 165 * (number % 3), TOP + 4 + LEGEND * (number // 3)
        colour = COLOURS[number % len(COLOURS)]
        yield f'<path d="M{x},{y - 4}h18" stroke="{colour}" stroke-width="2"/>'
        yield f'<text x="{x + 23}" y="{y}" font-size="11">{escape(line.name)}</text>'


_text: Callable[[float], str] = "{:.1f}".format
