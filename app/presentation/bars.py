"""Bar charts as SVG: contributions to a variance, largest on top, and a histogram with limits.

Equal data give equal bytes. The SVG has no scripts and no style attributes, which the pages' security policy
forbids.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape

from app.presentation import numbers

WIDTH = 560
NAMES = 170  # width of the names of bars
ROW, BAR = 26, 9  # height of a row, and of a bar
HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 220, 50, 14, 20, 40  # of the histogram and its margins
LONGEST_NAME = 28  # letters
FONT = "Liberation Sans, Arial, sans-serif"
ALONE, TOGETHER, LIMIT, VALUE = "#1b4f7f", "#9db8d2", "#b3261e", "#1d6b3a"


@dataclass(frozen=True)
class Bar:
    """A name, its share of the variance alone, and its share including interactions, each from 0 to 1."""

    name: str
    first: float
    total: float


@dataclass(frozen=True)
class Mark:
    """A line that marks a value in a histogram."""

    name: str
    at: float
    is_limit: bool = True


def tornado(bars: Sequence[Bar]) -> str:
    """Return a bar chart of shares, with total effects behind single effects; empty without shares."""
    if not bars:
        return ""
    height = ROW * len(bars) + 24
    inside = [part for place, bar in enumerate(bars) for part in _bar(place, bar)]
    inside += _legend(height)
    return _svg(height, "Shares of the variance", inside)


def _bar(place: int, bar: Bar) -> Iterator[str]:
    y = place * ROW + 4
    room = WIDTH - NAMES - 60
    first, total = (room * min(max(share, 0.0), 1.0) for share in (bar.first, bar.total))
    name = bar.name if len(bar.name) <= LONGEST_NAME else f"{bar.name[: LONGEST_NAME - 1]}…"
    middle = y + BAR + 4
    yield f'<text x="{NAMES - 8}" y="{middle}" text-anchor="end">{escape(name)}</text>'
    yield f'<rect x="{NAMES}" y="{y}" width="{total:.1f}" height="{2 * BAR}" fill="{TOGETHER}"/>'
    inner = y + BAR / 2
    yield f'<rect x="{NAMES}" y="{inner:.1f}" width="{first:.1f}" height="{BAR}" fill="{ALONE}"/>'
    percent = f"{100 * max(bar.total, 0.0):.1f} %"
    yield f'<text x="{NAMES + max(first, total) + 6:.1f}" y="{middle}">{percent}</text>'


def _legend(height: int) -> Iterator[str]:
    for x, colour, words in ((NAMES, ALONE, "alone"), (NAMES + 90, TOGETHER, "with others")):
        yield f'<rect x="{x}" y="{height - 15}" width="10" height="10" fill="{colour}"/>'
        yield f'<text x="{x + 15}" y="{height - 6}" font-size="11">{words}</text>'


def histogram(edges: Sequence[float], counts: Sequence[int], marks: Sequence[Mark], unit: str) -> str:
    """Return a histogram of the number of values between edges; marks outside the edges widen the axis."""
    if not counts or max(counts) == 0:
        return ""
    low = min(edges[0], *(mark.at for mark in marks))
    high = max(edges[-1], *(mark.at for mark in marks))
    axis = _Axis(low, high if high > low else low + 1.0)
    inside = [*_columns(axis, edges, counts), *_ends(axis, unit)]
    inside += [part for mark in marks for part in _line(axis, mark)]
    return _svg(HEIGHT, "Histogram", inside)


@dataclass(frozen=True)
class _Axis:
    low: float
    high: float

    def place(self, value: float) -> float:
        return LEFT + (value - self.low) / (self.high - self.low) * (WIDTH - LEFT - RIGHT)


def _columns(axis: _Axis, edges: Sequence[float], counts: Sequence[int]) -> Iterator[str]:
    deep = HEIGHT - TOP - BOTTOM
    for count, left, right in zip(counts, edges[:-1], edges[1:], strict=True):
        if count:
            tall = deep * count / max(counts)
            start, width = axis.place(left), max(axis.place(right) - axis.place(left), 0.4)
            top = HEIGHT - BOTTOM - tall
            size = f'width="{width:.1f}" height="{tall:.1f}"'
            yield f'<rect x="{start:.1f}" y="{top:.1f}" {size} fill="{TOGETHER}"/>'


def _ends(axis: _Axis, unit: str) -> Iterator[str]:
    floor = HEIGHT - BOTTOM
    yield f'<path d="M{LEFT},{floor}H{WIDTH - RIGHT}" stroke="#7b8894"/>'
    for value, anchor in ((axis.low, "start"), (axis.high, "end")):
        x = axis.place(value)
        yield f'<text x="{x:.1f}" y="{floor + 16}" text-anchor="{anchor}">{numbers.plain(value)}</text>'
    middle = (LEFT + WIDTH - RIGHT) / 2
    yield f'<text x="{middle:.0f}" y="{floor + 32}" text-anchor="middle">{escape(numbers.unit(unit))}</text>'


def _line(axis: _Axis, mark: Mark) -> Iterator[str]:
    x, colour = axis.place(mark.at), LIMIT if mark.is_limit else VALUE
    dashed = "" if mark.is_limit else ' stroke-dasharray="4 3"'
    yield f'<path d="M{x:.1f},{TOP}V{HEIGHT - BOTTOM}" stroke="{colour}" stroke-width="1.6"{dashed}/>'
    anchor = "end" if x > WIDTH / 2 else "start"
    y = TOP - 6 if mark.is_limit else TOP + 8
    shift = -4 if anchor == "end" else 4
    words = escape(mark.name)
    yield f'<text x="{x + shift:.1f}" y="{y}" text-anchor="{anchor}" fill="{colour}">{words}</text>'


def _svg(height: int, title: str, inside: Sequence[str]) -> str:
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" role="img" '
    head += f'aria-label="{escape(title)}" font-family="{FONT}" font-size="12" fill="#1b2733">'
    return f"{head}{''.join(inside)}</svg>"
