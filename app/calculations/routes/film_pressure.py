"""`/film-pressure`: the pressure of an oil film over its unrolled surface."""

from __future__ import annotations

from fastapi import APIRouter
from pydantic import ConfigDict, Field

from app.api.dependencies import Units
from app.calculations.film_pressure import TYPICAL, solve_film_pressure
from app.calculations.schemas.film_pressure import FilmPressure
from app.http.access import needs
from app.http.strict_requests import StrictRoute
from app.observation.processor_time import in_thread
from app.schemas.bounds import Bounded
from app.schemas.values import GIVEN, Given

router = APIRouter(prefix="/api/v1", tags=["templates"], route_class=StrictRoute)


class FilmPressureIn(Bounded):
    """The inputs of a journal that runs steadily in its film."""

    model_config = ConfigDict(
        strict=True, extra="forbid", json_schema_extra={"examples": [{"inputs": TYPICAL}]}
    )

    inputs: dict[str, Given] = Field(
        max_length=20,
        description="inputs as in `evaluate`, each with a single value",
        json_schema_extra={
            "properties": dict.fromkeys(TYPICAL, GIVEN),
            "required": list(TYPICAL),
            "additionalProperties": False,
        },
    )


@router.post("/film-pressure", dependencies=[needs("viewer", "admin")])
async def show_film_pressure(body: FilmPressureIn, units: Units = "si") -> FilmPressure:
    """Return the pressure [position along the shaft][angle from the narrowest gap].

    Angles increase in the sense of rotation.
    """
    field = await in_thread(solve_film_pressure, body.inputs)
    return field.in_units(units)
