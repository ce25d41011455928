"""Convert between fields of a form and JSON of the interface: typed text to values, values to text.

A control is called `.scale` for a design's own parameter, `film.radial_load` for an input of a step or a
parameter of a model, `film@level` for an option of a step, `film@limits.permissible_film` for a limit: all
these names are distinct, and differ from fields of the form itself (`note`) and from properties of HTML's
forms (`length`).

`shared/typed.js` does this conversion in the browser; `tests/app/web` compares the two.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Set
from math import isfinite
from typing import Protocol
from urllib.parse import parse_qsl

from fastapi import Request
from pydantic import JsonValue, TypeAdapter

from app.designs.document import WORKSHEET
from app.designs.schemas.designs import Design
from app.http.access import FORM_TOKEN
from app.http.limits import BodyTooLarge
from app.http.strict_requests import FORM_TYPES, NotForm, check_type
from app.presentation.input_text import text_of, value_of
from app.web.shared.session import check_form_token

OPTIONS = ("level", "tolerance")  # options of a step, besides its inputs
LIMITS = "limits."  # prefix of the controls for limits of its criteria
MOST_FIELDS = 20_000

Patch = dict[str, dict[str, JsonValue]]
"""A merge patch of a design: of its parameters, steps and models, by name."""
_WAS = TypeAdapter(dict[str, JsonValue])


class Names(Protocol):
    """The names of parameters, steps and models in a design."""

    @property
    def parameters(self) -> Collection[str]:
        """Return names of the design's own parameters."""

    @property
    def steps(self) -> Collection[str]:
        """Return the names of the design's steps."""

    @property
    def models(self) -> Collection[str]:
        """Return the names of the design's models."""


async def fields(request: Request) -> dict[str, str]:
    """Return the fields of a submitted form.

    Raises
    ------
    BodyTooLarge
        If there are more fields than any form of the service has.
    """
    body = (await request.body()).decode(errors="replace")
    try:
        return dict(parse_qsl(body, keep_blank_values=True, max_num_fields=MOST_FIELDS))
    except ValueError:
        raise BodyTooLarge(f"a form may have at most {MOST_FIELDS} fields") from None


async def forms_only(request: Request) -> None:
    """Accept only bodies that are forms, and within a session only forms from its own pages."""
    check_type(request, FORM_TYPES, NotForm)
    if request.scope.get(FORM_TOKEN):
        check_form_token(request, await fields(request))


def patch_of(design: Names, typed: Mapping[str, str]) -> Patch:
    """Return the merge patch with the user's changes in a form."""
    patch: Patch = {}
    blocks = {*design.steps, *design.models}
    for name, text in kept(typed).items():
        if _is_field(design, blocks, name):
            _put(patch, design, name, value_of(text))
    return patch


def lines_of(typed: Mapping[str, str]) -> dict[str, JsonValue]:
    """Return the merge patch of the design's worksheet; empty if its text was not changed."""
    text = kept(typed).get(WORKSHEET)
    if text is None:
        return {}
    return {WORKSHEET: text if text.strip() else None}


def kept(typed: Mapping[str, str]) -> dict[str, str]:
    """Return the fields that differ from the form's initial state, which its hidden field `was` stores."""
    try:
        old = _WAS.validate_json(typed.get("was", "{}"))
    except ValueError:
        old = {}
    texts = {name: text.replace("\r\n", "\n") for name, text in typed.items()}
    return {name: text for name, text in texts.items() if text.strip() != str(old.get(name, "")).strip()}


def _is_field(design: Names, blocks: Set[str], name: str) -> bool:
    block, kind, tail = _parts(name)
    if kind == "@":
        return block in design.steps and (tail in OPTIONS or tail.startswith(LIMITS))
    return tail in design.parameters if not block else bool(tail) and block in blocks


def _parts(name: str) -> tuple[str, str, str]:
    """Return the block of a control's name, the sign `.` or `@`, and the rest."""
    return name.partition("@" if "@" in name else ".")


def texts(design: Design) -> dict[str, str]:
    """Return the texts of a design by control.

    Names of controls are, for example, `.scale`, `film.radial_load`, `film@level` and `model.width`.
    """
    blocks = {name: step.inputs for name, step in design.steps.items()}
    blocks |= {name: model.parameters for name, model in design.models.items()}
    fields = {f".{name}": text_of(value) for name, value in design.parameters.items()}
    for block, values in blocks.items():
        fields |= {f"{block}.{name}": text_of(value) for name, value in values.items()}
    for name, step in design.steps.items():
        fields |= {f"{name}@{LIMITS}{tail}": text_of(value) for tail, value in step.limits.items()}
        fields |= {f"{name}@level": text_of(step.level), f"{name}@tolerance": text_of(step.tolerance)}
    return {**fields, WORKSHEET: design.worksheet}


def _put(patch: Patch, design: Names, name: str, value: JsonValue) -> None:
    """Store one value at its place, or remove the value if the user emptied the field."""
    block, kind, tail = _parts(name)
    new = None if value == "" else value
    if kind == "@" and tail.startswith(LIMITS):
        inner(inner(patch.setdefault("steps", {}), block), "limits")[tail.removeprefix(LIMITS)] = new
    elif kind == "@":
        inner(patch.setdefault("steps", {}), block)[tail] = option_of(tail, new)
    elif not block:
        patch.setdefault("parameters", {})[tail] = new
    elif block in design.models:
        inner(inner(patch.setdefault("models", {}), block), "parameters")[tail] = new
    else:
        inner(inner(patch.setdefault("steps", {}), block), "inputs")[tail] = new


def inner(outer: dict[str, JsonValue], name: str) -> dict[str, JsonValue]:
    """Return the object under a name; create an empty one if there is none yet."""
    inner = outer.setdefault(name, {})
    assert isinstance(inner, dict)
    return inner


def option_of(name: str, value: JsonValue) -> JsonValue:
    """Return an option, with a tolerance as a number; the interface refuses a text that is not a number."""
    if name != "tolerance" or not isinstance(value, str):
        return value
    try:
        number = float(value)
    except ValueError:
        return value
    return number if isfinite(number) else value
