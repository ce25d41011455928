"""One variant of a design on its page: its verdict, and its curves, which the server draws."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from fastapi import Request

from app.designs.schemas.designs import Design
from app.designs.schemas.variants import VariantDetail
from app.designs.variants.detail import WantedVariant
from app.presentation.criteria import Line, line
from app.reports.content import Plot
from app.reports.plots import drawn
from app.reports.variants import of_variant
from app.web.shared.answers import AnswerOrJob, stored
from app.web.shared.blocks import StepBlock
from app.web.shared.responses import units_of
from app.web.shared.services import PageServices, Refused
from app.web.solve.solution import PATIENCE

WITHOUT_ANSWER = (404, 422)


@dataclass(frozen=True)
class ChosenVariant:
    """A variant as the page shows it; without lines and plots while it is not, or cannot be, calculated."""

    NONE: ClassVar[ChosenVariant]

    name: str
    headline: str = ""
    lines: Sequence[Line] = ()
    plots: Sequence[Plot] = ()
    problem: str = ""
    job: str = ""  # the job that calculates the variant


ChosenVariant.NONE = ChosenVariant("")


async def chosen_variant(
    request: Request, services: PageServices, design: Design, steps: list[StepBlock]
) -> ChosenVariant:
    """Return the variant that the address names, if any."""
    name, job = (request.query_params.get(key, "")[:64] for key in ("variant", "job"))
    if not name:
        return ChosenVariant.NONE
    try:
        reply = (
            await stored(services, job, VariantDetail)
            if job
            else await _calculated(request, services, design, name)
        )
    except Refused as refused:
        if refused.status not in WITHOUT_ANSWER:
            raise
        return ChosenVariant(name, problem=refused.problem.detail)
    return ChosenVariant(name, job=reply.job) if reply.answer is None else _shown(reply.answer, steps)


async def _calculated(
    request: Request, services: PageServices, design: Design, name: str
) -> AnswerOrJob[VariantDetail]:
    """Return the variant, or the job that calculates it if it takes longer than the page waits."""
    wanted = WantedVariant(design.id, name, system=units_of(request))
    answer, job = await services.calculate(PATIENCE, services.variant_details.answer, wanted, services.client)
    return AnswerOrJob(answer, job or "")


def _shown(detail: VariantDetail, steps: list[StepBlock]) -> ChosenVariant:
    headline = detail.verdict.headline if detail.verdict else ""
    plots = [plot for step in steps for plot in _plots(detail, step)]
    return ChosenVariant(detail.name, headline, [line(one) for one in detail.criteria], plots)


def _plots(detail: VariantDetail, step: StepBlock) -> list[Plot]:
    """Return the pictures of a step, with the inputs and outputs of the variant."""
    return drawn(step.template, of_variant(detail, step.name, step.result))
