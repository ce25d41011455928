"""Response schemas for finite-element analyses of solids."""

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
    """One step of the mesh refinement until a stress converges."""

    elements: int
    order: int = Field(3, description="polynomial order of the elements")
    value: float = Field(description="the largest stress on this mesh, in MPa")


class Span(Answer):
    """The ends of an interval with their unit."""

    value: tuple[float, float]
    unit: str


class AnalysisOutput(Answer):
    """A quantity that an analysis computed; for the surface, a link to its file."""

    value: float | list[float] | list[list[float]] | None = Field(
        None,
        description="a number, a list, or the rows of a table; null if, for example, it did not converge",
    )
    unit: str | None = None
    columns: list[str] | None = Field(None, description="for a table: the meaning of each number in a row")
    error: float | None = Field(description="estimated relative error; null if unknown")
    level: str | None = Field(description="level of the mesh; null if the stress determines the mesh")
    mesh: Mesh
    convergence: list[Refinement] | None = None
    point: Triple | None = Field(None, description="position of the largest stress, in mm")
    searched: Span | None = Field(None, description="the part of the axis that was searched for it, in mm")
    reason: str | None = Field(None, description="why there is no value")
    error_reason: str | None = Field(None, description="why no error is estimated")
    seconds: float | None = Field(None, description="elapsed time, in s; only in previews")
    url: str | None = Field(None, description="link to the surface")
    sha256: str | None = None
    size: int | None = Field(None, description="size of the file, in bytes")
    triangles: int | None = None


class ModelAnalysis(Answer):
    """An analysis of a design's model: the request, and the known outputs."""

    id: str
    kind: str
    boundary: str = Field(description="how the loaded end is held")
    level: str | None
    tolerance: float | None
    load: Quantity = Field(description="the torque or moment that causes the stress, in N*m")
    outputs: dict[str, AnalysisOutput]
    warnings: list[Warning]


class Analysis(ModelAnalysis):
    """An analysis of a build."""

    model: Version
    build: str
    mesh: Mesh | None = Field(description="the finest mesh; null until there is a result")
    seconds: float = Field(description="elapsed time for all outputs, in s")


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
    """Three numbers at every point."""

    value: list[tuple[float, float, float]]
    unit: str


class Surface(Answer):
    """The surface of a solid under a load of 1 N·m. Multiply displacement, twist and stress by the load."""

    model_config = ConfigDict(json_schema_extra={"examples": [TRIANGLE]})

    load: str = Field(description="the load that causes the fields")
    points: Points = Field(description="positions of the points without load, in mm")
    triangles: list[tuple[int, int, int]] = Field(
        description="three point numbers each, counted from 0, counterclockwise as seen from outside"
    )
    displacement: Points = Field(description="displacement of every point, in mm")
    twist: Values | None = Field(
        None,
        description="local rotation about z under torsion, in deg; for a round shaft that of its section",
    )
    stress: Values = Field(description="von Mises stress, averaged where elements meet, in MPa")
