"""`/designs/{id}/compare`: the differences between two revisions, of one design or of two."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path, Query

from app.api.dependencies import TheCatalogues, TheDatabase, Units
from app.designs.comparison import Pair, compare
from app.designs.schemas.comparison import Comparison
from app.http.strict_requests import StrictRoute
from app.schemas.problems import refusals

router = APIRouter(prefix="/api/v1/designs", tags=["designs"], route_class=StrictRoute)

Id = Annotated[str, Path(max_length=64)]
Number = Annotated[
    int | None,
    Query(
        ge=1, le=10**9, description="revision of this design; by default the newest, or the one before `with`"
    ),
]
With = Annotated[
    int | None,
    Query(alias="with", ge=1, le=10**9, description="second revision; by default the newest"),
]
Other = Annotated[
    str | None, Query(max_length=64, description="design of the second revision; by default this design")
]


@router.get("/{id}/compare", responses=refusals(404))
def compare_revisions(
    id: Id,
    database: TheDatabase,
    catalogues: TheCatalogues,
    revision: Number = None,
    number: With = None,
    design: Other = None,
    units: Units = "si",
) -> Comparison:
    """Compare a revision of this design with another revision of it, or with one of another design."""
    with database.read() as session:
        return compare(session, Pair(id, revision, design or None, number), catalogues).in_units(units)
