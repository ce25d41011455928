"""Values that a revision stores beside its steps: the cells of the table of results, and rounded values.

The cells are stored for the design and for each variant; `result_table` assembles the table.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import NotRequired, TypedDict

import numpy as np

from app.designs.analyses import is_table
from app.designs.engine.calculate import calculated
from app.designs.engine.calculation import Calculation
from app.designs.network import Block, Cell, Graph, subjects
from app.reference import ItemReference, Reference
from templates.core.errors import FaultyText
from templates.core.language.spec import Choice
from templates.core.units.quantity import read_any
from templates.core.units.units import Unit, unit

TYPED_DIGITS = 12  # of a value that the user typed, which conversions of units may change in the last digits
ARRAY = "it is a list or a curve; choose one of its items, such as `[1]`, or a single value"
SINGLE = "it is not a list; omit the number of the item"
PENDING = "it is not calculated"
SHOWN_DIGITS = 12  # of a shown value, as many as a model's parameters have
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


class TableCell(TypedDict):
    """A value with its unit, the word of a choice, or null with a reason."""

    value: float | str | None
    unit: NotRequired[str]
    reason: NotRequired[str]


Cells = Mapping[str, TableCell]
"""The cells of one row by column."""


def columns_of(graph: Graph) -> tuple[ItemReference, ...]:
    """Return the columns that the design chooses, else the main results of its steps and models."""
    return graph.columns or tuple(dict.fromkeys(_main_results(graph)))


def _main_results(graph: Graph) -> Iterator[ItemReference]:
    for block in graph.blocks.values():
        for name in _of_model(graph, block) if block.is_model else _of_step(graph, block):
            yield ItemReference.parse(f"{block.name}.{name}")


def _of_step(graph: Graph, step: Block) -> list[str]:
    """Return the results that the template names, else those that its criteria judge."""
    own = (one.criterion for one in subjects(graph).values() if one.block is step)
    names = step.cls.main_results or tuple(one.subject for one in own if one.subject)
    return [name for name in names if _is_computed(graph, step, name.partition("[")[0])]


def _is_computed(graph: Graph, step: Block, name: str) -> bool:
    computed = graph.computed(step)
    return computed is None or name in computed or name not in step.cls.formulas


def _of_model(graph: Graph, model: Block) -> Iterator[str]:
    """Yield the mass of a solid, and the single outputs of its analyses that the design uses."""
    yield "mass"
    for kind in model.analyses:
        for output in graph.wanted(model.name, kind):
            if not is_table(Reference(model.name, kind, output)):
                yield f"{kind}.{output}"


def cells(calculation: Calculation) -> Cells:
    """Return the cells of one row of the table."""
    return {str(one): _cell(calculation, one) for one in columns_of(calculation.graph)}


def _cell(calculation: Calculation, column: ItemReference) -> TableCell:
    """Return a value of a design with its unit, or null with a reason."""
    reference = column.reference
    if word := _choice(calculation, reference):
        return {"value": word}
    scale = unit(_unit_of(calculation.graph, reference))
    try:
        with np.errstate(all="ignore"):
            si = calculation.value(reference)
    except FaultyText as error:
        return {"value": None, "unit": scale.text, "reason": str(error)}
    except (KeyError, AttributeError):
        return {"value": None, "unit": scale.text, "reason": PENDING}
    if np.ndim(si) != (column.item is not None):
        return {"value": None, "unit": scale.text, "reason": SINGLE if column.item else ARRAY}
    if column.item is not None and column.item > np.size(si):
        return {"value": None, "unit": scale.text, "reason": f"it has {np.size(si)} values"}
    value = float(scale.from_si(float(np.atleast_1d(si)[(column.item or 1) - 1])))
    if calculation.graph.cell(reference):
        value = float(f"{value:.{TYPED_DIGITS}g}")  # 6000 rpm, not 6000.000000000001 rpm
    if math.isfinite(value):
        return {"value": value, "unit": scale.text}
    return {"value": None, "unit": scale.text, "reason": _reason(calculation, reference)}


def _reason(calculation: Calculation, reference: Reference) -> str:
    """Return why a step gives no value for an output."""
    evaluation = calculation.evaluations.get(reference.block)
    answer = evaluation.outputs.get(reference.member) if evaluation else None
    return str(answer.reason) if answer is not None and answer.reason else "it is not given"


def _choice(calculation: Calculation, reference: Reference) -> str:
    """Return the word of a choice, or of an output that is a word; empty for a number."""
    block = calculation.graph.blocks.get(reference.block)
    if block is None or reference.analysis is not None:
        return ""
    declared = block.cls.inputs.get(reference.member)
    if isinstance(declared, Choice):
        cell = block.cells.get(reference.member)
        return str(cell.raw if cell else declared.default or "")
    evaluation = calculation.evaluations.get(reference.block)
    answer = evaluation.outputs.get(reference.member) if evaluation else None
    return answer.value if answer is not None and isinstance(answer.value, str) else ""


def _unit_of(graph: Graph, reference: Reference) -> str:
    """Return the unit of a column: the declared one; for a parameter the typed one."""
    if reference.output is not None:
        return graph.unit_of(reference)
    cell = graph.parameters[reference.block]
    try:
        return graph.kinds[reference.block].unit if cell.relations else read_any(cell.raw).unit
    except FaultyText:  # a list with relations
        return graph.kinds[reference.block].unit


def rounded(calculation: Calculation) -> list[RoundedValue]:
    """Return every known rounded value by its name: the rule, the calculated and the chosen value.

    A value that only names a rounded one, such as `= pin`, is listed as well.
    """
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
        "calculated": quantity(calculated(calculation, source).value, scale),
        "chosen": quantity(column.value, scale),
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


def quantity(si: object, scale: Unit) -> ShownQuantity:
    """Return a value [SI] in a unit, with the digits that are shown."""
    return {
        "value": _plain(np.asarray(scale.from_si(np.asarray(si, dtype=float))).tolist()),
        "unit": scale.text,
    }


def _plain(value: object) -> object:
    return [_plain(item) for item in value] if isinstance(value, list) else float(f"{value:.{SHOWN_DIGITS}g}")
