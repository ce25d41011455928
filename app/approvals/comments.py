"""Comments on revisions: plain text about one name or the whole revision, open until they are resolved."""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.approvals.schemas import Comment, CommentIn
from app.designs import repository
from app.identity.audit import record
from app.identity.principal import acting
from app.storage.clock import new_id, now
from app.storage.database import Database
from app.storage.errors import NotFound
from app.storage.idempotency import Once
from app.storage.tables import CommentRow, RevisionRow
from templates.core.errors import Fault, InvalidInputs, plain


class Comments:
    """Comments on revisions."""

    def __init__(self, database: Database) -> None:
        self.database = database

    def page(self, id: str, number: int | None, limit: int, before: str | None) -> list[CommentRow]:
        """Return one page of the comments on a revision or a design, newest first.

        The list has one comment more than the page if there is a next page.

        Raises
        ------
        NotFound
            If there is no such design or revision.
        """
        query = select(CommentRow).where(CommentRow.design_id == id)
        if number is not None:
            query = query.where(CommentRow.revision == number)
        if before:
            query = query.where(CommentRow.id < before)
        with self.database.read() as session:
            if number is None:
                repository.design(session, id)
            else:
                repository.revision(session, id, number)
            return list(session.scalars(query.order_by(CommentRow.id.desc()).limit(limit + 1)))

    def add(self, id: str, number: int, body: CommentIn, once: Once) -> Comment:
        """Add a comment by the acting principal, and return the comment.

        Raises
        ------
        NotFound
            If there is no such design or revision.
        InvalidInputs
            If the revision has no such name.
        """

        def unit(session: Session) -> Comment:
            if location := once.begin(session):
                return shown(_row(session, id, number, location["comment"]))
            repository.design(session, id)
            row = repository.revision(session, id, number)
            if body.subject is not None:
                _require_name(row, body.subject)
            comment = _added(session, row, body)
            once.keep(session, 201, {"comment": comment.id})
            return shown(comment)

        return self.database.write(unit)

    def resolve(self, id: str, number: int, comment: str) -> Comment:
        """Mark a comment as resolved; a resolved comment stays unchanged.

        Raises
        ------
        NotFound
            If there is no such comment.
        """

        def unit(session: Session) -> Comment:
            row = _row(session, id, number, comment)
            if row.resolved is None:
                row.resolved, row.resolved_by = now(), acting().name
                record(session, "comment.resolve", _place(row), at=row.resolved)
            return shown(row)

        return self.database.write(unit)


def shown(row: CommentRow) -> Comment:
    """Return a comment as the interface shows it."""
    return Comment(
        id=row.id,
        design=row.design_id,
        revision=row.revision,
        name=row.name,
        subject=row.subject,
        text=row.text,
        created=row.created,
        resolved=row.resolved,
        resolved_by=row.resolved_by,
    )


def _added(session: Session, row: RevisionRow, body: CommentIn) -> CommentRow:
    who = acting()
    comment = CommentRow(
        id=new_id(session),
        design_id=row.design_id,
        revision=row.number,
        principal_id=who.id,
        name=who.name,
        subject=body.subject,
        text=body.text,
        resolved=None,
        resolved_by=None,
        created=now(),
    )
    session.add(comment)
    session.flush()
    record(session, "comment.create", _place(comment), at=comment.created)
    return comment


def _row(session: Session, id: str, number: int, comment: str) -> CommentRow:
    row = session.get(CommentRow, comment)
    if row is None or (row.design_id, row.revision) != (id, number):
        raise NotFound(f"revision {number} of design {id[:80]!r} has no comment {comment[:80]!r}")
    return row


def _place(row: CommentRow) -> str:
    return f"designs/{row.design_id}/revisions/{row.revision}/comments/{row.id}"


def _require_name(row: RevisionRow, subject: str) -> None:
    """Check that a revision has the name that a comment is about; raises InvalidInputs."""
    names = set(_names(row))
    if subject in names:
        return
    near = get_close_matches(subject, names, n=3)
    hint = f"; near it: {', '.join(near)}" if near else ""
    named = plain(subject, 140)
    detail = f"revision {row.number} has no {named!r}: give a parameter, a block or a value of one"
    raise InvalidInputs([Fault("subject", "unknown_name", detail + hint)])


def _names(row: RevisionRow) -> Iterator[str]:
    """Yield the names of a revision's parameters, blocks, values, criteria and variants."""
    document, results = row.document, row.results or {}
    yield from document["parameters"]
    for name, step in document["steps"].items():
        calculated = results.get("steps", {}).get(name, {})
        yield name
        for member in {*step["inputs"], *calculated.get("inputs", {}), *calculated.get("outputs", {})}:
            yield f"{name}.{member}"
    for model in row.models:
        yield model.name
        for member in {*model.parameters, *model.relations, *document["models"][model.name]["parameters"]}:
            yield f"{model.name}.{member}"
    yield from (criterion["name"] for criterion in results.get("criteria", []))
    yield from document.get("variants", {})
