"""Detect damage of the database in use; from then on nothing is written."""

from __future__ import annotations

import logging
import os
import sqlite3
import threading
from contextlib import suppress

from app.storage.engines import sqlite_file
from app.storage.errors import DatabaseDamaged
from app.storage.integrity import faults, is_damage, marker_of

logger = logging.getLogger(__name__)


class Watch:
    """Turns SQLite's errors about damage into DatabaseDamaged, and remembers the first.

    It leaves a note of it beside the file: what is lost with SQLite's log shows at no later start.
    """

    def __init__(self, url: str) -> None:
        self._path = sqlite_file(url)
        self._file = self._path.stat() if self._path is not None and self._path.exists() else None
        self._lock = threading.Lock()
        self.damage: DatabaseDamaged | None = None

    def refuse(self) -> None:
        """Return if no damage has shown, and the file is still that of the start; raises DatabaseDamaged."""
        if self.damage is not None:
            raise self._again(self.damage)
        self.require_file()

    def require_file(self) -> None:
        """Return if the file is still that of the start: SQLite would make an empty one in its place."""
        if self._path is None or self._file is None:
            return
        with suppress(OSError):
            if os.path.samestat(os.stat(self._path), self._file):
                return
        lost = "the file was deleted or replaced while the service used it"
        raise self._named(DatabaseDamaged(str(self._path), [lost]))

    def raise_if_damage(self, error: BaseException | None) -> None:
        """Return unless an error says that the database is damaged; raises DatabaseDamaged."""
        if error is not None and is_damage(error):
            raise self._named(error) from error

    def translated(self, error: Exception) -> Exception:
        """Return DatabaseDamaged in place of an error that says so; any other error as it is."""
        try:
            self.raise_if_damage(error)
        except DatabaseDamaged as damage:
            return damage
        return error

    def _named(self, error: BaseException) -> DatabaseDamaged:
        with self._lock:
            if self.damage is None:
                self.damage = error if isinstance(error, DatabaseDamaged) else self._diagnosed(error)
                logger.critical("%s", self.damage)
                self._note(self.damage)
            return self._again(self.damage)

    def _diagnosed(self, error: BaseException) -> DatabaseDamaged:
        """Read the whole file once more, because the error names no page."""
        path = self._path
        try:
            damage = faults(path) if path else []
        except (sqlite3.Error, OSError) as failure:
            damage = [f"it cannot be examined ({failure})"]
        return DatabaseDamaged(str(path or "database"), damage or [str(getattr(error, "orig", error))])

    def _note(self, damage: DatabaseDamaged) -> None:
        if self._path is not None:
            with suppress(OSError):  # the disk may be the reason
                marker_of(self._path).write_text("; ".join(damage.faults), encoding="utf-8")

    @staticmethod
    def _again(damage: DatabaseDamaged) -> DatabaseDamaged:
        """Return a fresh exception: one that is raised in several threads would collect their tracebacks."""
        return DatabaseDamaged(damage.database, damage.faults)
