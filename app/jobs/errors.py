"""Errors of jobs.

JobError
 ├── JobNotFound    there is no such job
 ├── JobFinished    the job has ended, so it cannot be cancelled
 ├── JobShared      other clients wait for the job, so this client cannot cancel it
 ├── QueueFull      too many jobs are waiting
 ├── JobLost        the servers or workers that ran the job were lost repeatedly
 ├── JobRests       raised by a handler: the job continues later, after other jobs
 └── JobFailed      raised by a handler: the job ends with this error
"""

from collections.abc import Callable

from sqlalchemy.orm import Session


class JobError(Exception):
    """Base class of errors of jobs."""


class JobNotFound(JobError):
    """There is no such job."""

    def __init__(self, id: str) -> None:
        super().__init__(f"There is no job {id}.")
        self.id = id


class JobFinished(JobError):
    """The job has ended."""

    def __init__(self, id: str, state: str) -> None:
        super().__init__(f"Job {id} has ended: it is {state}.")
        self.id = id
        self.state = state


class JobShared(JobError):
    """Several clients wait for the job."""

    def __init__(self, id: str) -> None:
        super().__init__(f"Several clients wait for job {id}; it ends when each of them has cancelled it.")
        self.id = id


class QueueFull(JobError):
    """The client (`own`) or all clients have too many waiting jobs; retry after the stated time [s]."""

    def __init__(self, retry_after: int, own: int | None = None) -> None:
        whose = "Too many jobs are" if own is None else f"{own} jobs of yours, as many as may be, are"
        sooner = "" if own is None else ", or cancel some: GET /api/v1/jobs lists them"
        super().__init__(f"{whose} waiting. Try again in {retry_after} s{sooner}.")
        self.retry_after = retry_after


class JobLost(JobError):
    """The servers or workers that ran the job were lost repeatedly."""

    def __init__(self, losses: int) -> None:
        super().__init__(
            f"The server or worker that ran the job was lost {losses} times, so the job is not retried."
        )
        self.losses = losses


class JobRests(JobError):
    """A handler lets other clients' jobs run first; its own job is queued for its client's next turn."""


class JobFailed(JobError):
    """A handler raises this to end its job with an error; `completion` runs in the same transaction."""

    def __init__(self, cause: Exception, completion: Callable[[Session], None] | None = None) -> None:
        super().__init__(cause)
        self.cause = cause
        self.completion = completion
