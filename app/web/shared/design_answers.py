"""Answers about a design that the pages of the design and of its revisions share."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from fastapi import Request

from app.approvals.routes import list_all_comments, list_comments
from app.approvals.schemas import Approvals, CommentList
from app.catalogue.routes.templates import list_template_versions, show_template
from app.catalogue.schemas.templates import Template
from app.designs.schemas.designs import Design, RevisionWorksheet
from app.jobs.schemas import Job
from app.solids.routes.models import show_model
from app.solids.schemas.models import CadModel
from app.web.shared.responses import units_of
from app.web.shared.services import PageServices


async def revision_of(
    request: Request,
    services: PageServices,
    id: str,
    number: int,
    *,
    within: float | None = None,
    only: str | None = None,
    has_formulas: bool = True,
) -> RevisionWorksheet:
    """Return a revision as a worksheet, in the units of the page; `only` restricts it to one step."""
    units = units_of(request)
    return await services.calculate(within, services.reports.worksheet, id, number, units, only, has_formulas)


async def job_of(services: PageServices, id: str) -> Job:
    """Return a job."""
    return Job.model_validate(await services.run(services.jobs.get, id))


def steps_of_design(design: Design) -> dict[str, tuple[str, int]]:
    """Return the id and version of the template of every step."""
    return {name: (step.template, step.version) for name, step in design.steps.items()}


async def templates_of(services: PageServices, steps: Mapping[str, tuple[str, int]]) -> dict[str, Template]:
    """Return the template of every step; steps with the same version share one object."""
    versions = {
        (id, version): await services.run(show_template, id, version, services.catalogues)
        for id, version in dict.fromkeys(steps.values())
    }
    return {name: versions[place] for name, place in steps.items()}


async def described_models(services: PageServices, design: Design | RevisionWorksheet) -> dict[str, CadModel]:
    """Return the description of every model; models with the same version share one object."""
    places = {name: (model.id, model.version) for name, model in design.models.items()}
    versions = {
        (id, version): await services.run(show_model, id, version, services.catalogues, services.database)
        for id, version in dict.fromkeys(places.values())
    }
    return {name: versions[place] for name, place in places.items()}


class Upgrade(NamedTuple):
    """A step with a newer version available, or whose version was withdrawn."""

    step: str
    template: str
    version: int
    newest: int
    withdrawn: str


async def upgrades_of(services: PageServices, templates: Mapping[str, Template]) -> list[Upgrade]:
    """Return, by name, the steps of a design that do not use the latest version, with their templates."""
    old = {name: template for name, template in templates.items() if not template.latest}
    newest = {id: await _newest(services, id) for id in {template.id for template in old.values()}}
    return [
        Upgrade(name, template.id, template.version, newest[template.id], template.withdrawn or "")
        for name, template in old.items()
    ]


async def _newest(services: PageServices, id: str) -> int:
    versions = (await services.run(list_template_versions, id, services.catalogues)).items
    return next(item.version for item in versions if item.latest)


ON_DESIGN = 10  # comments on the page of a design; the page of a revision lists all


async def approval_of(services: PageServices, id: str, number: int) -> Approvals:
    """Return the approval of a revision."""
    return await services.run(services.approving.show, id, number)


async def comments_of(
    services: PageServices, id: str, number: int | None, limit: int, cursor: str = ""
) -> CommentList:
    """Return comments on a revision, or on all revisions of a design."""
    if number:
        return await services.run(list_comments, id, number, services.comments, limit, cursor or None)
    return await services.run(list_all_comments, id, services.comments, limit, cursor or None)
