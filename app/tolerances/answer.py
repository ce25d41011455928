"""Convert a tolerance analysis to the answer: in declared units, with a reason for each missing value."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, log2

import numpy as np

from app.designs.tasks import DesignTask
from app.reference import Reference
from app.schemas.answers import Quantity
from app.tolerances import schemas as answers
from app.tolerances import shares as indices
from app.tolerances.analysis import Analysis, ToleranceResults
from app.tolerances.bodies import ToleranceIn
from app.tolerances.criteria import CriterionVariable
from app.tolerances.scatter import AIM, Spread, Yield
from app.tolerances.schemas import ToleranceAnalysis
from app.tolerances.worst import Extreme
from templates.core.arrays import Array
from templates.core.units.units import Unit, Value, unit

DIGITS = 10  # digits of a value in its unit; further digits are rounding errors
REFUSED = "the design refuses some products, so there are no shares; see analysis.refused"
STEADY = "no tolerance changes it"


def answer(analysis: Analysis, findings: ToleranceResults, revision: int) -> answers.ToleranceAnalysis:
    """Return the complete answer."""
    return _Answer(analysis, findings).whole(revision)


@dataclass(frozen=True)
class _Answer:
    analysis: Analysis
    findings: ToleranceResults

    def whole(self, revision: int) -> answers.ToleranceAnalysis:
        """Return the complete answer: the scope of the analysis, and every output by name."""
        outputs = {
            str(reference): self._output(column, reference)
            for column, reference in enumerate(self.analysis.outputs)
        }
        return answers.ToleranceAnalysis.model_validate({"analysis": self._about(revision), **outputs})

    def _about(self, revision: int) -> answers.About:
        analysis, findings = self.analysis, self.findings
        question = analysis.question
        parts = {
            "revision": revision,
            "points": findings.scatter.rows,
            "seed": question.seed,
            "rows": 1 + findings.worst.rows + findings.scatter.rows + findings.shares.rows,
            "toleranced": {
                one.factor.name: self._toleranced(place) for place, one in enumerate(analysis.varied)
            },
            "levels": analysis.levels,
            "criteria": {name: one for name in analysis.demands if (one := self._yield(name, None))},
            "not_judged": {
                name: self._why(name) for name in analysis.demands if not findings.scatter.yields[name]
            },
            "refused": self._refused(),
            "warnings": analysis.warnings,
        }
        optional = (n for n, field in answers.About.model_fields.items() if not field.is_required())
        left_out = {name for name in optional if parts[name] in (None, [], {})}
        return answers.About(**{name: part for name, part in parts.items() if name not in left_out})

    def _toleranced(self, place: int) -> answers.TolerancedValue:
        one, quantity = self.analysis.varied[place].factor, self._quantity
        zone = getattr(self.analysis.varied[place].typed.tolerance, "zone", None)
        ends = {name: quantity(place, getattr(one, name)) for name in ("nominal", "low", "high")}
        parts = {**ends, "distribution": one.distribution, **({"zone": zone} if zone else {})}
        return answers.TolerancedValue.model_validate(parts)

    def _quantity(self, place: int, si: float) -> Quantity:
        """Return a toleranced value in the unit that its user typed."""
        scale = unit(self.analysis.varied[place].typed.unit)
        return Quantity(value=_short(scale.from_si(si)), unit=scale.text)

    def _at(self, row: Array) -> dict[str, Quantity]:
        factors = self.analysis.factors
        return {f.name: self._quantity(place, float(row[place])) for place, f in enumerate(factors)}

    def _refused(self) -> answers.RefusedProducts | None:
        worst, refusal = self.findings.worst, self.analysis.first_refusal
        rows = worst.refused + self.findings.scatter.refused
        if not rows or refusal is None:
            return None
        at = {} if worst.first_refused is None else self._at(worst.first_refused)
        return answers.RefusedProducts(rows=rows, at=at, reason=f"{refusal.place}: {refusal.detail}")

    def _why(self, name: str) -> answers.UnjudgedCriterion:
        if missing := self.analysis.demands[name].missing:
            return answers.UnjudgedCriterion(reason="a limit is missing", give=missing)
        return answers.UnjudgedCriterion(reason="its value or its limit has no value")

    def _output(self, column: int, reference: Reference) -> answers.OutputScatter:
        scale = unit(self.analysis.engine.unit(reference))
        nominal = float(self.findings.nominal.columns[reference][0])
        yields = [
            one for name in self._criteria_of(reference) if (one := self._yield(name, scale, reference))
        ]
        parts = {
            "unit": scale.text,
            "nominal": None if np.isnan(nominal) else _short(scale.from_si(nominal)),
            "worst": self._worst(column, scale),
            **_spread(self.findings.scatter.spreads[column], scale),
            **self._shares(column),
            "relative_error": self.findings.errors.get(reference),
            "yield": min(yields, key=lambda one: one.value, default=None),
            "yields": yields,
        }
        given = {
            name: part for name, part in parts.items() if part not in (None, [], {}) or name == "nominal"
        }
        return answers.OutputScatter.model_validate(given)

    def _criteria_of(self, reference: Reference) -> list[str]:
        """Return the criteria that compare an output with a limit."""
        return [name for name, demand in self.analysis.demands.items() if reference in demand.judged]

    def _worst(self, column: int, scale: Unit) -> answers.Worst | None:
        ends = self.findings.worst.ends[column]
        if ends is None:
            return None
        low, high = (self._extreme(end, scale) for end in ends)
        return answers.Worst(low=low, high=high)

    def _extreme(self, end: Extreme, scale: Unit) -> answers.Extreme:
        return answers.Extreme(value=_short(scale.from_si(end.value)), at=self._at(end.at))

    def _shares(self, column: int) -> dict[str, object]:
        parts = self.findings.shares.outputs[column]
        if parts is None:
            return {"reason": self._no_shares(column)}
        named = zip(self.analysis.factors, parts.shares, strict=True)
        ordered = sorted(named, key=lambda one: -one[1].total)
        total = answers.SharesSum(value=parts.sum, standard_error=parts.sum_error)
        return {"shares": {factor.name: _share(one) for factor, one in ordered}, "shares_sum": total}

    def _no_shares(self, column: int) -> str:
        if self.findings.scatter.spreads[column] is None:
            reference = self.analysis.outputs[column]
            absent = self.findings.nominal.absent.get(reference)
            return absent or "it has no value in any product"
        return REFUSED if self.findings.worst.refused or self.findings.scatter.refused else STEADY

    def _yield(self, name: str, scale: Unit | None, of: Reference | None = None) -> answers.Yield | None:
        one, demand = self.findings.scatter.yields[name], self.analysis.demands[name]
        if one is None:
            return None
        limit = self._limit(name, demand) if scale is not None and demand.alone == of else None
        parts = {
            "of": name,
            "value": one.value,
            "standard_error": one.standard_error,
            "with_model_error": list(one.with_model_error),
            "error_stated": self.analysis.stated.get(name, True),
            "limit": None if limit is None or scale is None else _short(scale.from_si(limit)),
            "sign": demand.criterion.sign,
            "points_needed": _needed(one, self.findings.scatter.rows),
        }
        return answers.Yield.model_validate({n: part for n, part in parts.items() if part is not None})

    def _limit(self, name: str, demand: CriterionVariable) -> float | None:
        """Return the limit [SI], if it is the same for all products."""
        if not demand.has_one_limit:
            return None
        limit = float(self.findings.nominal.judged[name].limit[0])
        return None if np.isnan(limit) else limit


def _short(number: Value) -> float:
    return float(f"{float(number):.{DIGITS}g}")


def _spread(spread: Spread | None, scale: Unit) -> dict[str, object]:
    if spread is None:
        return {}
    edges = [_short(scale.from_si(float(edge))) for edge in spread.edges]
    return {
        "mean": _short(scale.from_si(spread.mean)),
        "standard_deviation": _short(spread.deviation / scale.factor),
        "quantiles": {f"{share:g}": _short(scale.from_si(si)) for share, si in spread.quantiles.items()},
        "histogram": answers.Histogram(edges=edges, counts=list(spread.counts)),
    }


def _share(share: indices.Share) -> answers.Share:
    return answers.Share(
        first=share.first,
        total=share.total,
        first_standard_error=share.first_error,
        total_standard_error=share.total_error,
    )


def _needed(one: Yield, points: int) -> int | None:
    """Return the points needed for the wanted standard error, if it decreases as for random points."""
    if one.standard_error <= AIM:
        return None
    return points << ceil(2 * log2(one.standard_error / AIM))


def analysed(task: DesignTask, revision: int, body: str) -> ToleranceAnalysis:
    """Return the complete answer in SI units to a request body [JSON text] about a revision.

    Raises
    ------
    InvalidInputs
        If the design or the request has faults; the error lists all of them.
    """
    document, catalogues = task.read()
    analysis = Analysis.of(document, catalogues, ToleranceIn.model_validate_json(body).question())
    return answer(analysis, analysis.carried_out(), revision)
