"""The page of a study: its progress, results, charts of its rows, and the chosen row."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from urllib.parse import urlencode

from fastapi import Request, Response
from pydantic import BaseModel

from app.designs.schemas.result_table import ResultColumn, ResultRow, ResultTable
from app.http.pages import Cursor
from app.presentation import numbers
from app.presentation.criteria import line
from app.presentation.result_lines import result_lines
from app.presentation.units import System
from app.reference import Reference
from app.schemas.criteria import Criterion
from app.studies.routes.studies import Fits, Sort, list_rows, list_studies, show_study
from app.studies.schemas import Best, Index, Study, StudyRow
from app.web.shared.responses import show, units_of
from app.web.shared.services import PageServices, Refused

SHOWN = 20  # rows in the table
UNFINISHED = ("queued", "running")


class Rows(BaseModel):
    """The requested rows of a study, as the interface accepts the request."""

    where: Fits = None
    sort: Sort = None
    cursor: Cursor = None


async def study_page(
    request: Request, services: PageServices, id: str, notice: str | None = None
) -> Response:
    """Return the page of a study with the first of its rows."""
    units = units_of(request)
    study = await services.run(show_study, id, services.studies, units)
    design = await services.run(services.designs.show, study.design)
    cursor, sort, where = (request.query_params.get(name, "") for name in ("cursor", "sort", "where"))
    asked = {"where": where, "sort": sort, "cursor": cursor}
    wanted = services.read(Rows, {name: text for name, text in asked.items() if text})
    rows = await services.run(
        list_rows, id, services.studies, None, wanted.where, wanted.sort, SHOWN, wanted.cursor, units
    )
    criteria = await _criteria(services, study, units)
    subjects = {one.name: line(one).subject for one in criteria}
    best = _best(study)
    return show(
        request,
        "study/study.html",
        study=study,
        design=design,
        rows=rows,
        listed=result_lines(_of_rows(study, rows.items, subjects)),
        found=result_lines(_of_best(study, best, subjects)),
        marks={str(row.row): "best" if len(best) == 1 else "front" for row in best},
        links={name: _link(name, sort, where) for name in (*study.varied, *study.outputs)},
        names=[*study.varied, *study.outputs],
        unfinished=study.state in UNFINISHED,
        indices=_indices(study),
        limits=_limits(study, criteria),
        judged={one.name: _words_of(study, _sides(one)[0]) for one in criteria},
        notice=notice,
        sort=sort,
        where=where,
        estimate=study.estimate.seconds,
    )


def _best(study: Study) -> list[Best]:
    """Return the best row, or the rows of the front; empty without an objective."""
    if study.result is None:
        return []
    return [study.result.best] if study.result.best else study.result.front or []


def _of_rows(study: Study, rows: Sequence[StudyRow], subjects: Mapping[str, str]) -> ResultTable:
    """Return the table of some rows: the varied values, then the outputs."""
    names = [*study.varied, *study.outputs]
    shown = [_row(row, [row.values.get(name) for name in names], subjects) for row in rows]
    return ResultTable(columns=_columns(study, names), rows=shown)


def _of_best(study: Study, rows: Sequence[Best], subjects: Mapping[str, str]) -> ResultTable:
    """Return the table of the best row, or of the front: the varied values, then the outputs."""
    names = [*study.varied, *study.outputs]
    values = [{name: one.value for name, one in {**row.at, **row.outputs}.items()} for row in rows]
    shown = [
        _row(row, [own.get(name) for name in names], subjects) for row, own in zip(rows, values, strict=True)
    ]
    return ResultTable(columns=_columns(study, names), rows=shown)


def _columns(study: Study, names: Sequence[str]) -> list[ResultColumn]:
    return [
        ResultColumn(name=name, words=study.words.get(name, name), unit=study.units[name]) for name in names
    ]


def _row(row: StudyRow | Best, values: Sequence[float | None], subjects: Mapping[str, str]) -> ResultRow:
    """Return a row; the criteria that decide its verdict govern it, unless all are met."""
    decisive = [subjects.get(name, name) for name, one in row.verdicts.items() if one == row.verdict != "met"]
    reason = row.reason if isinstance(row, StudyRow) else None
    return ResultRow(
        name=str(row.row),
        values=list(values),
        verdict=row.verdict,
        error_unknown=bool(row.error_unknown),
        criterion_words=", ".join(decisive),
        problem=reason,
    )


def _link(name: str, sort: str, where: str) -> str:
    """Return the address of the rows sorted by a column; in descending order if they are ascending now."""
    way = f"-{name}" if sort == name else name
    return f"?{urlencode({'sort': way, **({'where': where} if where else {})})}"


async def _criteria(services: PageServices, study: Study, units: System) -> list[Criterion]:
    """Return the criteria of a study from its revision; empty if the revision does not store them."""
    if not study.criteria:
        return []
    try:
        sheet = await services.calculate(
            None, services.reports.worksheet, study.design, study.revision, units
        )
    except Refused as refused:
        if refused.status != 404:
            raise
        return []
    return [one for one in sheet.criteria or () if one.name in study.criteria]


def _limits(study: Study, criteria: list[Criterion]) -> dict[str, list[float]]:
    """Return limits of criteria by output, without limits that vary from row to row."""
    limits: dict[str, list[float]] = {}
    for one in criteria:
        if line := _limit_of(study, one):
            limits.setdefault(line[0], []).append(line[1])
    return limits


def _words_of(study: Study, side: str) -> str:
    """Return an output in words, which is not among those of the study; an expression stays as it is."""
    is_name = side.replace(".", "").isidentifier()
    return study.words.get(side) or (side.rpartition(".")[2].replace("_", " ") if is_name else side)


def _sides(one: Criterion) -> tuple[str, str]:
    """Return the output that a criterion judges, prefixed with its step, and the text of the limit."""
    left, _, right = (side.strip() for side in one.require.replace(">=", "<=").partition("<="))
    name = Reference.parse(one.name)
    return f"{name.block}.{left}" if name.output and left.isidentifier() else left, right


def _limit_of(study: Study, one: Criterion) -> tuple[str, float] | None:
    """Return the output that a criterion compares with a literal number, and this number."""
    name, right = _sides(one)
    limit = one.limit.value if one.limit else None
    if name not in study.outputs or not right[:1].isdigit() or not isinstance(limit, float | int):
        return None
    is_same_unit = one.limit is not None and one.limit.unit == study.units[name]
    return (name, float(limit)) if is_same_unit else None


async def studies_of(services: PageServices, design: str) -> list[Study]:
    """Return the newest studies of a design."""
    return (await services.run(list_studies, services.studies, design=design, limit=10)).items


@dataclass(frozen=True)
class IndexLine:
    """The influence of a varied quantity on an output, for the list and the chart."""

    place: str
    cells: list[str]
    value: float
    low: float | None
    high: float | None


@dataclass(frozen=True)
class IndexTable:
    """The sensitivity indices of one output, largest first."""

    output: str
    heads: list[str]
    words: str
    lines: list[IndexLine]

    def parts(self) -> list[dict[str, object]]:
        """Return the bars of the output's tornado chart."""
        return [
            {"name": line.place, "value": line.value}
            | ({} if line.low is None else {"low": line.low, "high": line.high})
            for line in self.lines
        ]


def _indices(study: Study) -> list[IndexTable]:
    indices = (study.result.indices if study.result else None) or {}
    return [_table(output, places) for output, places in indices.items()]


def _table(output: str, places: dict[str, Index]) -> IndexTable:
    lines = [_line(place, index) for place, index in places.items()]
    lines.sort(key=lambda line: -abs(line.value))
    first = next(iter(places.values()), Index())
    if first.total is not None:
        heads, words = ["first order", "total"], "share of the variance, with all interactions"
    elif first.mu_star is not None:
        heads, words = ["mean effect", "scatter"], "mean size of elementary effects"
    else:
        heads, words = ["slope", "elasticity"], "relative change by relative change"
    return IndexTable(output, heads, words, lines)


def _line(place: str, index: Index) -> IndexLine:
    if index.total is not None:
        cells = [_with_error(index.first, index.first_error), _with_error(index.total, index.total_error)]
        spread = index.total_error
        low, high = (None, None) if spread is None else (index.total - spread, index.total + spread)
        return IndexLine(place, cells, index.total, low, high)
    if index.mu_star is not None:
        cells = [numbers.in_line(index.mu_star), numbers.in_line(index.sigma)]
        return IndexLine(place, cells, index.mu_star.value, None, None)
    slope = numbers.in_line(index.slope) if index.slope else "–"
    return IndexLine(place, [slope, _plain(index.elasticity)], index.elasticity or 0.0, None, None)


def _with_error(value: float | None, error: float | None) -> str:
    return _plain(value) + (f" ± {numbers.rough(error)}" if error is not None else "")


def _plain(value: float | None) -> str:
    return "–" if value is None else numbers.plain(float(f"{value:.4g}"))
