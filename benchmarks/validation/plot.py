"""A small SVG for each case: the published numbers with their uncertainty, and ours."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from math import floor, log10

from templates.validate.case import Case
from templates.validate.comparison import Comparison

WIDTH, HEIGHT = 360, 220
LEFT, RIGHT, TOP, BOTTOM = 58, 12, 26, 40
THEIRS, OURS, INK = "#d9822b", "#3b7dd8", "#808080"
STYLE = f'font-family="sans-serif" font-size="11" fill="{INK}"'


class Axis:
    """A linear axis, or a logarithmic one where positive values span more than a factor of 30."""

    def __init__(self, values: Sequence[float], begin: float, end: float) -> None:
        low, high = min(values), max(values)
        self.is_log = low > 0 and high > 30 * low
        self.begin, self.end = begin, end
        margin = 0.06 * (high - low) or 0.05 * abs(high) or 1.0
        self.low, self.high = (low / 1.15, high * 1.15) if self.is_log else (low - margin, high + margin)

    def at(self, value: float) -> float:
        """Return the place of a value in the picture; a value outside lies on the edge."""
        low, high, value = (log10(x) if self.is_log else x for x in (self.low, self.high, self.inside(value)))
        return self.begin + (value - low) / (high - low) * (self.end - self.begin)

    def inside(self, value: float) -> float:
        """Return the value, or the nearest end of the axis."""
        return min(max(value, self.low), self.high)

    def ticks(self) -> list[float]:
        """Return three to seven round values."""
        if self.is_log:
            powers = range(floor(log10(self.low)), floor(log10(self.high)) + 1)
            each = [m * 10.0**n for n in powers for m in ((1,) if len(powers) > 3 else (1, 3))]
        else:
            step = _round_step((self.high - self.low) / 5)
            first = floor(self.low / step)
            each = [step * n for n in range(first, first + 9)]
        return [value for value in each if self.low <= value <= self.high]


def _round_step(step: float) -> float:
    power = 10.0 ** floor(log10(step))
    return next(m * power for m in (1, 2, 5, 10) if m * power >= step)


def svg(case: Case, compared: list[Comparison]) -> str:
    """Return the picture of a case: a curve over the abscissa, or the difference of each quantity."""
    lines = _curve(case, compared) if case.abscissa else _differences(compared)
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" {STYLE}>'
    return "\n".join([head, *lines, *_legend(), "</svg>", ""])


def _legend() -> Iterator[str]:
    yield f'<circle cx="{LEFT + 4}" cy="12" r="3.5" fill="{THEIRS}"/>'
    yield f'<text x="{LEFT + 12}" y="16">published ± uncertainty</text>'
    yield _cross(LEFT + 164, 12)
    yield f'<text x="{LEFT + 172}" y="16">ours</text>'


def _cross(x: float, y: float) -> str:
    path = f"M{x - 3.5:.1f} {y - 3.5:.1f}l7 7m0-7l-7 7"
    return f'<path d="{path}" stroke="{OURS}" stroke-width="1.6" fill="none"/>'


def _dot(x: float, y: float, low: float, high: float, is_upright: bool) -> str:
    ends = f"M{x:.1f} {low:.1f}V{high:.1f}" if is_upright else f"M{low:.1f} {y:.1f}H{high:.1f}"
    bar = f'<path d="{ends}" stroke="{THEIRS}" stroke-width="1.2"/>'
    return f'{bar}<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" fill="{THEIRS}"/>'


def _frame(x: Axis, label: str) -> Iterator[str]:
    edges = f"M{LEFT} {TOP}V{HEIGHT - BOTTOM}H{WIDTH - RIGHT}"
    yield f'<path d="{edges}" stroke="{INK}" fill="none"/>'
    for value in x.ticks():
        at = f'x="{x.at(value):.1f}" y="{HEIGHT - BOTTOM + 14}"'
        yield f'<text {at} text-anchor="middle">{value:.4g}</text>'
    middle = (LEFT + WIDTH - RIGHT) / 2
    yield f'<text x="{middle:.0f}" y="{HEIGHT - 8}" text-anchor="middle">{escape(label)}</text>'


def _curve(case: Case, compared: list[Comparison]) -> Iterator[str]:
    """Yield the ordinate over the abscissa."""
    shown = next((c for c in compared if c.column.name == case.ordinate), compared[0])
    rows = [row for row in case.selected if row[shown.column.name]]
    places = [float(row[case.abscissa]) for row in rows]
    x = Axis(places, LEFT, WIDTH - RIGHT)
    y = Axis([*shown.theirs, *shown.ours], HEIGHT - BOTTOM, TOP)
    yield from _frame(x, _label(case, case.abscissa))
    for value in y.ticks():
        yield f'<text x="{LEFT - 5}" y="{y.at(value) + 4:.1f}" text-anchor="end">{value:.4g}</text>'
    yield (
        f'<text transform="translate(12 {(TOP + HEIGHT - BOTTOM) / 2:.0f}) rotate(-90)" text-anchor="middle">'
        f"{escape(_label(case, shown.column.name))}</text>"
    )
    each = zip(places, shown.theirs, shown.uncertainties, shown.ours, strict=True)
    for place, theirs, allowed, ours in each:
        yield _dot(x.at(place), y.at(theirs), y.at(theirs - allowed), y.at(theirs + allowed), True)
        yield _cross(x.at(place), y.at(ours))


def _label(case: Case, name: str) -> str:
    column = case.reference.columns[name]
    return column.words if column.unit in ("1", "") else f"{column.words} [{column.unit}]"


def _differences(compared: list[Comparison]) -> Iterator[str]:
    """Yield the difference at the worst place of each quantity, beside the uncertainty."""
    rows = [_difference(comparison) for comparison in compared if comparison.theirs[comparison.worst]]
    spread = [s * a for _, a, _ in rows for s in (-1, 1)] + [difference for _, _, difference in rows]
    x = Axis(spread, LEFT, WIDTH - RIGHT)
    yield from _frame(x, "difference from the published value [%]")
    pitch = (HEIGHT - TOP - BOTTOM) / len(rows)
    for n, (words, allowed, difference) in enumerate(rows):
        y = TOP + (n + 0.7) * pitch
        yield f'<text x="{LEFT + 4}" y="{y - 6:.1f}">{escape(words)}</text>'
        yield _dot(x.at(0), y, x.at(-allowed), x.at(allowed), False)
        yield _cross(x.at(difference), y)


def _difference(comparison: Comparison) -> tuple[str, float, float]:
    """Return the words of a quantity, its uncertainty and the difference at the worst place [%]."""
    n = comparison.worst
    percent = 100 / abs(comparison.theirs[n])
    difference = comparison.ours[n] - comparison.theirs[n]
    return comparison.column.words, percent * comparison.uncertainties[n], percent * difference
