"""Request bodies for analyses."""

from __future__ import annotations

from typing import Annotated

from pydantic import ConfigDict, Field, WithJsonSchema

from app.plain import JsonObject
from app.schemas.values import Parameters
from app.solids.questions import Options, offered
from cad.analysis.kinds import KINDS

THROW: JsonObject = {
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


Output = Annotated[
    str,
    WithJsonSchema({"type": "string", "enum": sorted({name for kind in KINDS for name in offered(kind)})}),
]


class AnalysisIn(Options):
    """A request to analyse a model's solid by finite elements."""

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
        description="outputs to compute; default: all but `surface` and the expensive `maximum_stress`",
    )
