"""The units of relations, checked before any value is known."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from app.designs.network import Cell, Network
from app.reference import Reference
from templates.core.errors import Fault, FaultyText
from templates.core.language.spec import Choice
from templates.core.units.operations import Kind
from templates.core.units.quantity import read_any
from templates.core.units.relation import Relation
from templates.core.units.units import compatible, unit


def checked_kinds(network: Network, cells: Iterable[Cell]) -> tuple[dict[str, Kind], list[Fault]]:
    """Return the kind of unit of each parameter, and a fault for each relation whose units do not fit.

    The cells come in order, so that a parameter's unit is known before its use.
    """
    kinds: dict[str, Kind] = {}
    faults: dict[str, Fault] = {}
    broken: set[str] = set()
    for cell in cells:
        if cell.declared is not None and not cell.relations:
            continue
        if not broken.isdisjoint(cell.uses):
            broken.add(cell.name)
            continue
        try:
            kind = _kind(network, kinds, cell)
        except FaultyText as error:
            broken.add(cell.name)
            faults[cell.name] = error.fault(cell.name)
        else:
            kinds |= {cell.name: kind} if cell.declared is None else {}
    return kinds, list(faults.values())


def _kind(network: Network, kinds: Mapping[str, Kind], cell: Cell) -> Kind:
    """Return the kind of a cell, if its relations fit what it sets."""
    if not cell.relations:
        return Kind(unit(read_any(cell.raw).unit).base)
    used = {
        name: kinds[name] if name in network.parameters else _declared_kind(network, reference)
        for name, reference in cell.uses.items()
    }
    own = [relation.kind(used) for relation in cell.relations]
    if cell.declared is not None:
        for kind, relation in zip(own, cell.relations, strict=True):
            _check_target(cell, relation, kind)
    return Kind(own[0].base)


def _declared_kind(network: Network, reference: Reference) -> Kind:
    return Kind(unit(network.unit_of(reference)).base)


def _check_target(cell: Cell, relation: Relation, kind: Kind) -> None:
    declared = cell.declared
    assert declared is not None
    if isinstance(declared, Choice):
        message = f"{cell.name} is one of {', '.join(declared.options)}; no relation fits it"
        raise FaultyText("unit_mismatch", message)
    want = declared.meaning.scale
    if compatible(kind.base, want.base) and not (kind.absolute and want.difference):
        return
    given = f"{kind.base:~P}" or "a pure number"
    hint = (
        "; for a speed multiply by 1 rad" if "rad" in f"{want.base}" and "rad" not in f"{kind.base}" else ""
    )
    raise FaultyText(
        "unit_mismatch", f"{relation.text} gives {given}, but {cell.name} is in {want.text}{hint}"
    )
