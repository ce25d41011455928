"""The variants of a design in its report: the governing one first, then inputs, verdicts and solids."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TypeVar

from app.designs.schemas.designs import RevisionStep
from app.designs.schemas.variants import VariantDetail, VariantResult, VariantsOut
from app.designs.variants.names import BASE
from app.presentation import numbers
from app.presentation.criteria import Line, line, tone
from app.presentation.input_text import text_of
from app.presentation.result_lines import result_lines
from app.reports.cells import clean
from app.reports.content import Columns, File, Plot, ReportVerdict, Solid, Variants
from app.reports.typesetting import SKETCH
from app.reports.verdict import row_of

MOST_COLUMNS = 6  # columns of one table on paper, besides the names
SIGNS = {"met": "met", "not_met": "NOT MET", "undecided": "undecided", "not_checked": "not checked"}


def variants_of(
    out: VariantsOut, plots: Sequence[Plot] = (), *, pending: bool, has_appendix: bool
) -> Variants:
    """Return the content of a report of all variants.

    `plots` are those of the governing variant. The appendix has the used share of every limit and the
    solids. The content is `pending` while the service draws the pictures.
    """
    rows = _worst_first(out)
    first = next((row for row in rows if out.governing and row.name == out.governing.variant), None)
    return Variants(
        table=result_lines(out.table),
        governing=clean(out.table.governing),
        judged=_judged(first) if first else None,
        plots=list(plots),
        inputs=[*_parts(_inputs(out, rows), rows)],
        used=[*_parts(_used(rows), rows)] if has_appendix else [],
        solids=_solids(rows, pending=pending) if has_appendix else [],
    )


CalculatedStep = TypeVar("CalculatedStep", bound=RevisionStep)


def of_variant(detail: VariantDetail, step: str, result: CalculatedStep) -> CalculatedStep:
    """Return the results of a step with the inputs and outputs of a variant."""
    inputs = {name: detail.inputs.get(f"{step}.{name}", one) for name, one in result.inputs.items()}
    outputs = {name: detail.outputs.get(f"{step}.{name}", one) for name, one in result.outputs.items()}
    return result.model_copy(update={"inputs": inputs, "outputs": outputs})


def _worst_first(out: VariantsOut) -> list[VariantResult]:
    """Return the variants in their order, with the governing one first."""
    rows = [*([out.base] if out.base else []), *out.rows]
    governs = out.governing.variant if out.governing else ""
    return sorted(rows, key=lambda row: row.name != governs)


def _called(row: VariantResult) -> str:
    return "design itself" if row.name == BASE else row.name


def _judged(row: VariantResult) -> ReportVerdict | None:
    if row.verdict is None:
        return None
    criteria = [row_of(line(one), one) for one in row.criteria]
    return ReportVerdict(row.verdict.headline, tone(row.verdict), _called(row), criteria)


Column = tuple[str, list[str]]  # heading, and a text for each variant


def _inputs(out: VariantsOut, rows: Sequence[VariantResult]) -> list[Column]:
    """Return every value in which variants differ, with the design's own value in brackets."""
    columns = []
    for about in out.columns:
        own = f"({numbers.in_line(about.nominal)})" if about.nominal else ""
        texts = [_input(out, row, about.place) or own for row in rows]
        columns.append((clean(about.words), [clean(text) for text in texts]))
    return columns


def _input(out: VariantsOut, row: VariantResult, place: str) -> str:
    """Return the value that a variant overrides; for a list or a curve, as typed."""
    value = row.values.get(place)
    if value is None:
        return ""
    return text_of(out.variants[row.name][place]) if isinstance(value.value, list) else numbers.in_line(value)


def _used(rows: Sequence[VariantResult]) -> list[Column]:
    """Return the verdict and utilisation of every criterion for each variant."""
    names = dict.fromkeys(one.name for row in rows for one in row.criteria)
    columns = []
    for name in names:
        judged = [next((one for one in row.criteria if one.name == name), None) for row in rows]
        shown = [line(one) if one else None for one in judged]
        title = next(one.subject for one in shown if one)
        columns.append((clean(title), [_share(one) for one in shown]))
    return columns


def _share(shown: Line | None) -> str:
    return f"{SIGNS[shown.verdict]} {shown.used}".strip() if shown else ""


def _parts(columns: Sequence[Column], rows: Sequence[VariantResult]) -> Iterable[Columns]:
    """Yield tables that fit the width of the paper, each with the names of the variants."""
    for start in range(0, len(columns), MOST_COLUMNS):
        part = columns[start : start + MOST_COLUMNS]
        texts = [[_called(row), *(column[1][at] for column in part)] for at, row in enumerate(rows)]
        yield Columns(["Variant", *(heading for heading, _ in part)], texts)


def _solids(rows: Sequence[VariantResult], *, pending: bool) -> list[Solid]:
    """Return every distinct solid once, with the variants that share it."""
    shared: dict[tuple[str, str], list[VariantResult]] = {}
    for row in rows:
        for name, model in row.models.items():
            if model.build:
                shared.setdefault((name, model.build), []).append(row)
    return [_solid(name, build, those, pending) for (name, build), those in shared.items()]


def _solid(name: str, build: str, those: Sequence[VariantResult], pending: bool) -> Solid:
    sha = those[0].models[name].artifacts.get(SKETCH)
    words = f"{name} of {', '.join(_called(row) for row in those)}"
    missing = "its picture was still being made" if pending else "no picture could be made of it"
    file = File(SKETCH, sha) if sha else None
    return Solid(f"{name}-{build[:16]}", clean(words), file, "" if file else missing)
