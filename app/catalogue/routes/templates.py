"""`/templates`: list the templates and describe each version."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Annotated, TypeVar
from weakref import WeakKeyDictionary

from fastapi import APIRouter, Path, Query

from app.api.dependencies import TheCatalogues
from app.catalogue.catalogues import Catalogues
from app.catalogue.schemas.templates import (
    Accuracy,
    SheetMark,
    TemplateList,
    TemplateSummary,
    TemplateVersions,
)
from app.catalogue.schemas.templates import Template as TemplateAnswer
from app.catalogue.search import matching
from app.catalogue.sheets import Key
from app.http.pages import Cursor, Limit, page_of
from app.http.strict_requests import StrictRoute
from app.schemas.problems import refusals
from templates.core.catalogue.discovery import Catalogue
from templates.core.errors import UnknownTemplate
from templates.core.language.levels import accuracy
from templates.core.language.template import Template
from templates.core.paper.schema import describe

router = APIRouter(prefix="/api/v1/templates", tags=["templates"], route_class=StrictRoute)

Number = Annotated[int, Path(ge=1, le=10**6, examples=[1])]
Id = Annotated[str, Path(max_length=64, examples=["oil_film"])]

Search = Annotated[
    str,
    Query(
        max_length=200,
        description="words of the title, a standard, an author, a symbol, a name of a textbook",
        examples=["ISO 7902"],
    ),
]


@router.get("")
def list_templates(
    catalogues: TheCatalogues, limit: Limit = 100, cursor: Cursor = None, search: Search = ""
) -> TemplateList:
    """Return every version of every template, or the results of a search."""
    if not search.strip():
        return listed(catalogues.templates, limit, cursor, marks(catalogues))
    marked = marks(catalogues)
    kept, notes = matching(catalogues.templates, search)
    page = page_of(TemplateList, kept, limit, cursor, lambda cls: summary(cls, catalogues.templates, marked))
    return page.model_copy(update={"notes": notes})


@router.get("/{id}", responses=refusals(404))
def list_template_versions(id: Id, catalogues: TheCatalogues) -> TemplateVersions:
    """Return the versions of one template."""
    return versions_of(catalogues.templates, id, marks(catalogues))


@router.get("/{id}/versions/{number}", responses=refusals(404))
def show_template(id: Id, number: Number, catalogues: TheCatalogues) -> TemplateAnswer:
    """Return one version: inputs and outputs as JSON Schema, printed formulas, limits, references, errata."""
    cls = catalogues.templates.get(id, number)
    is_latest = cls is catalogues.templates.latest(id)
    return TemplateAnswer.model_validate(
        {**_description(cls), "latest": is_latest, **marks(catalogues).get((cls.id, cls.version), {})}
    )


@router.get("/{id}/versions/{number}/accuracy", responses=refusals(404))
def show_accuracy(id: Id, number: Number, catalogues: TheCatalogues) -> Accuracy:
    """Return the measured cost and error of each level over the parameter plane; 404 if none was measured."""
    cls = catalogues.templates.get(id, number)
    measured = accuracy(cls)
    if measured is None:
        raise UnknownTemplate(id, f"the error of {id} version {number} has not been measured")
    return Accuracy.model_validate(measured.content)


T = TypeVar("T", bound=Template)

_described: WeakKeyDictionary[type[Template], dict[str, object]] = WeakKeyDictionary()
_titles: WeakKeyDictionary[type[Template], dict[str, str]] = WeakKeyDictionary()


def _description(cls: type[Template]) -> Mapping[str, object]:
    """Return the description of a version, which depends only on its class."""
    if (description := _described.get(cls)) is None:
        description = _described[cls] = describe(cls)
    return description


def _words(cls: type[Template]) -> Mapping[str, str]:
    """Return the title and the summary of a version."""
    if (words := _titles.get(cls)) is None:
        words = _titles[cls] = {"title": cls.title(), "summary": cls.summary()}
    return words


Marks = Mapping[Key, Mapping[str, SheetMark]]
"""The worksheet's fields in an answer, by id and version."""


def marks(catalogues: Catalogues) -> Marks:
    """Return, for each version that is a worksheet, its state, author and reviewer."""
    return {
        key: {
            "worksheet": SheetMark(
                state=sheet.state,
                author=sheet.author,
                reviewer=sheet.reviewer,
                review_verified=sheet.is_verified,
            )
        }
        for key, sheet in catalogues.snapshot.sheets.released.items()
    }


def listed(
    catalogue: Catalogue[T], limit: int, cursor: str | None, marked: Marks = MappingProxyType({})
) -> TemplateList:
    """Return one page of all versions in a catalogue."""
    return page_of(TemplateList, list(catalogue), limit, cursor, lambda cls: summary(cls, catalogue, marked))


def versions_of(catalogue: Catalogue[T], id: str, marked: Marks = MappingProxyType({})) -> TemplateVersions:
    """Return all versions of one template or model.

    Raises
    ------
    UnknownTemplate
        If there is none.
    """
    items = [summary(cls, catalogue, marked) for cls in catalogue.of(id).values()]
    return TemplateVersions(id=id, items=items, next=None)


def summary(cls: type[Template], catalogue: Catalogue[T], marked: Marks) -> TemplateSummary:
    """Return one version as a list item."""
    return TemplateSummary(
        id=cls.id,
        version=cls.version,
        **_words(cls),
        status="withdrawn" if cls.withdrawn else "released",
        latest=cls is catalogue.latest(cls.id),
        **marked.get((cls.id, cls.version), {}),
    )
