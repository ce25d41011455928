"""Steps of a revision as a report shows them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from app.calculations.rendering import identity
from app.designs.worksheet import checked
from app.presentation import numbers
from app.presentation.units import System
from app.reports.cells import Cell, cell, in_si, shown
from app.reports.cells import typed as as_typed
from app.reports.content import Formula, Identity, Line, Step, Verdict, Warned
from templates.core.catalogue.finding import Catalogue
from templates.core.errors import TemplateError
from templates.core.language.template import Template
from templates.core.paper.mathml import mathml, symbol
from templates.core.paper.schema import documentation
from templates.core.paper.verdicts import Check

WAITS = "waits for a solid that is not built"
GUARD = 1e-5  # a domain that is used less than this guards against overflow and tells an engineer nothing
KINDS = {"domain": "range", "published": "published range", "rule": "rule", "warning": "rule"}


def step_of(
    name: str,
    told: Mapping[str, Any],
    typed: Mapping[str, Any],
    catalogue: Catalogue[Template],
    system: System,
) -> Step:
    """One step; `told` is what the revision's worksheet says of it, `typed` the step of the document."""
    cls = known(catalogue, told["template"])
    done = bool(told["outputs"])
    return Step(
        name=name,
        template=version_of(told["template"], cls),
        state="done" if done else WAITS,
        level=_level(told["level"], typed.get("tolerance")),
        inputs=_inputs(told, typed, cls),
        formulas=[_formula(row) for row in told["formulas"] if _exists(told["outputs"][row["name"]])],
        results=[_result(n, told, cls, system) for n in _ordered(told["outputs"], cls and cls.formulas)],
        checks=verdicts(checked(told, catalogue)),
        warnings=[Warned(w["name"].replace("_", " "), w["detail"]) for w in told["warnings"]],
        references=list(documentation(cls).get("References", ())) if cls else [],
    )


def known(catalogue: Catalogue[Any], told: Mapping[str, Any]) -> Any:
    """The class of a version, or None if its file was taken away."""
    try:
        return catalogue.get(told["id"], told["version"])
    except TemplateError:
        return None


def version_of(told: Mapping[str, Any], cls: Any) -> Identity:
    """A version with the digest of the code that calculated, as far as the revision knows it."""
    digest = told.get("digest") or (identity(cls)["digest"] if cls else "")
    title = cls.title() if cls else "a version that is no longer there"
    return Identity(told["id"], told["version"], digest, title, (cls and cls.withdrawn) or "")


def verdicts(found: Iterable[Check]) -> list[Verdict]:
    """Checks, those that do not hold first, then those that use most."""
    useful = [c for c in found if not (c.kind == "domain" and c.holds and _idle(c.used))]
    return [_verdict(check) for check in sorted(useful, key=lambda c: (c.holds, -(c.used or 0.0)))]


def _idle(used: float | None) -> bool:
    return used is None or used < GUARD


def _verdict(check: Check) -> Verdict:
    remark = f"not at {check.broken} of {check.points} points" if check.broken and check.points > 1 else ""
    return Verdict(
        words=check.words,
        kind=KINDS[check.kind],
        demand=check.demand and mathml(check.demand),
        numbers=check.numbers and mathml(check.numbers),
        used="" if check.used is None else numbers.share(check.used),
        share=check.used,
        holds=check.holds,
        remark=remark,
    )


def _level(level: Any, tolerance: float | None) -> str:
    wanted = f", chosen for a tolerance of {numbers.percent(tolerance)}" if tolerance else ""
    if level is None:
        return ""
    several = sorted({str(one) for one in _flat(level)})
    return ", ".join(several) + wanted


def _flat(value: Any) -> list[Any]:
    return [item for part in value for item in _flat(part)] if isinstance(value, list) else [value]


def _inputs(told: Mapping[str, Any], typed: Mapping[str, Any], cls: Any) -> list[Line]:
    """Inputs in the order of the template; those of a step that waits are as typed."""
    names = _ordered(told["inputs"], cls and cls.inputs)
    return [_input(name, told["inputs"][name], typed["inputs"].get(name), cls) for name in names]


def _ordered(there: Iterable[str], declared: Iterable[str] | None) -> list[str]:
    """Names in the order of their declarations, where there are any."""
    order = {name: place for place, name in enumerate(declared or ())}
    return sorted(there, key=lambda name: order.get(name, len(order)))


def _input(name: str, used: Any, raw: Any, cls: Any) -> Line:
    written = as_typed(raw)
    relation = written if written.lstrip().startswith(("=", "[")) and "=" in written else ""
    if not (isinstance(used, Mapping) and "from" in used):
        return Line(words_of(name, cls), symbol_of(name, cls), Cell(text=written), origin="as typed")
    given = used["from"] == "given" and not relation
    return Line(
        words_of(name, cls),
        symbol_of(name, cls),
        cell(used, whole=given),
        in_si(used),
        relation or used["from"],
    )


def _exists(answer: Mapping[str, Any]) -> bool:
    """Whether there is a value; if not, the results say why."""
    return answer["value"] is not None


def _formula(row: Mapping[str, Any]) -> Formula:
    parts = row["mathml"]
    return Formula(row["words"], row["source"] or "", parts["lead"], parts["numbers"], parts["result"])


def _result(name: str, told: Mapping[str, Any], cls: Any, system: System) -> Line:
    answer = told["outputs"][name]
    error = _error(told["error"].get(name)) if _exists(answer) else ""
    return Line(words_of(name, cls), symbol_of(name, cls), shown(answer, system), error=error)


def _error(error: Any) -> str:
    known = [e for e in _flat(error) if isinstance(e, (int, float))]
    if not known:
        return ""
    worst = max(known)
    return "same at all levels" if worst == 0 else f"± {numbers.percent(worst)}"


def words_of(name: str, cls: Any) -> str:
    """What a name means, in words."""
    declared = _declared(name, cls)
    return declared.meaning.words if declared else name.replace("_", " ")


def symbol_of(name: str, cls: Any) -> str:
    """The symbol of a name in MathML; empty for options, which have none on paper."""
    declared = _declared(name, cls)
    return mathml(symbol(declared)) if declared and not hasattr(declared, "options") else ""


def _declared(name: str, cls: Any) -> Any:
    return (cls.inputs.get(name) or cls.formulas.get(name)) if cls else None
