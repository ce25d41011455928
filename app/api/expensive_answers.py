"""Wait in a route for an expensive calculation, until it ends, the client leaves or its time is up."""

from __future__ import annotations

import asyncio
from concurrent.futures import Future
from contextlib import suppress

from fastapi import Request, Response
from starlette.concurrency import run_in_threadpool

from app.api.responses import accepted, client_left, patience
from app.calculations.jobs import CalculationJobs
from app.calculations.operations import LARGE, Question, answered, check, checked
from app.catalogue.catalogues import Catalogues
from app.http.access import get_client
from app.http.pace import PiecesResponse
from app.pool.errors import TooManyCalculations
from app.pool.pool import Calculation, CalculationPool
from app.pool.sources import source_of
from app.workers.errors import JobCancelled
from templates.core.errors import UnreleasedTemplate
from templates.core.language.template import Template


async def to_try(catalogues: Catalogues, template: str, version: int) -> type[Template]:
    """Return a version, or the draft of a worksheet: what is answered is not kept.

    Raises
    ------
    UnknownTemplate
        If there is none, or the draft has faults.
    """
    try:
        return catalogues.templates.get(template, version)
    except UnreleasedTemplate:
        return await run_in_threadpool(catalogues.to_try, template, version)


class Answering:
    """Answers expensive requests from the pool."""

    def __init__(self, pool: CalculationPool, jobs: CalculationJobs, deadline: float) -> None:
        self.pool, self.jobs, self.deadline = pool, jobs, deadline

    async def admit(self, request: Request, template: str, version: int) -> None:
        """Ask, before a large body comes, whether there is room for its calculation.

        Raises
        ------
        UnknownTemplate, InvalidInputs, TooManyCalculations
            What `answer` would raise now.
        """
        await to_try(self.jobs.catalogues, template, version)
        client = await get_client(request)
        if self._patience(request) > 0:  # else a job waits for its turn
            self.pool.admit(client)

    async def answer(self, request: Request, question: Question, within: float | None = None) -> Response:
        """Return the answer of a calculation process; 202 with a job once nobody waits for it any longer.

        Waits `within` [s], by default as long as the request prefers.

        Who does not want to wait at all learns nevertheless what is wrong with the request. The process is
        ended if the client leaves.

        Raises
        ------
        QueueFull
            Too many calculations, or jobs, are waiting.
        Exception
            What the calculation raises.
        """
        cls = await to_try(self.jobs.catalogues, question.template, question.version)
        client = await get_client(request)
        seconds = self._patience(request) if within is None else min(self.deadline, within)
        if seconds <= 0:
            await self._check(request, cls, client, question)
            return accepted(await run_in_threadpool(self.jobs.create, question, client))
        calculation = self.pool.submit(client, answered, source_of(cls), question)
        try:
            ended = await self._ends(request, calculation, seconds)
        except BaseException:
            self.pool.cancel(calculation)
            raise
        if not ended:
            return accepted(await run_in_threadpool(self.jobs.create, question, client, calculation))
        return PiecesResponse(calculation.future.result(), request.app.state.pace, question.media_type)

    def _patience(self, request: Request) -> float:
        """Time that the request waits for its answer [s]."""
        return min(self.deadline, patience(request.headers.get("prefer"), self.deadline))

    async def _check(self, request: Request, cls: type[Template], client: str, question: Question) -> None:
        """Refuse what is wrong with a question, as far as shows without calculating.

        A large body is read in a calculation process. If none is free within the time that an answer waits
        for its job, the job itself will say what is wrong.
        """
        if len(question.body) <= LARGE:
            await run_in_threadpool(check, cls, question)
            return
        with suppress(TooManyCalculations):
            checking = self.pool.submit(client, checked, source_of(cls), question)
            try:
                if await self._ends(request, checking, self.jobs.jobs.wait_seconds):
                    checking.future.result()
            finally:
                self.pool.cancel(checking)

    async def _ends(self, request: Request, calculation: Calculation, seconds: float) -> bool:
        """Wait until a calculation ends, at most so long [s]; whether it did.

        Raises
        ------
        JobCancelled
            The client has left.
        """
        end = asyncio.create_task(_done(calculation.future))
        leaving = asyncio.create_task(client_left(request))
        try:
            await asyncio.wait({end, leaving}, timeout=seconds, return_when=asyncio.FIRST_COMPLETED)
            if calculation.future.done():
                return True
            if leaving.done():
                raise JobCancelled
            return False
        finally:
            end.cancel()
            leaving.cancel()


async def _done(future: Future[object]) -> None:
    """Wait for a future of threads, without any hold on it."""
    loop, done = asyncio.get_running_loop(), asyncio.Event()

    def wake(_: Future[object]) -> None:
        with suppress(RuntimeError):  # the loop has ended
            loop.call_soon_threadsafe(done.set)

    future.add_done_callback(wake)
    await done.wait()
