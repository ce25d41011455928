"""Threads of routes that may wait for the pool of calculation processes; the other routes have theirs."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from typing import ParamSpec, TypeVar

from anyio import CapacityLimiter, to_thread
from fastapi import Request

from app.api.responses import client_left
from app.pool.steps import Caller, present_caller

P = ParamSpec("P")
T = TypeVar("T")

THREADS = 64


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
        caller = present_caller()
        leaving = asyncio.create_task(_note_leaving(request, caller))
        try:
            return await self.run(_closing, caller, lambda: function(*args, **options))
        finally:
            leaving.cancel()

    async def run_within(
        self, seconds: float, request: Request, function: Callable[P, T], *args: P.args, **options: P.kwargs
    ) -> T:
        """Run a function as `run_for`, and defer the steps that take longer than so long [s].

        The deadline of the calculation limits that time.
        """
        if caller := present_caller():
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
