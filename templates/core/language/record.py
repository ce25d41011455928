"""Store the single SI values of an evaluated template as JSON, and restore the template without calculating.

With such a record, the formulas of an answer can be printed again in any system of units. Arrays are not
stored, because their numbers are not printed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from templates.core.language.ledger import Ledger
from templates.core.language.spec import Given, Table

if TYPE_CHECKING:
    from templates.core.language.template import Template

Recorded = float | str | list[None] | None
"""A single value [SI] or a word; null for a missing value; an empty list in place of an array."""


@dataclass(frozen=True)
class Record:
    """Values by attribute: those from which the template was created, and those that it computed."""

    taken: dict[str, Recorded] = field(default_factory=dict)
    computed: dict[str, Recorded] = field(default_factory=dict)

    @property
    def has_arrays(self) -> bool:
        """Return whether the record omits an array or a table."""
        return any(isinstance(value, list) for value in (*self.taken.values(), *self.computed.values()))


def record(template: Template) -> Record:
    """Return a record of every declared value that the template has calculated so far."""
    record = Record()
    declared, handed = template.declarations, template.ledger.handed
    for attribute, value in vars(template).items():
        if attribute in declared:
            values = record.taken if attribute in handed else record.computed
            if isinstance(value, float):
                values[attribute] = float(value) if math.isfinite(value) else None
            elif isinstance(value, str):
                values[attribute] = value
            else:
                values[attribute] = None if np.size(value) == 0 else []  # an empty table counts as missing
    return record


def restored(cls: type[Template], record: Record, level: str | None) -> Template:
    """Return a template with the values of a record, at the level at which they were calculated."""
    taken, computed = _values(cls, record.taken), _values(cls, record.computed)
    optional = (d for d in cls.inputs.values() if isinstance(d, Given) and d.optional and not d.alternative)
    missing = {d.attribute for d in optional if record.taken.get(d.attribute, 0.0) is None}
    template = cls(taken, Ledger(missing=missing))
    vars(template).update(computed, **({"level": level} if level else {}))
    return template


def _values(cls: type[Template], recorded: Mapping[str, Recorded]) -> dict[str, object]:
    return {attribute: _value(cls, attribute, value) for attribute, value in recorded.items()}


def _value(cls: type[Template], attribute: str, recorded: Recorded) -> object:
    if isinstance(recorded, list):
        return np.empty(0)
    if recorded is None:
        return () if isinstance(cls.declarations.get(attribute), Table) else np.float64(np.nan)
    return recorded if isinstance(recorded, str) else np.float64(recorded)
