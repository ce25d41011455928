"""Kept for imports of version 0.1: the check of dimensions, for scripts written for version 0.1."""

from templates.core.language.dimensions import (
    LIBRARIES,
    faults,
    rebound,
)

__all__ = [
    "LIBRARIES",
    "faults",
    "rebound",
]
