"""Tolerances on the design page: the toleranced values, and the analysis as a table with pictures."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from app.designs.questions import DesignQuestion
from app.designs.schemas.designs import Design
from app.presentation import bars
from app.schemas.answers import Quantity
from app.tolerances.bodies import ToleranceIn
from app.tolerances.schemas import OutputScatter, ToleranceAnalysis, Yield
from app.web.shared.answers import stored
from app.web.shared.paths import Id
from app.web.shared.responses import show, units_of
from app.web.shared.services import PageServices, Refused, ThePageServices
from templates.core.units.tolerance import is_toleranced

PATIENCE = 60.0  # time that the page waits for the analysis [s]
LOW, HIGH = "0.00135", "0.99865"


@dataclass(frozen=True)
class Line:
    """One output in the table, and its pictures."""

    name: str
    output: OutputScatter
    tornado: str
    histogram: str

    def quantity(self, value: float | None) -> Quantity | None:
        """Return a number in the output's unit as a quantity."""
        return None if value is None else Quantity(value=value, unit=self.output.unit)

    @property
    def low(self) -> Quantity | None:
        """Return the value below which 0.135 % of the products lie."""
        return self.quantity(self.output.quantiles.get(LOW))

    @property
    def high(self) -> Quantity | None:
        """Return the value above which 0.135 % of the products lie."""
        return self.quantity(self.output.quantiles.get(HIGH))


def toleranced(design: Design) -> bool:
    """Return whether any value of a design has a tolerance."""
    groups = [design.parameters, *(step.inputs for step in design.steps.values())]
    groups += [model.parameters for model in design.models.values()]
    return any(is_toleranced(raw) for group in groups for raw in group.values())


async def tolerances_page(
    request: Request, services: PageServices, id: str, job: str | None, *, is_part: bool
) -> Response:
    """Return the page with the analysis of the newest revision or of a finished job, or its main part."""
    design = await services.run(services.designs.show, id)
    template = "tolerances/tolerances_part.html" if is_part else "tolerances/tolerances_page.html"
    try:
        analysis, later = await _analysis(request, services, id, job)
    except Refused as refused:
        wrong = [fault.detail for fault in refused.problem.errors] or [refused.problem.detail]
        return show(request, template, refused.status, design=design, analysis=None, wrong=wrong, later=None)
    lines = [_line(name, output) for name, output in analysis.outputs.items()] if analysis else []
    return show(request, template, design=design, analysis=analysis, lines=lines, wrong=[], later=later)


async def _analysis(
    request: Request, services: PageServices, id: str, job: str | None
) -> tuple[ToleranceAnalysis | None, str | None]:
    """Return the analysis, or the job that is still computing it."""
    if job is not None:
        reply = await stored(services, job, ToleranceAnalysis)
        return reply.answer, reply.job or None
    body = ToleranceIn().model_dump_json(exclude_unset=True)
    asked = DesignQuestion(id, body, units=units_of(request))
    return await services.calculate(PATIENCE, services.tolerances.answer, asked, services.client)


def _line(name: str, output: OutputScatter) -> Line:
    shares = [bars.Bar(of, share.first, share.total) for of, share in output.shares.items()]
    histogram = ""
    if output.histogram is not None:
        marks = list(_marks(output))
        histogram = bars.histogram(output.histogram.edges, output.histogram.counts, marks, output.unit)
    return Line(name, output, bars.tornado(shares), histogram)


def _marks(output: OutputScatter) -> Iterator[bars.Mark]:
    if output.nominal is not None:
        yield bars.Mark("nominal", output.nominal, is_limit=False)
    edges = output.histogram.edges if output.histogram else []
    yield from (
        bars.Mark(one.of, one.limit) for one in output.yields if one.limit is not None and _near(one, edges)
    )


def _near(one: Yield, edges: list[float]) -> bool:
    """Return whether a limit is close enough to be shown without compressing the histogram."""
    assert one.limit is not None
    width = edges[-1] - edges[0]
    return edges[0] - width <= one.limit <= edges[-1] + width


router = APIRouter(include_in_schema=False)


@router.get("/designs/{id}/tolerances")
async def tolerances(
    id: Id,
    request: Request,
    services: ThePageServices,
    job: Annotated[str | None, Query(max_length=64, pattern=r"^[A-Za-z0-9_-]+$")] = None,
    part: Annotated[str, Query(max_length=1)] = "",
) -> Response:
    """Return the page on the effects of a design's tolerances; `part` returns only its main part."""
    return await tolerances_page(request, services, id, job, is_part=bool(part))
