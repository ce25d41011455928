"""Jinja for pages and reports: it escapes all values, writes formulas as MathML, and aligns numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from app.presentation import numbers
from app.presentation.bidi import balanced, bare
from app.presentation.input_text import text_of
from app.reference import Reference
from templates.core.paper.mathml import mathml

PAGES = Path(__file__).with_name("pages")


def formula(latex: str) -> Markup:
    """Return LaTeX as MathML for a formula on its own line."""
    return Markup(mathml(latex).replace('display="inline"', 'display="block"', 1))


def inline(latex: str) -> Markup:
    """Return LaTeX as MathML for a formula within a line of text."""
    return Markup(mathml(latex))


def capital(words: str) -> str:
    """Return the text with a capital first letter, otherwise unchanged."""
    return words[:1].upper() + words[1:]


def isolated(text: object) -> Markup:
    """Return a user's text, escaped, in an element that isolates its writing direction."""
    return Markup("<bdi>{}</bdi>").format(balanced(str(text)))


def coded(text: str) -> Markup:
    """Return a sentence, escaped, with text between backticks as code."""
    pieces = text.split("`")
    if len(pieces) % 2 == 0:
        return escape(text)
    return Markup("").join(Markup("<code>{}</code>").format(p) if n % 2 else p for n, p in enumerate(pieces))


def environment(folder: Path) -> Environment:
    """Return the Jinja environment for the pages in a folder, which may extend the frame `base.html`."""
    jinja = Environment(
        loader=FileSystemLoader([PAGES, folder]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    filters: dict[str, Callable[..., object]] = {
        "formula": formula,
        "inline": inline,
        "capital": capital,
        "bare": bare,
        "isolated": isolated,
        "coded": coded,
        "aligned": numbers.aligned,
        "plain": numbers.plain,
        "unit": numbers.unit,
        "percent": numbers.percent,
        "rough": numbers.rough,
        "in_line": numbers.in_line,
        "as_typed": text_of,
        "rounded": numbers.rounded,
        "course": course,
        "reference": Reference.parse,
    }
    jinja.filters.update(filters)
    return jinja


WIDTH, HEIGHT = 120, 24
MOST_POINTS = 240


@dataclass(frozen=True)
class Course:
    """A long array as a table cell shows it."""

    ends: str  # `-5.3 … 12.1`
    count: str
    where: str  # `least at 30°, largest at 372°`
    path: str  # path data for an SVG of 120 × 24


def course(values: object, axis: object = None, unit: str | None = None) -> Course | None:
    """Return a small chart of a long list of numbers over its axis, if it has one; None for other values."""
    if not isinstance(values, list) or len(values) <= numbers.FEW or numbers.size(values) != len(values):
        return None
    ends = numbers.extremes(values)
    if ends is None:
        return None
    places = [_place(end, axis, unit, len(values)) for end in ends]
    shown = " … ".join(numbers.plain(values[end]) for end in ends)
    return Course(
        shown, f"{len(values)} values", f"least {places[0]}, largest {places[1]}", _path(values, ends)
    )


def _place(end: int, axis: object, unit: str | None, count: int) -> str:
    if isinstance(axis, list) and len(axis) == count and isinstance(axis[end], int | float):
        return f"at {numbers.in_line({'value': axis[end], 'unit': unit})}"
    return f"no. {end + 1}"


def _path(values: list[float | None], ends: tuple[int, int]) -> str:
    """Return the SVG path of the line, interrupted where values are missing."""
    low, high = values[ends[0]], values[ends[1]]
    assert low is not None
    assert high is not None
    every = -(-len(values) // MOST_POINTS)
    pieces, down = [], False
    for place in range(0, len(values), every):
        value = values[place]
        if isinstance(value, int | float):
            share = (value - low) / (high - low) if high > low else 0.5
            x, y = WIDTH * place / (len(values) - 1), 1 + (HEIGHT - 2) * (1 - share)
            pieces.append(f"{'L' if down else 'M'}{x:.1f},{y:.1f}")
        down = isinstance(value, int | float)
    return "".join(pieces)
