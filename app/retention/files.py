"""Files of the store that no row refers to: left over by deleted builds, or by a server that was killed."""

from __future__ import annotations

from collections.abc import Callable

from app.retention.rows import referenced_files
from app.storage.artifacts import ArtifactStore
from app.storage.database import Database


class Sweep:
    """Deletes files that two sweeps in succession saw without a reference.

    A file is stored before its row is written. The time between two sweeps is the grace for that, and for a
    backup that copies the rows first. `put` touches a file that is there already, so to the sweep a file that
    is wanted again is another one, whatever the wall clock says.
    """

    def __init__(self, database: Database, store: ArtifactStore) -> None:
        self._database, self._store = database, store
        self._seen: dict[
            str, int
        ] = {}  # what the last sweep saw without a reference, and when it was touched

    def run(self, is_stopping: Callable[[], bool] = lambda: False) -> int:
        """Sweep once; return how many files were deleted."""
        files = {file.sha: file.touched for file in self._store.list()}  # before the rows: a new file has one
        with self._database.read() as session:
            referenced = referenced_files(session)
        unused = {sha: touched for sha, touched in files.items() if sha not in referenced}
        count = 0
        for sha in unused.keys() & self._seen.keys():
            if is_stopping():
                break
            count += self._seen[sha] == unused[sha] and self._store.delete(sha, unused[sha])
        self._seen = unused
        return count
