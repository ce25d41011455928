"""The worksheet of a design: lines that use its values, calculated as one block named `worksheet`.

The text is read as a worksheet of a team is, with the values of the design as its inputs. So its results are
outputs of a step, and its checks are criteria of a step.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import replace

from app.designs.analyses import axes_of
from app.designs.document import WORKSHEET
from app.designs.network import Block, Cell, Network
from app.reference import Reference
from templates.core.errors import Fault, FaultyText, unknown_name
from templates.core.language.spec import Choice, Curve, Profile, Table, Text
from templates.core.language.template import Template
from templates.core.sheets.design_names import DesignName
from templates.core.sheets.faults import SheetFault, SheetRefused
from templates.core.sheets.lines import normal
from templates.core.sheets.sheet import Sheet, from_text
from templates.core.units.nodes import Kind
from templates.core.units.quantity import read_any
from templates.core.units.relation import parse

MOST_SUGGESTIONS = 20
"""Largest number of unknown names for which the most similar name is sought."""
_WRITTEN = re.compile(r"[A-Za-z][A-Za-z0-9_]*(?:\.[A-Za-z][A-Za-z0-9_]*){0,2}")

ParameterKind = Callable[[str], Kind]
"""Returns the kind of a parameter; raises FaultyText if it has none, or if it follows from the worksheet."""


def worksheet_block(
    text: str, network: Network, parameter_kind: ParameterKind
) -> tuple[Block | None, list[Fault]]:
    """Return the block that a design's lines make, and their faults; the block is None if there are any."""
    names, faults = _names(text, network, parameter_kind)
    try:
        cls = from_text(text, WORKSHEET, 1, None, tuple(names))
    except SheetRefused as error:
        return None, [*faults, *_faults(text, error, network)]
    return None if faults else Block(WORKSHEET, cls, _cells(cls)), faults


def _names(
    text: str, network: Network, parameter_kind: ParameterKind
) -> tuple[list[DesignName], list[Fault]]:
    """Return the values of the design whose names occur in a text, and the faults of parameters."""
    names: list[DesignName] = []
    faults: list[Fault] = []
    for written in sorted(set(_WRITTEN.findall(text))):
        try:
            names += _name(written, network, parameter_kind)
        except FaultyText as error:
            faults.append(error.fault(WORKSHEET))
    return names, faults


def _name(written: str, network: Network, parameter_kind: ParameterKind) -> Iterator[DesignName]:
    """Yield the value of the design that a written name refers to, if it is one that a line can use."""
    if cell := network.parameters.get(written):
        kind = parameter_kind(written)
        unit = kind.unit if cell.relations else read_any(cell.raw).unit
        words = written.replace("_", " ")
        yield DesignName(written, unit, kind.unit, words, turned=tuple(sorted(kind.turned)))
        return
    reference = Reference.parse(written)
    if reference.output is None or network.node(reference) is None or axes_of(reference) > 1:
        return
    block = network.blocks[reference.block]
    declared = block.cls.inputs.get(reference.member) or block.cls.formulas.get(reference.member)
    if isinstance(declared, (Choice, Table, Text)) or (isinstance(declared, Profile) and declared.axes > 1):
        return
    words = declared.meaning.words if declared else reference.member.replace("_", " ").replace(".", ": ")
    axis = f"{block.name}.{declared.along}" if isinstance(declared, (Curve, Profile)) else ""
    unit, accepted = network.unit_of(reference), network.accepted(reference)
    yield DesignName(written, unit, accepted, words, axis or (written if axes_of(reference) else ""))


def _cells(cls: type[Template]) -> dict[str, Cell]:
    """Return the inputs of the block; a relation sets each to the value of the design."""
    by_attribute = {declared.attribute: declared for declared in cls.inputs.values()}
    cells: dict[str, Cell] = {}
    assert isinstance(cls.sheet, Sheet)
    for one in cls.sheet.used:
        declared, raw = by_attribute[one.attribute], f"= {one.name}"
        reference, relation = Reference(WORKSHEET, None, declared.name), parse(raw)
        uses = {one.name: Reference.parse(one.name)}
        cells[declared.name] = Cell(reference, str(reference), raw, (relation,), uses, declared)
    return cells


def _faults(text: str, refused: SheetRefused, network: Network) -> Iterator[Fault]:
    """Yield the faults of the lines; an unknown name with a dot gets the most similar name of the design."""
    lines = normal(text).split("\n")
    for number, fault in enumerate(refused.faults):
        if fault.code == "unknown_name" and number < MOST_SUGGESTIONS:
            written = _WRITTEN.match(lines[fault.line - 1][fault.column - 1 :])
            name = written[0] if written else ""
            if name in network.parameters:
                continue  # the parameter has a fault of its own
            fault = _suggested(fault, name, network)
        yield Fault(f"{WORKSHEET}.{fault.line}", fault.code, fault.sentence)


def _suggested(fault: SheetFault, name: str, network: Network) -> SheetFault:
    """Return the fault of a name with a dot: why no line can use it, or the most similar name."""
    if "." not in name:
        return fault
    if network.has(Reference.parse(name)):
        return replace(fault, message=f"{name} is not a number or a list of numbers", remedy="")
    return replace(fault, message=unknown_name(name, network.names(), "name").detail, remedy="")
