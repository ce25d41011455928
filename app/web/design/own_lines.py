"""The worksheet of a design on its page: the text, and each line with its value or verdict."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from app.designs.document import WORKSHEET
from app.designs.schemas.designs import Design, Revision
from app.designs.schemas.worksheets import DesignLine
from app.reports.content import Plot
from app.reports.worksheet import comparison, plots_of
from app.schemas.criteria import Criterion
from app.web.shared.blocks import Refusal
from app.web.worksheet.page import Row
from app.worksheets.schemas.worksheets import SheetLine
from templates.core.sheets.design_lines import NOT_IN_DESIGNS


@dataclass(frozen=True)
class OwnLines:
    """The lines of a design: the text as saved or as sent, its faults, and the lines with their values."""

    text: str
    faults: list[str]
    rows: list[Row]
    plots: list[Plot]
    refused: tuple[str, ...] = NOT_IN_DESIGNS  # statements that completion does not offer


def own_lines(design: Design, revision: Revision, refusal: Refusal) -> OwnLines:
    """Return the lines of a design for its page."""
    faults = [detail for name, detail in refusal.faults.items() if name.partition(".")[0] == WORKSHEET]
    text = refusal.typed.get(WORKSHEET, design.worksheet)
    return OwnLines(text, faults, rows_of(revision), plots_of(revision))


def rows_of(revision: Revision) -> list[Row]:
    """Return the lines of a revision, typeset with their values; empty if it has none."""
    return list(_rows(revision))


def _rows(revision: Revision) -> Iterator[Row]:
    judged = {one.name: one for one in revision.criteria or ()}
    for one in revision.worksheet.lines if revision.worksheet else ():
        if one.kind != "plot":
            yield Row(_shown(one, judged.get(one.name)), [], None, _message(one, judged.get(one.name)))


def _message(one: DesignLine, criterion: Criterion | None) -> str | None:
    return comparison(criterion) if criterion else one.reason


def _shown(one: DesignLine, criterion: Criterion | None) -> SheetLine:
    value = one.value
    return SheetLine(
        line=one.line,
        last_line=one.last_line,
        kind=one.kind,
        name=one.name,
        words=one.words,
        mathml=one.mathml,
        html=one.html,
        value=value.value if value else None,
        unit=value.unit if value else None,
        text=None,
        verdict=criterion.verdict if criterion else None,
        message=None,
    )
