"""Designs without their roundings, or with the chosen sizes; rounded values between two values.

A relation that ends in `rounded to 0.5 mm` gives a chosen value, from which the solid is built and by which
criteria are judged.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from app.catalogue.catalogues import Catalogues
from app.designs.document import Document
from app.designs.engine.calculate import calculate
from app.designs.engine.calculation import Calculation
from app.designs.engine.needs import needs
from app.designs.graph import build_graph, starts
from app.designs.network import LIMITS, Cell, Graph
from app.designs.result_cells import ShownQuantity, quantity
from app.plain import Raw
from app.reference import Reference
from templates.core.errors import listed


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
    for cell, size in _chosen(design):
        _type(plain, cell.reference, size)
    return plain


def _chosen(design: Calculation) -> Iterator[tuple[Cell, ShownQuantity]]:
    for cell in design.graph.cells():
        if cell.roundings and (column := design.values.get(cell.name)) is not None:
            yield cell, quantity(column.value, cell.roundings[0].scale)


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
