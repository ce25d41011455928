"""All SQL for the impact of a version; it only reads."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from sqlalchemy import select, tuple_
from sqlalchemy.orm import Session

from app.designs import repository as designs
from app.designs.document import Document
from app.designs.filters import DesignFilter
from app.designs.graph import settled
from app.impact.solids import Solids
from app.impact.task import DesignAt
from app.solids import analysis_rows
from app.solids import rows as builds
from app.storage.tables import RevisionModelRow, RevisionRow, canonical_json

PAGE = 500  # ids of designs read in one query


def ids_of(session: Session, wanted: DesignFilter, chosen: Collection[str] | None) -> list[str]:
    """Return the ids of designs that a filter selects, newest first, optionally among given ids."""
    ids: list[str] = []
    cursor: str | None = None
    while page := designs.designs(session, PAGE, cursor, wanted)[:PAGE]:
        ids += [row.id for row in page if chosen is None or row.id in chosen]
        cursor = page[-1].id
        session.expunge_all()
    return ids


def newest(session: Session, ids: Sequence[str]) -> Iterator[tuple[DesignAt, Document]]:
    """Yield the designs with these ids at their newest revisions, except deleted ones."""
    heads = {row.id: row.head for row in designs.of_ids(session, ids)}
    query = select(RevisionRow.design_id, RevisionRow.number, RevisionRow.document)
    at = tuple_(RevisionRow.design_id, RevisionRow.number).in_(list(heads.items()))
    by_id = {id: (number, plain) for id, number, plain in session.execute(query.where(at))}
    for id in ids:
        if id in by_id:
            number, plain = by_id[id]
            document = Document.model_validate(plain)
            ended = _settled(session, id, number) if document.iterations else ()
            yield DesignAt(id, number, canonical_json(plain), ended), document


def _settled(session: Session, id: str, number: int) -> tuple[tuple[str, float], ...]:
    """Return the final values [SI] of the iterations of a revision."""
    results = designs.revision(session, id, number).results
    return tuple((str(reference), value) for reference, value in settled(results).items())


def solids_of(session: Session, batch: Collection[tuple[DesignAt, Document]]) -> Solids:
    """Return the stored measurements of the solids of some designs and of their variants."""
    with_models = [(design.id, design.revision) for design, document in batch if document.models]
    at = tuple_(RevisionModelRow.design_id, RevisionModelRow.number).in_(with_models)
    keys = {key for key in session.scalars(select(RevisionModelRow.build_key).where(at)) if key}
    measured = {key: row.measurements["measures"] for key, row in builds.builds(session, keys).items()}
    analysed = any(model.analyses for _, document in batch for model in document.models.values())
    return Solids(measured, analysis_rows.outputs_of_builds(session, keys) if analysed else {})
