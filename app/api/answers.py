"""Respond to a request that a job may have to compute: with the answer, or with 202 and the job."""

from __future__ import annotations

import time
from typing import TypeVar

from fastapi import Request, Response
from starlette.concurrency import run_in_threadpool

from app.api.dependencies import expensive_steps, services_of
from app.api.file_answers import rebuilding
from app.api.responses import accepted, finished, written
from app.api.services import Services
from app.calculations.array_files import MEDIA_TYPES
from app.http import problems
from app.http.connections import PiecesResponse
from app.http.problem_kinds import INTERNAL
from app.jobs.errors import JobNotFound
from app.jobs.repository import FINAL, Job
from app.pool.questions import ANSWERS, Questions, stored_answer
from app.schemas.answers import Answer
from app.storage.errors import ArtifactDamaged, ArtifactMissing
from app.workers.pieces import Pieces

Q = TypeVar("Q")
A = TypeVar("A", bound=Answer | Pieces)


async def answered(
    questions: Questions[Q, A],
    question: Q,
    request: Request,
    client: str,
    seconds: float,
    media_type: str = "application/json",
) -> Response:
    """Return the answer to a request, or 202 with its job and the available parts when the time is up.

    The time that the client waits [s] is limited by the deadline of calculations. The calculation ends if the
    client disconnects.

    Raises
    ------
    QueueFull
        If too many calculations or jobs are waiting.
    Exception
        An error of the calculation itself.
    """
    services = services_of(request)
    await expensive_steps(request, client)
    if questions.kind.check is None:
        seconds = min(seconds, questions.steps.deadline)
    end = time.monotonic() + seconds
    answer, job = await services.threads.run_within(seconds, request, questions.answer, question, client)
    if job is not None and answer is None:
        if await services.jobs.wait(job, end - time.monotonic()) in FINAL:
            return await answer_of(services, job, request, client)
        if questions.kind.has_parts:
            await expensive_steps(request, client)
            answer = await services.threads.run_within(0, request, questions.at_once, question)
    if isinstance(answer, Pieces):
        return PiecesResponse(answer, request.app.state.pace, media_type)
    return accepted(job, answer) if job is not None or answer is None else written(answer)


async def answer_of(
    services: Services, job: str, request: Request, client: str, prefer: str | None = None
) -> Response:
    """Return the answer that a job computed; 202 while the job runs, its problem if it failed.

    A lost answer is calculated again; the client's preference states how long it waits for that.

    Raises
    ------
    JobNotFound
        If there is no such job, or it computes no answer.
    CannotRebuild
        If both the answer and its request are lost.
    """
    row = await run_in_threadpool(_answering, services, job)
    if not row.finished:
        return accepted(job)
    if row.result is None:
        return problems.answer(row.problem or problems.problem(INTERNAL, "the job left no answer"))
    try:
        stored = await run_in_threadpool(stored_answer, services.store, row)
    except (ArtifactMissing, ArtifactDamaged) as lost:
        if unavailable := await _calculated_again(services, row, client, prefer, lost.sha):
            return unavailable
        row = await run_in_threadpool(_answering, services, job)
        stored = await run_in_threadpool(stored_answer, services.store, row)
    media_type = MEDIA_TYPES[row.payload.get("form", "json")]
    return PiecesResponse(stored, request.app.state.pace, media_type)


async def _calculated_again(
    services: Services, row: Job, client: str, prefer: str | None, sha: str
) -> Response | None:
    """Return None once the job has recalculated its answer, else the response to send instead."""
    again = await run_in_threadpool(services.evaluations.request_again, row, client)
    if not await finished(services.jobs, again, prefer):
        return rebuilding(sha, again)
    problem = await run_in_threadpool(services.jobs.problem, again)
    return problems.answer(problem) if problem else None


def _answering(services: Services, id: str) -> Job:
    """Return a job whose result is an answer; raise JobNotFound for any other."""
    row = services.jobs.get(id)
    if row.kind not in ANSWERS:
        raise JobNotFound(id)
    return row
