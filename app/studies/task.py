"""What a calculation process needs to know of a study: the design, what its steps are made of, the body."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from pydantic_core import from_json

from app.catalogue.catalogues import Catalogues
from app.designs.net import Net
from app.designs.reference import Reference
from app.designs.tasks import DesignTask
from app.plain import JsonObject
from app.storage.tables import canonical_json
from app.studies.asking import Asked, asked_of
from app.studies.schemas import StudyIn


@dataclass(frozen=True)
class Task:
    """A study as it is sent to a process; equal tasks calculate equal rows."""

    design: DesignTask
    body: str  # without the rows of a table
    varied: tuple[str, ...]  # places, in the order of the columns of the rows
    measured: tuple[tuple[str, float], ...] = ()  # of solids, known [SI]: one value for all rows

    @classmethod
    def of(
        cls,
        document: JsonObject,
        body: JsonObject,
        varied: Sequence[str],
        measured: Mapping[str, float],
        catalogues: Catalogues,
    ) -> Task:
        """The task of a body, without the rows of a table, and a revision's document.

        Raises
        ------
        UnknownTemplate
            The catalogue has no longer what a step or model of the design needs.
        """
        return cls(
            DesignTask.of(document, catalogues),
            canonical_json(body),
            tuple(varied),
            tuple(sorted(measured.items())),
        )


@dataclass(frozen=True)
class Prepared:
    """A task in the process that calculates it: read, checked, built once."""

    net: Net
    asked: Asked


def prepared(task: Task) -> Prepared:
    """The design of a task as a function of rows, and what is asked of it.

    Raises
    ------
    InvalidInputs
        With everything that is wrong with the study.
    """
    return _prepared(task)


def read_body(body: str) -> StudyIn:
    """A body that was checked when it came."""
    return StudyIn.model_validate(from_json(body))


@lru_cache(maxsize=4)
def _prepared(task: Task) -> Prepared:
    document, catalogues = task.design.read()
    varied = [Reference.parse(name) for name in task.varied]
    measured = {Reference.parse(name): value for name, value in task.measured}
    net = Net.of(document, catalogues, varied, measured=measured)
    return Prepared(net, asked_of(read_body(task.body), task.varied, net))
