"""The net of a design: which value follows from which, checked before anything is calculated.

Nodes are named as their user names them. A cell is a value of the design: `scale`, `film.radial_load`,
`model.inner_diameter`. A block is a step or a model: `film`, `model`; it follows from its cells, and its
outputs follow from it. A solid, `model!`, is a model when built: what is measured follows from it. So does an
analysis of it, `model!torsion`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise
from typing import Any

from app.designs.analyses import is_measured, measured_names, measured_unit, questions, remedy, used
from app.designs.document import Document
from app.designs.size import too_many_relations
from app.solids.questions import Question
from cad.model import CadModel
from templates.core.catalogue.finding import Catalogue
from templates.core.errors import Fault, FaultyText, InvalidInputs, UnknownTemplate, unknown_names
from templates.core.language.spec import Choice
from templates.core.language.template import Template
from templates.core.units.quantity import read_any
from templates.core.units.relation import Kind, Relation, is_relation, parse
from templates.core.units.units import compatible, unit

SOLID = "!"


@dataclass(frozen=True)
class Cell:
    """One value as its user wrote it, with the relations in it (a list may hold several)."""

    name: str
    raw: Any
    relations: tuple[Relation, ...]

    @cached_property
    def uses(self) -> frozenset[str]:
        """The names that its relations use."""
        return frozenset().union(*(relation.names for relation in self.relations))


@dataclass(frozen=True)
class Block:
    """A step or a model: a template and the cells that are set."""

    name: str
    cls: type[Template]
    cells: dict[str, Cell]
    level: str | None = None
    tolerance: float | None = None
    outputs: tuple[str, ...] | None = None
    analyses: Mapping[str, Question] = field(default_factory=dict)

    @property
    def is_model(self) -> bool:
        """Whether it has a shape."""
        return issubclass(self.cls, CadModel)


@dataclass(frozen=True)
class Catalogues:
    """What a design can be made of."""

    templates: Catalogue[Template]
    models: Catalogue[CadModel]


@dataclass
class Graph:
    """The checked net of one document."""

    parameters: dict[str, Cell]
    blocks: dict[str, Block]
    assumed: frozenset[str]  # the measures through which a declared iteration runs
    order: list[str] = field(default_factory=list)
    kinds: dict[str, Kind] = field(default_factory=dict)

    def cells(self) -> Iterator[Cell]:
        """Every cell of the design."""
        yield from self.parameters.values()
        for block in self.blocks.values():
            yield from block.cells.values()

    def cell(self, node: str) -> Cell | None:
        """The cell of this name."""
        head, _, tail = node.partition(".")
        if not tail:
            return self.parameters.get(head)
        return self.blocks[head].cells.get(tail) if head in self.blocks else None

    def node(self, name: str) -> str | None:
        """The node from which a name in a relation takes its value; None if nothing is named so."""
        if name in self.assumed or name in self.parameters:
            return name
        head, _, tail = name.partition(".")
        block = self.blocks.get(head)
        if block is None or not tail:
            return None
        if isinstance(block.cls.inputs.get(tail), Choice):
            return None  # a word is no value to calculate with
        if tail in block.cells:
            return name
        if tail in block.cls.inputs or tail in block.cls.formulas:
            return head
        if not (block.is_model and is_measured(tail, block.analyses)):
            return None
        kind, _, output = tail.partition(".")
        return head + SOLID + kind if output else head + SOLID

    def sources(self, node: str) -> set[str]:
        """The nodes from which a node follows directly."""
        if node in self.assumed:
            return set()
        solid, mark, analysis = node.partition(SOLID)
        if mark:
            return {solid + SOLID} if analysis else {solid}
        if node in self.blocks:
            return {cell.name for cell in self.blocks[node].cells.values()}
        cell = self.cell(node)
        return {source for name in (cell.uses if cell else ()) if (source := self.node(name))}

    def names(self) -> list[str]:
        """Every name that a relation may use, for a remedy."""
        inside = (f"{b.name}.{n}" for b in self.blocks.values() for n in (*b.cls.inputs, *b.cls.formulas))
        models = (block for block in self.blocks.values() if block.is_model)
        measured = (f"{model.name}.{n}" for model in models for n in measured_names(model.analyses))
        return [*self.parameters, *inside, *measured]

    @cached_property
    def used(self) -> Mapping[str, tuple[str, ...]]:
        """What relations and iterations use of each block: the names behind its own."""
        heads: dict[str, list[str]] = {}
        for name in sorted(self.assumed.union(*(cell.uses for cell in self.cells()))):
            head, _, tail = name.partition(".")
            heads.setdefault(head, []).append(tail)
        return {head: tuple(tails) for head, tails in heads.items()}

    def wanted(self, model: str, kind: str) -> tuple[str, ...]:
        """The outputs of an analysis that relations or iterations use."""
        return used(kind, self.used.get(model, ()))

    def unit_of(self, name: str) -> str:
        """The declared unit of a name inside a block."""
        head, _, tail = name.partition(".")
        cls = self.blocks[head].cls
        declared = cls.inputs.get(tail) or cls.formulas.get(tail)
        return declared.meaning.unit if declared else measured_unit(tail)


def build_graph(document: Document, catalogues: Catalogues) -> tuple[Graph, list[Fault]]:
    """The net of a document, and everything that is wrong with it before any value is known.

    A graph with faults is good for a preview of what is right, not for a save.
    """
    faults: list[Fault] = list(too_many_relations(document))
    if faults:
        return Graph({}, {}, frozenset()), faults
    parameters = {name: _cell(name, raw, faults) for name, raw in document.parameters.items()}
    blocks = dict(_blocks(document, catalogues, faults))
    graph = Graph(parameters, blocks, frozenset(i.through for i in document.iterations))
    faults += _unknown(graph)
    if not faults:
        faults += _ordered(graph)
    if not faults:
        faults += _kinds(graph)
    return graph, faults


def _cell(name: str, raw: Any, faults: list[Fault]) -> Cell:
    items = raw if isinstance(raw, list) else [raw]
    relations = []
    for item in items:
        try:
            relations += [parse(item)] if is_relation(item) else []
        except FaultyText as error:
            faults.append(error.fault(name))
    return Cell(name, raw, tuple(relations))


def _blocks(document: Document, catalogues: Catalogues, faults: list[Fault]) -> Iterator[tuple[str, Block]]:
    for name, step in document.steps.items():
        if cls := _class(catalogues.templates, f"steps.{name}", step.template, step.version, faults):
            cells = _cells(name, step.inputs, cls, faults)
            outputs = tuple(step.outputs) if step.outputs is not None else None
            yield name, Block(name, cls, cells, step.level, step.tolerance, outputs)
    for name, model in document.models.items():
        if shape := _class(catalogues.models, f"models.{name}", model.id, model.version, faults):
            cells = _cells(name, model.parameters, shape, faults)
            yield name, Block(name, shape, cells, analyses=questions(name, model, shape, faults))


def _class(catalogue: Catalogue[Any], place: str, id: str, version: Any, faults: list[Fault]) -> Any:
    try:
        return catalogue.get(id, version) if isinstance(version, int) else catalogue.latest(id)
    except UnknownTemplate as error:
        faults.append(Fault(place, "unknown_name", str(error)))
        return None


def _cells(
    block: str, values: Mapping[str, Any], cls: type[Template], faults: list[Fault]
) -> dict[str, Cell]:
    unknown = unknown_names((name for name in values if name not in cls.inputs), cls.inputs, "input")
    faults += (fault.within(block) for fault in unknown)
    known = {name: raw for name, raw in values.items() if name in cls.inputs}
    return {name: _cell(f"{block}.{name}", raw, faults) for name, raw in known.items()}


def _unknown(graph: Graph) -> Iterator[Fault]:
    models = {block.name: block.analyses for block in graph.blocks.values() if block.is_model}
    unknown: list[tuple[str, str]] = []  # where, and what
    for cell in graph.cells():
        for name in sorted(cell.uses):
            if graph.node(name) is None and (detail := remedy(name, models)):
                yield Fault(cell.name, "unknown_name", detail)
            elif graph.node(name) is None:
                unknown.append((cell.name, name))
    if unknown:
        faults = unknown_names((name for _, name in unknown), graph.names(), "name")
        yield from (replace(f, name=cell) for (cell, _), f in zip(unknown, faults, strict=True))
    for through in sorted(graph.assumed):
        head, _, measure = through.partition(".")
        if head not in models or not is_measured(measure, models[head]):
            detail = f"an iteration runs through a measure of a model, such as model.mass, not {through}"
            yield Fault("iterations", "unknown_name", remedy(through, models) or detail)


def _ordered(graph: Graph) -> Iterator[Fault]:
    nodes = [cell.name for cell in graph.cells()]
    for name, block in graph.blocks.items():
        nodes += [name, name + SOLID] if block.is_model else [name]
        nodes += [name + SOLID + kind for kind in block.analyses]
    try:
        graph.order = list(TopologicalSorter({node: graph.sources(node) for node in nodes}).static_order())
    except CycleError as error:
        path = list(_told(graph, error.args[1]))
        shown = " → ".join([*path, path[0]])
        detail = f"each follows from the one before it: {shown}; break the loop or declare an iteration"
        yield Fault(next(name for name in path if graph.cell(name)), "loop", detail)


def _told(graph: Graph, cycle: list[str]) -> Iterator[str]:
    """A cycle of nodes (its last is its first) in the names that its relations use."""
    for node, following in pairwise(cycle):
        if graph.cell(node):
            yield node
        elif cell := graph.cell(following):
            yield next(name for name in sorted(cell.uses) if graph.node(name) == node)


def _kinds(graph: Graph) -> Iterator[Fault]:
    """Check the units of every relation, in order, so that a parameter's unit is known before its use."""
    broken: set[str] = set()
    for cell in filter(None, map(graph.cell, graph.order)):
        if not broken.isdisjoint(cell.uses):
            broken.add(cell.name)
            continue
        try:
            _check_kind(graph, cell)
        except FaultyText as error:
            broken.add(cell.name)
            yield error.fault(cell.name)


def _check_kind(graph: Graph, cell: Cell) -> None:
    if cell.name in graph.parameters and not cell.relations:
        graph.kinds[cell.name] = Kind(unit(read_any(cell.raw).unit).base)
        return
    kinds = [
        relation.kind({name: _kind(graph, name) for name in relation.names}) for relation in cell.relations
    ]
    if cell.name in graph.parameters:
        graph.kinds[cell.name] = Kind(kinds[0].base)
        return
    for kind, relation in zip(kinds, cell.relations, strict=True):
        _check_target(graph, cell.name, relation, kind)


def _kind(graph: Graph, name: str) -> Kind:
    if name in graph.parameters:
        return graph.kinds[name]
    return Kind(unit(graph.unit_of(name)).base)


def _check_target(graph: Graph, name: str, relation: Relation, kind: Kind) -> None:
    head, _, tail = name.partition(".")
    declared = graph.blocks[head].cls.inputs[tail]
    if isinstance(declared, Choice):
        raise FaultyText(
            "unit_mismatch", f"{name} is one of {', '.join(declared.options)}; no relation fits it"
        )
    want = declared.meaning.scale
    if compatible(kind.base, want.base) and not (kind.absolute and want.difference):
        return
    given = f"{kind.base:~P}" or "a pure number"
    hint = (
        "; for a speed multiply by 1 rad" if "rad" in f"{want.base}" and "rad" not in f"{kind.base}" else ""
    )
    raise FaultyText("unit_mismatch", f"{relation.text} gives {given}, but {name} is in {want.text}{hint}")


def raise_if(faults: list[Fault]) -> None:
    """Raise what was found, if anything.

    Raises
    ------
    InvalidInputs
        With all faults.
    """
    if faults:
        raise InvalidInputs(faults)
