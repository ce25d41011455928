"""Requests to evaluate a template, to solve it, or to write its formulas out.

Calculation processes read the body of such a request and write the answer.
"""

from __future__ import annotations

import time
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import replace

from app.calculations.errors import InvalidBody, NoArray, TooManyValues
from app.calculations.operations import LARGE, Question, answered, check, checked
from app.catalogue.catalogues import Catalogues
from app.plain import JsonObject
from app.pool.errors import StepDeferred, TooManyCalculations
from app.pool.questions import CALCULATION, Form, Kind, Reply
from app.pool.sources import source_of
from app.pool.steps import Caller, in_the_pool, present_caller
from app.storage.database import Database
from app.workers.pieces import Pieces
from templates.core.catalogue.digests import digest
from templates.core.language.template import Template

CHECKED_WITHIN = 2.0
"""Longest time that a client that does not wait is held while a process checks a large body [s]."""


def calculated(question: Question, database: Database, catalogues: Catalogues) -> Reply[Question, Pieces]:
    """Return the answer of a calculation process, or a reply without one if the caller's waiting time ends.

    With `wait=0` the request is still validated.

    Raises
    ------
    UnknownTemplate, InvalidBody, InvalidInputs, NoArray, TooManyValues
        If the request is invalid.
    TooManyCalculations
        If too many calculations are waiting.
    """
    cls = catalogues.to_try(question.template, question.version)
    caller = present_caller()
    if caller is not None and time.monotonic() >= caller.until:
        _check(cls, question, caller)
        return Reply(None, question)
    try:
        return Reply(in_the_pool(CALCULATION, answered, source_of(cls), question))
    except StepDeferred:
        return Reply(None, question)


def _check(cls: type[Template], question: Question, caller: Caller) -> None:
    """Refuse an invalid request, as far as possible without calculating.

    A calculation process reads a large body. If no process is free in time, the job reports the faults.
    """
    if len(question.body) <= LARGE:
        check(cls, question)
        return
    begun = caller.steps.begun()
    checking = replace(caller, begun=begun, until=time.monotonic() + CHECKED_WITHIN)
    with suppress(StepDeferred, TooManyCalculations):
        try:
            checking.calculated(CALCULATION, checked, source_of(cls), question)
        finally:
            begun.close()


def _settled(
    question: Question, database: Database, catalogues: Catalogues
) -> tuple[Question, Iterable[str]]:
    """Return the request with the current digest of its template."""
    return question, (digest(catalogues.to_try(question.template, question.version)),)


def _written(question: Question) -> tuple[JsonObject, Pieces]:
    fields = {name: part for name, part in vars(question).items() if name != "body"}
    return fields, question.body


def _read(fields: JsonObject, body: Pieces) -> Question:
    return Question(**fields, body=body)


EVALUATION = Kind(
    CALCULATION,
    Form(_written, _read),
    lambda kept: kept,
    calculated,
    failures=(TooManyValues, InvalidBody, NoArray),
    settle=_settled,
)
