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
    """A criterion as judged; the margin [`unit`] is None if it is unknown."""

    verdict: Verdict
    unit: str
    margin: float | None

    @classmethod
    def alone(cls, judgement: Judgement) -> JudgedCriterion:
        """Return the verdict on a criterion of one design that was calculated alone."""
        return cls(judgement.verdict, judgement.margin_unit or judgement.unit, _finite(judgement.margin))

    @classmethod
    def in_row(cls, verdict: Verdict, criterion: Criterion, margin: float) -> JudgedCriterion:
        """Return the verdict on a criterion in one row of a batch; a margin [SI] of NaN is unknown."""
        scale = "delta_degC" if criterion.is_temperature else criterion.unit
        return cls(verdict, scale, _finite(margin / unit(scale).factor))


def is_temperature(name: str) -> bool:
    """Return whether a unit is one of temperature, for which ratios have no meaning."""
    return bool(unit(name).base == registry.kelvin)


def _finite(value: float | None) -> float | None:
    return None if value is None or not math.isfinite(value) else float(value)


@dataclass(frozen=True)
class Outcome:
    """A design, or one of its variants, calculated with one version.

    Attributes
    ----------
    faults
        Reasons for which a save is refused; if there are any, the other attributes are empty.
    values
        Outputs of steps that are quantities [SI], by their names in relations; NaN if a value is missing.
    parameters
        Known parameters of CAD models that are quantities [SI], such as `shell.inner_diameter`.
    units
        The declared units of the outputs and parameters.
    judged
        Criteria by name.
    waiting
        Values that need a solid that is not built yet.
    """

    faults: tuple[Fault, ...] = ()
    values: Mapping[str, Value] = field(default_factory=dict)
    parameters: Mapping[str, float] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    judged: Mapping[str, JudgedCriterion] = field(default_factory=dict)
    waiting: tuple[str, ...] = ()
