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
"""Indices into the levels of a search; the levels that are only compared follow."""


@dataclass(frozen=True)
class Part:
    """A chunk: the number of its first row, and its number of rows."""

    first: int
    count: int
    sha: str


class StoredRows:
    """The rows of a study in the order of its chunks; a column is read on request."""

    def __init__(self, store: Artifacts, chunks: Sequence[StudyChunkRow]) -> None:
        self._store = store
        starts = np.cumsum([0, *(chunk.rows for chunk in chunks)]).tolist()
        self.parts = [
            Part(start, chunk.rows, chunk.sha256) for start, chunk in zip(starts, chunks, strict=False)
        ]
        self.count: int = starts[-1]

    def archive(self, part: Part) -> Archive:
        """Return the arrays of a chunk; raise ArtifactMissing or ArtifactDamaged if it cannot be read."""
        return Archive(self._store.open(part.sha).file)

    def verify(self) -> None:
        """Check every chunk; raise ArtifactMissing or ArtifactDamaged for an invalid one."""
        for part in self.parts:
            self._store.open(part.sha).file.close()

    def values(self, name: str) -> Array:
        """Return a column of numbers [SI], with NaN for chunks that lack it."""
        return np.concatenate([np.empty(0), *self._each(name, np.nan)]).astype(np.float64)

    def codes(self, criterion: str) -> AnyArray:
        """Return the verdict on a criterion in each row, as an index into `VERDICTS`."""
        return np.concatenate([np.empty(0, np.int8), *self._each(f"{VERDICT}{criterion}", NOT_CHECKED)])

    def worst(self, criteria: Sequence[str]) -> AnyArray:
        """Return the worst verdict of each row on these criteria.

        Without criteria the verdict is "met" for every row that has values.
        """
        worst = np.where(self.is_refused, NOT_CHECKED, MET).astype(np.int8)
        for criterion in criteria:
            worst = np.minimum(worst, self.codes(criterion))
        return worst

    @cached_property
    def is_refused(self) -> Mask:
        """Return a mask of the refused rows, which have a reason instead of values."""
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
