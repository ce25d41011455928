"""Errors that occur while a shape is built, after its parameters have passed their checks.

Wrong parameters are refused earlier, as `templates.core.errors.InvalidInputs`.
"""

from __future__ import annotations

from collections.abc import Iterable


class GeometryError(Exception):
    """The kernel made no solid, or not the one that was requested.

    `code` is one of `not_finite`, `not_one_solid`, `invalid_solid`, `bounding_box`, `volume`, `dimension`,
    `tolerance`, `interference`, `open_mesh`, `kernel`; `parameters` are the API names of the parameters
    concerned. It survives pickling, because it is raised in a worker process.
    """

    def __init__(self, code: str, detail: str, parameters: Iterable[str] = ()) -> None:
        self.code, self.detail, self.parameters = code, detail, tuple(parameters)
        super().__init__(code, detail, self.parameters)

    def __str__(self) -> str:
        return self.detail


class UnreadableStep(ValueError):
    """Bytes that are not a STEP file, or one without a shape."""


class UnreadableModel(Exception):
    """A file of a model that is not opened; `code` says why. It survives pickling."""

    def __init__(self, code: str, detail: str) -> None:
        self.code, self.detail = code, detail
        super().__init__(code, detail)

    def __str__(self) -> str:
        return self.detail


class ProgramMissing(GeometryError):
    """A program that draws is not installed here, or not reachable; the detail says how to have it."""


class AnalysisError(Exception):
    """A solid that cannot be analysed as requested.

    `code` is one of `no_shaft`, `no_end`, `mesh`, `not_converged`, `solver`; `name` is what was analysed. It
    survives pickling.
    """

    def __init__(self, code: str, detail: str, name: str = "model") -> None:
        self.code, self.detail, self.name = code, detail, name
        super().__init__(code, detail, name)

    def __str__(self) -> str:
        return self.detail
