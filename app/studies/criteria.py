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
    """Return a criterion from the design, else from the template of its step."""
    return subjects(engine.graph)[name].criterion


JUDGED = "judged/"
SIDES = ("value", "limit", "low", "high", "is_known")
"""The values of a criterion that a search needs, in arrays `judged/<criterion>/<side>`; 1 is known."""


def judged_of(engine: DesignEngine, name: str, table: Table) -> dict[str, AnyArray]:
    """Return the value, limit and margins [SI] of a criterion over the rows; at least zero is safe."""
    column, codes = table.judged[name], np.asarray(table.verdicts[name])
    sign = 1.0 if criterion_of(engine, name).sign == ">=" else -1.0
    ends = sign * (column.low - column.limit), sign * (column.high - column.limit)
    margin = sign * (column.value - column.limit)
    # The verdict knows the band of the limit as well: where that leaves it open, the bad end is not safe.
    low = np.where(~is_met(codes) & (np.minimum(*ends) >= 0), -np.abs(margin), np.minimum(*ends))
    sides = (column.value, column.limit, low, np.maximum(*ends), codes != MET_ERROR_UNKNOWN)
    pairs = zip(SIDES, sides, strict=True)
    return {f"{JUDGED}{name}/{side}": _spread(values, table.count) for side, values in pairs}


def _spread(values: Array, count: int) -> Array:
    return np.broadcast_to(np.asarray(values, dtype=np.float64), (count,))
