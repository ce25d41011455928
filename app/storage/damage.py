"""Damage of the database that shows while it is in use: from then on nothing is written."""

from __future__ import annotations

import logging
import sqlite3
import threading
from types import TracebackType

from app.storage.engines import sqlite_file
from app.storage.errors import DatabaseDamaged
from app.storage.integrity import faults, is_damage

logger = logging.getLogger(__name__)


class Watch:
    """A context that turns SQLite's errors about damage into DatabaseDamaged, and remembers the first."""

    def __init__(self, url: str) -> None:
        self._url = url
        self._lock = threading.Lock()
        self.damage: DatabaseDamaged | None = None

    def refuse(self) -> None:
        """Return if no damage has shown; raises DatabaseDamaged."""
        if self.damage is not None:
            raise self._again(self.damage)

    def raise_if_damage(self, error: BaseException | None) -> None:
        """Return unless an error says that the database is damaged; raises DatabaseDamaged."""
        if error is not None and is_damage(error):
            raise self._named(error) from error

    def __enter__(self) -> None:
        """Watch from here."""

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Look at what was raised."""
        if error is not None:
            self.raise_if_damage(error)

    def _named(self, error: BaseException) -> DatabaseDamaged:
        with self._lock:
            if self.damage is None:
                self.damage = error if isinstance(error, DatabaseDamaged) else self._diagnosed(error)
                logger.critical("%s", self.damage)
            return self._again(self.damage)

    def _diagnosed(self, error: BaseException) -> DatabaseDamaged:
        """Read the whole file once more, because the error names no page."""
        path = sqlite_file(self._url)
        try:
            found = faults(path) if path else []
        except (sqlite3.Error, OSError) as failure:
            found = [f"it cannot be examined ({failure})"]
        return DatabaseDamaged(str(path or "database"), found or [str(getattr(error, "orig", error))])

    @staticmethod
    def _again(damage: DatabaseDamaged) -> DatabaseDamaged:
        """A fresh exception: one that is raised in several threads would collect their tracebacks."""
        return DatabaseDamaged(damage.database, damage.faults)
