"""Ids of worksheets, which share one namespace with files, and names of people."""

from __future__ import annotations

import re
import unicodedata

from app.catalogue.catalogues import Catalogues
from app.identity.principal import BUILT_IN, acting
from app.worksheets.errors import IdTaken
from templates.core.errors import Fault, InvalidInputs

RESERVED = frozenset({"check", "import", "new"})
"""Words that are part of a path, such as `/worksheets/check`, and so cannot be the id of a worksheet."""
_LIKE_A_VERSION = re.compile(r".*_v[0-9]+")


def require_free(id: str, catalogues: Catalogues) -> None:
    """Check that no file has this id and that the id has no other meaning.

    Raises
    ------
    InvalidInputs
        If the id has another meaning.
    IdTaken
        If a template or a CAD model has it.
    """
    if id in RESERVED or _LIKE_A_VERSION.fullmatch(id):
        why = "is part of an address" if id in RESERVED else "ends like a version"
        raise InvalidInputs([Fault("id", "name", f"{id!r} {why}; choose another, such as `bush_duty`")])
    files = catalogues.files
    for catalogue in (files.templates, files.models):
        if id in catalogue.ids or any(id == name for name, _ in catalogue.quarantined):
            raise IdTaken(id, f"a {catalogue.kind} in a file")


def signed(typed: str | None) -> tuple[str | None, str | None]:
    """Return the author of an action: name and id of a signed-in principal, else the typed name."""
    who = acting()
    return (typed, None) if who.id in BUILT_IN else (who.name, who.id)


def is_same_person(one: str, other: str) -> bool:
    """Return whether two names are equal, ignoring case, spaces and invisible characters."""
    return _folded(one) == _folded(other)


def _folded(name: str) -> str:
    seen = "".join(sign for sign in name if unicodedata.category(sign) != "Cf")
    return " ".join(unicodedata.normalize("NFKC", seen).casefold().split())
