"""What the calls of analyses take, and the surface that they give."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, WithJsonSchema

from app.schemas.values import Parameters
from app.solids.questions import Options, offered
from cad.analysis.kinds import KINDS

THROW: dict[str, Any] = {
    "journal_diameter": "50 mm",
    "journal_length": "20 mm",
    "pin_diameter": "45 mm",
    "pin_length": "24 mm",
    "web_thickness": "18 mm",
    "web_width": "70 mm",
    "web_shape": "rectangular",
    "throw": "35 mm",
}
"""A plain crank throw, small enough to be analysed in a second or two."""


EXAMPLE: dict[str, Any] = {
    "load": "a torque of 1 N*m about z",
    "points": {"value": [[25, 0, 0], [0, 25, 0], [0, 0, 0]], "unit": "mm"},
    "triangles": [[0, 1, 2]],
    "displacement": {"value": [[0, 0.000017, 0], [-0.000017, 0, 0], [0, 0, 0]], "unit": "mm"},
    "twist": {"value": [0.000039, 0.000039, 0.000039], "unit": "deg"},
    "stress": {"value": [0.07, 0.07, 0], "unit": "MPa"},
}
"""One triangle."""


Output = Annotated[
    str,
    WithJsonSchema({"type": "string", "enum": sorted({name for kind in KINDS for name in offered(kind)})}),
]


class AnalysisIn(Options):
    """Analyse a model's solid by finite elements."""

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [
                {"parameters": THROW, "level": "coarse", "outputs": ["stiffness"]},
                {"parameters": THROW, "level": "coarse", "outputs": ["surface"]},
            ]
        }
    )

    parameters: Parameters = Field(description='quantities by name: `"48 mm"`; the others have defaults')
    outputs: list[Output] | None = Field(
        None,
        max_length=10,
        description="what to find; without it all but `maximum_stress`, which is dear, and `surface`",
    )


class Points(BaseModel):
    """A triple at every point."""

    value: list[tuple[float, float, float]]
    unit: str


class Values(BaseModel):
    """A number at every point."""

    value: list[float]
    unit: str


class SurfaceOut(BaseModel):
    """The surface of a solid under a load of 1 N·m. Multiply displacement, twist and stress by the load."""

    model_config = ConfigDict(json_schema_extra={"examples": [EXAMPLE]})

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
