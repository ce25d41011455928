"""Answers about a design that its page and those of its revisions have in common."""

from __future__ import annotations

from collections.abc import Mapping

from fastapi import Request

from app.catalogue.schemas.templates import Template
from app.designs.schemas.designs import Design, RevisionWorksheet
from app.solids.schemas.models import CadModel
from app.web.api import Api, Scalar
from app.web.rendering import units_of
from app.web.same_answers import Same


async def revision_of(
    request: Request, api: Api, id: str, number: int, **options: Scalar
) -> RevisionWorksheet:
    """A revision as a worksheet, in the units that the page shows."""
    path = f"/designs/{id}/revisions/{number}/worksheet"
    return await api.get(path, RevisionWorksheet, units=units_of(request), **options)


async def same_revision(
    request: Request, api: Api, design: Design, **options: Scalar
) -> Same[RevisionWorksheet]:
    """The newest revision as a worksheet, in the units that the page shows; shared with earlier looks."""
    path = f"/designs/{design.id}/revisions/{design.revision}/worksheet"
    return await api.same(path, RevisionWorksheet, units=units_of(request), **options)


def steps_of_design(design: Design) -> dict[str, tuple[str, int]]:
    """Id and version of the template of every step."""
    return {name: (step.template, step.version) for name, step in design.steps.items()}


async def templates_of(api: Api, steps: Mapping[str, tuple[str, int]]) -> dict[str, Template]:
    """The template of every step; steps of one version share it."""
    versions = {
        (id, version): (await api.same(f"/templates/{id}/versions/{version}", Template)).model
        for id, version in dict.fromkeys(steps.values())
    }
    return {name: versions[place] for name, place in steps.items()}


async def described_models(api: Api, design: Design | RevisionWorksheet) -> dict[str, CadModel]:
    """The description of every model; models of one version share it."""
    places = {name: (model.id, model.version) for name, model in design.models.items()}
    versions = {
        (id, version): await api.get(f"/models/{id}/versions/{version}", CadModel)
        for id, version in dict.fromkeys(places.values())
    }
    return {name: versions[place] for name, place in places.items()}
