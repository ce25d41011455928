"""Steps of designs: evaluated in the thread that asks, or in the pool where that takes long.

Who calculates, and for which client, is set by the route or the job that calculates a design.
"""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import wait
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import Annotated, Any, ParamSpec, TypeVar

from anyio import CapacityLimiter, to_thread
from fastapi import Depends, Request

from app.api.gate.clients import get_client
from app.api.waiting import client_left
from app.calculations.cost import EXPENSIVE, estimated_seconds
from app.calculations.pool import CalculationPool
from app.calculations.sources import Source, loaded
from templates.core.language.evaluate import Evaluation, evaluate
from templates.core.language.template import Template

P = ParamSpec("P")
T = TypeVar("T")

GLANCE = 0.1  # how often a thread looks whether its client has left [s]
THREADS = 64  # that may wait for the pool; the other routes have theirs


@dataclass(frozen=True)
class Steps:
    """Where expensive steps are evaluated."""

    pool: CalculationPool
    sources: Mapping[type[Template], Source]


@dataclass(frozen=True)
class Caller:
    """Who asks for steps, and where they are evaluated."""

    steps: Steps
    client: str
    left: threading.Event = field(default_factory=threading.Event)  # the client has closed its connection


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
    TooManyCalculations, WorkerError
        As `CalculationPool.submit` and `Worker.run`.
    """
    caller = _caller.get()
    if caller is None or estimated_seconds(cls, raw, level, tolerance, outputs) <= EXPENSIVE:
        return evaluate(cls, raw, outputs=outputs, level=level, tolerance=tolerance)
    source = caller.steps.sources[cls]
    calculation = caller.steps.pool.submit(
        caller.client, _evaluated, source, dict(raw), outputs, level, tolerance
    )
    while not wait([calculation.future], GLANCE).done:
        if caller.left.is_set():
            caller.steps.pool.cancel(calculation)
    made: Evaluation = calculation.future.result()
    return made


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
def calling(steps: Steps | None, client: str) -> Iterator[None]:
    """Let expensive steps be evaluated in the pool within the context."""
    token = _caller.set(Caller(steps, client) if steps else None)
    try:
        yield
    finally:
        _caller.reset(token)


async def expensive_steps(request: Request) -> None:
    """Let a route evaluate expensive steps in the pool; a dependency of routers."""
    _caller.set(Caller(request.app.state.steps, await get_client(request)))


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
        """Call a function that changes nothing; what it calculates ends if the client leaves."""
        leaving = asyncio.create_task(_note_leaving(request, _caller.get()))
        try:
            return await self.run(function, *args, **options)
        finally:
            leaving.cancel()


async def _note_leaving(request: Request, caller: Caller | None) -> None:
    await client_left(request)
    if caller is not None:
        caller.left.set()


async def get_threads(request: Request) -> Threads:
    """The threads that may wait for the pool."""
    return request.app.state.threads  # type: ignore[no-any-return]


TheThreads = Annotated[Threads, Depends(get_threads)]
