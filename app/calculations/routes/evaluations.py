"""`/evaluations/{job}`: the answer to a calculation that continued as a job."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Header, Path, Request, Response

from app.api.answers import answer_of
from app.api.dependencies import services_of
from app.api.file_answers import UNAVAILABLE
from app.api.responses import LATER
from app.calculations.schemas.evaluations import AnyCalculation
from app.designs.schemas.decision import Decision
from app.designs.schemas.designs import Explanation, Preview
from app.designs.schemas.solution import DesignSolution
from app.designs.schemas.variants import VariantDetail
from app.http.access import TheClient
from app.http.strict_requests import StrictRoute
from app.impact.schemas import Impact
from app.schemas.problems import refusals
from app.tolerances.schemas import ToleranceAnalysis

router = APIRouter(prefix="/api/v1/evaluations", tags=["templates"], route_class=StrictRoute)


@router.get(
    "/{job}",
    response_model=AnyCalculation
    | Preview
    | Decision
    | DesignSolution
    | ToleranceAnalysis
    | Impact
    | VariantDetail
    | Explanation,
    responses={**LATER, **UNAVAILABLE, **refusals(404, 409, 429)},
)
async def show_evaluation(
    job: Annotated[str, Path(max_length=64)],
    client: TheClient,
    request: Request,
    prefer: Annotated[str | None, Header(description="`wait=5`, for an answer that was lost")] = None,
) -> Response:
    """Return the answer of an `evaluate`, `solve`, `preview`, `impact` or similar; 202 while its job runs.

    A lost answer is calculated again; only its elapsed time may differ.
    """
    return await answer_of(services_of(request), job, request, client, prefer)
