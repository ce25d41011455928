"""Steps of designs: evaluated in the thread that asks, or in the pool where that takes long.

Who calculates, and for which client, is set by the route or the job that calculates a design.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator, Mapping
from concurrent.futures import wait
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import Any

from app.calculations.cost import EXPENSIVE, estimated_seconds
from app.calculations.pool import CalculationPool
from app.calculations.sources import Source, loaded
from templates.core.language.evaluate import Evaluation, evaluate
from templates.core.language.template import Template

GLANCE = 0.1  # how often a thread looks whether its client has left [s]


@dataclass(frozen=True)
class Steps:
    """Where expensive steps are evaluated."""

    pool: CalculationPool
    sources: Mapping[type[Template], Source]


@dataclass(frozen=True)
class Caller:
    """Who asks for steps, and where they are evaluated."""

    steps: Steps
    client: str
    left: threading.Event = field(default_factory=threading.Event)  # the client has closed its connection


_caller: ContextVar[Caller | None] = ContextVar("caller", default=None)


def evaluated_step(
    cls: type[Template],
    raw: Mapping[str, Any],
    outputs: tuple[str, ...] | None,
    level: str | None,
    tolerance: float | None,
) -> Evaluation:
    """The evaluation of a step; blocks.

    Raises
    ------
    InvalidInputs
        Where the template refuses.
    TooManyCalculations, WorkerError
        As `CalculationPool.submit` and `Worker.run`.
    """
    caller = _caller.get()
    if caller is None or estimated_seconds(cls, raw, level, tolerance, outputs) <= EXPENSIVE:
        return evaluate(cls, raw, outputs=outputs, level=level, tolerance=tolerance)
    source = caller.steps.sources[cls]
    calculation = caller.steps.pool.submit(
        caller.client, _evaluated, source, dict(raw), outputs, level, tolerance
    )
    while not wait([calculation.future], GLANCE).done:
        if caller.left.is_set():
            caller.steps.pool.cancel(calculation)
    made: Evaluation = calculation.future.result()
    return made


def _evaluated(
    source: Source,
    raw: Mapping[str, Any],
    outputs: tuple[str, ...] | None,
    level: str | None,
    tolerance: float | None,
) -> Evaluation:
    """The evaluation, with all that the template has computed: in a calculation process."""
    return evaluate(loaded(source), raw, outputs=outputs, level=level, tolerance=tolerance)


@contextmanager
def calling(steps: Steps | None, client: str) -> Iterator[None]:
    """Let expensive steps be evaluated in the pool within the context."""
    token = _caller.set(Caller(steps, client) if steps else None)
    try:
        yield
    finally:
        _caller.reset(token)


def call_as(caller: Caller) -> None:
    """Let what follows in this context, such as a request, evaluate expensive steps for a caller."""
    _caller.set(caller)


def present_caller() -> Caller | None:
    """For whom this context evaluates steps."""
    return _caller.get()
