"""A design with the overrides of one variant applied, and the faults of a table of variants."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import chain

from app.designs.document import Document, Model, Step
from app.designs.network import Graph, Network
from app.designs.variants.names import RESERVED
from app.plain import Raw
from app.reference import Reference
from templates.core.errors import Fault, FaultyText, unknown_names
from templates.core.units.quantity import read, read_any
from templates.core.units.relation import is_relation

Overrides = Mapping[str, Raw]
"""Values of one variant by their places."""


def applied(document: Document, overrides: Overrides) -> Document:
    """Return a copy of the document with the overrides of one variant applied, and without variants."""
    parameters = dict(document.parameters)
    inside: dict[str, dict[str, Raw]] = {}
    for place, value in overrides.items():
        reference = Reference.parse(place)
        if reference.output is None:
            parameters[place] = value
        else:
            inside.setdefault(reference.block, {})[reference.output] = value
    steps = {name: _step(step, inside.get(name)) for name, step in document.steps.items()}
    models = {name: _model(model, inside.get(name)) for name, model in document.models.items()}
    changes = {"parameters": parameters, "steps": steps, "models": models, "variants": {}}
    return document.model_copy(update=changes)


def _step(step: Step, values: Overrides | None) -> Step:
    return step.model_copy(update={"inputs": {**step.inputs, **values}}) if values else step


def _model(model: Model, values: Overrides | None) -> Model:
    return model.model_copy(update={"parameters": {**model.parameters, **values}}) if values else model


def place_name(variant: str, place: str) -> str:
    """Return the name by which faults refer to a cell of the table: `variants.main_2.clearance`."""
    return f"variants.{variant}.{place}"


Cells = Mapping[tuple[str, str], Fault]
"""Faults of cells by variant and place; the place is empty for a fault of a whole variant."""


def faulty_cells(document: Document, graph: Graph) -> Cells:
    """Return the faults of cells: reserved names, unknown places, and units of the wrong kind."""
    faults: dict[tuple[str, str], Fault] = {}
    for name in RESERVED.keys() & document.variants.keys():
        faults[name, ""] = Fault(f"variants.{name}", "reserved", RESERVED[name])
    unknown: list[tuple[str, str]] = []
    for variant, overrides in document.variants.items():
        for place, value in overrides.items():
            if not is_place(graph, place):
                unknown.append((variant, place))
            elif fault := _other_kind(graph, variant, place, value):
                faults[variant, place] = fault
    if unknown:
        details = unknown_names((place for _, place in unknown), list(places(graph)), "parameter or input")
        for cell, detail in zip(unknown, details, strict=True):
            faults[cell] = Fault(place_name(*cell), detail.code, detail.detail)
    return faults


def _other_kind(graph: Graph, variant: str, place: str, value: Raw) -> Fault | None:
    """Return a fault if the unit of a parameter has another kind than in the design; otherwise None."""
    cell, kind = graph.parameters.get(place), graph.kinds.get(place)
    if cell is None or kind is None or is_relation(value) or isinstance(value, list):
        return None
    try:
        read(value, kind.unit if cell.relations else read_any(cell.raw).unit)
    except FaultyText as error:
        return error.fault(place_name(variant, place))
    return None


def sound(document: Document, faults: Cells) -> Document:
    """Return the document without its faulty cells, so that the other faults can be found too."""
    variants = {
        name: {place: value for place, value in overrides.items() if (name, place) not in faults}
        for name, overrides in document.variants.items()
        if name not in RESERVED
    }
    return document.model_copy(update={"variants": variants})


def is_place(network: Network, place: str) -> bool:
    """Return whether a name is a place that a variant may override.

    Places are parameters, inputs of steps, and parameters of models.
    """
    reference = Reference.parse(place)
    if reference.output is None:
        return reference.block in network.parameters
    block = network.blocks.get(reference.block)
    if block is None or block.is_worksheet:
        return False
    return reference.analysis is None and reference.output in block.cls.inputs


def places(network: Network) -> Iterator[str]:
    """Yield every place that a variant may override."""
    yield from network.parameters
    yield from chain.from_iterable(
        (f"{block.name}.{name}" for name in block.cls.inputs)
        for block in network.blocks.values()
        if not block.is_worksheet
    )
