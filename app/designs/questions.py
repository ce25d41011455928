"""Requests about a design that the process pool answers, and the data that determine their answers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import Field, dataclass, replace
from typing import ClassVar, Protocol, TypeVar

from app.catalogue.catalogues import Catalogues
from app.designs import repository
from app.designs.document import Document
from app.designs.engine.calculate import calculate
from app.designs.engine.calculation import Calculation
from app.designs.errors import DesignError
from app.designs.graph import build_graph, raise_if, starts
from app.designs.graph import settled as iterated
from app.designs.tasks import DesignTask
from app.pool.errors import StepDeferred
from app.pool.questions import Kind, Reply, json_answer, json_form
from app.pool.steps import in_the_pool
from app.presentation.units import System
from app.schemas.answers import Answer
from app.solids.analysis_rows import analysed
from app.solids.rows import built
from app.storage.database import Database
from app.storage.tables import RevisionRow
from templates.core.catalogue.digests import digest
from templates.core.catalogue.discovery import Catalogue
from templates.core.errors import UnknownTemplate
from templates.core.language.template import Template

A = TypeVar("A", bound=Answer)
T = TypeVar("T", bound=Template)


@dataclass(frozen=True)
class DesignQuestion:
    """A request about a design: its body as JSON text, and the units of its answer.

    If `revision` is None, it is the newest.
    """

    design: str
    body: str
    revision: int | None = None
    units: System = "si"


def in_a_process(
    name: str, answer: type[A], answered: Callable[[DesignTask, int, str], A]
) -> Kind[DesignQuestion, A]:
    """Return a kind of request that the process pool answers as a whole.

    `answered` takes a task, a revision number and a body [JSON text], and returns an answer in SI units.
    """

    def calculate(
        asked: DesignQuestion, database: Database, catalogues: Catalogues
    ) -> Reply[DesignQuestion, A]:
        with database.read() as session:
            number = asked.revision or repository.head(session, asked.design).number
            document = repository.document(session, asked.design, number)
        task = DesignTask.of(document, catalogues)
        try:
            whole = in_the_pool((name, number, task, asked.body), answered, task, number, asked.body)
        except StepDeferred:
            return Reply(None, replace(asked, revision=number))
        return Reply(whole.in_units(asked.units))

    return Kind(
        name,
        json_form(DesignQuestion),
        json_answer(answer),
        calculate,
        failures=(DesignError,),
        settle=settled,
    )


class AboutRevision(Protocol):
    """A request about a revision of a design; the newest if `revision` is None."""

    __dataclass_fields__: ClassVar[dict[str, Field[object]]]

    @property
    def design(self) -> str:
        """Return the design."""

    @property
    def revision(self) -> int | None:
        """Return the number of the revision."""


R = TypeVar("R", bound=AboutRevision)


def settled(asked: R, database: Database, catalogues: Catalogues) -> tuple[R, Iterable[str]]:
    """Return a request with its revision number, and the data that determine the answer.

    The data are the digests of the versions that the revision uses, and the number of the design's newest
    event, which changes when a solid is built.

    Raises
    ------
    NotFound
        If there is no such design or revision.
    """
    with database.read() as session:
        event = repository.design(session, asked.design).event
        number = asked.revision or repository.head(session, asked.design).number
        document = Document.model_validate(repository.document(session, asked.design, number))
    steps = [(step.template, step.version) for step in document.steps.values()]
    models = [(model.id, model.version) for model in document.models.values()]
    used = [*_digests(catalogues.templates, steps), *_digests(catalogues.models, models)]
    return replace(asked, revision=number), (str(event), *used)


def calculated_revision(
    asked: AboutRevision, database: Database, catalogues: Catalogues
) -> tuple[RevisionRow, Document, Calculation]:
    """Return the revision that a request names, by default the newest, with document and calculation.

    Iterations have their final values. The calculation keeps faults of values.

    Raises
    ------
    NotFound
        If there is no such design or revision.
    """
    with database.read() as session:
        row = (
            repository.head(session, asked.design)
            if asked.revision is None
            else repository.revision(session, asked.design, asked.revision)
        )
    document = Document.model_validate(row.document)
    graph, faults = build_graph(document, catalogues)
    raise_if(faults)
    assumed = {**starts(document), **iterated(row.results)}
    return row, document, calculate(graph, built(database), analysed(database), assumed)


def _digests(catalogue: Catalogue[T], versions: Iterable[tuple[str, object]]) -> Iterator[str]:
    """Yield the digest of each version, or a placeholder for a version that no longer exists."""
    for id, version in versions:
        assert isinstance(version, int), "a revision pins every version"
        try:
            yield digest(catalogue.get(id, version))
        except UnknownTemplate:
            yield f"unknown {id} {version}"
