"""Find templates: the built-in ones, and those in a team's own folders."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import templates
from cad.model import CadModel
from templates.core.catalogue.discovery import Catalogue, find
from templates.core.language.template import Template

BUILT_IN = tuple(Path(folder) for folder in templates.__path__)


def find_templates(
    folders: Iterable[Path], id: str | None = None, version: int | None = None
) -> Catalogue[Template]:
    """Return all templates for calculations, or only those of an id and version.

    `cad.catalogue.models` returns the CAD models.
    """
    catalogue = find((*BUILT_IN, *folders), Template, id=id, version=version)
    return Catalogue({key: cls for key, cls in catalogue.versions.items() if not issubclass(cls, CadModel)})
