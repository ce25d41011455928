"""Filter the list of designs by SQL conditions.

The database scans the designs, newest first, until a page is full. The time therefore grows with the number
of designs that a filter skips, and the memory is that of one page.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from sqlalchemy import JSON, ColumnElement, cast, column, exists, func, or_, select, type_coerce
from sqlalchemy.orm import Session

from app.storage.tables import DesignRow, DesignTagRow, RevisionModelRow, RevisionRow
from templates.core.errors import Fault, InvalidInputs

TEMPLATE = r"^[A-Za-z0-9_]{1,100}(/[1-9][0-9]{0,8})?$"
"""A template id, with or without a version: `oil_film`, `oil_film/2`."""


@dataclass(frozen=True)
class DesignFilter:
    """A filter on the list of designs; a field that is None matches every design."""

    name: str | None = None  # part of the design's name; case is ignored
    state: str | None = None  # state of the newest revision
    tags: tuple[str, ...] = ()  # keys of tags, all of which the design has
    archived: str = "false"  # "true": only archived designs; "any": archived designs too
    is_deleted: bool = False  # only deleted designs
    template: str | None = None  # template of a step, or CAD model, in the newest revision; see TEMPLATE

    def __post_init__(self) -> None:
        """Check the form of the template filter.

        Raises
        ------
        InvalidInputs
            If the template is neither an id nor an id with a version.
        """
        if self.template is not None and not re.fullmatch(TEMPLATE, self.template):
            detail = "give the id of a template or model, or id/version: oil_film or oil_film/2"
            raise InvalidInputs([Fault("template", "pattern", detail)])


def conditions(session: Session, wanted: DesignFilter) -> Iterator[ColumnElement[bool]]:
    """Yield the SQL conditions of a filter on a design."""
    if wanted.name is not None:
        yield DesignRow.name.icontains(wanted.name, autoescape=True)
    if wanted.archived != "any":
        is_archived = DesignRow.archived.is_not(None)
        yield is_archived if wanted.archived == "true" else ~is_archived
    for key in wanted.tags:
        is_own = (DesignTagRow.design_id == DesignRow.id) & (DesignTagRow.key == key)
        yield exists(select(1).where(is_own).correlate(DesignRow))
    if of_newest := list(_of_newest(session, wanted)):
        # No join: SQLite would begin with all revisions, and sort them.
        is_newest = (RevisionRow.design_id == DesignRow.id) & (RevisionRow.number == DesignRow.head)
        yield exists(select(1).where(is_newest, *of_newest).correlate(DesignRow))


def _of_newest(session: Session, wanted: DesignFilter) -> Iterator[ColumnElement[bool]]:
    """Yield the SQL conditions of a filter on the newest revision of a design."""
    if wanted.state is not None:
        yield RevisionRow.state == wanted.state
    if wanted.template is not None:
        id, _, version = wanted.template.partition("/")
        number = int(version) if version else None
        yield or_(_has_step(session, id, number), _has_model(id, number))


def _has_step(session: Session, id: str, version: int | None) -> ColumnElement[bool]:
    """Return the condition that a step of the revision uses a template; it searches the stored JSON."""
    steps = func.json_each(_document(session)["steps"]).table_valued(column("value", JSON), name="step")
    step = steps.c.value
    query = select(1).select_from(steps).where(step["template"].as_string() == id)
    if version is not None:
        query = query.where(step["version"].as_integer() == version)
    return exists(query.correlate(RevisionRow))


def _document(session: Session) -> ColumnElement[JSON]:
    """Return the stored document as a JSON expression; PostgreSQL needs a cast."""
    is_text = session.get_bind().dialect.name == "sqlite"
    return type_coerce(RevisionRow.document, JSON) if is_text else cast(RevisionRow.document, JSON)


def _has_model(id: str, version: int | None) -> ColumnElement[bool]:
    """Return the condition that the revision has a CAD model with this id."""
    query = select(1).where(
        RevisionModelRow.design_id == RevisionRow.design_id,
        RevisionModelRow.number == RevisionRow.number,
        RevisionModelRow.model == id,
    )
    if version is not None:
        query = query.where(RevisionModelRow.model_version == version)
    return exists(query.correlate(RevisionRow))
