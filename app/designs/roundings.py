"""The rounded values of a design: what each relation gives, and what its rule chooses.

A relation that ends in `rounded to 0.5 mm` gives a chosen value, from which the solid is built and by which
criteria are judged. A value that only names a rounded one, such as `= pin`, is listed as well.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from typing import TypedDict

import numpy as np

from app.catalogue.catalogues import Catalogues
from app.designs.document import Document
from app.designs.engine.calculate import calculate, calculated
from app.designs.engine.calculation import Calculation
from app.designs.engine.needs import needs
from app.designs.graph import build_graph, starts
from app.designs.network import LIMITS, Cell, Graph
from app.plain import Raw
from app.reference import Reference
from templates.core.errors import listed
from templates.core.units.units import Unit

DIGITS = 12  # of a shown value, as many as a model's parameters have
ROUNDED = "rounded"


class ShownQuantity(TypedDict):
    """A quantity as a revision stores it; its value is a number or a list of any depth."""

    value: object
    unit: str


class RoundedValue(TypedDict):
    """A rounded value as a revision stores it."""

    name: str
    rule: str
    calculated: ShownQuantity
    chosen: ShownQuantity


def rounded(calculation: Calculation) -> list[RoundedValue]:
    """Return every known rounded value by its name: the rule, the calculated and the chosen value."""
    return [
        row for cell in calculation.graph.cells() if (row := rounded_value(calculation, cell)) is not None
    ]


def as_member(calculation: Calculation) -> dict[str, list[RoundedValue]]:
    """Return the rounded values as the member `rounded` of stored results; empty if there are none."""
    rows = rounded(calculation)
    return {ROUNDED: rows} if rows else {}


def rounded_value(calculation: Calculation, cell: Cell) -> RoundedValue | None:
    """Return the rule, calculated and chosen value of a cell; None if it is pending or not rounded."""
    source = _source(calculation.graph, cell)
    column = calculation.values.get(source.name) if source is not None else None
    if source is None or column is None or column.is_row:
        return None
    scale = source.roundings[0].scale
    return {
        "name": cell.name,
        "rule": ", ".join(dict.fromkeys(rounding.words for rounding in source.roundings)),
        "calculated": _quantity(calculated(calculation, source).value, scale),
        "chosen": _quantity(column.value, scale),
    }


def _source(graph: Graph, cell: Cell) -> Cell | None:
    """Return the cell whose rounding a cell shows: itself, or the cell that it only names."""
    while not cell.roundings:
        names = [relation.only_name for relation in cell.relations]
        if len(names) != 1 or names[0] is None or isinstance(cell.raw, list):
            return None
        source = graph.node(cell.uses[names[0]])
        if not isinstance(source, Cell):
            return None
        cell = source
    return cell


def _quantity(si: object, scale: Unit) -> ShownQuantity:
    return {
        "value": _plain(np.asarray(scale.from_si(np.asarray(si, dtype=float))).tolist()),
        "unit": scale.text,
    }


def _plain(value: object) -> object:
    return [_plain(item) for item in value] if isinstance(value, list) else float(f"{value:.{DIGITS}g}")


def between(
    graph: Graph, places: Collection[Reference], wanted: Collection[Reference]
) -> dict[Reference, list[Cell]]:
    """Return the rounded cells through which each of some places acts on values; only places with any.

    Such a value is a step function of the place, so it has no slope.
    """
    if not any(cell.roundings for cell in graph.cells()):
        return {}
    due = needs(graph, wanted, ()).cells
    rounded_cells = [cell for cell in graph.cells() if cell.roundings and cell in due]
    through: dict[Reference, list[Cell]] = {}
    for cell in rounded_cells:
        behind = needs(graph, cell.uses.values(), ())
        used = {one.reference for one in behind.cells}
        used |= behind.waiting
        used |= {Reference(block, None, name) for block, names in behind.members.items() for name in names}
        for place in used.intersection(places):
            through.setdefault(place, []).append(cell)
    return through


def in_words(cells: Iterable[Cell]) -> str:
    """Return the names of rounded cells with their rules: `shell.wall (rounded up to 0.5 mm)`."""
    rules = {cell.name: ", ".join(dict.fromkeys(one.words for one in cell.roundings)) for cell in cells}
    return listed([f"{name} ({rule})" for name, rule in rules.items()])


def without(document: Document, cells: Iterable[Cell]) -> Document:
    """Return the document without the roundings of some cells."""
    plain = document.model_copy(deep=True)
    for cell in cells:
        _type(plain, cell.reference, cell.calculated.raw)
    return plain


def with_chosen_sizes(document: Document, catalogues: Catalogues) -> Document:
    """Return the document with every known rounded value typed in place of its relation.

    Products of one design differ within their tolerances, but the sizes of its drawing are chosen once.
    """
    graph, faults = build_graph(document, catalogues)
    if faults or not any(cell.roundings for cell in graph.cells()):
        return document
    design = calculate(graph, lambda _: None, lambda *_: None, starts(document))
    plain = document.model_copy(deep=True)
    for cell, quantity in _chosen(design):
        _type(plain, cell.reference, quantity)
    return plain


def _chosen(design: Calculation) -> Iterator[tuple[Cell, ShownQuantity]]:
    for cell in design.graph.cells():
        if cell.roundings and (column := design.values.get(cell.name)) is not None:
            yield cell, _quantity(column.value, cell.roundings[0].scale)


def _type(document: Document, place: Reference, raw: Raw) -> None:
    """Set a value in a document."""
    if place.output is None:
        document.parameters[place.block] = raw
    elif place.block in document.models:
        document.models[place.block].parameters[place.member] = raw
    elif place.analysis == LIMITS:
        document.steps[place.block].limits[place.output] = raw
    else:
        document.steps[place.block].inputs[place.member] = raw
