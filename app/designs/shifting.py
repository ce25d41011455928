"""How errors of steps reach the values that follow from them: each uncertain output is shifted to both ends.

The error of a step leaves out that of its inputs. So whatever follows from an uncertain output is calculated
again with that output at the lower and at the upper end of its band, and the changes are added. What cannot
be calculated again within a request (solids, expensive steps) is named, and no error is stated for it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from app.calculations.cost import EXPENSIVE, estimated_seconds
from app.designs.calculate import recalculated
from app.designs.calculation import Calculation
from app.designs.network import Block, Cell, Node
from app.designs.reference import Reference
from templates.core.judging.bands import Estimate
from templates.core.units.units import Value

MOST_SHIFTED = 12
"""Uncertain outputs that are carried downstream in one design; each takes two calculations."""


@dataclass(frozen=True)
class Upstream:
    """What a value follows from, as far as its errors go.

    Attributes
    ----------
    origins
        Outputs of other steps, all those with an error that is not zero.
    unknown
        Those whose error is not known, and those whose error is stated but cannot be carried.
    is_stated
        Whether all errors are stated and carried.
    """

    origins: frozenset[Reference] = frozenset()
    unknown: frozenset[Reference] = frozenset()
    is_stated: bool = True

    def joined(self, other: Upstream) -> Upstream:
        """Both together."""
        return Upstream(
            self.origins | other.origins, self.unknown | other.unknown, self.is_stated and other.is_stated
        )


NOTHING = Upstream()
