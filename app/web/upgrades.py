"""Steps of a design for which there is a newer version, or of which the version is withdrawn."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from app.catalogue.routes.templates import list_template_versions
from app.catalogue.schemas.templates import Template
from app.web.services import PageServices


class Upgrade(NamedTuple):
    """A step for which there is a newer version, or of which the version is withdrawn."""

    step: str
    template: str
    version: int
    newest: int
    withdrawn: str


async def upgrades_of(services: PageServices, templates: Mapping[str, Template]) -> list[Upgrade]:
    """The steps of a design, by name with their templates, that do not use the latest version."""
    old = {name: template for name, template in templates.items() if not template.latest}
    newest = {id: await _newest(services, id) for id in {template.id for template in old.values()}}
    return [
        Upgrade(name, template.id, template.version, newest[template.id], template.withdrawn or "")
        for name, template in old.items()
    ]


async def _newest(services: PageServices, id: str) -> int:
    versions = (await services.run(list_template_versions, id, services.catalogues)).items
    return next(item.version for item in versions if item.latest)
