"""Which templates there are: the built-in ones, and those in a team's own folders beside its models."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import templates
from cad.model import CadModel
from templates.core.catalogue.finding import Catalogue, find
from templates.core.language.template import Template

BUILT_IN = tuple(Path(folder) for folder in templates.__path__)


def find_templates(folders: Iterable[Path]) -> Catalogue[Template]:
    """All templates that calculate; one with a shape is a model, and found by `cad.catalogue.models`."""
    catalogue = find((*BUILT_IN, *folders), Template)
    return Catalogue({key: cls for key, cls in catalogue.versions.items() if not issubclass(cls, CadModel)})
