"""Limits of a principal: those of the settings, or its own where they differ."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from datetime import UTC, datetime, timedelta
from math import ceil

from app.identity.errors import IdentityError
from app.settings import Settings


@dataclass(frozen=True)
class Limits:
    """The limits of one principal.

    Parameters
    ----------
    requests_per_minute
        Of one server [1/min].
    storage_mb
        What it was the first to have stored: files of builds, surfaces of analyses, imported files, tables
        and rows of studies, texts of worksheets. Deleted ones stay counted. Documents of designs, and answers
        of jobs, which are kept for some days, do not count [MiB].
    calculation_seconds
        Run time of its jobs on one day in UTC [s].
    queued_jobs
        Jobs that wait at the same time.
    """

    requests_per_minute: float
    storage_mb: float
    calculation_seconds: float
    queued_jobs: int


NAMES = tuple(field.name for field in fields(Limits))


def limits_of(settings: Settings, own: Mapping[str, object] | None) -> Limits:
    """Return the limits of a principal, with its own values where its row has them."""
    general = {
        "requests_per_minute": settings.principal_rate,
        "storage_mb": settings.principal_storage_mb,
        "calculation_seconds": settings.principal_seconds,
        "queued_jobs": settings.client_queue_limit,
    }
    differing = {name: float(str(own[name])) for name in NAMES if own and own.get(name) is not None}
    amounts = {**general, **differing}
    queued = int(amounts.pop("queued_jobs"))
    return Limits(**amounts, queued_jobs=queued)


class LimitReached(IdentityError):
    """A principal has used all that it may; `retry_after` says when there is more, if ever [s]."""

    def __init__(self, what: str, retry_after: int | None) -> None:
        super().__init__(f"{what}; an administrator may raise the limit")
        self.headers = {} if retry_after is None else {"Retry-After": str(retry_after)}


def today() -> str:
    """Return the present day in UTC, in the format of the rows of usage."""
    return datetime.now(UTC).date().isoformat()


def seconds_to_midnight() -> int:
    """Return the time until the next day begins in UTC [s]."""
    present = datetime.now(UTC)
    tomorrow = present.replace(hour=0, minute=0, second=0, microsecond=0) + timedelta(days=1)
    return ceil((tomorrow - present).total_seconds())
