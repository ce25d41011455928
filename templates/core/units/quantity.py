"""Quantities: convert typed values to SI floats or arrays, once.

Typed values are untrusted. Every refusal is a `FaultyText` with a code and a remedy; it quotes only a few
characters of the text, and is valid in JSON (no lone surrogates).
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from templates.core.arrays import Array
from templates.core.errors import FaultyText, excerpt
from templates.core.units.tolerance import (
    KEYS,
    LONGEST_TEXT,
    NUMBER,
    Tolerance,
    Written,
    from_object,
    is_zone,
    joined,
    split,
    stated,
)
from templates.core.units.typed_lists import TypedList, listed
from templates.core.units.units import (
    Unit,
    Value,
    beside,
    compatible,
    difference_of,
    registry,
    require_same_kind,
    unit,
)

__all__ = [
    "Tolerance", "TypedQuantity", "Unit", "Value", "beside", "compatible", "read", "read_any", "read_beside",
    "registry", "require_same_kind", "scaled", "unit",
]  # fmt: skip

_PATTERN = re.compile(rf"([+-]?{NUMBER})\s*(.*)", re.DOTALL)  # matches a stripped text
_SINGLE = re.compile(rf"[+-]?{NUMBER}(?: ?[A-Za-zµμ°%Ω][^\s;,]*)?")  # the usual form, and never a list
_ABSOLUTE = re.compile(r"(?<![\w°])(?:degC|degF|°C|°F|celsius|fahrenheit|degree_?[CF]\w*)(?!\w)")
_DEEPEST = 4  # axes of an array
_DECIMAL_COMMA = re.compile(r"(?<![0-9.,])((?:[0-9]{1,3}(?:\.[0-9]{3}){1,6}|[0-9]*)),([0-9]+)(?![0-9.,])")
_ENGLISH = re.compile(r"(?<![0-9.,])[1-9][0-9]{0,2}(?:,[0-9]{3})+\.[0-9]+(?![0-9.,])")
_GROUPED = re.compile(r"(?<![0-9.,])[1-9][0-9]{0,2},[0-9]{3}(?![0-9.,])")
_GRADE = re.compile(r"(?:sae|iso ?vg|vg)[ -]?[0-9]", re.IGNORECASE)


@dataclass(frozen=True)
class TypedQuantity:
    """A quantity as typed by the user, and its value in SI.

    `extra` is its tolerance as an answer states it, `tolerance` the tolerance in SI; `si` is the value alone.
    """

    value: Any
    unit: str
    si: Value
    extra: dict[str, Any]
    tolerance: Tolerance | None = None


def read(raw: Any, declared: str) -> TypedQuantity:
    """Return a quantity from any of its accepted forms; `declared` is the declared unit of the value.

    The forms are `"25 kN"`, a list such as `"1 2 3 mm"` or `"1-3-4-2"` (see `typed_lists`), `{"value": 25,
    "unit": "kN"}` (value may be a list), a list of these, and a bare number or list of numbers if the
    declared unit is `1`. A text or an object may contain a tolerance: `"25 ± 1 kN"`, `"plus": 1`.

    Raises
    ------
    FaultyText
        If the value is not a valid quantity; the error states a code and a remedy.
    """
    match raw:
        case str():
            return _read_text(raw, declared) if len(raw) <= LONGEST_TEXT else _read_long(raw, declared)
        case dict():
            return _read_object(raw, declared)
        case list() | tuple():
            return _read_list(list(raw), declared)
        case np.ndarray() | np.number():
            return read(raw.tolist(), declared)
        case bool():
            raise _no_quantity(raw, declared)
        case int() | float():
            return _read_bare(raw, declared)
    raise _no_quantity(raw, declared)


def read_beside(raw: Any, declared: str) -> TypedQuantity:
    """Return a limit or a target, read as the same kind as the value to which it belongs.

    For a temperature difference, `30 degC` means 30 K.

    Raises
    ------
    FaultyText
        If the value is not a valid quantity; the error states a code and a remedy.
    """
    if not unit(declared).difference:
        return read(raw, declared)
    return read([_beside(item) for item in raw] if isinstance(raw, list) else _beside(raw), declared)


def _beside(raw: Any) -> Any:
    match raw:
        case str() if parts := _parted(raw):
            return f"{parts[0]} {_ABSOLUTE.sub(_as_difference, parts[1])}"
        case {"unit": str() as name} if _ABSOLUTE.fullmatch(name):
            return {**raw, "unit": difference_of(name)}
    return raw


def _as_difference(match: re.Match[str]) -> str:
    return difference_of(match[0])


def in_points(text: str) -> str:
    """Return a text with decimal points in place of decimal commas, unless a comma may group thousands."""
    return text if _GROUPED.search(text) and not _ENGLISH.search(text) else _with_points(text)


def scaled(typed: TypedQuantity, factor: float) -> TypedQuantity:
    """Return a multiple of a quantity, including its tolerance."""
    tolerance = typed.tolerance
    if tolerance is not None:
        tolerance = replace(
            tolerance, lower=tolerance.lower * factor, upper=tolerance.upper * factor, zone=None
        )
    extra = {
        key: value * factor if isinstance(value, float | int) else value
        for key, value in typed.extra.items()
        if key != "zone"
    }
    value = (np.asarray(typed.value, dtype=float) * factor).tolist()
    return replace(typed, value=value, si=typed.si * factor, extra=extra, tolerance=tolerance)


def read_any(raw: Any) -> TypedQuantity:
    """Return a quantity of any kind; its unit determines the kind.

    Raises
    ------
    FaultyText
        If the value is not a valid quantity; the error states a code and a remedy.
    """
    return read(raw, unit(_own_unit(raw)).text)


def _own_unit(raw: Any) -> str:
    for _ in range(_DEEPEST):
        if not isinstance(raw, list) or not raw:
            break
        raw = raw[0]
    match raw:
        case str() if items := _listed(raw):
            return items.unit or "1"
        case str() if parts := _parted(_with_points(raw)):
            written = split(parts[1])
            return written.unit if written else parts[1] or "1"
        case {"unit": str() as name}:
            return name
    return "1"


def _listed(text: str) -> TypedList | None:
    """Return the list of numbers in a text; None if it is a single quantity or something else."""
    return None if _SINGLE.fullmatch(text) else listed(text)


@lru_cache(maxsize=4096)  # a user who varies one input sends the others again
def _read_text(text: str, declared: str) -> TypedQuantity:
    if items := _listed(text):
        return _read_items(items, declared)
    _refuse_decimal_comma(text, declared)
    if not (parts := _parted(text)):
        raise _no_quantity(text, declared)
    number, name = parts
    if not name:
        return _read_bare(float(number), declared)
    if written := split(name):
        return _toleranced(_finite(float(number)), written, declared)
    if is_zone(name):
        raise FaultyText("missing_unit", f'{number} {name} has no unit; write it like "{number} mm {name}"')
    return _quantity(_finite(float(number)), name, declared)


def _read_long(text: str, declared: str) -> TypedQuantity:
    """Return the list in a text that is too long for a single quantity and for the cache."""
    if items := listed(text):
        return _read_items(items, declared)
    raise _no_quantity(text, declared)


def _read_items(items: TypedList, declared: str) -> TypedQuantity:
    """Return a quantity from a list that was typed without the syntax of JSON."""
    if not items.unit and declared != "1":
        raise FaultyText(
            "missing_unit", f"the unit is missing; write it at the end, for example `1 2 {declared}`"
        )
    return _quantity(_array(items.numbers), items.unit or "1", declared)


def _refuse_decimal_comma(text: str, declared: str) -> None:
    """Raise an error for a quantity with decimal commas; the error shows it with decimal points.

    Raises
    ------
    FaultyText
        If the text has decimal commas; the error shows it with decimal points.
    """
    if (plain := _with_points(text)) == text or not (_parted(plain) or listed(plain)):
        return
    try:
        _read_text(plain, declared)
        rest = f", or {text.replace(',', '').strip()} if thousands are meant" if _GROUPED.search(text) else ""
    except FaultyText as error:
        rest = f"; {error}"
    kind = "grouped digits" if _ENGLISH.search(text) else "decimal comma"
    raise FaultyText("decimal_comma", f"{kind}: write {plain.strip()}{rest}")


def _with_points(text: str) -> str:
    """Return a text with decimal points in place of decimal commas, so that its unit can be read."""
    if "," not in text or len(text) > LONGEST_TEXT:
        return text
    ungrouped = _ENGLISH.sub(lambda match: match[0].replace(",", ""), text)
    return _DECIMAL_COMMA.sub(_in_points, ungrouped)


def _in_points(match: re.Match[str]) -> str:
    whole, fraction = match[1].replace(".", ""), match[2]
    return f"{whole or 0}.{fraction}"


def _toleranced(number: float, written: Written, declared: str) -> TypedQuantity:
    """Return a quantity from a text with a tolerance."""
    if written.unit == "1" != declared:
        raise FaultyText(
            "missing_unit", f"the unit is missing; write it at the end, for example `… {declared}`"
        )
    typed = _quantity(number, written.unit, declared)
    assert isinstance(typed.si, float)
    tolerance, extra = written.of(typed.si, written.unit, declared)
    return replace(typed, extra=extra, tolerance=tolerance)


def _parted(text: str) -> tuple[str, str] | None:
    """Return the number and unit of a text; None if it does not begin with a number, or is too long."""
    match = _PATTERN.fullmatch(text.strip()) if len(text) <= LONGEST_TEXT else None
    return (match[1], match[2]) if match else None


def _read_object(raw: dict[str, Any], declared: str) -> TypedQuantity:
    if "value" not in raw or not raw.keys() <= {"value", "unit", *KEYS}:
        raise _no_quantity(raw, declared)
    if "unit" not in raw and declared != "1":
        raise FaultyText("missing_unit", f'the unit is missing; add "unit": "{declared}"')
    name, value = raw.get("unit", "1"), raw["value"]
    if not isinstance(name, str):
        raise _no_quantity(raw, declared)
    if isinstance(value, (np.ndarray, np.number)):
        value = value.tolist()
    magnitude = _array(value) if isinstance(value, (list, tuple)) else _number(value)
    typed = _quantity(magnitude, name, declared)
    tolerance = from_object(raw, name, declared, typed.si)
    extra = {key: raw[key] for key in KEYS if key in raw}
    if tolerance is not None and tolerance.zone is not None:
        extra = {**stated(tolerance, unit(name)), **extra}
    return TypedQuantity(value, typed.unit, typed.si, extra, tolerance)


def _read_list(raw: list[Any], declared: str) -> TypedQuantity:
    if raw and all(isinstance(item, (str, dict)) for item in raw):
        return _read_each(raw, declared)
    if declared != "1" and raw:
        raise FaultyText("missing_unit", f'the unit is missing; write {{"value": […], "unit": "{declared}"}}')
    return _quantity(_array(raw), "1", declared)


def _read_each(raw: list[Any], declared: str) -> TypedQuantity:
    """Return a list of quantities in the declared unit; each may be typed in its own unit."""
    parts = [read(item, declared) for item in raw]
    if len({np.shape(part.si) for part in parts}) > 1:
        raise FaultyText(
            "uneven", "the items of an array must have the same length; give each a single value"
        )
    si = np.array([part.si for part in parts], dtype=float)
    tolerance = joined([part.tolerance for part in parts])
    return TypedQuantity(np.asarray(unit(declared).from_si(si)).tolist(), declared, si, {}, tolerance)


def _read_bare(raw: float, declared: str) -> TypedQuantity:
    number = _number(raw)
    if declared != "1":
        raise FaultyText("missing_unit", f'{number:.15g} has no unit; write it as "{number:.15g} {declared}"')
    return _quantity(number, "1", declared)


def _quantity(magnitude: Value, name: str, declared: str) -> TypedQuantity:
    si = _in_si(magnitude, require_same_kind(name, declared))
    if not (math.isfinite(si) if isinstance(si, float) else np.isfinite(si).all()):
        raise FaultyText(
            "not_finite", f"the value is too large in {name}; give one below 1.8e308 in SI units"
        )
    shown = magnitude.tolist() if isinstance(magnitude, np.ndarray) else magnitude
    return TypedQuantity(shown, name, si, {})


def _in_si(magnitude: Value, scale: Unit) -> Value:
    if isinstance(magnitude, float):
        return scale.to_si(magnitude)
    with np.errstate(over="ignore"):
        return scale.to_si(magnitude)


def _number(raw: Any) -> float:
    if isinstance(raw, bool) or not isinstance(raw, (int, float)):
        raise FaultyText(
            "not_a_number", f"{excerpt(raw)} is not a number; write it like `1.5`, without quotes"
        )
    try:
        return _finite(float(raw))
    except OverflowError:
        return _finite(math.inf)


def _finite(number: float) -> float:
    if not math.isfinite(number):
        raise FaultyText("not_finite", "the value must be finite: not NaN, infinity or above 1.8e308")
    return number


def _array(raw: Sequence[Any]) -> Array:
    """Return an evenly nested list of numbers as an array; `true` and texts do not count as numbers."""
    flat, shape = list(raw), [len(raw)]
    while flat and isinstance(flat[0], (list, tuple)) and len(shape) < _DEEPEST:
        shape.append(len(flat[0]))
        flat = _joined(flat, shape[-1])
    if not flat:
        raise FaultyText("empty", "an array needs at least one value")
    if not set(map(type, flat)) <= {int, float}:
        raise FaultyText("not_a_number", "every item of an array must be a number")
    try:
        array = np.array(flat, dtype=float).reshape(shape)
    except OverflowError:
        array = np.array(np.inf)
    if not np.isfinite(array).all():
        raise FaultyText(
            "not_finite", "every item of an array must be finite: not NaN, infinity or above 1.8e308"
        )
    return array


def _joined(rows: Sequence[Any], length: int) -> list[Any]:
    """Return the items of all rows, which must be lists of equal length."""
    if not all(isinstance(row, (list, tuple)) and len(row) == length for row in rows):
        raise FaultyText("uneven", "the rows of an array must have the same length")
    return [item for row in rows for item in row]


def _no_quantity(raw: Any, declared: str) -> FaultyText:
    form = '"1.5"' if declared == "1" else f'"1.5 {declared}"'
    hint = ""
    if isinstance(raw, str) and _GRADE.match(raw):
        hint = "; a grade of oil is given as oil_grade, where there is such an input"
    return FaultyText("not_a_quantity", f"{excerpt(raw)} is not a quantity; write it as {form}{hint}")
