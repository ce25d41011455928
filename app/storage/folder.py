"""The data folder of a server: only one process at a time may hold it."""

import fcntl
import os
from pathlib import Path

from app.storage.errors import DataFolderInUse

LOCK = "crankwright.lock"
DATABASE = "crankwright.sqlite"


class DataFolder:
    """A folder that only this process may use until it ends or calls `release`.

    The lock belongs to the process, so a killed server leaves nothing to clean up. At the start, work that
    the database marks as running must therefore have been interrupted.

    Raises
    ------
    DataFolderInUse
        If another process holds the folder.
    """

    def __init__(self, path: Path) -> None:
        self.path = path.absolute()
        self.path.mkdir(parents=True, exist_ok=True)
        self._lock = os.open(self.path / LOCK, os.O_RDWR | os.O_CREAT, 0o644)
        self._acquire()

    @property
    def database(self) -> Path:
        """Return the path of the SQLite file in this folder."""
        return self.path / DATABASE

    @property
    def database_url(self) -> str:
        """Return the SQLAlchemy URL of the SQLite file in this folder."""
        return f"sqlite:///{self.database}"

    @property
    def artifacts(self) -> Path:
        """Return the folder of the artifact store."""
        return self.path / "artifacts"

    def release(self) -> None:
        """Release the folder, so that another process can use it."""
        os.close(self._lock)

    def _acquire(self) -> None:
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            owner = os.pread(self._lock, 20, 0).decode(errors="replace")
            self.release()
            raise DataFolderInUse(self.path, owner) from None
        os.ftruncate(self._lock, 0)
        os.pwrite(self._lock, str(os.getpid()).encode(), 0)
