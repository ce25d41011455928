"""The dependencies in a design for display: blocks in columns, relations, and usable names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from hashlib import sha256
from threading import Lock
from typing import Literal

from cachetools import LRUCache

from app.catalogue.catalogues import Catalogues
from app.catalogue.team import Snapshot
from app.designs.analyses import measured_names, measured_unit
from app.designs.graph import build_graph, read_document, resolved
from app.designs.network import LIMITS, Block, Cell, Graph
from app.designs.result_cells import columns_of
from app.designs.schemas.network import DesignNetwork, NetworkBlock, NetworkName, NetworkRelation
from app.plain import Raw
from app.reference import Reference
from app.storage.tables import canonical_json
from templates.core.language.spec import Choice, Declaration
from templates.core.units.relation import is_relation
from templates.core.units.units import dimension_of, unit

Columns = Mapping[str, int]

KEPT = 20_000  # largest total of names and relations in the cached networks
_kept: LRUCache[bytes, tuple[Snapshot, DesignNetwork]] = LRUCache(
    KEPT, getsizeof=lambda kept: len(kept[1].names) + len(kept[1].relations)
)
"""Networks by the digest of their document, each with the catalogue from which it was built; read only."""
_keeping = Lock()


def network(document: Mapping[str, Raw], catalogues: Catalogues) -> DesignNetwork:
    """Return the dependencies in a stored document; cached by document and catalogue."""
    digest, snapshot = sha256(canonical_json(document).encode()).digest(), catalogues.snapshot
    with _keeping:
        of, kept = _kept.get(digest, (None, None))
    if kept is None or of is not snapshot:
        graph, _ = build_graph(resolved(read_document(document), catalogues), catalogues)
        kept = network_of(graph)
        if len(kept.names) + len(kept.relations) <= KEPT:
            with _keeping:
                _kept[digest] = snapshot, kept
    return kept


def network_of(graph: Graph) -> DesignNetwork:
    """Return the dependencies in a checked network."""
    columns = _columns(graph)
    return DesignNetwork(
        blocks=[NetworkBlock(name=name, kind=_kind(graph, name), column=columns[name]) for name in columns],
        relations=list(_relations(graph, columns)),
        names=list(_names(graph)),
        table=list(map(str, columns_of(graph))),
    )


def _columns(graph: Graph) -> dict[str, int]:
    """Return the column of every parameter and block, in the order of calculation.

    A step that uses an input of a later block does not depend on that block, nor on a value assumed in an
    iteration.
    """
    columns: dict[str, int] = {}
    for name in _ordered(graph):
        sources = (source.block for cell in _cells(graph, name) for source in _sources(cell).values())
        columns[name] = max((columns[source] + 1 for source in sources if source in columns), default=0)
    return columns


def _ordered(graph: Graph) -> Iterator[str]:
    """Yield the names of parameters and blocks in calculation order, or else in document order."""
    nodes = graph.order or (*graph.parameters.values(), *graph.blocks.values())
    for node in nodes:
        if isinstance(node, Block) or (isinstance(node, Cell) and node.declared is None):
            yield node.name


def _cells(graph: Graph, name: str) -> list[Cell]:
    """Return the cells of a block, or the cell of a parameter."""
    block = graph.blocks.get(name)
    return list(block.cells.values()) if block else [graph.parameters[name]]


def _kind(graph: Graph, name: str) -> Literal["parameter", "step", "model"]:
    if name not in graph.blocks:
        return "parameter"
    return "model" if graph.blocks[name].is_model else "step"


def _relations(graph: Graph, columns: Columns) -> Iterator[NetworkRelation]:
    """Yield one entry for every name in a relation that refers to an existing block."""
    for cell in graph.cells():
        target = cell.reference.block
        for name, source in _sources(cell).items():
            if source.block in columns and not (cell.reference.analysis == LIMITS and source.block == target):
                forward = columns[source.block] < columns[target]
                yield NetworkRelation(target=cell.name, source=name, relation=_text(cell), forward=forward)


def _sources(cell: Cell) -> Mapping[str, Reference]:
    """Return the references that a cell uses: quantities, and choices that it tests."""
    return {**cell.uses, **cell.tests}


def _text(cell: Cell) -> str:
    """Return a cell's relation as typed; for a list, the first relation in it."""
    texts = cell.raw if isinstance(cell.raw, list) else [cell.raw]
    return next(str(text) for text in texts if is_relation(text))


def _names(graph: Graph) -> Iterator[NetworkName]:
    """Yield every name that a relation may use, with its unit and meaning."""
    for name, kind in graph.kinds.items():
        if name in graph.parameters:
            yield _name(name, "parameter", "parameter of the design", kind.unit)
    for block in graph.blocks.values():
        for tail, declared in block.cls.inputs.items():
            if not (isinstance(declared, Choice) or block.is_worksheet):
                yield _declared(f"{block.name}.{tail}", "input", declared)
        for tail, formula in block.cls.formulas.items():
            yield _declared(f"{block.name}.{tail}", "output", formula)
        for tail in measured_names(block.analyses, block.cls) if block.is_model else ():
            measure = Reference.parse(f"{block.name}.{tail}")
            yield _name(str(measure), "measure", _words(measure), measured_unit(measure))


Role = Literal["parameter", "input", "output", "measure"]


def _declared(name: str, role: Role, declared: Declaration) -> NetworkName:
    return _name(name, role, declared.meaning.words, declared.meaning.unit)


def _name(name: str, role: Role, words: str, unit_text: str) -> NetworkName:
    return NetworkName(name=name, role=role, words=words, unit=unit_text, dimension=_dimension(unit_text))


def _words(measure: Reference) -> str:
    """Return the description of a measurement.

    `throw.torsion.stiffness` becomes "stiffness, torsion analysis".
    """
    origin = f"{measure.analysis} analysis" if measure.analysis else "measured"
    return f"{measure.own_name.replace('_', ' ')}, {origin}"


@lru_cache(maxsize=1024)
def _dimension(unit_text: str) -> str:
    return dimension_of(unit(unit_text))
