"""Kept for imports of version 0.1: the evaluation, for scripts written for version 0.1."""

from templates.core.language.evaluate import (
    Answer,
    Echo,
    Evaluation,
    evaluate,
    is_reported,
)

is_told = is_reported

__all__ = [
    "Answer",
    "Echo",
    "Evaluation",
    "evaluate",
    "is_reported",
    "is_told",
]
