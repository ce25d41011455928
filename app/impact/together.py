"""Calculate designs of the same form together: each is one row of the same array calls.

`single` calculates all other designs: those with steps whose level depends on a tolerance, values measured on
solids, iterations, or inputs at several points. It also takes over if a whole array call is refused.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from app.catalogue.catalogues import Catalogues
from app.designs.document import Document
from app.designs.engine.calculation import Calculation
from app.designs.engine.columns import Indices
from app.designs.engine.design_engine import DesignEngine
from app.designs.engine.needs import is_member
from app.designs.engine.row_design import RowDesign, Rows, Targets
from app.designs.engine.steps import LevelMoved, StepRows
from app.designs.engine.verdicts import Verdicts
from app.designs.network import Block, Graph, Subject
from app.impact.outcome import JudgedCriterion, Outcome
from app.reference import Reference
from templates.core.arrays import Array
from templates.core.criteria.comparison import VERDICTS
from templates.core.errors import Fault, TemplateError
from templates.core.language.spec import Choice, Curve, Given, Table, Text
from templates.core.language.template import Template


@dataclass(frozen=True)
class Together:
    """A form of designs with one version of the template.

    Attributes
    ----------
    design
        The network whose placeholders receive the quantities in which the designs differ.
    outputs, parameters
        The requested outputs of steps and parameters of CAD models.
    """

    design: RowDesign
    outputs: tuple[Reference, ...]
    parameters: tuple[Reference, ...]
    subjects: Mapping[str, Subject]
    units: Mapping[str, str]

    @classmethod
    def of(cls, document: Document, catalogues: Catalogues, varied: Collection[Reference]) -> Together | None:
        """Return the form of a document; None if its designs must be calculated alone."""
        if document.iterations:
            return None
        try:
            engine = DesignEngine.of(document, catalogues, varied)
        except TemplateError:
            return None
        graph = engine.graph
        blocks = graph.blocks.values()
        if any(_chooses_by_tolerance(one) or _is_incomplete(one) for one in blocks) or _is_measured(graph):
            return None
        outputs, parameters = tuple(_outputs(graph)), tuple(_parameters(graph))
        units = {str(reference): graph.unit_of(reference) for reference in (*outputs, *parameters)}
        subjects = engine.subjects(engine.criteria())
        return cls(engine.design, outputs, parameters, subjects, units)

    def outcomes(self, rows: Rows, count: int) -> list[Outcome] | None:
        """Return the outcome of each row; None if the designs must be calculated alone."""
        listed: list[Outcome] = []
        try:
            with np.errstate(all="ignore"):
                for start, part in self.design.passes(rows, count, self._wanted, {}):
                    chunk = {place: column[start : start + part.count] for place, column in rows.items()}
                    ended = self._of_chunk(chunk, part)
                    if ended is None:
                        return None
                    listed += ended
        except (LevelMoved, TemplateError):
            return None
        return listed

    @property
    def _wanted(self) -> Targets:
        judged = Targets.of(self.outputs, self.subjects.values())
        cells = {Reference(name) for name in self.design.graph.parameters}
        return Targets(judged.references | cells, judged.inside | set(self.parameters))

    def _of_chunk(self, rows: Rows, part: Calculation) -> list[Outcome] | None:
        """Return the outcomes of one array call.

        Rows with different starting levels are calculated separately.
        """
        groups = _by_levels(part)
        if len(groups) == 1:
            return list(self._read(part))
        apart: dict[int, Outcome] = {}
        for indices in groups:
            some = {place: column[indices] for place, column in rows.items()}
            if (outcomes := self.outcomes(some, indices.size)) is None:
                return None
            apart |= dict(zip(indices.tolist(), outcomes, strict=True))
        return [apart[row] for row in range(part.count)]

    def _read(self, part: Calculation) -> Iterator[Outcome]:
        """Yield the outcome of each row of an array call."""
        values = {str(r): part.column(r).spread(part.count) for r in self.outputs}
        parameters = {str(r): self._parameter(part, r) for r in self.parameters}
        judging = Verdicts(part)
        verdicts = {name: judging.rows(subject) for name, subject in self.subjects.items()}
        for row in range(part.count):
            refusal = part.for_all or part.refusals.get(row)
            if refusal is not None:
                yield Outcome((Fault(refusal.place, refusal.code, refusal.detail),))
                continue
            yield Outcome(
                values={name: column[row] for name, column in values.items()},
                parameters={n: float(c[row]) for n, c in parameters.items() if not np.isnan(c[row])},
                units=self.units,
                judged={
                    name: JudgedCriterion.in_row(
                        VERDICTS[int(codes[row])],
                        self.subjects[name].criterion,
                        float(column.margin[row]),
                    )
                    for name, (codes, column) in verdicts.items()
                },
            )

    def _parameter(self, part: Calculation, reference: Reference) -> Array:
        """Return a parameter of a model in the type that the model needs."""
        return part.taken(reference).spread(part.count)


def _chooses_by_tolerance(block: Block) -> bool:
    return block.tolerance is not None and bool(block.cls.levels) and block.level is None


def _is_measured(graph: Graph) -> bool:
    """Return whether any value depends on a measurement or an analysis of a solid."""
    used = (reference for references in graph.used.values() for reference in references)
    inside = (reference for reference in used if reference.block in graph.blocks)
    return any(
        graph.blocks[reference.block].is_model and not is_member(graph, reference) for reference in inside
    )


def _outputs(graph: Graph) -> Iterator[Reference]:
    """Yield the outputs that the steps compute, except texts."""
    for block in graph.blocks.values():
        if not block.is_model:
            computed = graph.computed(block)
            for name in block.cls.formulas if computed is None else computed:
                if not isinstance(block.cls.formulas.get(name), Text):
                    yield Reference(block.name, None, name)


def _parameters(graph: Graph) -> Iterator[Reference]:
    """Yield the parameters of models that are single quantities."""
    for block in graph.blocks.values():
        if block.is_model:
            for name, declared in block.cls.inputs.items():
                if not isinstance(declared, (Choice, Curve, Table)):
                    yield Reference(block.name, None, name)


def _is_incomplete(block: Block) -> bool:
    """Return whether a model lacks parameters, or no output of a step is requested.

    `single` checks such a design.
    """
    if not block.is_model:
        return block.outputs == ()
    inputs = block.cls.inputs.items()
    return any(
        isinstance(declared, (Given, Choice)) and declared.required and name not in block.cells
        for name, declared in inputs
    )


def _by_levels(part: Calculation) -> list[Indices]:
    """Return the rows in groups that start at the same levels as the designs would alone."""
    keys: list[list[str]] = [[] for _ in range(part.count)]
    for step in part.steps.values():
        cls = step.block.cls
        if cls.levels and step.block.level is None and cls.ladder is not Template.ladder and step.has_rows:
            for row, level in _started(step):
                keys[row].append(level)
    groups: dict[tuple[str, ...], list[int]] = {}
    for row, key in enumerate(keys):
        groups.setdefault(tuple(key), []).append(row)
    return [np.array(rows) for rows in groups.values()]


def _started(step: StepRows) -> Iterator[tuple[int, str]]:
    """Yield the starting level of each row that has inputs."""
    for part in step.parts:
        shape = part.template.shape_of_points()
        for place, row in enumerate(part.rows.tolist()):
            if shape == part.rows.shape:
                where = np.arange(part.rows.size) == place
                yield row, part.template.at(part.template.level, where).starting_level()
            else:
                yield row, part.template.starting_level()
