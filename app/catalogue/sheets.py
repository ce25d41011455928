"""Released worksheets as templates of the catalogue."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from templates.core.language.template import Template

Key = tuple[str, int]
"""Id and version."""


@dataclass(frozen=True)
class ReleasedSheet:
    """A released version of a worksheet, with its author and reviewer."""

    cls: type[Template]
    state: Literal["released", "withdrawn"]
    author: str | None
    reviewer: str | None
    is_verified: bool = False  # the reviewer had signed in


@dataclass(frozen=True)
class Sheets:
    """All worksheets at one time; `broken` and `unreleased` state why a version cannot be used."""

    released: Mapping[Key, ReleasedSheet] = field(default_factory=dict)
    broken: Mapping[Key, str] = field(default_factory=dict)
    unreleased: Mapping[Key, str] = field(default_factory=dict)

    def owns(self, key: Key | None) -> bool:
        """Return whether a version has been released as a worksheet."""
        return key in self.released or key in self.broken
