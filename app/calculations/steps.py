"""Steps of designs: evaluated in the thread that asks, or in the pool where that takes long.

Who calculates, and for which client, is set by the route or the job that calculates a design.
"""

from __future__ import annotations

import asyncio
import math
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import wait
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import Annotated, Any, ParamSpec, TypeVar

from anyio import CapacityLimiter, to_thread
from fastapi import Depends, Request

from app.calculations.begun import Begun, fingerprint
from app.calculations.cost import EXPENSIVE, estimated_seconds
from app.calculations.errors import StepDeferred
from app.calculations.pool import Calculation, CalculationPool, Lane
from app.calculations.sources import Source, loaded
from app.clients import get_client
from app.jobs.service import Job, JobContext
from app.waiting import client_left
from app.workers.errors import JobCancelled
from templates.core.language.evaluate import Evaluation, evaluate
from templates.core.language.template import Template
from templates.core.progress import Reporter

P = ParamSpec("P")
T = TypeVar("T")

GLANCE = 0.1  # how often a thread looks whether its client has left [s]
THREADS = 64  # that may wait for the pool; the other routes have theirs


@dataclass(frozen=True)
class Steps:
    """Where expensive steps are evaluated, and how long an answer waits for them [s]."""

    pool: CalculationPool
    sources: Mapping[type[Template], Source]
    deadline: float
    left: dict[str, Begun] = field(default_factory=dict)  # calculations that wait for their job, by job

    def begun(self) -> Begun:
        """A place for the calculations that one request begins and does not wait for."""
        return Begun(self.pool, self.left)

    def drop(self, job: str) -> None:
        """End what was left to a job that nobody has begun."""
        if begun := self.left.get(job):
            begun.close(failed=True)


@dataclass
class Caller:
    """Who asks for steps, where they are evaluated, and how long that is waited for."""

    steps: Steps
    client: str
    begun: Begun
    lane: Lane = "answers"
    left: threading.Event = field(default_factory=threading.Event)  # nobody waits for the result any longer
    report: Reporter | None = None
    until: float = math.inf  # when steps are deferred that are not calculated by then [s, monotonic]

    def evaluation(
        self,
        cls: type[Template],
        raw: dict[str, Any],
        outputs: tuple[str, ...] | None,
        level: str | None,
        tolerance: float | None,
    ) -> Evaluation:
        """The evaluation of a step in the pool; blocks.

        Raises
        ------
        StepDeferred
            It has not ended in time; it goes on if it may.
        """
        key = (cls, outputs, level, tolerance, fingerprint(raw))
        question = self.steps.sources[cls], raw, outputs, level, tolerance
        calculation = self.begun.take(key) or self._submitted(*question)
        if self.report is not None:
            calculation.listen(self.report)
        while not wait([calculation.future], self._glance()).done:
            if self.left.is_set():
                self.steps.pool.cancel(calculation)
            elif time.monotonic() >= self.until:
                self.begun.keep(key, calculation)
                raise StepDeferred
        evaluation: Evaluation = calculation.future.result()
        return evaluation

    def _submitted(self, *question: Any) -> Calculation:
        if self.left.is_set():
            raise JobCancelled
        if time.monotonic() >= self.until:
            raise StepDeferred
        return self.steps.pool.submit(self.client, _evaluated, *question, lane=self.lane)

    def _glance(self) -> float:
        return max(0.0, min(GLANCE, self.until - time.monotonic()))


_caller: ContextVar[Caller | None] = ContextVar("caller", default=None)


def evaluated_step(
    cls: type[Template],
    raw: Mapping[str, Any],
    outputs: tuple[str, ...] | None,
    level: str | None,
    tolerance: float | None,
) -> Evaluation:
    """The evaluation of a step; blocks.

    Raises
    ------
    InvalidInputs
        Where the template refuses.
    StepDeferred
        It is expensive, and the caller does not wait for it.
    TooManyCalculations, WorkerError
        As `CalculationPool.submit` and `Worker.run`.
    """
    caller = _caller.get()
    if caller is None or estimated_seconds(cls, raw, level, tolerance, outputs) <= EXPENSIVE:
        return evaluate(cls, raw, outputs=outputs, level=level, tolerance=tolerance)
    return caller.evaluation(cls, dict(raw), outputs, level, tolerance)


def begun_steps() -> Begun | None:
    """What the caller of this context has begun and does not wait for."""
    caller = _caller.get()
    return caller.begun if caller else None


def _evaluated(
    source: Source,
    raw: Mapping[str, Any],
    outputs: tuple[str, ...] | None,
    level: str | None,
    tolerance: float | None,
) -> Evaluation:
    """The evaluation, with all that the template has computed: in a calculation process."""
    return evaluate(loaded(source), raw, outputs=outputs, level=level, tolerance=tolerance)


@contextmanager
def calling(steps: Steps | None, job: Job, context: JobContext, client: str, lane: Lane) -> Iterator[None]:
    """Let a job evaluate expensive steps in the pool, and take over what was begun for it."""
    if steps is None:
        yield
        return
    begun = steps.left.pop(job.id, None) or steps.begun()
    caller = Caller(steps, client, begun, lane, context.cancelled, context.progress)
    token = _caller.set(caller)
    try:
        yield
    finally:
        _caller.reset(token)
        begun.close(failed=True)


async def expensive_steps(request: Request) -> None:
    """Let a route evaluate expensive steps in the pool; a dependency of routers."""
    steps: Steps = request.app.state.steps
    _caller.set(Caller(steps, await get_client(request), steps.begun()))


ExpensiveSteps = Depends(expensive_steps)


class Threads:
    """Threads of routes that may wait for the pool, so that those of the others are free."""

    def __init__(self) -> None:
        self._limiter: CapacityLimiter | None = None

    async def run(self, function: Callable[P, T], *args: P.args, **options: P.kwargs) -> T:
        """Call a function in such a thread."""
        if self._limiter is None:
            self._limiter = CapacityLimiter(THREADS)
        return await to_thread.run_sync(lambda: function(*args, **options), limiter=self._limiter)

    async def run_for(
        self, request: Request, function: Callable[P, T], *args: P.args, **options: P.kwargs
    ) -> T:
        """Call a function for a client; what it calculates ends if the client leaves."""
        caller = _caller.get()
        leaving = asyncio.create_task(_note_leaving(request, caller))
        try:
            return await self.run(_closing, caller, lambda: function(*args, **options))
        finally:
            leaving.cancel()

    async def run_within(
        self, seconds: float, request: Request, function: Callable[P, T], *args: P.args, **options: P.kwargs
    ) -> T:
        """Likewise; steps are deferred that are not calculated after so long, or after the deadline [s]."""
        if caller := _caller.get():
            caller.until = time.monotonic() + min(seconds, caller.steps.deadline)
        return await self.run_for(request, function, *args, **options)


def _closing(caller: Caller | None, function: Callable[[], T]) -> T:
    """Call a function, then end what it has begun and left to no job."""
    failed = True
    try:
        result = function()
        failed = False
        return result
    finally:
        if caller is not None:
            caller.begun.close(failed=failed)


async def _note_leaving(request: Request, caller: Caller | None) -> None:
    await client_left(request)
    if caller is not None:
        caller.left.set()


async def get_threads(request: Request) -> Threads:
    """The threads that may wait for the pool."""
    return request.app.state.threads  # type: ignore[no-any-return]


TheThreads = Annotated[Threads, Depends(get_threads)]
