"""Makes the parts of the service from its settings; an exit stack ends them in reverse order."""

from __future__ import annotations

from contextlib import ExitStack, closing
from typing import TYPE_CHECKING

from app.api import problems, readiness
from app.api.answering import Answering
from app.api.gate.streams import Streams
from app.api.services import Services
from app.api.threads import Threads
from app.approvals.comments import Comments
from app.approvals.service import Approving
from app.brought.programs import assembled as assembled_programs
from app.brought.service import IMPORT as MODEL_IMPORT
from app.brought.service import ModelImports
from app.brought.shelf import Shelf
from app.calculations.assembly import Calculations, assemble_calculations
from app.calculations.cache import results
from app.calculations.jobs import CALCULATION, DECISION, IMPACT, PREVIEW, SOLUTION, TOLERANCE, VARIANT
from app.catalogue.catalogues import Catalogues, TeamCatalogues
from app.catalogue.checking import CheckInProcess
from app.catalogue.finding import find_templates
from app.designs import decisions as decisions_of
from app.designs.labels import Labelling
from app.designs.preview import Previewed, preview
from app.designs.questions import Asked, Questions, in_a_process
from app.designs.recent import Recent
from app.designs.regeneration import Regeneration
from app.designs.service import CALCULATE, REGENERATE, REGENERATE_SLOWLY, Designs
from app.designs.solved import solved
from app.designs.variants.detail import WantedVariant, detailed
from app.identity.sealing import Sealer
from app.identity.service import Identity
from app.impact import survey
from app.jobs.service import Jobs
from app.observation import metrics
from app.reports.paper import Press
from app.reports.service import Reports
from app.retention.service import Retention
from app.settings import Settings
from app.settings.machines import LOCAL
from app.solids.analyses import ANALYSIS, Analyses, ModelAnalysis
from app.solids.builds import Builds
from app.solids.finding import Analysing
from app.solids.healing import Healing
from app.solids.models import BUILD, ModelBuild, Models
from app.storage.artifacts import Artifacts
from app.storage.connecting import opened_database
from app.storage.database import Database
from app.storage.folder import DataFolder
from app.storage.opening import Figures, opened_store
from app.storage.ownership import claim
from app.studies.assembly import assemble_studies
from app.studies.running import LANES, Parts
from app.studies.solid_making import SolidMaking
from app.tolerances.process import analysed
from app.workers import ahead
from app.workers.base import Limits, Worker
from app.workers.light import CHECKS
from app.workers.local import LocalProcesses
from app.workers.started import started_workers
from app.worksheets.importing.service import IMPORT, Imports
from app.worksheets.published import Published
from app.worksheets.service import Worksheets
from cad.catalogue import models as find_models

if TYPE_CHECKING:
    from app.observation.traces import Traces

NETWORK = (
    "app.designs.engine.net",
    "app.impact.process",
    "app.studies.planning",
    "app.studies.searching",
    "app.studies.sensitivities",
)
"""Modules loaded by processes that calculate rows of designs."""
SHEETS = ("app.worksheets.checking",)
"""Modules loaded by all calculation processes, to read worksheets."""
FIGURES = Figures(metrics.bucket_asked, metrics.copy_looked_for)


def assemble(settings: Settings, stack: ExitStack, traces: Traces | None = None) -> Services:
    """Make all parts of the service, and begin to take jobs."""
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
    stack.callback(ahead.close)
    workers = started_workers(settings, stack)
    catalogues = find_catalogues(settings, workers.here)
    stack.callback(catalogues.close)
    of_jobs = workers.of_jobs if traces is None else traces.worker(workers.of_jobs)
    jobs = Jobs(database, of_jobs, settings, problems.describe)
    if traces is not None:
        jobs.run_within(traces.job)
    sealer = Sealer(database)
    sealer.start()
    stack.callback(sealer.stop)
    shelf = Shelf(database, catalogues, is_shared=database.is_shared)
    shelf.start()
    stack.callback(shelf.stop)
    published = published_worksheets(database, catalogues, stack)
    calculations = assemble_calculations(settings, stack, catalogues, database, store, jobs, NETWORK, SHEETS)
    recent = Recent()
    programs = assembled_programs(settings, store)
    stack.callback(programs.close)
    builds = Builds(database, store, programs)
    analysing = Analysing(database, store, Limits(settings.analysis_deadline, settings.analysis_memory_mb))
    register_jobs(jobs, builds, analysing, catalogues, calculations, recent)
    about = database, catalogues, store, jobs, calculations.steps
    previews = Questions(PREVIEW, Previewed, preview, *about)
    decisions = Questions(DECISION, decisions_of.Asked, decisions_of.decided, *about)
    impacts = Questions(IMPACT, survey.Asked, survey.impact, *about, survey.check)
    solving = Questions(SOLUTION, Asked, in_a_process(SOLUTION, solved), *about)
    tolerances = Questions(TOLERANCE, Asked, in_a_process(TOLERANCE, analysed), *about)
    variant_details = Questions(VARIANT, WantedVariant, detailed, *about)
    for one in (previews, decisions, impacts, solving, tolerances, variant_details):
        jobs.register(one.kind, one, one.failed, lane=CALCULATION)
    designs = Designs(database, jobs, catalogues, recent)
    solids = SolidMaking(database, builds, analysing, settings.workers)
    parts = Parts(database, store, catalogues, calculations.pool, jobs, calculations.steps, solids)
    studies = assemble_studies(parts, designs)
    worksheets = Worksheets(database, catalogues, calculations.pool, published)
    imports = Imports(database, store, jobs, catalogues, worksheets)
    jobs.register(IMPORT, imports, imports.failed)
    model_imports = ModelImports(database, store, jobs, catalogues, programs, shelf)
    jobs.register(MODEL_IMPORT, model_imports, model_imports.failed)
    jobs.start({**calculations.lanes, **LANES})
    stack.callback(jobs.stop)
    models = Models(database, store, jobs, catalogues)
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
        answering=Answering(calculations.pool, calculations.jobs, settings.calculation_deadline),
        designs=designs,
        labelling=Labelling(designs),
        previews=previews,
        decisions=decisions,
        studies=studies,
        worksheets=worksheets,
        imports=imports,
        solving=solving,
        tolerances=tolerances,
        variant_details=variant_details,
        impacts=impacts,
        models=models,
        model_imports=model_imports,
        analyses=analyses,
        healing=Healing(database, store, models, analyses),
        approving=Approving(database, store),
        comments=Comments(database),
        reports=Reports(database, store, models, catalogues, settings.owner),
        press=Press(workers.here, Limits(settings.job_deadline, settings.job_memory_mb), settings.workers),
        streams=Streams(settings.streams, settings.streams_per_client),
        readiness=readiness.Readiness(
            {
                **data_checks(database, store, folder, settings),
                "processes": readiness.Processes(workers.of_jobs, workers.why_silent),
                "calculations": readiness.Processes(calculations.pool),
            }
        ),
    )


def data_checks(
    database: Database, store: Artifacts, folder: DataFolder, settings: Settings
) -> dict[str, readiness.Check]:
    """The conditions on the data under which the service is ready."""
    checks: dict[str, readiness.Check] = {
        "database": readiness.Writing(database),
        "space": readiness.Space(folder.path, settings.minimum_free_mb),
    }
    return checks if settings.artifacts_url is None else {**checks, "files": readiness.Files(store)}


def find_catalogues(settings: Settings, worker: Worker) -> Catalogues:
    """The catalogues. A process of the worker checks every file of a team before the server loads it.

    At the start a light process checks those that do not name the kernel, so that nobody waits for it.
    """
    if not settings.template_folders:
        return Catalogues(find_templates(()), find_models())
    limits = Limits(settings.template_seconds, settings.job_memory_mb)
    check = CheckInProcess(worker, limits)
    if settings.engine != LOCAL:
        return TeamCatalogues(settings.template_folders, check)
    with closing(LocalProcesses(CHECKS)) as light:  # it is ready long before a process that loads the kernel
        return TeamCatalogues(settings.template_folders, check, CheckInProcess(worker, limits, light))


def published_worksheets(database: Database, catalogues: Catalogues, stack: ExitStack) -> Published:
    """The released worksheets among the templates; a SQLite file has one server, which releases them all."""
    published = Published(database, catalogues, is_shared=database.is_shared)
    published.start()
    stack.callback(published.stop)
    return published


def register_jobs(
    jobs: Jobs,
    builds: Builds,
    analysing: Analysing,
    catalogues: Catalogues,
    calculations: Calculations,
    recent: Recent,
) -> None:
    """Say what carries out each kind of job."""
    regeneration = Regeneration(
        builds.database, builds, analysing, catalogues, calculations.steps, recent, problems.describe
    )
    jobs.register(REGENERATE, regeneration, regeneration.failed)
    jobs.register(REGENERATE_SLOWLY, regeneration, regeneration.failed, is_slow=True)
    jobs.register(CALCULATE, regeneration, regeneration.failed, lane=CALCULATION)
    jobs.register(BUILD, ModelBuild(builds, catalogues))
    jobs.register(ANALYSIS, ModelAnalysis(builds, analysing, catalogues), is_slow=True)
