"""The criteria of a design by their names: those of its templates, and those that it writes itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from app.designs.network import Block, Demand, Graph
from app.reference import Reference
from templates.core.judging.criterion import Criterion, Missing


@dataclass(frozen=True)
class Subject:
    """A criterion of a design: that of a step's template, or one that the design writes itself."""

    criterion: Criterion
    block: Block | None
    demand: Demand | None

    @cached_property
    def references(self) -> Mapping[str, Reference]:
        """Return the values that it names, without limits that follow from nothing."""
        if self.block is None:
            return self.demand.uses if self.demand else {}
        limits = self.criterion.limits_by_name
        values = {n: Reference(self.block.name, None, n) for n in self.criterion.names if n not in limits}
        return values | {n: cell.reference for n, cell in self.block.related.items() if n in limits}

    @cached_property
    def instead(self) -> tuple[tuple[Missing, Subject], ...]:
        """Return the comparisons to judge where a value is missing."""
        every = self.criterion.absent.values()
        return tuple((one, Subject(one.instead, self.block, None)) for one in every if one.instead)

    def is_due(self, graph: Graph) -> bool:
        """Return whether judging it computes no output that the design leaves out."""
        if self.block is None or self.block.is_model:
            return True
        computed = graph.computed(self.block)
        outputs = self.block.cls.formulas.keys() - self.block.cells.keys()
        return computed is None or outputs.intersection(self.criterion.names).issubset(computed)


def subjects(graph: Graph) -> dict[str, Subject]:
    """Return all criteria by their names; one that the design writes again replaces that of a template."""
    by_name: dict[str, Subject] = {}
    for block in graph.blocks.values():
        for criterion in block.cls.declared_criteria:
            name = f"{block.name}.{criterion.name}"
            by_name[name] = Subject(criterion, block, graph.demands.get(name))
    for name, demand in graph.demands.items():
        if demand.criterion is not None:
            by_name[name] = Subject(demand.criterion, None, demand)
    return by_name
