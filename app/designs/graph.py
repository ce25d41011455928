"""Read a document, build its network, and check it before any calculation.

Every check returns its findings and changes nothing. Units of relations are checked before any value is
known.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import replace
from functools import partial
from graphlib import CycleError, TopologicalSorter
from itertools import chain, filterfalse, pairwise
from typing import TypeVar

from pydantic import ValidationError

from app.catalogue.catalogues import Catalogues
from app.designs.analyses import is_measured, is_table, measured_unit, questions, remedy
from app.designs.choices import Choices
from app.designs.design_worksheet import worksheet_block
from app.designs.document import WORKSHEET, Document, Model, Step, Version
from app.designs.network import (
    LIMITS,
    Block,
    Cell,
    Graph,
    Network,
    Node,
    checked_demands,
    limits_of,
    read_demands,
    unknown_names_in,
)
from app.designs.sizes import in_declared_sizes
from app.plain import Json, Raw
from app.reference import ItemReference, Reference
from templates.core.catalogue.discovery import Catalogue
from templates.core.criteria.limits import GivenLimit, read_limits
from templates.core.errors import Fault, FaultyText, InvalidInputs, UnknownTemplate, plain, unknown_names
from templates.core.language.intake import other_sizes
from templates.core.language.meaning import Meaning
from templates.core.language.spec import Choice, Given, Input
from templates.core.language.template import Template
from templates.core.units.nodes import Kind, kind_of
from templates.core.units.quantity import Value, read, read_any
from templates.core.units.relation import Relation, is_relation, parse
from templates.core.units.units import unit

T = TypeVar("T", bound=Template)

MOST_RELATION_TEXT = 50_000
"""Largest number of characters in all relations of a design; parsing them takes a quarter of a second."""

TOGETHER = "the lines of the worksheet are calculated together"

__all__ = ["Block", "Catalogues", "Cell", "Graph", "build_graph", "raise_if"]


def build_graph(document: Document, catalogues: Catalogues) -> tuple[Graph, list[Fault]]:
    """Return the network of a document, and all faults that can be found before any value is known.

    The valid parts of a network with faults can still be previewed, but it cannot be saved.
    """
    if faults := list(too_many_relations(document)):
        return Graph({}, {}, frozenset()), faults
    network, faults = _network(document, catalogues)
    unread = {
        *document.steps,
        *document.models,
        *([WORKSHEET] if document.worksheet else []),
    } - network.blocks.keys()  # relations that use them are not reported
    links = {cell: _links(network, cell, unread) for cell in network.cells() if cell.uses}
    unknown = [
        *_unknown(network, links),
        *unknown_names_in(network, unread),
        *_unknown_columns(network, unread),
    ]
    if faults := [*faults, *unknown]:
        return _graph(network), faults
    sources = _sources(network, links)
    order, faults = ordered(network, sources)
    if faults:
        return _graph(network, sources), faults
    kinds, faults = checked_kinds(network, (node for node in order if isinstance(node, Cell)))
    demands, wrong = checked_demands(network, kinds)
    return _graph(replace(network, demands=demands), sources, order, kinds), [*faults, *wrong]


def _graph(
    network: Network,
    sources: Mapping[Node, tuple[Node, ...]] | None = None,
    order: Sequence[Node] = (),
    kinds: Mapping[str, Kind] | None = None,
) -> Graph:
    return Graph(
        network.parameters,
        network.blocks,
        network.assumed,
        network.demands,
        network.columns,
        sources or {},
        order,
        kinds or {},
    )


def _network(document: Document, catalogues: Catalogues) -> tuple[Network, list[Fault]]:
    """Return the parameters and blocks of a document, and the faults of all that cannot be read."""
    faults: list[Fault] = []
    parameters: dict[str, Cell] = {}
    choices = Choices(document, catalogues)
    for name, raw in document.parameters.items():
        parameters[name], wrong = _cell(choices, Reference(name), name, raw)
        faults += wrong
    blocks: dict[str, Block] = {}
    for block, wrong in _blocks(choices):
        blocks |= {block.name: block} if block else {}
        faults += wrong
    assumed = frozenset(Reference.parse(iteration.through) for iteration in document.iterations)
    if document.worksheet:
        without = Network(parameters, blocks, assumed)
        block, wrong = worksheet_block(document.worksheet, without, partial(_kind_of_parameter, without))
        blocks |= {block.name: block} if block else {}
        faults += wrong
    demands, wrong = read_demands(document, blocks)
    columns = tuple(map(ItemReference.parse, document.table.columns))
    return Network(parameters, blocks, assumed, demands, columns), [*faults, *wrong]


def _cell(
    choices: Choices, reference: Reference, name: str, raw: Raw, declared: Input | None = None
) -> tuple[Cell, list[Fault]]:
    """Return a cell with the relations that can be read, and the faults of the others."""
    if isinstance(raw, list):
        texts = [item for item in raw if is_relation(item)]
    else:
        texts = [raw] if "=" in str(raw) and is_relation(raw) else []  # most cells are plain quantities
    if not texts:
        return Cell(reference, name, raw, declared=declared), []
    relations: list[Relation] = []
    faults: list[Fault] = []
    for text in texts:
        try:
            relation = parse(text)
            relations.append(choices.decided(relation) if relation.choices else relation)
        except FaultyText as error:
            faults.append(error.fault(name))
    names = relations[0].names if len(relations) == 1 else {n for one in relations for n in one.names}
    uses = {used: Reference.parse(used) for used in sorted(names)}
    return Cell(reference, name, raw, tuple(relations), uses, declared), faults


def _blocks(choices: Choices) -> Iterator[tuple[Block | None, list[Fault]]]:
    """Yield every step and every model with its faults; the block is None if its template is unknown."""
    for name, step in choices.document.steps.items():
        yield _step(choices, name, step)
    for name, model in choices.document.models.items():
        yield _model(choices, name, model)


def _step(choices: Choices, name: str, step: Step) -> tuple[Block | None, list[Fault]]:
    cls, faults = _class(choices.catalogues.templates, f"steps.{name}", step.template, step.version)
    if cls is None:
        return None, faults
    cells, faults = _cells(choices, name, step.inputs, cls)
    outputs = None if step.outputs is None else tuple(step.outputs)
    related, wrong = _related_limits(choices, name, step, cls)
    faults += wrong
    limits, wrong = _limits(name, {n: raw for n, raw in step.limits.items() if n not in related}, cls)
    return Block(name, cls, cells, step.level, step.tolerance, outputs, limits, related), [*faults, *wrong]


def _related_limits(
    choices: Choices, name: str, step: Step, cls: type[Template]
) -> tuple[dict[str, Cell], list[Fault]]:
    """Return the limits of a step that relations set; `_limits` reads the others."""
    cells: dict[str, Cell] = {}
    faults: list[Fault] = []
    if not step.limits:
        return cells, faults
    for tail in step.limits.keys() & limits_of(cls).keys():
        if has_relation(raw := step.limits[tail]):
            declared = limits_of(cls)[tail]
            given = Given(Meaning(words=declared.words, unit=declared.unit, name=tail))
            cells[tail], wrong = _cell(
                choices, Reference(name, LIMITS, tail), f"{name}.{LIMITS}.{tail}", raw, given
            )
            faults += wrong
    return cells, faults


def _limits(
    name: str, raw: Mapping[str, Raw], cls: type[Template]
) -> tuple[dict[str, GivenLimit], list[Fault]]:
    """Return the limits of a step that are quantities or come from a library row, and the faults."""
    try:
        return read_limits(cls.declared_criteria, raw), []
    except InvalidInputs as error:
        return {}, [fault.within(name) for fault in error.faults]


def _model(choices: Choices, name: str, model: Model) -> tuple[Block | None, list[Fault]]:
    cls, faults = _class(choices.catalogues.models, f"models.{name}", model.id, model.version)
    if cls is None:
        return None, faults
    cells, faults = _cells(choices, name, model.parameters, cls)
    analyses, wrong = questions(name, model, cls)
    return Block(name, cls, cells, analyses=analyses), [*faults, *wrong]


def _class(
    catalogue: Catalogue[T], place: str, id: str, version: Version
) -> tuple[type[T] | None, list[Fault]]:
    try:
        cls = catalogue.get(id, version) if isinstance(version, int) else catalogue.latest(id)
    except UnknownTemplate as error:
        return None, [Fault(place, error.code, str(error))]
    return cls, []


def _cells(
    choices: Choices, block: str, values: Mapping[str, Raw], cls: type[Template]
) -> tuple[dict[str, Cell], list[Fault]]:
    """Return the cells of a block, and a fault for each unknown name."""
    cells: dict[str, Cell] = {}
    unknown = unknown_names(filterfalse(cls.inputs.__contains__, values), cls.inputs, "input")
    faults = [fault.within(block) for fault in unknown]
    for name, raw in values.items():
        if declared := cls.inputs.get(name):
            cells[name], wrong = _cell(
                choices, Reference(block, None, name), f"{block}.{name}", raw, declared
            )
            faults += wrong
    return cells, faults


def _links(network: Network, cell: Cell, unread: Set[str]) -> dict[Reference, Node | None]:
    """Return the node of each name that a cell uses, or None if there is no such node.

    Values that iterations assume are omitted.
    """
    return {
        reference: network.node(reference)
        for reference in cell.uses.values()
        if reference not in network.assumed and reference.block not in unread
    }


Links = Mapping[Cell, Mapping[Reference, Node | None]]


def _unknown(network: Network, links: Links) -> Iterator[Fault]:
    """Yield a fault for each unknown name in relations and in iterations."""
    models = {block.name: block.analyses for block in network.blocks.values() if block.is_model}
    unknown: list[tuple[str, str]] = []  # the cell, and the unknown name in it
    for cell, linked in links.items():
        for reference, node in linked.items():
            if node is not None:
                continue
            if detail := remedy(reference, models):
                yield Fault(cell.name, "unknown_name", detail)
            else:
                unknown.append((cell.name, str(reference)))
    if unknown:
        faults = unknown_names((name for _, name in unknown), network.names(), "name")
        yield from (replace(f, name=cell) for (cell, _), f in zip(unknown, faults, strict=True))
    for through in sorted(network.assumed, key=str):
        if is_table(through):
            detail = f"an iteration needs a single value; {through} is a table or a list"
            yield Fault("iterations", "not_a_number", detail)
        elif through.block not in models or not is_measured(
            through, models[through.block], network.blocks[through.block].cls
        ):
            detail = f"an iteration needs a measurement of a model, such as `model.mass`, not {through}"
            yield Fault("iterations", "unknown_name", remedy(through, models) or detail)


def _unknown_columns(network: Network, unread: Set[str]) -> Iterator[Fault]:
    """Yield a fault for each column of the table of results that names no value of the design."""
    models = {block.name: block.analyses for block in network.blocks.values() if block.is_model}
    columns = dict.fromkeys(column.reference for column in network.columns)
    unknown = [one for one in columns if one.block not in unread and not network.has(one)]
    faults = unknown_names(map(str, unknown), network.names(), "value")
    for reference, fault in zip(unknown, faults, strict=True):
        yield Fault("table.columns", fault.code, remedy(reference, models) or fault.detail)


def _sources(network: Network, links: Links) -> dict[Node, tuple[Node, ...]]:
    """Return the nodes on which each node depends directly."""
    sources: dict[Node, tuple[Node, ...]] = dict.fromkeys(network.cells(), ())
    for cell, linked in links.items():
        sources[cell] = tuple(dict.fromkeys(filter(None, linked.values())))
    for block in network.blocks.values():
        sources[block] = tuple(block.cells.values())
        if block.is_model:
            sources[block.solid] = (block,)
            sources |= dict.fromkeys(block.analysed.values(), (block.solid,))
    return sources


def raise_if(faults: list[Fault]) -> None:
    """Raise InvalidInputs if there are any faults.

    Raises
    ------
    InvalidInputs
        If there are faults; the error lists all of them.
    """
    if faults:
        raise InvalidInputs(faults)


def too_many_relations(document: Document) -> Iterator[Fault]:
    """Yield a fault if the total length of a design's relations exceeds the limit."""
    texts = [item for item in _items(document) if isinstance(item, str)]
    required = sum(len(criterion.require or "") for criterion in document.criteria.values())
    if required + sum(map(len, texts)) <= MOST_RELATION_TEXT:
        return
    length = required + sum(len(text) for text in texts if is_relation(text))
    if length > MOST_RELATION_TEXT:
        most = f"at most {MOST_RELATION_TEXT} characters in total, not {length}"
        message = f"the relations and criteria of a design have {most}"
        yield Fault("design", "too_long", message)


def _items(document: Document) -> Iterator[Raw]:
    """Return every value of a document, with the items of lists one by one."""
    groups = [document.parameters]
    groups += [group for step in document.steps.values() for group in (step.inputs, step.limits)]
    groups += [model.parameters for model in document.models.values()]
    groups += document.variants.values()
    values = chain.from_iterable(group.values() for group in groups)
    return chain.from_iterable(value if isinstance(value, list) else (value,) for value in values)


def has_relation(raw: Raw) -> bool:
    """Return whether a value is a relation, or a list that contains one."""
    return any(map(is_relation, raw)) if isinstance(raw, list) else is_relation(raw)


def ordered(
    network: Network, sources: Mapping[Node, tuple[Node, ...]]
) -> tuple[tuple[Node, ...], list[Fault]]:
    """Return all nodes in dependency order; if there is a loop, no nodes and a fault that names it."""
    try:
        return tuple(TopologicalSorter(sources).static_order()), []
    except CycleError as error:
        cycle: Sequence[Node] = error.args[1]
        path = list(_named(network, cycle))
    shown = " → ".join([*path, path[0]])
    has_lines = any(isinstance(node, Block) and node.is_worksheet for node in cycle)
    lines = f"; {TOGETHER}" if has_lines else ""
    detail = f"each depends on the one before it: {shown}{lines}; break the loop or declare an iteration"
    cells = {cell.name for cell in network.cells()}
    return (), [Fault(next(name for name in path if name in cells), "loop", detail)]


def _named(network: Network, cycle: Sequence[Node]) -> Iterator[str]:
    """Yield the names along a cycle of nodes as its relations use them; the last node equals the first."""
    for node, following in pairwise(cycle):
        if isinstance(node, Cell):
            yield node.name
        elif isinstance(following, Cell):
            yield next(name for name, used in following.uses.items() if network.node(used) is node)


def checked_kinds(network: Network, cells: Iterable[Cell]) -> tuple[dict[str, Kind], list[Fault]]:
    """Return the kind of each parameter, and a fault for each relation whose units do not fit.

    The cells come in dependency order, so that the unit of a parameter is known before its use.
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


def _kind_of_parameter(network: Network, name: str) -> Kind:
    """Return the kind of a parameter before the whole network is known.

    Raises
    ------
    FaultyText
        If its relations have a fault, form a loop, or use a result of the worksheet; the code is then `loop`.
    """
    before: dict[str, set[str]] = {}
    left = [name]
    while left:
        if (one := left.pop()) not in before:
            uses = network.parameters[one].uses
            if own := next((used for used, at in uses.items() if at.block == WORKSHEET), None):
                detail = f"{own} → {one} → {WORKSHEET}: {TOGETHER}"
                raise FaultyText("loop", f"{detail}; let {one} follow from something else")
            before[one] = uses.keys() & network.parameters.keys()
            left += before[one]
    kinds: dict[str, Kind] = {}
    try:
        for one in TopologicalSorter(before).static_order():
            kinds[one] = _kind(network, kinds, network.parameters[one])
    except (CycleError, KeyError):
        raise FaultyText("unknown_name", f"{name} has no value: see the fault of its relation") from None
    return kinds[name]


def _kind(network: Network, kinds: Mapping[str, Kind], cell: Cell) -> Kind:
    """Return the kind of a cell.

    Raises
    ------
    FaultyText
        If its relations do not fit the declared unit.
    """
    if not cell.relations:
        return kind_of(read_any(cell.raw).unit, cell.name)
    used = {
        name: kinds[name] if name in network.parameters else network.kind_of(reference)
        for name, reference in cell.uses.items()
    }
    if cell.declared is not None:
        for relation in cell.relations:
            _check_target(cell, relation, used)
    kind = replace(cell.relations[0].kind(used), literal=False, pi=0, twos=frozenset())
    if cell.declared is None:
        _check_steps(cell, kind, kind.unit)
    return kind


def _check_target(cell: Cell, relation: Relation, used: Mapping[str, Kind]) -> None:
    declared = cell.declared
    assert declared is not None
    if isinstance(declared, Choice):
        message = f"{cell.name} is one of {', '.join(declared.options)}; a relation cannot set it"
        raise FaultyText("unit_mismatch", message)
    if why := relation.misfit(used, declared.meaning.accepted):
        raise FaultyText("unit_mismatch", f"{cell.name} is in {declared.meaning.unit}{why}")
    _check_steps(cell, kind_of(declared.meaning.accepted), declared.meaning.unit)


def _check_steps(cell: Cell, kind: Kind, shown: str) -> None:
    for rounding in cell.roundings:
        if why := rounding.misfit(kind, shown):
            raise FaultyText("unit_mismatch", f"{cell.name} is in {shown}{why}")


LONGEST_PLACE = 200  # characters of the place in a fault


def read_document(raw: Mapping[str, Raw]) -> Document:
    """Return a document from JSON.

    Raises
    ------
    InvalidInputs
        If parts do not have the form of a design; the error names all of them.
    """
    try:
        return Document.model_validate(raw)
    except ValidationError as error:
        raise InvalidInputs(map(_fault, error.errors(include_url=False, include_input=False))) from None


def _fault(error: Mapping[str, Json]) -> Fault:
    place = ".".join(str(part)[:LONGEST_PLACE] for part in error["loc"])
    return Fault(plain(place, LONGEST_PLACE) or "design", error["type"], error["msg"])


def resolved(document: Document, catalogues: Catalogues) -> Document:
    """Return the document with pinned versions, and every size under the name that its step declares.

    Both are resolved once, when the user adds a step or model.
    """
    pinned = _pinned(document, catalogues)
    pairs = {f"{step}.{other}": f"{step}.{name}" for step, other, name in _other_sizes(pinned, catalogues)}
    return in_declared_sizes(pinned, pairs) if pairs else pinned


def _other_sizes(document: Document, catalogues: Catalogues) -> Iterator[tuple[str, str, str]]:
    """Yield step, typed name and declared name of each size that a document gives under another name."""
    overridden = {place for overrides in document.variants.values() for place in overrides}
    for name, step in document.steps.items():
        cls, _ = _class(catalogues.templates, name, step.template, step.version)
        for other, declared in other_sizes(cls) if cls else ():
            if other in step.inputs or f"{name}.{other}" in overridden:
                yield name, other, declared


def _pinned(document: Document, catalogues: Catalogues) -> Document:
    """Return the document with every version pinned."""
    versions = [step.version for step in document.steps.values()]
    versions += [model.version for model in document.models.values()]
    if all(isinstance(version, int) for version in versions):
        return document
    plain = document.model_copy(deep=True)
    for step in plain.steps.values():
        if not isinstance(step.version, int) and step.template in catalogues.templates.ids:
            step.version = catalogues.templates.latest(step.template).version
    for model in plain.models.values():
        if not isinstance(model.version, int) and model.id in catalogues.models.ids:
            model.version = catalogues.models.latest(model.id).version
    return plain


def starts(document: Document) -> dict[Reference, float]:
    """Return the starting values [SI] of a document's iterations.

    Raises
    ------
    InvalidInputs
        If a start is not a quantity of the same kind as its measurement.
    """
    faults, values = list[Fault](), dict[Reference, float]()
    for iteration in document.iterations:
        through = Reference.parse(iteration.through)
        try:
            values[through] = _single(read(iteration.start, measured_unit(through)).si)
        except FaultyText as error:
            faults.append(error.fault("iterations.start"))
    raise_if(faults)
    return values


def settled(results: Mapping[str, list[Mapping[str, Raw]]] | None) -> dict[Reference, float]:
    """Return the final values [SI] of a revision's iterations, from its stored results."""
    rounds = (results or {}).get("iterations", [])
    values = {str(one["through"]): (float(str(one["assumed"])), str(one["unit"])) for one in rounds}
    return {Reference.parse(name): float(unit(scale).to_si(value)) for name, (value, scale) in values.items()}


def _single(value: Value) -> float:
    if not isinstance(value, float):
        raise FaultyText("not_a_number", "give a single value here, not an array")
    return value
