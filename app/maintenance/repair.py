"""Repair a data folder that no service uses: rebuild lost files, set files aside that no row names."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import TypeVar, TypeVarTuple

from app.calculations.errors import InvalidBody, NoArray, TooManyValues
from app.calculations.operations import answered
from app.calculations.questions import EVALUATION
from app.catalogue.catalogues import Catalogues, loaded
from app.imported_models.programs import Programs, assembled
from app.imported_models.registry import ImportedModelRegistry
from app.jobs import repository as jobs
from app.maintenance.check import Faults, Say
from app.maintenance.rows import NamedFile
from app.pool.questions import place_of_answer, question_of
from app.pool.sources import source_of
from app.settings import Settings
from app.solids import analysis_rows as analyses
from app.solids.analysis_process import AnalysisRunner
from app.solids.builds import Builds
from app.solids.shapes import shape_of
from app.storage.artifacts import Artifacts
from app.storage.database import Database
from app.storage.errors import ArtifactDamaged, ArtifactMissing, CannotRebuild
from app.storage.folder import DataFolder
from app.storage.stores import opened_store
from app.workers.base import Limits
from app.workers.errors import WorkerError
from app.workers.local import LocalProcesses
from app.worksheets.publication import WorksheetPublication
from cad.analysis.kinds import SURFACE
from cad.errors import AnalysisError, GeometryError
from cad.export import is_derived
from cad.regenerate import build_key
from templates.core.errors import TemplateError

T = TypeVar("T")
Ts = TypeVarTuple("Ts")

FAILURES = (
    CannotRebuild,
    TemplateError,
    GeometryError,
    AnalysisError,
    WorkerError,
    InvalidBody,
    NoArray,
    TooManyValues,
    ArtifactMissing,
    ArtifactDamaged,
)


class Direct:
    """Runs functions in a job process without a job in the queue."""

    def __init__(self, worker: LocalProcesses, limits: Limits) -> None:
        self._batch, self._limits = worker.batch(), limits

    def run(self, function: Callable[[*Ts], T], *args: *Ts, limits: Limits | None = None) -> T:
        """Run a function; see `Worker.run`."""
        return self._batch.run(function, *args, limits=limits or self._limits)


class Repair:
    """Rebuilds files with the service's own code, in separate processes."""

    def __init__(
        self,
        database: Database,
        store: Artifacts,
        settings: Settings,
        worker: LocalProcesses,
        programs: Programs,
    ) -> None:
        self.database, self.store = database, store
        files = loaded(settings.template_folders)
        self.catalogues = Catalogues(files.templates, files.models)
        WorksheetPublication(database, self.catalogues, is_shared=False, at_once=math.inf)
        ImportedModelRegistry(database, self.catalogues, is_shared=False)
        self.builds = Builds(database, store, programs)
        longest = Limits(
            settings.analysis_deadline, settings.analysis_memory_mb, "CRANKWRIGHT_ANALYSIS_MEMORY_MB"
        )
        self.analysing = AnalysisRunner(database, store, longest)
        self.calculation = Limits(
            settings.calculation_job_deadline,
            settings.calculation_memory_mb,
            "CRANKWRIGHT_CALCULATION_MEMORY_MB",
        )
        self.runner = Direct(
            worker, Limits(settings.job_deadline, settings.job_memory_mb, "CRANKWRIGHT_JOB_MEMORY_MB")
        )

    def row(self, row: NamedFile) -> str | None:
        """Repair the file that a row names; return the reason if that is impossible."""
        if row.kind == "body":
            return "it is not kept anywhere else; nothing needs it as long as the job's answer is good"
        if row.kind == "rows":
            return "the service calculates the rows again when they are read; a table that was sent is lost"
        if row.kind == "import":
            return "the worksheet is kept as text; the file that it was imported from is lost"
        if row.kind == "model":
            return "it is the file of an imported model: restore it from a backup, or import it again"
        try:
            if row.kind == "answer":
                self._answer(row)
            elif row.kind == SURFACE:
                self._surface(row.owner)
            else:
                self.builds.restore(row.owner, self.catalogues.models, self.runner)
                if is_derived(row.kind):
                    self.builds.derive(row.owner, row.kind, self.runner)
        except FAILURES as error:
            return str(error)
        return None

    def _answer(self, row: NamedFile) -> None:
        """Recalculate the answer of a job; only its elapsed time may differ."""
        if self.store.exists(row.sha):  # otherwise `exists` has just set it aside
            return
        with self.database.read() as session:
            job = jobs.get(session, row.owner)
        assert job is not None, "it has just been named"
        if job.kind != EVALUATION.name:
            raise CannotRebuild("answer_lost", f"job {job.id} is not a calculation; send its request again")
        question = question_of(EVALUATION.form, job, self.store)
        source = source_of(self.catalogues.templates.get(question.template, question.version))
        sha = self.store.put(*self.runner.run(answered, source, question, limits=self.calculation))
        link = place_of_answer(job.id, sha)
        self.database.write(lambda session: jobs.set_result(session, job.id, link))

    def _surface(self, key: str) -> None:
        with self.database.read() as session:
            build, question, _ = analyses.asked(session, key)
            shape = shape_of(session, self.catalogues.models, build)
        if question.key(build_key(shape)) != key:
            raise CannotRebuild("other_recipe", "another version of kernel, solver or recipe computed it")
        self.builds.make(shape, self.runner)
        self.analysing.find(shape, question, (SURFACE,), self.runner)


def repair(folder: DataFolder, url: str, findings: Faults, settings: Settings, say: Say) -> None:
    """Repair as much as possible, and return the actions taken; the caller holds the data folder."""
    if findings.damaged:
        _rebuild(opened_store(settings, folder), url, findings, settings, say)
    if findings.unnamed and settings.artifacts_url is None:
        say(_moved_aside(folder.path, [Path(place) for place in findings.unnamed.values()]))
    elif findings.unnamed:
        say(f"{len(findings.unnamed)} files that no row names stay: the service deletes them after a while")


def _rebuild(store: Artifacts, url: str, findings: Faults, settings: Settings, say: Say) -> None:
    database, worker = Database(url), LocalProcesses()
    programs = assembled(settings, store)
    try:
        repairing = Repair(database, store, settings, worker, programs)
        for row in findings.damaged:
            why = repairing.row(row)
            name = f"{row.kind} of {row.owner}"
            say(f"not repaired: {name}: {why}" if why else f"repaired: {name}")
    finally:
        programs.close()
        worker.close()
        database.close()


def _moved_aside(data: Path, files: list[Path]) -> str:
    """Move files that no row names into a separate folder; nothing is deleted."""
    aside = data / f"unreferenced-{datetime.now(UTC):%Y%m%dT%H%M%S}"
    aside.mkdir()
    for file in files:
        os.rename(file, aside / file.name)
    return f"{len(files)} files that no row names moved into {aside}; nothing was deleted"
