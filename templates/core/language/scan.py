"""Sample the output over the unknown of `solve`: array calls, refined where the curve needs it.

The scan takes 257 samples between the bounds at one level of fidelity. They show where the output crosses the
target, comes near it, or ceases to exist. These intervals are divided repeatedly, so that a jump is not
mistaken for a crossing, two close solutions are separated, and the end of the reachable range is located.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array
from templates.core.errors import Unreachable
from templates.core.language.answer import Answer
from templates.core.language.evaluate import Evaluation, evaluate
from templates.core.language.meaning import Meaning
from templates.core.language.question import typed_values
from templates.core.language.spec import Curve, Formula, Input
from templates.core.language.template import Template

SAMPLES = 257  # in the first call
PARTS, ROUNDS = 16, 7  # number of parts of a divided interval, and number of rounds
EDGES, EXTREMA, CROSSINGS = 8, 16, 30  # most intervals of each kind that are divided in a round
CROSSED = 2  # rounds in which intervals at a crossing are divided
NEAR = 2.0  # an extremum within this many steps of the target may reach it
CELLS = 200_000  # most values in one call: length of a curve input times number of samples
DECADE = 10.0  # bounds with a larger ratio are sampled at logarithmic spacing


@dataclass(frozen=True)
class Samples:
    """Values of the unknown in ascending order, and output minus target [SI]; NaN without a value."""

    x: Array
    miss: Array
    reasons: NDArray[np.object_]

    def joined(self, other: Samples) -> Samples:
        """Return both sets of samples in ascending order, with each value of the unknown only once."""
        x = np.concatenate([self.x, other.x])
        x, first = np.unique(x, return_index=True)
        miss, reasons = (np.concatenate([getattr(self, n), getattr(other, n)]) for n in ("miss", "reasons"))
        return Samples(x, miss[first], reasons[first])

    def crossings(self) -> NDArray[np.intp]:
        """Return the indices of samples between which and the next sample the output crosses the target."""
        return np.flatnonzero(np.sign(self.miss[:-1]) * np.sign(self.miss[1:]) < 0)

    def beside(self) -> NDArray[np.intp]:
        """Return the indices of samples that are nearer to the target than the output's step to the next.

        The output may jump across the target there.
        """
        near = np.minimum(np.abs(self.miss[:-1]), np.abs(self.miss[1:])) < np.abs(np.diff(self.miss))
        return np.flatnonzero(near)

    def edges(self) -> NDArray[np.intp]:
        """Return the indices of the samples after which the output begins or ceases to exist."""
        return np.flatnonzero(np.isnan(self.miss[:-1]) != np.isnan(self.miss[1:]))

    def nearest(self) -> NDArray[np.intp]:
        """Return the indices of samples nearer to the target than their neighbours on the same side."""
        before, here, after = self.miss[:-2], self.miss[1:-1], self.miss[2:]
        side = np.sign(here)
        nearer = (side * before >= side * here) & (side * after >= side * here)
        nearer &= (before != here) | (after != here)
        return np.flatnonzero((side != 0) & nearer & (np.abs(here) <= NEAR * self._steps())) + 1

    def _steps(self) -> Array:
        """Return the larger of the steps to both neighbours, for each sample."""
        steps = np.abs(np.diff(self.miss))
        return np.maximum(steps[:-1], steps[1:])


@dataclass(frozen=True)
class Outputs:
    """The output at values of the unknown [SI], NaN where it has none, and the level that calculated it.

    `error` is the relative error at each value, or None if none is stated. `reasons` are None where there is
    a value.
    """

    values: Array
    reasons: NDArray[np.object_]
    level: str | None
    error: Array | None


@dataclass(frozen=True)
class SampledCurve(ABC):
    """An output as a function of one unknown: the meanings of `x` and `y`, and the target of `y` [SI]."""

    x: Meaning
    y: Meaning
    wanted: float

    @abstractmethod
    def outputs(self, x: Array) -> Outputs:
        """Return the output at values of the unknown [SI]."""

    @abstractmethod
    def at_level(self, level: str) -> Self:
        """Return the same curve with all samples at one level."""

    @abstractmethod
    def level_at(self, x: float) -> str | None:
        """Return the level used at one value; raise InvalidInputs if the output is refused there."""

    @property
    @abstractmethod
    def level(self) -> str | None:
        """Return the level of all samples; None if a tolerance chooses it, or there are no levels."""

    @property
    @abstractmethod
    def chooses(self) -> bool:
        """Return whether a tolerance chooses the level at each sample."""

    @abstractmethod
    def is_at_levels_of(self, other: Self) -> bool:
        """Return whether another curve of the same output is calculated at the same levels."""

    @property
    def rows(self) -> int:
        """Return the number of samples in one call."""
        return CELLS

    def at_one_level(self, x: Array) -> tuple[Self, Samples]:
        """Return the samples, and the curve at the level at which they were calculated."""
        first = self.outputs(x[: self.rows])
        fixed = self if first.level is None else self.at_level(first.level)
        samples = self._samples(x[: self.rows], first)
        return fixed, samples.joined(fixed.sample(x[self.rows :]))

    def sample(self, x: Array) -> Samples:
        """Return the samples at these values, in as many calls as the level needs."""
        samples = Samples(np.empty(0), np.empty(0), np.empty(0, dtype=object))
        for start in range(0, x.size, self.rows):
            part = x[start : start + self.rows]
            samples = samples.joined(self._samples(part, self.outputs(part)))
        return samples

    def miss(self, value: float) -> float:
        """Return the output minus target at one value [SI]; NaN where the template refuses."""
        return self.miss_of(self.outputs(np.array([value])))

    def miss_of(self, outputs: Outputs) -> float:
        """Return output minus target [SI] at one value, from computed outputs; NaN without a value."""
        return float(outputs.values[0]) - self.wanted

    def scan(self, low: float, high: float) -> tuple[Self, Samples, Samples]:
        """Return the curve at its level, the even samples between the bounds, and the refined samples."""
        curve, even = self.at_one_level(evenly(low, high))
        samples = even
        for turn in range(ROUNDS):
            intervals = _divided(samples, turn)
            if not intervals.size:
                break
            inner = np.concatenate([_inside(samples.x[i], samples.x[i + 1]) for i in intervals])
            samples = samples.joined(curve.sample(np.unique(inner)))
        return curve, even, samples

    def unreachable(self, samples: Samples) -> Unreachable:
        """Return the error with the reachable range between the bounds and the reason for missing values."""
        meaning, name = self.y, self.y.name
        if np.isnan(samples.miss).all():
            detail = f"{name} has no value anywhere between the bounds; give other bounds or inputs"
            return Unreachable(name, detail, (np.nan, np.nan), meaning.unit)
        ends = [float(end) + self.wanted for end in (np.nanmin(samples.miss), np.nanmax(samples.miss))]
        low, high = (float(meaning.scale.from_si(end)) for end in ends)
        shown, target = " … ".join(map(meaning.with_unit, ends)), meaning.with_unit(self.wanted)
        if ends[0] < self.wanted < ends[1]:
            detail = (
                f"{target} lies in a jump of {name}, or where it has no value: no input gives exactly this"
            )
        else:
            detail = f"{target} is out of reach: between the bounds {name} is {shown}"
        return Unreachable(name, detail, (low, high), meaning.unit)

    def _samples(self, x: Array, outputs: Outputs) -> Samples:
        return Samples(x, outputs.values - self.wanted, outputs.reasons)


@dataclass(frozen=True)
class TargetCurve(SampledCurve):
    """An output of a template as a function of one of its inputs; `fidelity` is its level or tolerance."""

    cls: type[Template]
    raw: dict[str, Any]
    declared: Input
    formula: Formula[Any]
    fidelity: dict[str, Any]

    @property
    def level(self) -> str | None:
        """Return the level of all samples; None if a tolerance chooses it, or there are no levels."""
        return self.fidelity.get("level")

    @property
    def chooses(self) -> bool:
        """Return whether a tolerance chooses the level at each sample."""
        return "tolerance" in self.fidelity

    @property
    def rows(self) -> int:
        """Return the number of samples in one call."""
        curves = (n for n, declared in self.cls.inputs.items() if isinstance(declared, Curve))
        longest = max((np.size(_magnitude(self.raw.get(name))) for name in curves), default=1)
        most = self.cls.most_points.get(self.level or "", CELLS)
        return max(1, min(most, CELLS // max(1, longest)))

    def at_level(self, level: str) -> TargetCurve:
        """Return the same curve with all samples at one level."""
        return replace(self, fidelity={"level": level})

    def is_at_levels_of(self, other: Self) -> bool:
        """Return whether another curve of the same output is calculated at the same level."""
        return self.level == other.level

    def evaluation(self, values: Any) -> Evaluation:
        """Return the evaluation of the output at values of the unknown [SI]."""
        raw = {**self.raw, self.declared.name: typed_values(self.declared, values)}
        return evaluate(self.cls, raw, outputs=[self.formula.name], **self.fidelity)

    def level_at(self, x: float) -> str | None:
        """Return the level used at one value; raise InvalidInputs if the output is refused there."""
        return self.evaluation(x).level

    def outputs(self, x: Array) -> Outputs:
        """Return the output at values of the unknown [SI]."""
        evaluation = self.evaluation(x)
        answer, error = evaluation.outputs[self.formula.name], evaluation.error[self.formula.name]
        si = self.formula.meaning.scale.to_si(np.asarray(answer.value, dtype=float))
        return Outputs(
            np.broadcast_to(si, x.shape),
            _reasons(answer, x.size),
            evaluation.level,
            None if error is None else np.broadcast_to(error, x.shape),
        )


def _magnitude(raw: Any) -> Any:
    return raw.get("value") if isinstance(raw, dict) else raw


def _reasons(answer: Answer, count: int) -> NDArray[np.object_]:
    """Return the reasons why values are missing at the points; None where they exist."""
    if answer.reasons is not None:
        return np.broadcast_to(answer.reasons, (count,))
    return np.full(count, answer.reason, dtype=object)


def evenly(low: float, high: float, count: int = SAMPLES) -> Array:
    """Return equally spaced values between the bounds.

    The spacing is logarithmic if both bounds are positive and far apart.
    """
    if low > 0 and high > DECADE * low:
        return np.geomspace(low, high, count)
    return np.linspace(low, high, count)


def _inside(low: float, high: float) -> Array:
    """Return the points that divide an interval, without the ends of the interval."""
    return np.linspace(low, high, PARTS + 1)[1:-1]


def _divided(samples: Samples, turn: int) -> NDArray[np.intp]:
    """Return the intervals to divide, each by the sample before it, with a limited number of each kind."""
    crossed = samples.beside()[:CROSSINGS] if turn < CROSSED else np.empty(0, dtype=np.intp)
    near = samples.nearest()
    near = near[np.argsort(np.abs(samples.miss[near]), kind="stable")][:EXTREMA]
    return np.unique(np.concatenate([samples.edges()[:EDGES], crossed, near - 1, near]))
