"""The values of a design for some rows, as far as they are known, and the faults of the design."""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np

from app.designs.analyses import is_table, measured_unit
from app.designs.engine.columns import Column
from app.designs.engine.needs import Needs
from app.designs.engine.refusals import Refusal, refusal_of
from app.designs.engine.steps import StepRows
from app.designs.network import Graph, Node, SolidAnalysis
from app.reference import Reference
from app.solids.outputs import Outputs as Outputs
from app.solids.questions import Question
from cad.model import CadModel
from templates.core.arrays import Array
from templates.core.errors import Fault, FaultyText, TemplateError
from templates.core.language.evaluate import Evaluation
from templates.core.language.template import Template
from templates.core.units.quantity import TypedQuantity
from templates.core.units.units import Value, unit

Measures = Mapping[str, float]  # measurements of a solid, in the units of MEASURES
Measured = Callable[[CadModel], Measures | None]
Analysed = Callable[[CadModel, Question, tuple[str, ...]], Outputs | None]
NOT_MEASURED = "the stored build lacks this measurement; change the design to rebuild it"
DEFERRED: Literal["deferred"] = "deferred"
DocumentCalculation = Evaluation | Literal["deferred"]
"""The evaluation of a step that is shared with other designs, or a mark that the step is deferred."""


@dataclass
class Calculation:
    """The values [SI] of a design for `count` rows; a single design is one row without varied values.

    Attributes
    ----------
    assumed
        Measurements of solids [SI] that are known in advance, including the values assumed by iterations.
    needs
        The nodes to calculate; all, if None.
    moving
        The nodes whose values differ from row to row.
    levels
        The level of each step in a calculation of rows; None if levels and tolerances of the design apply.
    started
        The level at which the first rows of each step started, for steps without a requested level.
    given
        The values of varied places, as columns.
    changed
        Outputs of steps whose calculated values are replaced by these.
    values
        The values of cells, by cell name.
    typed
        The cells that are equal in all rows, in the form that templates accept.
    prepared
        Evaluations made in advance for steps that are not calculated yet.
    evaluations, steps
        The results of steps that are equal in all rows, and of steps that differ from row to row.
    shapes, measures
        The models whose parameters are all known, and the measurements of the models that are built.
    analyses
        The known outputs of analyses that relations use, by model and kind.
    missing
        The unset parameters of models.
    pending
        The nodes that depend on an unfinished solid or a deferred step.
    deferred
        Expensive steps for which the caller does not wait.
    broken
        The faulty nodes, and the nodes that depend on them.
    faults
        The faults that concern all rows.
    refusals
        For each refused row, the first reason why a value is missing.
    operations
        The number of operations on single values that relations have needed so far for one row.
    """

    graph: Graph
    assumed: Mapping[Reference, float] = field(default_factory=dict)
    needs: Needs | None = None
    moving: Container[Node] = ()
    levels: Mapping[str, str | None] | None = None
    started: dict[str, str] = field(default_factory=dict)
    count: int = 1
    given: Mapping[Reference, Array] = field(default_factory=dict)
    changed: Mapping[Reference, Column] = field(default_factory=dict)
    values: dict[str, Column] = field(default_factory=dict)
    typed: dict[str, TypedQuantity] = field(default_factory=dict)
    prepared: dict[str, DocumentCalculation] = field(default_factory=dict)
    evaluations: dict[str, Evaluation] = field(default_factory=dict)
    steps: dict[str, StepRows] = field(default_factory=dict)
    shapes: dict[str, CadModel] = field(default_factory=dict)
    measures: dict[str, Measures] = field(default_factory=dict)
    analyses: dict[str, dict[str, Outputs]] = field(default_factory=dict)
    missing: dict[str, list[str]] = field(default_factory=dict)
    pending: set[Node] = field(default_factory=set)
    deferred: set[str] = field(default_factory=set)
    broken: set[Node] = field(default_factory=set)
    faults: list[Fault] = field(default_factory=list)
    refusals: dict[int, Refusal] = field(default_factory=dict)
    operations: int = 0

    @property
    def for_all(self) -> Refusal | None:
        """Return the refusal that concerns all rows; None if no fault does."""
        return refusal_of(self.faults) if self.faults else None

    def value(self, reference: Reference) -> Value:
        """Return the value [SI] of a name in a design of one row; its node must be calculated already.

        Raises
        ------
        KeyError, AttributeError, FaultyText
            If the name has no value.
        """
        return self.used(reference).value

    def used(self, reference: Reference) -> Column:
        """Return the value of a name as relations use it; raise the same errors as `value`."""
        if reference in self.changed:
            return self.changed[reference]
        if cell := self.graph.cell(reference):
            if (column := self.values.get(cell.name)) is not None:
                return column
        if reference in self.given:
            return Column(self.given[reference], is_row=True)
        if reference in self.assumed:
            return Column(self.assumed[reference])
        if reference.block in self.steps:
            return self.steps[reference.block].column(reference.member)
        cls = self.graph.blocks[reference.block].cls
        declared = cls.inputs.get(reference.member) or cls.formulas.get(reference.member)
        if declared is None:
            return Column(self.measure(reference))
        with np.errstate(all="ignore"):
            return Column(getattr(self.instance(reference.block), declared.attribute))

    def column(self, reference: Reference) -> Column:
        """Return the value of a name in all rows; NaN while it is pending or missing."""
        step = self.step(reference.block) if self.graph.cell(reference) is None else None
        try:
            if step is not None and reference not in self.changed and reference not in self.given:
                return step.column(reference.member)
            return self.used(reference)
        except (KeyError, AttributeError, TemplateError):
            return Column(np.nan)

    def taken(self, reference: Reference) -> Column:
        """Return the value that a model uses for a parameter; NaN if it has none."""
        if reference.block in self.steps:
            return self.steps[reference.block].column(reference.member)
        shape = self.shapes.get(reference.block)
        if shape is None:
            return Column(np.nan)
        return Column(getattr(shape, shape.inputs[reference.member].attribute))

    def step(self, name: str) -> StepRows | None:
        """Return the rows of a step, or of a model whose values are requested; None while pending."""
        if name in self.steps:
            return self.steps[name]
        evaluation = self.evaluations.get(name)
        if evaluation is None:
            return None
        if name not in self._whole or self._whole[name].evaluation is not evaluation:
            self._whole[name] = StepRows.of(self.graph.blocks[name], evaluation)
        return self._whole[name]

    @cached_property
    def _whole(self) -> dict[str, StepRows]:
        return {}

    def is_output(self, reference: Reference) -> bool:
        """Return whether a name is a calculated output of a step, which may therefore have an error."""
        block = self.graph.blocks.get(reference.block)
        if block is None or block.is_model or reference in self.given or self.graph.cell(reference):
            return False
        return reference.analysis is None and reference.member in block.cls.formulas

    def measure(self, reference: Reference) -> Value:
        """Return a measurement of a solid, or an output of its analyses [SI], by its name.

        An example is `throw.torsion.stiffness`. The value is a number, an array [row, column] for a table, or
        an array for a list.

        Raises
        ------
        FaultyText
            If the analysis gives a reason instead of a value, or the build has no such measurement; the code
            is `no_value`.
        """
        scale = unit(measured_unit(reference))
        if reference.analysis is None:
            measures = self.measures[reference.block]
            if reference.member not in measures:
                raise FaultyText("no_value", f"{reference} has no value: {NOT_MEASURED}")
            return float(scale.to_si(measures[reference.member]))
        computed = self._computed(reference, reference.analysis)
        if is_table(reference):
            return np.asarray(scale.to_si(np.asarray(computed, dtype=float)))
        assert isinstance(computed, int | float), "no table"
        return float(scale.to_si(float(computed)))

    def outputs(self, model: str, kind: str) -> Outputs:
        """Return the known outputs of an analysis that relations use; empty while the analysis is pending."""
        return self.analyses.get(model, {}).get(kind, {})

    def _computed(self, reference: Reference, kind: str) -> object:
        result = self.analyses[reference.block][kind][reference.output or ""]
        if result["value"] is None:
            raise FaultyText("no_value", f"{reference} has no value: {result['reason']}")
        return result["value"]

    def instance(self, block: str) -> Template:
        """Return the template of a step, or the model, with its values.

        If the rows were evaluated in several parts, the template of the first part is returned.

        Raises
        ------
        KeyError
            If there is none, because the block is pending or refused.
        """
        if block in self.steps:
            parts = self.steps[block].parts
            if not parts:
                raise KeyError(block)
            return parts[0].template
        return self.evaluations[block].template if block in self.evaluations else self.shapes[block]

    def waiting(self) -> list[SolidAnalysis]:
        """Return the pending analyses whose models are already built."""
        return [
            node
            for node in self.graph.order
            if isinstance(node, SolidAnalysis) and node in self.pending and node.model.name in self.measures
        ]

    def levels_used(self) -> dict[str, str | None]:
        """Return the level at which each step was calculated; None for a step without levels."""
        used = {name: evaluation.level for name, evaluation in self.evaluations.items()}
        single = {name: level if isinstance(level, str) else None for name, level in used.items()}
        return single | {n: step.level for n, step in self.steps.items() if not step.block.is_model}
