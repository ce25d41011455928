"""What a design can be made of: built-in templates and models, and a team's, read again when they change."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path

from app.catalogue.checking import Check
from app.catalogue.finding import find_templates
from app.catalogue.team import Snapshot, TeamFile, TeamFiles, merged
from app.workers.errors import WorkerError
from cad.catalogue import models as find_models
from cad.model import CadModel
from templates.core.catalogue.finding import Catalogue
from templates.core.language.template import Template

logger = logging.getLogger(__name__)

EVERY = 1.0  # how often files are looked at, while there are requests [s]
PATIENCE = 2.0  # how long a request waits for the check of a file that has changed [s]


class Catalogues:
    """What a design can be made of, as it is now; who uses one catalogue twice shall keep it meanwhile."""

    def __init__(self, templates: Catalogue[Template], models: Catalogue[CadModel]) -> None:
        self.snapshot = Snapshot(templates, models)

    @property
    def templates(self) -> Catalogue[Template]:
        """The templates."""
        return self.snapshot.templates

    @property
    def models(self) -> Catalogue[CadModel]:
        """The CAD models."""
        return self.snapshot.models

    async def refresh(self) -> None:
        """Take notice of files that have changed; nothing changes here."""

    def close(self) -> None:
        """Look at no file any more."""


class TeamCatalogues(Catalogues):
    """The built-in versions, and those of a team's folders.

    A request looks at the files if nobody did for a second. A thread then checks and loads what has changed,
    for which the request waits two seconds at most: an import that does not end holds nobody up for longer.
    """

    def __init__(self, folders: Sequence[Path], check: Check) -> None:
        super().__init__(find_templates(()), find_models())
        self._built_in = self.templates, self.models
        self._team = TeamFiles(folders, check)
        self._thread = ThreadPoolExecutor(1, "catalogue")
        self._looking: Future[None] | None = None
        self._begun = time.monotonic()
        self._look()

    async def refresh(self) -> None:
        """Take notice of files that have changed; called by every request, in the event loop."""
        now = time.monotonic()
        if (self._looking is None or self._looking.done()) and now >= self._begun + EVERY:
            self._begun = now
            self._looking = self._thread.submit(self._look)
        left = self._begun + PATIENCE - now
        if self._looking is not None and not self._looking.done() and left > 0:
            await _ended(self._looking, left)

    def close(self) -> None:
        """Look at no file any more."""
        self._thread.shutdown(wait=False, cancel_futures=True)

    def _look(self) -> None:
        try:
            is_changed = self._team.examine()
        except WorkerError:  # the service is stopping
            return
        except Exception:
            logger.exception("The files of templates could not be looked at")
            return
        if is_changed:
            before = {file.path: file for file in self.snapshot.files}
            self.snapshot = merged(*self._built_in, self._team.files)
            for file in self.snapshot.files:
                if file.faults and before.get(file.path) != file:
                    _report(file)


async def _ended(future: Future[None], seconds: float) -> None:
    """Wait for a future of a thread, at most so long [s], without any hold on it."""
    loop, ended = asyncio.get_running_loop(), asyncio.Event()

    def wake(_: Future[None]) -> None:
        with suppress(RuntimeError):  # the loop has ended
            loop.call_soon_threadsafe(ended.set)

    future.add_done_callback(wake)
    with suppress(TimeoutError):
        await asyncio.wait_for(ended.wait(), seconds)


def loaded(folders: Sequence[Path]) -> Snapshot:
    """Everything in this process, for a command: without the checks, and without what cannot be imported."""
    team = TeamFiles(folders, lambda path, content: [])
    team.examine()
    return merged(find_templates(()), find_models(), team.files)


def _report(file: TeamFile) -> None:
    state = "is quarantined" if file.is_quarantined else "is used"
    for fault in file.faults:
        logger.warning("%s %s: %s", file.path, state, fault.sentence)
