"""The slopes of a solid as its measures and numbers; this module does not import the kernel."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

Side = Literal["both", "above", "below"]
"""The sides of a parameter's value on which a slope holds."""


@dataclass(frozen=True)
class ParameterSlopes:
    """Slopes of the measures of a solid over one parameter, in the units of `MEASURES` per SI unit.

    A measure without a slope has a reason; `whole` is that of all measures. If `side` is not `both`, the
    slopes hold on that side only, and `one_sided` is the reason.
    """

    slopes: Mapping[str, float] = field(default_factory=dict)
    reasons: Mapping[str, str] = field(default_factory=dict)
    side: Side = "both"
    one_sided: str = ""
    whole: str = ""

    def reason(self, measure: str) -> str:
        """Return why a measure has no slope."""
        return self.whole or self.reasons.get(measure, "no slope of it is computed")


@dataclass(frozen=True)
class SolidSlopes:
    """The measures of a solid, in the units of `MEASURES`, and their slopes over parameters by API name."""

    measures: Mapping[str, float]
    parameters: Mapping[str, ParameterSlopes]
