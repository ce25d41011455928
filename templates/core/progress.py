"""Report the progress of a long calculation or a job; the caller may install a reporter."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

Reporter = Callable[[float, str], None]

_reporter: ContextVar[Reporter | None] = ContextVar("reporter", default=None)


def report(fraction: float, text: str) -> None:
    """Report the completed fraction (0 to 1) of the work, and a text about the next action."""
    reporter = _reporter.get()
    if reporter is not None:
        reporter(fraction, text)


@contextmanager
def reporting(reporter: Reporter | None) -> Iterator[None]:
    """Send progress to this reporter within the context."""
    token = _reporter.set(reporter)
    try:
        yield
    finally:
        _reporter.reset(token)


@contextmanager
def part_of_progress(number: int, count: int) -> Iterator[None]:
    """Scale `report` within the context to one of `count` equal parts, numbered from 0."""
    whole = _reporter.get()
    if whole is None or count == 1:
        yield
        return

    def of_part(fraction: float, text: str) -> None:
        whole((number + fraction) / count, f"point {number + 1} of {count}: {text}")

    with reporting(of_part):
        yield
