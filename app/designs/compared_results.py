"""The table of results of two revisions: each variant of the older one above that of the newer one."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from sqlalchemy.orm import Session

from app.catalogue.catalogues import Catalogues
from app.designs.document import Document
from app.designs.graph import Graph, build_graph
from app.designs.result_cells import Cells, TableCell
from app.designs.result_table import compared
from app.designs.results import TABLE
from app.designs.schemas.result_table import ResultTable
from app.designs.schemas.variants import GoverningVariant, VariantResult
from app.designs.variants.names import BASE
from app.designs.variants.views import rows_of
from app.storage.tables import RevisionRow
from templates.core.criteria.comparison import WORST_FIRST
from templates.core.units.units import unit


@dataclass(frozen=True)
class _Side:
    """One of the two revisions, with its rows by variant."""

    title: str
    rows: Mapping[str, VariantResult]
    cells: Mapping[str, Cells]
    graph: Graph
    governing: GoverningVariant | None


def compared_results(
    session: Session, old: RevisionRow, new: RevisionRow, catalogues: Catalogues
) -> ResultTable:
    """Return the table of two revisions; a row of the newer one states its change from the older one."""
    titles = _titles(old, new)
    rows = dict(zip(titles, (old, new), strict=True))
    sides = [_side(session, row, title, catalogues) for title, row in rows.items()]
    variants = list(dict.fromkeys(name for side in reversed(sides) for name in side.rows))
    names = {(side.title, one): _name(side.title, one, variants) for side in sides for one in side.rows}
    shown = [
        side.rows[one].model_copy(update={"name": names[side.title, one]})
        for one in variants
        for side in sides
        if one in side.rows
    ]
    units = _units(sides)
    cells = {
        names[side.title, one]: {column: _in_unit(cell, units[column]) for column, cell in row.items()}
        for side in sides
        for one, row in side.cells.items()
        if one in side.rows
    }
    firsts = {names[titles[1], one]: names[titles[0], one] for one in variants if _is_in_both(one, sides)}
    return compared(shown, cells, [side.graph for side in reversed(sides)], _worst(sides, names), firsts)


def _titles(old: RevisionRow, new: RevisionRow) -> tuple[str, str]:
    """Return a title for each revision, equal only for the same revision."""
    if old.design_id == new.design_id:
        return f"revision {old.number}", f"revision {new.number}"
    first, second = old.document["name"], new.document["name"]
    if first == second:
        first, second = f"{first} ({old.design_id})", f"{second} ({new.design_id})"
    return f"{first}, revision {old.number}", f"{second}, revision {new.number}"


def _side(session: Session, row: RevisionRow, title: str, catalogues: Catalogues) -> _Side:
    results, governing = rows_of(session, row)
    graph, _ = build_graph(Document.model_validate(row.document), catalogues)
    cells = (row.results or {}).get(TABLE, {})
    return _Side(title, {one.name: one for one in results}, cells, graph, governing)


def _name(title: str, variant: str, variants: Sequence[str]) -> str:
    if len(variants) == 1:
        return title
    return f"{title}: {'design itself' if variant == BASE else variant}"


def _is_in_both(variant: str, sides: Sequence[_Side]) -> bool:
    return len(sides) == 2 and all(variant in side.rows for side in sides)


def _units(sides: Sequence[_Side]) -> dict[str, str]:
    """Return the unit of each column, which the newest revision with this column decides."""
    return {
        column: cell.get("unit", "")
        for side in sides
        for row in side.cells.values()
        for column, cell in row.items()
    }


def _in_unit(cell: TableCell, wanted: str) -> TableCell:
    """Return a cell in the unit of its column; without a value if its unit measures something else."""
    own, value = cell.get("unit", ""), cell["value"]
    if own == wanted or not isinstance(value, float):
        return cell
    if not wanted or unit(own).base != unit(wanted).base:
        return {"value": None, "unit": wanted, "reason": f"its unit {own} does not fit the column"}
    return {"value": float(unit(wanted).from_si(unit(own).to_si(value))), "unit": wanted}


def _worst(sides: Sequence[_Side], names: Mapping[tuple[str, str], str]) -> GoverningVariant | None:
    """Return the worse of the two governing rows, under its name in the table."""
    worst = [(side, side.governing) for side in sides if side.governing is not None]
    if not worst:
        return None
    side, governing = min(worst, key=lambda pair: _rank(pair[1]))
    return governing.model_copy(update={"variant": names[side.title, governing.variant]})


def _rank(one: GoverningVariant) -> tuple[int, float]:
    return WORST_FIRST.index(one.verdict), -(one.utilisation if one.utilisation is not None else -math.inf)
