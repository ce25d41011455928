"""Compare two stored values: decide whether they differ and by how much, and shorten them for display."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from app.designs.schemas.comparison import ComparedValue, TextChange, ValueDifference
from app.plain import Json, JsonObject
from app.schemas.answers import Quantity
from templates.core.errors import FaultyText
from templates.core.units.tolerance import KEYS
from templates.core.units.units import Unit, unit

MOST_SHOWN = 20  # a longer array is shown by its range
SAME = 1e-12  # relative: smaller differences come from conversion between units
PARTS = ("value", "unit", "reason", *KEYS)

Numbers = NDArray[np.float64]


def differing(old: Mapping[str, Json], new: Mapping[str, Json]) -> list[ValueDifference]:
    """Return the differences of all quantities that are not equal, in the order of the newer revision."""
    names = dict.fromkeys([*new, *old])
    pairs = ((name, old.get(name), new.get(name)) for name in names)
    return [_compared(*pair) for pair in pairs if not _is_same(pair[1], pair[2])]


def differing_texts(old: Mapping[str, str], new: Mapping[str, str]) -> list[TextChange]:
    """Return the differences of all texts that are not equal, in the order of the newer revision."""
    names = dict.fromkeys([*new, *old])
    changes = (TextChange(name=name, old=old.get(name), new=new.get(name)) for name in names)
    return [change for change in changes if change.old != change.new]


def leaves(tree: Mapping[str, Json], prefix: str) -> Iterator[tuple[str, Json]]:
    """Yield the quantities in a nested mapping, with their dotted names."""
    for name, part in tree.items():
        if isinstance(part, Mapping) and "value" not in part:
            yield from leaves(part, f"{prefix}.{name}")
        elif part is not None:
            yield f"{prefix}.{name}", part


def _is_same(old: Json, new: Json) -> bool:
    one, other = _parts(old), _parts(new)
    if one == other:
        return True
    values, others = _numbers(one), _numbers(other)
    if values is None or others is None or not _is_same_kind(one, other):
        return False
    rest, more = ({n: v for n, v in parts.items() if n in PARTS[3:]} for parts in (one, other))
    return rest == more and values.shape == others.shape and _close(values, others)


def _close(one: Numbers, other: Numbers) -> bool:
    return np.allclose(one, other, rtol=SAME, atol=0, equal_nan=True)


def _parts(raw: Json) -> JsonObject:
    """Return the parts of a stored value, such as `value` and `unit`.

    A value that is not an object, such as a typed text, has the single part `value`.
    """
    if isinstance(raw, Mapping):
        return {name: raw[name] for name in PARTS if raw.get(name) is not None}
    return {} if raw is None else {"value": raw}


def _unit_of(parts: JsonObject) -> Unit | None:
    try:
        return unit(parts["unit"]) if isinstance(parts.get("unit"), str) else None
    except FaultyText:  # a unit that only an older program knew
        return None


def _is_same_kind(one: JsonObject, other: JsonObject) -> bool:
    first, second = _unit_of(one), _unit_of(other)
    return first is not None and second is not None and first.base == second.base


def _numbers(parts: JsonObject) -> Numbers | None:
    """Return the magnitudes in SI; None for a text, or for a value without a unit."""
    scale = _unit_of(parts)
    if scale is None or isinstance(parts.get("value"), (str, bool)):
        return None
    try:
        return np.asarray(scale.to_si(np.asarray(parts.get("value"), dtype=float)))
    except (TypeError, ValueError):  # a list of unequal lists
        return None


def _compared(name: str, old: Json, new: Json) -> ValueDifference:
    one, other = _parts(old), _parts(new)
    sides: JsonObject = {"name": name, "old": _shown(one), "new": _shown(other)}
    before, after = _numbers(one), _numbers(other)
    if before is None or after is None or before.shape != after.shape or not _is_same_kind(one, other):
        return ValueDifference(**sides)
    change, difference = _change(one, other, before, after), _difference(other, before, after)
    more = {"change": change, "difference": difference}
    return ValueDifference(**sides, **{key: value for key, value in more.items() if value is not None})


def _change(one: JsonObject, other: JsonObject, before: Numbers, after: Numbers) -> float | None:
    """Return the largest relative change; None for temperatures, whose zero is arbitrary."""
    if _is_temperature(one) or _is_temperature(other):
        return None
    scale = _largest(before)
    if not before.size or not np.isfinite(scale) or scale == 0:
        return None
    steps = after - before
    step = steps.flat[np.argmax(np.where(np.isfinite(steps), np.abs(steps), -1.0))]
    return float(step / scale) if np.isfinite(step) else None


def _largest(values: Numbers) -> float:
    finite = np.abs(values[np.isfinite(values)])
    return float(finite.max()) if finite.size else 0.0


def _difference(other: JsonObject, before: Numbers, after: Numbers) -> Quantity | None:
    scale = _unit_of(other)
    if before.shape or scale is None or not np.isfinite(step := float(after - before)):
        return None
    if _is_temperature(other):
        return Quantity(value=step, unit="delta_degC")
    return Quantity(value=step / scale.factor, unit=scale.text)


def _is_temperature(parts: JsonObject) -> bool:
    scale = _unit_of(parts)
    return scale is not None and (scale.absolute or (scale.text == "K" and not scale.difference))


def _shown(parts: JsonObject) -> ComparedValue | None:
    if not parts:
        return None
    kept = {name: parts[name] for name in ("value", "unit", "reason") if name in parts}
    if (count := _count(parts.get("value"))) <= MOST_SHOWN:
        return ComparedValue(**{"value": None, **kept})
    numbers = np.asarray(parts["value"], dtype=float) if _numbers(parts) is not None else None
    ends = {} if numbers is None else _range(numbers)
    rest = {name: part for name, part in kept.items() if name != "value"}
    return ComparedValue(**rest, count=count, **ends)


def _range(numbers: Numbers) -> dict[str, float]:
    finite = numbers[np.isfinite(numbers)]
    return {"least": float(finite.min()), "largest": float(finite.max())} if finite.size else {}


def _count(value: object) -> int:
    """Return the number of single values in nested lists."""
    return sum(map(_count, value)) if isinstance(value, list) else 1
