"""The 60 cases of the bench: what each task states, and what is asked."""

from __future__ import annotations

from benchmarks.agent_tasks.uses import (
    CLEARANCE,
    FILM,
    LARGE,
    PAD,
    PETROV,
    ROLLING,
    SLIDER,
    THROW,
    THRUST,
    WARM,
    WIDTH,
    Case,
    Use,
    carter_stiffness,
    petrov_torque,
    rating_life,
    searched,
    warm_clearance,
)

POWER = "power_loss"
H = "minimum_film_thickness"

NUMBERS = [
    Case("number-01", FILM.limited(permissible_film="3 um"), H, "confirmed"),
    Case("number-02", LARGE, POWER),
    Case("number-03", FILM.changed(radial_load="40 kN").limited(permissible_film="4 um"), H, "not met"),
    Case("number-04", PETROV, "friction_torque", exact=petrov_torque),
    Case("number-05", SLIDER.limited(permissible_pressure="5 MPa"), "maximum_pressure", "confirmed"),
    Case("number-06", THRUST.limited(smallest_permissible_film="20 um"), H, "confirmed"),
    Case(
        "number-07",
        WARM.limited(smallest_permissible_clearance="50 um"),
        "diametral_clearance",
        "met",
        exact=warm_clearance,
    ),
    Case("number-08", ROLLING.limited(required_life="1500 h"), "life_in_hours", "met", exact=rating_life),
    Case("number-09", THROW, "stiffness_carter", exact=carter_stiffness),
    Case("number-10", PAD.limited(smallest_permissible_film="30 um"), "film_thickness", "met"),
]

SEARCHES = [
    Case("search-01", FILM, search=searched("bearing_width", WIDTH, "mm", f"{H} >= 3 um", "least", POWER)),
    Case(
        "search-02",
        FILM.changed(radial_load="35 kN"),
        search=searched(
            "bearing_width", WIDTH, "mm", f"{H} >= 3 um; maximum_pressure <= 120 MPa", "least", POWER
        ),
    ),
    Case(
        "search-03",
        FILM.changed(bearing_width="28 mm"),
        search=searched("diametral_clearance", CLEARANCE, "um", f"{H} >= 4 um", "least", POWER),
    ),
    Case(
        "search-04",
        LARGE,
        search=searched("speed", (800.0, 4000.0, 100.0), "rpm", f"{H} >= 5 um", "least", POWER),
    ),
    Case(
        "search-05",
        SLIDER,
        search=searched("width", (30.0, 80.0, 1.0), "mm", "load >= 4000 N", "least", POWER),
    ),
    Case(
        "search-06",
        SLIDER,
        search=searched("sliding_speed", (2.0, 20.0, 0.5), "m/s", "power_loss <= 300 W", "greatest", "load"),
    ),
    Case(
        "search-07",
        SLIDER,
        search=searched("outlet_film", (20.0, 50.0, 1.0), "um", "load >= 2500 N", "least", POWER),
    ),
    Case(
        "search-08",
        LARGE,
        search=searched(
            "radial_load", (20.0, 120.0, 2.0), "kN", f"{H} >= 4 um", "greatest", "maximum_pressure"
        ),
    ),
    Case(
        "search-09",
        PETROV,
        search=searched(
            "bearing_width", (30.0, 120.0, 2.0), "mm", "power_loss <= 150 W", "greatest", "width_ratio"
        ),
    ),
    Case(
        "search-10",
        LARGE,
        search=searched("bearing_width", (20.0, 60.0, 1.0), "mm", f"{H} >= 6 um", "least", POWER),
    ),
]

COLD = WARM.changed(cold_diametral_clearance="30 um", housing_temperature="80 degC")
BEFORE_FILM = FILM.changed(diametral_clearance="")
OIL = FILM.changed(radial_load="15 kN")
CHAINS = [
    Case(
        "chain-01",
        BEFORE_FILM.limited(permissible_film="3 um"),
        H,
        "confirmed",
        before=(WARM, "diametral_clearance", "diametral_clearance"),
    ),
    Case("chain-02", BEFORE_FILM, POWER, before=(COLD, "diametral_clearance", "diametral_clearance")),
    Case(
        "chain-03",
        PETROV.changed(radial_clearance=""),
        "friction_torque",
        before=(WARM, "radial_clearance", "radial_clearance"),
        exact=lambda: petrov_torque(c=warm_clearance() / 2e6),
    ),
    Case(
        "chain-04",
        PETROV.changed(dynamic_viscosity=""),
        POWER,
        before=(OIL, "dynamic_viscosity", "dynamic_viscosity"),
    ),
    Case(
        "chain-05",
        SLIDER.changed(dynamic_viscosity="").limited(permissible_pressure="4 MPa"),
        "maximum_pressure",
        "confirmed",
        before=(THRUST, "dynamic_viscosity", "dynamic_viscosity"),
    ),
    Case(
        "chain-06",
        SLIDER.changed(dynamic_viscosity=""),
        "load",
        before=(FILM, "dynamic_viscosity", "dynamic_viscosity"),
    ),
    Case(
        "chain-07",
        THRUST.changed(oil_grade="", dynamic_viscosity="").limited(smallest_permissible_film="15 um"),
        H,
        "confirmed",
        before=(OIL, "dynamic_viscosity", "dynamic_viscosity"),
    ),
    Case(
        "chain-08",
        LARGE.changed(dynamic_viscosity="").limited(permissible_film="5 um"),
        H,
        "confirmed",
        before=(THRUST, "dynamic_viscosity", "dynamic_viscosity"),
    ),
    Case(
        "chain-09",
        PAD.changed(dynamic_viscosity=""),
        "flow",
        before=(THRUST, "dynamic_viscosity", "dynamic_viscosity"),
    ),
    Case(
        "chain-10",
        BEFORE_FILM.changed(radial_load="45 kN").limited(permissible_film="4 um"),
        H,
        "not met",
        before=(COLD, "diametral_clearance", "diametral_clearance"),
    ),
]

WRONG = [
    Case("unit-01", FILM.changed(radial_load="25"), H, wrong="radial_load"),
    Case("unit-02", FILM.changed(speed="5000 mm"), H, wrong="speed"),
    Case("unit-03", FILM.changed(bearing_width="24 kg"), POWER, wrong="bearing_width"),
    Case("unit-04", PETROV.changed(dynamic_viscosity="20"), POWER, wrong="dynamic_viscosity"),
    Case("unit-05", SLIDER.changed(sliding_speed="10 mm"), "load", wrong="sliding_speed"),
    Case("unit-06", THRUST.changed(supply_temperature="40"), H, wrong="supply_temperature"),
    Case("unit-07", WARM.changed(diameter="48 degC"), "diametral_clearance", wrong="diameter"),
    Case("unit-08", ROLLING.changed(dynamic_capacity="40"), "life_in_hours", wrong="dynamic_capacity"),
    Case("unit-09", PAD.changed(supply_pressure="20 kN"), "film_thickness", wrong="supply_pressure"),
    Case("unit-10", THROW.changed(shear_modulus="80 mm"), "stiffness_carter", wrong="shear_modulus"),
]


def _conflict(
    number: int, use: Use, free: str, span: tuple[float, float, float], unit: str, require: str
) -> Case:
    """Return a task that no point of the grid meets; each requirement alone can be met unless it is alone."""
    wanted = searched(free, span, unit, require, "least", POWER)
    return Case(f"conflict-{number:02}", use, search=wanted, conflict=tuple(a for a, *_ in wanted.require))


CONFLICTS = [
    _conflict(1, FILM, "bearing_width", WIDTH, "mm", f"{H} >= 12 um"),
    _conflict(2, FILM, "bearing_width", WIDTH, "mm", f"{H} >= 6 um; power_loss <= 700 W"),
    _conflict(3, FILM, "diametral_clearance", CLEARANCE, "um", f"{H} >= 8 um"),
    _conflict(4, FILM, "bearing_width", (15.0, 20.0, 0.5), "mm", f"{H} >= 4 um"),
    _conflict(5, FILM, "speed", (500.0, 3000.0, 100.0), "rpm", f"{H} >= 4 um"),
    _conflict(6, LARGE, "bearing_width", (20.0, 60.0, 1.0), "mm", f"{H} >= 6 um; power_loss <= 1000 W"),
    _conflict(7, LARGE, "speed", (800.0, 4000.0, 100.0), "rpm", f"{H} >= 5 um; power_loss <= 1000 W"),
    _conflict(8, LARGE, "radial_load", (40.0, 100.0, 2.0), "kN", "maximum_pressure <= 20 MPa"),
    _conflict(9, SLIDER, "width", (30.0, 80.0, 1.0), "mm", "load >= 4000 N; power_loss <= 150 W"),
    _conflict(10, SLIDER, "width", (30.0, 60.0, 1.0), "mm", "load >= 8000 N"),
    _conflict(11, SLIDER, "sliding_speed", (2.0, 20.0, 0.5), "m/s", "load >= 4000 N; power_loss <= 200 W"),
    _conflict(
        12, SLIDER, "outlet_film", (20.0, 50.0, 1.0), "um", "load >= 3000 N; maximum_pressure <= 2 MPa"
    ),
    _conflict(13, SLIDER, "length", (20.0, 80.0, 1.0), "mm", "maximum_pressure >= 10 MPa"),
    _conflict(14, SLIDER, "sliding_speed", (2.0, 20.0, 0.5), "m/s", "load >= 3500 N; power_loss <= 220 W"),
    _conflict(15, LARGE, "radial_load", (20.0, 120.0, 2.0), "kN", f"{H} >= 6 um; maximum_pressure >= 60 MPa"),
    _conflict(16, SLIDER, "inlet_film", (35.0, 90.0, 1.0), "um", "load >= 6000 N"),
    _conflict(17, SLIDER, "width", (30.0, 80.0, 1.0), "mm", "load >= 3000 N; maximum_pressure <= 2 MPa"),
    _conflict(18, PETROV, "bearing_width", (30.0, 120.0, 2.0), "mm", "power_loss <= 20 W"),
    _conflict(19, PETROV, "speed", (500.0, 6000.0, 100.0), "rpm", "friction_torque <= 0.01 N*m"),
    _conflict(20, PETROV, "bearing_width", (30.0, 120.0, 2.0), "mm", "power_loss <= 100 W; width_ratio >= 2"),
]

CASES = [*NUMBERS, *SEARCHES, *CHAINS, *WRONG, *CONFLICTS]
