"""Create the model of a build from its row."""

from __future__ import annotations

from sqlalchemy.orm import Session

from app.solids import rows
from app.storage.errors import CannotRebuild, NotFound
from cad.model import CadModel
from cad.regenerate import MADE_BY, build_key, made_by
from templates.core.catalogue.discovery import Catalogue
from templates.core.errors import TemplateError, UnknownTemplate

OLDER = "an older version of this program"


def shape_of(session: Session, catalogue: Catalogue[CadModel], key: str) -> CadModel:
    """Return the model of a build, with its parameters.

    Its key differs if another recipe made the build.

    Raises
    ------
    NotFound
        If there is no such build.
    CannotRebuild
        If the model no longer exists, or refuses the parameters that it once accepted.
    """
    row = rows.build(session, key)
    if row is None:
        raise NotFound(f"there is no build {key[:80]!r}")
    given = {n: p if "unit" in p else p["value"] for n, p in row.parameters.items()}
    name = f"model {row.model} version {row.version}, which made build {key},"
    try:
        return catalogue.get(row.model, row.version).from_quantities(given)
    except UnknownTemplate as error:
        detail = f"{name} cannot be used: {error}. Put its file back, or correct it"
        raise CannotRebuild("model_gone", detail) from None
    except TemplateError as error:
        detail = f"{name} has been changed and refuses its parameters now: {error}"
        raise CannotRebuild("model_changed", detail) from None


def built_by_another(session: Session, key: str, shape: CadModel) -> CannotRebuild:
    """Return the problem that this program cannot rebuild a build.

    The problem links to the build that the program makes instead.
    """
    row = rows.build(session, key)
    maker, now = (row.made_by if row else "") or OLDER, made_by(type(shape))
    if maker.startswith(f"{MADE_BY}, code "):
        detail = (
            f"model {shape.id} version {shape.version} has been changed since it made build {key} "
            f"({maker}). Put its old file back, or restore the build's file from a backup"
        )
        return CannotRebuild("model_changed", detail, {"build": f"/api/v1/builds/{build_key(shape)}"})
    detail = (
        f"build {key} was made by {maker}; this program ({now}) makes another build of the same "
        "parameters. Restore the file from a backup, or use the new build"
    )
    return CannotRebuild("other_recipe", detail, {"build": f"/api/v1/builds/{build_key(shape)}"})
