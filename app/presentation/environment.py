"""Jinja as pages and reports use it: everything is escaped, formulas become MathML, numbers are aligned."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from app.presentation import numbers
from app.presentation.bidi import balanced, bare
from app.presentation.sparkline import course
from app.reference import Reference
from templates.core.paper.mathml import mathml

PAGES = Path(__file__).with_name("pages")


def formula(latex: str) -> Markup:
    """Return LaTeX as MathML, set as in a line of its own."""
    return Markup(mathml(latex).replace('display="inline"', 'display="block"', 1))


def inline(latex: str) -> Markup:
    """Return LaTeX as MathML within a line of words."""
    return Markup(mathml(latex))


def capital(words: str) -> str:
    """Return the words with a capital; the rest as it is."""
    return words[:1].upper() + words[1:]


def isolated(text: object) -> Markup:
    """Return a text of a user, escaped, in an element of its own that turns nothing beside it."""
    return Markup("<bdi>{}</bdi>").format(balanced(str(text)))


def coded(text: str) -> Markup:
    """Return a sentence, escaped, with what stands between backticks as code."""
    pieces = text.split("`")
    if len(pieces) % 2 == 0:
        return escape(text)
    return Markup("").join(Markup("<code>{}</code>").format(p) if n % 2 else p for n, p in enumerate(pieces))


def environment(folder: Path) -> Environment:
    """Return Jinja for the pages in a folder, which may extend the frame of every page, `base.html`."""
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
        "course": course,
        "reference": Reference.parse,
    }
    jinja.filters.update(filters)
    return jinja
