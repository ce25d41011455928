"""The calculated rows of a study, read from its chunks column by column."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from app.storage.artifacts import Artifacts
from app.storage.tables import StudyChunkRow
from app.studies.archive import AnyArray, Archive
from templates.core.arrays import Array, Integers, Mask
from templates.core.criteria.comparison import MET, NOT_CHECKED

PLACE, OUTPUT, ERROR, VERDICT = "place/", "output/", "error/", "verdict/"
"""Prefixes of the names of the arrays of a chunk."""
EXPLORE, CONFIRM = 0, 1
"""Places in the list of levels of a search; those of its trade follow."""


@dataclass(frozen=True)
class Part:
    """A chunk: the number of its first row, and how many it has."""

    first: int
    count: int
    sha: str


class StoredRows:
    """The rows of a study in the order of its chunks; a column is read when it is asked for."""

    def __init__(self, store: Artifacts, chunks: Sequence[StudyChunkRow]) -> None:
        self._store = store
        starts = np.cumsum([0, *(chunk.rows for chunk in chunks)]).tolist()
        self.parts = [
            Part(start, chunk.rows, chunk.sha256) for start, chunk in zip(starts, chunks, strict=False)
        ]
        self.count: int = starts[-1]

    def archive(self, part: Part) -> Archive:
        """Return the arrays of a chunk; raises ArtifactMissing, ArtifactDamaged."""
        return Archive(self._store.open(part.sha).file)

    def verify(self) -> None:
        """Look at every chunk; raises ArtifactMissing, ArtifactDamaged."""
        for part in self.parts:
            self._store.open(part.sha).file.close()

    def values(self, name: str) -> Array:
        """Return a column of numbers [SI], NaN where a chunk has none."""
        return np.concatenate([np.empty(0), *self._each(name, np.nan)]).astype(np.float64)

    def codes(self, criterion: str) -> AnyArray:
        """Return the verdicts on a criterion, as places in `VERDICTS`."""
        return np.concatenate([np.empty(0, np.int8), *self._each(f"{VERDICT}{criterion}", NOT_CHECKED)])

    def worst(self, criteria: Sequence[str]) -> AnyArray:
        """Return the worst verdict of each row on these criteria.

        Met, if there are none and the row has values.
        """
        worst = np.where(self.is_refused, NOT_CHECKED, MET).astype(np.int8)
        for criterion in criteria:
            worst = np.minimum(worst, self.codes(criterion))
        return worst

    @cached_property
    def is_refused(self) -> Mask:
        """Return a mask of the rows that have a reason instead of values."""
        reasons = [reason.astype(np.int32) for reason in self._each("reason", -1)]
        return np.concatenate([np.empty(0, np.int32), *reasons]) >= 0

    def rows(self, names: Sequence[str], numbers: Integers) -> Array:
        """Return some rows of some columns [SI], shape (len(numbers), len(names))."""
        columns = [self.values(name)[numbers] for name in names]
        return np.stack(columns, axis=-1) if columns else np.empty((len(numbers), 0))

    def _each(self, name: str, missing: float) -> Iterator[AnyArray]:
        for part in self.parts:
            with self.archive(part) as archive:
                yield archive[name] if name in archive else np.full(part.count, missing)
