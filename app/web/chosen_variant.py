"""One variant of a design on its page: how it is judged, and its curves, drawn by the server."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar
from urllib.parse import quote

from fastapi import Request

from app.designs.schemas.designs import Design
from app.designs.schemas.variants import VariantDetail
from app.presentation.criteria import Line, line
from app.reports.content import Plot
from app.reports.plots import drawn
from app.schemas.answers import Accepted
from app.web.api import Api, read
from app.web.blocks import StepBlock
from app.web.rendering import units_of
from app.web.services import Refused
from app.web.solution import ACCEPTED, PATIENT

WITHOUT_ANSWER = (404, 422)


@dataclass(frozen=True)
class ChosenVariant:
    """A variant as the page shows it; without lines and plots where it is not, or cannot be, calculated."""

    NONE: ClassVar[ChosenVariant]

    name: str
    headline: str = ""
    lines: Sequence[Line] = ()
    plots: Sequence[Plot] = ()
    problem: str = ""
    job: str = ""  # that calculates it


ChosenVariant.NONE = ChosenVariant("")


async def chosen_variant(request: Request, api: Api, design: Design, steps: list[StepBlock]) -> ChosenVariant:
    """The variant that the address names; none if it names none."""
    name, job = (request.query_params.get(key, "")[:64] for key in ("variant", "job"))
    if not name:
        return ChosenVariant.NONE
    path = (
        f"/evaluations/{quote(job, safe='')}"
        if job
        else f"/designs/{design.id}/variants/{quote(name, safe='')}"
    )
    try:
        response = await api.send("GET", path, params={"units": units_of(request)}, headers=PATIENT)
    except Refused as refused:
        if refused.status not in WITHOUT_ANSWER:
            raise
        return ChosenVariant(name, problem=refused.problem.detail)
    if response.status_code == ACCEPTED:
        return ChosenVariant(name, job=job or read(response, Accepted).job.rpartition("/")[2])
    return _shown(read(response, VariantDetail), steps)


def _shown(detail: VariantDetail, steps: list[StepBlock]) -> ChosenVariant:
    headline = detail.verdict.headline if detail.verdict else ""
    plots = [plot for step in steps for plot in _plots(detail, step)]
    return ChosenVariant(detail.name, headline, [line(one) for one in detail.criteria], plots)


def _plots(detail: VariantDetail, step: StepBlock) -> list[Plot]:
    """The pictures of a step with the outputs of the variant in the place of the design's own."""
    outputs = {
        name: detail.outputs.get(f"{step.name}.{name}", output)
        for name, output in step.result.outputs.items()
    }
    return drawn(step.template, step.result.model_copy(update={"outputs": outputs}))
