"""Fields of a form and the JSON of the interface: typed text becomes a value, a value becomes text.

A control is called `.scale` for a design's own parameter, `film.radial_load` for an input of a step or a
parameter of a model, `film@level` for an option of a step: no two are called alike, and none like a field of
the form itself (`note`) or a property of HTML's forms (`length`).

`static/typed.js` does the same in the browser; `tests/web` compares the two.
"""

from __future__ import annotations

from collections.abc import Mapping, Set
from math import isfinite
from typing import Any
from urllib.parse import parse_qsl

from fastapi import Request
from pydantic_core import from_json

from app.api.reading import BodyTooLarge
from app.presentation.typed import text_of, value_of

OPTIONS = ("level", "tolerance")  # of a step, beside its inputs
MOST_FIELDS = 20_000


async def fields(request: Request) -> dict[str, str]:
    """The fields of a form that was sent.

    Raises
    ------
    BodyTooLarge
        If there are more than any of our forms has.
    """
    body = (await request.body()).decode(errors="replace")
    try:
        return dict(parse_qsl(body, keep_blank_values=True, max_num_fields=MOST_FIELDS))
    except ValueError:
        raise BodyTooLarge(f"a form has at most {MOST_FIELDS} fields") from None


def patch_of(design: Mapping[str, Any], typed: Mapping[str, str]) -> dict[str, Any]:
    """The merge patch with what a form's user changed."""
    patch: dict[str, Any] = {}
    blocks = {*design["steps"], *design["models"]}
    for name, text in kept(typed).items():
        if _is_field(design, blocks, name):
            _put(patch, design, name, value_of(text))
    return patch


def kept(typed: Mapping[str, str]) -> dict[str, str]:
    """What differs from what the form said at first, which its hidden field `was` holds."""
    try:
        was = from_json(typed.get("was", "{}"))
    except ValueError:
        was = {}
    old = was if isinstance(was, dict) else {}
    return {name: text for name, text in typed.items() if text.strip() != str(old.get(name, "")).strip()}


def _is_field(design: Mapping[str, Any], blocks: Set[str], name: str) -> bool:
    block, kind, tail = _parts(name)
    if kind == "@":
        return block in design["steps"] and tail in OPTIONS
    return tail in design["parameters"] if not block else bool(tail) and block in blocks


def _parts(name: str) -> tuple[str, str, str]:
    """Block, `.` or `@`, and the rest of a control's name."""
    return name.partition("@" if "@" in name else ".")


def texts(design: Mapping[str, Any]) -> dict[str, str]:
    """What a design says, field by field: `.scale`, `film.radial_load`, `film@level`, `model.width`."""
    found = {f".{name}": text_of(value) for name, value in design["parameters"].items()}
    for group, inside in (("steps", "inputs"), ("models", "parameters")):
        for block, told in design[group].items():
            found |= {f"{block}.{name}": text_of(value) for name, value in told[inside].items()}
    for step, told in design["steps"].items():
        found |= {f"{step}@{option}": text_of(told[option]) for option in OPTIONS}
    return found


def _put(patch: dict[str, Any], design: Mapping[str, Any], name: str, value: Any) -> None:
    """One value in its place; what was emptied is removed."""
    block, kind, tail = _parts(name)
    told = None if value == "" else value
    if kind == "@":
        patch.setdefault("steps", {}).setdefault(block, {})[tail] = option_of(tail, told)
    elif not block:
        patch.setdefault("parameters", {})[tail] = told
    elif block in design["models"]:
        _inside(patch, "models", block, "parameters")[tail] = told
    else:
        _inside(patch, "steps", block, "inputs")[tail] = told


def _inside(patch: dict[str, Any], group: str, block: str, part: str) -> dict[str, Any]:
    inside: dict[str, Any] = patch.setdefault(group, {}).setdefault(block, {}).setdefault(part, {})
    return inside


def option_of(name: str, value: Any) -> Any:
    """A tolerance is a number; the interface says what is wrong with one that is none."""
    if name != "tolerance" or not isinstance(value, str):
        return value
    try:
        number = float(value)
    except ValueError:
        return value
    return number if isfinite(number) else value
