"""Evaluations as the REST interface shows them: plain JSON values, never NaN."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from templates.core.catalogue.digests import content_digest, digest
from templates.core.language.evaluate import Answer, Echo, Evaluation
from templates.core.language.template import Template

_identities: dict[Any, dict[str, Any]] = {}


def identity(cls: type[Template]) -> dict[str, Any]:
    """Which version calculated: id, version and both digests of its code."""
    if cls not in _identities:
        codes = {"digest": digest(cls), "content_digest": content_digest(cls)}
        _identities[cls] = {"id": cls.id, "version": cls.version, **codes}
    return dict(_identities[cls])


def quantity(value: Any, unit: str | None) -> dict[str, Any]:
    """A value with its unit; a text has none."""
    return {"value": value} if unit is None else {"value": value, "unit": unit}


def answer(result: Answer) -> dict[str, Any]:
    """An output; what does not exist is null with its reason."""
    if not isinstance(result.value, np.ndarray):
        unit = {} if result.unit is None else {"unit": result.unit}
        reason = {} if result.reason is None else {"reason": result.reason}
        return {"value": None if reason else result.value, **unit, **reason}
    if result.reasons is None:
        return quantity(result.value.tolist(), result.unit)
    holes = _with_holes(result.value, result.reasons)
    return {**quantity(holes.tolist(), result.unit), "reasons": result.reasons.tolist()}


def _with_holes(value: NDArray[np.float64], reasons: NDArray[np.object_]) -> NDArray[np.object_]:
    """The values as objects, None where there is none; a profile, which has one reason, is one object."""
    if value.ndim == reasons.ndim:
        holes = value.astype(object)
        holes[reasons != None] = None  # noqa: E711
        return holes
    rows = np.empty(reasons.shape, dtype=object)
    for point in np.ndindex(reasons.shape):
        rows[point] = None if reasons[point] else value[point].tolist()
    return rows


def _plain(value: Any) -> Any:
    """A single value or an array as JSON; what was not measured is null."""
    if not isinstance(value, np.ndarray):
        return None if value != value else value  # NaN
    if value.ndim == 1:
        return [None if item != item else item for item in value.tolist()]
    return [_plain(row) for row in value]


def _errors(errors: Mapping[str, Any]) -> dict[str, Any]:
    """The error of each output as JSON."""
    return {
        name: _plain(error) if isinstance(error, np.ndarray) else None if error != error else error
        for name, error in errors.items()
    }


def echo(used: Echo) -> dict[str, Any]:
    """An input as it was used."""
    unit = {} if used.unit is None else {"unit": used.unit}
    return {"value": used.value, **unit, "from": used.source, **used.extra}


def evaluation(made: Evaluation) -> dict[str, Any]:
    """The whole answer to `evaluate`."""
    return {
        "template": identity(type(made.template)),
        "inputs": {name: echo(used) for name, used in made.inputs.items()},
        "outputs": {name: answer(result) for name, result in made.outputs.items()},
        "level": _plain(made.level),
        "error": _errors(made.error),
        "warnings": [{"code": w.code, "name": w.name, "detail": w.detail} for w in made.warnings],
        "seconds": made.seconds,
    }
