"""Evaluate a template and write its formulas out: symbol = expression = numbers = result."""

from __future__ import annotations

from collections.abc import Container

from app.calculations import json_values
from app.calculations.bodies import EvaluateIn
from app.calculations.schemas.evaluations import Worksheet
from app.calculations.service import evaluated
from app.plain import JsonObject
from app.presentation.units import System, shown_unit
from templates.core.language.evaluate import Evaluation
from templates.core.language.template import Template
from templates.core.paper import report
from templates.core.paper.mathml import mathml


def run_worksheet(cls: type[Template], body: EvaluateIn, system: System) -> JsonObject:
    """Evaluate a template and write its formulas out.

    Raises
    ------
    InvalidInputs, TooManyValues
        As raised by `evaluate`.
    """
    return worksheet(evaluated(cls, body), system)


def worksheet(evaluation: Evaluation, system: System) -> JsonObject:
    """Return an evaluation as `evaluate` returns it, in a system of units and with its formulas."""
    written = formulas(evaluation.template, system, evaluation.outputs)
    answer = {**json_values.evaluation(evaluation), "formulas": written}
    return answer if system == "si" else Worksheet.model_validate(answer).in_units(system).plain()


def formulas(template: Template, system: System, names: Container[str]) -> list[JsonObject]:
    """Return the formulas of the named outputs in LaTeX and MathML, in the order of the template."""
    cls = type(template)
    declared = {a: d.meaning.unit for a, d in cls.declarations.items() if d.meaning.unit}
    units = {attribute: shown_unit(unit, system) for attribute, unit in declared.items()}
    return [_row(row) for row in report.rows(template, units) if row.name in names]


def _row(row: report.Row) -> JsonObject:
    lead = row.symbol if row.expression in ("", row.symbol) else f"{row.symbol}={row.expression}"
    parts = {
        "lead": lead,
        "numbers": row.numbers and f"={row.numbers}",
        "result": row.result and f"={row.result}",
    }
    return {**vars(row), "mathml": {name: latex and mathml(latex) for name, latex in parts.items()}}
