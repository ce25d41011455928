"""Values that a request uses in place of those of the design; they are never saved."""

from __future__ import annotations

from collections.abc import Iterator

from app.catalogue.catalogues import Catalogues
from app.designs.document import Document
from app.designs.graph import Graph, build_graph, raise_if
from app.designs.variants.table import Overrides, applied, is_place, places
from app.plain import Raw
from app.reference import Reference
from templates.core.errors import Fault, FaultyText, unknown_name, unknown_names
from templates.core.language.intake import option_named
from templates.core.language.spec import Choice, Table
from templates.core.units.quantity import read, read_any
from templates.core.units.relation import is_relation

WITH = "with"


def changed(document: Document, catalogues: Catalogues, others: Overrides, unknown: str) -> Document:
    """Return a copy of the document with replaced values.

    Raises
    ------
    InvalidInputs
        If a place does not exist, a value does not fit its place, or a value is given for the unknown.
    """
    graph, faults = build_graph(document, catalogues)
    raise_if(faults)
    raise_if([fault.within(WITH) for fault in _faults(graph, others, unknown)])
    return applied(document, others)


def _faults(graph: Graph, others: Overrides, unknown: str) -> Iterator[Fault]:
    absent = [name for name in others if not is_place(graph, name)]
    if absent:
        yield from unknown_names(absent, list(places(graph)), "parameter or input")
    for name, raw in others.items():
        if name == unknown:
            yield Fault(name, "conflict", f"{name} is the unknown of `solve`; omit its value")
        elif name not in absent and not is_relation(raw) and not isinstance(raw, list):
            yield from _misfit(graph, name, raw)


def _misfit(graph: Graph, name: str, raw: Raw) -> Iterator[Fault]:
    """Yield a fault if a value does not fit its place: an unknown option, or a quantity of the wrong kind."""
    reference = Reference.parse(name)
    block = graph.blocks.get(reference.block)
    declared = block.cls.inputs[reference.member] if block else None
    if isinstance(declared, Choice):
        if not isinstance(raw, str) or option_named(declared.options, raw) is None:
            yield unknown_name(str(raw), declared.options, "option").within(name)
        return
    if isinstance(declared, Table):
        return
    try:
        if declared is not None:
            read(raw, declared.meaning.accepted)
        else:
            cell = graph.parameters[name]
            read(raw, graph.kinds[name].unit if cell.relations else read_any(cell.raw).unit)
    except FaultyText as error:
        yield error.fault(name)
