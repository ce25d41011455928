"""One calculation of a design for some rows at once: cells and steps in order, with what each row refuses."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from app.designs.columns import Column, stacked
from app.designs.network import Block, Cell, Graph
from app.designs.row_items import related, wrong_index
from app.designs.row_refusals import Refusal, refusal_of_text
from app.designs.rows_needed import Needs, Varying
from app.designs.step_rows import StepRows, step_rows
from app.plain import Raw
from app.reference import Reference
from templates.core.arrays import Array
from templates.core.errors import FaultyText
from templates.core.language.spec import Choice
from templates.core.units.quantity import Typed, read, read_any
from templates.core.units.relation import is_relation

NOT_FINITE = "the relation has no finite value here (a division by zero, a root below zero?)"
NOT_FINITE_GIVEN = "the value of this row is not finite"


@dataclass(frozen=True)
class Question:
    """A calculation to do: of which design, for which values, from which measures, at which levels.

    Attributes
    ----------
    measured
        Known measures of solids [SI].
    levels
        By step, the level that was asked for.
    started
        By step, the level at which its first rows started, where none was asked for.
    """

    graph: Graph
    needs: Needs
    moving: Varying
    measured: Mapping[Reference, float]
    levels: Mapping[str, str | None]
    started: dict[str, str] = field(default_factory=dict)


@dataclass
class RowPass:
    """The values [SI] of `count` rows.

    Attributes
    ----------
    given
        The columns of varied places.
    changed
        Outputs of steps that have other values than those that are calculated.
    waiting
        Cells and steps that follow from a solid that is not known.
    refusals
        By row; under `for_all` what refuses every row.
    """

    question: Question
    count: int
    given: Mapping[Reference, Array] = field(default_factory=dict)
    changed: Mapping[Reference, Column] = field(default_factory=dict)
    cells: dict[Cell, Column] = field(default_factory=dict)
    typed: dict[Cell, Typed | str] = field(default_factory=dict)
    steps: dict[str, StepRows] = field(default_factory=dict)
    waiting: set[Cell | Block] = field(default_factory=set)
    refusals: dict[int, Refusal] = field(default_factory=dict)
    for_all: Refusal | None = None

    @classmethod
    def constants(cls, question: Question) -> RowPass:
        """Calculate what all rows share, once."""
        result = cls(question, 1)
        result._run(node for node in question.graph.order if node not in question.moving)
        return result

    def of_one_call(self) -> RowPass:
        """The same constants, with which rows have not started at any level yet."""
        started = {name: step.level for name, step in self.steps.items() if step.level is not None}
        return replace(self, question=replace(self.question, started=started))

    def rows(self, count: int, given: Mapping[Reference, Array]) -> RowPass:
        """The values of some rows, from constants that are known."""
        result = RowPass(
            self.question,
            count,
            given,
            cells=dict(self.cells),
            typed=dict(self.typed),
            steps=dict(self.steps),
            waiting=set(self.waiting),
            for_all=self.for_all,
        )
        result._run(node for node in self.question.graph.order if node in self.question.moving)
        return result

    def again(self, changed: Mapping[Reference, Column], nodes: Iterable[object]) -> RowPass:
        """The same rows with other values of some outputs, and of the nodes that follow from these."""
        result = RowPass(
            self.question,
            self.count,
            self.given,
            changed,
            cells=dict(self.cells),
            typed=dict(self.typed),
            steps=dict(self.steps),
            waiting=set(self.waiting),
        )
        result._run(nodes)
        return result

    def value(self, reference: Reference) -> Column:
        """The value of a name; NaN while it waits for a solid."""
        if reference in self.changed:
            return self.changed[reference]
        if cell := self.question.graph.cell(reference):
            return self.cells[cell]
        if reference in self.given:
            return Column(self.given[reference], is_row=True)
        if reference in self.question.measured:
            return Column(self.question.measured[reference])
        if reference in self.question.needs.waiting:
            return Column(np.nan)
        return self.steps[reference.block].values[reference.member]

    def _run(self, nodes: Iterable[object]) -> None:
        needs = self.question.needs
        for node in nodes:
            if isinstance(node, Cell) and node in needs.cells:
                self._cell(node)
            elif isinstance(node, Block) and node.name in needs.members:
                self._block(node)

    def _cell(self, cell: Cell) -> None:
        """The value of a cell; rows in which it has none are refused."""
        if not self.waiting.isdisjoint(self._sources(cell)) or self._waits(cell):
            self.waiting.add(cell)
            self.cells[cell] = Column(np.nan)
        elif cell.reference in self.given:
            column = Column(self.given[cell.reference], is_row=True)
            self.cells[cell] = self._admitted(cell, column, {}, NOT_FINITE_GIVEN)
        else:
            try:
                self._calculated(cell)
            except FaultyText as error:
                self._refuse_all(refusal_of_text(cell.name, error))
                self.cells[cell] = Column(np.nan)

    def _sources(self, cell: Cell) -> set[Cell | Block]:
        if cell.reference in self.given:
            return set()
        return {n for n in self.question.graph.sources.get(cell, ()) if isinstance(n, (Cell, Block))}

    def _waits(self, cell: Cell) -> bool:
        return not self.question.needs.waiting.isdisjoint(cell.uses.values())

    def _calculated(self, cell: Cell) -> None:
        """The value of a literal, or of relations."""
        if cell.relations:
            uses = {name: self.value(reference) for name, reference in cell.uses.items()}
            self.cells[cell] = self._admitted(cell, _related(cell, uses), uses, NOT_FINITE)
        elif isinstance(cell.declared, Choice):
            self.typed[cell] = str(cell.raw["value"] if isinstance(cell.raw, dict) else cell.raw)
        else:
            self.typed[cell] = typed = literal(cell)
            self.cells[cell] = Column(typed.si)

    def _admitted(self, cell: Cell, column: Column, uses: Mapping[str, Column], why: str) -> Column:
        """A column with NaN in the rows that have no finite value; these are refused, if not before."""
        finite = column.finite_rows() if column.is_row else np.isfinite(column.value)
        if finite.all():
            return column
        refusal = Refusal(cell.name, "not_finite", why)
        if not column.is_row:
            self._refuse_all(refusal)
            return Column(np.nan)
        rows = np.flatnonzero(~finite).tolist()
        self._refuse(dict.fromkeys(rows, refusal) | dict(_wrong_indices(cell, uses, rows)))
        return column.without(~finite)

    def _block(self, block: Block) -> None:
        """Evaluate a step, or a model's own values, for all rows that have inputs."""
        members = sorted(self.question.needs.members[block.name])
        if not self.waiting.isdisjoint(block.cells.values()):
            self.waiting.add(block)
            values = dict.fromkeys(members, Column(np.nan))
            self.steps[block.name] = StepRows(block, self.count, has_rows=False, values=values)
            return
        given = {name: self.typed.get(cell) or self.cells[cell] for name, cell in block.cells.items()}
        level, started = self.question.levels.get(block.name), self.question.started.get(block.name)
        step = step_rows(block, given, members, self.count, level, started)
        if step.level is not None and block.cls.levels:
            self.question.started.setdefault(block.name, step.level)
        self.steps[block.name] = step
        if step.has_rows:
            self._refuse(step.refusals)
        elif step.refusals:
            self._refuse_all(step.refusals[0])

    def _refuse(self, refusals: Mapping[int, Refusal]) -> None:
        self.refusals = {**refusals, **self.refusals}  # the first reason is the cause of the others

    def _refuse_all(self, refusal: Refusal) -> None:
        self.for_all = self.for_all or refusal


def _wrong_indices(
    cell: Cell, uses: Mapping[str, Column], rows: Iterable[int]
) -> Iterator[tuple[int, Refusal]]:
    """The rows in which a relation has no value because an index is no place of its array."""
    for relation in cell.relations:
        for row in rows if relation.items and uses else ():
            if error := wrong_index(relation, uses, row):
                yield row, refusal_of_text(cell.name, error)


def literal(cell: Cell) -> Typed:
    """A quantity as its user wrote it.

    Raises
    ------
    FaultyText
        If it is none.
    """
    return read(cell.raw, cell.declared.meaning.unit) if cell.declared else read_any(cell.raw)


def _related(cell: Cell, uses: Mapping[str, Column]) -> Column:
    """The value of a relation, or of a list of relations and quantities.

    Raises
    ------
    FaultyText
        With code `shape`, where curves of different lengths meet.
    """
    if not isinstance(cell.raw, list):
        return related(cell.relations[0], uses)
    items = [_item(cell, item, uses) for item in cell.raw]
    if any(item.rank for item in items):
        raise FaultyText(
            "shape", "each item of a list is a single value, but a relation in it gives an array"
        )
    return stacked(items)


def _item(cell: Cell, item: Raw, uses: Mapping[str, Column]) -> Column:
    if not is_relation(item):
        unit = cell.declared.meaning.unit if cell.declared else None
        return Column(read(item, unit).si if unit else read_any(item).si)
    return related(cell.relations_by_text[str(item).strip()], uses)
