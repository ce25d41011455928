"""What routes ask for, by annotation; all of it is made once, in `main.lifespan`.

The functions are async although they do nothing to wait for: FastAPI runs sync ones in a thread each.
"""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Header, Request

from app.api.gate.clients import TheClient
from app.api.reading import fingerprint
from app.designs.graph import Catalogues
from app.designs.service import Designs
from app.jobs.service import Jobs
from app.solids.analyses import Analyses
from app.solids.healing import Healing
from app.solids.models import Models
from app.storage.artifacts import ArtifactStore
from app.storage.database import Database
from app.storage.idempotency import Once


async def get_catalogues(request: Request) -> Catalogues:
    """Templates and models."""
    return request.app.state.catalogues  # type: ignore[no-any-return]


async def get_database(request: Request) -> Database:
    """The database."""
    return request.app.state.database  # type: ignore[no-any-return]


async def get_store(request: Request) -> ArtifactStore:
    """The artifacts."""
    return request.app.state.store  # type: ignore[no-any-return]


async def get_jobs(request: Request) -> Jobs:
    """The jobs."""
    return request.app.state.jobs  # type: ignore[no-any-return]


async def get_designs(request: Request) -> Designs:
    """The designs."""
    return request.app.state.designs  # type: ignore[no-any-return]


async def get_models(request: Request) -> Models:
    """The CAD models and builds."""
    return request.app.state.models  # type: ignore[no-any-return]


async def get_analyses(request: Request) -> Analyses:
    """The analyses of solids."""
    return request.app.state.analyses  # type: ignore[no-any-return]


async def get_healing(request: Request) -> Healing:
    """What makes lost files again."""
    return request.app.state.healing  # type: ignore[no-any-return]


async def get_once(
    request: Request,
    client: TheClient,
    idempotency_key: Annotated[
        str | None, Header(min_length=1, max_length=200, description="the same key, the same change: once")
    ] = None,
) -> Once:
    """How to tell a repeated request."""
    return Once(idempotency_key, f"{request.method} {request.url.path}", await fingerprint(request), client)


TheCatalogues = Annotated[Catalogues, Depends(get_catalogues)]
TheDatabase = Annotated[Database, Depends(get_database)]
TheStore = Annotated[ArtifactStore, Depends(get_store)]
TheJobs = Annotated[Jobs, Depends(get_jobs)]
TheDesigns = Annotated[Designs, Depends(get_designs)]
TheModels = Annotated[Models, Depends(get_models)]
TheAnalyses = Annotated[Analyses, Depends(get_analyses)]
TheHealing = Annotated[Healing, Depends(get_healing)]
TheOnce = Annotated[Once, Depends(get_once)]
JobsDependency = TheJobs
