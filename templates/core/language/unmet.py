"""The warning `tolerance_unmet`: errors that exceed the requested tolerance, or are unknown."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from templates.core.arrays import Array
from templates.core.errors import listed
from templates.core.language.ledger import Notice
from templates.core.language.levels import accuracy
from templates.core.language.spec import Formula, Profile, Text
from templates.core.language.template import Template

CODE = "tolerance_unmet"


def unmet(
    cls: type[Template], values: Mapping[str, Any], errors: Mapping[str, Any], level: Any, tolerance: float
) -> list[Notice]:
    """Return a warning for each output with too large an error, and one for all with an unknown error.

    `values` and `errors` are those of the answer, with None or NaN for missing ones; an output without a
    value needs no error.
    """
    if accuracy(cls) is None:
        detail = f"the error of {cls.id} version {cls.version} is not measured; no level is known to meet it"
        return [Notice(CODE, "tolerance", detail)]
    numbers = [name for name in values if not isinstance(cls.formulas[name], Text)]
    by_output = {name: _of_values(cls.formulas[name], values[name], errors[name]) for name in numbers}
    unknown = [name for name, error in by_output.items() if np.isnan(error).any()]
    large = {n: float(np.nanmax(e)) for n, e in by_output.items() if np.any(e > tolerance)}
    return [*_unstated(unknown, level), *(Notice(CODE, n, _beyond(n, error)) for n, error in large.items())]


def _of_values(formula: Formula[Any], value: Any, error: Any) -> Array:
    """Return the errors of the points that have a value, as a one-dimensional array."""
    if value is None:
        return np.empty(0)
    there = ~np.isnan(value)
    there = np.asarray(formula.inside(there) if isinstance(formula, Profile) else there)
    return np.broadcast_to(error, there.shape)[there]


def _unstated(names: list[str], level: Any) -> Iterator[Notice]:
    if names:
        at = f" at level {level}" if isinstance(level, str) else ""
        detail = f"no error of {listed(names)} is stated{at}, so no level is known to be within the tolerance"
        yield Notice(CODE, names[0] if len(names) == 1 else "tolerance", detail)


def _beyond(name: str, error: float) -> str:
    beyond = f"{name} may be off by {error:.2g}, which is more than the tolerance"
    return f"{beyond}; no level within the budget is known to be nearer"
