"""A CAD model's page: its parameters and rules, its picture, and a form to build it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from fastapi import Request, Response

from app.presentation.typed import text_of, value_of
from app.web import sheet
from app.web.api import Api, Refused
from app.web.rendering import show, units_of
from cad.export import MEDIA_TYPES

SHOWN = ["step", "glb"]  # made at once; other kinds when they are asked for
ABOUT = {"units"}


async def model_page(request: Request, api: Api, id: str, version: int) -> Response:
    """The page, with the build of what the address asks for; of the example, where it asks for nothing."""
    path = f"/models/{id}/versions/{version}"
    told = await api.get(path)
    typed = {n: text for n, text in request.query_params.items() if n not in ABOUT and text.strip()}
    cells = {name: value_of(text) for name, text in typed.items()} if typed else told["example"]
    built, faults = await _built(api, path, cells)
    return show(
        request,
        "model.html",
        status=422 if faults else 200,
        model=told,
        fields=sheet.of_block(
            told["parameters"], "", cells, (built or {}).get("parameters", {}), typed, faults
        ),
        built=built,
        analyses=await known_analyses(request, api, (built or {}).get("build"), told),
        faults=faults,
        kinds=list(MEDIA_TYPES),
        path_of_api=f"/api/v1{path}",
    )


async def known_analyses(
    request: Request,
    api: Api,
    build: str | None,
    model: Mapping[str, Any],
    declared: Mapping[str, Mapping[str, Any]] | None = None,
) -> list[dict[str, Any]]:
    """What finite elements have found of a build by now; what a design declares, under its load there."""
    if not model["analyses"] or build is None:
        return []
    units = units_of(request)
    found = await api.find(f"/builds/{build}/analyses", units=units)
    loads = {told["id"]: text_of(told["load"]) for told in (declared or {}).values()}
    return [
        await api.get(f"/analyses/{known['id']}", units=units, load=loads[known["id"]])
        if known["id"] in loads
        else known
        for known in (found["items"] if found else [])
    ]


async def _built(api: Api, path: str, cells: dict[str, Any]) -> tuple[dict[str, Any] | None, dict[str, str]]:
    """The build with its files, or what is wrong; while it is being built, neither its files nor measures."""
    try:
        made = await api.post(f"{path}/build", {"parameters": cells, "artifacts": SHOWN})
    except Refused as refused:
        if refused.status != 422:
            raise
        return None, refused.faults or {"model": refused.problem["detail"]}
    known = await api.find(f"/builds/{made['build']}")
    return (known if known and known["artifacts"].keys() >= {*SHOWN} else {**made, "artifacts": {}}), {}
