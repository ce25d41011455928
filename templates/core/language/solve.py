"""Find the inputs that give a wanted output: scan between bounds, then refine every crossing.

The scan consists of a few array calls at one level of fidelity, so jumps and non-monotone formulas are
detected and reported. Every solution between the bounds is returned, together with the curve. If the
requested level differs from that of the scan, each solution is recalculated at the requested level.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from templates.core.language.confirmation import CONFIRMED, POLISHES, Root
from templates.core.language.evaluate import Evaluation, evaluate
from templates.core.language.ledger import Notice
from templates.core.language.question import read_question
from templates.core.language.roots import Jump, TracedCurve, roots_of
from templates.core.language.scan import ROUNDS, SAMPLES, TargetCurve
from templates.core.language.template import Template

__all__ = [
    "CONFIRMED", "POLISHES", "ROUNDS", "SAMPLES", "Jump", "Root", "Solution", "TracedCurve", "read_question",
    "solve",
]  # fmt: skip


@dataclass(frozen=True)
class Solution:
    """The lowest value of the unknown that gives the target [in its declared unit], and the evaluation there.

    `roots` are all crossings, `touching` the extrema that just reach the target, each in ascending order;
    jumps and curves give the output in `target_unit`. `finer` are the curves at the levels that confirmed
    solutions, if these differ from the level of `curve`.
    """

    unknown: float
    unit: str
    evaluation: Evaluation
    warnings: list[Notice]
    roots: list[Root]
    touching: list[Root]
    jumps: list[Jump]
    curve: TracedCurve
    finer: list[TracedCurve]
    target_unit: str


def solve(
    cls: type[Template],
    raw: Mapping[str, Any],
    unknown: str,
    between: Sequence[Any],
    target: Mapping[str, Any],
    **options: Any,
) -> Solution:
    """Find the values of `unknown` in the interval `between` that give the one output in `target` its value.

    `options` are passed to `evaluate`. If there are several solutions, `unknown` of the result is the lowest,
    and a warning names the others.

    Raises
    ------
    InvalidInputs
        If anything in the question is wrong, or the requested level refuses every solution.
    Unreachable
        If no value between the bounds gives the target; the error contains the reachable range.
    """
    declared, interval, formula, wanted = read_question(cls, raw, unknown, between, target, **options)
    fidelity: dict[str, Any] = {name: options[name] for name in ("level", "tolerance") if name in options}
    requested = TargetCurve(
        declared.meaning, formula.meaning, wanted, cls, dict(raw), declared, formula, fidelity
    )
    roots = roots_of(requested, replace(requested, fidelity=_cheap(cls, fidelity)), interval)
    given = {**raw, unknown: {"value": roots.lowest.value, "unit": declared.meaning.unit}}
    return Solution(
        roots.lowest.value,
        declared.meaning.unit,
        evaluate(cls, given, **options),
        roots.warnings,
        roots.roots,
        roots.touching,
        roots.jumps,
        roots.curve,
        roots.finer,
        formula.meaning.unit,
    )


def _cheap(cls: type[Template], fidelity: dict[str, Any]) -> dict[str, Any]:
    """Return the fidelity of the scan.

    It is the requested one, or the default level if the requested level accepts only a few points.
    """
    if not cls.most_points or ((level := fidelity.get("level")) and level not in cls.most_points):
        return fidelity
    return {"level": cls.default_level}
