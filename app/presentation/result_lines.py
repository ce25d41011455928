"""The table of results in texts, for pages and reports: heads with units, a line for each row."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from app.presentation import numbers
from app.presentation.criteria import UNKNOWN, WORDS

NO_VALUE = "–"
DESIGN_ITSELF = "design itself"
BASE = "base"


class Column(Protocol):
    """A column of the table of results; see `app/designs/schemas/result_table.py`."""

    @property
    def words(self) -> str: ...  # noqa: D102 - the schema describes every field
    @property
    def name(self) -> str: ...  # noqa: D102
    @property
    def unit(self) -> str | None: ...  # noqa: D102


class Row(Protocol):
    """A row of the table of results."""

    @property
    def name(self) -> str: ...  # noqa: D102 - the schema describes every field
    @property
    def values(self) -> Sequence[float | str | bool | None]: ...  # noqa: D102
    @property
    def reasons(self) -> dict[str, str]: ...  # noqa: D102
    @property
    def changes(self) -> Sequence[float | None]: ...  # noqa: D102
    @property
    def verdict(self) -> str | None: ...  # noqa: D102
    @property
    def error_unknown(self) -> bool: ...  # noqa: D102
    @property
    def criterion_words(self) -> str: ...  # noqa: D102
    @property
    def utilisation(self) -> float | None: ...  # noqa: D102
    @property
    def governs(self) -> bool: ...  # noqa: D102
    @property
    def problem(self) -> str | None: ...  # noqa: D102


class Table(Protocol):
    """The table of results."""

    @property
    def columns(self) -> Sequence[Column]: ...  # noqa: D102 - the schema describes every field
    @property
    def rows(self) -> Sequence[Row]: ...  # noqa: D102
    @property
    def governing(self) -> str: ...  # noqa: D102


@dataclass(frozen=True)
class ResultHead:
    """The heading of a column, its printed unit, and the name of the value in relations."""

    words: str
    unit: str
    name: str


@dataclass(frozen=True)
class ResultCell:
    """A value with five digits, its change from the first row, and why it is missing."""

    text: str
    value: float | None = None
    change: str = ""
    reason: str = ""


@dataclass(frozen=True)
class ResultLine:
    """A row of the table."""

    name: str
    title: str
    cells: list[ResultCell]
    criterion: str
    used: str
    share: float | None
    verdict: str  # met, not_met, undecided, not_checked; empty without criteria
    tag: str
    verdict_words: str
    governs: bool
    problem: str


@dataclass(frozen=True)
class ResultLines:
    """The table of results."""

    heads: list[ResultHead]
    lines: list[ResultLine]
    governing: str
    is_judged: bool  # whether any row has a verdict


def result_lines(table: Table) -> ResultLines:
    """Return the table of results in texts."""
    heads = [ResultHead(one.words, numbers.unit(one.unit), one.name) for one in table.columns]
    lines = [_line(row, heads) for row in table.rows]
    return ResultLines(heads, lines, table.governing, any(line.verdict for line in lines))


def _line(row: Row, heads: Sequence[ResultHead]) -> ResultLine:
    changes = row.changes or [None] * len(heads)
    cells = [
        _cell(value, change, row.reasons.get(head.name, ""))
        for value, change, head in zip(row.values, changes, heads, strict=True)
    ]
    verdict = row.verdict or ""
    is_unknown = row.error_unknown and verdict in ("met", "not_met")
    return ResultLine(
        name=row.name,
        title=DESIGN_ITSELF if row.name == BASE else row.name,
        cells=cells,
        criterion=row.criterion_words,
        used="" if row.utilisation is None else numbers.share(row.utilisation),
        share=row.utilisation,
        verdict=verdict,
        tag=f"{verdict} error-unknown" if is_unknown else verdict,
        verdict_words=f"{WORDS.get(verdict, '')}; {UNKNOWN}" if is_unknown else WORDS.get(verdict, ""),
        governs=row.governs,
        problem=row.problem or "",
    )


def _cell(value: float | str | bool | None, change: float | None, reason: str) -> ResultCell:
    if value is None:
        return ResultCell(NO_VALUE, reason=reason)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return ResultCell(str(value))
    return ResultCell(numbers.plain(float(value)), float(value), change_text(change))


def change_text(change: float | None) -> str:
    """Return a relative change in per cent with its sign: `+6.0 %`; empty without a change."""
    if change is None:
        return ""
    text = f"{100 * change:+.1f} %"
    return "0.0 %" if text in ("+0.0 %", "-0.0 %") else text.replace("-", "−")
