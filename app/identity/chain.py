"""The hash chain of the audit: each sealed row has the next number and the hash of the previous row.

A hash is the SHA-256 of a row's content, its number and the previous hash, as canonical JSON. Anyone who
changes, removes or inserts a row must rewrite all later rows, whose hashes then differ from an exported hash.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from sqlalchemy import BigInteger, Select, bindparam, cast, func, select, update
from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import Session

from app.storage.errors import DatabaseDamaged
from app.storage.tables import AuditRow, Base, canonical_json
from app.storage.units import Statement, Values

AT_ONCE = 1000  # rows read in one query
SOME = 100  # rows sealed in one transaction, which delays other writes by a few milliseconds
NO_NUMBER = 2**62  # larger than any sealed number; an invalid number from here on does not stop the sealing
_SAID = ("id", "at", "principal", "name", "action", "object", "digest")
_TEXTS = (*_SAID, "previous", "hash")
_DAMAGED = (DBAPIError, DatabaseDamaged)  # raised when SQLite reads a damaged text
_ROWS = Base.metadata.tables[AuditRow.__tablename__]
_UNSEALED = Statement(
    select(*(_ROWS.c[name] for name in _TEXTS))
    .where(_ROWS.c.seq.is_(None))
    .order_by(_ROWS.c.id)
    .limit(bindparam("most")),
    "most",
)
_SEALED = Statement(
    update(_ROWS)
    .where(_ROWS.c.id == bindparam("row"))
    .values(seq=bindparam("number"), previous=bindparam("before"), hash=bindparam("own")),
    "row",
    "number",
    "before",
    "own",
)


@dataclass(frozen=True)
class Link:
    """The number and the hash of the last row of a chain, or of a part of it."""

    seq: int
    hash: str | None


START = Link(0, None)
"""The link before the first row."""


@dataclass(frozen=True)
class ChainCheck:
    """The result of verifying the chain."""

    head: Link  # the last sound row
    unsealed: int  # rows that have not been sealed yet
    fault: str = ""  # fault of the first broken row, or of the exported hash


def hash_of(row: AuditRow, seq: int, previous: str | None) -> str:
    """Return the hash of a row, given its number and the previous hash."""
    return _hash(_said(row), seq, previous)


def _said(row: AuditRow) -> dict[str, object]:
    """Return the content of a row by column."""
    return {name: getattr(row, name) for name in _SAID}


def _hash(row: Mapping[str, object], seq: int, previous: str | None) -> str:
    said = {name: row[name] for name in _SAID} | {"seq": seq, "previous": previous}
    return hashlib.sha256(canonical_json(said).encode()).hexdigest()


def head(session: Session) -> Link:
    """Return the newest sealed row, ignoring rows with an invalid number."""
    is_number = cast(AuditRow.seq, BigInteger) == AuditRow.seq  # SQLite would store even 2.5 or 'x'
    numbered = select(AuditRow.seq).where(AuditRow.seq < NO_NUMBER, is_number)
    seq = session.scalar(numbered.order_by(AuditRow.seq.desc()).limit(1))
    if seq is None:
        return START
    try:
        hash = session.scalar(select(AuditRow.hash).where(AuditRow.seq == seq))
    except _DAMAGED:
        hash = None
    return Link(seq, hash if isinstance(hash, str) else None)


def verify(session: Session, exported: str | None = None) -> ChainCheck:
    """Verify the chain up to its first broken row, or to its end.

    Parameters
    ----------
    session
        A snapshot of the database.
    exported
        A hash that was recorded earlier and must match a row, because a chain that was truncated or
        completely rewritten is consistent in itself.
    """
    unsealed = session.scalar(select(func.count()).where(AuditRow.seq.is_(None))) or 0
    last, met = START, exported is None
    try:
        for row in _sealed(session):
            if fault := _fault(row, last):
                return ChainCheck(last, unsealed, fault)
            last = Link(last.seq + 1, row.hash)
            met = met or row.hash == exported
    except _DAMAGED:
        return ChainCheck(last, unsealed, f"row {last.seq + 1} was changed: one of its values is not text")
    if len(waiting(session)) < min(unsealed, SOME):
        return ChainCheck(
            last, unsealed, f"an unsealed row after row {last.seq} has a value that is not text"
        )
    cut = f"no row has the hash {exported}: rows were cut off at the end, or all of them written again"
    return ChainCheck(last, unsealed, "" if met else cut)


def _sealed(session: Session) -> Iterator[AuditRow]:
    """Yield the sealed rows in order, read one page at a time."""
    last = -(2**63)
    while True:
        query = select(AuditRow).where(AuditRow.seq > last).order_by(AuditRow.seq).limit(AT_ONCE)
        try:
            page = list(session.scalars(query))
        except _DAMAGED:  # one value is not text: return the rows before it one by one
            page = list(session.scalars(query.limit(1)))
        if not page:
            return
        yield from page
        if not isinstance(place := page[-1].seq, int):
            return
        last = place
        session.expunge_all()


def _fault(row: AuditRow, last: Link) -> str:
    """Return the fault of a row that follows a sound row; empty if the row is sound."""
    seq, name = row.seq, f"row {row.seq} ({row.action} of {row.object} by {row.name}, {row.at})"
    if not isinstance(seq, int):
        return f"{name} was changed: its number is not an integer"
    if not _is_text(row):
        return f"{name} was changed: one of its values is not text"
    if seq > last.seq + 1:
        return f"row {last.seq + 1} is missing: after row {last.seq} comes {name}"
    if seq <= last.seq or row.hash is None:
        return f"{name} was inserted: the sealer would not have numbered it like this"
    if row.hash != hash_of(row, seq, row.previous):
        return f"{name} was changed: its content does not match its hash"
    if row.previous != last.hash:
        return (
            f"{name} was inserted, or row {last.seq} was replaced: it does not contain the hash of that row"
        )
    return ""


def _is_text(row: AuditRow) -> bool:
    return all(isinstance(getattr(row, column), str | None) for column in _TEXTS)


def waiting(session: Session) -> list[AuditRow]:
    """Return the oldest unsealed rows, except rows with values that are not text, which `verify` reports."""
    query = select(AuditRow).where(AuditRow.seq.is_(None)).order_by(AuditRow.id).limit(SOME)
    try:
        rows = list(session.scalars(query))
    except _DAMAGED:
        rows = [row for place in range(SOME) for row in _readable(session, query.offset(place).limit(1))]
    return [row for row in rows if _is_text(row)]


def _readable(session: Session, query: Select[AuditRow]) -> list[AuditRow]:
    try:
        return list(session.scalars(query))
    except _DAMAGED:
        return []


def _unsealed(session: Session) -> list[dict[str, object]]:
    """Return the contents of the rows for `waiting`; the ORM reads them only if a row is damaged."""
    session.flush()
    try:
        rows = _UNSEALED.run(session, {"most": SOME})
    except _DAMAGED:
        return [_said(row) for row in waiting(session)]
    texts = (row for row in rows if all(isinstance(value, str | None) for value in row))
    return [dict(zip(_TEXTS, row, strict=True)) for row in texts]


def seal(session: Session) -> int:
    """Number and chain waiting rows in a unit of work; return how many were sealed."""
    last, sealed = head(session), list[Values]()
    for row in _unsealed(session):
        before, last = last, Link(last.seq + 1, _hash(row, last.seq + 1, last.hash))
        sealed.append({"row": row["id"], "number": last.seq, "before": before.hash, "own": last.hash})
    if sealed:
        _SEALED.run_many(session, sealed)
    return len(sealed)
