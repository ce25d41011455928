"""The worksheet of a design in its report: each line with formula, value and verdict, and the plots."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from app.designs.schemas.designs import Revision
from app.designs.schemas.worksheets import DesignLine, DesignPlot, PlottedValue
from app.presentation import numbers
from app.presentation.criteria import line
from app.reports.cells import NOTHING, cell, clean
from app.reports.charts import Chart, Series, svg
from app.reports.content import Plot, WorksheetRow
from app.schemas.criteria import Criterion
from templates.core.paper.mathml import mathml


def rows_of(revision: Revision) -> list[WorksheetRow]:
    """Return the lines of the design's worksheet except remarks and plots; empty if it has none."""
    if revision.worksheet is None:
        return []
    judged = {one.name: one for one in revision.criteria or ()}
    lines = (one for one in revision.worksheet.lines if one.kind not in ("remark", "plot"))
    return [_row(one, judged) for one in lines]


def plots_of(revision: Revision) -> list[Plot]:
    """Return the plots of the design's worksheet, and the reason in place of one that cannot be drawn."""
    lines = revision.worksheet.lines if revision.worksheet else ()
    return [
        Plot(clean(_title(one)), drawn(one.plot) if one.plot else "") for one in lines if one.kind == "plot"
    ]


def _title(one: DesignLine) -> str:
    return one.words if one.plot else f"{one.words}: no plot, because {one.reason}"


def _row(one: DesignLine, judged: Mapping[str, Criterion]) -> WorksheetRow:
    words = one.words.lstrip("#> ") if one.kind == "prose" else one.words
    criterion = judged.get(one.name) if one.kind == "check" else None
    verdict = line(criterion) if criterion else None
    return WorksheetRow(
        kind=one.kind,
        is_heading=one.kind == "prose" and one.words.startswith("#"),
        words=clean(words),
        formula=mathml(one.latex) if one.latex else "",
        value=cell(one.value) if one.value else NOTHING,
        verdict=verdict.verdict if verdict else "",
        verdict_words=verdict.verdict_words if verdict else "",
        sentence=clean("; ".join(filter(None, _said(criterion))) if criterion else one.reason or ""),
    )


def comparison(criterion: Criterion) -> str:
    """Return the comparison of a check in one sentence, after the variant in which it is worst."""
    variant = (criterion.where or {}).get("variant")
    said = line(criterion).sentence
    return f"{variant}: {said}" if variant else said


def _said(criterion: Criterion) -> Iterator[str]:
    """Yield the comparison of a check, its margin and its error."""
    verdict = line(criterion)
    yield comparison(criterion)
    yield f"margin {verdict.margin}" if verdict.margin else ""
    yield f"error {verdict.error}" if verdict.error else ""


def drawn(plot: DesignPlot) -> str:
    """Return a plot as SVG; single values of rows are points, lists are lines."""
    x, y = (_numbers(axis) for axis in (plot.x, plot.y))
    if plot.rows:
        order = sorted(range(len(x)), key=lambda place: (x[place] is None, x[place] or 0.0))
        x, y = [x[place] for place in order], [y[place] for place in order]
    series = Series("", x, y, marked=bool(plot.rows))
    return svg(Chart(_label(plot.x), _label(plot.y), [series]))


def _numbers(axis: PlottedValue) -> list[float | None]:
    values = axis.values.value
    assert isinstance(values, list)
    return values


def _label(axis: PlottedValue) -> str:
    unit = numbers.unit(axis.values.unit)
    return f"{axis.words} [{unit}]" if unit else axis.words
