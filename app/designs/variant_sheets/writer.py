"""The table of variants as rows of a sheet: inputs, which are read back, then results, which are not."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from app.designs.schemas.variants import VariantColumn, VariantResult, VariantsOut
from app.designs.variant_sheets.reader import FIRST, RELATION, RESULTS
from app.designs.variant_sheets.values import Shape, shape
from app.designs.variant_sheets.xlsx_files import number_text
from app.presentation.criteria import WORDS
from app.presentation.input_text import text_of
from app.presentation.spreadsheets import Value
from app.schemas.criteria import Criterion

DIGITS = 4  # decimals of a utilisation
UNIT = "unit"


@dataclass(frozen=True)
class SheetColumn:
    """Heading and unit of a column, and its cell for every variant."""

    heading: str
    unit: str
    cells: Sequence[Value]
    is_result: bool = False


def sheet_columns(out: VariantsOut) -> list[SheetColumn]:
    """Return the columns of a table of variants: names, overrides, results."""
    names = list(out.variants)
    inputs = [column for about in out.columns for column in _of_place(out, about)]
    return [SheetColumn(FIRST, UNIT, names), *inputs, *_results(out, names)]


def rows_of(columns: Sequence[SheetColumn]) -> list[list[Value]]:
    """Return the rows of a sheet: headings, units, then one row for each variant."""
    head: list[list[Value]] = [[column.heading for column in columns], [column.unit for column in columns]]
    return head + [list(cells) for cells in zip(*(column.cells for column in columns), strict=True)]


def _of_place(out: VariantsOut, about: VariantColumn) -> Iterable[SheetColumn]:
    """Yield a column for the values of a place, and a second column if it has relations."""
    raws = [overrides.get(about.place) for overrides in out.variants.values()]
    shapes = [None if raw is None else shape(raw) for raw in raws]
    if any(one and not one.is_relation for one in shapes):
        unit = _unit(shapes, about)
        cells = [_cell(one, raw, unit) for one, raw in zip(shapes, raws, strict=True)]
        yield SheetColumn(about.place, unit, cells)
    if any(one and one.is_relation for one in shapes):
        relations = [one.value if one and one.is_relation else None for one in shapes]
        yield SheetColumn(f"{about.place} {RELATION}", "", relations)


def page_columns(out: VariantsOut) -> list[SheetColumn]:
    """Return the columns of inputs for a web page: texts, relations with `=`, one column for each place."""
    names = list(out.variants)
    return [SheetColumn(FIRST, UNIT, names), *(_on_page(out, about) for about in out.columns)]


def _on_page(out: VariantsOut, about: VariantColumn) -> SheetColumn:
    raws = [overrides.get(about.place) for overrides in out.variants.values()]
    shapes = [None if raw is None else shape(raw) for raw in raws]
    unit = _unit(shapes, about) or about.unit or ""
    return SheetColumn(
        about.place, unit, [_text(one, raw, unit) for one, raw in zip(shapes, raws, strict=True)]
    )


def _text(one: Shape | None, raw: object, unit: str) -> str:
    if one is None:
        return ""
    if one.is_relation:
        return f"= {one.value}"
    cell = _cell(one, raw, unit)
    return number_text(cell) if isinstance(cell, (int, float)) else str(cell)


def _unit(shapes: Sequence[Shape | None], about: VariantColumn) -> str:
    """Return the unit that most of the numbers have; empty for a choice."""
    units = Counter(one.unit for one in shapes if one and one.unit)
    most = max(units, key=lambda unit: units[unit], default="")
    return "" if about.unit is None and most == "1" else most


def _cell(one: Shape | None, raw: object, unit: str) -> Value:
    """Return a number in the unit of its column, or any other value with its own unit."""
    if one is None or one.is_relation:
        return None
    is_plain = one.unit == unit or (one.unit == "1" and not unit)
    return one.value if one.unit and is_plain else text_of(raw)


def _results(out: VariantsOut, names: Sequence[str]) -> Iterable[SheetColumn]:
    """Yield the columns of the table of results, then the verdict on each criterion."""
    rows, shown = {row.name: row for row in out.rows}, {row.name: row for row in out.table.rows}
    results = [rows.get(name) for name in names]
    listed = [shown.get(name) for name in names]
    if any(row and row.problem for row in listed):
        yield _result("problem", "", [row.problem if row else None for row in listed])
    for at, column in enumerate(out.table.columns):
        yield _result(column.words, column.unit or "", [row.values[at] if row else None for row in listed])
        if any(row and row.changes for row in listed):
            changes = [row.changes[at] if row else None for row in listed]
            yield _result(f"{column.words} change", "%", [_percent(change) for change in changes])
    if not any(row and row.verdict for row in listed):
        return
    yield _result("governing", "", [row.criterion_words if row else None for row in listed])
    yield _result("used", "1", [_rounded(row.utilisation if row else None) for row in listed])
    yield _result("verdict", "", [one.verdict.headline if one and one.verdict else None for one in results])
    for name in dict.fromkeys(one.name for row in results if row for one in row.criteria):
        yield from _of_criterion(name, results)


def _percent(change: float | None) -> float | None:
    return None if change is None else round(100 * change, DIGITS)


def _rounded(used: float | None) -> float | None:
    return None if used is None else round(used, DIGITS)


def _of_criterion(name: str, results: Sequence[VariantResult | None]) -> Iterable[SheetColumn]:
    judged = [_criterion(row, name) for row in results]
    yield _result(name, "", [WORDS[one.verdict] if one else None for one in judged])
    if any(one and one.utilisation is not None for one in judged):
        used = [_rounded(one.utilisation if one else None) for one in judged]
        yield _result(f"{name} used", "1", used)


def _criterion(row: VariantResult | None, name: str) -> Criterion | None:
    return next((one for one in row.criteria if one.name == name), None) if row else None


def _result(heading: str, unit: str, cells: Sequence[Value]) -> SheetColumn:
    return SheetColumn(f"{RESULTS} {heading}", unit, cells, is_result=True)
