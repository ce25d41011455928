"""A checked design with varied parameters: determine what to calculate, and in which chunks of rows."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TypeVar

import numpy as np

from app.designs.engine.calculate import constants, rows
from app.designs.engine.calculation import Calculation
from app.designs.engine.needs import MovingNodes, Needs, needs, varying
from app.designs.engine.steps import LevelMoved
from app.designs.network import LIMITS, Block, Graph, Subject
from app.reference import Reference
from templates.core.arrays import Array
from templates.core.errors import Fault, unknown_name, unknown_names
from templates.core.language import spec

Rows = Mapping[Reference, Array]
"""SI values by place: of shape (N,), or (N, K) for a curve."""

Levels = Mapping[str, str | None]
"""Levels by step; None if the design or the template determines the level."""

T = TypeVar("T")

MOST_ROWS = 4096
"""Largest number of rows in one array call. Results differ in the last bits with the length of the arrays."""
MOST_VALUES = 2_000_000
"""Largest number of values in all columns of a chunk; a curve counts with all its points."""
MOST_PREPARED = 32  # number of requests whose shared values are cached
FEWEST_TIMED = 64  # smallest number of rows whose time is used for estimates


@dataclass(frozen=True)
class Targets:
    """The values that the caller requests, and the inputs that are read from evaluated steps (`inside`)."""

    references: frozenset[Reference]
    inside: frozenset[Reference] = frozenset()

    @classmethod
    def of(cls, references: Iterable[Reference], judged: Iterable[Subject] = ()) -> Targets:
        """Return the targets for requested values and for the values that criteria name."""
        subjects = [subject for subject in judged if subject.block is None or not subject.block.is_model]
        subjects += [other for one in subjects for _, other in one.instead]
        used = [(one, r) for one in subjects for r in one.references.values()]
        named = {r for one, r in used if one.block is None or r.analysis == LIMITS}
        inside = {r for _, r in used} - named
        return cls(frozenset(references) | named, frozenset(inside))


@dataclass(frozen=True)
class RowDesign:
    """A network with the places that rows vary, and the known measurements of solids [SI]."""

    graph: Graph
    varied: frozenset[Reference]
    measured: Mapping[Reference, float]
    _prepared: dict[object, Calculation] = field(default_factory=dict)

    @cached_property
    def moving(self) -> MovingNodes:
        """Return the nodes whose values differ between rows."""
        return varying(self.graph, self.varied)

    def needs(self, wanted: Targets) -> Needs:
        """Return the nodes on which some values depend; they are cached for the next call."""
        if wanted not in self._needs:
            if len(self._needs) >= MOST_PREPARED:
                self._needs.clear()
            given = self.varied | self.measured.keys()
            self._needs[wanted] = needs(self.graph, wanted.references, given, wanted.inside)
        return self._needs[wanted]

    @cached_property
    def _needs(self) -> dict[Targets, Needs]:
        return {}

    def steps(self, wanted: Targets) -> list[Block]:
        """Return, in order, the steps that some values need."""
        due = self.needs(wanted).members
        blocks = (node for node in self.graph.order if isinstance(node, Block))
        return [block for block in blocks if block.name in due and not block.is_model]

    def faults(self, wanted: Collection[Reference], levels: Levels) -> Iterator[Fault]:
        """Yield the faults in requested names and in levels."""
        unknown = [str(r) for r in wanted if r not in self.varied and self.graph.node(r) is None]
        yield from unknown_names(unknown, self.graph.names(), "name")
        for reference in wanted:
            if isinstance(self._declared(reference), (spec.Text, spec.Table)):
                yield Fault(str(reference), "not_a_number", f"{reference} is not a quantity")
        for name, level in levels.items():
            block = self.graph.blocks.get(name)
            if block is None:
                yield unknown_name(name, self.graph.blocks, "step").within("levels")
            elif level is not None and level not in block.cls.levels:
                fault = unknown_name(level, block.cls.levels, "level")
                yield Fault(f"levels.{name}", fault.code, fault.detail)

    def _declared(self, reference: Reference) -> spec.Declaration | None:
        block = self.graph.blocks.get(reference.block)
        if block is None or reference.analysis is not None:
            return None
        return block.cls.inputs.get(reference.member) or block.cls.formulas.get(reference.member)

    def constants(self, wanted: Targets, levels: Levels) -> Calculation:
        """Calculate the values that all rows share; they are cached for the next call."""
        pinned = self._pinned(wanted, levels)
        key = wanted, pinned
        if key not in self._prepared:
            if len(self._prepared) >= MOST_PREPARED:
                self._prepared.clear()
            due, given = self.needs(wanted), self.measured
            shared = Calculation(self.graph, given, needs=due, moving=self.moving, levels=dict(pinned))
            self._prepared[key] = constants(shared)
        shared = self._prepared[key]
        return replace(shared, started=dict(shared.started))  # this call chooses its own starting levels

    def passes(
        self,
        given: Rows,
        count: int,
        wanted: Targets,
        levels: Levels,
        chunk: int = MOST_ROWS,
    ) -> Iterator[tuple[int, Calculation]]:
        """Calculate the rows in chunks; yield the number of each chunk's first row, and its calculation.

        Raises
        ------
        LevelMoved
            If no level is given for a step and its rows start at different levels.
        """
        shared = self.constants(wanted, levels)
        size = self.rows_at_once(wanted, levels, chunk)
        for start in range(0, count, size):
            part = {reference: array[start : start + size] for reference, array in given.items()}
            begun = time.thread_time()
            result = rows(shared, min(size, count - start), part)
            if result.count >= min(size, FEWEST_TIMED):
                self._keep_pace(wanted, levels, (time.thread_time() - begun) / result.count)
            yield start, result

    def _keep_pace(self, wanted: Targets, levels: Levels, seconds: float) -> None:
        if len(self._paces) >= MOST_PREPARED:
            self._paces.clear()
        self._paces[wanted, self._pinned(wanted, levels)] = seconds

    def pace(self, wanted: Targets, levels: Levels) -> float | None:
        """Return the processor time per row of the last similar call [s]; None before the first call."""
        return self._paces.get((wanted, self._pinned(wanted, levels)))

    def _pinned(self, wanted: Targets, levels: Levels) -> frozenset[tuple[str, str | None]]:
        """Return the given level of each needed step."""
        due = self.needs(wanted).members
        return frozenset((name, levels.get(name) or self.graph.blocks[name].level) for name in due)

    def settled(self, calculate: Callable[[Levels], T], levels: Levels) -> T:
        """Return a result with one level for each step: the finest level at which any of its rows starts."""
        pinned = dict(levels)
        with np.errstate(all="ignore"):
            while True:
                try:
                    return calculate(pinned)
                except LevelMoved as moved:
                    ladder = self.graph.blocks[moved.step].cls.levels
                    pinned[moved.step] = max(moved.before, moved.level, key=ladder.index)

    def nominal(self, wanted: Targets, levels: Levels) -> Calculation:
        """Return the calculation of the design as the document states it, without varied values."""
        with np.errstate(all="ignore"):
            return replace(self, varied=frozenset(), _prepared={}).constants(wanted, levels)

    def rows_at_once(self, wanted: Targets, levels: Levels, chunk: int = MOST_ROWS) -> int:
        """Return the number of rows to calculate in one array call."""
        values = sum(self.sizes(wanted).values())
        return max(1, min([chunk, MOST_VALUES // max(values, 1), *self._most_points(wanted, levels)]))

    def sizes(self, wanted: Targets) -> Mapping[str, int]:
        """Return how many values each cell and output has in one row of the unvaried design."""
        if wanted not in self._sizes:
            cheapest = {block.name: next(iter(block.cls.levels), None) for block in self.steps(wanted)}
            nominal, needed = self.nominal(wanted, cheapest), self.needs(wanted).members.items()
            inside = (Reference(block, None, name) for block, names in needed for name in names)
            self._sizes[wanted] = {name: int(np.size(c.value)) for name, c in nominal.values.items()} | {
                str(reference): int(np.size(nominal.column(reference).value)) for reference in inside
            }
        return self._sizes[wanted]

    @cached_property
    def _paces(self) -> dict[object, float]:
        return {}

    @cached_property
    def _sizes(self) -> dict[Targets, Mapping[str, int]]:
        return {}

    def _most_points(self, wanted: Targets, levels: Levels) -> Iterator[int]:
        """Yield the largest number of points that the level of each varied step allows in one call."""
        for block in self.steps(wanted):
            level = levels.get(block.name) or block.level or block.cls.default_level
            if block in self.moving and level in block.cls.most_points:
                yield block.cls.most_points[level]
