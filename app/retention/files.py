"""Delete files of the store that no row names, left over from deleted builds or from a killed server."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable

from app.retention.rows import referenced_files
from app.storage.artifacts import Artifacts, StoredFile
from app.storage.copies_of_databases import require_only_copy
from app.storage.database import Database
from app.storage.locks import alone

GRACE = 24 * 3600.0  # s


class Sweep:
    """Deletes files that no row has named for some time.

    A file is stored before its row is written, and a backup copies rows before files; both take less than
    that time. `put` renews the age of an existing file.

    A single server compares two successive sweeps, so its wall clock does not matter. If several servers
    share a database, one sweeps at a time and none sees all sweeps, so they use the age of the file. `grace`
    [s] is long compared with the differences of their clocks; S3 refuses requests from a clock that is 15
    min wrong.
    """

    def __init__(self, database: Database, store: Artifacts, grace: float = GRACE) -> None:
        self._database, self._store, self._grace = database, store, grace
        self._seen: set[StoredFile] = set()  # files that the last sweep found without a reference

    def run(self, is_stopping: Callable[[], bool] = lambda: False) -> int:
        """Sweep once, unless another server does; return how many files were deleted.

        Raises
        ------
        DatabaseCopied
            If a copy of the database uses the same store.
        """
        with alone(self._database, "sweep of files") as is_alone:
            if not is_alone:
                return 0
            if self._store.is_shared:
                require_only_copy(self._database, self._store)
            return self._swept(is_stopping)

    def _swept(self, is_stopping: Callable[[], bool]) -> int:
        files = set(self._store.list())  # before the rows, so that files stored meanwhile are not considered
        with self._database.read() as session:
            referenced = referenced_files(session)
        unused = {file for file in files if file.sha not in referenced or self._is_spare(file)}
        return sum(self._store.delete_unchanged(file) for file in self._old(unused) if not is_stopping())

    def _is_spare(self, file: StoredFile) -> bool:
        """Return whether a discarded file is in its place again; the store restores it if necessary."""
        return file.is_discarded and self._store.exists(file.sha)

    def _old(self, unused: set[StoredFile]) -> Iterable[StoredFile]:
        if self._database.is_shared:
            latest = time.time() - self._grace
            return [file for file in unused if file.modified < latest]
        twice, self._seen = unused & self._seen, unused
        return twice
