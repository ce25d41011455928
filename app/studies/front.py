"""The best row and the Pareto front of the calculated rows."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.studies.archive import AnyArray
from templates.core.arrays import Array, Integers, Mask
from templates.core.criteria.comparison import UNDECIDED, is_met

MOST_CONFIRMED = 64  # rows that are calculated again for one objective
MOST_FRONT = 200


def ranked(objective: Array, worst: AnyArray, most: int, *, undecided: bool = False) -> Integers:
    """Return the rows of least objective among those that meet all criteria, the best first.

    With `undecided`, rows whose limits lie within the error of their level are among them.
    """
    usable = np.isfinite(objective) & _may_be_met(worst, undecided=undecided)
    rows = np.flatnonzero(usable)
    return rows[np.argsort(objective[rows], kind="stable")[:most]]


def front(objectives: Array, worst: AnyArray, *, undecided: bool = False) -> Integers:
    """Return the rows that no other one equals or betters in all objectives, shape (N, k).

    At most `MOST_FRONT`.

    They are in the order of the first objective; of more, those are kept that are spread evenly over it.
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
    """Return a mask of the rows that no earlier row dominates; rows are sorted by their columns.

    Only rows that are kept are compared with, so that the cost is that of rows times front.
    """
    kept = np.zeros(len(sorted_rows), dtype=bool)
    members: Array = np.empty((0, sorted_rows.shape[1]))
    for number, row in enumerate(sorted_rows):
        if not len(members) or not (members <= row).all(axis=1).any():
            kept[number] = True
            members = np.vstack([members, row])
    return kept


def signed(columns: Array, maximised: Sequence[bool]) -> Array:
    """Return objectives with their sign changed where they are maximised."""
    return columns * np.where(maximised, -1.0, 1.0)
