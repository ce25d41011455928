"""`/templates/{id}/versions/{n}/evaluate.csv`: an evaluation requested by its URL alone, for spreadsheets."""

from __future__ import annotations

from functools import partial
from typing import Annotated

from fastapi import APIRouter, Query, Request, Response
from pydantic.config import JsonDict

from app.api.dependencies import TheCatalogues, services_of
from app.calculations.spreadsheet_line import MOST_INPUTS, MOST_POINTS, csv_of
from app.catalogue.routes.templates import Id, Number
from app.http.access import TheClient
from app.http.strict_requests import StrictRoute
from app.observation.processor_time import in_thread
from app.plain import Raw
from app.pool.cost import EXPENSIVE, estimated_seconds
from app.pool.sources import source_of
from app.schemas.problems import refusals
from app.studies.routes.studies import calculated_in_pool
from templates.core.errors import Fault, InvalidInputs

router = APIRouter(prefix="/api/v1/templates", tags=["templates"], route_class=StrictRoute)

RESERVED = ("outputs", "level", "tolerance")
INPUTS: JsonDict = {
    "parameters": [
        {
            "name": "inputs",
            "in": "query",
            "description": "inputs by name, each with its unit: `radial_load=25 kN`; repeated: points",
            "style": "form",
            "explode": True,
            "schema": {"type": "object", "additionalProperties": {"type": "string"}},
        }
    ]
}


@router.get(
    "/{id}/versions/{number}/evaluate.csv",
    response_class=Response,
    responses={200: {"content": {"text/csv": {"schema": {"type": "string"}}}}, **refusals(404, 429)},
    openapi_extra=INPUTS,
)
async def evaluate_line(
    id: Id,
    number: Number,
    catalogues: TheCatalogues,
    client: TheClient,
    request: Request,
    outputs: Annotated[
        str | None, Query(max_length=5000, description="separated by commas; all, if none")
    ] = None,
    level: Annotated[str | None, Query(max_length=64)] = None,
    tolerance: Annotated[float | None, Query(gt=0, lt=1)] = None,
) -> Response:
    """Evaluate a template with inputs from the query, and return CSV.

    The CSV has a row of names, a row of units, then the numbers.
    """
    cls, inputs = catalogues.templates.get(id, number), _inputs(request)
    names = [name.strip() for name in outputs.split(",") if name.strip()] if outputs else None
    run = partial(csv_of, source_of(cls), inputs, names, level, tolerance)
    if estimated_seconds(cls, inputs, level, tolerance, names) > EXPENSIVE:
        pool = services_of(request).calculations
        content = await calculated_in_pool(pool, pool.submit(client, csv_of, *run.args))
    else:
        content = await in_thread(run)
    return Response(content, media_type="text/csv; charset=utf-8")


def _inputs(request: Request) -> dict[str, Raw]:
    """Return the inputs in the query as texts.

    A repeated name becomes an array; a reserved name is refused.
    """
    given: dict[str, list[str]] = {}
    for name, text in request.query_params.multi_items():
        if name not in RESERVED:
            given.setdefault(name, []).append(text)
    if len(given) > MOST_INPUTS or any(len(texts) > MOST_POINTS for texts in given.values()):
        detail = f"an address may have at most {MOST_INPUTS} inputs of {MOST_POINTS} points each; send a body"
        raise InvalidInputs([Fault("query", "too_many", detail)])
    twice = [name for name in RESERVED if len(request.query_params.getlist(name)) > 1]
    if twice:
        detail = "stands several times; give it once, several outputs separated by commas"
        raise InvalidInputs(Fault(name, "named_twice", f"{name} {detail}") for name in twice)
    return {name: texts[0] if len(texts) == 1 else texts for name, texts in given.items()}
