"""Jinja as pages and report use it: everything is escaped, formulas become MathML, numbers are aligned."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from app.presentation import numbers
from app.presentation.bidi import balanced, bare
from templates.core.paper.mathml import mathml

PAGES = Path(__file__).with_name("pages")


def formula(latex: str) -> Markup:
    """LaTeX as MathML, set as in a line of its own."""
    return Markup(mathml(latex).replace('display="inline"', 'display="block"', 1))


def inline(latex: str) -> Markup:
    """LaTeX as MathML within a line of words."""
    return Markup(mathml(latex))


def capital(words: str) -> str:
    """The words with a capital; the rest as it is."""
    return words[:1].upper() + words[1:]


def isolated(text: object) -> Markup:
    """A text of a user, escaped, in an element of its own that turns nothing beside it."""
    return Markup("<bdi>{}</bdi>").format(balanced(str(text)))


def pages(*more: Path) -> Environment:
    """The environment of the pages; `more` folders hold pages of other parts."""
    made = Environment(
        loader=FileSystemLoader([PAGES, *more]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    filters: dict[str, Any] = {
        "formula": formula,
        "inline": inline,
        "capital": capital,
        "bare": bare,
        "isolated": isolated,
        "aligned": numbers.aligned,
        "plain": numbers.plain,
        "unit": numbers.unit,
        "percent": numbers.percent,
        "rough": numbers.rough,
        "told": numbers.told,
    }
    made.filters.update(filters)
    return made
