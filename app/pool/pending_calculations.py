"""Calculations of steps that were begun for an answer and go on for the job that takes its place."""

from __future__ import annotations

import json
from collections.abc import Hashable, Mapping
from hashlib import sha256

from app.plain import Raw
from app.pool.pool import Calculation, CalculationPool
from templates.core.units.quantity import Typed


class PendingCalculations:
    """Calculations that a request has begun and left; a job takes them over, or they are cancelled.

    Parameters
    ----------
    pool
        Where the calculations run.
    left
        What was left to jobs, by job; all requests share it.
    """

    def __init__(self, pool: CalculationPool, left: dict[str, PendingCalculations]) -> None:
        self._pool, self._left = pool, left
        self._calculations: dict[Hashable, Calculation] = {}
        self._job: str | None = None

    def keep(self, key: Hashable, calculation: Calculation) -> None:
        """Let a calculation go on if the pool has room for one more job; else it is cancelled."""
        if calculation.future.done() or self._pool.keep(calculation):
            self._calculations[key] = calculation
        else:
            self._pool.cancel(calculation)

    def take(self, key: Hashable) -> Calculation | None:
        """Return the calculation of a question, which is the caller's from now on."""
        return self._calculations.pop(key, None)

    def leave_to(self, job: str) -> None:
        """Leave everything to a job; to be called in the transaction that queues it."""
        self._withdraw()
        self._job, self._left[job] = job, self

    def close(self, *, failed: bool = False) -> None:
        """Cancel what no job takes over; if the request failed, its job was not queued."""
        if self._job is None or failed:
            self._withdraw()
            for calculation in self._calculations.values():
                self._pool.cancel(calculation)
            self._calculations.clear()

    def _withdraw(self) -> None:
        if self._job is not None:
            self._left.pop(self._job, None)


def fingerprint(inputs: Mapping[str, Raw]) -> bytes:
    """Return a digest of inputs as typed, the same in whatever order their parts are written."""
    return sha256(json.dumps(inputs, sort_keys=True, default=_plain).encode()).digest()


def _plain(value: object) -> object:
    """Return a value as JSON; a quantity that was read already becomes the text that its user typed."""
    return [value.value, value.unit, value.extra] if isinstance(value, Typed) else repr(value)
