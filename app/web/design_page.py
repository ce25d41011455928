"""The design page: worksheet and part, side by side; and the page of one of its revisions."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Mapping
from typing import Any

from fastapi import Request, Response

from app.web import sheet
from app.web.api import Api
from app.web.differences import differences
from app.web.forms import texts
from app.web.model_page import known_analyses
from app.web.pictures import painted, pictures
from app.web.rendering import show, units_of
from cad.export import MEDIA_TYPES

UNFINISHED = ("queued", "running")
QUICK = (
    1  # how long a page waits for steps; its script asks for what takes longer, and shows the progress [s]
)


async def design_page(
    request: Request,
    api: Api,
    id: str,
    *,
    typed: Mapping[str, str] | None = None,
    faults: Mapping[str, str] | None = None,
    notice: str | None = None,
    status: int = 200,
) -> Response:
    """The newest revision in a form; or a form that was refused, with what was typed and what is wrong."""
    design = await api.get(f"/designs/{id}")
    number = design["revision"]
    within = 0 if design["state"] == "regenerating" else QUICK
    told = await _revision(request, api, id, number, within=within)
    steps, models = await _descriptions(api, design)
    query = {"worksheet": True, "units": units_of(request), "within": within}
    previewed = await api.post(f"/designs/{id}/preview", {}, **query)
    before = await _revision(request, api, id, number - 1, within=0) if number > 1 else None
    wrong, words = faults or {}, typed or {}
    parameters = sheet.of_parameters(design["parameters"], previewed["parameters"], words, wrong)
    blocks = _steps(design, told, steps, words, wrong)
    parts = _models(design, told, models, words, wrong, before, previewed["model_parameters"])
    measured = await api.get(f"/designs/{id}/measurements", units=units_of(request))
    fields = [*parameters, *(f for part in parts for f in part["fields"])]
    fields += [f for block in blocks for f in (*block["fields"], *block["options"])]
    return show(
        request,
        "design.html",
        status=status,
        design=design,
        revision=told,
        parameters=parameters,
        steps=blocks,
        models=parts,
        measured=measured,
        analyses={
            name: await known_analyses(request, api, part["build"], models[name], part["analyses"])
            for name, part in measured.items()
        },
        revisions=await api.get(f"/designs/{id}/revisions", limit=20),
        proposals=(await api.post(f"/designs/{id}/auto-map"))["proposals"],
        job=await _job(api, design),
        kinds=list(MEDIA_TYPES),
        loose=sheet.loose_faults(fields, wrong),
        refused=bool(wrong),
        notice=notice,
        base=f"/api/v1/designs/{id}",
        painted=painted(blocks, parts),
        was=json.dumps(texts(design)),
        choices=await _choices(api),
    )


async def revision_page(request: Request, api: Api, id: str, number: int, other: int | None) -> Response:
    """One revision as it is kept, with what differs from another: the one before, if none is named."""
    design, told = await asyncio.gather(api.get(f"/designs/{id}"), _revision(request, api, id, number))
    compared = other or (number - 1 if number > 1 else None)
    against = await _revision(request, api, id, compared) if compared else None
    steps, models = await _descriptions(api, told)
    return show(
        request,
        "revision.html",
        design=design,
        revision=told,
        steps=_steps(_as_design(told), told, steps, {}, {}),
        models=_models(_as_design(told), told, models, {}, {}, against, {}),
        against=against,
        differences=differences(against, told) if against else [],
        kinds=list(MEDIA_TYPES),
        base=f"/api/v1/designs/{id}/revisions/{number}",
    )


async def _revision(request: Request, api: Api, id: str, number: int, **options: Any) -> dict[str, Any]:
    path = f"/designs/{id}/revisions/{number}/worksheet"
    return await api.get(path, units=units_of(request), **options)


async def _descriptions(
    api: Api, design: Mapping[str, Any]
) -> tuple[dict[str, dict[str, Any]], dict[str, dict[str, Any]]]:
    """What the templates of the steps and the models say of themselves."""
    steps = {
        name: await api.get(f"/templates/{id}/versions/{version}")
        for name, (id, version) in ((n, _template(step)) for n, step in design["steps"].items())
    }
    models = {
        name: await api.get(f"/models/{model['id']}/versions/{model['version']}")
        for name, model in design["models"].items()
    }
    return steps, models


def _template(step: Mapping[str, Any]) -> tuple[str, int]:
    """Id and version, as a design names them or as a revision does."""
    told = step["template"]
    return (told["id"], told["version"]) if isinstance(told, Mapping) else (told, step["version"])


def _as_design(told: Mapping[str, Any]) -> dict[str, Any]:
    """A revision in the shape of a design, its inputs as they were used."""
    steps = {
        name: {
            "inputs": {
                **{n: value for n, value in step["inputs"].items() if not _defaulted(value)},
                **step.get("relations", {}),
            },
            "level": step["level"],
            "tolerance": None,
        }
        for name, step in told["steps"].items()
    }
    models = {
        name: {"parameters": {**model["parameters"], **model["relations"]}}
        for name, model in told["models"].items()
    }
    return {"steps": steps, "models": models}


def _defaulted(value: Any) -> bool:
    return isinstance(value, Mapping) and value.get("from") == "default"


def _steps(
    design: Mapping[str, Any],
    told: Mapping[str, Any],
    schemas: Mapping[str, Any],
    typed: Mapping[str, str],
    faults: Mapping[str, str],
) -> list[dict[str, Any]]:
    """Every step with its fields, results and pictures."""
    blocks = []
    for name, template in schemas.items():
        cells, result = design["steps"][name], _awaited(template, design["steps"][name], told["steps"][name])
        blocks.append(
            {
                "name": name,
                "template": template,
                "cells": cells,
                "fields": sheet.of_block(
                    template["inputs"], name, cells["inputs"], _used(result), typed, faults
                ),
                "options": sheet.of_options(template, name, cells, typed, faults),
                "result": result,
                "outputs": [n for n in template["outputs"]["properties"] if n in result["outputs"]],
                "pictures": pictures(name, template, told["steps"][name]),
            }
        )
    return blocks


def _awaited(
    template: Mapping[str, Any], cells: Mapping[str, Any], result: Mapping[str, Any]
) -> Mapping[str, Any]:
    """The results of a step; while they are awaited, places for the page's script to fill in."""
    if not result.get("pending"):
        return result
    names = cells.get("outputs") or list(template["outputs"]["properties"])
    waiting = {"value": None, "reason": "is not calculated yet"}
    return {**result, "outputs": dict.fromkeys(names, waiting), "error": dict.fromkeys(names)}


def _used(result: Mapping[str, Any]) -> dict[str, Any]:
    """The inputs that a step used; nothing while it waits for a solid."""
    return {} if result.get("pending") or not result["outputs"] else result["inputs"]


def _models(
    design: Mapping[str, Any],
    told: Mapping[str, Any],
    schemas: Mapping[str, Any],
    typed: Mapping[str, str],
    faults: Mapping[str, str],
    before: Mapping[str, Any] | None,
    previewed: Mapping[str, Any],
) -> list[dict[str, Any]]:
    """Every model with its fields, and what its parameters were before."""
    blocks = []
    for name, model in schemas.items():
        values = told["models"][name]["parameters"]
        old = before["models"].get(name, {}).get("parameters", {}) if before else {}
        cells = design["models"][name]["parameters"]
        blocks.append(
            {
                "name": name,
                "model": model,
                "fields": sheet.of_block(model["parameters"], name, cells, values, typed, faults),
                "values": values,
                "old": {n: value for n, value in old.items() if value != values.get(n)},
                "status": {n: previewed.get(f"{name}.{n}", {}).get("status") for n in values}
                or dict.fromkeys(model["parameters"]["required"], "missing"),
                "build": told["models"][name]["build"],
            }
        )
    return blocks


async def _job(api: Api, design: Mapping[str, Any]) -> dict[str, Any] | None:
    """The job that regenerates the design, if one does."""
    if design["state"] != "regenerating":
        return None
    jobs: list[dict[str, Any]] = (await api.get("/jobs", limit=200))["items"]
    mine = (job for job in jobs if job["design"] == design["id"] and job["state"] in UNFINISHED)
    return next(mine, None)


async def _choices(api: Api) -> dict[str, list[dict[str, Any]]]:
    """The templates and models that a design may take in."""
    groups = {group: (await api.get(f"/{group}", limit=500))["items"] for group in ("templates", "models")}
    return {group: [item for item in items if item["latest"]] for group, items in groups.items()}
