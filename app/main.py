"""The application: `create_app(settings)`. `lifespan` creates and closes all its parts."""

from __future__ import annotations

import gc
import logging
from collections.abc import AsyncIterator, Iterator
from contextlib import ExitStack, asynccontextmanager, contextmanager
from functools import partial
from importlib.metadata import version
from typing import TYPE_CHECKING

from fastapi import FastAPI
from fastapi_offline import FastAPIOffline

from app.answers.routes import router as requirements
from app.approvals.routes import router as approvals
from app.assembly import assemble
from app.calculations.routes.curves import router as curves
from app.calculations.routes.evaluate import router as calculations
from app.calculations.routes.evaluate import worksheets
from app.calculations.routes.evaluations import router as answers
from app.calculations.routes.film_pressure import router as film_pressure
from app.calculations.routes.spreadsheet_lines import router as spreadsheet_lines
from app.catalogue.routes.faults import router as faults
from app.catalogue.routes.library import router as library
from app.catalogue.routes.templates import router as catalogue
from app.designs.routes.comparison import router as comparisons
from app.designs.routes.decision import router as decisions
from app.designs.routes.designs import router as designs
from app.designs.routes.designs import saves
from app.designs.routes.events import router as design_events
from app.designs.routes.files import router as design_files
from app.designs.routes.labels import router as labels
from app.designs.routes.network import router as networks
from app.designs.routes.revisions import router as revisions
from app.designs.routes.solid_fields import router as solid_fields
from app.designs.routes.solution import router as solving
from app.designs.routes.variant_sheets import by_type as sheets_by_type
from app.designs.routes.variant_sheets import router as variant_sheets
from app.designs.routes.variants import router as variants
from app.http import access, gate, openapi, problems, request_log
from app.http.connections import AddressLimit, Pace
from app.http.limits import BodyLimits
from app.http.openapi import describe_interface, operation_id
from app.http.server import on_stop_signal
from app.http.uploads import UploadFolder
from app.identity.routes.audit import router as audit
from app.identity.routes.principals import router as principals
from app.impact.routes import router as impact
from app.imported_models.routes import router as imported_models
from app.imported_models.routes import uploads as model_uploads
from app.jobs.routes import router as jobs
from app.observation.routes import router as health
from app.reports.routes import router as reports
from app.schemas.problems import PROBLEM_CONTENT
from app.settings import Settings
from app.settings.hosts import Hosts
from app.signing.routes import router as stamp_keys
from app.solids.routes.analyses import router as analyses
from app.solids.routes.models import router as models
from app.studies.routes.studies import router as studies
from app.studies.routes.tables import router as study_tables
from app.tolerances.routes import router as tolerances
from app.web import site as pages
from app.worksheets.routes.imports import router as worksheet_imports
from app.worksheets.routes.worksheets import router as written_worksheets

if TYPE_CHECKING:
    from app.observation.traces import Traces

logger = logging.getLogger(__name__)

NEW_OBJECTS = 5000  # surplus of created over freed objects that starts a collection; Python's own is 700

DESCRIPTION = """Engine-bearing calculations that drive geometry: versioned templates, designs that tie their
outputs to CAD parameters by relations, and STEP files regenerated whenever an output changes.

Quantities are text with a unit (`"25 kN"`) or objects (`{"value": 25, "unit": "kN"}`). Errors are RFC 9457
problems that name every wrong input at once."""

ROUTERS = (
    calculations,
    saves,
    worksheets,
    answers,
    spreadsheet_lines,
    film_pressure,
    curves,
    catalogue,
    impact,
    faults,
    worksheet_imports,
    written_worksheets,
    library,
    designs,
    revisions,
    decisions,
    solving,
    requirements,
    tolerances,
    labels,
    comparisons,
    networks,
    design_files,
    solid_fields,
    sheets_by_type,
    variant_sheets,
    reports,
    variants,
    design_events,
    study_tables,
    studies,
    model_uploads,
    imported_models,
    models,
    analyses,
    jobs,
    principals,
    approvals,
    audit,
    stamp_keys,
)
"""The routers are tried in this order; the most frequently used ones come first: `evaluate`, then saves.
Reports precede variants, because `…/variants/report.pdf` is not a variant. Imports of models precede
models, because `/models/import` is not a model."""


def create_app(settings: Settings | None = None) -> FastAPI:
    """Yield the service, ready to be served; it opens its data folder when it starts."""
    chosen = settings or Settings()
    traces = opened_traces(chosen)

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        with ExitStack() as stack:
            if traces is not None:
                stack.callback(traces.close)  # closed last, when all other parts have ended their spans
            services = assemble(chosen, stack, traces)
            app.state.services, app.state.pace = services, Pace()
            app.state.uploads = UploadFolder(chosen.data / "uploads", chosen.minimum_free_mb)
            stack.enter_context(on_stop_signal(services.jobs.drain))
            stack.enter_context(spared_by_collections())
            yield

    app: FastAPI = FastAPIOffline(
        title="Crankwright",
        version=version("crankwright"),
        description=DESCRIPTION,
        lifespan=lifespan,
        docs_url=None,  # our page has a content security policy
        redoc_url=None,
        telemetry={"tracing": False, "metrics": False, "logs": False},  # /metrics counts
        swagger_ui_parameters={"validatorUrl": None},  # the default validator is an outside service
        responses={"4XX": {"description": "a problem", "content": PROBLEM_CONTENT}},
        generate_unique_id_function=operation_id,
    )
    for router in ROUTERS:
        openapi.include(app, router)
    openapi.include(app, health)
    openapi.include(app, problems.router)
    problems.install(app)
    openapi.install(app)
    pages.install(app)
    access.install(app)
    body = BodyLimits(chosen.body_limit, chosen.body_seconds, chosen.slowest_rate, chosen.upload_limit)
    addresses = AddressLimit(chosen.connections_per_address, chosen.trusted_proxies)
    gate.install(app, Hosts(chosen.allowed_hosts, chosen.host), body, addresses, problems.refusal)
    if traces is not None:
        from app.http import request_spans

        request_spans.install(app, traces)
    request_log.install(app)  # outermost, so that it also sees refused requests
    app.openapi = partial(describe_interface, app)  # type: ignore[method-assign]
    return app


def opened_traces(settings: Settings) -> Traces | None:
    """Return the object that sends traces, if the settings name a collector.

    It needs the packages of the extra `traces`.
    """
    if settings.traces_url is None:
        return None
    from app.observation.traces import Traces

    return Traces(settings.traces_url)


@contextmanager
def spared_by_collections() -> Iterator[None]:
    """Collect garbage rarely and skip loaded objects, because all threads wait during a collection.

    With half a million permanent objects, each full collection takes a tenth of a second. Nearly all objects
    of a request are freed without a collection; with Python's own threshold, collections would take a
    thirtieth of the time of a save.
    """
    threshold = gc.get_threshold()
    gc.set_threshold(NEW_OBJECTS, *threshold[1:])
    if gc.isenabled():
        gc.collect()
    gc.freeze()  # the imports of `serve`, made without collections, contain hardly any garbage
    gc.enable()  # `app.cli.start` disabled it
    try:
        yield
    finally:
        gc.unfreeze()
        gc.set_threshold(*threshold)
