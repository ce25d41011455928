"""All SQL of analyses: one row for each output that was found."""

from __future__ import annotations

from collections.abc import Mapping

from sqlalchemy import Text, select, type_coerce
from sqlalchemy.orm import Session

from app.plain import JsonObject
from app.solids.questions import Question, in_order
from app.storage.errors import NotFound
from app.storage.identity import now
from app.storage.tables import AnalysisRow
from cad.analysis.kinds import STRESSES, SURFACE

Found = dict[str, JsonObject]


def found(session: Session, key: str) -> Found:
    """What is known to a question about a build, by output."""
    rows = session.scalars(select(AnalysisRow).where(AnalysisRow.key == key))
    return {row.output: row.found for row in rows}


def stresses(session: Session, build: str, question: Question) -> Found:
    """What is known of stress in a build, whatever level was asked for: its meshes follow from the stress."""
    rows = session.scalars(
        select(AnalysisRow).where(AnalysisRow.build_key == build, AnalysisRow.output.in_(STRESSES))
    )
    alike = question.whatever_level()
    earlier = [(Question(**row.asked), row) for row in rows]
    return {
        row.output: row.found
        for other, row in earlier
        if other.whatever_level() == alike and other.key(build) == row.key  # found by this program's recipe
    }


def asked(session: Session, key: str) -> tuple[str, Question, Found]:
    """The build, the question, and all that is known to it.

    Raises
    ------
    NotFound
        If nothing was found under this key.
    """
    rows = list(session.scalars(select(AnalysisRow).where(AnalysisRow.key == key)))
    if not rows:
        raise NotFound(f"there is no analysis {key[:80]!r}")
    return (rows[0].build_key, *_together(rows))


def key_of_surface(session: Session, sha256: str) -> str | None:
    """The analysis whose surface has this hash; rare, so no index serves it."""
    named = type_coerce(AnalysisRow.found, Text).contains(f'"sha256":"{sha256}"', autoescape=True)
    return session.scalar(select(AnalysisRow.key).where(AnalysisRow.output == SURFACE, named).limit(1))


def of_build(session: Session, build: str) -> list[tuple[Question, Found]]:
    """Every question that was asked about a build, by kind, with all that is known to it."""
    rows = list(session.scalars(select(AnalysisRow).where(AnalysisRow.build_key == build)))
    told: dict[str, list[AnalysisRow]] = {}
    for row in sorted(rows, key=lambda row: (row.asked["kind"], row.key)):
        told.setdefault(row.key, []).append(row)
    return [_together(rows) for rows in told.values()]


def _together(rows: list[AnalysisRow]) -> tuple[Question, Found]:
    """A question from the rows of its answers."""
    question = Question(**rows[0].asked)
    known = {row.output: row.found for row in rows}
    return question, {name: known[name] for name in in_order(question.kind, known)}


def add(session: Session, build: str, question: Question, known: Mapping[str, JsonObject]) -> None:
    """Record what was found; the same found twice is one."""
    key = question.key(build)
    for output, told in known.items():
        row = AnalysisRow(
            key=key, output=output, build_key=build, asked=question.kept(), found=told, created=now()
        )
        session.merge(row)
    session.flush()
