"""Labels of designs in the database. A change of labels affects no result."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Sequence

from pydantic import ConfigDict, Field
from sqlalchemy import delete, func, select
from sqlalchemy.orm import Session

from app.designs import repository
from app.designs.schemas.labels import MOST_TAGS, Labels, Tag, TagUse
from app.identity.audit import record
from app.schemas.bounds import Bounded
from app.storage.clock import now
from app.storage.database import Database
from app.storage.tables import DesignRow, DesignTagRow
from app.storage.units import upsert
from templates.core.errors import Fault, InvalidInputs

MOST_LISTED = 500


class LabelsIn(Bounded):
    """A change of labels; labels that it does not name stay. Repeating the change has no further effect."""

    model_config = ConfigDict(
        strict=True,
        extra="forbid",
        json_schema_extra={"examples": [{"add_tags": ["V8", "main bearing"], "archived": False}]},
    )

    add_tags: list[Tag] = Field([], max_length=MOST_TAGS)
    remove_tags: list[Tag] = Field(
        [], max_length=MOST_TAGS, description="tags that the design does not have are ignored"
    )
    archived: bool | None = Field(
        None, description="if true, lists omit the design unless they are filtered by `archived`"
    )


def key_of(tag: str) -> str:
    """Return the common key of all spellings of a tag.

    `Main  bearing` and `main bearing` have the same key.
    """
    return clean(tag).casefold()


def clean(tag: str) -> str:
    """Return a tag in its stored form: composed letters, single spaces."""
    return " ".join(filter(None, unicodedata.normalize("NFC", tag).split(" ")))


class LabelService:
    """Reads and changes labels, which do not affect results."""

    def __init__(self, database: Database) -> None:
        self.database = database

    def labels(self, id: str) -> Labels:
        """Return the labels of a design."""
        with self.database.read() as session:
            return _labels(session, repository.design(session, id))

    def label(self, id: str, change: LabelsIn) -> Labels:
        """Change the labels of a design, and return them.

        Raises
        ------
        InvalidInputs
            If the design would have too many tags.
        """

        def unit(session: Session) -> Labels:
            row = repository.locked(session, id)
            before = _labels(session, row)
            _apply(session, row, change)
            _record(session, id, before, _labels(session, row))
            return _labels(session, row)

        return self.database.write(unit)


def _apply(session: Session, row: DesignRow, change: LabelsIn) -> None:
    removed = {key_of(tag) for tag in change.remove_tags}
    if removed:
        of_design = DesignTagRow.design_id == row.id
        session.execute(delete(DesignTagRow).where(of_design, DesignTagRow.key.in_(removed)))
    for tag in change.add_tags:
        upsert(session, DesignTagRow(design_id=row.id, key=key_of(tag), tag=clean(tag)))
    session.flush()
    if len(tags_of(session, [row.id])[row.id]) > MOST_TAGS:
        raise InvalidInputs([Fault("add_tags", "too_many", f"a design may have at most {MOST_TAGS} tags")])
    if change.archived is not None and change.archived != (row.archived is not None):
        row.archived = now() if change.archived else None


def _record(session: Session, id: str, before: Labels, after: Labels) -> None:
    """Record a change of labels in the audit, if the service has one."""
    if before.tags != after.tags:
        record(session, "design.tag", f"designs/{id}")
    if before.archived != after.archived:
        record(session, "design.archive" if after.archived else "design.unarchive", f"designs/{id}")


def _labels(session: Session, row: DesignRow) -> Labels:
    return Labels(tags=tags_of(session, [row.id])[row.id], archived=row.archived is not None)


def tags_of(session: Session, ids: Sequence[str]) -> dict[str, list[str]]:
    """Return the tags of each design, in alphabetical order."""
    tags: dict[str, list[str]] = {id: [] for id in ids}
    query = select(DesignTagRow.design_id, DesignTagRow.tag).where(DesignTagRow.design_id.in_(ids))
    for id, tag in session.execute(query.order_by(DesignTagRow.key)):
        tags[id].append(tag)
    return tags


def all_tags(session: Session) -> Iterable[TagUse]:
    """Return the tags of designs that are neither deleted nor archived, most used first."""
    count = func.count()
    query = (
        select(func.min(DesignTagRow.tag), count)
        .join(DesignRow, DesignRow.id == DesignTagRow.design_id)
        .where(DesignRow.deleted.is_(None), DesignRow.archived.is_(None))
        .group_by(DesignTagRow.key)
        .order_by(count.desc(), DesignTagRow.key)
        .limit(MOST_LISTED)
    )
    return [TagUse(tag=tag, designs=number) for tag, number in session.execute(query)]
