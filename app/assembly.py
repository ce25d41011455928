"""Makes the parts of the service from its settings; an exit stack ends them in reverse order."""

from __future__ import annotations

from contextlib import ExitStack

from app.api import problems, readiness
from app.api.answering import Answering
from app.api.gate.streams import Streams
from app.api.services import Services
from app.api.threads import Threads
from app.calculations.assembly import Calculations, assemble_calculations
from app.calculations.cache import results
from app.calculations.jobs import CALCULATION, DECISION, PREVIEW
from app.catalogue.finding import find_templates
from app.designs.decisions import Decisions
from app.designs.graph import Catalogues
from app.designs.previewing import Previews
from app.designs.recent import Recent
from app.designs.regeneration import Regeneration
from app.designs.service import CALCULATE, REGENERATE, REGENERATE_SLOWLY, Designs
from app.jobs.service import Jobs
from app.observation import metrics
from app.reports.paper import Press
from app.reports.service import Reports
from app.retention.service import Retention
from app.settings import Settings
from app.solids.analyses import ANALYSIS, Analyses, ModelAnalysis
from app.solids.builds import Builds
from app.solids.finding import Analysing
from app.solids.healing import Healing
from app.solids.models import BUILD, ModelBuild, Models
from app.storage.artifacts import ArtifactStore
from app.storage.database import Database
from app.storage.folder import DataFolder
from app.storage.integrity import refuse_damage
from app.storage.migrations import migrate
from app.workers.base import Limits
from app.workers.local import LocalProcesses
from cad.catalogue import models as find_models


def assemble(settings: Settings, stack: ExitStack) -> Services:
    """Make all parts of the service, and begin to take jobs."""
    folder = DataFolder(settings.data)
    stack.callback(folder.release)
    database = opened_database(settings, folder, stack)
    store = ArtifactStore(folder.artifacts)
    results.limit(settings.cache_mb)
    retention = Retention(database, store, settings)
    retention.start()
    stack.callback(retention.stop)
    catalogues = Catalogues(
        find_templates(settings.template_folders), find_models(*settings.template_folders)
    )
    worker = LocalProcesses()
    stack.callback(worker.close)
    jobs = Jobs(database, worker, settings, problems.describe)
    calculations = assemble_calculations(settings, stack, catalogues.templates, database, store, jobs)
    recent = Recent()
    register_jobs(settings, jobs, database, store, catalogues, calculations, recent)
    previews = Previews(database, catalogues, store, jobs, calculations.steps)
    jobs.register(PREVIEW, previews, previews.failed, lane=CALCULATION)
    decisions = Decisions(database, catalogues, store, jobs, calculations.steps)
    jobs.register(DECISION, decisions, decisions.failed, lane=CALCULATION)
    jobs.start(calculations.lanes)
    stack.callback(jobs.stop)
    models = Models(database, store, jobs, catalogues.models)
    analyses = Analyses(database, store, jobs)
    return Services(
        settings=settings,
        catalogues=catalogues,
        database=database,
        store=store,
        jobs=jobs,
        calculations=calculations.pool,
        steps=calculations.steps,
        threads=Threads(),
        answering=Answering(calculations.pool, calculations.jobs, settings.calculation_deadline),
        designs=Designs(database, jobs, catalogues, recent),
        previews=previews,
        decisions=decisions,
        models=models,
        analyses=analyses,
        healing=Healing(database, store, models, analyses),
        reports=Reports(database, store, models, catalogues),
        press=Press(worker, Limits(settings.job_deadline, settings.job_memory_mb), settings.workers),
        streams=Streams(settings.streams, settings.streams_per_client),
        readiness=readiness.Readiness(
            {
                "database": readiness.Writing(database),
                "space": readiness.Space(folder.path, settings.minimum_free_mb),
                "processes": readiness.Processes(worker),
                "calculations": readiness.Processes(calculations.pool),
            }
        ),
    )


def opened_database(settings: Settings, folder: DataFolder, stack: ExitStack) -> Database:
    """The database, migrated; a damaged one is refused before anything is written to it."""
    url = settings.database_url or folder.database_url
    refuse_damage(url)
    migrate(url)
    database = Database(url, on_commit=metrics.committed)
    stack.callback(database.close)
    return database


def register_jobs(
    settings: Settings,
    jobs: Jobs,
    database: Database,
    store: ArtifactStore,
    catalogues: Catalogues,
    calculations: Calculations,
    recent: Recent,
) -> None:
    """Say what carries out each kind of job."""
    builds = Builds(database, store, settings.template_folders)
    analysing = Analysing(database, store, Limits(settings.analysis_deadline, settings.analysis_memory_mb))
    regeneration = Regeneration(database, builds, analysing, catalogues, calculations.steps, recent)
    jobs.register(REGENERATE, regeneration, regeneration.failed)
    jobs.register(REGENERATE_SLOWLY, regeneration, regeneration.failed, is_slow=True)
    jobs.register(CALCULATE, regeneration, regeneration.failed, lane=CALCULATION)
    jobs.register(BUILD, ModelBuild(builds, catalogues.models))
    jobs.register(ANALYSIS, ModelAnalysis(builds, analysing, catalogues.models), is_slow=True)
