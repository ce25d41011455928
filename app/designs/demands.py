"""The criteria of a design: its own, and its changes to those of its templates.

A name without a dot is a criterion of the design, which needs `require`. `film.pressure` is the criterion
`pressure` of the template of step `film`: the design may replace its comparison, words or source, or waive
it.
"""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import replace

from app.designs.analyses import is_table
from app.designs.document import Document, WrittenCriterion
from app.designs.network import Block, Demand, Network
from app.reference import Reference
from templates.core.errors import Fault, FaultyText, unknown_name, unknown_names
from templates.core.judging.criterion import Criterion as Checked
from templates.core.judging.criterion import Described, read_comparison, read_criterion
from templates.core.language.spec import Table, Text
from templates.core.units.operations import Kind
from templates.core.units.quantity import read_any


def read_demands(document: Document, blocks: Mapping[str, Block]) -> tuple[dict[str, Demand], list[Fault]]:
    """Return the criteria of a document with the names that they use, and what of them cannot be read."""
    demands: dict[str, Demand] = {}
    faults: list[Fault] = []
    for name, written in document.criteria.items():
        try:
            if not _is_unread(name, document, blocks):
                _require_subject(name, written, blocks)
            demands[name] = Demand(name, written, _uses(written.require))
        except FaultyText as error:
            faults.append(fault_of(name, error))
    return demands, faults


def _is_unread(name: str, document: Document, blocks: Mapping[str, Block]) -> bool:
    """True if a criterion is one of a step whose template is not known, which is a fault of its own."""
    criterion = Reference.parse(name)
    is_of_step = criterion.output is not None and criterion.block in document.steps
    return is_of_step and criterion.block not in blocks


def _require_subject(name: str, written: WrittenCriterion, blocks: Mapping[str, Block]) -> None:
    """Refuse a criterion of no template, and one of the design that demands nothing."""
    criterion = Reference.parse(name)
    if criterion.output is None:
        if written.require is None:
            form = "give `require`, such as film.minimum_film_thickness >= 3 um"
            raise FaultyText("missing", f"a criterion of the design compares two values: {form}")
        return
    block = blocks.get(criterion.block)
    names = [declared.name for declared in block.cls.declared_criteria] if block else []
    if criterion.member not in names:
        there = [f"{b.name}.{c.name}" for b in blocks.values() for c in b.cls.declared_criteria]
        detail = unknown_name(name, there, "criterion").detail if there else "no template here has criteria"
        raise FaultyText("unknown_name", f"{detail}; a criterion of the design has no dot in its name")


def _uses(require: str | None) -> dict[str, Reference]:
    if require is None:
        return {}
    value, _, limit = read_comparison(require)
    return {name: Reference.parse(name) for name in sorted(value.names | limit.names)}


def unknown_names_in(network: Network, unread: Set[str] = frozenset()) -> list[Fault]:
    """Return a fault for every name in a criterion of the design that means no number.

    `unread` are blocks whose template is not known, which is a fault of its own.
    """
    unknown = [
        (demand.name, used)
        for demand in network.demands.values()
        for used, reference in demand.uses.items()
        if reference.block not in unread and not _is_value(network, reference)
    ]
    if not unknown:
        return []
    faults = unknown_names((used for _, used in unknown), network.names(), "name")
    return [replace(f, name=f"criteria.{name}") for (name, _), f in zip(unknown, faults, strict=True)]


def checked_demands(network: Network, kinds: Mapping[str, Kind]) -> tuple[dict[str, Demand], list[Fault]]:
    """Return the criteria of a network with their units checked, from the kinds of its parameters."""
    demands: dict[str, Demand] = {}
    faults: list[Fault] = []
    for name, demand in network.demands.items():
        if demand.written.require is None or not _parameters(network, demand) <= kinds.keys():
            demands[name] = demand  # a parameter whose kind is not known is a fault already
            continue
        try:
            demands[name] = replace(demand, criterion=_checked(network, kinds, demand))
        except FaultyText as error:
            faults.append(fault_of(name, error))
    return demands, faults


def _is_value(network: Network, reference: Reference) -> bool:
    """Return whether a name means a number: no word, and no table."""
    if reference in network.assumed:
        return True
    if network.node(reference) is None or is_table(reference):
        return False
    block = network.blocks.get(reference.block)
    declared = block and (block.cls.inputs.get(reference.member) or block.cls.formulas.get(reference.member))
    return not isinstance(declared, (Text, Table))


def _parameters(network: Network, demand: Demand) -> set[str]:
    return {name for name in demand.uses if name in network.parameters}


def _checked(network: Network, kinds: Mapping[str, Kind], demand: Demand) -> Checked:
    meanings = {name: _meaning(network, kinds, name, reference) for name, reference in demand.uses.items()}
    written = demand.written
    parts = {"require": written.require, "words": written.words, "source": written.source}
    return read_criterion(demand.name, {key: part for key, part in parts.items() if part}, meanings)


def _meaning(network: Network, kinds: Mapping[str, Kind], name: str, reference: Reference) -> Described:
    """Return the unit in which a value is shown, and its words."""
    if cell := network.parameters.get(name):
        typed = None if cell.relations else read_any(cell.raw).unit
        return Described(typed or kinds[name].unit, name.replace("_", " "), kinds[name])
    block = network.blocks[reference.block]
    declared = block.cls.inputs.get(reference.member) or block.cls.formulas.get(reference.member)
    words = declared.meaning.words if declared else name
    return Described(network.unit_of(reference), words, network.kind_of(reference))


def fault_of(name: str, error: FaultyText) -> Fault:
    """Return the fault of a criterion, by its place in the document."""
    return error.fault(f"criteria.{name}")
