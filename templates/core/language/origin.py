"""The source text of a class: a file, or a worksheet that a user wrote."""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from templates.core.language.template import Template


class Written(Protocol):
    """The worksheet from which a class was made."""

    @property
    def text(self) -> str:
        """The worksheet as it was written."""

    def digest(self) -> str:
        """SHA-256 of what it calculates, without prose and layout."""


def file_of(cls: type[Template]) -> Path | None:
    """The file that declares a class; None where a worksheet does."""
    return None if cls.sheet else Path(inspect.getfile(cls))
