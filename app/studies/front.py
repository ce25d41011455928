"""Find the best row and the Pareto front among the calculated rows."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.studies.archive import AnyArray
from templates.core.arrays import Array, Integers, Mask
from templates.core.criteria.comparison import UNDECIDED, is_met

MOST_CONFIRMED = 64  # largest number of rows that are recalculated for one objective
MOST_FRONT = 200


def ranked(objective: Array, worst: AnyArray, most: int, *, undecided: bool = False) -> Integers:
    """Return the rows with the smallest objectives among those that meet all criteria, best first.

    With `undecided`, rows whose limits lie within the error of their level are included.
    """
    usable = np.isfinite(objective) & _may_be_met(worst, undecided=undecided)
    rows = np.flatnonzero(usable)
    return rows[np.argsort(objective[rows], kind="stable")[:most]]


def front(objectives: Array, worst: AnyArray, *, undecided: bool = False) -> Integers:
    """Return the rows that no other row equals or betters in all objectives, shape (N, k).

    The rows are ordered by the first objective, then by the others. If there are more than `MOST_FRONT`, an
    evenly spaced selection is returned.
    """
    usable = np.isfinite(objectives).all(axis=1) & _may_be_met(worst, undecided=undecided)
    rows = np.flatnonzero(usable)
    order = rows[np.lexsort(objectives[rows].T[::-1])]
    kept = order[_undominated(objectives[order])]
    if len(kept) > MOST_FRONT:
        kept = kept[np.unique(np.linspace(0, len(kept) - 1, MOST_FRONT).astype(int))]
    return kept


def _may_be_met(worst: AnyArray, *, undecided: bool) -> Mask:
    mask: Mask = is_met(worst) | ((worst == UNDECIDED) & undecided)
    return mask


def _undominated(sorted_rows: Array) -> Mask:
    """Return a mask of the rows that no earlier row dominates; the rows must be sorted.

    Each row is compared with the kept rows only, so the cost is rows times front.
    """
    kept = np.zeros(len(sorted_rows), dtype=bool)
    members: Array = np.empty((0, sorted_rows.shape[1]))
    for number, row in enumerate(sorted_rows):
        if not len(members) or not (members <= row).all(axis=1).any():
            kept[number] = True
            members = np.vstack([members, row])
    return kept


def signed(columns: Array, maximised: Sequence[bool]) -> Array:
    """Return objectives with the sign changed for those that are maximised."""
    return columns * np.where(maximised, -1.0, 1.0)
