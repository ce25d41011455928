"""Find the solid of each row of a study and put its measurements into columns, in a calculation process.

A row waits for its solids: until all are known, a chunk reports the missing ones. A model may use a
measurement of another model, so its parameters are known only after that model is built.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from app.designs.analyses import axes_of, is_table
from app.designs.document import Document
from app.designs.engine.design_engine import DesignEngine, Refusal
from app.designs.engine.needs import needs, varying
from app.designs.engine.row_design import Levels, Rows, Targets
from app.designs.engine.row_shapes import numbers_of, shape_of
from app.designs.network import Block, subjects
from app.reference import Reference
from app.studies.bodies import StudyIn
from cad.regenerate import as_text
from templates.core.arrays import Array, Mask
from templates.core.errors import Fault

Texts = tuple[tuple[str, str], ...]
"""All parameters of a model by name, as `as_text` writes them; they identify a solid."""


@dataclass(frozen=True)
class SolidRequest:
    """A solid that is not built yet, and the measurements that it needs."""

    model: str
    texts: Texts
    measures: tuple[str, ...]


@dataclass(frozen=True)
class SolidMeasures:
    """The measurements of a solid [SI], by their names in relations, or why it has none."""

    model: str
    texts: Texts
    measures: tuple[tuple[str, float], ...] = ()
    failure: Refusal | None = None


Solids = tuple[SolidMeasures, ...]

NO_VALUE = "a parameter of the solid has no finite value here"


@dataclass
class RowsWithSolids:
    """Rows with the known measurements of their solids.

    Attributes
    ----------
    columns
        The measurements [SI]; NaN where a row has none.
    wanting
        Solids that are not known yet.
    waiting
        Mask of the rows that use any of these solids.
    refusals
        For each refused row, why it has no solid.
    levels
        The levels of the steps on which parameters of models depend.
    """

    columns: dict[Reference, Array]
    waiting: Mask
    wanting: list[SolidRequest] = field(default_factory=list)
    refusals: dict[int, Refusal] = field(default_factory=dict)
    levels: dict[str, str | None] = field(default_factory=dict)


def measures_of_rows(
    engine: DesignEngine, body: StudyIn, outputs: Collection[Reference], measured: Collection[Reference]
) -> list[Reference]:
    """Return the measurements that a study needs and that differ from row to row or are not yet `measured`.

    Only the outputs, the objectives and the criteria of `hold` count as needed.
    """
    held = [subject for name, subject in subjects(engine.graph).items() if name in (body.hold or ())]
    wanted = Targets.of(outputs, held)
    due = needs(engine.graph, wanted.references, engine.varied, wanted.inside)
    moving = engine.design.moving
    return sorted(
        (r for r in due.waiting if r not in measured or engine.graph.blocks[r.block].solid in moving), key=str
    )


def iterated(document: Document, measures: Sequence[Reference]) -> Iterator[Fault]:
    """Yield a fault if a design iterates, because each row would need several solids in succession."""
    if document.iterations and measures:
        through = document.iterations[0].through
        detail = f"the design iterates through {through}; a study builds no solid for a row of such a design"
        yield Fault(str(measures[0]), "needs_solids", detail)


def tables_among(measures: Sequence[Reference]) -> Iterator[Fault]:
    """Yield a fault for each table or list among the measurements, because rows have single values."""
    for reference in filter(is_table, measures):
        what = {1: "list", 2: "table"}[axes_of(reference)]
        detail = f"is a {what} of an analysis, but a study needs single values; type the {what} as values"
        yield Fault(str(reference), "needs_solids", f"{reference} {detail}")


@dataclass(frozen=True)
class RowSolids:
    """The solids of rows: the models that must be built, and the measurements of each."""

    engine: DesignEngine
    measures: tuple[Reference, ...]

    @cached_property
    def models(self) -> list[Block]:
        """Return the models to build, each after the models on which it depends."""
        names = {reference.block for reference in self.measures}
        return [node for node in self.engine.graph.order if isinstance(node, Block) and node.name in names]

    def measures_of(self, model: str) -> list[Reference]:
        """Return the references to measurements of a model."""
        return [reference for reference in self.measures if reference.block == model]

    def drivers(self, model: Block) -> list[Reference]:
        """Return the varied places on which the parameters of a model depend."""
        places = self.engine.varied - set(self.measures)
        return sorted((p for p in places if model in varying(self.engine.graph, [p])), key=str)

    @property
    def analysed(self) -> set[str]:
        """Return the models that need finite-element analyses."""
        return {reference.block for reference in self.measures if reference.analysis is not None}

    def resolved(self, rows: Rows, count: int, levels: Levels | None, solids: Solids) -> RowsWithSolids:
        """Return the measurements of those rows whose solids are known."""
        empty = {reference: np.full(count, np.nan) for reference in self.measures}
        result = RowsWithSolids(empty, np.zeros(count, dtype=bool))
        by_texts = {(solid.model, solid.texts): solid for solid in solids}
        for model in self.models:
            self._measure(model, rows, levels, by_texts, result)
        return result

    def _measure(
        self,
        model: Block,
        rows: Rows,
        levels: Levels | None,
        by_texts: Mapping[tuple[str, Texts], SolidMeasures],
        result: RowsWithSolids,
    ) -> None:
        """Fill in the columns of one model's measurements."""
        names = numbers_of(model)
        references = [model.cells[name].reference for name in names]
        table = self.engine({**rows, **result.columns}, references, levels=levels)
        result.levels |= table.levels
        columns = [table.columns[reference] for reference in references]
        matrix = _side_by_side(columns, len(result.waiting))
        there: Mask = np.asarray(np.isfinite(matrix).all(axis=1))
        for row in np.flatnonzero(~there & ~result.waiting).tolist():
            _refuse(result, [row], table.refusals.get(row, Refusal(model.name, "not_finite", NO_VALUE)))
        for values, numbers in _distinct(matrix, there):
            shape = shape_of(model, dict(zip(names, _apart(values, columns), strict=True)))
            if isinstance(shape, Refusal):
                _refuse(result, numbers, shape)
                continue
            texts = tuple(sorted(as_text(shape).items()))
            solid = by_texts.get((model.name, texts))
            if solid is None:
                measures = tuple(reference.member for reference in self.measures_of(model.name))
                result.wanting.append(SolidRequest(model.name, texts, measures))
                result.waiting[numbers] = True
            elif solid.failure is not None:
                _refuse(result, numbers, solid.failure)
            else:
                for name, value in solid.measures:
                    result.columns[Reference.parse(f"{model.name}.{name}")][numbers] = value


def _side_by_side(columns: Sequence[Array], count: int) -> Array:
    """Return one row of numbers for each row; a list of k items takes k columns."""
    parts = [np.reshape(column, (count, -1)) for column in columns]
    return np.concatenate(parts, axis=1) if parts else np.empty((count, 0))


def _apart(values: Array, columns: Sequence[Array]) -> list[float | list[float]]:
    """Return a row of numbers split into the values of the original columns: numbers and lists."""
    ends = np.cumsum([column[0].size for column in columns])
    parts = np.split(values, ends[:-1]) if columns else []
    return [
        part.tolist() if column.ndim > 1 else float(part[0])
        for part, column in zip(parts, columns, strict=True)
    ]


def _refuse(result: RowsWithSolids, numbers: Sequence[int], refusal: Refusal) -> None:
    """Record why rows have no solid; earlier reasons are kept, because they cause the later ones."""
    result.refusals = dict.fromkeys(map(int, numbers), refusal) | result.refusals


def _distinct(matrix: Array, among: Mask) -> Iterator[tuple[Array, list[int]]]:
    """Yield the distinct rows of a matrix, each with the numbers of all rows equal to it."""
    numbers = np.flatnonzero(among)
    if not len(numbers):
        return
    unique, which = np.unique(matrix[numbers], axis=0, return_inverse=True)
    order = np.argsort(which.reshape(-1), kind="stable")
    starts = np.searchsorted(which.reshape(-1)[order], np.arange(len(unique) + 1))
    for place, values in enumerate(unique):
        yield values, numbers[order[starts[place] : starts[place + 1]]].tolist()
