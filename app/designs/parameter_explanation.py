"""Explain a model parameter: dimension ← relation ← output ← formula ← inputs."""

from __future__ import annotations

import numpy as np

from app.calculations import json_values
from app.designs.analyses import measured_unit
from app.designs.engine.calculation import Calculation
from app.designs.network import Block, Cell, Solid, SolidAnalysis
from app.designs.result_cells import rounded_value
from app.plain import JsonObject
from app.reference import Reference
from templates.core.errors import FaultyText
from templates.core.language.spec import Derived, Formula
from templates.core.paper.expressions import relation_latex
from templates.core.paper.mathml import mathml
from templates.core.paper.schema import formula_on_paper
from templates.core.units.units import Value, unit

DEEPEST = 50  # links; many JSON readers, and this program's writer, refuse deeper nesting


def explain(calculation: Calculation, parameter: str) -> JsonObject:
    """Return the explanation of a model parameter as nested `because`; a repeated part is only named.

    Chains are followed up to 50 links; values beyond are marked `deeper` and not explained further.
    """
    return Explainer(calculation).of(Reference.parse(parameter))


def model_parameters(calculation: Calculation) -> list[str]:
    """Return the parameters of all models by their full names: `shell.inner_diameter`."""
    return [f"{block.name}.{tail}" for block in _models(calculation) for tail in block.cls.inputs]


def full_name(calculation: Calculation, name: str) -> str:
    """Return the name of a parameter with that of its model.

    In a design with one model, the name of the parameter alone, such as `inner_diameter`, is enough.
    """
    models = _models(calculation)
    return f"{models[0].name}.{name}" if len(models) == 1 and name in models[0].cls.inputs else name


def _models(calculation: Calculation) -> list[Block]:
    return [block for block in calculation.graph.blocks.values() if block.is_model]


class Explainer:
    """Explains the values of one calculated design; a value that was explained before is only named."""

    def __init__(self, calculation: Calculation, depth: int = 0) -> None:
        self.calculation, self.graph = calculation, calculation.graph
        self.explained: set[Reference] = set()
        self.depth = depth

    def of(self, reference: Reference) -> JsonObject:
        """Return the meaning of a name, and the values on which it depends."""
        name = str(reference)
        if reference in self.explained:
            return {"name": name, "kind": "told_above"}
        if self.depth == DEEPEST:
            return {"name": name, "value": self._value(reference), "kind": "deeper"}
        self.explained.add(reference)
        self.depth += 1
        origin = self._origin(reference)
        self.depth -= 1
        return {"name": name, "value": self._value(reference), **origin}

    def _origin(self, reference: Reference) -> JsonObject:
        if reference in self.graph.assumed:
            return {"kind": "iterated", "because": []}
        if cell := self.graph.cell(reference):
            return self._cell(cell)
        node = self.graph.node(reference)
        if isinstance(node, (Solid, SolidAnalysis)):
            because = [self.of(cell.reference) for cell in node.model.cells.values()]
            return {**_measured_by(node), "because": because}
        return self._declared(reference.block, reference.member)

    def _cell(self, cell: Cell) -> JsonObject:
        if not cell.relations:
            return {"kind": "given", "typed": cell.raw, "because": []}
        because = [self.of(used) for used in (*cell.uses.values(), *cell.tests.values())]
        rounded = {"rounded": row} if (row := rounded_value(self.calculation, cell)) else {}
        return {"kind": "relation", "relation": cell.raw, **rounded, **_on_paper(cell), "because": because}

    def _declared(self, head: str, tail: str) -> JsonObject:
        cls = self.graph.blocks[head].cls
        declared = cls.inputs.get(tail) or cls.formulas[tail]
        if not isinstance(declared, Formula):
            return {"kind": "not_given" if declared.default is None else "default", "because": []}
        kind = "default_formula" if isinstance(declared, Derived) else "formula"
        paper = formula_on_paper(cls, declared)
        because = [self.of(Reference(head, None, used)) for used in paper.pop("uses")]
        del paper["name"]
        about = {"template": json_values.identity(cls), **self._error(head, tail)}
        return {"kind": kind, **about, **paper, "because": because}

    def _error(self, step: str, output: str) -> JsonObject:
        """Return the estimated error of a step's output at its level; nothing if its template has none."""
        evaluation = self.calculation.evaluations.get(step)
        if evaluation is None or output not in evaluation.error:
            return {}
        return {"error": json_values.errors({output: evaluation.error[output]})[output]}

    def _value(self, reference: Reference) -> JsonObject | None:
        """Return the value with its unit; null while it is pending or unset."""
        if reference.output is None:
            kind = self.graph.kinds[reference.block].unit
            column = self.calculation.values.get(reference.block)
            return None if column is None else shown(column.value, kind)
        try:
            si = self.calculation.value(reference)
        except (KeyError, AttributeError, FaultyText):
            return None
        if isinstance(si, str):
            return {"value": si}
        cls = self.graph.blocks[reference.block].cls
        cell = self.graph.cell(reference)
        declared = cell.declared if cell else cls.inputs.get(reference.member)
        declared = declared or cls.formulas.get(reference.member)
        if isinstance(si, tuple):  # a table; empty if it is not set
            si = np.asarray(si)
        if not np.size(si):
            return None
        return shown(si, measured_unit(reference) if declared is None else declared.meaning.unit)


def _on_paper(cell: Cell) -> JsonObject:
    """Return a relation as LaTeX and MathML; nothing if the relation is only a name."""
    latex = relation_latex(cell.raw)
    return {"latex": latex, "mathml": mathml(latex)} if latex else {}


def shown(si: Value, unit_name: str) -> JsonObject:
    """Return a value [SI] in a unit; null if missing."""
    values = np.asarray(unit(unit_name).from_si(si), dtype=float)
    plain = values.astype(object)
    plain[~np.isfinite(values)] = None
    return {"value": plain.tolist(), "unit": unit_name}


def _measured_by(node: Solid | SolidAnalysis) -> JsonObject:
    """Return how a value was obtained: measured on a solid, or computed by an analysis."""
    if isinstance(node, Solid):
        return {"kind": "measured"}
    return {"kind": "analysis", "analysis": node.model.analyses[node.kind].shown()}
