"""The declared unit of every parameter and input that a variant may override."""

from __future__ import annotations

from app.designs.network import Cell, Network
from app.designs.variant_sheets.reader import Units
from app.designs.variants.table import places
from app.reference import Reference
from templates.core.errors import FaultyText
from templates.core.language.intake import other_sizes
from templates.core.language.spec import Choice
from templates.core.units.quantity import read_any
from templates.core.units.relation import is_relation


def units_of(network: Network) -> Units:
    """Return units by place; None for a choice, and for a parameter that a relation sets.

    A radial clearance is listed in addition to the diametral one, to which a save converts it.
    """
    declared = {place: _unit(network, Reference.parse(place)) for place in places(network)}
    sizes = (
        (block.name, other, name)
        for block in network.blocks.values()
        if not block.is_worksheet
        for other, name in other_sizes(block.cls)
    )
    return declared | {f"{block}.{other}": declared[f"{block}.{name}"] for block, other, name in sizes}


def _unit(network: Network, place: Reference) -> str | None:
    if place.output is None:
        return _typed_unit(network.parameters[place.block])
    declared = network.blocks[place.block].cls.inputs[place.output]
    return None if isinstance(declared, Choice) else network.unit_of(place)


def _typed_unit(cell: Cell) -> str | None:
    """Return the unit in which a parameter was typed; None for a relation."""
    if is_relation(cell.raw) or cell.relations:
        return None
    try:
        return read_any(cell.raw).unit
    except FaultyText:
        return None
