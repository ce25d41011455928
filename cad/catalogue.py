"""Find models: every `<id>_v<version>.py` in the built-in folder and in a team's folders."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from cad.model import CadModel
from templates.core.catalogue.discovery import Catalogue, find

BUILT_IN = Path(__file__).parent / "models"


@cache
def models(*folders: Path) -> Catalogue[CadModel]:
    """Return the built-in models and those in further folders."""
    return find((BUILT_IN, *folders), CadModel, "model")
