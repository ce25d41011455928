"""Names of imported models and of their parameters."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable

from app.catalogue.catalogues import Catalogues
from app.imported_models.errors import ModelIdTaken
from cad.imported_models import imported_description
from templates.core.errors import Fault, InvalidInputs

RESERVED = frozenset({"import", "new"})
"""Words that have their own path, such as `/models/import`."""
_LIKE_A_VERSION = re.compile(r".*_v[0-9]+")
LONGEST = 60


def require_free(id: str, catalogues: Catalogues) -> None:
    """Check that an imported model may have this id.

    Raises
    ------
    InvalidInputs
        If the id is reserved, or ends like a version.
    ModelIdTaken
        If a template or another model has it.
    """
    if id in RESERVED or _LIKE_A_VERSION.fullmatch(id):
        why = "has an address of its own" if id in RESERVED else "ends like a version"
        raise InvalidInputs([Fault("id", "name", f"{id!r} {why}; choose another, such as `main_cap`")])
    snapshot = catalogues.snapshot
    if any(name == id for name, _ in (*snapshot.templates.quarantined, *snapshot.models.quarantined)):
        raise ModelIdTaken(f"{id} is already the id of a file of the team")
    if id in snapshot.templates.ids:
        raise ModelIdTaken(f"{id} is already the id of a template")
    if any(
        name == id and imported_description(cls) is None
        for (name, _), cls in snapshot.models.versions.items()
    ):
        raise ModelIdTaken(f"{id} is already the id of a model in a Python file")


def parameter_name(key: str, thing: str, taken: Iterable[str]) -> str:
    """Return an API name for a parameter: `boreDiameter` → `bore_diameter`.

    If that name is in use, the name of the parameter's object is put in front.
    """
    name = snake(key) or "parameter"
    if name in taken:
        name = f"{snake(thing) or 'object'}_{name}"[:LONGEST].strip("_")
    number, unique = 2, name
    while unique in taken:
        unique, number = f"{name}_{number}", number + 1
    return unique


def snake(text: str) -> str:
    """Return a text in lower-case ASCII letters, digits and single underscores, beginning with a letter.

    The result may be empty.
    """
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
    parted = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", plain).lower()
    name = re.sub(r"[^a-z0-9]+", "_", parted).strip("_")[:LONGEST].strip("_")
    return re.sub(r"^[0-9_]+", "", name)
