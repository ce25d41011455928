"""`/readyz`: whether the database, free space, job processes and the file store are ready for work.

The time of a response does not depend on the number of designs, and a hanging writer does not delay it.
"""

from __future__ import annotations

import asyncio
import shutil
import time
from collections.abc import Awaitable, Callable, Mapping
from concurrent.futures import Future
from pathlib import Path
from typing import Protocol

from sqlalchemy import update
from sqlalchemy.orm import Session

from app.storage.artifacts import Artifacts
from app.storage.database import Database
from app.storage.errors import ArtifactsUnreachable
from app.storage.tables import CounterRow
from app.workers.choice import why_silent_here

KEPT = 1.0  # time for which a result is reused [s]
PATIENCE = 2.0  # longest wait for the writer [s]
FORK = 1.0  # longest wait for a job process, which may just be starting [s]
_GLANCE = 0.05  # s

Check = Callable[[], Awaitable[str | None]]
"""Returns what is wrong; None if nothing is wrong."""


class Readiness:
    """Named checks, of which one set runs at a time, at most once a second."""

    def __init__(self, checks: Mapping[str, Check]) -> None:
        self._checks = checks
        self._lock = asyncio.Lock()
        self._kept: tuple[float, dict[str, str | None]] | None = None

    async def failures(self) -> dict[str, str | None]:
        """Return the result of each check: a message about the fault, or None."""
        async with self._lock:
            if self._kept is None or time.monotonic() - self._kept[0] > KEPT:
                said = await asyncio.gather(*(check() for check in self._checks.values()))
                self._kept = time.monotonic(), dict(zip(self._checks, said, strict=True))
            return self._kept[1]


class WriterProbe:
    """Lets the writer change a row; while a test still hangs, no other test is started."""

    def __init__(self, database: Database, patience: float = PATIENCE) -> None:
        self._database, self._patience = database, patience
        self._pending: Future[None] | None = None

    async def __call__(self) -> str | None:
        """Return the reason why rows cannot be written, or None."""
        try:
            if self._pending is None or self._pending.done():
                self._pending = self._database.submit(_touch)
            writing = asyncio.wrap_future(self._pending)
            writing.add_done_callback(_look_at)
            await asyncio.wait_for(asyncio.shield(writing), self._patience)
        except TimeoutError:
            return f"a write takes longer than {self._patience:g} s"
        except Exception as error:  # after any error the service cannot write
            return f"a write fails: {error}"
        return None


class Files:
    """Tests whether the file store answers; while a test still hangs, no other test is started."""

    def __init__(self, store: Artifacts, patience: float = PATIENCE) -> None:
        self._store, self._patience = store, patience
        self._pending: asyncio.Future[None] | None = None

    async def __call__(self) -> str | None:
        """Return the reason why files cannot be read or stored, or None."""
        try:
            if self._pending is None or self._pending.done():
                self._pending = asyncio.ensure_future(asyncio.to_thread(self._store.probe))
                self._pending.add_done_callback(_look_at)
            await asyncio.wait_for(asyncio.shield(self._pending), self._patience)
        except TimeoutError:
            return f"the file store takes longer than {self._patience:g} s"
        except ArtifactsUnreachable as error:
            return f"the file store cannot be used: {error.reason}"
        return None


def _look_at(writing: asyncio.Future[None]) -> None:
    """Retrieve the error of a write that ends after its test, because no other caller does."""
    if not writing.cancelled():
        writing.exception()


def _touch(session: Session) -> None:
    """Write a row without effect, and sync it to disk."""
    session.execute(update(CounterRow).where(CounterRow.name == "operation").values(value=CounterRow.value))


class Space:
    """Compares the free space on a folder's disk with the required space [MiB]."""

    def __init__(self, folder: Path, minimum_mb: int) -> None:
        self._folder, self._minimum = folder, minimum_mb

    async def __call__(self) -> str | None:
        """Return a message with the missing disk space, or None."""
        try:
            free = shutil.disk_usage(self._folder).free / 2**20
        except OSError as error:
            return f"the data folder cannot be read: {error.strerror}"
        if free >= self._minimum:
            return None
        return f"{free:.0f} MiB are free, less than the {self._minimum} MiB of CRANKWRIGHT_MINIMUM_FREE_MB"


class ProcessPool(Protocol):
    """The interface of a worker whose processes can be tested."""

    def answers(self) -> bool:
        """Return whether a worker answers; see `Worker.answers`."""
        ...


class Processes:
    """Tests whether a job would find a process now or soon."""

    def __init__(
        self,
        worker: ProcessPool,
        why_silent: Callable[[], str] = why_silent_here,
        patience: float = FORK,
    ) -> None:
        self._worker, self._why_silent, self._patience = worker, why_silent, patience

    async def __call__(self) -> str | None:
        """Return a message if no job process answers, else None."""
        end = time.monotonic() + self._patience
        while not self._worker.answers():
            if time.monotonic() >= end:
                return f"no job process answers: {self._why_silent()}"
            await asyncio.sleep(_GLANCE)
        return None
