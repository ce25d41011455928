"""The source text of a class: a file, or a worksheet that a user wrote."""

from __future__ import annotations

import inspect
from pathlib import Path

from templates.core.language.calculation import Calculation


def file_of(cls: type[Calculation]) -> Path | None:
    """Return the file that declares a class; None where a worksheet does."""
    return None if cls.sheet else Path(inspect.getfile(cls))
