"""Check results against their bounds: refuse a point, mask points of an array, or note a warning."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from templates.core.arrays import Array
from templates.core.errors import Fault, InvalidInputs
from templates.core.language.calculation import Calculation
from templates.core.language.ledger import Mask, Notice
from templates.core.language.spec import Declaration, Formula, Profile


def absence(self: Calculation, declaration: Formula[Any]) -> str | None:
    """Return the reason why a result may be NaN without being a fault, or None.

    Either an optional input is missing, or the result does not exist in this case.
    """
    missing = sorted(self.ledger.missing & self.ancestors(declaration.attribute))
    if missing:
        return f"needs {', '.join(self.declarations[name].name for name in missing)}"
    return declaration.meaning.absent or _explained(self, declaration)


def _explained(self: Calculation, declaration: Formula[Any]) -> str | None:
    """Return the reason noted by a formula on which this one depends, if its result exists nowhere."""
    explaining = [mask for mask in self.ledger.masks if mask.explains and mask.where.all()]
    if not explaining:
        return None
    beneath = self.ancestors(declaration.attribute)
    return next((mask.reason for mask in explaining if not beneath.isdisjoint(mask.names)), None)


def refusal(self: Calculation, declaration: Formula[Any], value: float) -> Fault:
    """Return a fault for a formula's result outside its domain; it names the inputs behind that result."""
    meaning = declaration.meaning.at(self.level)
    beneath = sorted(self.depends_on(declaration.attribute) & self.declarations.keys())
    used = (self.declarations[n].name for n in beneath)
    inputs = ", ".join(name for name in used if name in self.inputs) or "constants alone"
    if np.isfinite(value):
        what = f"would be {meaning.with_unit(value)}; it must be {meaning.wanted}"
    else:
        what = "has no finite value here"
    remedy = f"; {meaning.remedy}" if meaning.remedy else ""
    detail = f"{meaning.words} {what}{remedy} (it follows from {inputs})"
    return Fault(declaration.name, "outside_domain", detail)


def whole(self: Calculation, declaration: Formula[Any], value: Array) -> Array:
    """Return the profile of a single point.

    The profile is refused unless all its values are valid or its absence has a reason.
    """
    inside = declaration.meaning.at(self.level).admits(value)
    if not inside.all():
        why = absence(self, declaration) if np.isnan(value).any() else None
        if why is None:
            raise InvalidInputs([refusal(self, declaration, value[~inside][0])])
        self.ledger.absent[declaration.attribute] = why
    return value


def masked(self: Calculation, declaration: Formula[Any], value: Array) -> Array:
    """Return the results with NaN at invalid points, and note the reason.

    A profile is masked as a whole.
    """
    meaning = declaration.meaning.at(self.level)
    inside = meaning.admits(value)
    if inside.all():
        return value
    present = ~np.isnan(value)
    if isinstance(declaration, Profile):
        inside, present = declaration.inside(inside), declaration.inside(present)
    if (present & ~inside).any():
        remedy = f"; {meaning.remedy}" if meaning.remedy else ""
        reason = f"{declaration.name} must be {meaning.wanted}{remedy}"
        self.ledger.masks.append(Mask((declaration.attribute,), present & ~inside, reason))
    if not present.all() and (why := absence(self, declaration)):
        self.ledger.masks.append(Mask((declaration.attribute,), ~present, why, explains=True))
    return np.where(declaration.spread(inside) if isinstance(declaration, Profile) else inside, value, np.nan)


def outside_published(declaration: Declaration, value: Any, level: str = "") -> Notice | None:
    """Return a warning with the limit if a value leaves its published range, otherwise None."""
    meaning = declaration.meaning.at(level)
    if meaning.published_si is None:
        return None
    if isinstance(value, float) and (math.isnan(value) or meaning.published_si.admits(value)):
        return None
    outside = ~np.isnan(value) & ~np.asarray(meaning.published_si.admits(value))
    if not outside.any():
        return None
    if np.ndim(value):
        where = f"leaves it at {int(outside.sum())} of {outside.size} points"
    else:
        where = f"is {meaning.with_unit(value)}"
    source = f" ({meaning.source})" if meaning.source else ""
    remedy = f"; {meaning.remedy}" if meaning.remedy and meaning.domain.open else ""
    limits = meaning.published.text(meaning.unit)
    detail = f"published for {meaning.words} {limits}{source}; here it {where}{remedy}"
    return Notice("outside_published_range", declaration.name, detail)
