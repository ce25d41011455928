"""Kept for imports of version 0.1: the lines of a report, for scripts written for version 0.1."""

from templates.core.paper.report import (
    NONE,
    Row,
    rows,
    shown,
)

__all__ = [
    "NONE",
    "Row",
    "rows",
    "shown",
]
