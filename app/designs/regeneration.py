"""The job that completes a revision: build and measure solids, calculate dependent steps, iterate."""

from __future__ import annotations

from collections.abc import Mapping

from sqlalchemy.orm import Session

from app.catalogue.catalogues import Catalogues
from app.designs import repository, results
from app.designs.analyses import measured_unit
from app.designs.document import Document, Iteration
from app.designs.engine.calculate import calculate, resume
from app.designs.engine.calculation import Calculation
from app.designs.errors import NotConverged
from app.designs.graph import Graph, build_graph, raise_if, starts
from app.designs.results import Outcome
from app.designs.roundings import between, in_words
from app.designs.service import REGENERATE, CalculationCache, DocumentCalculation
from app.designs.variants.checks import row_faults
from app.designs.variants.solids import Describe, VariantSolids, plain_problem
from app.designs.variants.together import Available, together
from app.jobs.service import Completion, Job, JobContext, JobFailed
from app.plain import Json, JsonObject
from app.pool.pool import Lane
from app.pool.steps import Steps, calling
from app.reference import Reference
from app.solids.analysis_process import AnalysisRunner
from app.solids.analysis_rows import analysed
from app.solids.builds import Builds, failures_named
from app.solids.rows import built
from app.storage.database import Database
from app.storage.errors import CannotRebuild
from app.workers.errors import DeadlineExceeded, MemoryExceeded
from cad.errors import AnalysisError, GeometryError
from templates.core.errors import FaultyText, InvalidInputs, TemplateError
from templates.core.units.units import unit

FAILURES = (
    NotConverged, TemplateError, GeometryError, AnalysisError, DeadlineExceeded, MemoryExceeded,
    CannotRebuild,
)  # fmt: skip
"""Errors that are caused by the design itself."""


class Regeneration:
    """Handles the jobs that complete a revision: `regenerate` and its related kinds."""

    def __init__(
        self,
        database: Database,
        builds: Builds,
        analysing: AnalysisRunner,
        catalogues: Catalogues,
        steps: Steps | None = None,
        calculation_cache: CalculationCache | None = None,
        describe: Describe = plain_problem,
    ) -> None:
        self.describe = describe
        self._solids = built(database), analysed(database)
        self.database, self.builds, self.catalogues = database, builds, catalogues
        self.analysing, self.steps, self.calculation_cache = (
            analysing,
            steps,
            calculation_cache or CalculationCache(),
        )

    def __call__(self, job: Job, context: JobContext) -> Completion:
        """Regenerate the revision of a job, and return a completion that stores the results.

        Raises
        ------
        JobFailed
            If the design itself has a fault; the error contains the problem.
        """
        assert job.design is not None
        assert job.revision is not None
        id, number = job.design, job.revision
        with self.database.read() as session:
            plain = repository.document(session, id, number)
        try:
            with calling(self.steps, job, context, f"design:{id}", _lane(job)):
                prepared = self._prepared(plain)
                calculation, rounds = self._settled(prepared, context)
                outcomes = self._variants(prepared.document, calculation, context)
        except FAILURES as error:
            raise JobFailed(self._named_by_change(error, id, number)) from error
        stored = results.stored(calculation, rounds, outcomes)
        models = results.models(calculation, outcomes)

        def completion(session: Session) -> str:
            repository.attach(session, id, number, stored, models)
            return f"/api/v1/designs/{id}/revisions/{number}"

        return completion

    def _named_by_change(self, error: Exception, id: str, number: int) -> Exception:
        """Return an interference with the parameters that changed since the last good model, if there is one.

        Parts that did not interfere before do so because of these. Defaults that follow from a changed
        parameter are not named beside it.
        """
        if not isinstance(error, GeometryError) or error.code != "interference":
            return error
        model = error.parameters[0].partition(".")[0]
        with self.database.read() as session:
            every = repository.changed_since_good(session, id, number)
            document = Document.model_validate(repository.document(session, id, number))
        changed = [name for name in every if name.startswith(f"{model}.")]
        if not changed or {*error.parameters} <= {*changed}:
            return error
        typed = {f"{model}.{name}" for name in document.models[model].parameters}
        changed = [name for name in changed if name in typed] or changed
        detail = f"{error.detail}. Changed since the last good model: {', '.join(changed)}"
        return GeometryError(error.code, detail, changed)

    def failed(self, session: Session, job: Job, problem: JsonObject) -> None:
        """Record in the revision why its regeneration failed.

        This runs in the transaction that ends the job.
        """
        if self.steps is not None:
            self.steps.drop(job.id)
        if job.design is not None and job.revision is not None:
            changed = repository.changed_since_good(session, job.design, job.revision)
            repository.fail(session, job.design, job.revision, {**problem, "changed": changed})

    def _prepared(self, plain: Mapping[str, Json]) -> DocumentCalculation:
        """Return a revision's document and its calculation, either from the cache of the save or repeated."""
        if prepared := self.calculation_cache.find(plain):
            return prepared
        document = Document.model_validate(plain)
        graph, faults = build_graph(document, self.catalogues)
        raise_if(faults)
        return DocumentCalculation(document, self._calculated(graph, starts(document)))

    def _calculated(self, graph: Graph, assumed: Mapping[Reference, float]) -> Calculation:
        return calculate(graph, *self._solids, assumed)

    def _settled(
        self, prepared: DocumentCalculation, context: JobContext
    ) -> tuple[Calculation, list[JsonObject]]:
        """Return the calculation with all solids built and iterations converged, and the rounds used."""
        document, calculation = prepared
        rounds = list[JsonObject]()
        while True:
            calculation = self._built(calculation, context)
            if not document.iterations:
                return calculation, []
            assumed = calculation.assumed
            measured = {Reference.parse(i.through): _measure(calculation, i) for i in document.iterations}
            number = len(rounds) // max(1, len(measured)) + 1
            rounds += [_round(number, name, assumed[name], value) for name, value in measured.items()]
            unsettled = [i for i in document.iterations if not _settles(i, assumed, measured)]
            if not unsettled:
                return calculation, rounds
            for iteration in unsettled:
                done_before = [done for done in rounds if done["through"] == iteration.through]
                if len(done_before) >= iteration.limit:
                    rounded = _rounded_in_the_loop(calculation.graph, Reference.parse(iteration.through))
                    raise NotConverged(iteration.through, iteration.tolerance, done_before, rounded)
            calculation = self._calculated(calculation.graph, measured)

    def _variants(self, document: Document, base: Calculation, context: JobContext) -> list[Outcome]:
        """Return the variants of a document, each with its solids or with the reason of a failure."""
        if not document.variants:
            return []
        raise_if(row_faults(base))
        available = Available(self.catalogues, *self._solids)
        settling = VariantSolids(self.builds, self._settle, self.describe, context)
        return settling.settled(together(document, available))

    def _settle(self, prepared: DocumentCalculation, context: JobContext) -> Calculation:
        return self._settled(prepared, context)[0]

    def _built(self, calculation: Calculation, context: JobContext) -> Calculation:
        """Return the calculation after all its models are built and all used analyses are finished.

        A model may need measurements of another one, so each round builds the models that can be built.
        """
        while True:
            raise_if(calculation.faults)
            if not self.builds.keep(calculation.shapes[name] for name in calculation.measures):
                calculation = self._calculated(calculation.graph, calculation.assumed)
                continue  # a build was deleted in the meantime and must be built again
            waiting = sorted(calculation.shapes.keys() - calculation.measures.keys())
            for name in waiting:
                with failures_named(name):
                    self.builds.make(calculation.shapes[name], context)
            if not self._analysed(calculation, context) and not waiting:
                return calculation
            calculation = resume(calculation, *self._solids)

    def _analysed(self, calculation: Calculation, context: JobContext) -> bool:
        """Analyse every solid that needs it; return whether there was any."""
        waiting = calculation.waiting()
        for node in waiting:
            name, kind = node.model.name, node.kind
            question = node.model.analyses[kind]
            with failures_named(name, kind):
                self.builds.make(calculation.shapes[name], context)  # the file of the solid may be lost
                self.analysing.find(
                    calculation.shapes[name], question, calculation.graph.wanted(name, kind), context
                )
        return bool(waiting)


def _lane(job: Job) -> Lane:
    """Return the lane of a job, so that a quick change never waits for long calculations."""
    return "answers" if job.kind == REGENERATE else "jobs"


def _rounded_in_the_loop(graph: Graph, through: Reference) -> str:
    """Return the rounded values between a measurement and the parameters of its model; empty if none is."""
    inside = [cell.reference for cell in graph.cells() if cell.reference.block == through.block]
    return in_words(between(graph, [through], inside).get(through, []))


def _measure(calculation: Calculation, iteration: Iteration) -> float:
    try:
        return float(calculation.measure(Reference.parse(iteration.through)))
    except FaultyText as error:
        raise InvalidInputs([error.fault("iterations")]) from error


def _round(number: int, through: Reference, assumed: float, measured: float) -> JsonObject:
    scale = unit(measured_unit(through))
    shown = {"assumed": float(scale.from_si(assumed)), "measured": float(scale.from_si(measured))}
    return {"round": number, "through": str(through), **shown, "unit": scale.text}


def _settles(
    iteration: Iteration, assumed: Mapping[Reference, float], measured: Mapping[Reference, float]
) -> bool:
    through = Reference.parse(iteration.through)
    old, new = assumed[through], measured[through]
    return abs(new - old) <= iteration.tolerance * max(abs(new), abs(old))
