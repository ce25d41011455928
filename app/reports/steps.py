"""Prepare the steps of a revision for a report."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import NotRequired, TypedDict, TypeVar

from app.calculations.json_values import identity
from app.calculations.schemas.evaluations import CalculatedBy, Output, UsedInput, WorkedFormula
from app.catalogue.catalogues import Catalogues
from app.catalogue.sheets import ReleasedSheet
from app.designs.schemas.designs import PreviewedStep
from app.designs.worksheet import checked
from app.plain import Raw
from app.presentation import numbers
from app.reports.cells import Cell, cell, clean, flat, in_si, typed
from app.reports.content import Formula, Identity, Line, Rule, Step, StepWarning
from app.reports.plots import plots_of
from templates.core.catalogue.discovery import Catalogue
from templates.core.errors import TemplateError
from templates.core.language.spec import Formula as DeclaredFormula
from templates.core.language.spec import Input, Profile
from templates.core.language.template import Template
from templates.core.paper.expressions import relation_latex
from templates.core.paper.mathml import mathml, symbol
from templates.core.paper.schema import documentation
from templates.core.paper.verdicts import Check

WAITS = "waits for a solid that is not built"
GUARD = 1e-5  # a domain with less utilisation only guards against overflow and means nothing to an engineer
OF_CURVE = " of its largest value"
"""The reference value for the error of a curve, which may cross zero."""
KINDS = {"domain": "range", "published": "published range", "rule": "rule", "warning": "rule"}
RANGES = ("domain", "published")

T = TypeVar("T", bound=Template)
Class = type[Template] | None
"""The class of a version; None if its file was removed."""


class StepDocument(TypedDict):
    """The part of a step's document that a report shows."""

    inputs: Mapping[str, Raw]
    tolerance: NotRequired[float | None]


def step_of(name: str, step: PreviewedStep, document: StepDocument, catalogues: Catalogues) -> Step:
    """Return one step, built from the worksheet of a revision and from the step as typed (`document`)."""
    calculated_by, catalogue = step.template, catalogues.templates
    review = review_of(catalogues.snapshot.sheets.released.get((calculated_by.id, calculated_by.version)))
    cls = class_of(catalogue, calculated_by.id, calculated_by.version)
    checks = checked(step, catalogue)
    return Step(
        name=name,
        template=replace(version_of(calculated_by, cls), review=review),
        state="done" if step.outputs else WAITS,
        level=_level(step.level, document.get("tolerance")),
        inputs=_inputs(step, document["inputs"], cls),
        formulas=[_formula(row) for row in step.formulas if _exists(step.outputs[row.name])],
        results=[_result(n, step, cls) for n in _ordered(step.outputs, cls.formulas if cls else ())],
        plots=plots_of(step, cls),
        ranges=rules(check for check in checks if check.kind in RANGES),
        rules=rules(check for check in checks if check.kind not in RANGES),
        warnings=[
            StepWarning(w.name.replace("_", " "), _about_the_case(w.detail, checks)) for w in step.warnings
        ],
        assumed=[clean(one.detail) for one in step.assumed],
        references=list(documentation(cls).get("References", ())) if cls else [],
    )


def review_of(sheet: ReleasedSheet | None) -> str:
    """Return the author and reviewer of a worksheet; empty for a template from a file."""
    if sheet is None:
        return ""
    author = f"written by {sheet.author}" if sheet.author else "its author is not named"
    doubt = "" if sheet.is_verified else "; review not verified"
    return f"Worksheet, {author}, reviewed by {sheet.reviewer}{doubt}."


def class_of(catalogue: Catalogue[T], id: str, version: int) -> type[T] | None:
    """Return the class of a version, or None if its file was removed."""
    try:
        return catalogue.get(id, version)
    except TemplateError:
        return None


def version_of(calculated_by: CalculatedBy, cls: Class) -> Identity:
    """Return a version with the digest of the code that calculated, if the revision has the digest."""
    digest = calculated_by.digest or (identity(cls)["digest"] if cls else "")
    title = cls.title() if cls else "a version that is no longer there"
    withdrawn = (cls and cls.withdrawn) or ""
    return Identity(calculated_by.id, calculated_by.version, digest, title, withdrawn)


def rules(checks: Iterable[Check]) -> list[Rule]:
    """Return ranges or rules: first those that are violated, then those with the highest utilisation."""
    useful = [c for c in checks if not (c.kind == "domain" and c.holds and _idle(c.used))]
    return [_rule(check) for check in sorted(useful, key=lambda c: (c.holds, -(c.used or 0.0)))]


def _idle(used: float | None) -> bool:
    return used is None or used < GUARD


def _rule(check: Check) -> Rule:
    states = ("inside", "outside") if check.kind in RANGES else ("kept", "violated")
    return Rule(
        words=check.words if check.holds else check.violation or check.words,
        kind=KINDS[check.kind],
        demand=check.demand and mathml(check.demand),
        numbers=check.numbers and mathml(check.numbers),
        used="" if check.used is None else numbers.share(check.used),
        holds=check.holds,
        state=states[not check.holds],
        remark=f"not at {check.broken} of {check.points} points" if check.broken and check.points > 1 else "",
    )


def _about_the_case(detail: str, checks: Iterable[Check]) -> str:
    """Return a warning; replace the sentence of a violated rule at its beginning by the actual values."""
    for check in checks:
        if check.violation and detail.startswith(check.words):
            return check.violation + detail.removeprefix(check.words)
    return detail


def _level(level: object, tolerance: float | None) -> str:
    wanted = f", chosen for a tolerance of {numbers.percent(tolerance)}" if tolerance else ""
    if level is None:
        return ""
    several = sorted({str(one) for one in flat(level)})
    return ", ".join(several) + wanted


def _inputs(step: PreviewedStep, typed: Mapping[str, Raw], cls: Class) -> list[Line]:
    """Return inputs in the order of the template; those of a waiting step appear as their user typed them."""
    names = _ordered(step.inputs, cls.inputs if cls else ())
    return [_input(name, step.inputs[name], typed.get(name), cls) for name in names]


def _ordered(there: Iterable[str], declared: Iterable[str]) -> list[str]:
    """Return names in the order of their declarations, if there are declarations."""
    order = {name: place for place, name in enumerate(declared)}
    return sorted(there, key=lambda name: order.get(name, len(order)))


def _input(name: str, used: UsedInput | Raw, raw: Raw, cls: Class) -> Line:
    written = typed(raw)
    relation = written if written.lstrip().startswith(("=", "[")) and "=" in written else ""
    if not isinstance(used, UsedInput):
        return Line(words_of(name, cls), symbol_of(name, cls), Cell(text=written), origin="as typed")
    given = used.source == "given" and not relation
    return Line(
        words_of(name, cls),
        symbol_of(name, cls),
        cell(used, whole=given),
        in_si(used),
        relation or used.source,
        relation=relation_mathml(raw),
    )


def relation_mathml(raw: Raw) -> str:
    """Return a relation in MathML; empty if the relation is only a name, or absent."""
    latex = relation_latex(raw)
    return mathml(latex) if latex else ""


def _exists(output: Output) -> bool:
    """Return whether there is a value; if not, the results state the reason."""
    return output.value is not None


def _formula(row: WorkedFormula) -> Formula:
    parts = row.mathml
    return Formula(row.words, row.source or "", parts.lead, parts.numbers, parts.result)


def _result(name: str, step: PreviewedStep, cls: Class) -> Line:
    output = step.outputs[name]
    is_curve = cls is not None and isinstance(cls.formulas.get(name), Profile)
    error = _error(step.error.get(name), is_curve=is_curve) if _exists(output) else ""
    return Line(words_of(name, cls), symbol_of(name, cls), cell(output), error=error)


def _error(error: object, *, is_curve: bool) -> str:
    measured = [e for e in flat(error) if isinstance(e, (int, float))]
    if not measured:
        return ""
    worst = max(measured)
    return "same at all levels" if worst == 0 else f"± {numbers.percent(worst)}{OF_CURVE if is_curve else ''}"


def words_of(name: str, cls: Class) -> str:
    """Return the meaning of a name, in words."""
    declared = _declared(name, cls)
    return declared.meaning.words if declared else name.replace("_", " ")


def symbol_of(name: str, cls: Class) -> str:
    """Return the symbol of a name in MathML; empty for options, which have no symbol."""
    declared = _declared(name, cls)
    return mathml(symbol(declared)) if declared and not hasattr(declared, "options") else ""


def _declared(name: str, cls: Class) -> Input | DeclaredFormula[Template] | None:
    return (cls.inputs.get(name) or cls.formulas.get(name)) if cls else None
