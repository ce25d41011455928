"""The page of a version's impact: a form, the progress of the job, and the affected designs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import urlencode

from fastapi import APIRouter, Depends, Request, Response

from app.catalogue.routes.templates import show_template
from app.impact.bodies import ImpactIn
from app.impact.schemas import DesignImpact, Impact
from app.impact.survey import ImpactQuestion
from app.presentation import numbers
from app.schemas.answers import Quantity
from app.web.shared.answers import stored
from app.web.shared.forms import fields, forms_only
from app.web.shared.paths import Id, Number, Text
from app.web.shared.responses import go, show, units_of
from app.web.shared.services import PageServices, Refused, ThePageServices

router = APIRouter(include_in_schema=False)
forms = APIRouter(include_in_schema=False, dependencies=[Depends(forms_only)])

ILL_NAMED = 422
MOST_LISTED = 200
EFFECTS = {"moved": "moves", "refused": "refuses it", "needs_solids": "needs a solid"}


@dataclass(frozen=True)
class Line:
    """A design in the table."""

    impact: DesignImpact

    @property
    def effect(self) -> str:
        """Return the effect of the version on the design, in words."""
        return EFFECTS[self.impact.effect]

    @property
    def margin(self) -> str:
        """Return the largest loss of margin, such as `0.59 µm of thick (114 %)`."""
        lost = self.impact.margin
        if lost is None:
            return ""
        share = "" if lost.relative is None else f" ({numbers.percent(lost.relative)})"
        return f"{numbers.in_line(lost.lost)} of {_placed(lost.name, lost.variant)}{share}"

    @property
    def output(self) -> str:
        """Return the output that changes most: `film.minimum_film_thickness: 3.24 µm → 2.66 µm (−18 %)`."""
        moved = self.impact.output
        if moved is None:
            return ""
        sign = "" if moved.change is None else "+" if moved.change > 0 else "−"
        change = "" if moved.change is None else f" ({sign}{numbers.percent(abs(moved.change))})"
        ends = f"{_shown(moved.old)} → {_shown(moved.new)}"
        return f"{_placed(moved.name, moved.variant)}: {ends}{change}"

    @property
    def parameters(self) -> list[str]:
        """Return the CAD parameters that change: `shell.inner_diameter: 48.003 mm → 48.002 mm`."""
        return [
            f"{_placed(one.name, one.variant)}: {_shown(one.old)} → {_shown(one.new)}"
            for one in self.impact.parameters
        ]


def _shown(quantity: Quantity | None) -> str:
    return "no value" if quantity is None else numbers.in_line(quantity)


def _placed(name: str, variant: str | None) -> str:
    return name if variant is None else f"{name} of {variant}"


@router.get("/templates/{id}/{version}/impact")
async def impact_page(
    id: Id,
    version: Number,
    request: Request,
    services: ThePageServices,
    job: Text = "",
    name: Text = "",
    tag: Text = "",
) -> Response:
    """Return the page with the form, or with the progress or result of a job."""
    impact, refusal = None, None
    if job:
        try:
            impact = (await stored(services, job, Impact)).answer
        except Refused as refused:
            refusal = refused
    return await _page(
        request, services, id, version, {"job": job, "name": name, "tag": tag}, impact, refusal
    )


@forms.post("/templates/{id}/{version}/impact")
async def ask(id: Id, version: Number, request: Request, services: ThePageServices) -> Response:
    """Start a calculation of the impact, and redirect to its page."""
    typed = await fields(request)
    asked = {name: typed.get(name, "").strip()[:200] for name in ("name", "tag")}
    try:
        body = services.read(ImpactIn, _body(asked))
        asked_for = ImpactQuestion(id, version, body, units_of(request))
        _, job = await services.run(services.impacts.answer, asked_for, services.client)
    except Refused as refused:
        if refused.status != ILL_NAMED:
            raise
        return await _page(request, services, id, version, asked, None, refused, ILL_NAMED)
    given = {name: text for name, text in asked.items() if text}
    return go(f"/templates/{id}/{version}/impact?{urlencode({**given, 'job': job})}")


@forms.post("/templates/{id}/{version}/impact/cancel")
async def cancel(id: Id, version: Number, request: Request, services: ThePageServices) -> Response:
    """Cancel a calculation; one that has already ended stays unchanged."""
    job = (await fields(request)).get("job", "")[:64]
    await services.cancel(job)
    return go(f"/templates/{id}/{version}/impact?{urlencode({'job': job})}")


def _body(asked: Mapping[str, str]) -> dict[str, object]:
    chosen: dict[str, object] = {"limit": MOST_LISTED}
    chosen |= {"name": asked["name"]} if asked["name"] else {}
    return chosen | ({"tags": [asked["tag"]]} if asked["tag"] else {})


async def _page(
    request: Request,
    services: PageServices,
    id: str,
    version: int,
    typed: Mapping[str, str],
    impact: Impact | None,
    refusal: Refused | None,
    status: int = 200,
) -> Response:
    template = await services.find(show_template, id, version, services.catalogues)  # not of a draft
    job = typed.get("job", "")
    return show(
        request,
        "impact/impact.html",
        status=status,
        id=id,
        version=version,
        is_released=template is not None,
        withdrawn=template.withdrawn if template else None,
        typed=typed,
        job=job if job and impact is None and refusal is None else "",
        impact=impact,
        lines=[Line(impact) for impact in impact.designs] if impact else [],
        refusal=refusal.problem if refusal else None,
    )
