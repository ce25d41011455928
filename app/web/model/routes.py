"""A CAD model's page: its parameters and rules, its picture, and a form to build it."""

from __future__ import annotations

from collections.abc import Mapping

from fastapi import APIRouter, Request, Response

from app.api.responses import finished
from app.catalogue.catalogues import Catalogues
from app.http.access import AUTHOR
from app.presentation.input_text import text_of, value_of
from app.schemas.problems import Problem
from app.schemas.values import Given
from app.solids.routes.analyses import list_analyses_of_build, show_analysis
from app.solids.routes.models import BuildIn, list_model_versions, show_model
from app.solids.schemas.analyses import Analysis, ModelAnalysis
from app.solids.schemas.models import Build
from app.solids.schemas.models import CadModel as Model
from app.web.shared import sheet
from app.web.shared.paths import Id, Number
from app.web.shared.responses import go, show, units_of
from app.web.shared.services import PageServices, Refused, ThePageServices, refusals
from cad.file_kinds import MEDIA_TYPES, SHOWN
from cad.model import CadModel
from cad.regenerate import build_key

ABOUT = {"units"}


async def model_page(request: Request, services: PageServices, id: str, version: int) -> Response:
    """Return the page, with the build of the parameters in the address.

    Without parameters it shows the build of the example.
    """
    model = await services.run(show_model, id, version, services.catalogues, services.database)
    typed = {n: text for n, text in request.query_params.items() if n not in ABOUT and text.strip()}
    cells = {name: value_of(text) for name, text in typed.items()} if typed else model.example
    built, faults = await _built(services, model, cells)
    return show(
        request,
        "model/model.html",
        status=422 if faults else 200,
        model=model,
        fields=sheet.of_block(
            model.parameters, "", cells, (built.parameters if built else None) or {}, typed, faults
        ),
        built=built,
        origin=model.origin,
        analyses=await finished_analyses(request, services, built.build if built else None, model),
        faults=faults,
        kinds=list(MEDIA_TYPES),
        path_of_api=f"/api/v1/models/{id}/versions/{version}",
    )


async def finished_analyses(
    request: Request,
    services: PageServices,
    build: str | None,
    model: Model,
    declared: Mapping[str, ModelAnalysis] | None = None,
) -> list[Analysis]:
    """Return the analyses of a build that have results, under the load that the design sets, if any."""
    if not model.analyses or build is None:
        return []
    units = units_of(request)
    analyses = await services.find(list_analyses_of_build, build, services.analyses, units)
    loads = {analysis.id: text_of(analysis.load.plain()) for analysis in (declared or {}).values()}
    return [
        await services.run(show_analysis, analysis.id, services.analyses, loads[analysis.id], units)
        if analysis.id in loads
        else analysis
        for analysis in (analyses.items if analyses else [])
    ]


async def _built(
    services: PageServices, model: Model, cells: Mapping[str, Given]
) -> tuple[Build | None, dict[str, str]]:
    """Return the build with its files, or its faults.

    While the build is running, it has neither files nor measurements.
    """
    try:
        key = await _begun(services, model, cells)
    except Refused as refused:
        if refused.status != 422:
            raise
        return None, refused.faults or {"model": refused.problem.detail}
    build = await services.find(services.models.show, key)
    if build and build.artifacts.keys() >= {*SHOWN}:
        return build, {}
    return Build(build=key, artifacts={}, measurements=None), {}


async def _begun(services: PageServices, model: Model, cells: Mapping[str, Given]) -> str:
    """Start the build, wait a short time for it, and return its key.

    Raises
    ------
    Refused
        If the parameters are wrong, or do not give a valid solid.
    """
    with refusals():
        AUTHOR.check()
    body = services.read(BuildIn, {"parameters": cells})
    shape = await services.run(_shape, services.catalogues, model.id, model.version, body.parameters)
    job = await services.run(services.models.request, shape, SHOWN, services.client)
    if job and await finished(services.jobs, job, None):
        failed = await services.run(services.jobs.problem, job)
        if failed:
            raise Refused(Problem.model_validate(failed))
    return build_key(shape)


def _shape(catalogues: Catalogues, id: str, version: int, parameters: Mapping[str, Given]) -> CadModel:
    return catalogues.models.get(id, version).from_quantities(parameters)


router = APIRouter(include_in_schema=False)


@router.get("/models/{id}")
async def newest_model(id: Id, services: ThePageServices) -> Response:
    """Redirect to the latest version of a model."""
    versions = await services.run(list_model_versions, id, services.catalogues)
    return go(f"/models/{id}/{next(item.version for item in versions.items if item.latest)}")


@router.get("/models/{id}/{version}")
async def model(id: Id, version: Number, request: Request, services: ThePageServices) -> Response:
    """Return the page of a CAD model, with a form to build it; the address contains the entries."""
    return await model_page(request, services, id, version)
