"""All SQL for analyses: one row for each computed output."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from typing import cast

from sqlalchemy import Text, select, type_coerce
from sqlalchemy.orm import Session

from app.identity import usage
from app.solids.outputs import Outputs, StoredOutput
from app.solids.questions import Question, in_order, under_load
from app.storage.clock import now
from app.storage.database import Database
from app.storage.errors import NotFound
from app.storage.tables import AnalysisRow
from app.storage.units import upsert
from cad.analysis.kinds import STRESSES, SURFACE
from cad.model import CadModel
from cad.regenerate import build_key


def outputs_of(session: Session, key: str) -> Outputs:
    """Return the stored outputs of an analysis of a build, by output."""
    rows = session.scalars(select(AnalysisRow).where(AnalysisRow.key == key))
    return {row.output: _output(row) for row in rows}


def analysed(database: Database) -> Callable[[CadModel, Question, tuple[str, ...]], Outputs | None]:
    """Return a function that looks up finite-element results of models, if all of them are stored."""

    def stored(shape: CadModel, question: Question, wanted: tuple[str, ...]) -> Outputs | None:
        with database.read() as session:
            outputs = outputs_of(session, question.key(build_key(shape)))
        if not set(wanted) <= outputs.keys():
            return None
        return under_load(question, {name: outputs[name] for name in wanted})

    return stored


def outputs_of_builds(session: Session, builds: Collection[str]) -> Mapping[str, Outputs]:
    """Return the stored outputs of all analyses of some builds, by key of the analysis and output."""
    outputs: dict[str, dict[str, StoredOutput]] = {}
    for row in session.scalars(select(AnalysisRow).where(AnalysisRow.build_key.in_(builds))):
        outputs.setdefault(row.key, {})[row.output] = _output(row)
    return outputs


def stresses(session: Session, build: str, question: Question) -> Outputs:
    """Return the stored stresses of a build, at any level.

    The stress itself determines their meshes.
    """
    rows = session.scalars(
        select(AnalysisRow).where(AnalysisRow.build_key == build, AnalysisRow.output.in_(STRESSES))
    )
    alike = question.whatever_level()
    earlier = [(Question(**row.asked), row) for row in rows]
    return {
        row.output: _output(row)
        for other, row in earlier
        if other.whatever_level() == alike
        and other.key(build) == row.key  # computed by this program's recipe
    }


def asked(session: Session, key: str) -> tuple[str, Question, Outputs]:
    """Return the build, the request, and all stored answers of an analysis.

    Raises
    ------
    NotFound
        If nothing is stored under this key.
    """
    rows = list(session.scalars(select(AnalysisRow).where(AnalysisRow.key == key)))
    if not rows:
        raise NotFound(f"there is no analysis {key[:80]!r}")
    return (rows[0].build_key, *_together(rows))


def key_of_surface(session: Session, sha256: str) -> str | None:
    """Return the analysis whose surface has this hash; the query is rare, so it has no index."""
    named = type_coerce(AnalysisRow.found, Text).contains(f'"sha256":"{sha256}"', autoescape=True)
    return session.scalar(select(AnalysisRow.key).where(AnalysisRow.output == SURFACE, named).limit(1))


def of_build(session: Session, build: str) -> list[tuple[Question, Outputs]]:
    """Return every analysis of a build, by kind, with all stored answers."""
    rows = list(session.scalars(select(AnalysisRow).where(AnalysisRow.build_key == build)))
    grouped: dict[str, list[AnalysisRow]] = {}
    for row in sorted(rows, key=lambda row: (row.asked["kind"], row.key)):
        grouped.setdefault(row.key, []).append(row)
    return [_together(rows) for rows in grouped.values()]


def _together(rows: list[AnalysisRow]) -> tuple[Question, Outputs]:
    """Return a request with its answers from their rows."""
    question = Question(**rows[0].asked)
    outputs = {row.output: _output(row) for row in rows}
    return question, {name: outputs[name] for name in in_order(question.kind, outputs)}


def _output(row: AnalysisRow) -> StoredOutput:
    return cast(StoredOutput, row.found)


def add(session: Session, build: str, question: Question, outputs: Mapping[str, StoredOutput]) -> None:
    """Record outputs; an output that was computed twice is stored once."""
    key = question.key(build)
    for name, output in outputs.items():
        row = AnalysisRow(
            key=key, output=name, build_key=build, asked=question.kept(), found=output, created=now()
        )
        if "size" in output and session.get(AnalysisRow, (key, name)) is None:
            usage.note_bytes(session, output["size"])
        upsert(session, row)
