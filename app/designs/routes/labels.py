"""`/designs/{id}/labels` and `/tags`: labels of designs, which change no revision."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path

from app.api.dependencies import TheDatabase, TheLabelling
from app.designs.labels import LabelsIn, all_tags
from app.designs.schemas.labels import Labels, TagList
from app.http.strict_requests import StrictRoute
from app.schemas.problems import refusals

router = APIRouter(prefix="/api/v1", tags=["designs"], route_class=StrictRoute)

Id = Annotated[str, Path(max_length=64)]


@router.get("/designs/{id}/labels", responses=refusals(404))
def show_labels(id: Id, labelling: TheLabelling) -> Labels:
    """Return the tags of a design, and whether it is archived."""
    return labelling.labels(id)


@router.post("/designs/{id}/labels", responses=refusals(404))
def change_labels(id: Id, body: LabelsIn, labelling: TheLabelling) -> Labels:
    """Add and remove tags, archive or restore a design; this creates no revision."""
    return labelling.label(id, body)


@router.get("/tags")
def list_tags(database: TheDatabase) -> TagList:
    """Return every tag of the designs that are not archived, the most used first."""
    with database.read() as session:
        return TagList(items=list(all_tags(session)))
