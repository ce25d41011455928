"""Build, analyse and measure the solids that rows of a study need, one by one, in the study's job.

All solids of a study share a process (`JobContext`). A recorded build is not built twice, so a killed study
reuses its builds. If a solid fails, only the rows that use it fail.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from app.catalogue.catalogues import Catalogues
from app.designs.analyses import measured_unit
from app.designs.document import Document
from app.designs.engine.calculation import NOT_MEASURED
from app.designs.engine.design_engine import Refusal
from app.designs.engine.refusals import refusal_of
from app.designs.graph import build_graph, raise_if
from app.designs.network import Graph
from app.jobs.service import JobContext
from app.reference import Reference
from app.solids.analysis_process import AnalysisRunner
from app.solids.analysis_rows import analysed
from app.solids.builds import Builds
from app.solids.questions import in_order
from app.solids.rows import built
from app.storage.database import Database
from app.storage.errors import CannotRebuild
from app.studies.row_solids import SolidMeasures, SolidRequest, Solids, Texts
from app.workers.base import Runner
from app.workers.errors import DeadlineExceeded, JobCancelled, JobCrashed, MemoryExceeded
from cad.errors import AnalysisError, GeometryError
from cad.model import CadModel
from templates.core.errors import InvalidInputs, TemplateError
from templates.core.units.units import unit

FAILURES = (
    TemplateError, GeometryError, AnalysisError, DeadlineExceeded, MemoryExceeded, JobCrashed, CannotRebuild,
)  # fmt: skip
"""Errors that a solid itself causes."""
CODES: dict[type[Exception], str] = {
    DeadlineExceeded: "too_long",
    MemoryExceeded: "too_much_memory",
    JobCrashed: "crashed",
    CannotRebuild: "lost",
}
"""Codes of refused rows for failures without a code."""
MOST_CRASHES = 2  # largest number of crashes of the process that builds one solid
GLANCE = 0.05  # interval at which a waiting study checks whether it was cancelled [s]


class SolidPool:
    """Makes solids for studies; at most as many at a time as the service has job threads."""

    def __init__(self, database: Database, builds: Builds, analysing: AnalysisRunner, most: int) -> None:
        self.database, self.builds, self.analysing = database, builds, analysing
        self._turns = threading.BoundedSemaphore(most)

    def of(self, document: Document, catalogues: Catalogues, context: JobContext) -> StudySolids:
        """Return the solids of one study."""
        return StudySolids(self, document, catalogues, context)

    @contextmanager
    def turn(self, context: JobContext) -> Iterator[None]:
        """Wait until a solid may be made, and occupy one place of the pool in the block.

        Raises
        ------
        JobCancelled
            If the study is cancelled while it waits.
        """
        while not self._turns.acquire(timeout=GLANCE):
            if context.is_cancelled:
                raise JobCancelled
        try:
            yield
        finally:
            self._turns.release()


@dataclass
class StudySolids:
    """The solids of one study while a job calculates it."""

    making: SolidPool
    document: Document
    catalogues: Catalogues
    context: JobContext
    _graph: Graph | None = None
    _measures: dict[tuple[str, Texts], SolidMeasures] = field(default_factory=dict)

    @property
    def measured(self) -> Solids:
        """Return the solids that are known so far."""
        return tuple(self._measures.values())

    def is_known(self, wanting: SolidRequest) -> bool:
        """Return whether a solid was measured, or has failed."""
        return (wanting.model, wanting.texts) in self._measures

    def make(self, wanting: SolidRequest) -> None:
        """Build and measure a solid, or record why it has no measurements.

        Raises
        ------
        JobCancelled
            If the study is cancelled.
        """
        with self.making.turn(self.context):
            self._measures[wanting.model, wanting.texts] = self._measured_solid(wanting)

    def _measured_solid(self, wanting: SolidRequest) -> SolidMeasures:
        try:
            measures = tuple(self._measured(wanting).items())
        except FAILURES as error:
            return SolidMeasures(wanting.model, wanting.texts, failure=_refusal(wanting.model, error))
        return SolidMeasures(wanting.model, wanting.texts, measures)

    def _measured(self, wanting: SolidRequest) -> dict[str, float]:
        """Return the measurements of a solid [SI], by their names within its model."""
        model = self.document.models[wanting.model]
        assert isinstance(model.version, int), "a revision pins every version"
        shape = self.catalogues.models.get(model.id, model.version).from_quantities(dict(wanting.texts))
        runner = self.context.quietly()
        self._build(shape, runner)
        measures = built(self.making.database)(shape)
        assert measures is not None, "it has just been built"
        values: dict[str, float] = {}
        for name in wanting.measures:
            reference = Reference.parse(f"{wanting.model}.{name}")
            if reference.analysis is None and name not in measures:
                raise AnalysisError("no_value", f"{reference} has no value: {NOT_MEASURED}")
            if reference.analysis is None:
                values[name] = float(unit(measured_unit(reference)).to_si(measures[name]))
        return values | self._analysed(wanting, shape, runner)

    def _build(self, shape: CadModel, runner: Runner) -> None:
        for attempt in range(MOST_CRASHES):
            try:
                self.making.builds.make(shape, runner)
            except JobCrashed:
                if attempt + 1 == MOST_CRASHES:
                    raise
            else:
                return

    def _analysed(self, wanting: SolidRequest, shape: CadModel, runner: Runner) -> dict[str, float]:
        """Return the results of finite-element analyses of a solid [SI]."""
        references = [Reference.parse(f"{wanting.model}.{name}") for name in wanting.measures]
        values: dict[str, float] = {}
        for kind in dict.fromkeys(r.analysis for r in references if r.analysis is not None):
            question = self._questions().blocks[wanting.model].analyses[kind]
            outputs = in_order(kind, {r.output for r in references if r.analysis == kind and r.output})
            self.making.analysing.find(shape, question, outputs, runner)
            stored = analysed(self.making.database)(shape, question, outputs)
            assert stored is not None, "it has just been analysed"
            for output in outputs:
                name, value = f"{kind}.{output}", stored[output]["value"]
                if value is None:
                    raise AnalysisError("no_value", f"{name} has no value: {stored[output]['reason']}")
                assert isinstance(value, int | float), "a study reads single values"
                scale = unit(measured_unit(Reference.parse(f"{wanting.model}.{name}")))
                values[name] = float(scale.to_si(value))
        return values

    def _questions(self) -> Graph:
        """Return the network of the design, which has the analyses of its models."""
        if self._graph is None:
            self._graph, faults = build_graph(self.document, self.catalogues)
            raise_if(faults)
        return self._graph


def _refusal(model: str, error: Exception) -> Refusal:
    """Return the refusal of the rows whose solid failed."""
    if isinstance(error, InvalidInputs):
        return refusal_of([fault.within(model) for fault in error.faults])
    code = CODES.get(type(error)) or getattr(error, "code", "failed")
    return Refusal(model, str(code), str(error))
