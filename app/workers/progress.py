"""How a job function tells how far it is, wherever it runs."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

Reporter = Callable[[float, str], None]

_reporter: ContextVar[Reporter | None] = ContextVar("reporter", default=None)


def report(fraction: float, text: str) -> None:
    """Say what fraction (0 to 1) of the work is done and what is done next; outside a job nobody listens."""
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
