"""The answers of an evaluation, and the inputs that were used."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(slots=True)  # frozen, each would cost four times as much
class Answer:
    """One result in its unit. A missing value is NaN in an array and None otherwise, with its reason."""

    value: Any
    unit: str | None
    reason: str | None = None
    reasons: NDArray[np.object_] | None = None


@dataclass(slots=True)  # frozen, each would cost four times as much
class UsedInput:
    """One input as it was used: the typed value or the default."""

    value: Any
    unit: str | None
    source: str  # "given" or "default"
    extra: Mapping[str, Any]
