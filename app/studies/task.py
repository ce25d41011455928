"""The input of a calculation process for a study: the design, the sources of its steps, the request body."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

from pydantic_core import from_json

from app.catalogue.catalogues import Catalogues
from app.designs.document import Document
from app.designs.engine.design_engine import DesignEngine
from app.designs.graph import raise_if
from app.designs.tasks import DesignTask
from app.plain import JsonObject
from app.reference import Reference
from app.storage.tables import canonical_json
from app.studies.bodies import StudyIn
from app.studies.question import StudyQuestion, asked_of
from app.studies.row_solids import RowSolids, iterated, measures_of_rows, tables_among
from templates.core.errors import Fault, InvalidInputs


@dataclass(frozen=True)
class Task:
    """A study as sent to a process; equal tasks calculate equal rows."""

    design: DesignTask
    body: str  # without the rows of a table
    varied: tuple[str, ...]  # varied places, in the order of the columns
    measured: tuple[tuple[str, float], ...] = ()  # known measurements of solids [SI], equal for all rows

    @classmethod
    def of(
        cls,
        document: JsonObject,
        body: JsonObject,
        varied: Sequence[str],
        measured: Mapping[str, float],
        catalogues: Catalogues,
    ) -> Task:
        """Return the task for a body, without the rows of a table, and for a revision's document.

        Raises
        ------
        UnknownTemplate
            If the catalogue no longer has a version that the design needs.
        """
        return cls(
            DesignTask.of(document, catalogues),
            canonical_json(body),
            tuple(varied),
            tuple(sorted(measured.items())),
        )


@dataclass(frozen=True)
class TaskState:
    """A task in the process that calculates it, read, checked and built once.

    Attributes
    ----------
    solids
        The measurements of solids that differ from row to row.
    nominal
        These measurements [SI] for the design itself, as far as known; trial rows use them.
    """

    engine: DesignEngine
    asked: StudyQuestion
    solids: RowSolids
    nominal: Mapping[Reference, float]


def prepared(task: Task) -> TaskState:
    """Return a task read and checked: its design as a function of rows, and the requested outputs.

    Raises
    ------
    InvalidInputs
        If the study has faults; the error lists all of them.
    """
    return _prepared(task)


def read_body(body: str) -> StudyIn:
    """Return a stored body, which was checked when it arrived."""
    return StudyIn.model_validate(from_json(body))


@lru_cache(maxsize=4)
def _prepared(task: Task) -> TaskState:
    document, catalogues = task.design.read()
    varied = [Reference.parse(name) for name in task.varied]
    measured_si = {Reference.parse(name): value for name, value in task.measured}
    body = read_body(task.body)
    aside = [Reference.parse(name) for name in body.set_aside]
    engine = _engine(document, catalogues, varied, measured_si, aside)
    asked = asked_of(body, task.varied, engine)
    measures = measures_of_rows(engine, body, asked.wanted, measured_si)
    raise_if([*iterated(document, measures), *tables_among(measures)])
    nominal = {reference: measured_si[reference] for reference in measures if reference in measured_si}
    blocks, moving = engine.graph.blocks, engine.design.moving
    constant = {
        reference: v for reference, v in measured_si.items() if blocks[reference.block].solid not in moving
    }
    if measures or constant != measured_si:
        engine = _engine(document, catalogues, [*varied, *measures], constant, aside)
    return TaskState(engine, asked, RowSolids(engine, tuple(measures)), nominal)


def _engine(
    document: Document,
    catalogues: Catalogues,
    varied: Sequence[Reference],
    measured: Mapping[Reference, float],
    aside: Sequence[Reference],
) -> DesignEngine:
    """Return the engine for the design and the varied places.

    If a relation sets a varied place, the error also names the remedy `set_aside`.
    """
    try:
        return DesignEngine.of(document, catalogues, varied, measured=measured, pending=True, set_aside=aside)
    except InvalidInputs as error:
        raise InvalidInputs(_with_remedy(fault) for fault in error.faults) from None


def _with_remedy(fault: Fault) -> Fault:
    if fault.code != "follows_from":
        return fault
    return replace(
        fault, detail=f"{fault.detail}; or name it in `set_aside`, so that the rows replace the relation"
    )
