"""Calculate variants together: each step once for all of them, in array calls at one level.

Cells are calculated variant by variant, as in separate designs. At a step, the variants whose inputs have the
same shapes and choices share one array call; each then continues with its row of the result. A variant that
an array call refuses or masks is calculated alone, so that the message refers to that variant.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from app.catalogue.catalogues import Catalogues
from app.designs.document import Document
from app.designs.engine.calculate import calculate_nodes
from app.designs.engine.calculation import Analysed, Calculation, Measured
from app.designs.engine.relations import MOST_OPERATIONS
from app.designs.graph import build_graph, starts
from app.designs.network import Block, Node
from app.designs.results import Outcome
from app.designs.variants.array_calls import StepInputs, evaluations
from app.designs.variants.outcome import outcome_of, refused, units_of
from app.designs.variants.table import applied
from templates.core.errors import Fault, InvalidInputs

TOO_MUCH = (
    f"the relations of all variants need more than {MOST_OPERATIONS} operations on single values; "
    "use shorter arrays, or fewer variants"
)
ROW_ARRAYS = "{} is calculated at several points; with variants, its inputs must be single values or curves"


@dataclass(frozen=True)
class Available:
    """The catalogues, and the existing results of solids, that a calculation can use."""

    catalogues: Catalogues
    measured: Measured
    analysed: Analysed


@dataclass
class _Run:
    """The calculation of one variant while it proceeds through its network."""

    name: str
    places: Mapping[str, str]  # overridden places, with the typed units of parameters
    document: Document
    calculation: Calculation
    left: Iterator[Node]
    at: Block | None = field(default=None)  # the next step

    def advance(self, available: Available) -> None:
        """Calculate everything before the next step."""
        if self.at is not None:
            self._calculate(self.at, available)
        self.at = None
        for node in self.left:
            if isinstance(node, Block) and not node.is_model:
                self.at = node
                return
            self._calculate(node, available)

    def _calculate(self, node: Node, available: Available) -> None:
        calculate_nodes(self.calculation, [node], available.measured, available.analysed)

    def stop(self) -> None:
        """Stop the calculation, because all variants together exceed the limits."""
        self.at, self.left = None, iter(())
        self.calculation.faults.append(Fault("relations", "too_many_values", TOO_MUCH))

    def outcome(self) -> Outcome:
        """Return the outcome of the variant."""
        if wrong := row_arrays(self.calculation):
            return refused(self.name, wrong)
        return outcome_of(self.name, self.places, self.document, self.calculation)


def together(document: Document, available: Available) -> list[Outcome]:
    """Return every variant of a document, calculated as far as possible now."""
    begun = {name: _begun(document, name, available) for name in document.variants}
    runs = [run for run in begun.values() if isinstance(run, _Run)]
    for run in runs:
        run.advance(available)
    _limit(runs)
    while waiting := [run for run in runs if run.at is not None]:
        for group in _by_step(waiting):
            _share(group)
            for run in group:
                run.advance(available)
        _limit(runs)
    return [run.outcome() if isinstance(run, _Run) else run for run in begun.values()]


def _limit(runs: Sequence[_Run]) -> None:
    """Stop all variants once their relations together need more operations than one design may."""
    if sum(run.calculation.operations for run in runs) > MOST_OPERATIONS:
        for run in runs:
            run.stop()


def _begun(document: Document, name: str, available: Available) -> _Run | Outcome:
    """Return a variant that is ready for calculation, or its outcome if its network has faults."""
    overrides = document.variants[name]
    own = applied(document, overrides)
    graph, faults = build_graph(own, available.catalogues)
    if faults:
        return refused(name, faults)
    try:
        assumed = starts(own)
    except InvalidInputs as error:
        return refused(name, error.faults)
    places = units_of(document, overrides)
    return _Run(name, places, own, Calculation(graph, assumed), iter(graph.order))


def _by_step(runs: Sequence[_Run]) -> list[list[_Run]]:
    """Return the variants that wait at the same step, namely the step at which most of them wait."""
    steps: dict[str, list[_Run]] = {}
    for run in runs:
        assert run.at is not None, "it waits at a step"
        steps.setdefault(run.at.name, []).append(run)
    return [max(steps.values(), key=len)]


def _share(runs: Sequence[_Run]) -> None:
    """Prepare the evaluation of a step for each variant by array calls, where possible."""
    asking = {run.name: asked for run in runs if (asked := _asking(run)) is not None}
    shared = evaluations(list(asking.values()))
    for name, evaluation in zip(asking, shared, strict=True):
        if evaluation is not None:
            run = next(run for run in runs if run.name == name)
            run.calculation.prepared[asking[name].block.name] = evaluation


def _asking(run: _Run) -> StepInputs | None:
    """Return the inputs of a step for one variant; None while an input is pending or faulty."""
    block, calculation = run.at, run.calculation
    assert block is not None, "it waits at a step"
    unknown = calculation.pending | calculation.broken
    if not unknown.isdisjoint(block.cells.values()):
        return None
    raw = {name: calculation.typed.get(cell.name, cell.raw) for name, cell in block.cells.items()}
    return StepInputs(block, raw, calculation.graph)


def row_arrays(calculation: Calculation) -> Sequence[Fault]:
    """Return a fault for every step that is calculated at several points at once."""
    points = {
        name: evaluation.template.shape_of_points() for name, evaluation in calculation.evaluations.items()
    }
    return [Fault(name, "shape", ROW_ARRAYS.format(name)) for name, shape in points.items() if shape]
