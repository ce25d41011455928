"""Calculate a design: the values known now, those that wait for a solid or a job, and the faults.

The calculation does not stop at the first fault, so that a user sees all faults at once. Values that depend
on varied parameters are calculated for all rows at once. A refused row has no value there.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import replace

import numpy as np

from app.designs.engine.calculation import DEFERRED, Analysed, Calculation, Measured
from app.designs.engine.columns import Column, stacked
from app.designs.engine.refusals import Refusal, refusal_of_text
from app.designs.engine.relations import limit_operations, limit_values, related, tolerance_of, wrong_index
from app.designs.engine.steps import memory, step_rows
from app.designs.network import Block, Cell, Graph, Node, Solid, SolidAnalysis
from app.plain import Raw
from app.pool.cost import points, spanned
from app.pool.errors import StepDeferred
from app.reference import Reference
from cad.model import CadModel
from templates.core.arrays import Array
from templates.core.errors import Fault, FaultyText, InvalidInputs
from templates.core.language.evaluate import Evaluation, evaluate
from templates.core.language.request import read_request
from templates.core.language.spec import Choice, Curve
from templates.core.units.quantity import TypedQuantity, read, read_any
from templates.core.units.relation import is_relation

NOT_FINITE = "the relation has no finite value here (a division by zero, a root below zero?)"
NOT_FINITE_GIVEN = "the value of this row is not finite"


def calculate(
    graph: Graph,
    measured: Measured,
    analysed: Analysed,
    assumed: Mapping[Reference, float] | None = None,
    broken: Iterable[Cell] = (),
) -> Calculation:
    """Return the calculation of all nodes, in dependency order.

    `measured` returns the measurements of a model, or None if the model is not built. `analysed` returns the
    finite-element results of a model. `assumed` holds the SI values of the current iteration round. `broken`
    holds cells that are known to be faulty.
    """
    result = Calculation(graph, assumed or {}, broken=set(broken))
    calculate_nodes(result, graph.order, measured, analysed)
    for through in sorted(graph.assumed, key=str):
        if model := graph.blocks.get(through.block):
            result.faults += _unmapped(result, "iterations", (model.solid,))
    return result


def resume(before: Calculation, measured: Measured, analysed: Analysed) -> Calculation:
    """Continue a calculation without faults: calculate only its pending values, and return it."""
    result = _copy(before)
    result.pending, result.deferred, result.faults = set(), set(), []
    result.shapes, result.measures = dict(before.shapes), dict(before.measures)
    result.analyses = {model: dict(kinds) for model, kinds in before.analyses.items()}
    nodes = [node for node in before.graph.order if node in before.pending]
    calculate_nodes(result, nodes, measured, analysed)
    return result


def constants(calculation: Calculation) -> Calculation:
    """Calculate the needed values that all rows share, and return the calculation."""
    nodes = (node for node in calculation.graph.order if node not in calculation.moving)
    calculate_nodes(calculation, nodes, _unmeasured, _unmeasured)
    return calculation


def rows(shared: Calculation, count: int, given: Mapping[Reference, Array]) -> Calculation:
    """Return the calculation of some rows, based on the values that all rows share."""
    result = _copy(shared)
    result.count, result.given = count, given
    result.faults, result.broken = list(shared.faults), set(shared.broken)
    moving = (node for node in shared.graph.order if node in shared.moving)
    calculate_nodes(result, moving, _unmeasured, _unmeasured)
    return result


def recalculated(
    before: Calculation,
    changed: Mapping[Reference, Column],
    levels: Mapping[str, str | None],
    again: Collection[str] = (),
    outputs: Mapping[str, tuple[str, ...]] | None = None,
) -> Calculation:
    """Repeat a calculation with given step outputs [SI]; solids and rounded sizes do not change.

    Each step is calculated at its level in `levels`, so that no change of level affects the result. Steps in
    `again` are always recalculated, and compute the named `outputs`. Pending values stay pending.
    """
    result = _copy(before)
    result.changed, result.levels = changed, levels
    result.deferred, result.missing, result.faults, result.refusals = set(), {}, [], {}
    nodes = following(before, changed, again)
    result.broken, result.operations = before.broken.difference(nodes), 0
    for node in nodes:
        if isinstance(node, Cell):
            result.values.pop(node.name, None)
            result.typed.pop(node.name, None)
            _cell(result, node)
        elif node in before.pending and node.name not in again:
            continue
        else:
            result.evaluations.pop(node.name, None)
            result.steps.pop(node.name, None)
            _again(result, node, (outputs or {}).get(node.name))
    return result


def _again(result: Calculation, block: Block, outputs: tuple[str, ...] | None) -> None:
    """Recalculate a step, perhaps for other outputs than those that the design requests."""
    asked = block if outputs is None else replace(block, outputs=outputs)
    _block(result, asked)
    if asked in result.pending:
        result.pending = result.pending - {asked} | {block}
    elif block.name not in result.evaluations and block.name not in result.steps:
        result.broken.add(block)


def following(
    calculation: Calculation, changed: Collection[Reference], again: Collection[str] = ()
) -> list[Cell | Block]:
    """Return, in order, the cells and steps that depend on the changed outputs or on the steps in `again`.

    A rounded size is chosen once, so neither it nor what depends on it alone is among them.
    """
    moved = dict[Node, None]()
    nodes = list[Cell | Block]()
    for node in calculation.graph.order:
        if isinstance(node, Cell):
            if node.roundings:
                continue
            sources = calculation.graph.sources[node]
            is_moved = not (moved.keys().isdisjoint(sources) and _is_disjoint(node, changed))
        elif isinstance(node, Block) and not node.is_model:
            is_moved = node.name in again or not moved.keys().isdisjoint(node.cells.values())
        else:
            continue
        if is_moved and _is_needed(calculation, node):
            moved[node] = None
            nodes.append(node)
    return nodes


def _is_disjoint(cell: Cell, changed: Collection[Reference]) -> bool:
    return not any(reference in changed for reference in cell.uses.values())


def _copy(before: Calculation) -> Calculation:
    """Return a copy of the calculation to be continued; it shares the data of solids with the original."""
    return replace(
        before,
        values=dict(before.values),
        typed=dict(before.typed),
        evaluations=dict(before.evaluations),
        steps=dict(before.steps),
        pending=set(before.pending),
        refusals=dict(before.refusals),
    )


def _unmeasured(*_: object) -> None:
    """Return None for every measurement, because rows build no solids."""


def calculate_nodes(
    result: Calculation, nodes: Iterable[Node], measured: Measured, analysed: Analysed
) -> None:
    """Calculate some nodes in order; nodes on which they depend are already calculated."""
    for node in nodes:
        if node in result.broken or not _is_needed(result, node):
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


def _is_needed(result: Calculation, node: Node) -> bool:
    """Return whether the requested values depend on a node; always true if everything is requested."""
    if (needs := result.needs) is None:
        return True
    return (
        node in needs.cells
        if isinstance(node, Cell)
        else isinstance(node, Block) and node.name in needs.members
    )


def _unmapped(result: Calculation, name: str, sources: Iterable[Node]) -> list[Fault]:
    """Return a fault if a value needs a model that has unset parameters."""
    models = {node.model.name for node in sources if isinstance(node, (Solid, SolidAnalysis))}
    unset = [f"{model}.{n}" for model in sorted(models) for n in result.missing.get(model, ())]
    return (
        [Fault(name, "missing", f"this needs {', '.join(unset)}: set it, or link it to an output")]
        if unset
        else []
    )


def _cell(result: Calculation, cell: Cell) -> None:
    """Calculate a cell if its sources have values; its block reports a literal that cannot be read."""
    sources = result.graph.sources[cell]
    if cell.reference in result.given:
        column = Column(result.given[cell.reference], is_row=True)
        result.values[cell.name] = _admitted(result, cell, column, {}, NOT_FINITE_GIVEN)
    elif not result.broken.isdisjoint(sources):
        result.broken.add(cell)
        result.faults += _unmapped(result, cell.name, sources)
    elif _waits(result, cell, sources):
        result.pending.add(cell)
    elif not (isinstance(cell.declared, Choice) and not cell.relations):
        try:
            if cell.relations:
                _related(result, cell)
            else:
                result.typed[cell.name] = typed = literal(cell)
                result.values[cell.name] = Column(typed.si)
        except FaultyText as error:
            result.broken.add(cell)
            if cell.relations or cell.declared is None:
                result.faults.append(error.fault(cell.name))


def _waits(result: Calculation, cell: Cell, sources: Collection[Node]) -> bool:
    """Return whether a cell uses a pending value or, in a calculation of rows, an unknown measurement."""
    if not result.pending.isdisjoint(sources):
        return True
    return result.needs is not None and not result.needs.waiting.isdisjoint(cell.uses.values())


def literal(cell: Cell) -> TypedQuantity:
    """Return the typed quantity of a cell.

    Raises
    ------
    FaultyText
        If the text is not a quantity.
    """
    return read(cell.raw, cell.declared.meaning.accepted) if cell.declared else read_any(cell.raw)


def _related(result: Calculation, cell: Cell) -> None:
    """Calculate the value of a cell from its relations; in a block the value gets the declared unit."""
    uses = {name: result.used(reference) for name, reference in cell.uses.items()}
    _limit(result, cell, uses)
    column = _admitted(result, cell, _joined(cell, uses), uses, NOT_FINITE)
    result.values[cell.name] = column
    if not column.is_row:
        result.typed[cell.name] = _typed(result, cell, column)


def _limit(result: Calculation, cell: Cell, uses: Mapping[str, Column]) -> None:
    """Count the operations of a cell's relations on arrays, and refuse the design if the total is too large.

    Relations between single values are not counted, because the length limit of a relation keeps their number
    small.
    """
    if any(column.rank for column in uses.values()):
        limit_values(count := spanned(column.places for column in uses.values()))
        result.operations += count * sum(relation.parts for relation in cell.relations)
        limit_operations(result.operations)


def _typed(result: Calculation, cell: Cell, column: Column) -> TypedQuantity:
    """Return the value of a relation in the form that the template of its block accepts."""
    si = column.value
    if cell.declared is None:
        return TypedQuantity(None, "", si, {})  # a parameter of the design is used in SI only
    scale = cell.declared.meaning.scale
    block = result.graph.blocks.get(cell.reference.block)
    is_of_model = block is not None and block.is_model
    tolerance = tolerance_of(result.graph, cell, result.typed) if is_of_model else None
    return TypedQuantity(np.asarray(scale.from_si(si)).tolist(), scale.text, si, {}, tolerance)


def calculated(result: Calculation, cell: Cell) -> Column:
    """Return the value of a cell before its rounding; its sources have values."""
    uses = {name: result.used(reference) for name, reference in cell.uses.items()}
    return _joined(cell.calculated, uses)


def _joined(cell: Cell, uses: Mapping[str, Column]) -> Column:
    """Return the value of a relation, or of a list that contains relations."""
    if not isinstance(cell.raw, list):
        return related(cell.relations[0], uses)
    items = [_item(cell, item, uses) for item in cell.raw]
    if any(item.rank for item in items):
        raise FaultyText(
            "shape", "each item of a list is a single value, but a relation in it gives an array"
        )
    return stacked(items)


def _item(cell: Cell, item: Raw, uses: Mapping[str, Column]) -> Column:
    if is_relation(item):
        return related(cell.relations_by_text[str(item).strip()], uses)
    return Column(read(item, cell.declared.meaning.accepted).si if cell.declared else read_any(item).si)


def _admitted(
    result: Calculation, cell: Cell, column: Column, uses: Mapping[str, Column], why: str
) -> Column:
    """Return a column with NaN in the rows that have no finite value, and refuse these rows.

    Raises
    ------
    FaultyText
        If the column has one value for all rows and it is not finite; the code is `not_finite`.
    """
    if not column.is_row:
        if not np.all(np.isfinite(column.value)):
            raise FaultyText("not_finite", why)
        return column
    finite = column.finite_rows()
    if finite.all():
        return column
    refused = np.flatnonzero(~finite).tolist()
    refusal = Refusal(cell.name, "not_finite", why)
    _refuse(result, dict.fromkeys(refused, refusal) | dict(_wrong_indices(cell, uses, refused)))
    return column.without(~finite)


def _wrong_indices(
    cell: Cell, uses: Mapping[str, Column], rows: Iterable[int]
) -> Iterator[tuple[int, Refusal]]:
    """Yield the rows in which a relation uses an index outside its array, each with its refusal."""
    for relation in cell.relations:
        for row in rows if relation.items and uses else ():
            if error := wrong_index(relation, uses, row):
                yield row, refusal_of_text(cell.name, error)


def _refuse(result: Calculation, refusals: Mapping[int, Refusal]) -> None:
    result.refusals = {**refusals, **result.refusals}  # the first reason is the cause of the others


def _block(result: Calculation, block: Block) -> None:
    """Evaluate a step, or check a model's parameters; while a cell is pending, check the known values."""
    cells = block.cells
    waiting = {n for n, cell in cells.items() if cell in result.pending} if result.pending else set()
    broken, typed, values = result.broken, result.typed, result.values
    spoilt = {n for n, c in cells.items() if c in broken and c.relations} if broken else set()
    if result.given and any(c.name in values and values[c.name].is_row for c in cells.values()):
        _rows_of(result, block)
        return
    raw = {n: typed.get(c.name, c.raw) for n, c in cells.items() if n not in waiting}
    faults = _attempt(result, block, raw, waiting)
    if not (faults or waiting or spoilt):
        return
    remaining = [fault for fault in faults if fault.name not in waiting | spoilt]
    if block.is_model and result.needs is None:
        absent = [f.name for f in remaining if f.code == "missing"]
        result.missing.update({block.name: absent} if absent else {})
        remaining = [fault for fault in remaining if fault.code != "missing"]
    result.faults += [fault.within(block.name) for fault in remaining]
    if waiting and not remaining and not spoilt:
        result.pending.add(block)
    elif faults or spoilt:
        result.broken.add(block)


def _given(result: Calculation, cell: Cell) -> Column | Raw:
    """Return the value of a cell as an input of a step, as a column if it differs between rows."""
    column = result.values.get(cell.name)
    if column is not None and column.is_row:
        return column
    return result.typed.get(cell.name, cell.raw)


def _rows_of(result: Calculation, block: Block) -> None:
    """Evaluate a step, or the formulas of a model, for all rows whose inputs exist."""
    for states in (result.pending, result.broken):
        if not states.isdisjoint(block.cells.values()):
            states.add(block)
            return
    given = {name: _given(result, cell) for name, cell in block.cells.items()}
    levels, members = result.levels or {}, result.needs.members[block.name] if result.needs else set()
    level, started = levels.get(block.name), result.started.get(block.name)
    step = step_rows(block, given, sorted(members), result.count, level, started)
    if step.level is not None and block.cls.levels:
        result.started.setdefault(block.name, step.level)
    result.steps[block.name] = step
    _refuse(result, step.refusals)


def _attempt(result: Calculation, block: Block, raw: dict[str, Raw], waiting: set[str]) -> list[Fault]:
    """Evaluate a step or create a model's shape, and return the faults; pending inputs are not checked."""
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
            wanted = _outputs(result, block)
            limit_values(points(raw) * len(block.cls.formulas if wanted is None else wanted))
            _evaluate(result, block, raw, wanted)
    except InvalidInputs as error:
        return list(error.faults)
    except FaultyText as error:
        return [error.fault("inputs")]
    return []


def _outputs(result: Calculation, block: Block) -> tuple[str, ...] | None:
    """Return the outputs that a step must compute; None for all."""
    return result.graph.computed(block) if result.needs is None else result.needs.outputs(block)


def _evaluate(result: Calculation, block: Block, raw: dict[str, Raw], wanted: tuple[str, ...] | None) -> None:
    """Evaluate a step; if it is deferred, only check its inputs."""
    try:
        evaluation = _prepared(result, block) or _evaluation(result, block, raw, wanted)
    except StepDeferred:
        read_request(block.cls, raw, wanted, level=block.level)
        result.deferred.add(block.name)
        result.pending.add(block)
        return
    limit_values(evaluation.count())  # curves are longer than their inputs
    result.evaluations[block.name] = evaluation
    if result.needs is not None and isinstance(evaluation.level, str):
        result.started.setdefault(block.name, evaluation.level)


def _evaluation(
    result: Calculation, block: Block, raw: dict[str, Raw], wanted: tuple[str, ...] | None
) -> Evaluation:
    """Return the evaluation of a step.

    The evaluation is taken from the cache where possible, except at a level chosen for rows.
    """
    if result.levels is None:
        return memory.evaluation(block, raw, wanted)
    level = result.levels.get(block.name)
    if result.needs is None:
        return memory.evaluation(replace(block, level=level, tolerance=None), raw, wanted)
    return evaluate(block.cls, raw, outputs=wanted, level=level, judge=False)


def _prepared(result: Calculation, block: Block) -> Evaluation | None:
    """Return the evaluation of a step that another calculation has prepared; None if there is none."""
    prepared = result.prepared.pop(block.name, None)
    if prepared == DEFERRED:
        raise StepDeferred
    return prepared


def _refuse_arrays(result: Calculation, block: Block) -> None:
    single = Column(0.0)
    arrays = [
        n
        for n, cell in block.cells.items()
        if result.values.get(cell.name, single).rank > int(isinstance(cell.declared, Curve))
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
    """Add the results of an analysis that relations use, or mark the analysis as pending."""
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
