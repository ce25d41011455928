"""Calculate a design: every value that can be known now, what waits for a solid or a job, and what is wrong.

Nothing stops at the first fault, so that a user sees all of them at once.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace

import numpy as np

from app.calculations.errors import StepDeferred
from app.calculations.size import points, spanned
from app.designs.calculation import DEFERRED, Analysed, Calculation, Measured, Measures, Outputs
from app.designs.memory import memory
from app.designs.network import Block, Cell, Graph, Node, Solid, SolidAnalysis
from app.designs.prescribed import tolerance_of
from app.designs.size import limit_operations, limit_values
from app.plain import Raw
from app.reference import Reference
from cad.model import CadModel
from templates.core.errors import Fault, FaultyText, InvalidInputs
from templates.core.language.evaluate import Evaluation
from templates.core.language.request import read_request
from templates.core.language.spec import Choice, Curve
from templates.core.units.quantity import Typed, read, read_any
from templates.core.units.relation import is_relation
from templates.core.units.units import Value

__all__ = [
    "Analysed",
    "Calculation",
    "Measured",
    "Measures",
    "Outputs",
    "calculate",
    "recalculated",
    "resume",
]


def calculate(
    graph: Graph,
    measured: Measured,
    analysed: Analysed,
    assumed: Mapping[Reference, float] | None = None,
    broken: Iterable[Cell] = (),
) -> Calculation:
    """Calculate all nodes in order.

    `measured` returns what a model measures, or None if it is not built, and `analysed` what finite elements
    computed on it; `assumed` are the SI values of the measures through which iterations run; `broken` are
    faulty cells.
    """
    result = Calculation(graph, assumed or {}, broken=set(broken))
    _calculate(result, graph.order, measured, analysed)
    for through in sorted(graph.assumed, key=str):
        if model := graph.blocks.get(through.block):
            result.faults += _unmapped(result, "iterations", (model.solid,))
    return result


def resume(before: Calculation, measured: Measured, analysed: Analysed) -> Calculation:
    """A calculation without faults, continued: only what was pending is calculated."""
    result = replace(
        before,
        values=dict(before.values),
        typed=dict(before.typed),
        evaluations=dict(before.evaluations),
        shapes=dict(before.shapes),
        measures=dict(before.measures),
        analyses={model: dict(kinds) for model, kinds in before.analyses.items()},
        pending=set(),
        deferred=set(),
        faults=[],
    )
    nodes = [node for node in before.graph.order if node in before.pending]
    _calculate(result, nodes, measured, analysed)
    return result


def recalculated(
    before: Calculation,
    changed: Mapping[Reference, Value],
    levels: Mapping[str, str | None],
    again: Collection[str] = (),
    outputs: Mapping[str, tuple[str, ...]] | None = None,
) -> Calculation:
    """Calculate again from given outputs of steps [SI]; solids stay as they are.

    Steps are calculated at the `levels` given by their names, so that no other level makes a difference.
    Those to calculate `again` are calculated whatever they follow from, and compute the `outputs` named.
    """
    result = replace(
        before,
        changed=changed,
        values=dict(before.values),
        typed=dict(before.typed),
        evaluations=dict(before.evaluations),
        pending=set(),
        broken=set(),
        deferred=set(),
        missing={},
        faults=[],
        operations=0,
    )
    moved = set[Node]()
    for node in before.graph.order:
        if isinstance(node, Cell) and not (
            moved.isdisjoint(before.graph.sources[node]) and changed.keys().isdisjoint(node.uses.values())
        ):
            moved.add(node)
            result.values.pop(node.name, None)
            _cell(result, node)
        elif (
            isinstance(node, Block)
            and not node.is_model
            and (node.name in again or not moved.isdisjoint(node.cells.values()))
        ):
            moved.add(node)
            result.evaluations.pop(node.name, None)
            pinned = replace(node, level=levels.get(node.name), tolerance=None)
            wanted = (outputs or {}).get(node.name, node.outputs)
            _block(result, replace(pinned, outputs=wanted))
            result.broken |= {node} if node.name not in result.evaluations else set()
    return result


def _calculate(result: Calculation, nodes: Iterable[Node], measured: Measured, analysed: Analysed) -> None:
    for node in nodes:
        if node in result.broken:
            continue
        match node:
            case Cell():
                _cell(result, node)
            case Block():
                _block(result, node)
            case Solid(model):
                _solid(result, model, measured)
            case SolidAnalysis(model, kind):
                _analysis(result, node, model, kind, analysed)


def calculate_nodes(
    result: Calculation, nodes: Iterable[Node], measured: Measured, analysed: Analysed
) -> None:
    """Calculate some nodes; those before them in order are calculated already."""
    _calculate(result, nodes, measured, analysed)


def _unmapped(result: Calculation, name: str, sources: Iterable[Node]) -> list[Fault]:
    """Faults of a value that needs a model of which a parameter is not set."""
    models = {node.model.name for node in sources if isinstance(node, (Solid, SolidAnalysis))}
    unset = [f"{model}.{n}" for model in sorted(models) for n in result.missing.get(model, ())]
    return (
        [Fault(name, "missing", f"this needs {', '.join(unset)}: set it, or map it to an output")]
        if unset
        else []
    )


def _cell(result: Calculation, cell: Cell) -> None:
    """The SI value of a cell, if what it follows from has one; a faulty literal is left to its block."""
    sources = result.graph.sources[cell]
    if not result.broken.isdisjoint(sources):
        result.broken.add(cell)
        result.faults += _unmapped(result, cell.name, sources)
    elif not result.pending.isdisjoint(sources):
        result.pending.add(cell)
    elif not (isinstance(cell.declared, Choice) and not cell.relations):
        try:
            if cell.relations:
                typed = _related(result, cell)
            else:
                declared = cell.declared
                typed = read(cell.raw, declared.meaning.unit) if declared else read_any(cell.raw)
        except FaultyText as error:
            result.broken.add(cell)
            if cell.relations or cell.declared is None:
                result.faults.append(error.fault(cell.name))
        else:
            result.typed[cell.name], result.values[cell.name] = typed, typed.si


def _related(result: Calculation, cell: Cell) -> Typed:
    """The value of relations, in a block in the unit that is declared there."""
    si = _joined(result, cell)
    if cell.declared is None:
        return Typed(None, "", si, {})  # it is used in SI only
    scale = cell.declared.meaning.scale
    block = result.graph.blocks.get(cell.reference.block)
    is_of_model = block is not None and block.is_model
    tolerance = tolerance_of(result.graph, cell, result.typed) if is_of_model else None
    return Typed(np.asarray(scale.from_si(si)).tolist(), scale.text, si, {}, tolerance)


def _joined(result: Calculation, cell: Cell) -> Value:
    """The value of a relation, or of a list that mixes relations and quantities."""
    values = {} if result.assumed or result.changed else result.values
    names = {n: values[n] if n in values else result.value(reference) for n, reference in cell.uses.items()}
    if any(map(np.ndim, names.values())):  # single values are few: the text of all relations is limited
        limit_values(count := spanned(map(np.shape, names.values())))
        result.operations += count * sum(relation.parts for relation in cell.relations)
        limit_operations(result.operations)
    if not isinstance(cell.raw, list):
        return _finite(cell.relations[0].value(names))
    declared = cell.declared.meaning.unit if cell.declared else None
    parts = [_item(cell, item, names, declared) for item in cell.raw]
    if any(np.ndim(part) for part in parts):
        raise FaultyText(
            "shape", "each item of a list is a single value, but a relation in it gives an array"
        )
    return _finite(np.array(parts, dtype=float))


def _item(cell: Cell, item: Raw, names: Mapping[str, Value], declared: str | None) -> Value:
    if is_relation(item):
        return cell.relations_by_text[str(item).strip()].value(names)
    return read(item, declared).si if declared else read_any(item).si


def _finite(value: Value) -> Value:
    if not np.all(np.isfinite(value)):
        raise FaultyText(
            "not_finite", "the relation has no finite value here (a division by zero, a root below zero?)"
        )
    return value


def _block(result: Calculation, block: Block) -> None:
    """Evaluate a step or check a model's parameters; what can be checked is, even if a cell is pending."""
    waiting = {n for n, cell in block.cells.items() if cell in result.pending} if result.pending else set()
    broken = result.broken
    spoilt = {n for n, c in block.cells.items() if c in broken and c.relations} if broken else set()
    typed = result.typed
    raw = {n: typed.get(c.name, c.raw) for n, c in block.cells.items() if n not in waiting}
    faults = _attempt(result, block, raw, waiting)
    if not (faults or waiting or spoilt):
        return
    remaining = [fault for fault in faults if fault.name not in waiting | spoilt]
    if block.is_model:
        absent = [f.name for f in remaining if f.code == "missing"]
        result.missing.update({block.name: absent} if absent else {})
        remaining = [fault for fault in remaining if fault.code != "missing"]
    result.faults += [fault.within(block.name) for fault in remaining]
    if waiting and not remaining and not spoilt:
        result.pending.add(block)
    elif faults or spoilt:
        result.broken.add(block)


def _attempt(result: Calculation, block: Block, raw: dict[str, Raw], waiting: set[str]) -> list[Fault]:
    """Evaluate a step or make a model's shape; where inputs are waited for, check what can be checked."""
    try:
        if waiting:
            block.cls.from_quantities(raw, pending=waiting)
        elif block.is_model:
            _refuse_arrays(result, block)
            shape = block.cls.from_quantities(raw)
            assert isinstance(shape, CadModel)
            with np.errstate(all="ignore"):
                shape.inputs_si()
            result.shapes[block.name] = shape
        else:
            wanted = result.graph.computed(block)
            limit_values(points(raw) * len(block.cls.formulas if wanted is None else wanted))
            _evaluate(result, block, raw, wanted)
    except InvalidInputs as error:
        return list(error.faults)
    except FaultyText as error:
        return [error.fault("inputs")]
    return []


def _evaluate(result: Calculation, block: Block, raw: dict[str, Raw], wanted: tuple[str, ...] | None) -> None:
    """Evaluate a step; one that is deferred is checked as far as that takes no formula."""
    try:
        evaluation = _prepared(result, block) or memory.evaluation(block, raw, wanted)
    except StepDeferred:
        read_request(block.cls, raw, wanted, level=block.level)
        result.deferred.add(block.name)
        result.pending.add(block)
        return
    limit_values(evaluation.count())  # curves are longer than their inputs
    result.evaluations[block.name] = evaluation


def _prepared(result: Calculation, block: Block) -> Evaluation | None:
    """The evaluation of a step that somebody else has made for this calculation; None if nobody has."""
    prepared = result.prepared.pop(block.name, None)
    if prepared == DEFERRED:
        raise StepDeferred
    return prepared


def _refuse_arrays(result: Calculation, block: Block) -> None:
    arrays = [
        n
        for n, cell in block.cells.items()
        if np.ndim(result.values.get(cell.name, 0.0)) > int(isinstance(cell.declared, Curve))
    ]
    if arrays:
        raise InvalidInputs(
            Fault(n, "not_a_number", "a model takes a single value, not an array") for n in arrays
        )


def _solid(result: Calculation, model: Block, measured: Measured) -> None:
    if model in result.broken or model.name in result.missing:
        result.broken.add(model.solid)
        return
    measures = measured(result.shapes[model.name]) if model.name in result.shapes else None
    if measures is None:
        result.pending.add(model.solid)
    else:
        result.measures[model.name] = measures


def _analysis(result: Calculation, node: SolidAnalysis, model: Block, kind: str, analysed: Analysed) -> None:
    """Take the results of an analysis that a relation uses; it waits for its solid, and then for its job."""
    wanted = result.graph.wanted(model.name, kind)
    if not wanted:
        return
    if model.solid in result.broken:
        result.broken.add(node)
        return
    is_waiting = model.solid in result.pending
    outputs = None if is_waiting else analysed(result.shapes[model.name], model.analyses[kind], wanted)
    if outputs is None:
        result.pending.add(node)
    else:
        result.analyses.setdefault(model.name, {})[kind] = outputs
