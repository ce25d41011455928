"""FastAPI dependencies of routes: the parts of `Services`, and parts of a request other than its body.

The functions are async although they await nothing, because FastAPI would run each sync function in a thread.
"""

from __future__ import annotations

from collections.abc import AsyncIterator, Awaitable, Callable
from typing import Annotated

from fastapi import Depends, Header, Query, Request
from fastapi.concurrency import run_in_threadpool

from app.answers.schemas import DesignAnswer
from app.answers.service import AnswerQuestion
from app.api.event_streams import Still, always
from app.api.responses import Threads
from app.api.services import Services
from app.approvals.comments import Comments
from app.approvals.service import ApprovalService
from app.catalogue.catalogues import Catalogues
from app.designs import decisions
from app.designs.explanation import ExplanationQuestion
from app.designs.labels import LabelService
from app.designs.preview import PreviewRequest
from app.designs.questions import DesignQuestion
from app.designs.schemas.decision import Decision
from app.designs.schemas.designs import Explanation, Preview
from app.designs.schemas.solution import DesignSolution
from app.designs.schemas.variants import VariantDetail
from app.designs.service import Designs
from app.designs.variants.detail import WantedVariant
from app.http.access import STILL, TheClient
from app.http.strict_requests import fingerprint
from app.identity.service import Identity
from app.impact import survey
from app.impact.schemas import Impact
from app.imported_models.service import ModelImports
from app.jobs.service import Jobs
from app.observation.readiness import Readiness
from app.pool.questions import Questions
from app.pool.steps import Caller, call_as
from app.presentation.units import System
from app.reports.paper import Press
from app.reports.service import Reports
from app.settings import Settings
from app.signing.keys import StampKeys
from app.solids.analyses import Analyses
from app.solids.models import Models
from app.solids.repair import ArtifactRepair
from app.storage.artifacts import Artifacts
from app.storage.database import Database
from app.storage.idempotency import Once
from app.studies.service import Studies
from app.tolerances.schemas import ToleranceAnalysis
from app.worksheets.imports.service import Imports
from app.worksheets.service import Worksheets


def services_of(request: Request) -> Services:
    """Return the parts of the service for a request."""
    services: Services = request.app.state.services
    return services


def _part(name: str) -> Callable[[Request], Awaitable[object]]:
    """Return a dependency that provides the part of the services with this name."""

    async def part(request: Request) -> object:
        return getattr(services_of(request), name)

    return part


TheCatalogues = Annotated[Catalogues, Depends(_part("catalogues"))]
TheDatabase = Annotated[Database, Depends(_part("database"))]
TheIdentity = Annotated[Identity, Depends(_part("identity"))]
TheSettings = Annotated[Settings, Depends(_part("settings"))]
TheStore = Annotated[Artifacts, Depends(_part("store"))]
TheJobs = Annotated[Jobs, Depends(_part("jobs"))]
TheThreads = Annotated[Threads, Depends(_part("threads"))]
TheDesigns = Annotated[Designs, Depends(_part("designs"))]
TheAnswers = Annotated[Questions[AnswerQuestion, DesignAnswer], Depends(_part("answers"))]
TheLabelling = Annotated[LabelService, Depends(_part("labelling"))]
TheStudies = Annotated[Studies, Depends(_part("studies"))]
TheImports = Annotated[Imports, Depends(_part("imports"))]
TheWorksheets = Annotated[Worksheets, Depends(_part("worksheets"))]
ThePreviews = Annotated[Questions[PreviewRequest, Preview], Depends(_part("previews"))]
TheDecisions = Annotated[Questions[decisions.DecisionQuestion, Decision], Depends(_part("decisions"))]
TheExplanations = Annotated[Questions[ExplanationQuestion, Explanation], Depends(_part("explanations"))]
TheSolving = Annotated[Questions[DesignQuestion, DesignSolution], Depends(_part("solving"))]
TheTolerances = Annotated[Questions[DesignQuestion, ToleranceAnalysis], Depends(_part("tolerances"))]
TheVariantDetails = Annotated[Questions[WantedVariant, VariantDetail], Depends(_part("variant_details"))]
TheImpacts = Annotated[Questions[survey.ImpactQuestion, Impact], Depends(_part("impacts"))]
TheModels = Annotated[Models, Depends(_part("models"))]
TheModelImports = Annotated[ModelImports, Depends(_part("model_imports"))]
TheAnalyses = Annotated[Analyses, Depends(_part("analyses"))]
TheHealing = Annotated[ArtifactRepair, Depends(_part("healing"))]
TheApproving = Annotated[ApprovalService, Depends(_part("approving"))]
TheComments = Annotated[Comments, Depends(_part("comments"))]
TheReports = Annotated[Reports, Depends(_part("reports"))]
ThePress = Annotated[Press, Depends(_part("press"))]
TheStampKeys = Annotated[StampKeys | None, Depends(_part("stamp_keys"))]
TheReadiness = Annotated[Readiness, Depends(_part("readiness"))]

Units = Annotated[
    System, Query(description="`us`: lengths in inches, forces in pounds, … instead of as declared")
]


IdempotencyKey = Annotated[
    str | None, Header(min_length=1, max_length=200, description="the same key, the same change: once")
]


async def get_once(request: Request, client: TheClient, idempotency_key: IdempotencyKey = None) -> Once:
    """Return the service that recognises a repeated request."""
    scope = f"{request.method} {request.scope['path']}"
    return Once(idempotency_key, scope, await fingerprint(request), client)


TheOnce = Annotated[Once, Depends(get_once)]


async def require_room(request: Request, identity: TheIdentity) -> None:
    """Refuse a file, before it arrives, that does not fit into the storage of its principal.

    Raises
    ------
    LimitReached
        If it does not fit.
    """
    await run_in_threadpool(identity.require_room, int(request.headers.get("content-length", 0)))


async def expensive_steps(request: Request, client: TheClient) -> None:
    """Let the route of a request evaluate expensive steps in the pool; a dependency of routers."""
    steps = services_of(request).steps
    call_as(Caller(steps, client, steps.begun()))


ExpensiveSteps = Depends(expensive_steps)


async def one_stream(request: Request, client: TheClient) -> AsyncIterator[Still]:
    """Count an event stream while it is open, and detect when it ends."""
    streams = services_of(request).streams
    streams.enter(client)
    try:
        yield request.scope.get(STILL, always)
    finally:
        streams.leave(client)


OneStream = Annotated[Still, Depends(one_stream)]
