"""The results of the calculation of a design."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from app.designs.analyses import is_table, measured_unit
from app.designs.network import Graph, Node, SolidAnalysis
from app.reference import Reference
from app.solids.outputs import Outputs as Outputs
from app.solids.questions import Question
from cad.model import CadModel
from templates.core.errors import Fault, FaultyText
from templates.core.language.evaluate import Evaluation
from templates.core.language.template import Template
from templates.core.units.quantity import Typed
from templates.core.units.units import Value, unit

Measures = Mapping[str, float]  # in the units of MEASURES
Measured = Callable[[CadModel], Measures | None]
Analysed = Callable[[CadModel, Question, tuple[str, ...]], Outputs | None]
NOT_MEASURED = "this build was measured by an older program, or nothing else is there: change the design"
DEFERRED: Literal["deferred"] = "deferred"
Prepared = Evaluation | Literal["deferred"]
"""The evaluation of a step that is shared with other designs, or that nobody waited for it."""


@dataclass
class Calculation:
    """The results; all values are in SI."""

    graph: Graph
    assumed: Mapping[Reference, float] = field(default_factory=dict)  # with which iterations begin a round
    changed: Mapping[Reference, Value] = field(default_factory=dict)  # outputs of steps that are shifted
    values: dict[str, Value] = field(default_factory=dict)  # of cells
    typed: dict[str, Typed] = field(default_factory=dict)  # cells of blocks as the templates take them
    prepared: dict[str, Prepared] = field(default_factory=dict)  # of steps still to come, taken when they do
    evaluations: dict[str, Evaluation] = field(default_factory=dict)  # of steps
    shapes: dict[str, CadModel] = field(default_factory=dict)  # models whose parameters are all known
    measures: dict[str, Measures] = field(default_factory=dict)  # of models that are built
    analyses: dict[str, dict[str, Outputs]] = field(default_factory=dict)  # by model and kind: used and known
    missing: dict[str, list[str]] = field(default_factory=dict)  # unset parameters of models
    pending: set[Node] = field(default_factory=set)  # what waits for a solid, or for a deferred step
    deferred: set[str] = field(default_factory=set)  # expensive steps that nobody waited for
    broken: set[Node] = field(default_factory=set)  # what follows from a fault
    faults: list[Fault] = field(default_factory=list)
    operations: int = 0  # on single values, of the relations so far

    def value(self, reference: Reference) -> Value:
        """The value [SI] of a name, once its node is calculated."""
        if reference in self.assumed:
            return self.assumed[reference]
        if reference in self.changed:
            return self.changed[reference]
        if cell := self.graph.cell(reference):
            if cell.name in self.values:
                return self.values[cell.name]
        cls = self.graph.blocks[reference.block].cls
        declared = cls.inputs.get(reference.member) or cls.formulas.get(reference.member)
        if declared is None:
            return self.measure(reference)
        with np.errstate(all="ignore"):
            return getattr(self.instance(reference.block), declared.attribute)  # type: ignore[no-any-return]

    def measure(self, reference: Reference) -> Value:
        """A measure of a solid, or output of its analyses [SI], by its name: `throw.torsion.stiffness`.

        A number, a table as an array [row, column], or a list as an array.

        Raises
        ------
        FaultyText
            With code `no_value`, where an analysis has a reason instead, or a build lacks the measure.
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
        """The outputs of an analysis that are used and calculated; empty while it is pending."""
        return self.analyses.get(model, {}).get(kind, {})

    def _computed(self, reference: Reference, kind: str) -> object:
        result = self.analyses[reference.block][kind][reference.output or ""]
        if result["value"] is None:
            raise FaultyText("no_value", f"{reference} has no value: {result['reason']}")
        return result["value"]

    def instance(self, block: str) -> Template:
        """The template of a step, or the model, with its values."""
        return self.evaluations[block].template if block in self.evaluations else self.shapes[block]

    def waiting(self) -> list[SolidAnalysis]:
        """The analyses that are waited for, of models that are built."""
        return [
            node
            for node in self.graph.order
            if isinstance(node, SolidAnalysis) and node in self.pending and node.model.name in self.measures
        ]
