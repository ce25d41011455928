"""Margins to limits that a user may set."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from templates.core.arrays import Array, Truth


def above(limit: Array, value: Callable[[], Array]) -> Truth:
    """Return whether a value is at or above a limit; true if there is no limit."""
    none = np.isnan(limit)
    return True if np.all(none) else none | (value() >= limit)


def below(limit: Array, value: Callable[[], Array]) -> Truth:
    """Return whether a value is at or below a limit; true if there is no limit."""
    none = np.isnan(limit)
    return True if np.all(none) else none | (value() <= limit)
