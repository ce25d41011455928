"""The columns of a table of variants: every parameter or input that at least one variant overrides."""

from __future__ import annotations

from app.designs.document import Document
from app.designs.graph import Graph
from app.designs.network import Cell
from app.designs.schemas.variants import VariantColumn
from app.designs.variants.outcome import base_unit
from app.designs.variants.table import places
from app.reference import Reference
from app.schemas.answers import Shown
from templates.core.errors import FaultyText
from templates.core.language.spec import Choice, Input
from templates.core.units.quantity import TypedQuantity, read, read_any


def columns(document: Document, graph: Graph) -> list[VariantColumn]:
    """Return the columns of a document's table.

    Parameters come first, then steps and models, in declaration order.
    """
    used = {place: None for overrides in document.variants.values() for place in overrides}
    ordered = dict.fromkeys([*(place for place in places(graph) if place in used), *used])
    return [_column(place, graph) for place in ordered]


def _column(place: str, graph: Graph) -> VariantColumn:
    reference = Reference.parse(place)
    cell = graph.cell(reference)
    block = graph.blocks.get(reference.block)
    declared = block.cls.inputs.get(reference.output or "") if block else None
    words = declared.meaning.words if declared else place.replace("_", " ")
    heading = words if reference.output is None else f"{reference.block}: {words}"
    more = {"unit": _unit(place, cell, declared, graph), "nominal": _nominal(cell)}
    present = {name: part for name, part in more.items() if part is not None}
    return VariantColumn.model_validate({"place": place, "words": heading, **present})


def _unit(place: str, cell: Cell | None, declared: Input | None, graph: Graph) -> str | None:
    """Return the unit of a column: the declared one, or for a parameter the typed one.

    It is None for a choice.
    """
    if declared is not None:
        return None if isinstance(declared, Choice) else declared.meaning.unit
    if cell is not None and not cell.relations and (typed := _typed(cell)):
        return typed.unit
    return base_unit(graph, place) if place in graph.kinds else None


def _nominal(cell: Cell | None) -> Shown | None:
    """Return the design's own value as the user typed it; None if a relation or nothing sets it."""
    if cell is None or cell.relations:
        return None
    if isinstance(cell.declared, Choice):
        return Shown(value=cell.raw)
    typed = _typed(cell)
    return Shown(value=typed.value, unit=typed.unit) if typed else None


def _typed(cell: Cell) -> TypedQuantity | None:
    try:
        return read(cell.raw, cell.declared.meaning.accepted) if cell.declared else read_any(cell.raw)
    except FaultyText:  # an older program accepted it
        return None
