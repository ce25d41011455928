"""Find the input that gives a wanted output: scan between bounds, then close in on the crossing.

The scan is one array call, so a formula that is not monotone, or jumps, is seen and said.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.optimize import brentq

from templates.core.arrays import Array, Mask
from templates.core.errors import Fault, FaultyText, InvalidInputs, Unreachable, unknown_name
from templates.core.language.evaluate import Evaluation, evaluate
from templates.core.language.intake import Input, is_single
from templates.core.language.ledger import Notice
from templates.core.language.request import read_options
from templates.core.language.spec import Choice, Curve, Formula, Profile, Table, Text
from templates.core.language.template import Template
from templates.core.units.quantity import Typed, read

SAMPLES = 1025  # of the scan; cheap as one array call
INTERVALS, FINER, ROUNDS = 20, 65, 5  # where something happens: so many intervals, in so many parts, so often
POLISHES, POLISHED = 8, 1e-9  # steps at an expensive level, and the relative miss with which they end
JUMP = 1e-6  # relative residual at a crossing beyond which it is a jump, not a solution


@dataclass(frozen=True)
class Solution:
    """The value of the solution [declared unit of the unknown], and the evaluation there."""

    unknown: float
    unit: str
    evaluation: Evaluation
    warnings: list[Notice]


def solve(
    cls: type[Template],
    raw: Mapping[str, Any],
    unknown: str,
    bounds: Sequence[Any],
    target: Mapping[str, Any],
    **options: Any,
) -> Solution:
    """Find the input `unknown` between `bounds` for which the one output in `target` has its value.

    `options` go to `evaluate`. Where several solutions exist the lowest is returned and a warning names
    the others.

    Raises
    ------
    InvalidInputs
        If anything of the question is wrong.
    Unreachable
        If no value between the bounds gives the target, with the range that is reachable.
    """
    declared, (low, high), formula, wanted = read_question(cls, raw, unknown, bounds, target, **options)
    fidelity: dict[str, Any] = {name: options[name] for name in ("level", "tolerance") if name in options}
    requested = _Curve(cls, dict(raw), declared, formula, wanted, fidelity)
    curve = replace(requested, fidelity=_cheap(cls, fidelity))
    grid, residual = curve.scan(low, high)
    roots = curve.roots(grid, residual)
    if not roots:
        raise curve.unreachable(grid, residual)
    unit = declared.meaning.unit
    root = roots[0] if curve == requested else requested.polished(roots[0], curve)
    value = float(declared.meaning.scale.from_si(root))
    evaluation = evaluate(cls, {**raw, unknown: {"value": value, "unit": unit}}, **options)
    return Solution(
        value, unit, evaluation, [*_not_monotone(declared, formula, residual), *_others(declared, roots)]
    )


def _cheap(cls: type[Template], fidelity: dict[str, Any]) -> dict[str, Any]:
    """The fidelity of the scan: the one requested, or the default level where that may take few points."""
    if not cls.most_points or ((level := fidelity.get("level")) and level not in cls.most_points):
        return fidelity
    return {"level": cls.default_level}


def read_question(
    cls: type[Template],
    raw: Mapping[str, Any],
    unknown: str,
    bounds: Sequence[Any],
    target: Mapping[str, Any],
    *,
    tolerance: float | None = None,
    **names: Any,
) -> tuple[Input, tuple[float, float], Formula[Any], float]:
    """Return the declarations and SI values that the question is about; `names` go to `read_options`.

    Raises
    ------
    InvalidInputs
        Naming everything that is wrong with the question at once.
    """
    *_, faults = read_options(cls, **names)
    declared, formula = _unknown(cls, unknown, faults), None
    if unknown in raw:
        faults.append(Fault(f"inputs.{unknown}", "solved_for", "this input is solved for; leave it out"))
    ends = _ends(declared, bounds, faults) if declared else (0.0, 1.0)
    wanted = 0.0
    if len(target) != 1:
        faults.append(Fault("target", "one_output", "name exactly one output and its wanted value"))
    for name, value in list(target.items())[:1]:
        formula = cls.formulas.get(name)
        if formula is None:
            faults.append(unknown_name(name, cls.formulas, "output").within("target"))
        elif isinstance(formula, (Profile, Text)):
            faults.append(Fault(f"target.{name}", "not_a_number", "only a single value can be aimed at"))
        else:
            wanted = _scalar(value, formula.meaning.unit, f"target.{name}", faults)
    faults += _faulty_inputs(cls, raw, unknown, declared, ends)
    if faults or declared is None or formula is None:
        raise InvalidInputs(faults)
    return declared, ends, formula, wanted


def _unknown(cls: type[Template], name: str, faults: list[Fault]) -> Input | None:
    """The declaration of the unknown, if it is a quantity that can take any value."""
    declared = cls.inputs.get(name)
    if declared is None:
        fault = unknown_name(name, _solvable(cls), "input")
        faults.append(Fault("unknown", fault.code, fault.detail))
    elif name not in _solvable(cls):
        detail = f"{name} takes no continuous values; one of {', '.join(_solvable(cls))} can be solved for"
        faults.append(Fault("unknown", "not_solvable", detail))
        return None
    return declared


def _solvable(cls: type[Template]) -> list[str]:
    discrete = (Choice, Curve, Table)
    return [
        n for n, d in cls.inputs.items() if not (isinstance(d, discrete) or d.meaning.integer or is_single(d))
    ]


def _ends(declared: Input, bounds: Sequence[Any], faults: list[Fault]) -> tuple[float, float]:
    if len(bounds) != 2:
        faults.append(Fault("bounds", "two_values", "give the lowest and the highest value to try"))
        return 0.0, 1.0
    low, high = (_scalar(end, declared.meaning.unit, "bounds", faults) for end in bounds)
    if low >= high:
        faults.append(Fault("bounds", "not_ascending", "the first bound must be below the second"))
    return low, high


def _scalar(raw: Any, unit: str, name: str, faults: list[Fault]) -> float:
    try:
        typed = read(raw, unit)
        if np.ndim(typed.si):
            raise FaultyText("not_a_number", "one value is wanted here, not an array")
        return float(typed.si)
    except FaultyText as error:
        faults.append(error.fault(name))
        return np.nan


def _faulty_inputs(
    cls: type[Template],
    raw: Mapping[str, Any],
    unknown: str,
    declared: Input | None,
    ends: tuple[float, float],
) -> list[Fault]:
    """What is wrong with the other inputs, seen with the unknown in the middle of its bounds."""
    curves = [name for name, d in cls.inputs.items() if isinstance(d, (Curve, Table))]
    arrays = [name for name, value in raw.items() if _is_array(value) and name not in curves]
    faults = [Fault(f"inputs.{n}", "not_a_number", "solve takes single values, not arrays") for n in arrays]
    probe = {name: value for name, value in raw.items() if name not in arrays}
    if declared and np.all(np.isfinite(ends)):
        probe[unknown] = _typed(declared, np.array(ends))
    try:
        cls.from_quantities(probe)
    except InvalidInputs as error:
        faults += [fault.within("inputs") for fault in error.faults if fault.name not in (unknown, *arrays)]
    return faults


def _is_array(value: Any) -> bool:
    return isinstance(value, list) or (isinstance(value, Mapping) and isinstance(value.get("value"), list))


def _typed(declared: Input, si: Array) -> Typed:
    return Typed(None, declared.meaning.unit, si, {})


def _grid(low: float, high: float) -> Array:
    """Samples between the bounds: even in the logarithm where both are positive and far apart."""
    if low > 0 and high > 10 * low:
        return np.geomspace(low, high, SAMPLES)
    return np.linspace(low, high, SAMPLES)


def _crosses(residual: Array) -> Mask:
    """Whether the residual changes its sign between each sample and the next."""
    return np.asarray(np.sign(residual[:-1]) * np.sign(residual[1:]) < 0)


@dataclass(frozen=True)
class _Curve:
    """The output as a function of the unknown, both in SI."""

    cls: type[Template]
    raw: dict[str, Any]
    declared: Input
    formula: Formula[Any]
    wanted: float
    fidelity: dict[str, Any]

    def residual(self, values: Array) -> Array:
        """Output minus target [SI] at these values of the unknown; NaN where the template refuses."""
        raw, name = {**self.raw, self.declared.name: _typed(self.declared, values)}, self.formula.name
        answer = evaluate(self.cls, raw, outputs=[name], **self.fidelity).outputs[name].value
        si = self.formula.meaning.scale.to_si(np.asarray(answer, dtype=float))
        return np.broadcast_to(si - self.wanted, values.shape)

    def scan(self, low: float, high: float) -> tuple[Array, Array]:
        """Values of the unknown and their residuals; dense where the target is crossed or the domain ends.

        This separates a jump from a crossing, and locates the end of the reachable range.
        """
        grid = _grid(low, high)
        for _ in range(ROUNDS):
            residual = self.residual(grid)
            edge = np.isnan(residual[:-1]) != np.isnan(residual[1:])
            intervals = np.flatnonzero(edge | _crosses(residual))[:INTERVALS]
            fine = (np.linspace(grid[i], grid[i + 1], FINER) for i in intervals)
            grid = np.unique(np.concatenate([grid, *fine]))
        return grid, self.residual(grid)

    def roots(self, grid: Array, residual: Array) -> list[float]:
        """Every crossing of the target, closed in to rounding; jumps across it are none."""
        if np.isnan(residual).all():
            return []
        exact = [float(grid[i]) for i in np.flatnonzero(residual == 0)]
        change = np.flatnonzero(_crosses(residual))
        closed = (brentq(self._at, grid[i], grid[i + 1], xtol=1e-300, rtol=4e-15, disp=False) for i in change)
        size = max(abs(self.wanted), float(np.nanmax(np.abs(residual))) * JUMP)
        return sorted([*exact, *(float(root) for root in closed if abs(self._at(root)) <= JUMP * size)])

    def _at(self, value: float) -> float:
        return float(self.residual(np.array([value]))[0])

    def polished(self, root: float, cheap: _Curve) -> float:
        """The crossing at this fidelity, from that of a cheaper one, by its slope."""
        step = JUMP * abs(root)
        slope = (cheap._at(root + step) - cheap._at(root - step)) / (2 * step)
        for _ in range(POLISHES):
            miss = self._at(root)
            if not abs(miss) > POLISHED * abs(self.wanted):
                break
            root -= miss / slope
        return root

    def unreachable(self, grid: Array, residual: Array) -> Unreachable:
        """The error that says what can be reached between the bounds, and why the target cannot."""
        meaning, name = self.formula.meaning, self.formula.name
        if np.isnan(residual).all():
            detail = f"{name} has no value anywhere between the bounds; give other bounds or inputs"
            return Unreachable(name, detail, (np.nan, np.nan), meaning.unit)
        ends = np.nanmin(residual) + self.wanted, np.nanmax(residual) + self.wanted
        low, high = (float(meaning.scale.from_si(end)) for end in ends)
        shown, target = (
            f"{meaning.with_unit(ends[0])} … {meaning.with_unit(ends[1])}",
            meaning.with_unit(self.wanted),
        )
        if ends[0] < self.wanted < ends[1]:
            detail = (
                f"{target} lies in a jump of {name}, or where it has no value: no input gives exactly this"
            )
        else:
            detail = f"{target} is out of reach: between the bounds {name} is {shown}"
        return Unreachable(name, detail, (low, high), meaning.unit)


def _not_monotone(declared: Input, formula: Formula[Any], residual: Array) -> list[Notice]:
    finite = residual[np.isfinite(residual)]
    steps, rounding = np.diff(finite), 1e-12 * np.max(np.abs(finite), initial=0.0)
    if (steps >= -rounding).all() or (steps <= rounding).all():
        return []
    detail = f"{formula.name} is not monotone in {declared.name} between the bounds, in this version"
    return [Notice("not_monotone", declared.name, detail)]


def _others(declared: Input, roots: list[float]) -> list[Notice]:
    if len(roots) == 1:
        return []
    others = ", ".join(declared.meaning.with_unit(root) for root in roots[1:5])
    detail = f"{others} give the target too; the lowest is returned"
    return [Notice("several_solutions", declared.name, detail)]
