"""Create the parts of the service from its settings; an exit stack closes them in reverse order."""

from __future__ import annotations

from contextlib import ExitStack, closing
from typing import TYPE_CHECKING

from app.answers.service import AnswerService
from app.api.responses import Threads
from app.api.services import QuestionServices, Services
from app.approvals.comments import Comments
from app.approvals.service import ApprovalService
from app.calculations.assembly import Calculations, assemble_calculations
from app.calculations.cache import results
from app.calculations.questions import EVALUATION
from app.catalogue.catalogues import Catalogues, TeamCatalogues
from app.catalogue.check import CheckInProcess
from app.catalogue.discovery import find_templates
from app.designs.decisions import DECISIONS
from app.designs.explanation import EXPLANATIONS
from app.designs.labels import LabelService
from app.designs.preview import PREVIEWS
from app.designs.questions import in_a_process
from app.designs.regeneration import Regeneration
from app.designs.schemas.solution import DesignSolution
from app.designs.service import CALCULATE, REGENERATE, REGENERATE_SLOWLY, CalculationCache, Designs
from app.designs.solution import solved
from app.designs.variants.detail import VARIANT_DETAILS
from app.http import problems
from app.http.streams import Streams
from app.identity.sealer import Sealer
from app.identity.service import Identity
from app.impact.survey import IMPACTS
from app.imported_models.programs import assembled as assembled_programs
from app.imported_models.registry import ImportedModelRegistry
from app.imported_models.service import IMPORT as MODEL_IMPORT
from app.imported_models.service import ModelImports
from app.jobs.service import Jobs
from app.observation import metrics, readiness
from app.pool.questions import CALCULATION, SOLUTION, TOLERANCE, A, Kind, Q, Questions
from app.pool.steps import Steps
from app.reports.paper import Press
from app.reports.service import Reports
from app.retention.service import Retention
from app.settings import Settings
from app.settings.machines import LOCAL
from app.signing.keys import opened_keys
from app.solids.analyses import ANALYSIS, Analyses, ModelAnalysis
from app.solids.analysis_process import AnalysisRunner
from app.solids.builds import Builds
from app.solids.models import BUILD, ModelBuild, Models
from app.solids.repair import ArtifactRepair
from app.storage.artifacts import Artifacts
from app.storage.connection import opened_database
from app.storage.database import Database
from app.storage.folder import DataFolder
from app.storage.ownership import claim
from app.storage.stores import Figures, opened_store
from app.studies.run import LANES, StudyServices
from app.studies.solids import SolidPool
from app.tolerances.answer import analysed
from app.tolerances.schemas import ToleranceAnalysis
from app.workers import prefork
from app.workers.base import BatchWorker, Limits, Worker
from app.workers.choice import started_workers
from app.workers.light import CHECKS
from app.workers.local import LocalProcesses
from app.worksheets.imports.service import IMPORT, Imports
from app.worksheets.publication import WorksheetPublication
from app.worksheets.service import Worksheets
from cad.catalogue import models as find_models

if TYPE_CHECKING:
    from app.observation.traces import Traces


from app.studies.conclude import StudyConclusion
from app.studies.repair import ChunkRepair
from app.studies.run import STUDY, StudyRunner
from app.studies.service import Studies
from app.studies.variant_design import DesignFactory

NETWORK = (
    "app.answers.tasks",
    "app.designs.engine.design_engine",
    "app.impact.process",
    "app.studies.plan",
    "app.studies.search_slice",
    "app.studies.sensitivities",
)
"""Modules loaded by processes that calculate rows of designs."""
SHEETS = ("app.worksheets.check",)
"""Modules loaded by all calculation processes, to read worksheets."""
FIGURES = Figures(metrics.bucket_asked, metrics.copy_looked_for)


def assemble(settings: Settings, stack: ExitStack, traces: Traces | None = None) -> Services:
    """Create all parts of the service, and start taking jobs."""
    folder, database, store = open_data(settings, stack, traces)
    stack.callback(prefork.close)
    workers = started_workers(settings, stack)
    catalogues = find_catalogues(settings, workers.here)
    stack.callback(catalogues.close)
    jobs = job_service(settings, database, workers.of_jobs, traces)
    start_sealer(database, stack)
    registry = followed_imports(database, catalogues, stack)
    published = published_worksheets(database, catalogues, stack)
    calculations = assemble_calculations(settings, stack, NETWORK, SHEETS)
    calculation_cache = CalculationCache()
    programs = assembled_programs(settings, store)
    stack.callback(programs.close)
    builds = Builds(database, store, programs)
    analysing = AnalysisRunner(
        database,
        store,
        Limits(settings.analysis_deadline, settings.analysis_memory_mb, "CRANKWRIGHT_ANALYSIS_MEMORY_MB"),
    )
    register_jobs(jobs, builds, analysing, catalogues, calculations, calculation_cache)
    designs = Designs(database, jobs, catalogues, calculation_cache)
    models = Models(database, store, jobs, catalogues)
    about = database, catalogues, store, jobs, calculations.steps
    questions = assemble_questions(*about)
    answers = question_service(AnswerService(designs, models, jobs).kind, *about)
    solids = SolidPool(database, builds, analysing, settings.workers)
    of_studies = StudyServices(
        database, store, catalogues, calculations.pool, jobs, calculations.steps, solids
    )
    studies = assemble_studies(of_studies, designs)
    worksheets = Worksheets(database, catalogues, calculations.pool, published)
    imports = Imports(store, jobs, catalogues, worksheets)
    jobs.register(IMPORT, imports)
    model_imports = ModelImports(database, store, jobs, catalogues, programs, registry)
    jobs.register(MODEL_IMPORT, model_imports)
    jobs.start({**calculations.lanes, **LANES})
    stack.callback(jobs.stop)
    analyses = Analyses(database, store, jobs)
    return Services(
        settings=settings,
        catalogues=catalogues,
        database=database,
        identity=Identity(database, settings),
        store=store,
        jobs=jobs,
        calculations=calculations.pool,
        steps=calculations.steps,
        threads=Threads(),
        designs=designs,
        answers=answers,
        labelling=LabelService(database),
        studies=studies,
        worksheets=worksheets,
        imports=imports,
        models=models,
        model_imports=model_imports,
        analyses=analyses,
        healing=ArtifactRepair(database, store, models, analyses),
        approving=ApprovalService(database, store),
        comments=Comments(database),
        reports=Reports(database, store, models, catalogues, settings.owner),
        press=Press(
            workers.here,
            Limits(settings.job_deadline, settings.job_memory_mb, "CRANKWRIGHT_JOB_MEMORY_MB"),
            settings.workers,
        ),
        streams=Streams(settings.streams, settings.streams_per_client),
        readiness=readiness.Readiness(
            {
                **data_checks(database, store, folder, settings),
                "processes": readiness.Processes(workers.of_jobs, workers.why_silent),
                "calculations": readiness.Processes(calculations.pool),
            }
        ),
        stamp_keys=opened_keys(settings),
        **questions,
    )


def open_data(
    settings: Settings, stack: ExitStack, traces: Traces | None
) -> tuple[DataFolder, Database, Artifacts]:
    """Return the data folder, the database and the store of files; start the deletion of what has expired."""
    folder = DataFolder(settings.data)
    stack.callback(folder.release)
    database = opened_database(settings, folder, metrics.committed)
    stack.callback(database.close)
    if traces is not None:
        database.write_through(traces.writer)
    store = opened_store(settings, folder, FIGURES)
    if settings.artifacts_url is not None:
        claim(database, store)
    results.limit(settings.cache_mb)
    retention = Retention(database, store, settings)
    retention.start()
    stack.callback(retention.stop)
    return folder, database, store


def job_service(settings: Settings, database: Database, worker: BatchWorker, traces: Traces | None) -> Jobs:
    """Return the job service; with traces, each job is recorded in a span."""
    if traces is None:
        return Jobs(database, worker, settings, problems.describe)
    jobs = Jobs(database, traces.worker(worker), settings, problems.describe)
    jobs.run_within(traces.job)
    return jobs


def start_sealer(database: Database, stack: ExitStack) -> None:
    """Start to seal the audit trail."""
    sealer = Sealer(database)
    sealer.start()
    stack.callback(sealer.stop)


def followed_imports(database: Database, catalogues: Catalogues, stack: ExitStack) -> ImportedModelRegistry:
    """Return the registry of imported models, which follows the imports of other servers."""
    registry = ImportedModelRegistry(database, catalogues, is_shared=database.is_shared)
    registry.follower.start()
    stack.callback(registry.follower.stop)
    return registry


def assemble_questions(
    database: Database, catalogues: Catalogues, store: Artifacts, jobs: Jobs, steps: Steps
) -> QuestionServices:
    """Return the services for all kinds of questions."""
    about = database, catalogues, store, jobs, steps
    return QuestionServices(
        evaluations=question_service(EVALUATION, *about),
        previews=question_service(PREVIEWS, *about),
        decisions=question_service(DECISIONS, *about),
        explanations=question_service(EXPLANATIONS, *about),
        impacts=question_service(IMPACTS, *about),
        solving=question_service(in_a_process(SOLUTION, DesignSolution, solved), *about),
        tolerances=question_service(in_a_process(TOLERANCE, ToleranceAnalysis, analysed), *about),
        variant_details=question_service(VARIANT_DETAILS, *about),
    )


def question_service(
    kind: Kind[Q, A], database: Database, catalogues: Catalogues, store: Artifacts, jobs: Jobs, steps: Steps
) -> Questions[Q, A]:
    """Return the service for one kind of question, with its job handler registered."""
    service = Questions(kind, database, catalogues, store, jobs, steps)
    jobs.register(kind.name, service, service.failed, lane=CALCULATION)
    return service


def data_checks(
    database: Database, store: Artifacts, folder: DataFolder, settings: Settings
) -> dict[str, readiness.Check]:
    """Return the checks of the data that must pass before the service reports that it is ready."""
    checks: dict[str, readiness.Check] = {
        "database": readiness.WriterProbe(database),
        "space": readiness.Space(folder.path, settings.minimum_free_mb),
    }
    return checks if settings.artifacts_url is None else {**checks, "files": readiness.Files(store)}


def find_catalogues(settings: Settings, worker: Worker) -> Catalogues:
    """Return the catalogues. A worker process checks every file of a team before the server loads it.

    At the start, a light process checks the files that do not import the kernel, so that no request waits for
    that check.
    """
    if not settings.template_folders:
        return Catalogues(find_templates(()), find_models())
    limits = Limits(settings.template_seconds, settings.job_memory_mb, "CRANKWRIGHT_JOB_MEMORY_MB")
    check = CheckInProcess(worker, limits)
    if settings.engine != LOCAL:
        return TeamCatalogues(settings.template_folders, check)
    with closing(LocalProcesses(CHECKS)) as light:  # ready long before a process that loads the kernel
        return TeamCatalogues(settings.template_folders, check, CheckInProcess(worker, limits, light))


def published_worksheets(
    database: Database, catalogues: Catalogues, stack: ExitStack
) -> WorksheetPublication:
    """Return the released worksheets among the templates.

    A SQLite database has a single server, so that server makes all releases.
    """
    published = WorksheetPublication(database, catalogues, is_shared=database.is_shared)
    published.follower.start()
    stack.callback(published.follower.stop)
    return published


def register_jobs(
    jobs: Jobs,
    builds: Builds,
    analysing: AnalysisRunner,
    catalogues: Catalogues,
    calculations: Calculations,
    calculation_cache: CalculationCache,
) -> None:
    """Register the handler of each kind of job."""
    regeneration = Regeneration(
        builds.database,
        builds,
        analysing,
        catalogues,
        calculations.steps,
        calculation_cache,
        problems.describe,
    )
    jobs.register(REGENERATE, regeneration, regeneration.failed)
    jobs.register(REGENERATE_SLOWLY, regeneration, regeneration.failed, is_slow=True)
    jobs.register(CALCULATE, regeneration, regeneration.failed, lane=CALCULATION)
    jobs.register(BUILD, ModelBuild(builds, catalogues))
    jobs.register(ANALYSIS, ModelAnalysis(builds, analysing, catalogues), is_slow=True)


def assemble_studies(services: StudyServices, designs: Designs) -> Studies:
    """Return the service for studies, with its job handler registered."""
    conclude = StudyConclusion(DesignFactory(services, designs))
    repair = ChunkRepair(services, conclude)
    handler = StudyRunner(services, conclude, repair.heal)
    services.jobs.register(STUDY, handler, handler.failed, lane=STUDY)
    return Studies(
        services.database, services.store, services.jobs, services.catalogues, designs, repair.lost
    )
