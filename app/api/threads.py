"""Threads of routes that may wait for the pool of calculation processes; the other routes have theirs."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import ParamSpec, TypeVar

from anyio import CapacityLimiter, to_thread
from fastapi import Request

from app.api.waiting import client_left
from app.calculations.steps import Caller, present_caller

P = ParamSpec("P")
T = TypeVar("T")

THREADS = 64


class Threads:
    """A number of threads of their own."""

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
        leaving = asyncio.create_task(_note_leaving(request, present_caller()))
        try:
            return await self.run(function, *args, **options)
        finally:
            leaving.cancel()


async def _note_leaving(request: Request, caller: Caller | None) -> None:
    await client_left(request)
    if caller is not None:
        caller.left.set()
