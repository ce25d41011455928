"""The route of the page of an explanation."""

from __future__ import annotations

import asyncio
from typing import Annotated

from fastapi import APIRouter, Path, Request, Response

from app.designs.explanation import ExplanationQuestion
from app.presentation.criteria import line
from app.web.explanation.faces import face_of
from app.web.explanation.sensitivities import sensitivity_lines
from app.web.shared.paths import Id
from app.web.shared.responses import show, units_of
from app.web.shared.services import ThePageServices

router = APIRouter(include_in_schema=False)


@router.get("/designs/{id}/explain/{name}")
async def explanation(
    id: Id, name: Annotated[str, Path(max_length=140)], request: Request, services: ThePageServices
) -> Response:
    """Return the page that explains a model parameter or a criterion's verdict."""
    asked = ExplanationQuestion(id, name, units_of(request))
    design, chain = await asyncio.gather(
        services.run(services.designs.show, id),
        services.calculate(None, services.explanations.at_once, asked),
    )
    judged = line(chain.criterion) if chain.criterion else None
    slopes = sensitivity_lines(chain.sensitivities or [])
    return show(
        request,
        "explanation/explanation.html",
        design=design,
        chain=chain,
        judged=judged,
        sensitivities=slopes,
    )


@router.get("/designs/{id}/faces/{name}")
async def face(
    id: Id, name: Annotated[str, Path(max_length=140)], request: Request, services: ThePageServices
) -> Response:
    """Return what the panel beside the 3-D view shows of the parameter that a face carries."""
    asked = ExplanationQuestion(id, name, units_of(request))
    chain = await services.calculate(None, services.explanations.at_once, asked)
    return show(request, "explanation/face.html", design=id, face=face_of(chain))
