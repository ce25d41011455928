"""Convert between the text in an input field and its value; `static/typed.js` does it in the browser."""

from __future__ import annotations

import json
from collections.abc import Mapping

from pydantic import JsonValue
from pydantic_core import from_json

DIGITS = 15  # of a number in a field; later ones come from rounding in floating point
LARGEST_WHOLE = 1e15  # larger numbers are written with a power of ten


def value_of(text: str) -> JsonValue:
    """Return the value of a field: a list `[1, 2] mm`, a JSON object, or else the text itself."""
    stripped = text.strip()
    if not stripped.startswith(("[", "{")):
        return stripped
    end = stripped.rfind("]" if stripped[0] == "[" else "}") + 1
    try:
        # json.loads would accept NaN as a number and fail on deep nesting.
        inside: JsonValue = from_json(stripped[:end], allow_inf_nan=False)
        unit = stripped[end:].strip()
    except ValueError:
        return stripped  # the interface will report what is wrong with it
    return {"value": inside, "unit": unit} if unit else inside


def text_of(value: object) -> str:
    """Return the text that a field shows for a value, in the form in which users type it."""
    if value is None:
        return ""
    if isinstance(value, Mapping) and set(value) == {"value", "unit"}:
        inside = value["value"] if isinstance(value["value"], str) else json.dumps(_as_typed(value["value"]))
        return f"{inside} {value['unit']}" if value["unit"] != "1" else inside
    return value if isinstance(value, str) else json.dumps(_as_typed(value), ensure_ascii=False)


def _as_typed(value: object) -> object:
    """Return a value whose numbers have as many digits as anyone types: 6000.000000000001 → 6000."""
    if isinstance(value, Mapping):
        return {name: _as_typed(inside) for name, inside in value.items()}
    if isinstance(value, list):
        return [_as_typed(inside) for inside in value]
    if not isinstance(value, float):
        return value
    typed = float(f"{value:.{DIGITS}g}")
    return int(typed) if typed.is_integer() and abs(typed) < LARGEST_WHOLE else typed
