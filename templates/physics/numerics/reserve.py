"""Reserves to limits that a user may set."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from templates.core.arrays import Array, Truth


def above(limit: Array, value: Callable[[], Array]) -> Truth:
    """Return whether a value is not below a limit; without a limit the rule holds."""
    none = np.isnan(limit)
    return True if np.all(none) else none | (value() >= limit)


def below(limit: Array, value: Callable[[], Array]) -> Truth:
    """Return whether a value is not above a limit; without a limit the rule holds."""
    none = np.isnan(limit)
    return True if np.all(none) else none | (value() <= limit)
