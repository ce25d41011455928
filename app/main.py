"""The application: `create_app(settings)`. Everything it holds is made in `lifespan` and ends there."""

from __future__ import annotations

import gc
import logging
from collections.abc import AsyncIterator, Iterator
from contextlib import ExitStack, asynccontextmanager, contextmanager
from functools import partial
from importlib.metadata import version
from typing import Any

from fastapi import FastAPI, Response
from fastapi_offline import FastAPIOffline

from app import docs, guard, health, metrics, observing, problems, readiness
from app.analyses.finding import Analysing
from app.analyses.routes import router as analyses
from app.analyses.service import ANALYSIS, Analyses, ModelAnalysis
from app.cache import results
from app.calculations.answers import router as answers
from app.calculations.assembly import assemble_calculations
from app.calculations.film_pressure import router as film_pressure
from app.calculations.routes import router as calculations
from app.calculations.routes import worksheets
from app.catalogue.finding import find_templates
from app.catalogue.routes import router as catalogue
from app.curves.routes import router as curves
from app.description import describe_interface
from app.designs.events import router as design_events
from app.designs.files import router as design_files
from app.designs.graph import Catalogues
from app.designs.recent import Recent
from app.designs.regeneration import Regeneration
from app.designs.routes import router as designs
from app.designs.service import REGENERATE, REGENERATE_SLOWLY, Designs
from app.heads import HeadLimit
from app.hosts import Hosts
from app.http import BodyLimit, BodyTooLarge, HeadTooLarge, HttpError
from app.jobs.routes import router as jobs
from app.jobs.service import Jobs
from app.jobs.shutdown import on_stop_signal
from app.models.builds import Builds
from app.models.healing import Healing
from app.models.routes import router as models
from app.models.service import BUILD, ModelBuild, Models
from app.reports.paper import Press
from app.reports.routes import router as reports
from app.reports.service import Reports
from app.retention.service import Retention
from app.settings import Settings
from app.stopping import StoppingAnswer
from app.storage.artifacts import ArtifactStore
from app.storage.database import Database
from app.storage.folder import DataFolder
from app.storage.integrity import refuse_damage
from app.storage.migrations import migrate
from app.streams import Streams
from app.timeouts import BodyTime
from app.web import assembly as pages
from app.workers.base import Limits
from app.workers.local import LocalProcesses
from cad.catalogue import models as find_models

logger = logging.getLogger(__name__)

DESCRIPTION = """Engine-bearing calculations that drive geometry: versioned templates, designs that tie their
outputs to CAD parameters by relations, and STEP files regenerated whenever an output changes.

Quantities are text with a unit (`"25 kN"`) or objects (`{"value": 25, "unit": "kN"}`). Errors are RFC 9457
problems that name every wrong input at once."""


def create_app(settings: Settings | None = None) -> FastAPI:
    """The service, ready to be served; it opens its data folder when it starts."""
    chosen = settings or Settings()

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        with ExitStack() as stack:
            assemble(app, chosen, stack)
            stack.enter_context(on_stop_signal(app.state.jobs.drain))
            stack.enter_context(spared_by_collections())
            yield

    app: FastAPI = FastAPIOffline(
        title="Crankwright",
        version=version("crankwright"),
        description=DESCRIPTION,
        lifespan=lifespan,
        docs_url=None,  # ours has a policy
        redoc_url=None,
        telemetry={"tracing": False, "metrics": False, "logs": False},  # /metrics counts
        swagger_ui_parameters={"validatorUrl": None},  # the default one asks an outside address
        responses={
            "4XX": {"description": "a problem", "content": {problems.MEDIA_TYPE: {"schema": PROBLEM}}}
        },
    )
    # Routers are tried one after another; that of `evaluate`, which is called most, is the first.
    for router in (
        calculations,
        worksheets,
        answers,
        film_pressure,
        curves,
        catalogue,
        designs,
        design_files,
        reports,
        design_events,
        models,
        analyses,
        jobs,
    ):
        app.include_router(router)
    app.include_router(health.router)
    app.include_router(readiness.router)
    app.include_router(problems.router)
    problems.install(app)
    docs.install(app)
    pages.install(app)
    app.add_middleware(BodyLimit, limit=chosen.body_limit, refuse=_too_large)
    app.add_middleware(BodyTime, seconds=chosen.body_seconds, rate=chosen.slowest_rate)
    app.add_middleware(HeadLimit, refuse=_head_too_large)
    app.add_middleware(StoppingAnswer)
    guard.install(app, Hosts(chosen.allowed_hosts, chosen.host), _refused)
    observing.install(app)  # the outermost: it sees what the others refuse
    app.openapi = partial(describe_interface, app)  # type: ignore[method-assign]
    return app


@contextmanager
def spared_by_collections() -> Iterator[None]:
    """Keep what the program has loaded out of Python's full collections, during which all threads wait.

    Half a million objects that live as long as the program make every collection a tenth of a second long.
    """
    gc.collect()
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()


def assemble(app: FastAPI, settings: Settings, stack: ExitStack) -> None:
    """Make what the routes depend on; the stack undoes it in reverse order."""
    folder = DataFolder(settings.data)
    stack.callback(folder.release)
    url = settings.database_url or folder.database_url
    refuse_damage(url)  # before anything is written to it
    migrate(url)
    database = Database(url, on_commit=metrics.committed)
    stack.callback(database.close)
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
    queue = Jobs(database, worker, settings, problems.describe)
    builds = Builds(database, store, settings.template_folders)
    analysing = Analysing(database, store, Limits(settings.analysis_deadline, settings.analysis_memory_mb))
    lanes = assemble_calculations(app, settings, stack, catalogues.templates, database, store, queue)
    recent = Recent()
    regeneration = Regeneration(database, builds, analysing, catalogues, app.state.steps, recent)
    queue.register(REGENERATE, regeneration, Regeneration.failed)
    queue.register(REGENERATE_SLOWLY, regeneration, Regeneration.failed, is_slow=True)
    queue.register(BUILD, ModelBuild(builds, catalogues.models))
    queue.register(ANALYSIS, ModelAnalysis(builds, analysing, catalogues.models), is_slow=True)
    queue.start(lanes)
    stack.callback(queue.stop)
    app.state.database, app.state.store, app.state.jobs = database, store, queue
    app.state.catalogues, app.state.settings = catalogues, settings
    app.state.streams = Streams(settings.streams, settings.streams_per_client)
    app.state.designs = Designs(database, queue, catalogues, recent)
    app.state.models = Models(database, store, queue, catalogues.models)
    app.state.analyses = Analyses(database, store, queue)
    app.state.healing = Healing(database, store, app.state.models, app.state.analyses)
    app.state.reports = Reports(database, store, app.state.models, catalogues)
    app.state.readiness = readiness.Readiness(
        {
            "database": readiness.Writing(database),
            "space": readiness.Space(folder.path, settings.minimum_free_mb),
            "processes": readiness.Processes(worker),
            "calculations": readiness.Processes(app.state.calculations),
        }
    )
    limits = Limits(settings.job_deadline, settings.job_memory_mb)
    app.state.press = Press(worker, limits, settings.workers)


def _too_large(told: str) -> Response:
    return _refused(BodyTooLarge(told))


def _refused(error: HttpError) -> Response:
    return problems.answer(problems.describe(error))


def _head_too_large(told: str) -> Response:
    return _refused(HeadTooLarge(told))


PROBLEM: dict[str, Any] = {
    "type": "object",
    "required": ["type", "title", "status", "detail"],
    "properties": {
        "type": {"type": "string"},
        "title": {"type": "string"},
        "status": {"type": "integer"},
        "detail": {"type": "string"},
        "request_id": {"type": "string", "description": "as in the header X-Request-ID and in the log"},
        "errors": {
            "type": "array",
            "items": {
                "type": "object",
                "properties": {part: {"type": "string"} for part in ("name", "code", "detail")},
            },
        },
    },
}
