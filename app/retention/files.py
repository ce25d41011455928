"""Files of the store that no row refers to: left over by deleted builds, or by a server that was killed."""

from __future__ import annotations

from collections.abc import Callable

from app.retention.rows import referenced_files
from app.storage.artifacts import ArtifactStore, Stored
from app.storage.database import Database


class Sweep:
    """Deletes files that two sweeps in succession saw without a reference.

    A file is stored before its row is written. The time between two sweeps is the grace for that, and for a
    backup that copies the rows first. `put` touches a file that is there already, so to the sweep a file that
    is wanted again is another one, whatever the wall clock says.
    """

    def __init__(self, database: Database, store: ArtifactStore) -> None:
        self._database, self._store = database, store
        self._seen: set[Stored] = set()  # by the last sweep, without a reference

    def run(self, is_stopping: Callable[[], bool] = lambda: False) -> int:
        """Sweep once; return how many files were deleted."""
        files = set(self._store.list())  # before the rows: a file that is put meanwhile is not looked at
        with self._database.read() as session:
            referenced = referenced_files(session)
        unused = {file for file in files if file.sha not in referenced}
        twice, self._seen = unused & self._seen, unused
        return sum(self._store.delete_unchanged(file) for file in twice if not is_stopping())
