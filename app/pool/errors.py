"""Errors of the pool.

QueueFull
 └── TooManyCalculations   the queue of calculations is full
StepDeferred               an expensive step did not finish while its caller waited
"""

from __future__ import annotations

from app.jobs.errors import QueueFull


class TooManyCalculations(QueueFull):
    """The queue of calculations is full; the client may try again after some time [s]."""

    def __str__(self) -> str:
        return f"Too many calculations are waiting. Try again in {self.retry_after} s."


class StepDeferred(Exception):
    """An expensive step was not calculated while its caller waited; a job will calculate it."""
