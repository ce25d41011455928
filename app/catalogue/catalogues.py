"""Catalogues of templates and models: built-in versions, a team's files, and released worksheets.

The files of a team are reloaded when they change; `app.worksheets` provides the worksheets.
"""

from __future__ import annotations

import asyncio
import logging
import threading
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from app.catalogue.check import Check
from app.catalogue.discovery import find_templates
from app.catalogue.sheets import Key, Sheets
from app.catalogue.team import Snapshot, TeamFile, TeamFiles, joined, merged, with_models
from app.workers.errors import WorkerError
from cad.catalogue import models as find_models
from cad.model import CadModel
from templates.core.catalogue.discovery import Catalogue
from templates.core.errors import UnknownTemplate, UnreleasedTemplate
from templates.core.language.template import Template

logger = logging.getLogger(__name__)

EVERY = 1.0  # shortest time between two checks of the files [s]
PATIENCE = 2.0  # how long a request waits for the check of a file that has changed [s]


Drafts = Callable[[str, int], type[Template]]
"""Reads the current draft of a worksheet; raises UnknownTemplate if it has faults or no longer exists."""


class Catalogues:
    """The present templates and models.

    Code that uses a template or model twice should keep the reference, because a refresh may replace it.
    """

    def __init__(self, templates: Catalogue[Template], models: Catalogue[CadModel]) -> None:
        self.files = self.snapshot = Snapshot(templates, models)
        self._sheets = Sheets()
        self._brought: Mapping[Key, type[CadModel]] = {}
        self._drafts: Drafts = _no_drafts
        self._joining = threading.Lock()

    @property
    def templates(self) -> Catalogue[Template]:
        """Return the templates."""
        return self.snapshot.templates

    @property
    def models(self) -> Catalogue[CadModel]:
        """Return the CAD models."""
        return self.snapshot.models

    def publish(self, sheets: Sheets, drafts: Drafts) -> None:
        """Add these worksheets to the catalogue of templates."""
        with self._joining:
            self._sheets, self._drafts = sheets, drafts
            self._join()

    def bring(self, models: Mapping[Key, type[CadModel]]) -> None:
        """Add these imported models to the catalogue."""
        with self._joining:
            self._brought = models
            self._join()

    def _join(self) -> None:
        self.snapshot = with_models(joined(self.files, self._sheets), self._brought)

    def to_try(self, id: str, version: int) -> type[Template]:
        """Return a version, or the present draft of a worksheet, for results that are not stored.

        Raises
        ------
        UnknownTemplate
            If there is no such version, or the draft has faults.
        """
        if (id, version) not in self.templates.unreleased:
            return self.templates.get(id, version)
        return self._drafts(id, version)

    async def tried(self, id: str, version: int) -> type[Template]:
        """Return the result of `to_try` in the event loop; a thread reads the draft.

        Raises
        ------
        UnknownTemplate
            As raised by `to_try`.
        """
        try:
            return self.templates.get(id, version)
        except UnreleasedTemplate:
            return await asyncio.to_thread(self.to_try, id, version)

    def with_drafts(self, wanted: Iterable[Key]) -> Catalogues:
        """Return these catalogues together with the requested drafts of worksheets.

        A draft with faults remains unusable.
        """
        drafts: dict[Key, type[Template]] = {}
        faulty: dict[Key, str] = {}
        for key in self.templates.unreleased.keys() & set(wanted):
            try:
                drafts[key] = self._drafts(*key)
            except UnknownTemplate as error:
                faulty[key] = str(error)
        if not (drafts or faulty):
            return self
        versions = {**self.templates.versions, **drafts}
        unreleased = {**self.templates.unreleased, **faulty}
        return Catalogues(replace(self.templates, versions=versions, unreleased=unreleased), self.models)

    def _take(self, files: Snapshot) -> None:
        """Replace the versions that come from files."""
        with self._joining:
            self.files = files
            self._join()

    async def refresh(self) -> None:
        """Do nothing, because a catalogue without team files never changes."""

    def close(self) -> None:
        """Stop watching the files."""


class TeamCatalogues(Catalogues):
    """The built-in versions, and those in a team's folders.

    A request starts a check of the files if the last one began more than a second ago. A thread checks and
    loads the changed files, and the request waits at most two seconds for it, so an import that never ends
    delays no request for longer. The constructor makes the first check, with `first` if that is given.
    """

    def __init__(self, folders: Sequence[Path], check: Check, first: Check | None = None) -> None:
        super().__init__(find_templates(()), find_models())
        self._built_in = self.templates, self.models
        self._team = TeamFiles(folders, first or check)
        self._thread = ThreadPoolExecutor(1, "catalogue")
        self._looking: Future[None] | None = None
        self._begun = time.monotonic()
        self._look()
        self._team.check = check

    async def refresh(self) -> None:
        """Check the files for changes; every request calls it, in the event loop."""
        now = time.monotonic()
        if (self._looking is None or self._looking.done()) and now >= self._begun + EVERY:
            self._begun = now
            self._looking = self._thread.submit(self._look)
        left = self._begun + PATIENCE - now
        if self._looking is not None and not self._looking.done() and left > 0:
            await _ended(self._looking, left)

    def close(self) -> None:
        """Stop watching the files."""
        self._thread.shutdown(wait=False, cancel_futures=True)

    def _look(self) -> None:
        try:
            is_changed = self._team.examine()
        except WorkerError:  # the service is stopping
            return
        except Exception:
            logger.exception("The files of templates could not be checked")
            return
        if is_changed:
            before = {file.path: file for file in self.snapshot.files}
            self._take(merged(*self._built_in, self._team.files))
            for file in self.snapshot.files:
                if file.faults and before.get(file.path) != file:
                    _report(file)


def _no_drafts(id: str, version: int) -> type[Template]:
    raise UnknownTemplate(id, f"there is no draft of {id} version {version}")


async def _ended(future: Future[None], seconds: float) -> None:
    """Wait at most this time [s] for a future of a thread, without keeping a reference to it."""
    loop, ended = asyncio.get_running_loop(), asyncio.Event()

    def wake(_: Future[None]) -> None:
        with suppress(RuntimeError):  # the loop has ended
            loop.call_soon_threadsafe(ended.set)

    future.add_done_callback(wake)
    with suppress(TimeoutError):
        await asyncio.wait_for(ended.wait(), seconds)


def loaded(folders: Sequence[Path]) -> Snapshot:
    """Return the complete catalogues of this process, for a command.

    Files are not checked, and files that cannot be imported are left out.
    """
    team = TeamFiles(folders, lambda path, content: [])
    team.examine()
    return merged(find_templates(()), find_models(), team.files)


def _report(file: TeamFile) -> None:
    state = "is quarantined" if file.is_quarantined else "is used"
    for fault in file.faults:
        logger.warning("%s %s: %s", file.path, state, fault.sentence)
