"""Newest versions of templates and models, which quick tests use; older versions are slow tests.

Golden results and digests of every version stay in the quick lane: they hold an older version as it is.
"""

from collections.abc import Iterable
from typing import Any

import pytest


def newest(classes: Iterable[Any]) -> set[tuple[str, int]]:
    """Id and version of the newest of each id."""
    latest: dict[str, int] = {}
    for cls in classes:
        latest[cls.id] = max(cls.version, latest.get(cls.id, 0))
    return set(latest.items())


def older_slow(classes: Iterable[Any]) -> list[Any]:
    """Parameters of a test, one for each version; the older ones belong to the slow lane."""
    every = list(classes)
    quick = newest(every)
    return [
        pytest.param(
            cls,
            id=f"{cls.id}-{cls.version}",
            marks=() if (cls.id, cls.version) in quick else pytest.mark.slow,
        )
        for cls in every
    ]
