"""`/templates`: which calculations there are, and all that is known of each version."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Path

from app.dependencies import TheCatalogues
from app.http import StrictRoute
from app.paging import Cursor, Limit, page_of
from templates.core.catalogue.finding import Catalogue
from templates.core.errors import UnknownTemplate
from templates.core.language.levels import accuracy
from templates.core.language.template import Template
from templates.core.paper.schema import describe

router = APIRouter(prefix="/api/v1/templates", tags=["templates"], route_class=StrictRoute)

Number = Annotated[int, Path(ge=1, le=10**6, examples=[1])]
Id = Annotated[str, Path(max_length=64, examples=["oil_film"])]


@router.get("")
def list_templates(catalogues: TheCatalogues, limit: Limit = 100, cursor: Cursor = None) -> dict[str, Any]:
    """Every version of every template."""
    return page_of(list(catalogues.templates), limit, cursor, lambda cls: summary(cls, catalogues.templates))


@router.get("/{id}")
def list_versions(id: Id, catalogues: TheCatalogues) -> dict[str, Any]:
    """The versions of one template."""
    versions = list(catalogues.templates.of(id).values())
    return {
        "id": id,
        **page_of(versions, len(versions), None, lambda cls: summary(cls, catalogues.templates)),
    }


@router.get("/{id}/versions/{number}")
def show_version(id: Id, number: Number, catalogues: TheCatalogues) -> dict[str, Any]:
    """One version: inputs and outputs as JSON Schema, formulas on paper, limits, references, errata."""
    cls = catalogues.templates.get(id, number)
    return {**describe(cls), "latest": cls is catalogues.templates.latest(id)}


@router.get("/{id}/versions/{number}/accuracy")
def show_accuracy(id: Id, number: Number, catalogues: TheCatalogues) -> dict[str, Any]:
    """Measured cost and error of each level over the parameter plane; 404 where none was measured."""
    cls = catalogues.templates.get(id, number)
    measured = accuracy(cls)
    if measured is None:
        raise UnknownTemplate(id, f"the error of {id} version {number} is not measured")
    return measured.content


def summary(cls: type[Template], catalogue: Catalogue[Any]) -> dict[str, Any]:
    """One version in a list."""
    return {
        "id": cls.id,
        "version": cls.version,
        "title": cls.title(),
        "summary": cls.summary(),
        "status": "withdrawn" if cls.withdrawn else "released",
        "latest": cls is catalogue.latest(cls.id),
    }
