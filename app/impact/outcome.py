"""The result of a design with one version of a template, calculated alone or in a batch."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from templates.core.criteria.comparison import Verdict
from templates.core.criteria.criterion import Criterion
from templates.core.criteria.judgement import Judgement
from templates.core.errors import Fault
from templates.core.units.units import Value, registry, unit


@dataclass(frozen=True, slots=True)
class JudgedCriterion:
    """A criterion as judged; the margin [`unit`] is None where there is none."""

    verdict: Verdict
    unit: str
    margin: float | None

    @classmethod
    def alone(cls, judgement: Judgement) -> JudgedCriterion:
        """Return the judgement of one design."""
        return cls(judgement.verdict, judgement.margin_unit or judgement.unit, _finite(judgement.margin))

    @classmethod
    def in_row(cls, verdict: Verdict, criterion: Criterion, margin: float) -> JudgedCriterion:
        """Return the judgement of a row; the margin [SI] is NaN where there is none."""
        scale = "K" if criterion.is_temperature else criterion.unit
        return cls(verdict, scale, _finite(margin / unit(scale).factor))


def is_temperature(name: str) -> bool:
    """Return whether a unit is one of temperature, whose ratios have no meaning."""
    return bool(unit(name).base == registry.kelvin)


def _finite(value: float | None) -> float | None:
    return None if value is None or not math.isfinite(value) else float(value)


@dataclass(frozen=True)
class Outcome:
    """A design, or one variant of it, with one version.

    Attributes
    ----------
    faults
        Why a save is refused; then there is nothing else.
    values
        Outputs of steps that are quantities [SI], by their names in relations; NaN where there is none.
    parameters
        Those of CAD models that are quantities [SI], as far as they are known: `shell.inner_diameter`.
    units
        In which the outputs and parameters are declared.
    judged
        Criteria by name.
    waiting
        What waits for a solid that is not built.
    """

    faults: tuple[Fault, ...] = ()
    values: Mapping[str, Value] = field(default_factory=dict)
    parameters: Mapping[str, float] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    judged: Mapping[str, JudgedCriterion] = field(default_factory=dict)
    waiting: tuple[str, ...] = ()
