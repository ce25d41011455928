"""`/film-pressure`: the pressure of a journal bearing's oil film over its unrolled surface, for pictures.

A steady, rigid, aligned journal at a given eccentricity; Reynolds' equation with Swift-Stieber rupture, as
`templates.physics.films.reynolds`. What a template says of the same film stays with the template: this field
is
solved afresh on a mesh for the eye, 64 × 16 intervals, which errs by 0.1 % of the largest pressure.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from fastapi import APIRouter
from pydantic import ConfigDict, Field
from starlette.concurrency import run_in_threadpool

from app.api.dependencies import Units
from app.api.reading import StrictRoute
from app.presentation.units import converted
from app.schemas.bounded import Bounded
from app.schemas.values import GIVEN
from templates.core.errors import Fault, InvalidInputs
from templates.core.language.template import Array, Template, given
from templates.physics.films.film_measures import measure
from templates.physics.films.reynolds import static_field

router = APIRouter(prefix="/api/v1", tags=["templates"], route_class=StrictRoute)

AROUND, ACROSS = 64, 8  # intervals; across half the width
TYPICAL: dict[str, Any] = {
    "relative_eccentricity": 0.88,
    "bearing_diameter": "48 mm",
    "bearing_width": "18 mm",
    "diametral_clearance": "0.055 mm",
    "speed": "5000 rpm",
    "dynamic_viscosity": "18 mPa*s",
}


class FilmPressure(Template):
    """What the pressure of a film follows from."""

    example = TYPICAL

    eps: Array = given("1", "relative eccentricity", ge=0, le=1 - 1e-6)
    D: Array = given("mm", "bearing diameter", gt=0)
    W: Array = given("mm", "bearing width", gt=0)
    c: Array = given("mm", "diametral clearance", gt=0)
    omega: Array = given("rpm", "speed", gt=0)
    eta: Array = given("mPa*s", "dynamic viscosity", gt=0)


class FilmPressureIn(Bounded):
    """A journal at rest in its film."""

    model_config = ConfigDict(
        strict=True, extra="forbid", json_schema_extra={"examples": [{"inputs": TYPICAL}]}
    )

    inputs: dict[str, Any] = Field(
        max_length=20,
        description="one value each, as in `evaluate`",
        json_schema_extra={
            "properties": dict.fromkeys(TYPICAL, GIVEN),
            "required": list(TYPICAL),
            "additionalProperties": False,
        },
    )


@router.post("/film-pressure")
async def show_film_pressure(body: FilmPressureIn, units: Units = "si") -> dict[str, Any]:
    """Pressure [place along the shaft][angle from the narrowest gap, in the sense of rotation]."""
    return converted(await run_in_threadpool(solved, body.inputs), units)  # type: ignore[no-any-return]


def solved(raw: dict[str, Any]) -> dict[str, Any]:
    """The field for inputs as a user types them.

    Raises
    ------
    InvalidInputs
        If an input is wrong, an array, or outside what the film's solution covers.
    """
    film = FilmPressure.from_quantities(raw)
    arrays = [name for name, value in film.inputs_si().items() if np.ndim(value)]
    if arrays:
        raise InvalidInputs(
            Fault(name, "not_a_number", "one value is wanted here, not an array") for name in arrays
        )
    ratio = float(film.W / film.D)
    if not 0.01 <= ratio <= 100:
        told = f"width over diameter must be ≥ 0.01 and ≤ 100; here it is {ratio:.4g}"
        raise InvalidInputs([Fault("bearing_width", "out_of_domain", told)])
    with np.errstate(all="ignore"):
        scale = float(film.eta * film.omega * np.square(film.D / film.c)) / 1e6  # MPa
    if not np.isfinite(scale):
        raise InvalidInputs(
            [Fault("diametral_clearance", "not_finite", "the pressure has no finite value here")]
        )
    field = static_field(max(float(film.eps), 1e-9), ratio, AROUND, ACROSS)
    around = np.r_[field.mesh.phi, np.pi]  # beyond the mesh the film has ruptured
    half = np.pad(field.rupture.P.T * scale, ((0, 0), (0, 1)))
    return {
        "bearing_diameter": {"value": float(film.D) * 1e3, "unit": "mm"},
        "angle": {"value": np.degrees(around).tolist(), "unit": "deg"},
        "place": {
            "value": (np.r_[-field.mesh.zeta[:0:-1], field.mesh.zeta] * float(film.W) * 500).tolist(),
            "unit": "mm",
        },
        "pressure": {"value": np.r_[half[:0:-1], half].tolist(), "unit": "MPa"},
        "maximum_pressure": {"value": measure(field).P_max * scale, "unit": "MPa"},
        "attitude_angle": {"value": float(np.degrees(measure(field).attitude)), "unit": "deg"},
    }
