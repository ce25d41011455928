"""Failures of geometry that name the model of the design they are about."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from cad.errors import AnalysisError, GeometryError


@contextmanager
def named(model: str, analysis: str = "") -> Iterator[None]:
    """Let a failure of geometry name the model of the design, and one of its analysis that too."""
    try:
        yield
    except GeometryError as error:
        names = (f"{model}.{parameter}" for parameter in error.parameters)
        raise GeometryError(error.code, f"{model}: {error.detail}", names) from error
    except AnalysisError as error:
        name = f"{model}.{analysis}"
        raise AnalysisError(error.code, f"{name}: {error.detail}", name) from error
