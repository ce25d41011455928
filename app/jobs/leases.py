"""Leases of jobs on a shared database: when a server dies, other servers take over its jobs."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable

from sqlalchemy.orm import Session

from app.jobs import repository
from app.jobs.context import note
from app.jobs.dispatcher import MAX_LOSSES, Dispatcher, Problem
from app.jobs.errors import JobLost
from app.jobs.events import Events
from app.jobs.repository import Job
from app.settings import Settings
from app.storage.database import Database

logger = logging.getLogger(__name__)


class Leases:
    """Renews the leases of this server's jobs, and queues again the jobs that dead servers have left.

    A job that no longer belongs to this server is interrupted: somebody cancelled it on another server, or
    this server was silent for too long. A thread also checks the queue from time to time, because hints of
    other servers may get lost.
    """

    def __init__(
        self,
        database: Database,
        dispatcher: Dispatcher,
        events: Events,
        settings: Settings,
        describe: Callable[[Exception], Problem],
    ) -> None:
        self._database, self._dispatcher, self._events = database, dispatcher, events
        self._lease, self._beat, self._poll = (
            settings.lease_seconds,
            settings.beat_seconds,
            settings.poll_seconds,
        )
        self._describe = describe
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._work, name="leases", daemon=True)

    @property
    def is_started(self) -> bool:
        """Return whether `start` was called."""
        return self._thread.ident is not None

    def start(self) -> None:
        """Start the thread, and queue again at once the jobs of dead servers whose leases have expired."""
        self._thread.start()

    def stop(self) -> None:
        """Stop the thread, and give back the jobs that this server still has."""
        self._stopping.set()
        self._thread.join()
        try:
            self._dispatcher.requeue_all(self._dispatcher.owner)
        except Exception:
            logger.exception("Jobs could not be given back; other servers take them when their leases end")

    def beat(self) -> None:
        """Renew the leases once, and interrupt jobs that this server has lost."""
        jobs = self._dispatcher.running()
        if not jobs:
            return
        ids = [job.id for job in jobs]
        owner, lease = self._dispatcher.owner, self._lease
        held = self._database.write(lambda session: repository.beat(session, owner, ids, lease))
        for job in jobs:
            if (job.id, job.attempt) not in held:
                self._dispatcher.interrupt(job.id, job.attempt)

    def reap(self) -> None:
        """Queue again the jobs whose leases have expired."""
        for job in self._database.write(self._reaped):
            logger.warning("job %s (%s) was abandoned by its server, loss %d", job.id, job.kind, job.losses)

    def _reaped(self, session: Session) -> list[Job]:
        jobs = repository.reap(session)
        for job in jobs:
            if job.losses < MAX_LOSSES:
                note(session, self._events, job, "queued")
                continue
            problem = self._describe(JobLost(job.losses))
            repository.give_up(session, job, problem)
            if kind := self._dispatcher.kinds.get(job.kind):
                kind.on_failure(session, job, problem)
            note(session, self._events, job, "failed", problem=problem)
        return jobs

    def _work(self) -> None:
        beaten = -self._beat
        pause = 0.0
        while not self._stopping.wait(pause):
            try:
                if time.monotonic() - beaten >= self._beat:
                    beaten = time.monotonic()
                    self.beat()
                    self.reap()
            except Exception as error:
                logger.warning("The leases of jobs could not be renewed; trying again: %s", error)
            self._dispatcher.wake()
            pause = min(self._poll, max(0.0, beaten + self._beat - time.monotonic()))
