"""`/verdicts`: the verdict of a preview as a part of a page, so that only the server renders it."""

from __future__ import annotations

from fastapi import APIRouter, Response
from fastapi.responses import HTMLResponse
from pydantic import Field

from app.http.access import needs
from app.http.strict_requests import StrictRoute
from app.schemas.answers import Answer
from app.schemas.criteria import Criterion, Verdict
from app.web.shared.responses import HEADERS, jinja
from app.web.verdict.banner import banner_over

router = APIRouter(include_in_schema=False, route_class=StrictRoute)


class JudgedAnswer(Answer):
    """The verdict and criteria of an answer of the interface, and the design if it is saved."""

    verdict: Verdict
    criteria: list[Criterion]
    design: str = Field("", pattern="^[A-Za-z0-9_-]*$", max_length=64)


@router.post("/verdicts", dependencies=[needs("viewer")])
def draw_verdict(judged: JudgedAnswer) -> Response:
    """Return the banner with the table of criteria, and the verdicts for the summary lines, as HTML."""
    drawn = jinja.get_template("verdict/verdict.html").module.drawn  # type: ignore[attr-defined]
    return HTMLResponse(drawn(banner_over(judged.verdict, judged.criteria), judged.design), headers=HEADERS)
