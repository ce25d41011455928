"""Describe the criteria of a template as plain values for its description, its page and the handbook."""

from __future__ import annotations

from typing import Any

from templates.core.criteria.criterion import Criterion, Limit
from templates.core.language.template import Template


def described_criteria(cls: type[Template]) -> list[dict[str, Any]]:
    """Return the description of every criterion in the order of the class, with the user's limits."""
    return [_criterion(criterion) for criterion in cls.declared_criteria]


def _criterion(criterion: Criterion) -> dict[str, Any]:
    return {
        "name": criterion.name,
        "words": criterion.words,
        "require": criterion.require,
        "source": criterion.source,
        "unverified": criterion.unverified,
        "warning": criterion.warning,
        "limits": [described_limit(limit) for limit in criterion.limits],
    }


def described_limit(limit: Limit) -> dict[str, Any]:
    """Return a description of a limit that the user of a template sets, with its default as a formula."""
    default = None if limit.default is None else f"{limit.default[0]}({limit.default[1]})"
    return {
        "name": limit.name,
        "unit": limit.unit,
        "words": limit.words,
        "library": limit.library,
        "default": default,
    }
