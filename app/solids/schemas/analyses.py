"""Finite-element analyses of solids as the interface shows them."""

from __future__ import annotations

from pydantic import ConfigDict, Field
from pydantic.config import JsonDict

from app.schemas.answers import Answer, Measured, Quantity, Triple, Values, Version, Warning


class Mesh(Answer):
    """The mesh of an analysis."""

    degrees_of_freedom: int
    elements: int
    order: int = Field(description="polynomial order of the elements")
    mirror_plane: str | None = Field(description="the plane of symmetry that halves the solid")


class Refinement(Answer):
    """One step of the refinement until a stress settles."""

    elements: int
    value: float = Field(description="the greatest stress on this mesh, in MPa")


class Span(Answer):
    """The ends of an interval with their unit."""

    value: tuple[float, float]
    unit: str


class AnalysisOutput(Answer):
    """A quantity that an analysis computed; of the surface, where its file is."""

    value: float | list[float] | list[list[float]] | None = Field(
        None,
        description="a number; a list; of a table its rows; null where the refinement did not settle, say",
    )
    unit: str | None = None
    columns: list[str] | None = Field(None, description="of a table: what each number of a row is")
    error: float | None = Field(description="estimated relative error; null where it is not known")
    level: str | None = Field(description="how fine the mesh is; null where the mesh follows the stress")
    mesh: Mesh
    convergence: list[Refinement] | None = None
    point: Triple | None = Field(None, description="where the greatest stress is, in mm")
    searched: Span | None = Field(None, description="the part of the axis in which it was sought, in mm")
    reason: str | None = Field(None, description="why there is no value")
    error_reason: str | None = Field(None, description="why no error is estimated")
    seconds: float | None = Field(None, description="time that it took, in s; in previews only")
    url: str | None = Field(None, description="where the surface is")
    sha256: str | None = None
    size: int | None = Field(None, description="of the file, in bytes")
    triangles: int | None = None


class ModelAnalysis(Answer):
    """An analysis of a design's model: what was asked, and the outputs that are known."""

    id: str
    kind: str
    boundary: str = Field(description="how the loaded end is held")
    level: str | None
    tolerance: float | None
    load: Quantity = Field(description="the torque or moment of stress, in N*m")
    outputs: dict[str, AnalysisOutput]
    warnings: list[Warning]


class Analysis(ModelAnalysis):
    """An analysis of a build."""

    model: Version
    build: str
    mesh: Mesh | None = Field(description="the finest mesh; null while nothing is known")
    seconds: float = Field(description="time that all outputs took, in s")


class AnalysisList(Answer):
    """All analyses of a build."""

    items: list[Analysis]


TRIANGLE: JsonDict = {
    "load": "a torque of 1 N*m about z",
    "points": {"value": [[25, 0, 0], [0, 25, 0], [0, 0, 0]], "unit": "mm"},
    "triangles": [[0, 1, 2]],
    "displacement": {"value": [[0, 0.000017, 0], [-0.000017, 0, 0], [0, 0, 0]], "unit": "mm"},
    "twist": {"value": [0.000039, 0.000039, 0.000039], "unit": "deg"},
    "stress": {"value": [0.07, 0.07, 0], "unit": "MPa"},
}
"""One triangle."""


class Points(Measured):
    """A triple at every point."""

    value: list[tuple[float, float, float]]
    unit: str


class Surface(Answer):
    """The surface of a solid under a load of 1 N·m. Multiply displacement, twist and stress by the load."""

    model_config = ConfigDict(json_schema_extra={"examples": [TRIANGLE]})

    load: str = Field(description="what the fields are caused by")
    points: Points = Field(description="where the points are while nothing acts, in mm")
    triangles: list[tuple[int, int, int]] = Field(
        description="three numbers of points each, from 0, counterclockwise as seen from outside"
    )
    displacement: Points = Field(description="how far every point moves, in mm")
    twist: Values | None = Field(
        None,
        description="the local rotation about z, in deg: of a round shaft, that of its section; in torsion",
    )
    stress: Values = Field(description="von Mises stress, averaged where elements meet, in MPa")
