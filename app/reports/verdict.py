"""The verdict at the head of a report: every criterion as judged, worst first."""

from __future__ import annotations

from app.designs.schemas.designs import RevisionWorksheet
from app.presentation.criteria import Line, headline_of, line, tone
from app.reports.cells import clean
from app.reports.content import Criterion, ReportVerdict
from app.schemas import criteria as schemas
from templates.core.criteria.judgement import is_model


def judged(revision: RevisionWorksheet) -> ReportVerdict:
    """Return the verdict of a revision, or the reason why there is none."""
    verdict = revision.verdict
    if verdict is None or not revision.criteria:
        return ReportVerdict(
            headline_of(revision.state, is_judged=revision.criteria is not None), "plain", "", []
        )
    lines = [line(criterion) for criterion in revision.criteria]
    governing = next((one for one in lines if one.name == verdict.governing), None)
    rows = [row_of(one, judged) for one, judged in zip(lines, revision.criteria, strict=True)]
    return ReportVerdict(verdict.headline, tone(verdict), _governing(governing), rows)


def _governing(first: Line | None) -> str:
    """Return one sentence about the criterion that governs; empty if there is none."""
    return governing_sentence(first) if first else ""


def governing_sentence(first: Line) -> str:
    """Return one sentence about a criterion that governs."""
    used = f"{first.used} of the limit used" if first.used else ""
    margin = f"margin {first.margin}" if first.margin else ""
    error = f"error {first.error}" if first.error else ""
    said = ", ".join(filter(None, (used, margin, error)))
    place = f"{first.place}: " if first.place else ""
    return clean(f"governing: {place}{first.sentence}{f' ({said})' if said else ''}")


def row_of(one: Line, criterion: schemas.Criterion) -> Criterion:
    """Return a criterion as a row of the report."""
    truth = None if is_model(criterion.truth) else criterion.truth  # a remark names the model instead
    basis = ", ".join(filter(None, (criterion.level and f"level {criterion.level}", truth)))
    remarks = [one.missing, *one.remarks, basis and f"calculated: {basis}"]
    return Criterion(
        words=clean(one.subject),
        verdict=one.verdict,
        verdict_words=one.verdict_words,
        sentence=clean(one.sentence),
        used=one.used,
        margin=one.margin,
        error=one.error,
        source=clean(criterion.source or ""),
        remarks=[clean(remark) for remark in remarks if remark],
    )
