"""A template's page: its description, and a form to evaluate it."""

from __future__ import annotations

from collections.abc import Mapping

from fastapi import APIRouter, Request, Response
from pydantic import JsonValue

from app.calculations.bodies import EvaluateIn
from app.calculations.schemas.evaluations import CalculatedBy, Output, Worksheet
from app.catalogue.routes.templates import list_template_versions, show_accuracy, show_template
from app.catalogue.schemas.declarations import properties
from app.catalogue.schemas.templates import Template
from app.pool.cost import estimated_seconds, writing_seconds
from app.presentation.criteria import line
from app.presentation.input_text import value_of
from app.presentation.units import System
from app.reports.pictures import pictures
from app.web.shared import sheet
from app.web.shared.answers import TemplateQuestion, calculated
from app.web.shared.forms import OPTIONS, option_of
from app.web.shared.limits import is_limit, library, limit_fields, limits_of, with_rows
from app.web.shared.paths import Id, Number
from app.web.shared.responses import go, show, units_of
from app.web.shared.services import PageServices, Refused, ThePageServices
from app.web.template.accuracy import table
from templates.core.language import template as language

ABOUT = {"units"}  # query fields besides the inputs
PATIENCE = 2.0  # longest wait of the page for an answer [s]; then it shows the progress


async def template_page(request: Request, services: PageServices, id: str, version: int) -> Response:
    """Return the page with results for the inputs in the address, or for the example if there are none."""
    template = await services.run(show_template, id, version, services.catalogues)
    typed = typed_in(request)
    inputs, chosen, limits = inputs_of(template, typed)
    tables = await library(services)
    measured = await services.find(show_accuracy, id, version, services.catalogues)
    written = await services.find(services.worksheets.sheet, id, version) if template.worksheet else None
    body = {"inputs": inputs, **chosen, **({"limits": limits} if limits else {})}
    answer, job, faults = await _tried(services, template, body, units_of(request))
    used = answer.inputs if answer else {}
    fields = with_rows(sheet.of_block(template.inputs, "", inputs, used, typed, faults), tables)
    given = limit_fields(template, "", limits, typed, faults, tables)
    options = sheet.of_options(template, "", chosen, typed, faults)
    return show(
        request,
        "template/template.html",
        status=422 if faults else 200,
        template=template,
        versions=(await services.run(list_template_versions, id, services.catalogues)).items,
        written=written,
        accuracy=measured,
        levels=table(measured) if measured else None,
        fields=fields,
        options=options,
        given_limits=given,
        loose=sheet.loose_faults([*fields, *given, *options], faults),
        criteria=[line(criterion) for criterion in (answer.criteria if answer else None) or ()],
        answer=answer or (_empty(template) if job else None),
        job=job,
        pictures=pictures(template, answer) if answer else [],
        path_of_api=f"/api/v1/templates/{id}/versions/{version}",
    )


Values = dict[str, JsonValue]


def typed_in(request: Request) -> dict[str, str]:
    """Return the typed texts by control."""
    return {name: text for name, text in request.query_params.items() if name not in ABOUT}


def inputs_of(template: Template, typed: Mapping[str, str]) -> tuple[Values, Values, Values]:
    """Return the inputs, the options and the limits of a calculation from the typed texts."""
    filled = {name: text.strip() for name, text in typed.items() if text.strip()}
    chosen = {f"@{option}": option for option in OPTIONS}
    limits = limits_of(filled)
    others = (name for name in filled if not is_limit(name) and name not in chosen)
    inputs = {name: value_of(filled[name]) for name in others}
    options = {o: option_of(o, filled[name]) for name, o in chosen.items() if name in filled}
    return inputs if typed else template.example, options, limits


async def _tried(
    services: PageServices, template: Template, body: Mapping[str, JsonValue], units: System
) -> tuple[Worksheet | None, str, dict[str, str]]:
    """Return the answer, the address of the job that calculates it, or the faults."""
    try:
        given = services.read(EvaluateIn, body)
        asked = TemplateQuestion(template.id, template.version, "worksheet", given, units)
        reply = await calculated(services, asked, _seconds, Worksheet, PATIENCE)
    except Refused as refused:
        if refused.status not in (413, 422, 429):
            raise
        return None, "", refused.faults or {"inputs": refused.problem.detail}
    return reply.answer, f"/api/v1/jobs/{reply.job}" if reply.job else "", {}


def _seconds(cls: type[language.Template], body: EvaluateIn) -> float:
    """Return the estimated time of a worksheet [s]."""
    seconds = estimated_seconds(cls, body.inputs, body.level, body.tolerance, body.outputs)
    return seconds + writing_seconds(cls, body.outputs)


def _empty(template: Template) -> Worksheet:
    """Return an empty worksheet, which the page's script fills in once results are calculated."""
    names = properties(template.outputs)
    return Worksheet(
        template=CalculatedBy(id=template.id, version=template.version),
        inputs={},
        outputs=dict.fromkeys(names, Output(value=None, reason="is being calculated")),
        level=None,
        error=dict.fromkeys(names),
        warnings=[],
        seconds=0.0,
        formulas=[],
    )


router = APIRouter(include_in_schema=False)


@router.get("/templates/{id}")
async def newest_template(id: Id, services: ThePageServices) -> Response:
    """Redirect to the latest version of a template."""
    versions = await services.run(list_template_versions, id, services.catalogues)
    return go(f"/templates/{id}/{next(item.version for item in versions.items if item.latest)}")


@router.get("/templates/{id}/{version}")
async def template(id: Id, version: Number, request: Request, services: ThePageServices) -> Response:
    """Return the page of a template with a form to evaluate it; the address contains the typed values."""
    return await template_page(request, services, id, version)
