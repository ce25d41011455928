"""Publish the imported models of the database in the catalogue."""

from __future__ import annotations

import logging
import threading
from collections.abc import Iterable, Iterator

from app.catalogue.catalogues import Catalogues
from app.catalogue.follower import Follower
from app.catalogue.sheets import Key
from app.imported_models import repository
from app.storage.database import Database
from app.storage.tables import ImportedModelRow
from cad.imported_models import ImportedModel
from cad.model_classes import class_of

logger = logging.getLogger(__name__)


def _classes(rows: Iterable[ImportedModelRow]) -> Iterator[tuple[Key, type[ImportedModel]]]:
    """Yield the classes of rows; an unreadable row is skipped."""
    for row in rows:
        try:
            yield (row.id, row.number), class_of(row.description, row.id, row.number)
        except Exception:
            logger.exception("Model %s version %d cannot be read", row.id, row.number)


class ImportedModelRegistry:
    """Publishes imported models, and reads each version only once."""

    def __init__(self, database: Database, catalogues: Catalogues, *, is_shared: bool) -> None:
        self.database, self.catalogues = database, catalogues
        self._looking, self._count = threading.Lock(), 0
        self.follower = Follower("imported models", self.look, lambda: is_shared)
        """Finds the models that other servers import, if the database may have other servers."""
        self.look()

    def look(self) -> None:
        """Publish new versions in the database."""
        with self._looking, self.database.read() as session:
            if (count := repository.count(session)) == self._count:
                return
            rows = repository.all_rows(session)
            self.catalogues.bring(dict(_classes(rows)))
            self._count = count
