"""The table of results of a design and its variants, as pages, reports, files and the client show it.

`table` makes it for one revision, `compared` for two revisions.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain

from app.designs.network import Graph
from app.designs.result_cells import Cells, TableCell, columns_of
from app.designs.schemas.result_table import Number, ResultColumn, ResultRow, ResultTable
from app.designs.schemas.variants import GoverningVariant, VariantResult
from app.designs.variants.names import BASE
from app.presentation.criteria import line, plain_name
from app.reference import ItemReference, Reference
from app.schemas.criteria import Criterion
from templates.core.errors import listed

MOST_DEFAULT = 12
NOTHING: TableCell = {"value": None}
EQUAL = 0.005  # relative difference below which two used shares count as equal


def table(
    rows: Sequence[VariantResult],
    stored: Mapping[str, Cells],
    graph: Graph,
    governing: GoverningVariant | None,
    *,
    with_changes: bool,
) -> ResultTable:
    """Return the table of a revision.

    Parameters
    ----------
    rows
        The judged rows, in the order of the table.
    stored
        The cells of each row, as the revision stores them.
    graph
        The network of the design. If it chooses no columns, the overridden values are left out, and blocks
        whose results are equal in all rows.
    governing
        The worst row and its criterion.
    with_changes
        Whether each row states its change from the first row.
    """
    present = frozenset(chain.from_iterable(stored.get(row.name, {}) for row in rows))
    names = [name for name in map(str, columns_of(graph)) if name in present]
    if not graph.columns:
        varied = frozenset(chain.from_iterable(row.values for row in rows))
        differing = _different(names, [stored.get(row.name, {}) for row in rows])
        names = [name for name in differing if name not in varied][:MOST_DEFAULT]
    firsts = {row.name: rows[0].name for row in rows} if with_changes else {}
    return _assembled(rows, stored, headings(names, graph), governing, firsts)


def compared(
    rows: Sequence[VariantResult],
    stored: Mapping[str, Cells],
    graphs: Sequence[Graph],
    governing: GoverningVariant | None,
    firsts: Mapping[str, str],
) -> ResultTable:
    """Return the table of two revisions: the columns of both, without blocks whose results are equal.

    Parameters
    ----------
    rows, stored, governing
        As for `table`; the names of the rows differ between the revisions.
    graphs
        The networks of the revisions; the first decides the order and the headings.
    firsts
        For a row, the row from which it states its change.
    """
    words: dict[str, str] = {}
    for graph in graphs:
        words = {**headings(map(str, columns_of(graph)), graph), **words}
    names = [str(name) for name in dict.fromkeys(chain.from_iterable(map(columns_of, graphs)))]
    differing = _different(names, [stored.get(row.name, {}) for row in rows])[:MOST_DEFAULT]
    return _assembled(rows, stored, {name: words[name] for name in differing}, governing, firsts)


def _assembled(
    rows: Sequence[VariantResult],
    stored: Mapping[str, Cells],
    words: Mapping[str, str],
    governing: GoverningVariant | None,
    firsts: Mapping[str, str],
) -> ResultTable:
    columns = [_column(name, text, _unit(name, stored.values())) for name, text in words.items()]
    shown = {row.name: _row(row, stored.get(row.name, {}), list(words)) for row in rows}
    changes = {name: _changes(shown[first], shown[name]) for name, first in firsts.items()}
    worst = _worst(rows, governing)
    marked = [
        row.model_copy(
            update={
                **({"changes": changes[row.name]} if row.name in changes else {}),
                **({"governs": True} if row.name in worst else {}),
            }
        )
        for row in shown.values()
    ]
    return ResultTable(columns=columns, rows=marked, governing=_sentence(rows, worst, governing))


def _column(name: str, words: str, unit: str | None) -> ResultColumn:
    return ResultColumn(name=name, words=words, **({"unit": unit} if unit else {}))


def _unit(name: str, rows: Iterable[Cells]) -> str | None:
    units = (cells.get(name, NOTHING).get("unit") for cells in rows)
    return next((unit for unit in units if unit), None)


def _different(names: Sequence[str], rows: Sequence[Cells]) -> list[str]:
    """Return the columns of all blocks of which at least one column differs between rows."""
    if len(rows) < 2:
        return list(names)
    differing = {
        Reference.parse(name).block
        for name in names
        if len({repr(cells.get(name, NOTHING).get("value")) for cells in rows}) > 1
    }
    return [name for name in names if Reference.parse(name).block in differing]


def _row(row: VariantResult, stored: Cells, names: Sequence[str]) -> ResultRow:
    values: list[Number] = [stored[name]["value"] if name in stored else None for name in names]
    reasons = {name: reason for name in names if (reason := stored.get(name, NOTHING).get("reason"))}
    criterion = governing_criterion(row)
    parts: dict[str, object] = {
        "reasons": reasons,
        "verdict": row.verdict.verdict if row.verdict else None,
        "criterion": criterion.name if criterion else None,
        "criterion_words": line(criterion).subject if criterion else "",
        "utilisation": criterion.utilisation if criterion else None,
        "error_unknown": bool(criterion and line(criterion).is_error_unknown),
        "problem": row.problem.detail if row.problem else None,
    }
    present = {name: part for name, part in parts.items() if part}
    return ResultRow.model_validate({"name": row.name, "values": values, **present})


def governing_criterion(row: VariantResult) -> Criterion | None:
    """Return the criterion that governs a row; None if none was checked."""
    name = row.verdict.governing if row.verdict else None
    return next((one for one in row.criteria if one.name == name), None)


def _changes(first: ResultRow, row: ResultRow) -> list[float | None]:
    return [_change(base, value) for base, value in zip(first.values, row.values, strict=True)]


def _change(base: Number, value: Number) -> float | None:
    """Return the relative change of a number; None without both numbers, or from zero."""
    if not (isinstance(base, float) and isinstance(value, float)) or base == 0:
        return None
    return value / base - 1


def _worst(rows: Sequence[VariantResult], governing: GoverningVariant | None) -> list[str]:
    """Return the rows that govern: the worst one, and those for which the same criterion is equally bad."""
    if governing is None:
        return []
    judged = {row.name: one for row in rows for one in row.criteria if one.name == governing.criterion}
    worst = judged[governing.variant]
    return [name for name, one in judged.items() if _is_equal(one, worst)]


def _is_equal(one: Criterion, worst: Criterion) -> bool:
    used, most = one.utilisation, worst.utilisation
    if one.verdict != worst.verdict or used is None or most is None:
        return one is worst
    return math.isclose(used, most, rel_tol=EQUAL)


def _sentence(rows: Sequence[VariantResult], worst: Sequence[str], governing: GoverningVariant | None) -> str:
    """Return a sentence that names the rows that govern, their criterion and its numbers."""
    if governing is None:
        return ""
    row = next(row for row in rows if row.name == governing.variant)
    about = line(next(one for one in row.criteria if one.name == governing.criterion))
    names = ["the design itself" if name == BASE else name for name in worst]
    verb = "governs" if len(names) == 1 else f"govern ({len(names)} equal within {100 * EQUAL:g} %)"
    place = f"{about.place}: " if about.place else ""
    used = f", {about.used} of the limit used" if about.used else ""
    return f"{listed(names)} {verb}; {place}{about.sentence}{used}"


def headings(names: Iterable[str], graph: Graph) -> dict[str, str]:
    """Return the heading of each column; with its step or model if another column has the same words."""
    words = {name: _words(ItemReference.parse(name), graph) for name in names}
    counts = Counter(words.values())
    return {
        name: f"{plain_name(Reference.parse(name).block)}: {text}" if counts[text] > 1 else text
        for name, text in words.items()
    }


def _words(column: ItemReference, graph: Graph) -> str:
    words = _words_of(column.reference, graph)
    return f"{words} [{column.item}]" if column.item else words


def _words_of(reference: Reference, graph: Graph) -> str:
    block = graph.blocks.get(reference.block)
    if block is not None and reference.analysis is None:
        declared = block.cls.inputs.get(reference.member) or block.cls.formulas.get(reference.member)
        if declared is not None:
            return declared.meaning.words
        return f"{reference.own_name} of {reference.block}".replace("_", " ")
    return reference.own_name.replace("_", " ")
