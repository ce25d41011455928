"""The stamp that a downloaded file of a model carries: its design, revision, date and materials."""

from __future__ import annotations

from collections.abc import Mapping

from sqlalchemy.orm import Session

from app.designs import repository
from app.plain import Json
from app.solids import rows
from app.storage.tables import BuildRow, RevisionModelRow
from cad.model import material_named
from cad.stamp import Stamp

_MM3 = 1e-9  # m³


def stamp(session: Session, model: RevisionModelRow) -> Stamp:
    """The stamp of a built model: always the same, because a revision never changes."""
    revision = repository.revision(session, model.design_id, model.number)
    build = rows.build(session, model.build_key or "")
    return Stamp(
        design=revision.document["name"],
        model=model.own_name,
        revision=model.number,
        date=revision.created[:19],  # UTC, to the second
        materials=_materials(build) if build else {},
        variant=model.variant,
        is_only=len(revision.document["models"]) == 1,
    )


def _materials(build: BuildRow) -> Mapping[str, str]:
    """The materials of a build's parts; of a build of an older recipe that of the whole, by its density."""
    measured: Mapping[str, Json] = build.measurements
    if "materials" in measured:
        materials: dict[str, str] = measured["materials"]
        return materials
    measures = measured["measures"]
    return {build.model: material_named("", measures["mass"] / (measures["volume"] * _MM3))}
