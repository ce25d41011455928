"""The design page, which shows worksheet and part side by side."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from fastapi import Request, Response
from markupsafe import Markup

from app.catalogue.routes.templates import list_templates
from app.catalogue.schemas.templates import Template, TemplateSummary
from app.designs.preview import PreviewRequest
from app.designs.routes.designs import show_measurements
from app.designs.routes.revisions import list_revisions
from app.designs.routes.solid_fields import list_solid_fields
from app.designs.routes.variants import variants_of
from app.designs.schemas.designs import (
    Design,
    ModelMeasurements,
    Preview,
    Proposal,
    RevisionWorksheet,
    RoundedValue,
)
from app.designs.schemas.solid_fields import SolidField
from app.designs.schemas.variants import VariantsOut
from app.identity.principal import acting
from app.jobs.routes import list_jobs
from app.jobs.schemas import Job
from app.solids.routes.models import list_models
from app.solids.schemas.analyses import Analysis
from app.solids.schemas.models import CadModel as Model
from app.web.design.declarations import analysis_lines, errors_of, iteration_lines, measures
from app.web.design.flow import drawing
from app.web.design.own_lines import own_lines
from app.web.design.sections import (
    MOST_IN_FULL,
    asked_step,
    banner_of,
    fold_lines,
    sections,
    steps_in_full,
    variants_start,
)
from app.web.model.routes import finished_analyses
from app.web.shared import sheet
from app.web.shared.blocks import (
    ModelBlock,
    Refusal,
    StepBlock,
    models_of,
    painted,
    steps_of,
    with_changes,
    with_fields,
    with_result,
)
from app.web.shared.design_answers import (
    ON_DESIGN,
    approval_of,
    comments_of,
    described_models,
    revision_of,
    steps_of_design,
    templates_of,
    upgrades_of,
)
from app.web.shared.forms import texts
from app.web.shared.limits import library
from app.web.shared.places import names_json, values_of
from app.web.shared.responses import show, units_of
from app.web.shared.services import PageServices
from app.web.study.page import studies_of
from app.web.tolerances.routes import toleranced
from app.web.variants.detail import chosen_variant
from app.web.variants.table import RefusedTable, places_of, variants_table
from app.web.verdict.banner import Banner, banner, opened, with_keys
from cad.file_kinds import BY_PART, MEDIA_TYPES

UNFINISHED = ("queued", "running")
QUICK = 1  # longest wait for steps; the page's script requests slower ones and shows their progress [s]
NO_REFUSAL = Refusal()
NO_PART = dict.fromkeys(("declare", "add", "name", "value"), "")


async def design_page(
    request: Request,
    services: PageServices,
    id: str,
    *,
    refusal: Refusal = NO_REFUSAL,
    table: RefusedTable | None = None,
    notice: str | None = None,
    status: int = 200,
) -> Response:
    """Return the page of the newest revision with its form, or with a refused form and its faults."""
    design = await services.run(services.designs.show, id)
    revision, preview, parameters, steps, folded, parts, models, verdict, in_full = await _form(
        request, services, design, refusal
    )
    faults, wrong = refusal.faults, errors_of(refusal.part, refusal.faults)
    measured = await services.run(show_measurements, id, services.database, units_of(request))
    network = await services.run(services.designs.network, id)
    places = places_of(network, design)
    variants = variants_table(design, await _variants(request, services, id), places, table)
    return show(
        request,
        "design/design.html",
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
            in_full=in_full,
            folded=folded,
        ),
        models=parts,
        measured=measured,
        analyses=await _analyses(request, services, measured, models),
        painted_fields=await _fields_of_solids(services, id, measured),
        revisions=await services.run(list_revisions, id, services.database, limit=20, steps=False),
        proposals=await _proposals(services, design),
        job=await _job(services, design),
        studies=await studies_of(services, id),
        kinds=list(MEDIA_TYPES),
        by_part=list(BY_PART),
        loose=_loose([*parameters, *_fields(steps, parts)], faults, wrong),
        refused=bool(faults) or table is not None,
        notice=notice,
        verdict=verdict,
        verdict_banner=banner_of(verdict, id),
        toleranced=toleranced(design),
        base=f"/api/v1/designs/{id}",
        painted=painted(steps, parts),
        was=_as_typed(design),
        own_lines=own_lines(design, revision, refusal),
        choices=await _choices(services),
        analysis_lines=analysis_lines(design, parts, refusal),
        iteration_lines=iteration_lines(design, refusal),
        part={**NO_PART, **refusal.part},
        part_errors=wrong,
        measures=list(measures(design, parts)),
        network=network,
        picture=drawing(network),
        upgrades=await upgrades_of(services, {step.name: step.template for step in steps}),
        variants=variants,
        variants_start="" if variants.count or variants.is_refused else variants_start(design, variants),
        approval=await approval_of(services, id, design.revision),
        comments=await comments_of(services, id, None, ON_DESIGN),
        chosen=await chosen_variant(request, services, design, steps),
        names="" if in_full is not None else names_json(network, values_of(revision, preview, measured)),
    )


class Form(NamedTuple):
    """A design as calculated, with the fields of its form; `models` are described by name.

    `in_full` are the steps of a long design whose fields and formulas are on the page; None if all are. The
    summary lines of the other steps are `folded`.
    """

    revision: RevisionWorksheet
    preview: Preview | None
    parameters: list[sheet.Field]
    steps: list[StepBlock]
    folded: Mapping[str, Markup]
    parts: list[ModelBlock]
    models: dict[str, Model]
    verdict: Banner
    in_full: set[str] | None


async def _form(request: Request, services: PageServices, design: Design, refusal: Refusal) -> Form:
    id = design.id
    within = 0 if design.state == "regenerating" else QUICK
    is_long = len(design.steps) > MOST_IN_FULL
    revision = await revision_of(
        request, services, id, design.revision, within=within, has_formulas=not is_long
    )
    templates, models = (
        await templates_of(services, steps_of_design(design)),
        await described_models(services, design),
    )
    has_parameters = bool(design.parameters)  # only a preview with the worksheet has their values
    change = PreviewRequest(id, {}, worksheet=has_parameters, system=units_of(request))
    has_values = has_parameters or bool(design.models)  # the page shows nothing else of a preview
    preview = await services.calculate(within, services.previews.at_once, change) if has_values else None
    before = await _before(request, services, design)
    tables = await library(services) if templates else []
    verdict = _verdict(revision, design, templates)
    rounded = by_name(revision.rounded)
    bare = blocks = _blocks(revision, design, templates)
    in_full = steps_in_full(request, design.steps, refusal, verdict) if is_long else None
    if in_full is not None:
        written = [
            await revision_of(request, services, id, design.revision, within=within, only=name)
            for name in in_full
        ]
        whole = {name: step for one in written for name, step in one.steps.items()}
        revision = revision.model_copy(update={"steps": {**revision.steps, **whole}})
        blocks = [with_result(block, whole.get(block.name)) for block in blocks]
    steps = [
        with_fields(block, design, refusal, tables, rounded)
        if in_full is None or block.name in in_full
        else block
        for block in blocks
    ]
    folded = {} if in_full is None else fold_lines(bare, verdict, f"/designs/{id}")
    parts = [
        with_changes(block, design, refusal, before, preview.model_parameters if preview else {}, rounded)
        for block in models_of(revision, models)
    ]
    typed, faults = refusal.typed, refusal.faults
    values = (preview.parameters if preview else None) or {}
    parameters = sheet.of_parameters(design.parameters, values, typed, faults, rounded, _sources(design))
    return Form(revision, preview, parameters, steps, folded, parts, models, verdict, in_full)


def by_name(rounded: Sequence[RoundedValue]) -> dict[str, RoundedValue]:
    """Return rounded values by their names."""
    return {value.name: value for value in rounded}


def _sources(design: Design) -> dict[str, str]:
    """Return the sources of the assumed parameters."""
    return {name: one.source for name, one in design.assumed.items()}


def _as_typed(design: Design) -> str:
    return json.dumps(texts(design))


def _verdict(revision: RevisionWorksheet, design: Design, templates: Mapping[str, Template]) -> Banner:
    has_criteria = bool(design.criteria) or any(template.criteria for template in templates.values())
    return banner(revision, has_criteria=has_criteria)


def _blocks(
    revision: RevisionWorksheet, design: Design, templates: Mapping[str, Template]
) -> list[StepBlock]:
    """Return the steps with their results and the outputs in their summary lines."""
    computed = {name: step.outputs for name, step in design.steps.items()}
    return with_keys(steps_of(revision, templates, computed), revision, design)


async def _before(request: Request, services: PageServices, design: Design) -> RevisionWorksheet | None:
    """Return the previous revision; the page shows only its model parameters."""
    if design.revision == 1 or not design.models:
        return None
    return await revision_of(request, services, design.id, design.revision - 1, within=0, has_formulas=False)


async def step_section(request: Request, services: PageServices, id: str, name: str) -> Response:
    """Return the unfolded section of one step, which the script of a long design's page requests.

    Raises
    ------
    Refused
        If there is no such design, or no such step in it.
    """
    design = await services.run(services.designs.show, id)
    revision = await revision_of(request, services, id, design.revision, within=QUICK, only=name)
    templates = await templates_of(services, {name: steps_of_design(design)[name]})
    blocks = steps_of(revision, templates, {name: design.steps[name].outputs})
    tables = await library(services)
    steps = with_keys(
        [with_fields(block, design, NO_REFUSAL, tables, by_name(revision.rounded)) for block in blocks],
        revision,
        design,
    )
    (section,) = sections(steps, banner(revision), name, in_full={name})
    return show(request, "design/section.html", section=section)


async def _analyses(
    request: Request,
    services: PageServices,
    measured: Mapping[str, ModelMeasurements],
    models: Mapping[str, Model],
) -> dict[str, list[Analysis]]:
    """Return the finished analyses of every model's solid."""
    return {
        name: await finished_analyses(request, services, part.build, models[name], part.analyses)
        for name, part in measured.items()
    }


async def _fields_of_solids(
    services: PageServices, id: str, measured: Mapping[str, ModelMeasurements]
) -> dict[str, list[SolidField]]:
    """Return the fields that can be shown in colour on each model; none for a model without analyses."""
    fields: dict[str, list[SolidField]] = {name: [] for name in measured}
    for name, part in measured.items():
        if part.analyses:
            listed = await services.run(
                list_solid_fields, id, part.revision, name, services.database, services.catalogues
            )
            fields[name] = listed.items
    return fields


async def _proposals(services: PageServices, design: Design) -> list[Proposal]:
    """Return proposed relations for unset model parameters; empty if the principal may not save."""
    if not (design.models and acting().may("author")):
        return []
    return await services.calculate(None, services.designs.proposals, design.id)


def _loose(
    fields: list[sheet.Field], faults: Mapping[str, str], wrong: Mapping[str, tuple[str, str]]
) -> dict[str, str]:
    """Return the faults that belong to no field of the worksheet or of a small form."""
    shown = {name for name, _ in wrong.values()}
    loose = sheet.loose_faults(fields, faults)
    return {name: detail for name, detail in loose.items() if name not in shown}


def _fields(steps: list[StepBlock], models: list[ModelBlock]) -> list[sheet.Field]:
    """Return all fields of the blocks."""
    of_models = [field for block in models for field in block.fields]
    return of_models + [field for block in steps for field in (*block.fields, *block.options, *block.limits)]


async def _variants(request: Request, services: PageServices, id: str) -> VariantsOut:
    return await services.run(
        variants_of, id, None, services.database, services.catalogues, (), units_of(request)
    )


async def _job(services: PageServices, design: Design) -> Job | None:
    """Return the job that regenerates the design, if there is one."""
    if design.state != "regenerating":
        return None
    jobs = (await services.run(list_jobs, services.jobs, limit=200)).items
    return next((job for job in jobs if job.design == design.id and job.state in UNFINISHED), None)


async def _choices(services: PageServices) -> dict[str, list[TemplateSummary]]:
    """Return the templates and models that can be added to a design."""
    groups = {
        "templates": (await services.run(list_templates, services.catalogues, limit=500)).items,
        "models": (await services.run(list_models, services.catalogues, limit=500)).items,
    }
    return {group: [item for item in items if item.latest] for group, items in groups.items()}
