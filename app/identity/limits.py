"""Limits of a principal: those of the settings, unless the principal has its own."""

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
    processor_seconds
        Processor time of requests to one server, while another principal uses that server [s/min].
    storage_mb
        Content that the principal was the first to store: files of builds, surfaces of analyses, imported
        files, tables and rows of studies, texts of worksheets. Deleted content still counts. Documents of
        designs, and answers of jobs, which are kept for some days, do not count [MiB].
    calculation_seconds
        Run time of its jobs per day in UTC [s].
    queued_jobs
        Largest number of waiting jobs.
    """

    processor_seconds: float
    storage_mb: float
    calculation_seconds: float
    queued_jobs: int


NAMES = tuple(field.name for field in fields(Limits))


def limits_of(settings: Settings, own: Mapping[str, object] | None) -> Limits:
    """Return the limits of a principal: its own values where it has them, otherwise those of the settings."""
    general = {
        "processor_seconds": settings.principal_processor_seconds,
        "storage_mb": settings.principal_storage_mb,
        "calculation_seconds": settings.principal_seconds,
        "queued_jobs": settings.client_queue_limit,
    }
    differing = {name: float(str(own[name])) for name in NAMES if own and own.get(name) is not None}
    amounts = {**general, **differing}
    queued = int(amounts.pop("queued_jobs"))
    return Limits(**amounts, queued_jobs=queued)


class LimitReached(IdentityError):
    """A principal has reached a limit; `retry_after` is the time until it is reset [s], or None."""

    def __init__(self, what: str, retry_after: int | None) -> None:
        super().__init__(f"{what}; an administrator may raise the limit")
        self.headers = {} if retry_after is None else {"Retry-After": str(retry_after)}


def today() -> str:
    """Return the present day in UTC, as text in the format of the usage rows."""
    return datetime.now(UTC).date().isoformat()


def seconds_to_midnight() -> int:
    """Return the time until the next day begins in UTC [s]."""
    present = datetime.now(UTC)
    tomorrow = present.replace(hour=0, minute=0, second=0, microsecond=0) + timedelta(days=1)
    return ceil((tomorrow - present).total_seconds())
