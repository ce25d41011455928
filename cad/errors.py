"""Errors raised while a shape is built, after its parameters have passed their checks.

Wrong parameters are refused earlier, as `templates.core.errors.InvalidInputs`.
"""

from __future__ import annotations

from collections.abc import Iterable


class GeometryError(Exception):
    """The kernel built no solid, or not the requested one.

    `code` is one of `not_finite`, `not_one_solid`, `invalid_solid`, `bounding_box`, `volume`, `dimension`,
    `tolerance`, `interference`, `open_mesh`, `kernel`; `parameters` are the API names of the affected
    parameters. The exception can be pickled, because worker processes raise it.
    """

    def __init__(self, code: str, detail: str, parameters: Iterable[str] = ()) -> None:
        self.code, self.detail, self.parameters = code, detail, tuple(parameters)
        super().__init__(code, detail, self.parameters)

    def __str__(self) -> str:
        return self.detail


class UnreadableStep(ValueError):
    """The bytes are not a STEP file, or the file contains no shape."""


class UnreadableModel(Exception):
    """The file of a model cannot be opened; `code` gives the reason. The exception can be pickled."""

    def __init__(self, code: str, detail: str) -> None:
        self.code, self.detail = code, detail
        super().__init__(code, detail)

    def __str__(self) -> str:
        return self.detail


class ProgramMissing(GeometryError):
    """An external CAD program is not installed here or not reachable; the detail states how to install it."""


class AnalysisError(Exception):
    """The solid cannot be analysed as requested.

    `code` is one of `no_shaft`, `no_end`, `mesh`, `not_converged`, `solver`; `name` is the analysed solid.
    The exception can be pickled.
    """

    def __init__(self, code: str, detail: str, name: str = "model") -> None:
        self.code, self.detail, self.name = code, detail, name
        super().__init__(code, detail, name)

    def __str__(self) -> str:
        return self.detail
