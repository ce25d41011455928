"""Report the progress of a long calculation or a job; who listens, if anybody does, is set from outside."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

Reporter = Callable[[float, str], None]

_reporter: ContextVar[Reporter | None] = ContextVar("reporter", default=None)


def report(fraction: float, text: str) -> None:
    """Say what fraction (0 to 1) of the work is done, and what is done next."""
    reporter = _reporter.get()
    if reporter is not None:
        reporter(fraction, text)


@contextmanager
def reporting(reporter: Reporter | None) -> Iterator[None]:
    """Let `report` reach this reporter within the context."""
    token = _reporter.set(reporter)
    try:
        yield
    finally:
        _reporter.reset(token)
