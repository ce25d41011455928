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
    Proposal,
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
from app.web.sections import (
    MOST_IN_FULL,
    asked_step,
    banner_of,
    sections,
    steps_in_full,
    variants_start,
)
from app.web.study_page import studies_of
from app.web.tolerances_page import toleranced
from app.web.upgrades import upgrades_of
from app.web.variants import RefusedTable, variants_table
from app.web.verdict import Banner, banner, opened, with_keys
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
    revision, preview, parameters, steps, parts, models, verdict, in_full = await _form(
        request, api, design, refusal
    )
    faults, wrong = refusal.faults, errors_of(refusal.part, refusal.faults)
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
            steps,
            verdict,
            asked_step(request, design.steps)
            or (None if variants.count else opened(list(design.steps), verdict)),
            base=f"/designs/{id}",
            in_full=in_full,
        ),
        models=parts,
        measured=measured,
        analyses=await _analyses(request, api, measured, models),
        painted_fields=await _fields_of_solids(api, id, measured),
        revisions=await api.get(f"/designs/{id}/revisions", RevisionList, limit=20, steps=False),
        proposals=await _proposals(api, design),
        job=await _job(api, design),
        studies=await studies_of(api, id),
        kinds=list(MEDIA_TYPES),
        loose=_loose([*parameters, *_fields(steps, parts)], faults, wrong),
        refused=bool(faults) or table is not None,
        notice=notice,
        verdict=verdict,
        verdict_banner=banner_of(verdict, id),
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
        variants_start="" if variants.count or variants.is_refused else variants_start(design, variants),
        approval=await approval_of(api, id, design.revision),
        comments=await comments_of(api, id, None, ON_DESIGN),
        chosen=await chosen_variant(request, api, design, steps),
        names="" if in_full is not None else names_json(network, values_of(revision, preview, measured)),
    )


class Form(NamedTuple):
    """A design as it is calculated, with the fields of its form; `models` are described by name.

    `in_full` are the steps of a long design that have fields and formulas here; None where all have.
    """

    revision: RevisionWorksheet
    preview: Preview | None
    parameters: list[sheet.Field]
    steps: list[StepBlock]
    parts: list[ModelBlock]
    models: dict[str, Model]
    verdict: Banner
    in_full: set[str] | None


async def _form(request: Request, api: Api, design: Design, refusal: Refusal) -> Form:
    id, within = design.id, 0 if design.state == "regenerating" else QUICK
    is_long = len(design.steps) > MOST_IN_FULL
    revision = await _revision(request, api, id, design.revision, within=within, formulas=not is_long)
    templates, models = await _templates(api, _steps_of_design(design)), await _models(api, design)
    has_parameters = bool(design.parameters)  # only with the worksheet a preview has their values
    query: dict[str, Scalar] = {"worksheet": has_parameters, "units": units_of(request), "within": within}
    has_values = has_parameters or bool(design.models)  # the page shows nothing else of a preview
    preview = await api.post(f"/designs/{id}/preview", Preview, {}, **query) if has_values else None
    before = await _before(request, api, design)
    computed = {name: step.outputs for name, step in design.steps.items()}
    tables = await library(api) if templates else []
    has_criteria = bool(design.criteria) or any(template.criteria for template in templates.values())
    verdict = banner(revision, has_criteria=has_criteria)
    in_full = steps_in_full(request, design.steps, refusal, verdict) if is_long else None
    for name in in_full or ():
        written = await _revision(request, api, id, design.revision, within=within, step=name)
        revision.steps[name] = written.steps[name]
    steps = [
        with_fields(block, design, refusal, tables) if in_full is None or block.name in in_full else block
        for block in steps_of(revision, templates, computed)
    ]
    parts = [
        with_changes(block, design, refusal, before, preview.model_parameters if preview else {})
        for block in models_of(revision, models)
    ]
    typed, faults = refusal.typed, refusal.faults
    values = (preview.parameters if preview else None) or {}
    parameters = sheet.of_parameters(design.parameters, values, typed, faults)
    steps = with_keys(steps, revision, design)
    return Form(revision, preview, parameters, steps, parts, models, verdict, in_full)


async def _before(request: Request, api: Api, design: Design) -> RevisionWorksheet | None:
    """The revision before the newest; of it the page shows parameters of models alone."""
    if design.revision == 1 or not design.models:
        return None
    return await _revision(request, api, design.id, design.revision - 1, within=0, formulas=False)


async def step_section(request: Request, api: Api, id: str, name: str) -> Response:
    """The section of one step, unfolded, for the page of a long design; its script fetches it.

    Raises
    ------
    Refused
        If there is no such design, or no such step in it.
    """
    design = await api.get(f"/designs/{id}", Design)
    revision = await _revision(request, api, id, design.revision, within=QUICK, step=name)
    templates = await _templates(api, {name: _steps_of_design(design)[name]})
    blocks = steps_of(revision, templates, {name: design.steps[name].outputs})
    tables = await library(api)
    steps = with_keys([with_fields(block, design, NO_REFUSAL, tables) for block in blocks], revision, design)
    (section,) = sections(steps, banner(revision), name, in_full={name})
    return show(request, "section.html", section=section)


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


async def _proposals(api: Api, design: Design) -> list[Proposal]:
    """Relations for parameters of models that are not set; none without a model."""
    if not design.models:
        return []
    return (await api.post(f"/designs/{design.id}/auto-map", Proposals)).proposals


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
