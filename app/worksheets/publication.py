"""Publish worksheets as templates: read them from the database and verify them against their releases."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Sequence
from typing import Literal

from app.catalogue.catalogues import Catalogues
from app.catalogue.follower import Follower
from app.catalogue.sheets import Key, ReleasedSheet, Sheets
from app.pool.sources import SheetSource, class_of
from app.storage.database import Database
from app.storage.errors import NotFound
from app.storage.tables import WorksheetVersionRow as Row
from app.worksheets import repository
from app.worksheets.examination import as_released
from app.worksheets.repository import RELEASED
from templates.core.errors import TemplateError, UnreleasedTemplate
from templates.core.language.template import Template

logger = logging.getLogger(__name__)

AT_ONCE = 15.0  # largest time of one update; the remaining releases are read while the service runs [s]
WAITING = "its release is being verified after the start of the service; try again in a few seconds"


class WorksheetPublication:
    """Keeps the catalogue of templates in step with the worksheets in the database.

    Every server reads a released version from its text once. If its digest or its golden results differ from
    the release, the version is broken, and the server refuses to calculate with it. It also refuses a version
    that it has not read yet.
    """

    def __init__(
        self, database: Database, catalogues: Catalogues, *, is_shared: bool, at_once: float = AT_ONCE
    ) -> None:
        self.database, self.catalogues, self._at_once = database, catalogues, at_once
        self._looking = threading.Lock()
        self._states: tuple[repository.State, ...] = ()
        self._read: dict[Key, tuple[str, ReleasedSheet | str]] = {}  # results with the edit that was read
        self._waiting: set[Key] = set()
        self.follower = Follower("worksheets", self.look, lambda: is_shared or bool(self._waiting))
        """Reads the remaining releases and, on a shared database, those of other servers."""
        self.look()

    @property
    def broken(self) -> dict[Key, str]:
        """Return the broken released versions, each with its reason."""
        return {key: read for key, (_, read) in self._read.items() if isinstance(read, str)}

    def look(self) -> None:
        """Update the catalogue after changes in the database, within the time allowed for one update."""
        with self._looking:
            with self.database.read() as session:
                states = repository.states(session)
                if states == self._states and not self._waiting:
                    return
                released = {(state.id, state.number): state for state in states if state.state in RELEASED}
                new = [key for key, state in released.items() if self._edit(key) != state.edit]
                rows = [repository.version(session, *key) for key in new]
            unchanged = {key: read for key, read in self._read.items() if key in released.keys() - new}
            self._read = {**unchanged, **_read_again(rows, self._at_once)}
            self._states, self._waiting = states, released.keys() - self._read.keys()
            self.catalogues.publish(self._sheets(), self.draft)

    def draft(self, id: str, version: int) -> type[Template]:
        """Return the present draft of a worksheet.

        Raises
        ------
        UnreleasedTemplate
            If it has faults, or has been deleted.
        """
        try:
            with self.database.read() as session:
                row = repository.version(session, id, version)
            return class_of(SheetSource(id, version, row.text, None))  # `loaded` caches a thousand texts
        except NotFound as error:
            raise UnreleasedTemplate(id, str(error)) from None
        except TemplateError as error:
            raise UnreleasedTemplate(id, f"the draft of {id} version {version} has faults: {error}") from None

    def _edit(self, key: Key) -> str | None:
        return self._read[key][0] if key in self._read else None

    def _sheets(self) -> Sheets:
        sound = {key: read for key, (_, read) in self._read.items() if isinstance(read, ReleasedSheet)}
        broken = {key: f"its worksheet is broken: {reason}" for key, reason in self.broken.items()}
        broken |= dict.fromkeys(self._waiting, WAITING)
        drafts = (state for state in self._states if state.state not in RELEASED)
        return Sheets(sound, broken, {(one.id, one.number): _remedy(one) for one in drafts})


def _remedy(state: repository.State) -> str:
    place = f"POST /api/v1/worksheets/{state.id}"
    return f"it is a {state.state} worksheet; release it first, by {place}/test, …/review and …/release"


def _read_again(rows: Sequence[Row], seconds: float) -> dict[Key, tuple[str, ReleasedSheet | str]]:
    """Return the releases that were read, each with its edit.

    It reads as many releases as the time [s] allows, but at least one.
    """
    read: dict[Key, tuple[str, ReleasedSheet | str]] = {}
    begun = time.monotonic()
    for row in rows:
        read[row.id, row.number] = row.edit, _verified(row)
        if time.monotonic() > begun + seconds:
            break
    return read


def _verified(row: Row) -> ReleasedSheet | str:
    """Return a released version, or the reason why it is broken."""
    source = SheetSource(row.id, row.number, row.text, row.withdrawn)
    if isinstance(released := as_released(source, row.digest, row.record), str):
        logger.error("Worksheet %s version %d is broken: %s", row.id, row.number, released)
        return released
    state: Literal["released", "withdrawn"] = "withdrawn" if row.withdrawn else "released"
    return ReleasedSheet(released, state, row.author, row.reviewer, row.reviewer_principal is not None)
