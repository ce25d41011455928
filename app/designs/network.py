"""The network of a design: the dependencies between its values.

Its nodes are cells (the values that a user wrote, such as `scale` or `film.radial_load`), blocks (steps and
models), solids (built models) and analyses of solids. A block depends on its cells, and its outputs depend on
the block. Measurements depend on the solid.

Criteria refer to values of the network. A name without a dot is a criterion of the design itself, which needs
`require`. `film.pressure` is the criterion `pressure` of the template of step `film`: the design may replace
its comparison, words or source, or waive it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field, replace
from functools import cached_property

from app.designs.analyses import is_measured, is_table, measured_names, measured_unit, used
from app.designs.document import Document, WrittenCriterion
from app.plain import Raw
from app.reference import ItemReference, Reference
from app.solids.questions import Question
from cad.model import CadModel
from templates.core.criteria.criterion import (
    Criterion,
    Limit,
    MissingValue,
    NameDescription,
    read_comparison,
    read_criterion,
)
from templates.core.criteria.limits import GivenLimit
from templates.core.errors import Fault, FaultyText, unknown_name, unknown_names
from templates.core.language.spec import Choice, Declaration, Formula, Input, Table, Text
from templates.core.language.template import Template
from templates.core.units.nodes import Kind, kind_of
from templates.core.units.quantity import read_any
from templates.core.units.relation import Relation
from templates.core.units.rounding import Rounding

LIMITS = "limits"  # marks a reference to a limit, at the position of an analysis name: film.limits.pressure


@dataclass(frozen=True, eq=False)
class Cell:
    """One value as its user wrote it, with its relations (a list may have several) and the names they use.

    `declared` is the input or limit of a block that the cell sets; None for a parameter of the design.
    """

    reference: Reference
    name: str
    raw: Raw
    relations: tuple[Relation, ...] = ()
    uses: Mapping[str, Reference] = field(default_factory=dict)
    declared: Declaration | None = None

    @cached_property
    def tests(self) -> Mapping[str, Reference]:
        """Return the choices that the relations test; their results are already resolved."""
        return {name: Reference.parse(name) for relation in self.relations for name in relation.decided_by}

    @cached_property
    def roundings(self) -> tuple[Rounding, ...]:
        """Return the rules by which its relations are rounded."""
        return tuple(one.rounding for one in self.relations if one.rounding is not None)

    @cached_property
    def calculated(self) -> Cell:
        """Return the cell without its roundings."""
        texts = {relation.text: relation.calculated.text for relation in self.relations}
        items = self.raw if isinstance(self.raw, list) else [self.raw]
        bare = [texts.get(item.strip(), item) if isinstance(item, str) else item for item in items]
        raw = bare if isinstance(self.raw, list) else bare[0]
        return replace(self, raw=raw, relations=tuple(one.calculated for one in self.relations))

    @cached_property
    def relations_by_text(self) -> Mapping[str, Relation]:
        """Return the relations by their text, in the order of list items."""
        return {relation.text: relation for relation in self.relations}


@dataclass(frozen=True, eq=False)
class Block:
    """A step or a model: a template and the cells that are set.

    `limits` of its criteria are known at once; `related` limits are set by relations. No value of the block
    depends on a limit.
    """

    name: str
    cls: type[Template]
    cells: dict[str, Cell]
    level: str | None = None
    tolerance: float | None = None
    outputs: tuple[str, ...] | None = None
    limits: Mapping[str, GivenLimit] = field(default_factory=dict)
    related: Mapping[str, Cell] = field(default_factory=dict)
    analyses: Mapping[str, Question] = field(default_factory=dict)

    @cached_property
    def is_model(self) -> bool:
        """Return whether the block is a CAD model."""
        return issubclass(self.cls, CadModel)

    @property
    def is_worksheet(self) -> bool:
        """Return whether the block is the design's own worksheet, whose inputs are values of the design."""
        return self.cls.sheet is not None and self.cls.sheet.is_exact

    @cached_property
    def solid(self) -> Solid:
        """Return the node of the model's solid."""
        return Solid(self)

    @cached_property
    def analysed(self) -> Mapping[str, SolidAnalysis]:
        """Return the nodes of the analyses that a model declares, by kind."""
        return {kind: SolidAnalysis(self, kind) for kind in self.analyses}


@dataclass(frozen=True, eq=False)
class Solid:
    """A model's built solid."""

    model: Block


@dataclass(frozen=True, eq=False)
class SolidAnalysis:
    """A finite-element analysis of a solid."""

    model: Block
    kind: str


@dataclass(frozen=True, eq=False)
class Demand:
    """A criterion in the document of a design.

    `criterion` is set once the kinds of all parameters are known. It stays None if the entry only changes the
    words of a template's criterion.
    """

    name: str
    written: WrittenCriterion
    uses: Mapping[str, Reference] = field(default_factory=dict)
    criterion: Criterion | None = None


Node = Cell | Block | Solid | SolidAnalysis


@dataclass(frozen=True)
class Network:
    """The parameters and blocks of one document; resolves the names that refer to them."""

    parameters: dict[str, Cell]
    blocks: dict[str, Block]
    assumed: frozenset[Reference]  # the measurements that declared iterations assume
    demands: Mapping[str, Demand] = field(default_factory=dict)  # criteria written in the design
    columns: tuple[ItemReference, ...] = ()  # of the table of results, if the design chooses them

    def cells(self) -> Iterator[Cell]:
        """Yield every cell of the design."""
        yield from self.parameters.values()
        for block in self.blocks.values():
            yield from block.cells.values()
            yield from block.related.values()

    def cell(self, reference: Reference) -> Cell | None:
        """Return the cell with this name."""
        if reference.output is None:
            return self.parameters.get(reference.block)
        block = self.blocks.get(reference.block)
        if block is None:
            return None
        if reference.analysis == LIMITS:
            return block.related.get(reference.output)
        return block.cells.get(reference.member)

    def node(self, reference: Reference) -> Node | None:
        """Return the node that provides the value of a name; None if there is none."""
        block, output = self.blocks.get(reference.block), reference.output
        if block is None or output is None:
            return self.parameters.get(reference.block) if output is None else None
        if reference.analysis is None and (cell := block.cells.get(output)):
            return None if isinstance(cell.declared, Choice) else cell  # a choice has no numeric value
        if declared := _declared(block, reference):
            return None if isinstance(declared, Choice) else block
        if not (block.is_model and is_measured(reference, block.analyses, block.cls)):
            return None
        return block.analysed[reference.analysis] if reference.analysis else block.solid

    def has(self, reference: Reference) -> bool:
        """Return whether a name refers to a value of the design: a number, an array or a choice."""
        block = self.blocks.get(reference.block)
        is_declared = block is not None and _declared(block, reference) is not None
        return is_declared or self.node(reference) is not None

    def names(self) -> list[str]:
        """Return every name that a relation may use, for error messages."""
        inside = (f"{b.name}.{n}" for b in self.blocks.values() for n in (*b.cls.inputs, *b.cls.formulas))
        models = (block for block in self.blocks.values() if block.is_model)
        measured = (
            f"{model.name}.{n}" for model in models for n in measured_names(model.analyses, model.cls)
        )
        return [*self.parameters, *inside, *measured]

    @cached_property
    def used(self) -> Mapping[str, tuple[Reference, ...]]:
        """Return the references to each block in relations, iterations, criteria and the table of results.

        They are ordered by name. A measure of a solid in the table is read from its build, if there is one.
        """
        shown = (column.reference for column in self.columns)
        columns = (one for one in shown if one.analysis or not self._is_model(one.block))
        names = {str(reference): reference for reference in (*self.assumed, *columns)}
        for cell in self.cells():
            names.update(cell.uses)
        for demand in self.demands.values():
            names.update(demand.uses)
        blocks: dict[str, list[Reference]] = {}
        for name in sorted(names):
            blocks.setdefault(names[name].block, []).append(names[name])
        return {block: tuple(references) for block, references in blocks.items()}

    def _is_model(self, name: str) -> bool:
        block = self.blocks.get(name)
        return block is not None and block.is_model

    def computed(self, step: Block) -> tuple[str, ...] | None:
        """Return the outputs that a step computes: all (None), or those that are requested or used."""
        if step.outputs is None:
            return None
        linked = (reference.member for reference in self.used.get(step.name, ()))
        return tuple(dict.fromkeys([*step.outputs, *(name for name in linked if name in step.cls.formulas)]))

    def wanted(self, model: str, kind: str) -> tuple[str, ...]:
        """Return the outputs of an analysis that relations, iterations or criteria use."""
        return used(kind, self.used.get(model, ()))

    def unit_of(self, reference: Reference) -> str:
        """Return the declared unit of a name inside a block."""
        declared = _declared(self.blocks[reference.block], reference)
        return declared.meaning.unit if declared else measured_unit(reference)

    def accepted(self, reference: Reference) -> str:
        """Return the unit that determines in which units a user may type a value for a name in a block."""
        declared = _declared(self.blocks[reference.block], reference)
        return declared.meaning.accepted if declared else measured_unit(reference)

    def kind_of(self, reference: Reference) -> Kind:
        """Return the kind of quantity of a name inside a block."""
        return kind_of(self.accepted(reference), str(reference))


def limits_of(cls: type[Template]) -> dict[str, Limit]:
    """Return the limits that a user may set for the criteria of a template, by name."""
    return {limit.name: limit for criterion in cls.declared_criteria for limit in criterion.limits}


def _declared(block: Block, reference: Reference) -> Input | Formula[Template] | None:
    """Return the input or formula of a block to which a reference points; None for a measurement."""
    if reference.analysis is not None or reference.output is None:
        return None
    return block.cls.inputs.get(reference.output) or block.cls.formulas.get(reference.output)


@dataclass(frozen=True)
class Graph(Network):
    """A checked network, with its nodes in calculation order."""

    sources: Mapping[Node, tuple[Node, ...]] = field(
        default_factory=dict
    )  # the nodes on which each node depends directly
    order: Sequence[Node] = ()
    kinds: Mapping[str, Kind] = field(default_factory=dict)  # kinds of the parameters


@dataclass(frozen=True)
class Subject:
    """A criterion of a design: from a step's template, or written in the design itself."""

    criterion: Criterion
    block: Block | None
    demand: Demand | None

    @cached_property
    def references(self) -> Mapping[str, Reference]:
        """Return the values that the criterion uses; of its limits, only those that relations set."""
        if self.block is None:
            return self.demand.uses if self.demand else {}
        limits = self.criterion.limits_by_name
        values = {n: Reference(self.block.name, None, n) for n in self.criterion.names if n not in limits}
        return values | {n: cell.reference for n, cell in self.block.related.items() if n in limits}

    @cached_property
    def instead(self) -> tuple[tuple[MissingValue, Subject], ...]:
        """Return the comparisons that are judged instead of this one if a value is missing."""
        every = self.criterion.absent.values()
        return tuple((one, Subject(one.instead, self.block, None)) for one in every if one.instead)

    def is_due(self, graph: Graph) -> bool:
        """Return whether the outputs that the design computes suffice to judge the criterion."""
        if self.block is None or self.block.is_model:
            return True
        computed = graph.computed(self.block)
        outputs = self.block.cls.formulas.keys() - self.block.cells.keys()
        return computed is None or outputs.intersection(self.criterion.names).issubset(computed)


def subjects(graph: Graph) -> dict[str, Subject]:
    """Return all criteria by name; those of templates include the design's changes."""
    by_name: dict[str, Subject] = {}
    for block in graph.blocks.values():
        for criterion in block.cls.declared_criteria:
            name = f"{block.name}.{criterion.name}"
            by_name[name] = Subject(criterion, block, graph.demands.get(name))
    for name, demand in graph.demands.items():
        if demand.criterion is not None:
            by_name[name] = Subject(demand.criterion, None, demand)
    return by_name


def read_demands(document: Document, blocks: Mapping[str, Block]) -> tuple[dict[str, Demand], list[Fault]]:
    """Return the criteria of a document with the names that they use, and the faults of unreadable ones."""
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
    """Return whether a criterion belongs to a step with an unknown template, which has its own fault."""
    criterion = Reference.parse(name)
    is_of_step = criterion.output is not None and criterion.block in document.steps
    return is_of_step and criterion.block not in blocks


def _require_subject(name: str, written: WrittenCriterion, blocks: Mapping[str, Block]) -> None:
    """Check that a criterion exists in a template, or is a criterion of the design with `require`.

    Raises
    ------
    FaultyText
        If it is neither.
    """
    criterion = Reference.parse(name)
    if criterion.output is None:
        if written.require is None:
            form = "give `require`, such as `film.minimum_film_thickness >= 3 um`"
            raise FaultyText("missing", f"a criterion of the design compares two values: {form}")
        return
    block = blocks.get(criterion.block)
    names = [declared.name for declared in block.cls.declared_criteria] if block else []
    if criterion.member not in names:
        there = [f"{b.name}.{c.name}" for b in blocks.values() for c in b.cls.declared_criteria]
        detail = (
            unknown_name(name, there, "criterion").detail
            if there
            else "no template in this design has criteria"
        )
        raise FaultyText("unknown_name", f"{detail}; the name of a design's criterion must not contain a dot")


def _uses(require: str | None) -> dict[str, Reference]:
    if require is None:
        return {}
    value, _, limit = read_comparison(require)
    return {name: Reference.parse(name) for name in sorted(value.names | limit.names)}


def unknown_names_in(network: Network, unread: Set[str] = frozenset()) -> list[Fault]:
    """Return a fault for every name in a criterion of the design that does not refer to a number.

    `unread` are blocks with an unknown template, which have their own faults.
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
    """Check the units of criteria against the kinds of parameters; return the criteria and the faults."""
    demands: dict[str, Demand] = {}
    faults: list[Fault] = []
    for name, demand in network.demands.items():
        if demand.written.require is None or not _parameters(network, demand) <= kinds.keys():
            demands[name] = demand  # a parameter of unknown kind is reported already
            continue
        try:
            demands[name] = replace(demand, criterion=_checked(network, kinds, demand))
        except FaultyText as error:
            faults.append(fault_of(name, error))
    return demands, faults


def _is_value(network: Network, reference: Reference) -> bool:
    """Return whether a name refers to a number rather than to a word or a table."""
    if reference in network.assumed:
        return True
    if network.node(reference) is None or is_table(reference):
        return False
    block = network.blocks.get(reference.block)
    declared = block and (block.cls.inputs.get(reference.member) or block.cls.formulas.get(reference.member))
    return not isinstance(declared, (Text, Table))


def _parameters(network: Network, demand: Demand) -> set[str]:
    return {name for name in demand.uses if name in network.parameters}


def _checked(network: Network, kinds: Mapping[str, Kind], demand: Demand) -> Criterion:
    meanings = {name: _meaning(network, kinds, name, reference) for name, reference in demand.uses.items()}
    written = demand.written
    parts = {"require": written.require, "words": written.words, "source": written.source}
    return read_criterion(demand.name, {key: part for key, part in parts.items() if part}, meanings)


def _meaning(network: Network, kinds: Mapping[str, Kind], name: str, reference: Reference) -> NameDescription:
    """Return the display unit, the description and the kind of a value."""
    if cell := network.parameters.get(name):
        typed = None if cell.relations else read_any(cell.raw).unit
        return NameDescription(typed or kinds[name].unit, name.replace("_", " "), kinds[name])
    block = network.blocks[reference.block]
    declared = block.cls.inputs.get(reference.member) or block.cls.formulas.get(reference.member)
    words = declared.meaning.words if declared else name
    return NameDescription(network.unit_of(reference), words, network.kind_of(reference))


def fault_of(name: str, error: FaultyText) -> Fault:
    """Return an error in a criterion as a fault, with its place in the document."""
    return error.fault(f"criteria.{name}")
