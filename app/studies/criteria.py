"""The criteria of a design by name: those of its templates, and its own."""

from __future__ import annotations

import numpy as np

from app.designs.engine.design_engine import DesignEngine, Table
from app.designs.network import subjects
from app.studies.archive import AnyArray
from templates.core.arrays import Array
from templates.core.criteria.comparison import MET_ERROR_UNKNOWN, is_met
from templates.core.criteria.criterion import Criterion


def criterion_of(engine: DesignEngine, name: str) -> Criterion:
    """Return the criterion with this name, from the design or from the template of a step."""
    return subjects(engine.graph)[name].criterion


JUDGED = "judged/"
SIDES = ("value", "limit", "low", "high", "is_known")
"""The numbers of a criterion for a search, in arrays `judged/<criterion>/<side>`; `is_known` is 0 or 1."""


def judged_of(engine: DesignEngine, name: str, table: Table) -> dict[str, AnyArray]:
    """Return value, limit and margins [SI] of a criterion for all rows; a margin of zero or more is safe."""
    column, codes = table.judged[name], np.asarray(table.verdicts[name])
    sign = 1.0 if criterion_of(engine, name).sign == ">=" else -1.0
    ends = sign * (column.low - column.limit), sign * (column.high - column.limit)
    margin = sign * (column.value - column.limit)
    # The verdict also includes the band of the limit. If it is not "met", the bad end must be negative.
    low = np.where(~is_met(codes) & (np.minimum(*ends) >= 0), -np.abs(margin), np.minimum(*ends))
    sides = (column.value, column.limit, low, np.maximum(*ends), codes != MET_ERROR_UNKNOWN)
    pairs = zip(SIDES, sides, strict=True)
    return {f"{JUDGED}{name}/{side}": _spread(values, table.count) for side, values in pairs}


def _spread(values: Array, count: int) -> Array:
    return np.broadcast_to(np.asarray(values, dtype=np.float64), (count,))
