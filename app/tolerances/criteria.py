"""The criteria of a design whose yields an analysis states."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from app.designs.network import Graph, Subject, subjects
from app.reference import Reference
from templates.core.criteria.criterion import Criterion


@dataclass(frozen=True)
class CriterionVariable:
    """A criterion as a tolerance analysis evaluates it."""

    subject: Subject

    @property
    def criterion(self) -> Criterion:
        """Return the criterion to compare."""
        return self.subject.criterion

    @property
    def references(self) -> frozenset[Reference]:
        """Return the values in the criterion, without limits."""
        return frozenset(self.subject.references.values())

    @cached_property
    def judged(self) -> frozenset[Reference]:
        """Return the values that the criterion compares with its limit."""
        named = self.criterion.value.names
        return frozenset(of for name, of in self.subject.references.items() if name in named)

    @property
    def alone(self) -> Reference | None:
        """Return the judged value, if that side of the criterion is a single name."""
        name = self.criterion.subject
        return None if name is None else self.subject.references.get(name)

    @property
    def has_one_limit(self) -> bool:
        """Return whether the limit contains no value of the design, and so is the same for every product."""
        return self.subject.references.keys().isdisjoint(self.criterion.limit.names)

    @property
    def missing(self) -> list[str]:
        """Return the missing limits."""
        block = self.subject.block
        if block is None:
            return []
        given = {*block.limits, *block.related}
        return [f"{block.name}.{one.name}" for one in self.criterion.limits if one.name not in given]


def demanded(graph: Graph) -> dict[str, CriterionVariable]:
    """Return every criterion of a design that is judged and not waived."""
    return {
        name: CriterionVariable(one) for name, one in subjects(graph).items() if _counts(graph, name, one)
    }


def _counts(graph: Graph, name: str, subject: Subject) -> bool:
    is_waived = name in graph.demands and graph.demands[name].written.waived is not None
    return subject.is_due(graph) and not is_waived
