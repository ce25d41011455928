"""Calculate a design: every value that can be known now, what waits for a solid or a job, and what is wrong.

Nothing stops at the first fault, so that a user sees all of them at once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from app.calculations.errors import StepDeferred
from app.calculations.size import points, spanned
from app.designs.analyses import measured_unit
from app.designs.graph import SOLID, Block, Cell, Graph
from app.designs.memory import memory
from app.designs.size import limit_operations, limit_values
from app.solids.questions import Question
from cad.model import CadModel
from templates.core.errors import Fault, FaultyText, InvalidInputs
from templates.core.language.evaluate import Evaluation, checked
from templates.core.language.spec import Choice
from templates.core.language.template import Template
from templates.core.units.quantity import Typed, read, read_any
from templates.core.units.relation import is_relation, parse
from templates.core.units.units import Value, unit

Measures = Mapping[str, float]  # in the units of MEASURES
Measured = Callable[[CadModel], Measures | None]
Found = Mapping[str, Mapping[str, Any]]  # outputs of an analysis
Analysed = Callable[[CadModel, Question, tuple[str, ...]], Found | None]


@dataclass
class Calculation:
    """What came out; all values are in SI."""

    graph: Graph
    values: dict[str, Value] = field(default_factory=dict)  # of cells
    evaluations: dict[str, Evaluation] = field(default_factory=dict)  # of steps
    shapes: dict[str, CadModel] = field(default_factory=dict)  # models whose parameters are all known
    measures: dict[str, Measures] = field(default_factory=dict)  # of models that are built
    analyses: dict[str, Found] = field(default_factory=dict)  # by model.kind: what is used and known
    missing: dict[str, list[str]] = field(default_factory=dict)  # unset parameters of models
    pending: set[str] = field(default_factory=set)  # nodes that wait for a solid, or for a deferred step
    deferred: set[str] = field(default_factory=set)  # expensive steps that nobody waited for
    broken: set[str] = field(default_factory=set)  # nodes that follow from a fault
    faults: list[Fault] = field(default_factory=list)
    operations: int = 0  # on single values, of the relations so far

    def value(self, name: str, assumed: Mapping[str, float] | None = None) -> Value:
        """The value [SI] of a name, once its node is calculated."""
        if assumed and name in assumed:
            return assumed[name]
        if name in self.values:
            return self.values[name]
        head, _, tail = name.partition(".")
        block = self.graph.blocks[head]
        declared = block.cls.inputs.get(tail) or block.cls.formulas.get(tail)
        if declared is None:
            return self.measure(name)
        with np.errstate(all="ignore"):
            return getattr(self.instance(head), declared.attribute)  # type: ignore[no-any-return]

    def measure(self, name: str) -> float:
        """What is measured or found on a solid [SI], by its name in relations: `throw.torsion.stiffness`.

        Raises
        ------
        FaultyText
            With code `no_value`, where an analysis tells a reason instead.
        """
        head, _, tail = name.partition(".")
        measured = self.measures[head][tail] if tail in self.measures[head] else self._found(name)
        return float(unit(measured_unit(tail)).to_si(measured))

    def _found(self, name: str) -> float:
        analysis, _, output = name.rpartition(".")
        told = self.analyses[analysis][output]
        if told["value"] is None:
            raise FaultyText("no_value", f"{name} has no value: {told['reason']}")
        return float(told["value"])

    def instance(self, block: str) -> Template:
        """The template of a step, or the model, with its values."""
        return self.evaluations[block].template if block in self.evaluations else self.shapes[block]


def calculate(
    graph: Graph,
    measured: Measured,
    analysed: Analysed,
    assumed: Mapping[str, float] | None = None,
    broken: Iterable[str] = (),
) -> Calculation:
    """Calculate all nodes in order.

    `measured` tells what a model measures, or None if it is not built, and `analysed` what finite elements
    found on it; `assumed` are the SI values of the measures through which iterations run; `broken` names
    cells that are known to be faulty.
    """
    result = Calculation(graph, broken=set(broken))
    for node in graph.order:
        sources = graph.sources(node)
        if node in result.broken:
            continue
        name, mark, kind = node.partition(SOLID)
        if kind:
            _analysis(result, name, kind, analysed)
        elif mark:
            _solid(result, name, measured)
        elif node in graph.blocks:
            _block(result, graph.blocks[node])
        elif not sources.isdisjoint(result.broken):
            result.broken.add(node)
            result.faults += _unmapped(result, node, sources)
        elif not sources.isdisjoint(result.pending):
            result.pending.add(node)
        elif cell := graph.cell(node):
            _cell(result, cell, assumed or {})
    for through in sorted(graph.assumed):
        result.faults += _unmapped(result, "iterations", {through.partition(".")[0] + SOLID})
    return result


def _unmapped(result: Calculation, node: str, sources: set[str]) -> list[Fault]:
    """Faults of a value that needs a model of which a parameter is not set."""
    models = sorted({source.partition(SOLID)[0] for source in sources} & result.missing.keys())
    unset = [f"{model}.{name}" for model in models for name in result.missing[model]]
    return (
        [Fault(node, "missing", f"this needs {', '.join(unset)}: set it, or map it to an output")]
        if unset
        else []
    )


def _cell(result: Calculation, cell: Cell, assumed: Mapping[str, float]) -> None:
    """The SI value of a cell; a faulty literal of a block is left for the block to tell."""
    try:
        value = _joined(result, cell, assumed) if cell.relations else _literal(result.graph, cell)
    except FaultyText as error:
        result.broken.add(cell.name)
        if cell.relations or cell.name in result.graph.parameters:
            result.faults.append(error.fault(cell.name))
        return
    if value is not None:
        result.values[cell.name] = value


def _literal(graph: Graph, cell: Cell) -> Value | None:
    if cell.name in graph.parameters:
        return read_any(cell.raw).si
    head, _, tail = cell.name.partition(".")
    declared = graph.blocks[head].cls.inputs[tail]
    return None if isinstance(declared, Choice) else read(cell.raw, declared.meaning.unit).si


def _joined(result: Calculation, cell: Cell, assumed: Mapping[str, float]) -> Value:
    """The value of a relation, or of a list that mixes relations and quantities."""
    names = {name: result.value(name, assumed) for name in cell.uses}
    limit_values(count := spanned(np.shape(value) for value in names.values()))
    result.operations += count * sum(relation.parts for relation in cell.relations)
    limit_operations(result.operations)
    if not isinstance(cell.raw, list):
        return _finite(cell.relations[0].value(names))
    declared = result.graph.unit_of(cell.name) if "." in cell.name else None
    parts = [_item(item, names, declared) for item in cell.raw]
    if any(np.ndim(part) for part in parts):
        raise FaultyText(
            "shape", "each item of a list is a single value, but a relation in it gives an array"
        )
    return _finite(np.array(parts, dtype=float))


def _item(item: Any, names: Mapping[str, Value], declared: str | None) -> Value:
    if is_relation(item):
        return parse(item).value(names)
    return read(item, declared).si if declared else read_any(item).si


def _finite(value: Value) -> Value:
    if not np.all(np.isfinite(value)):
        raise FaultyText(
            "not_finite", "the relation has no finite value here (a division by zero, a root below zero?)"
        )
    return value


def _block(result: Calculation, block: Block) -> None:
    """Evaluate a step or check a model's parameters; what can be checked is, even if a cell is pending."""
    waiting = {n for n, cell in block.cells.items() if cell.name in result.pending}
    spoilt = {n for n, c in block.cells.items() if c.name in result.broken and c.relations}
    raw = {n: _given(result, block, cell) for n, cell in block.cells.items() if n not in waiting}
    faults = _attempt(result, block, raw, waiting)
    told = [fault for fault in faults if fault.name not in waiting | spoilt]
    if block.is_model:
        absent = [f.name for f in told if f.code == "missing"]
        result.missing.update({block.name: absent} if absent else {})
        told = [fault for fault in told if fault.code != "missing"]
    result.faults += [fault.within(block.name) for fault in told]
    if waiting and not told and not spoilt:
        result.pending.add(block.name)
    elif faults or spoilt:
        result.broken.add(block.name)


def _given(result: Calculation, block: Block, cell: Cell) -> Any:
    """A cell as the template takes it: as typed, or the value of its relation in the declared unit."""
    if not cell.relations or cell.name not in result.values:
        return cell.raw
    scale = unit(result.graph.unit_of(cell.name))
    si = result.values[cell.name]
    return Typed(np.asarray(scale.from_si(si)).tolist(), scale.text, si, {})


def _attempt(result: Calculation, block: Block, raw: dict[str, Any], waiting: set[str]) -> list[Fault]:
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
            wanted = _wanted(result.graph, block)
            limit_values(points(raw) * len(block.cls.formulas if wanted is None else wanted))
            _evaluate(result, block, raw, wanted)
    except InvalidInputs as error:
        return list(error.faults)
    except FaultyText as error:
        return [error.fault("inputs")]
    return []


def _evaluate(result: Calculation, block: Block, raw: dict[str, Any], wanted: tuple[str, ...] | None) -> None:
    """Evaluate a step; one that is deferred is checked as far as that takes no formula."""
    try:
        evaluation = memory.evaluation(block, raw, wanted)
    except StepDeferred:
        checked(block.cls, raw, wanted or (), block.level)
        result.deferred.add(block.name)
        result.pending.add(block.name)
        return
    limit_values(evaluation.count())  # curves are longer than their inputs tell
    result.evaluations[block.name] = evaluation


def _refuse_arrays(result: Calculation, block: Block) -> None:
    arrays = [n for n, cell in block.cells.items() if np.ndim(result.values.get(cell.name, 0.0))]
    if arrays:
        raise InvalidInputs(
            Fault(n, "not_a_number", "a model takes a single value, not an array") for n in arrays
        )


def _wanted(graph: Graph, block: Block) -> tuple[str, ...] | None:
    """The outputs to compute: all, or those the step names and those that relations use."""
    if block.outputs is None:
        return None
    linked = [tail for tail in graph.used.get(block.name, ()) if tail in block.cls.formulas]
    return tuple(dict.fromkeys([*block.outputs, *linked]))


def _solid(result: Calculation, name: str, measured: Measured) -> None:
    if name in result.broken or name in result.missing:
        result.broken.add(name + SOLID)
        return
    measures = measured(result.shapes[name]) if name in result.shapes else None
    if measures is None:
        result.pending.add(name + SOLID)
    else:
        result.measures[name] = measures


def _analysis(result: Calculation, name: str, kind: str, analysed: Analysed) -> None:
    """What is known of an analysis that somebody uses; it waits for its solid, and then for its job."""
    solid, node = name + SOLID, name + SOLID + kind
    wanted = result.graph.wanted(name, kind)
    if not wanted:
        return
    if solid in result.broken:
        result.broken.add(node)
        return
    question = result.graph.blocks[name].analyses[kind]
    found = None if solid in result.pending else analysed(result.shapes[name], question, wanted)
    if found is None:
        result.pending.add(node)
    else:
        result.analyses[f"{name}.{kind}"] = found
