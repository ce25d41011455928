"""The design page: worksheet and part, side by side; and the page of one of its revisions."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Mapping
from typing import NamedTuple

from fastapi import Request, Response

from app.api.gate.roles import routes_of
from app.schemas.analyses import Analysis
from app.schemas.designs import (
    Design,
    ModelMeasurements,
    Preview,
    Proposals,
    RevisionList,
    RevisionWorksheet,
)
from app.schemas.jobs import Job, JobList
from app.schemas.networks import DesignNetwork
from app.schemas.solid_fields import SolidField, SolidFieldList
from app.schemas.templates import CadModel as Model
from app.schemas.templates import Template, TemplateList, TemplateSummary
from app.schemas.variants import VariantsOut
from app.web import sheet
from app.web.api import Api, Scalar
from app.web.approvals import ON_DESIGN, approval_of, comments_of
from app.web.blocks import (
    ModelBlock,
    Refusal,
    StepBlock,
    models_of,
    painted,
    steps_of,
    with_changes,
    with_fields,
)
from app.web.chosen_variant import chosen_variant
from app.web.declaring import analysis_lines, errors_of, iteration_lines, measures
from app.web.differences import differences
from app.web.flow import drawing
from app.web.forms import texts
from app.web.limits import library
from app.web.model_page import finished_analyses
from app.web.names import names_json, values_of
from app.web.rendering import show, units_of
from app.web.sections import sections
from app.web.study_page import studies_of
from app.web.tolerances_page import toleranced
from app.web.upgrades import upgrades_of
from app.web.variants import RefusedTable, variants_table
from app.web.verdict import banner, opened, with_keys
from cad.export import MEDIA_TYPES

UNFINISHED = ("queued", "running")
QUICK = (
    1  # how long a page waits for steps; its script asks for what takes longer, and shows the progress [s]
)
NO_REFUSAL = Refusal()
NO_PART = dict.fromkeys(("declare", "add", "name", "value"), "")
DECIDE = "/api/v1/designs/{id}/decide"


async def design_page(
    request: Request,
    api: Api,
    id: str,
    *,
    refusal: Refusal = NO_REFUSAL,
    table: RefusedTable | None = None,
    notice: str | None = None,
    status: int = 200,
) -> Response:
    """The newest revision in a form; or a form that was refused, with what was typed and what is wrong."""
    design = await api.get(f"/designs/{id}", Design)
    revision, preview, parameters, steps, parts, models = await _form(request, api, design, refusal)
    faults, wrong = refusal.faults, errors_of(refusal.part, refusal.faults)
    has_criteria = bool(design.criteria) or any(step.template.criteria for step in steps)
    verdict = banner(revision, has_criteria=has_criteria)
    measured = await api.get(
        f"/designs/{id}/measurements", dict[str, ModelMeasurements], units=units_of(request)
    )
    network = await api.get(f"/designs/{id}/network", DesignNetwork)
    variants = variants_table(design, await _variants(request, api, id), network, table)
    return show(
        request,
        "design.html",
        status=status,
        design=design,
        revision=revision,
        parameters=parameters,
        steps=steps,
        sections=sections(
            steps, verdict, None if variants.count else opened([s.name for s in steps], verdict)
        ),
        models=parts,
        measured=measured,
        analyses=await _analyses(request, api, measured, models),
        painted_fields=await _fields_of_solids(api, id, measured),
        revisions=await api.get(f"/designs/{id}/revisions", RevisionList, limit=20),
        proposals=(await api.post(f"/designs/{id}/auto-map", Proposals)).proposals,
        job=await _job(api, design),
        studies=await studies_of(api, id),
        kinds=list(MEDIA_TYPES),
        loose=_loose([*parameters, *_fields(steps, parts)], faults, wrong),
        refused=bool(faults) or table is not None,
        notice=notice,
        verdict=verdict,
        can_decide=_has_route(request, DECIDE),
        toleranced=toleranced(design),
        base=f"/api/v1/designs/{id}",
        painted=painted(steps, parts),
        was=json.dumps(texts(design)),
        choices=await _choices(api),
        analysis_lines=analysis_lines(design, parts, refusal),
        iteration_lines=iteration_lines(design, refusal),
        part={**NO_PART, **refusal.part},
        part_errors=wrong,
        measures=list(measures(design, parts)),
        network=network,
        picture=drawing(network),
        upgrades=await upgrades_of(api, {step.name: step.template for step in steps}),
        variants=variants,
        approval=await approval_of(api, id, design.revision),
        comments=await comments_of(api, id, None, ON_DESIGN),
        chosen=await chosen_variant(request, api, design, steps),
        names=names_json(network, values_of(revision, preview, measured)),
    )


class Form(NamedTuple):
    """A design as it is calculated, with the fields of its form; `models` are described by name."""

    revision: RevisionWorksheet
    preview: Preview
    parameters: list[sheet.Field]
    steps: list[StepBlock]
    parts: list[ModelBlock]
    models: dict[str, Model]


async def _form(request: Request, api: Api, design: Design, refusal: Refusal) -> Form:
    id, within = design.id, 0 if design.state == "regenerating" else QUICK
    revision = await _revision(request, api, id, design.revision, within=within)
    templates, models = await _templates(api, _steps_of_design(design)), await _models(api, design)
    has_parameters = bool(design.parameters)  # only with the worksheet a preview has their values
    query: dict[str, Scalar] = {"worksheet": has_parameters, "units": units_of(request), "within": within}
    preview = await api.post(f"/designs/{id}/preview", Preview, {}, **query)
    before = await _revision(request, api, id, design.revision - 1, within=0) if design.revision > 1 else None
    computed = {name: step.outputs for name, step in design.steps.items()}
    tables = await library(api) if templates else []
    steps = [with_fields(block, design, refusal, tables) for block in steps_of(revision, templates, computed)]
    parts = [
        with_changes(block, design, refusal, before, preview.model_parameters)
        for block in models_of(revision, models)
    ]
    typed, faults = refusal.typed, refusal.faults
    parameters = sheet.of_parameters(design.parameters, preview.parameters or {}, typed, faults)
    return Form(revision, preview, parameters, with_keys(steps, revision, design), parts, models)


async def revision_page(
    request: Request,
    api: Api,
    id: str,
    number: int,
    other: int | None,
    *,
    cursor: str = "",
    notice: str | None = None,
    status: int = 200,
) -> Response:
    """Show a stored revision, and how it differs from another: the one before, if none is named."""
    design, revision = await asyncio.gather(
        api.get(f"/designs/{id}", Design), _revision(request, api, id, number)
    )
    compared = other or (number - 1 if number > 1 else None)
    against = await _revision(request, api, id, compared) if compared else None
    templates = await _templates(api, _steps_of_revision(revision))
    return show(
        request,
        "revision.html",
        status=status,
        notice=notice,
        approval=await approval_of(api, id, number),
        comments=await comments_of(api, id, number, 50, cursor),
        design=design,
        revision=revision,
        steps=steps_of(revision, templates),
        models=models_of(revision, await _models(api, revision)),
        against=against,
        differences=differences(against, revision) if against else [],
        kinds=list(MEDIA_TYPES),
        base=f"/api/v1/designs/{id}/revisions/{number}",
    )


def _has_route(request: Request, path: str) -> bool:
    """Return whether the interface has this path."""
    return any(getattr(route, "path", None) == path for route in routes_of(request.app))


async def _revision(request: Request, api: Api, id: str, number: int, **options: Scalar) -> RevisionWorksheet:
    path = f"/designs/{id}/revisions/{number}/worksheet"
    return await api.get(path, RevisionWorksheet, units=units_of(request), **options)


def _steps_of_design(design: Design) -> dict[str, tuple[str, int]]:
    """Id and version of the template of every step."""
    return {name: (step.template, step.version) for name, step in design.steps.items()}


def _steps_of_revision(revision: RevisionWorksheet) -> dict[str, tuple[str, int]]:
    """Id and version of the template of every step."""
    return {name: (step.template.id, step.template.version) for name, step in revision.steps.items()}


async def _templates(api: Api, steps: Mapping[str, tuple[str, int]]) -> dict[str, Template]:
    """The template of every step; steps of one version share it."""
    versions = {
        (id, version): await api.get(f"/templates/{id}/versions/{version}", Template)
        for id, version in dict.fromkeys(steps.values())
    }
    return {name: versions[place] for name, place in steps.items()}


async def _models(api: Api, design: Design | RevisionWorksheet) -> dict[str, Model]:
    """The description of every model; models of one version share it."""
    places = {name: (model.id, model.version) for name, model in design.models.items()}
    versions = {
        (id, version): await api.get(f"/models/{id}/versions/{version}", Model)
        for id, version in dict.fromkeys(places.values())
    }
    return {name: versions[place] for name, place in places.items()}


async def _analyses(
    request: Request, api: Api, measured: Mapping[str, ModelMeasurements], models: Mapping[str, Model]
) -> dict[str, list[Analysis]]:
    """The finished analyses of every model's solid."""
    return {
        name: await finished_analyses(request, api, part.build, models[name], part.analyses)
        for name, part in measured.items()
    }


async def _fields_of_solids(
    api: Api, id: str, measured: Mapping[str, ModelMeasurements]
) -> dict[str, list[SolidField]]:
    """What can be painted on every model; nothing on one without analyses."""
    fields: dict[str, list[SolidField]] = {name: [] for name in measured}
    for name, part in measured.items():
        if part.analyses:
            path = f"/designs/{id}/revisions/{part.revision}/models/{name}/fields"
            fields[name] = (await api.get(path, SolidFieldList)).items
    return fields


def _loose(
    fields: list[sheet.Field], faults: Mapping[str, str], wrong: Mapping[str, tuple[str, str]]
) -> dict[str, str]:
    """The faults that belong neither to a field of the worksheet nor to one of a small form."""
    shown = {name for name, _ in wrong.values()}
    loose = sheet.loose_faults(fields, faults)
    return {name: detail for name, detail in loose.items() if name not in shown}


def _fields(steps: list[StepBlock], models: list[ModelBlock]) -> list[sheet.Field]:
    """Every field of the blocks."""
    of_models = [field for block in models for field in block.fields]
    return of_models + [field for block in steps for field in (*block.fields, *block.options, *block.limits)]


async def _variants(request: Request, api: Api, id: str) -> VariantsOut:
    return await api.get(f"/designs/{id}/variants", VariantsOut, units=units_of(request))


async def _job(api: Api, design: Design) -> Job | None:
    """The job that regenerates the design, if one does."""
    if design.state != "regenerating":
        return None
    jobs = (await api.get("/jobs", JobList, limit=200)).items
    return next((job for job in jobs if job.design == design.id and job.state in UNFINISHED), None)


async def _choices(api: Api) -> dict[str, list[TemplateSummary]]:
    """The templates and models that a design may take in."""
    groups = {
        group: (await api.get(f"/{group}", TemplateList, limit=500)).items
        for group in ("templates", "models")
    }
    return {group: [item for item in items if item.latest] for group, items in groups.items()}
