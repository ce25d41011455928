"""The job behind a revision: build what is not built, measure, calculate what waited, iterate if declared."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from sqlalchemy.orm import Session

from app.designs import repository, results
from app.designs.calculate import Calculation, calculate
from app.designs.document import Document, Iteration
from app.designs.errors import NotConverged
from app.designs.graph import Catalogues, Graph, build_graph, raise_if
from app.designs.service import built, starts
from app.jobs.service import Completion, Job, JobContext, JobFailed
from app.models.builds import Builds
from app.problems import describe
from app.storage.database import Database
from app.workers.errors import DeadlineExceeded, MemoryExceeded
from cad.errors import GeometryError
from cad.inspect import MEASURES
from templates.core.errors import TemplateError
from templates.core.units import unit


class Regeneration:
    """The handler of jobs of the kind `regenerate`."""

    def __init__(self, database: Database, builds: Builds, catalogues: Catalogues) -> None:
        self.database, self.builds, self.catalogues = database, builds, catalogues

    def __call__(self, job: Job, context: JobContext) -> Completion:
        """Regenerate the revision of a job; the completion attaches what was found.

        Raises
        ------
        JobFailed
            With the problem, for anything that the design itself brings about.
        """
        assert job.design is not None
        assert job.revision is not None
        id, number = job.design, job.revision
        with self.database.read() as session:
            document = Document.model_validate(repository.revision(session, id, number).document)
        try:
            calculation, rounds = self._settled(document, context)
        except (NotConverged, TemplateError, GeometryError, DeadlineExceeded, MemoryExceeded) as error:
            raise JobFailed(describe(error)) from error
        told = {"steps": results.steps(calculation), "iterations": rounds}
        models = results.models(calculation)

        def completion(session: Session) -> str:
            repository.attach(session, id, number, told, models)
            return f"/api/v1/designs/{id}/revisions/{number}"

        return completion

    @staticmethod
    def failed(session: Session, job: Job, problem: dict[str, Any]) -> None:
        """Record in the revision why its regeneration failed; runs in the transaction that ends the job."""
        if job.design is not None and job.revision is not None:
            changed = repository.changed_since_good(session, job.design, job.revision)
            repository.fail(session, job.design, job.revision, {**problem, "changed": changed})

    def _settled(self, document: Document, context: JobContext) -> tuple[Calculation, list[dict[str, Any]]]:
        """The calculation with all solids built and all iterations settled, and the rounds that it took."""
        graph, faults = build_graph(document, self.catalogues)
        raise_if(faults)
        assumed, rounds = starts(document), list[dict[str, Any]]()
        while True:
            calculation = self._built(graph, assumed, context)
            measured = {i.through: calculation.measure(i.through) for i in document.iterations}
            number = len(rounds) // max(1, len(measured)) + 1
            rounds += [_round(number, name, assumed[name], value) for name, value in measured.items()]
            unsettled = [i for i in document.iterations if not _settles(i, assumed, measured)]
            if not unsettled:
                return calculation, rounds
            for iteration in unsettled:
                told = [done for done in rounds if done["through"] == iteration.through]
                if len(told) >= iteration.limit:
                    raise NotConverged(iteration.through, iteration.tolerance, told)
            assumed = measured

    def _built(self, graph: Graph, assumed: Mapping[str, float], context: JobContext) -> Calculation:
        """The calculation once every model in it is built; models may wait for each other's measures."""
        while True:
            with self.database.read() as session:
                calculation = calculate(graph, built(session), assumed)
            raise_if(calculation.faults)
            waiting = calculation.shapes.keys() - calculation.measures.keys()
            if not waiting:
                return calculation
            for name in sorted(waiting):
                with _named(name):
                    self.builds.make(calculation.shapes[name], context)


@contextmanager
def _named(model: str) -> Iterator[None]:
    """Let a failure of geometry name the model of the design."""
    try:
        yield
    except GeometryError as error:
        names = (f"{model}.{parameter}" for parameter in error.parameters)
        raise GeometryError(error.code, f"{model}: {error.detail}", names) from error


def _round(number: int, name: str, assumed: float, measured: float) -> dict[str, Any]:
    scale = unit(MEASURES[name.partition(".")[2]])
    shown = {"assumed": float(scale.from_si(assumed)), "measured": float(scale.from_si(measured))}
    return {"round": number, "through": name, **shown, "unit": scale.text}


def _settles(iteration: Iteration, assumed: Mapping[str, float], measured: Mapping[str, float]) -> bool:
    old, new = assumed[iteration.through], measured[iteration.through]
    return abs(new - old) <= iteration.tolerance * max(abs(new), abs(old))
