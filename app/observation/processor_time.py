"""Measure the processor time of a request: its steps in the event loop, and its work in threads.

A calculation process and other processes are not included; the run time of jobs has a limit of its own.
"""

from __future__ import annotations

import functools
from collections.abc import Awaitable, Callable, Generator
from contextvars import ContextVar
from time import thread_time
from typing import ParamSpec, TypeVar

from starlette.concurrency import run_in_threadpool

Given = ParamSpec("Given")
Result = TypeVar("Result")


class Meter:
    """The processor time of one request so far, `seconds`."""

    __slots__ = ("seconds",)

    def __init__(self) -> None:
        self.seconds = 0.0


METER: ContextVar[Meter | None] = ContextVar("METER", default=None)
"""Meter of the request that the present thread works for; threads of `run_in_threadpool` inherit it."""


class Metered(Awaitable[None]):
    """Work in the event loop whose processor time a meter counts, without the time of other tasks."""

    def __init__(self, work: Awaitable[None], meter: Meter) -> None:
        self._steps, self._meter = work.__await__(), meter

    def __await__(self) -> Generator[object, None, None]:
        """Run the work step by step, and count the time of each step."""
        error: BaseException | None = None
        while True:
            start = thread_time()
            try:
                waiting = self._step(error)
            except StopIteration:
                return
            finally:
                self._meter.seconds += thread_time() - start
            try:
                error = None
                yield waiting
            except BaseException as thrown:
                error = thrown

    def _step(self, error: BaseException | None) -> object:
        return next(self._steps) if error is None else self._steps.throw(error)


def metered(function: Callable[Given, Result]) -> Callable[Given, Result]:
    """Return a function for a thread, whose processor time the request's meter counts."""

    @functools.wraps(function)
    def counted(*given: Given.args, **options: Given.kwargs) -> Result:
        start = thread_time()
        try:
            return function(*given, **options)
        finally:
            if (meter := METER.get()) is not None:
                meter.seconds += thread_time() - start

    return counted


async def in_thread(function: Callable[Given, Result], *given: Given.args, **options: Given.kwargs) -> Result:
    """Run a function in a thread, as a part of the request's processor time."""
    return await run_in_threadpool(metered(function), *given, **options)
