"""Find the file that declares a class."""

from __future__ import annotations

import inspect
from pathlib import Path

from templates.core.language.calculation import Calculation


def file_of(cls: type[Calculation]) -> Path | None:
    """Return the file that declares a class; None if a worksheet declares it."""
    return None if cls.sheet else Path(inspect.getfile(cls))
