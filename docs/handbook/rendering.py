"""Jinja for generated pages: Markdown, with HTML tables where a cell holds a formula."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from templates.core.paper.mathml import mathml, unit_symbol

ROOT = Path(__file__).parents[2]


def math(latex: str) -> Markup:
    """LaTeX as MathML, within a line."""
    return Markup(mathml(latex))


def prose(text: str) -> Markup:
    """A sentence for a cell of an HTML table: what stands in backticks becomes code."""
    return Markup(re.sub(r"`([^`]+)`", r"<code>\1</code>", str(escape(text))))


def unit(text: str | None) -> str:
    """A unit as it is printed; nothing for a pure number."""
    return "" if text in (None, "1") else unit_symbol(str(text))


def number(value: float | list[float] | None) -> str:
    """A number with five digits, or a list of them."""
    if isinstance(value, list):
        return f"[{', '.join(map(number, value))}]"
    return "none" if value is None else f"{value:.5g}"


def percent(value: float) -> str:
    """A relative error with two digits; a factor where it is above ten."""
    return f"{100 * value:.2g} %" if value < 10 else f"{value:.2g} times the value"


def as_json(value: Any) -> Markup:
    """JSON for a block of code, a line for each input."""
    lines = (f"  {json.dumps(name)}: {json.dumps(v, ensure_ascii=False)}" for name, v in value.items())
    return Markup("{\n" + ",\n".join(lines) + "\n}")


ENVIRONMENT = Environment(
    loader=FileSystemLoader(Path(__file__).with_name("pages")),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)
ENVIRONMENT.filters |= {
    "math": math,
    "prose": prose,
    "unit": unit,
    "number": number,
    "percent": percent,
    "as_json": as_json,
}


def render(page: str, **values: Any) -> str:
    """The text of a page."""
    return ENVIRONMENT.get_template(page).render(**values)
