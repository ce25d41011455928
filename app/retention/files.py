"""Files of the store that no row refers to: left over from deleted builds or from a killed server."""

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
    """Deletes files that nothing has referred to for a while.

    A file is stored before its row is written, and a backup copies rows before files: both take less than
    that while. `put` makes a file that is there already as young as a new one.

    The only server of a database compares two sweeps in succession, whatever the wall clock says. Of several,
    one sweeps at a time, and no one sees all sweeps: they go by the age of the file. `grace` [s] is long
    against the differences of their clocks; S3 refuses requests of a clock that is 15 min wrong.
    """

    def __init__(self, database: Database, store: Artifacts, grace: float = GRACE) -> None:
        self._database, self._store, self._grace = database, store, grace
        self._seen: set[StoredFile] = set()  # by the last sweep, without a reference

    def run(self, is_stopping: Callable[[], bool] = lambda: False) -> int:
        """Sweep once, unless another server does; return how many files were deleted.

        Raises
        ------
        DatabaseCopied
            A copy of the database uses the store as well.
        """
        with alone(self._database, "sweep of files") as is_alone:
            if not is_alone:
                return 0
            if self._store.is_shared:
                require_only_copy(self._database, self._store)
            return self._swept(is_stopping)

    def _swept(self, is_stopping: Callable[[], bool]) -> int:
        files = set(self._store.list())  # before the rows: a file that is put meanwhile is not looked at
        with self._database.read() as session:
            referenced = referenced_files(session)
        unused = {file for file in files if file.sha not in referenced or self._is_spare(file)}
        return sum(self._store.delete_unchanged(file) for file in self._old(unused) if not is_stopping())

    def _is_spare(self, file: StoredFile) -> bool:
        """Return whether a discarded file that a row refers to is back in its place.

        Restore it if necessary.
        """
        return file.is_discarded and self._store.exists(file.sha)

    def _old(self, unused: set[StoredFile]) -> Iterable[StoredFile]:
        if self._database.is_shared:
            latest = time.time() - self._grace
            return [file for file in unused if file.modified < latest]
        twice, self._seen = unused & self._seen, unused
        return twice
