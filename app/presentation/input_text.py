"""Text as a user types it in a field, and the value that it stands for; `static/typed.js` does the same."""

from __future__ import annotations

import json
from collections.abc import Mapping

from pydantic import JsonValue
from pydantic_core import from_json


def value_of(text: str) -> JsonValue:
    """Read a field: a text as it is; a list `[1, 2] mm`, or an object of JSON, as such."""
    stripped = text.strip()
    if not stripped.startswith(("[", "{")):
        return stripped
    end = stripped.rfind("]" if stripped[0] == "[" else "}") + 1
    try:
        # Not json.loads, which takes NaN for a number and does not survive deep nesting.
        inside: JsonValue = from_json(stripped[:end], allow_inf_nan=False)
        unit = stripped[end:].strip()
    except ValueError:
        return stripped  # the interface says what is wrong with it
    return {"value": inside, "unit": unit} if unit else inside


def text_of(value: object) -> str:
    """Return the text of a field from a value as typed."""
    if value is None:
        return ""
    if isinstance(value, Mapping) and set(value) == {"value", "unit"}:
        inside = value["value"] if isinstance(value["value"], str) else json.dumps(value["value"])
        return f"{inside} {value['unit']}" if value["unit"] != "1" else inside
    if isinstance(value, float):
        return f"{value:.17g}" if value.is_integer() else repr(value)
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
