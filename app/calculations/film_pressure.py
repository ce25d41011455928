"""The pressure of a journal bearing's oil film over its unrolled surface, for pictures.

The journal is steady, rigid and aligned, at a given eccentricity. Reynolds' equation is solved with
Swift-Stieber rupture, as in `templates.physics.films.reynolds`. The field is for display only: it is solved
on 64 × 16 intervals, with an error of 0.1 % of the largest pressure.
"""

from __future__ import annotations

import numpy as np

from app.calculations.schemas.film_pressure import Field, FilmPressure
from app.plain import JsonObject, Raw
from app.schemas.answers import Quantity, Values
from templates.core.errors import Fault, InvalidInputs
from templates.core.language.template import Array, Template, given
from templates.physics.films.film_measures import measure
from templates.physics.films.reynolds import static_field

AROUND, ACROSS = 64, 8  # intervals; across half the width
TYPICAL: JsonObject = {
    "relative_eccentricity": 0.88,
    "bearing_diameter": "48 mm",
    "bearing_width": "18 mm",
    "diametral_clearance": "0.055 mm",
    "speed": "5000 rpm",
    "dynamic_viscosity": "18 mPa*s",
}


class Film(Template):
    """The inputs that determine the pressure of a film."""

    example = TYPICAL

    eps: Array = given("1", "relative eccentricity", ge=0, le=1 - 1e-6)
    D: Array = given("mm", "bearing diameter", gt=0)
    W: Array = given("mm", "bearing width", gt=0)
    c: Array = given("mm", "diametral clearance", gt=0)
    omega: Array = given("rpm", "speed", gt=0)
    eta: Array = given("mPa*s", "dynamic viscosity", gt=0)


def solve_film_pressure(raw: dict[str, Raw]) -> FilmPressure:
    """Return the pressure field for inputs in any unit.

    Raises
    ------
    InvalidInputs
        If an input is wrong, is an array, or is outside the range of the film's solution.
    """
    film = Film.from_quantities(raw)
    arrays = [name for name, value in film.inputs_si().items() if np.ndim(value)]
    if arrays:
        raise InvalidInputs(
            Fault(name, "not_a_number", "give a single value here, not an array") for name in arrays
        )
    ratio = float(film.W / film.D)
    if not 0.01 <= ratio <= 100:
        detail = f"width over diameter must be ≥ 0.01 and ≤ 100; here it is {ratio:.4g}"
        raise InvalidInputs([Fault("bearing_width", "out_of_domain", detail)])
    with np.errstate(all="ignore"):
        scale = float(film.eta * film.omega * np.square(film.D / film.c)) / 1e6  # MPa
    if not np.isfinite(scale):
        raise InvalidInputs(
            [Fault("diametral_clearance", "not_finite", "the pressure has no finite value here")]
        )
    field = static_field(max(float(film.eps), 1e-9), ratio, AROUND, ACROSS)
    around = np.r_[field.mesh.phi, np.pi]  # beyond the mesh the film has ruptured
    half = np.pad(field.rupture.P.T * scale, ((0, 0), (0, 1)))
    place = np.r_[-field.mesh.zeta[:0:-1], field.mesh.zeta] * float(film.W) * 500
    return FilmPressure(
        bearing_diameter=Quantity(value=float(film.D) * 1e3, unit="mm"),
        angle=Values(value=np.degrees(around).tolist(), unit="deg"),
        place=Values(value=place.tolist(), unit="mm"),
        pressure=Field(value=np.r_[half[:0:-1], half].tolist(), unit="MPa"),
        maximum_pressure=Quantity(value=measure(field).P_max * scale, unit="MPa"),
        attitude_angle=Quantity(value=float(np.degrees(measure(field).attitude)), unit="deg"),
    )
