"""Analyse the tolerances of one design: check the request, then compute limits, scatter, yields, shares.

This runs in a calculation process. Each step has the same level in all rows.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from app.designs.document import Document
from app.designs.engine.design_engine import DesignEngine, Refusal, Table
from app.designs.engine.needs import needs, varying
from app.designs.engine.row_design import Targets
from app.designs.graph import Catalogues, Graph, build_graph, raise_if
from app.designs.linear_solids import LinearSolids, parameters_of, slopes_of
from app.designs.origins import solid_measures
from app.designs.roundings import between, in_words, with_chosen_sizes
from app.reference import Reference
from app.schemas.answers import Warning
from app.tolerances.criteria import CriterionVariable, demanded
from app.tolerances.factors import Factor
from app.tolerances.question import Question
from app.tolerances.scatter import SCRAMBLINGS, Rows, Scatter, scatter
from app.tolerances.shares import Shares, shares
from app.tolerances.variables import TolerancedVariable, faults, varied
from app.tolerances.worst import Worst, worst
from cad.inspect import MEASURES
from templates.core.arrays import Array
from templates.core.errors import Fault, unknown_name, unknown_names
from templates.core.language.spec import Choice, Curve, Profile, Text
from templates.core.language.spec import Table as TableInput
from templates.core.progress import report

LEAST_POINTS, USUAL_POINTS, MOST_POINTS = 1024, 16_384, 131_072
MOST_OUTPUTS = 30
ABOUT = "analysis"  # key of the scope among the outputs of an answer
PATIENCE = 20.0
"""Largest estimated time for further points if the request gives no number of points [s]."""
LONGEST = 600.0
"""Largest estimated time of an analysis; longer analyses are refused [s]."""


@dataclass(frozen=True)
class ToleranceResults:
    """The results of an analysis, in SI."""

    nominal: Table
    worst: Worst
    scatter: Scatter
    shares: Shares
    errors: Mapping[Reference, float]


@dataclass
class Analysis:
    """A checked request for a checked design.

    Attributes
    ----------
    outputs
        The analysed outputs, in the order of the answer.
    demands
        The judged criteria, by name.
    warnings
        Warnings about tolerances that do not take part, and about measurements of the first order.
    measures
        The measurements of solids on which the outputs and criteria depend.
    """

    graph: Graph
    engine: DesignEngine
    question: Question
    outputs: list[Reference]
    demands: dict[str, CriterionVariable]
    varied: list[TolerancedVariable]
    warnings: list[Warning]
    measures: list[Reference]
    first_refusal: Refusal | None = None
    stated: dict[str, bool] = field(
        default_factory=dict
    )  # by criterion: whether the errors of all models behind it are known
    _errors: dict[Reference, float] = field(default_factory=dict)
    _levels: dict[str, str | None] = field(default_factory=dict)

    @classmethod
    def of(cls, document: Document, catalogues: Catalogues, question: Question) -> Analysis:
        """Return the analysis of a design.

        Raises
        ------
        InvalidInputs
            If the design or the request has faults; the error lists all of them.
        """
        written, wrong = build_graph(document, catalogues)
        raise_if(wrong)
        document = with_chosen_sizes(document, catalogues)
        graph, _ = build_graph(document, catalogues)
        every = demanded(graph)
        raise_if([*_faults(graph, question, every)])
        named = every if question.criteria is None else {n: every[n] for n in question.criteria}
        outputs = _outputs(graph, question, named)
        wanted = {*outputs, *(r for demand in named.values() for r in demand.references)}
        measures = _measures(graph, wanted)
        wanted |= {one for name in _blocks(measures) for one in parameters_of(graph.blocks[name]).values()}
        chosen, warnings = varied(graph, needs(graph, wanted, ()).cells)
        raise_if(list(faults(chosen, warnings)))
        warnings += _held(written, [one.reference for one in chosen], wanted)
        places = [one.reference for one in chosen]
        warnings += _linear(graph, places, measures)
        engine = DesignEngine.of(document, catalogues, [*places, *measures], wanted=wanted, pending=True)
        return cls(graph, engine, question, outputs, named, chosen, warnings, measures)

    @cached_property
    def factors(self) -> list[Factor]:
        """Return the toleranced values as random numbers."""
        return [one.factor for one in self.varied]

    @property
    def levels(self) -> dict[str, str]:
        """Return the level of each step that has levels."""
        return {step: level for step, level in self._levels.items() if level is not None}

    @property
    def base(self) -> int:
        """Return the number of rows in each sample for the shares."""
        return (self.question.points or USUAL_POINTS) // SCRAMBLINGS

    def carried_out(self) -> ToleranceResults:
        """Return the results of the whole analysis.

        Raises
        ------
        InvalidInputs
            If an output is not a single value, or the levels of the design take too long.
        """
        most = self._most_points()  # from the tables of costs, because a measured speed varies
        nominal = self._nominal()
        self._require_single(nominal)
        self._require_time()
        report(0.05, "the limits are searched")
        ends = worst(self.factors, self._outputs, self.question.seed)
        report(0.4, "products are sampled")
        question = self.question
        spread = scatter(self.factors, self._judged, question.points or USUAL_POINTS, question.seed, most)
        report(0.7, "shares are estimated")
        causes = shares(self.factors, self._outputs, self.base, self.question.seed)
        return ToleranceResults(nominal, ends, spread, causes, self._errors)

    def _nominal(self) -> Table:
        """Return the values of the design itself, at the levels that all rows will have."""
        self._levels = dict(self.question.levels)
        row = np.array([[factor.nominal for factor in self.factors]])
        table = self._table(row, judge=True)
        self._levels |= table.levels
        return table

    def _outputs(self, rows: Array) -> Array:
        return _stacked(self._table(rows), self.outputs)

    def _judged(self, rows: Array) -> Rows:
        table = self._table(rows, judge=True)
        for output, errors in table.errors.items():
            if np.isfinite(errors).any():
                self._errors[output] = max(self._errors.get(output, 0.0), float(np.nanmax(errors)))
        for name, column in table.judged.items():
            self.stated[name] = self.stated.get(name, True) and column.is_known
        margins = {name: column.margin for name, column in table.judged.items()}
        return Rows(_stacked(table, self.outputs), table.verdicts, margins)

    def _table(self, rows: Array, *, judge: bool = False) -> Table:
        """Return the outputs, and with `judge` also the verdicts, for rows of factors."""
        given = {one.reference: rows[:, column] for column, one in enumerate(self.varied)}
        given |= self._measured(given, len(rows))
        criteria = list(self.demands) if judge else []
        table = self.engine(given, self.outputs, levels=self._levels, judge=judge, criteria=criteria)
        if self.first_refusal is None and table.refusals:
            self.first_refusal = table.refusals[min(table.refusals)]
        return table

    def _measured(self, given: Mapping[Reference, Array], count: int) -> dict[Reference, Array]:
        """Return the measurements of the solids of all rows, to the first order in the tolerances."""
        if not self.measures:
            return {}
        point = {one.reference: np.array([one.factor.nominal]) for one in self.varied}
        solids = LinearSolids(self.engine, self.measures, point, self._levels, {}, slopes_of)
        columns = solids.columns(given, count)
        if self.first_refusal is None and solids.refusals:
            self.first_refusal = solids.refusals[min(solids.refusals)]
        return columns

    def _require_single(self, nominal: Table) -> None:
        raise_if(
            [
                Fault(
                    f"outputs.{output}", "shape", "it is a curve or an array; an analysis takes single values"
                )
                for output in self.outputs
                if nominal.columns[output].ndim > 1
            ]
        )

    def _most_points(self) -> int | None:
        """Return the largest number of products to sample if yields need them.

        Return None if the request states the number.
        """
        if self.question.points is not None:
            return None
        self._levels = dict(self.question.levels)
        most = USUAL_POINTS
        while 2 * most <= MOST_POINTS and self._seconds(2 * most) <= PATIENCE:
            most *= 2
        return most

    def _seconds(self, rows: int) -> float:
        return self.engine.seconds(rows, self.outputs, self._levels, criteria=list(self.demands))

    def _require_time(self) -> None:
        """Refuse an analysis that takes too long at these levels, and name a step that takes long."""
        rows = 2000 + (self.question.points or USUAL_POINTS) + self.base * (len(self.factors) + 2)
        seconds = self._seconds(rows)
        if seconds > LONGEST:
            levels = ", ".join(f"{step}: {level}" for step, level in self.levels.items())
            remedy = 'name cheaper ones, for example `"levels": {"film": "map"}`, or ask for fewer points'
            detail = f"{rows} rows at these levels ({levels}) take too long to calculate; {remedy}"
            raise_if([Fault("levels", "too_expensive", detail)])


def _measures(graph: Graph, wanted: Collection[Reference]) -> list[Reference]:
    """Return the measurements on which values depend, without those of finite elements and of distances."""
    behind = solid_measures(graph, Targets.of(wanted))
    return sorted((r for r in behind if r.analysis is None and r.member in MEASURES), key=str)


def _blocks(measures: Sequence[Reference]) -> list[str]:
    """Return the models of measurements, each once."""
    return list(dict.fromkeys(measure.block for measure in measures))


def _linear(graph: Graph, places: Collection[Reference], measures: Sequence[Reference]) -> list[Warning]:
    """Return a warning for each measurement that differs between products."""
    moving = varying(graph, places)
    detail = "it changes by the slopes of the nominal solid, to the first order in the tolerances"
    return [
        Warning(code="first_order", name=str(measure), detail=detail)
        for measure in measures
        if graph.blocks[measure.block].solid in moving
    ]


def _held(graph: Graph, places: Collection[Reference], wanted: Collection[Reference]) -> list[Warning]:
    """Return a warning for each rounded value that would follow a toleranced one."""
    cells = {cell.name: cell for one in between(graph, places, wanted).values() for cell in one}
    detail = "it is chosen once, so all products have the chosen value of the design"
    return [
        Warning(code="held", name=name, detail=f"{in_words([cell])}: {detail}")
        for name, cell in cells.items()
    ]


def _stacked(table: Table, outputs: Sequence[Reference]) -> Array:
    """Return columns side by side as an array of shape (rows, outputs)."""
    return np.stack([table.columns[output] for output in outputs], axis=1)


def _faults(graph: Graph, question: Question, every: Mapping[str, CriterionVariable]) -> Iterator[Fault]:
    """Yield the faults of the names and numbers in a request."""
    unknown = [name for name in question.criteria or () if name not in every]
    yield from (fault.within("criteria") for fault in unknown_names(unknown, every, "criterion"))
    wanted = [name for name in question.outputs or () if not _is_quantity(graph, Reference.parse(name))]
    quantities = [n for n in graph.names() if _is_quantity(graph, Reference.parse(n))]
    yield from (fault.within("outputs") for fault in unknown_names(wanted, quantities, "output"))
    if ABOUT in (question.outputs or ()):
        detail = f"{ABOUT} is where the answer says what was analysed; give this parameter another name"
        yield Fault(f"outputs.{ABOUT}", "reserved", detail)
    points = question.points
    if points is not None and not (LEAST_POINTS <= points <= MOST_POINTS and points & (points - 1) == 0):
        detail = f"points is a power of two from {LEAST_POINTS} to {MOST_POINTS}, such as 16384"
        yield Fault("points", "out_of_range", detail)
    for step, level in question.levels:
        yield from _level_faults(graph, step, level)


def _level_faults(graph: Graph, step: str, level: str) -> Iterator[Fault]:
    block = graph.blocks.get(step)
    if block is None or block.is_model:
        steps = [name for name, block in graph.blocks.items() if not block.is_model]
        yield unknown_name(step, steps, "step").within("levels")
    elif level not in block.cls.levels:
        yield unknown_name(level, block.cls.levels, "level").within(f"levels.{step}")


def _is_quantity(graph: Graph, reference: Reference) -> bool:
    """Return whether a name refers to a value that a row of the design can have."""
    if graph.node(reference) is None and not graph.cell(reference):
        return False
    block = graph.blocks.get(reference.block)
    declared = block and (block.cls.inputs.get(reference.member) or block.cls.formulas.get(reference.member))
    return not isinstance(declared, (Choice, Text, TableInput))


def _outputs(graph: Graph, question: Question, demands: Mapping[str, CriterionVariable]) -> list[Reference]:
    """Return the requested outputs, else those that criteria compare with limits, else all of the steps."""
    if question.outputs is not None:
        return [Reference.parse(name) for name in dict.fromkeys(question.outputs)]
    subjects = [demand.alone for demand in demands.values() if demand.alone is not None]
    outputs = list(dict.fromkeys([r for r in subjects if graph.cell(r) is None] or _all_outputs(graph)))
    return outputs[:MOST_OUTPUTS]


def _all_outputs(graph: Graph) -> Iterator[Reference]:
    for name, block in graph.blocks.items():
        if not block.is_model:
            formulas = block.cls.formulas.items()
            single = [n for n, f in formulas if not isinstance(f, (Text, Profile, Curve))]
            yield from (
                Reference(name, None, n) for n in single if block.outputs is None or n in block.outputs
            )
