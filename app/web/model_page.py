"""A CAD model's page: its parameters and rules, its picture, and a form to build it."""

from __future__ import annotations

from collections.abc import Mapping

from fastapi import Request, Response

from app.presentation.input_text import text_of, value_of
from app.schemas.values import Given
from app.solids.routes.analyses import list_analyses_of_build, show_analysis
from app.solids.schemas.analyses import Analysis, ModelAnalysis
from app.solids.schemas.models import Build
from app.solids.schemas.models import CadModel as Model
from app.web import sheet
from app.web.api import Api
from app.web.rendering import show, units_of
from app.web.services import Refused
from cad.export import MEDIA_TYPES

SHOWN = ["step", "glb"]  # made at once; other kinds when they are asked for
ABOUT = {"units"}


async def model_page(request: Request, api: Api, id: str, version: int) -> Response:
    """The page, with the build of what the address asks for; of the example, where it asks for nothing."""
    path = f"/models/{id}/versions/{version}"
    model = await api.get(path, Model)
    typed = {n: text for n, text in request.query_params.items() if n not in ABOUT and text.strip()}
    cells = {name: value_of(text) for name, text in typed.items()} if typed else model.example
    built, faults = await _built(api, path, cells)
    return show(
        request,
        "model.html",
        status=422 if faults else 200,
        model=model,
        fields=sheet.of_block(
            model.parameters, "", cells, (built.parameters if built else None) or {}, typed, faults
        ),
        built=built,
        origin=model.origin,
        analyses=await finished_analyses(request, api, built.build if built else None, model),
        faults=faults,
        kinds=list(MEDIA_TYPES),
        path_of_api=f"/api/v1{path}",
    )


async def finished_analyses(
    request: Request,
    api: Api,
    build: str | None,
    model: Model,
    declared: Mapping[str, ModelAnalysis] | None = None,
) -> list[Analysis]:
    """The analyses of a build that have results by now; those of a design under the load that it gives."""
    if not model.analyses or build is None:
        return []
    units = units_of(request)
    analyses = await api.find(list_analyses_of_build, build, api.analyses, units)
    loads = {analysis.id: text_of(analysis.load.plain()) for analysis in (declared or {}).values()}
    return [
        await api.run(show_analysis, analysis.id, api.analyses, loads[analysis.id], units)
        if analysis.id in loads
        else analysis
        for analysis in (analyses.items if analyses else [])
    ]


async def _built(api: Api, path: str, cells: Mapping[str, Given]) -> tuple[Build | None, dict[str, str]]:
    """The build with its files, or what is wrong; while it is being built, neither its files nor measures."""
    try:
        begun = await api.post(f"{path}/build", Build, {"parameters": cells, "artifacts": SHOWN})
    except Refused as refused:
        if refused.status != 422:
            raise
        return None, refused.faults or {"model": refused.problem.detail}
    build = await api.get_or_none(f"/builds/{begun.build}", Build)
    if build and build.artifacts.keys() >= {*SHOWN}:
        return build, {}
    return begun.model_copy(update={"artifacts": {}}), {}
