"""Errors of studies, besides wrong inputs."""

from __future__ import annotations

AGAIN_SECONDS = 2  # after which rows that are calculated again may be asked for


class RowsLost(Exception):
    """Calculated rows are missing or damaged; a job calculates them again.

    Attributes
    ----------
    job
        The id of that job.
    retry_after
        When to ask again [s].
    """

    def __init__(self, study: str, job: str) -> None:
        super().__init__(study, job)
        self.study, self.job, self.retry_after = study, job, AGAIN_SECONDS

    def __str__(self) -> str:
        return f"rows of study {self.study} were missing or damaged and are calculated again"
