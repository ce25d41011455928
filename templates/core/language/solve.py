"""Find the inputs that give a wanted output: scan between bounds, then close in on every crossing.

The scan is a few array calls at one level of fidelity, so a formula that is not monotone, or jumps, is seen
and said. Every solution between the bounds is returned, with the curve that shows them. A solution is
calculated again at the level requested, where that is another than the scan's.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array
from templates.core.errors import Unreachable
from templates.core.language.confirming import CONFIRMED, POLISHES, Root, confirmed
from templates.core.language.crossings import Leap, meetings
from templates.core.language.evaluate import Evaluation, evaluate
from templates.core.language.intake import Input
from templates.core.language.ledger import Notice
from templates.core.language.question import read_question
from templates.core.language.scan import ROUNDS, SAMPLES, Samples, TargetCurve
from templates.core.language.spec import Formula
from templates.core.language.template import Template

__all__ = [
    "CONFIRMED", "POLISHES", "ROUNDS", "SAMPLES", "Jump", "Root", "Solution", "TracedCurve", "read_question",
    "solve",
]  # fmt: skip

NAMED = 10  # solutions that a warning names
MISSED = 1e-6  # relative miss of a solution beyond which a warning says so


@dataclass(frozen=True)
class Jump:
    """A value of the unknown at which the output jumps across the target, and the output on both sides.

    In the declared units.
    """

    value: float
    before: float
    after: float


@dataclass(frozen=True)
class TracedCurve:
    """The output over the unknown: even samples between the bounds at one level, in the declared units.

    NaN where there is no value; `reasons` says why, None where there is one.
    """

    x: Array
    y: Array
    reasons: NDArray[np.object_]
    level: str | None


@dataclass(frozen=True)
class Solution:
    """The lowest value of the unknown that gives the target [its declared unit], and the evaluation there.

    `roots` are all crossings, `touching` the extrema that just reach the target, each in ascending order;
    jumps and curve have the output in `target_unit`.
    """

    unknown: float
    unit: str
    evaluation: Evaluation
    warnings: list[Notice]
    roots: list[Root]
    touching: list[Root]
    jumps: list[Jump]
    curve: TracedCurve
    target_unit: str


def solve(
    cls: type[Template],
    raw: Mapping[str, Any],
    unknown: str,
    bounds: Sequence[Any],
    target: Mapping[str, Any],
    **options: Any,
) -> Solution:
    """Find the inputs `unknown` between `bounds` for which the one output in `target` has its value.

    `options` go to `evaluate`. Where several solutions exist `unknown` is the lowest, and a warning names
    the others.

    Raises
    ------
    InvalidInputs
        If anything of the question is wrong, or the level requested refuses every solution.
    Unreachable
        If no value between the bounds gives the target, with the range that is reachable.
    """
    declared, bounds_si, formula, wanted = read_question(cls, raw, unknown, bounds, target, **options)
    fidelity: dict[str, Any] = {name: options[name] for name in ("level", "tolerance") if name in options}
    requested = TargetCurve(cls, dict(raw), declared, formula, wanted, fidelity)
    scanned, even, samples = replace(requested, fidelity=_cheap(cls, fidelity)).scan(*bounds_si)
    found = meetings(scanned, samples)
    places = sorted([*found.roots, *found.touching], key=lambda place: place.x)
    if not places:
        raise scanned.unreachable(samples)
    roots = confirmed(requested, scanned, places, bounds_si)
    lowest = next((root for root in roots if root.confirmed), None)
    given = {**raw, unknown: {"value": (lowest or roots[0]).value, "unit": declared.meaning.unit}}
    evaluation = evaluate(cls, given, **options)
    if lowest is None:
        raise _moved_away(scanned, samples, evaluation.level)
    return Solution(
        lowest.value,
        declared.meaning.unit,
        evaluation,
        [
            *_not_monotone(declared, formula, samples.miss),
            *_others(declared, lowest, roots, found.more),
            *_unsettled(formula, roots),
        ],
        [root for root in roots if not root.touches],
        [root for root in roots if root.touches],
        [_jump(scanned, leap) for leap in found.leaps],
        _traced(scanned, even),
        formula.meaning.unit,
    )


def _cheap(cls: type[Template], fidelity: dict[str, Any]) -> dict[str, Any]:
    """The fidelity of the scan: the one requested, or the default level where that may take few points."""
    if not cls.most_points or ((level := fidelity.get("level")) and level not in cls.most_points):
        return fidelity
    return {"level": cls.default_level}


def _moved_away(scanned: TargetCurve, samples: Samples, level: Any) -> Unreachable:
    """The error where the solutions of the scan are none between the bounds at the level requested."""
    error = scanned.unreachable(samples)
    there = scanned.fidelity.get("level")
    detail = (
        f"at level {level} no value between the bounds is found for the target; at level {there} there is"
    )
    return Unreachable(error.name, detail, error.reachable, error.unit)


def _jump(curve: TargetCurve, leap: Leap) -> Jump:
    """A leap in declared units."""
    output = curve.formula.meaning.scale
    sides = (float(output.from_si(side)) for side in (leap.before, leap.after))
    return Jump(float(curve.declared.meaning.scale.from_si(leap.x)), *sides)


def _traced(curve: TargetCurve, even: Samples) -> TracedCurve:
    """The samples of the scan in declared units."""
    x, y = curve.declared.meaning.scale, curve.formula.meaning.scale
    return TracedCurve(
        np.asarray(x.from_si(even.x)),
        np.asarray(y.from_si(even.miss + curve.wanted)),
        even.reasons,
        curve.fidelity.get("level"),
    )


def _not_monotone(declared: Input, formula: Formula[Any], residual: Array) -> list[Notice]:
    finite = residual[np.isfinite(residual)]
    steps, rounding = np.diff(finite), 1e-12 * np.max(np.abs(finite), initial=0.0)
    if (steps >= -rounding).all() or (steps <= rounding).all():
        return []
    detail = f"{formula.name} is not monotone in {declared.name} between the bounds, in this version"
    return [Notice("not_monotone", declared.name, detail)]


def _others(declared: Input, lowest: Root, roots: list[Root], more: int) -> list[Notice]:
    """The warning that there are several solutions, which names the others."""
    others = [root for root in roots if root is not lowest]
    if not others:
        return []
    unit = declared.meaning.scale
    names = ", ".join(declared.meaning.with_unit(float(unit.to_si(root.value))) for root in others[:NAMED])
    rest = f" and {len(others) + more - NAMED} more" if len(others) + more > NAMED else ""
    detail = f"{names}{rest} give the target too; the lowest is returned, see roots"
    return [Notice("several_solutions", declared.name, detail)]


def _unsettled(formula: Formula[Any], roots: list[Root]) -> list[Notice]:
    """A warning if a finer level still misses the target after the last step."""
    worst = max((root.miss for root in roots if root.confirmed), default=0.0)
    if worst <= MISSED:
        return []
    detail = (
        f"{formula.name} misses the target by {worst:.2g} of it after {POLISHES} steps at the finer level"
    )
    return [Notice("not_settled", formula.name, detail)]
