"""The lines of a design's worksheet as a revision stores them: results, checks and plots."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from app.calculations.json_values import outputs
from app.designs.document import WORKSHEET
from app.designs.engine.calculation import Calculation
from app.designs.schemas.worksheets import DesignLine, DesignPlot, PlottedValue
from app.presentation.prose import html_of
from app.schemas.answers import Shown
from templates.core.language.evaluate import Evaluation
from templates.core.language.spec import Formula
from templates.core.language.template import Template
from templates.core.paper.mathml import mathml
from templates.core.sheets.design_lines import Plot
from templates.core.sheets.sheet import Sheet, Statement

OWN_ROW = "design"
ONE_POINT = "there is one point only: plot two lists, or give the design variants"
SEVERAL = "these are tables of several lists: plot two single lists"
WAITS = "not calculated yet"

Numbers = NDArray[np.float64]


def lines(calculation: Calculation, rows: Mapping[str, Calculation]) -> list[DesignLine]:
    """Return the lines of a design's worksheet with the values of a calculation; empty if it has none.

    `rows` are the calculations of the design itself and of its variants, which plots of single values show.
    """
    block = calculation.graph.blocks.get(WORKSHEET)
    if block is None or not isinstance(sheet := block.cls.sheet, Sheet):
        return []
    own = calculation.evaluations.get(WORKSHEET)
    by_row = {name: one.evaluations.get(WORKSHEET) for name, one in rows.items()}
    evaluations = {name: one for name, one in by_row.items() if one is not None}
    return [line for one in sheet.statements for line in _lines(block.cls, sheet, one, own, evaluations)]


Evaluations = Mapping[str, Evaluation]
"""The evaluations of the worksheet by row."""


def _lines(
    cls: type[Template], sheet: Sheet, statement: Statement, own: Evaluation | None, rows: Evaluations
) -> Iterator[DesignLine]:
    """Yield one line for a statement, or one for each unknown of a system of equations."""
    plain = {"line": statement.line, "last_line": statement.last_line, "kind": statement.kind}
    if statement.kind == "plot":
        plot = next(one for one in sheet.plots if one.line == statement.line)
        yield _plotted(cls, plot, own, rows, plain)
    elif results := _results(cls, statement):
        for number, formula in enumerate(results):
            latex = "" if number else statement.latex
            yield _valued(own, formula, {**plain, "latex": latex})
    else:
        name = f"{WORKSHEET}.{statement.name}" if statement.kind == "check" else ""
        yield DesignLine.model_validate(
            {**plain, "name": name, "words": statement.words, "latex": statement.latex}
        )


def _results(cls: type[Template], statement: Statement) -> list[Formula[Template]]:
    """Return the results that a statement calculates."""
    if statement.kind not in ("formula", "solve"):
        return []
    return [one for one in cls.formulas.values() if getattr(one.function, "line", 0) == statement.line]


def _valued(
    evaluation: Evaluation | None, formula: Formula[Template], plain: Mapping[str, object]
) -> DesignLine:
    """Return the line of a result; without an evaluation it says that the value is not calculated."""
    about = {**plain, "name": f"{WORKSHEET}.{formula.name}", "words": formula.meaning.words}
    answer = evaluation.outputs.get(formula.name) if evaluation else None
    if answer is None:
        return DesignLine.model_validate({**about, "reason": WAITS})
    shown = outputs({formula.name: answer})[formula.name]
    value = {"value": shown["value"], "unit": shown.get("unit")}
    reason = {"reason": shown["reason"]} if "reason" in shown else {}
    return DesignLine.model_validate({**about, **({} if reason else {"value": value}), **reason})


def _plotted(
    cls: type[Template],
    plot: Plot,
    own: Evaluation | None,
    evaluations: Evaluations,
    plain: Mapping[str, object],
) -> DesignLine:
    """Return the line of a plot: of two lists, or of two single values over the rows of the design."""
    x, y = cls.declarations[plot.x], cls.declarations[plot.y]
    words = plot.words or f"{y.meaning.words} over {x.meaning.words}"
    about = {**plain, "name": "", "words": words, "latex": ""}
    if own is None:
        return DesignLine.model_validate({**about, "reason": WAITS})
    across, upright = _value(own, plot.x), _value(own, plot.y)
    rows: list[str] = []
    if not np.ndim(across) and not np.ndim(upright):
        rows = list(evaluations)
        across, upright = (
            np.array([_value(one, at) for one in evaluations.values()]) for at in (plot.x, plot.y)
        )
    if reason := _nothing_to_draw(across, upright):
        return DesignLine.model_validate({**about, "reason": reason})
    axes = {"x": _axis(cls, plot.x, across), "y": _axis(cls, plot.y, upright)}
    drawn = DesignPlot.model_validate({**axes, **({"rows": rows} if rows else {})})
    return DesignLine.model_validate({**about, "plot": drawn})


def _value(evaluation: Evaluation, attribute: str) -> Numbers:
    """Return a value of the worksheet in its declared unit."""
    template = evaluation.template
    scale = template.declarations[attribute].meaning.scale
    with np.errstate(all="ignore"):
        return np.asarray(scale.from_si(getattr(template, attribute)), dtype=float)


def _nothing_to_draw(x: Numbers, y: Numbers) -> str:
    if x.ndim > 1 or y.ndim > 1:
        return SEVERAL
    if x.shape != y.shape:
        return f"there are {x.size} values on one axis and {y.size} on the other: plot lists of one length"
    return "" if x.size > 1 else ONE_POINT


def _axis(cls: type[Template], attribute: str, values: Numbers) -> PlottedValue:
    meaning = cls.declarations[attribute].meaning
    numbers = [value if np.isfinite(value) else None for value in values.tolist()]
    return PlottedValue(words=meaning.words, values=Shown(value=numbers, unit=meaning.unit))


def typeset(stored: Sequence[DesignLine]) -> list[DesignLine]:
    """Return stored lines with their formulas as MathML and their prose as HTML."""
    return [one.model_copy(update=_markup(one)) for one in stored]


def _markup(line: DesignLine) -> dict[str, str]:
    if line.kind == "prose":
        return {"html": html_of(line.words)}
    return {"mathml": mathml(line.latex)} if line.latex else {}
