"""A filter on the list of designs, and its SQL conditions.

The database walks along the designs, newest first, until a page is full. A filter therefore costs time in
proportion to the number of designs that it skips, and memory for one page.
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
"""An id, or an id and a version: `oil_film`, `oil_film/2`."""


@dataclass(frozen=True)
class DesignFilter:
    """Filter of a list of designs; a field that is None lets every design pass."""

    name: str | None = None  # part of the design's name, in upper or lower case
    state: str | None = None  # of the newest revision
    tags: tuple[str, ...] = ()  # keys of tags, all of which the design has
    archived: str = "false"  # true: archived ones alone; any: those as well
    template: str | None = None  # of a step or a model of the newest revision, see TEMPLATE

    def __post_init__(self) -> None:
        """Check the template.

        Raises
        ------
        InvalidInputs
            If the template is not an id, or an id and a version.
        """
        if self.template is not None and not re.fullmatch(TEMPLATE, self.template):
            detail = "give the id of a template or model, or id/version: oil_film or oil_film/2"
            raise InvalidInputs([Fault("template", "pattern", detail)])


def conditions(session: Session, wanted: DesignFilter) -> Iterator[ColumnElement[bool]]:
    """Yield the conditions of a filter on a design."""
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
    """Yield the conditions of a filter on the newest revision of a design."""
    if wanted.state is not None:
        yield RevisionRow.state == wanted.state
    if wanted.template is not None:
        id, _, version = wanted.template.partition("/")
        number = int(version) if version else None
        yield or_(_has_step(session, id, number), _has_model(id, number))


def _has_step(session: Session, id: str, version: int | None) -> ColumnElement[bool]:
    """Return whether a step of the revision uses a template; its steps are read as a table of JSON values."""
    steps = func.json_each(_document(session)["steps"]).table_valued(column("value", JSON), name="step")
    step = steps.c.value
    query = select(1).select_from(steps).where(step["template"].as_string() == id)
    if version is not None:
        query = query.where(step["version"].as_integer() == version)
    return exists(query.correlate(RevisionRow))


def _document(session: Session) -> ColumnElement[JSON]:
    """Return the stored document as JSON.

    PostgreSQL has a type.
    """
    is_text = session.get_bind().dialect.name == "sqlite"
    return type_coerce(RevisionRow.document, JSON) if is_text else cast(RevisionRow.document, JSON)


def _has_model(id: str, version: int | None) -> ColumnElement[bool]:
    """Return whether a CAD model of the revision is of this kind."""
    query = select(1).where(
        RevisionModelRow.design_id == RevisionRow.design_id,
        RevisionModelRow.number == RevisionRow.number,
        RevisionModelRow.model == id,
    )
    if version is not None:
        query = query.where(RevisionModelRow.model_version == version)
    return exists(query.correlate(RevisionRow))
