"""Errors of studies, besides wrong inputs."""

from __future__ import annotations

AGAIN_SECONDS = 2  # time after which a client may ask for recalculated rows [s]


class RowsLost(Exception):
    """Raised if calculated rows are missing or damaged; a job recalculates them.

    Attributes
    ----------
    job
        The id of that job.
    retry_after
        Time after which the client may ask again [s].
    """

    def __init__(self, study: str, job: str) -> None:
        super().__init__(study, job)
        self.study, self.job, self.retry_after = study, job, AGAIN_SECONDS

    def __str__(self) -> str:
        return f"rows of study {self.study} were missing or damaged and are calculated again"
