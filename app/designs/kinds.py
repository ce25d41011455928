"""The units of relations, checked before any value is known."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from app.designs.network import Cell, Network
from templates.core.errors import Fault, FaultyText
from templates.core.language.spec import Choice
from templates.core.units.conformity import misfit, turns_remark
from templates.core.units.nodes import Kind, kind_of
from templates.core.units.quantity import read_any
from templates.core.units.relation import Relation
from templates.core.units.units import unit


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
        return kind_of(read_any(cell.raw).unit, cell.name)
    used = {
        name: kinds[name] if name in network.parameters else network.kind_of(reference)
        for name, reference in cell.uses.items()
    }
    own = [relation.kind(used) for relation in cell.relations]
    if cell.declared is not None:
        for kind, relation in zip(own, cell.relations, strict=True):
            _check_target(cell, relation, kind)
    return replace(own[0], literal=False, pi=0, twos=frozenset())


def _check_target(cell: Cell, relation: Relation, kind: Kind) -> None:
    declared = cell.declared
    assert declared is not None
    if isinstance(declared, Choice):
        message = f"{cell.name} is one of {', '.join(declared.options)}; no relation fits it"
        raise FaultyText("unit_mismatch", message)
    want = unit(declared.meaning.accepted)
    text = relation.text.removeprefix("=").strip()
    if mismatch := misfit(kind, want, text):
        why, remedy = mismatch
        hint = f"; {remedy}" if remedy else ""
        raise FaultyText("unit_mismatch", f"{cell.name} is in {declared.meaning.unit}, but {why}{hint}")
    if remark := turns_remark(kind, want, text):
        raise FaultyText("unit_mismatch", f"{cell.name} is in {declared.meaning.unit}: {remark}")
