"""Finite-element analyses of CAD models outside a design."""

from __future__ import annotations

from dataclasses import replace

from sqlalchemy.orm import Session

from app.catalogue.catalogues import Catalogues
from app.jobs.service import Completion, Job, JobContext, JobFailed, Jobs
from app.schemas.answers import Version
from app.solids import analysis_rows as repository
from app.solids import rows
from app.solids.analysis_process import AnalysisRunner, bore_of, is_stored, shaft_of
from app.solids.analysis_views import shown
from app.solids.builds import Builds
from app.solids.models import FAILURES, File
from app.solids.questions import Question, under_load
from app.solids.rows import is_fresh, renew
from app.solids.schemas.analyses import Analysis
from app.solids.shapes import shape_of
from app.storage.artifacts import Artifacts
from app.storage.database import Database
from app.storage.errors import CannotRebuild, NotFound
from cad.analysis.kinds import BORE_COMPLIANCE, SURFACE
from cad.errors import AnalysisError
from cad.model import CadModel
from cad.regenerate import as_text, build_key
from templates.core.catalogue.discovery import Catalogue

ANALYSIS = "analysis"


class Analyses:
    """Requests analyses of models, and returns their results."""

    def __init__(self, database: Database, store: Artifacts, jobs: Jobs) -> None:
        self.database, self.store, self.jobs = database, store, jobs

    def request(
        self, shape: CadModel, question: Question, outputs: tuple[str, ...], client: str = ""
    ) -> str | None:
        """Return the job that builds and analyses a model, or None if all outputs are stored.

        Raises
        ------
        AnalysisError
            If the model is not a shaft, or a bore analysis is requested and it has no split bore.
        """
        bore_of(shape) if question.kind == BORE_COMPLIANCE else shaft_of(shape)
        build = build_key(shape)
        with self.database.read() as session:
            stored = repository.outputs_of(session, question.key(build))
            fresh = is_fresh(session, [build])
        there = all(is_stored(stored, name, self.store) for name in outputs)
        return None if there and fresh else self._enqueued(shape, question, outputs, client, there=there)

    def request_surface(self, key: str, catalogue: Catalogue[CadModel]) -> str:
        """Return the job that recomputes the lost surface of an analysis.

        Raises
        ------
        CannotRebuild
            If this program stores the answer to the same request under another key; a job computes that one.
        """
        with self.database.read() as session:
            build, question, _ = repository.asked(session, key)
            shape = shape_of(session, catalogue, build)
        job, now = self._enqueued(shape, question, (SURFACE,), ""), question.key(build_key(shape))
        assert job is not None, "nothing is said to be there"
        if now == key:
            return job
        links = {"analysis": f"/api/v1/analyses/{now}", "job": f"/api/v1/jobs/{job}"}
        detail = (
            f"the surface of analysis {key} was computed by another version of the kernel, the solver or the "
            "recipe. Restore the file from a backup, or use the new analysis"
        )
        raise CannotRebuild("other_recipe", detail, links)

    def _enqueued(
        self,
        shape: CadModel,
        question: Question,
        outputs: tuple[str, ...],
        client: str,
        *,
        there: bool = False,
    ) -> str | None:
        """Return the job; None if all outputs are stored and their build has not been deleted meanwhile."""
        payload = {
            "model": shape.id,
            "version": shape.version,
            "parameters": as_text(shape),
            "question": question.kept(),
            "outputs": [*outputs],
        }

        def unit(session: Session) -> str | None:
            if renew(session, [build_key(shape)]) and there:
                return None
            return self.jobs.request(session, ANALYSIS, payload, client)

        return self.jobs.commit(unit)

    def show(self, shape: CadModel, question: Question, outputs: tuple[str, ...]) -> Analysis:
        """Return the requested outputs that are stored."""
        build = build_key(shape)
        with self.database.read() as session:
            stored = repository.outputs_of(session, question.key(build))
        computed = under_load(question, {name: stored[name] for name in outputs if name in stored})
        return shown(Version(id=shape.id, version=shape.version), build, question, computed)

    def show_all(self, key: str, load: float) -> Analysis:
        """Return all stored outputs of an analysis of a build, under a load [N·m].

        Raises
        ------
        NotFound
            If there is no analysis with this key.
        """
        with self.database.read() as session:
            build, question, outputs = repository.asked(session, key)
            question = replace(question, load=load)
            return shown(_model_of(session, build), build, question, under_load(question, outputs))

    def of_build(self, build: str) -> list[Analysis]:
        """Return all stored outputs of a build, under 1 N·m.

        Raises
        ------
        NotFound
            If there is no such build.
        """
        with self.database.read() as session:
            model = _model_of(session, build)
            return [shown(model, build, *answered) for answered in repository.of_build(session, build)]

    def surface(self, key: str) -> File:
        """Return the surface that an analysis computed.

        Raises
        ------
        NotFound
            If it was not requested.
        """
        with self.database.read() as session:
            _, question, outputs = repository.asked(session, key)
        if SURFACE not in outputs:
            detail = f"this analysis has no {SURFACE} yet: ask for it by name in `outputs` of {question.kind}"
            raise NotFound(detail)
        return File("json", outputs[SURFACE]["sha256"])


def _model_of(session: Session, build: str) -> Version:
    row = rows.build(session, build)
    if row is None:
        raise NotFound(f"there is no build {build[:80]!r}")
    return Version(id=row.model, version=row.version)


class ModelAnalysis:
    """The handler of jobs of the kind `analysis`, which build a model and analyse it."""

    def __init__(self, builds: Builds, analysing: AnalysisRunner, catalogues: Catalogues) -> None:
        self.builds, self.analysing, self.catalogues = builds, analysing, catalogues

    def __call__(self, job: Job, context: JobContext) -> Completion:
        """Build the model, then analyse it.

        Raises
        ------
        JobFailed
            If the model itself causes an error; the failure contains the problem.
        """
        asked = job.payload
        question = Question(**asked["question"])
        try:
            cls = self.catalogues.models.get(asked["model"], asked["version"])
            shape = cls.from_quantities(asked["parameters"])
            self.builds.make(shape, context)
            self.analysing.find(shape, question, tuple(asked["outputs"]), context)
        except (*FAILURES, AnalysisError) as error:
            raise JobFailed(error) from error
        return lambda session: f"/api/v1/analyses/{question.key(build_key(shape))}"
