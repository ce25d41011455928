"""An output of an analysis, as its database row stores it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypedDict


class Refinement(TypedDict):
    """One step of the mesh refinement until a stress converges."""

    elements: int
    order: int
    value: float  # MPa under 1 N·m


class Mesh(TypedDict):
    """The mesh of an analysis."""

    degrees_of_freedom: int
    elements: int
    order: int
    mirror_plane: str | None


class StoredOutput(TypedDict, total=False):
    """An output as its row stores it; `app.solids.schemas.analyses.AnalysisOutput` describes its fields."""

    value: float | list[float] | list[list[float]] | None
    unit: str | None
    columns: list[str] | None
    error: float | None
    level: str | None
    mesh: Mesh
    convergence: list[Refinement]
    point: dict[str, object] | None
    searched: dict[str, object] | None
    reason: str | None
    error_reason: str | None
    seconds: float
    sha256: str
    size: int  # size of the file [bytes]
    triangles: int


Outputs = Mapping[str, StoredOutput]
"""Outputs of an analysis by name."""

Computed = Mapping[str, Mapping[str, object]]
"""Outputs from the worker by name; a file includes its bytes."""
