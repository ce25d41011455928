"""Evaluate steps of designs: in the calling thread, or in the pool if they take long.

The route or job that calculates a design sets the pool and the client for its context.
"""

from __future__ import annotations

import json
import math
import threading
import time
from collections.abc import Callable, Hashable, Iterator, Mapping
from concurrent.futures import wait
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from hashlib import sha256
from typing import TypeVar, TypeVarTuple

from app.jobs.service import Job, JobContext
from app.plain import Raw
from app.pool.cost import EXPENSIVE, estimated_seconds
from app.pool.errors import StepDeferred
from app.pool.pool import Calculation, CalculationPool, Lane
from app.pool.sources import Source, loaded, source_of
from app.workers.errors import JobCancelled
from templates.core.language.evaluate import Evaluation, evaluate
from templates.core.language.template import Template
from templates.core.progress import Reporter
from templates.core.units.quantity import TypedQuantity

T = TypeVar("T")
Ts = TypeVarTuple("Ts")

GLANCE = 0.1  # time between two checks whether the client has left [s]


@dataclass(frozen=True)
class Steps:
    """The pool for expensive steps, and how long an answer waits for them [s]."""

    pool: CalculationPool
    deadline: float
    left: dict[str, PendingCalculations] = field(
        default_factory=dict
    )  # calculations that wait for their job, by job

    def begun(self) -> PendingCalculations:
        """Return an empty record of the calculations that one request begins without waiting for them."""
        return PendingCalculations(self.pool, self.left)

    def drop(self, job: str) -> None:
        """Cancel a calculation that was left to a job which never started."""
        if begun := self.left.get(job):
            begun.close(failed=True)


_Question = tuple[Source, Mapping[str, Raw], tuple[str, ...] | None, str | None, float | None]
"""The arguments of `_evaluated`."""


@dataclass
class Caller:
    """The client that needs steps, where they are evaluated, and how long the client waits."""

    steps: Steps
    client: str
    begun: PendingCalculations
    lane: Lane = "answers"
    left: threading.Event = field(default_factory=threading.Event)  # set once nobody waits for the result
    report: Reporter | None = None
    until: float = math.inf  # steps not calculated by then are deferred [s, monotonic]

    def evaluation(
        self,
        cls: type[Template],
        raw: dict[str, Raw],
        outputs: tuple[str, ...] | None,
        level: str | None,
        tolerance: float | None,
    ) -> Evaluation:
        """Return the evaluation of a step in the pool; this call blocks.

        Raises
        ------
        StepDeferred
            If it does not end in time; it continues if there is room.
        """
        key = (cls, outputs, level, tolerance, fingerprint(raw))
        question: _Question = source_of(cls), raw, outputs, level, tolerance
        return self.calculated(key, _evaluated, *question)

    def calculated(self, key: Hashable, function: Callable[[*Ts], T], *args: *Ts) -> T:
        """Run a function in the pool and wait for its result. A job that takes it over finds it by its `key`.

        Raises
        ------
        StepDeferred
            If it does not end in time; it continues if there is room.
        """
        calculation = self.begun.take(key) or self._submitted(function, *args)
        if self.report is not None:
            calculation.listen(self.report)
        while not wait([calculation.future], self._glance()).done:
            if self.left.is_set():
                self.steps.pool.cancel(calculation)
            elif time.monotonic() >= self.until:
                self.begun.keep(key, calculation)
                raise StepDeferred
        result: T = calculation.future.result()
        return result

    def _submitted(self, function: Callable[[*Ts], object], *args: *Ts) -> Calculation:
        if self.left.is_set():
            raise JobCancelled
        if time.monotonic() >= self.until:
            raise StepDeferred
        return self.steps.pool.submit(self.client, function, *args, lane=self.lane)

    def _glance(self) -> float:
        return max(0.0, min(GLANCE, self.until - time.monotonic()))


_caller: ContextVar[Caller | None] = ContextVar("caller", default=None)


def evaluated_step(
    cls: type[Template],
    raw: Mapping[str, Raw],
    outputs: tuple[str, ...] | None,
    level: str | None,
    tolerance: float | None,
) -> Evaluation:
    """Return the evaluation of a step; this call blocks.

    The design judges the evaluation, because a criterion may depend on several steps.

    Raises
    ------
    InvalidInputs
        If the template refuses the inputs.
    StepDeferred
        If the step is expensive, and the caller does not wait for it.
    TooManyCalculations, WorkerError
        As raised by `CalculationPool.submit` and `Worker.run`.
    """
    caller = _caller.get()
    if caller is None or estimated_seconds(cls, raw, level, tolerance, outputs) <= EXPENSIVE:
        return evaluate(cls, raw, outputs=outputs, level=level, tolerance=tolerance, judge=False)
    return caller.evaluation(cls, dict(raw), outputs, level, tolerance)


def in_the_pool(key: Hashable, function: Callable[[*Ts], T], *args: *Ts) -> T:
    """Run a function in the pool for the caller of this context, or in this process if there is no pool.

    Raises
    ------
    StepDeferred
        If the caller does not wait for the result.
    TooManyCalculations, WorkerError
        As raised by `CalculationPool.submit` and `Worker.run`.
    """
    caller = _caller.get()
    return function(*args) if caller is None else caller.calculated(key, function, *args)


def begun_steps() -> PendingCalculations | None:
    """Return the calculations that the caller of this context has begun without waiting for them."""
    caller = _caller.get()
    return caller.begun if caller else None


def _evaluated(
    source: Source,
    raw: Mapping[str, Raw],
    outputs: tuple[str, ...] | None,
    level: str | None,
    tolerance: float | None,
) -> Evaluation:
    """Return the evaluation with all values that the template computes; runs in a calculation process."""
    return evaluate(loaded(source), raw, outputs=outputs, level=level, tolerance=tolerance, judge=False)


@contextmanager
def calling(steps: Steps | None, job: Job, context: JobContext, client: str, lane: Lane) -> Iterator[None]:
    """Let a job evaluate expensive steps in the pool, and take over the calculations begun for it."""
    if steps is None:
        yield
        return
    begun = steps.left.pop(job.id, None) or steps.begun()
    caller = Caller(steps, client, begun, lane, context.cancelled, context.progress)
    token = _caller.set(caller)
    try:
        yield
    finally:
        _caller.reset(token)
        begun.close(failed=True)


def call_as(caller: Caller) -> None:
    """Set the caller for whom the rest of this context, such as a request, evaluates expensive steps."""
    _caller.set(caller)


def announce(text: str) -> None:
    """Tell the job of this context, if there is one, which calculation comes next."""
    caller = _caller.get()
    if caller is not None and caller.report is not None:
        caller.report(0.0, text)


@contextmanager
def stage(first: float, last: float, name: str) -> Iterator[None]:
    """Report the progress of the calculations in this block as the part of the total from `first` to `last`.

    Each text begins with the name of the part, if the part has a name.
    """
    caller = _caller.get()
    if caller is None or caller.report is None:
        yield
        return
    whole, head = caller.report, f"{name}: " if name else ""
    caller.report = lambda share, text: whole(first + (last - first) * share, head + text)
    try:
        yield
    finally:
        caller.report = whole


def present_caller() -> Caller | None:
    """Return the caller for whom this context evaluates steps."""
    return _caller.get()


class PendingCalculations:
    """Calculations that a request has begun without waiting; a job takes them over, or they are cancelled.

    Parameters
    ----------
    pool
        The pool in which the calculations run.
    left
        The calculations left to jobs, by job; all requests share this mapping.
    """

    def __init__(self, pool: CalculationPool, left: dict[str, PendingCalculations]) -> None:
        self._pool, self._left = pool, left
        self._calculations: dict[Hashable, Calculation] = {}
        self._job: str | None = None

    def keep(self, key: Hashable, calculation: Calculation) -> None:
        """Let a calculation continue if the pool has room for one more job; otherwise cancel it."""
        if calculation.future.done() or self._pool.keep(calculation):
            self._calculations[key] = calculation
        else:
            self._pool.cancel(calculation)

    def take(self, key: Hashable) -> Calculation | None:
        """Return the calculation with this key, and hand it over to the caller."""
        return self._calculations.pop(key, None)

    def leave_to(self, job: str) -> None:
        """Leave all calculations to a job; call this in the transaction that queues the job."""
        self._withdraw()
        self._job, self._left[job] = job, self

    def close(self, *, failed: bool = False) -> None:
        """Cancel the calculations that no job takes over; if the request failed, its job was not queued."""
        if self._job is None or failed:
            self._withdraw()
            for calculation in self._calculations.values():
                self._pool.cancel(calculation)
            self._calculations.clear()

    def _withdraw(self) -> None:
        if self._job is not None:
            self._left.pop(self._job, None)


def fingerprint(inputs: Mapping[str, Raw]) -> bytes:
    """Return a digest of inputs as the user wrote them, regardless of the order of their parts."""
    return sha256(json.dumps(inputs, sort_keys=True, default=_plain).encode()).digest()


def _plain(value: object) -> object:
    """Return a value as JSON; a parsed quantity becomes the text that its user typed."""
    return [value.value, value.unit, value.extra] if isinstance(value, TypedQuantity) else repr(value)
