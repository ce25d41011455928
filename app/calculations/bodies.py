"""Request bodies for single templates."""

from __future__ import annotations

from functools import cached_property
from typing import Annotated

from pydantic import ConfigDict, Field, StringConstraints
from pydantic.config import JsonDict

from app.plain import JsonObject
from app.pool.cost import points
from app.schemas.bounds import Bounded, at_most
from app.schemas.values import Between, Given, Limits

Text = Annotated[str, StringConstraints(max_length=100)]
MOST_NAMES = 2000  # largest number of names in one request
NOTHING: JsonDict = {"default": {}}
"""Documents an empty object as the default; a default in pydantic would be copied for each request."""

OIL_FILM: JsonObject = {
    "radial_load": "25 kN",
    "diametral_clearance": "0.055 mm",
    "bearing_diameter": "48 mm",
    "bearing_width": "18 mm",
    "speed": "5000 rpm",
    "oil_inlet_temperature": "80 degC",
    "oil_outlet_temperature": "87.762 degC",
}


class CalculationRequest(Bounded):
    """The inputs of a calculation, and the outputs that the client wants."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)

    inputs: Annotated[dict[str, Given], at_most(MOST_NAMES)] = Field(
        max_length=MOST_NAMES,
        description='quantities by name: `"25 kN"` or `{"value": 25, "unit": "kN"}`',
    )
    outputs: Annotated[list[Text], Field(max_length=200)] | None = Field(
        None, description="names of the outputs to compute; all outputs if omitted"
    )
    level: Text | None = Field(None, description="name of a level of fidelity")
    tolerance: float | None = Field(None, gt=0, lt=1, description="largest acceptable relative error")
    units: Annotated[dict[str, Text], at_most(200)] = Field(
        default_factory=dict,
        max_length=200,
        description="units of the outputs, by output",
        json_schema_extra=NOTHING,
    )

    @cached_property
    def points(self) -> int:
        """Return the number of points that the arrays among the inputs span together."""
        return points(self.inputs)


class EvaluateIn(CalculationRequest):
    """A request to evaluate a template."""

    per_point: bool = Field(
        False, description="with a tolerance: choose the cheapest level at each point, not one for all points"
    )

    model_config = ConfigDict(
        json_schema_extra={"examples": [{"inputs": OIL_FILM, "outputs": ["minimum_film_thickness"]}]}
    )

    limits: Limits = Field(default_factory=dict, json_schema_extra=NOTHING)


class SolveIn(CalculationRequest):
    """A request to find the input that gives a wanted output."""

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [
                {
                    "inputs": {name: value for name, value in OIL_FILM.items() if name != "bearing_width"},
                    "unknown": "bearing_width",
                    "between": ["10 mm", "80 mm"],
                    "target": {"minimum_film_thickness": "3.2449 um"},
                }
            ]
        }
    )

    unknown: Text = Field(description="the input to find")
    between: Between
    target: dict[str, Given] = Field(
        max_length=200,
        description="one output and its wanted value",
        json_schema_extra={"minProperties": 1, "maxProperties": 1},
    )
