"""What a task may use: a template with inputs, a search, and closed forms written a second time."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

Inputs = Mapping[str, str]


@dataclass(frozen=True)
class Use:
    """A template with inputs, found by the words of `subject`."""

    subject: str
    template: str
    version: int
    inputs: Inputs
    limits: Inputs = field(default_factory=dict)

    def changed(self, **inputs: str) -> Use:
        """Return the use with other inputs; an empty text removes one."""
        kept = {name: text for name, text in {**self.inputs, **inputs}.items() if text}
        return Use(self.subject, self.template, self.version, kept, self.limits)

    def limited(self, **limits: str) -> Use:
        """Return the use with limits."""
        return Use(self.subject, self.template, self.version, self.inputs, limits)


@dataclass(frozen=True)
class Search:
    """One free input on a grid, the requirements, and the objective."""

    free: str
    lower: float
    upper: float
    step: float
    unit: str
    require: tuple[tuple[str, str, float, str], ...]  # output, comparison, limit, its unit
    sense: str
    objective: str


@dataclass(frozen=True)
class Case:
    """One task: a use, and what is asked of it."""

    id: str
    use: Use
    wanted: str = ""
    verdict: str = "no limit"
    search: Search | None = None
    before: tuple[Use, str, str] | None = None  # a first template, its output, the input that it gives
    wrong: str = ""  # the input whose unit is wrong or missing
    conflict: tuple[str, ...] = ()
    exact: Callable[[], float] | None = None  # a closed form [SI or the unit of the output]


FILM = Use(
    "oil film, any bore",
    "oil_film",
    2,
    {
        "radial_load": "25 kN",
        "diametral_clearance": "0.055 mm",
        "bearing_diameter": "48 mm",
        "bearing_width": "24 mm",
        "speed": "5000 rpm",
        "oil_inlet_temperature": "80 degC",
        "oil_outlet_temperature": "90 degC",
    },
)
LARGE = FILM.changed(
    radial_load="60 kN", bearing_diameter="90 mm", bearing_width="36 mm", diametral_clearance="90 um",
    speed="2500 rpm", oil_inlet_temperature="", oil_outlet_temperature="", dynamic_viscosity="14 mPa*s",
)  # fmt: skip
PETROV = Use(
    "friction of a concentric journal, Petrov",
    "journal_friction",
    1,
    {
        "journal_diameter": "50 mm",
        "bearing_width": "60 mm",
        "radial_clearance": "0.1 mm",
        "speed": "3000 rpm",
        "dynamic_viscosity": "20 mPa*s",
    },
)
SLIDER = Use(
    "slider bearing, fixed incline",
    "slider_bearing",
    1,
    {
        "length": "50 mm",
        "width": "50 mm",
        "inlet_film": "60 um",
        "outlet_film": "30 um",
        "sliding_speed": "10 m/s",
        "dynamic_viscosity": "30 mPa*s",
    },
)
THRUST = Use(
    "thrust bearing with a collar on pads",
    "thrust_bearing",
    1,
    {
        "load": "20 kN",
        "outer_diameter": "200 mm",
        "inner_diameter": "110 mm",
        "pads": "8",
        "taper": "30 um",
        "speed": "1500 rpm",
        "oil_grade": "iso_vg_46",
        "supply_temperature": "40 degC",
    },
)
WARM = Use(
    "clearance of a warm journal in its housing",
    "thermal_clearance",
    1,
    {
        "diameter": "48 mm",
        "cold_diametral_clearance": "40 um",
        "housing_expansion_coefficient": "2.3e-5 1/K",
        "journal_expansion_coefficient": "1.1e-5 1/K",
        "housing_temperature": "90 degC",
        "journal_temperature": "110 degC",
    },
)
ROLLING = Use(
    "rolling bearing life, ISO 281",
    "rolling_bearing_life",
    1,
    {"radial_load": "6 kN", "speed": "2500 rpm", "dynamic_capacity": "40 kN", "static_capacity": "24 kN"},
)
PAD = Use(
    "hydrostatic pad with a recess",
    "hydrostatic_pad",
    1,
    {
        "load": "60 kN",
        "outer_diameter": "100 mm",
        "recess_diameter": "57 mm",
        "supply_pressure": "20 MPa",
        "restrictor_diameter": "0.7 mm",
        "capillary_length": "80 mm",
        "dynamic_viscosity": "80 mPa*s",
    },
)
THROW = Use(
    "torsional stiffness of a crank throw, Carter",
    "crank_stiffness",
    1,
    {
        "journal_length": "45 mm",
        "journal_diameter": "100 mm",
        "web_thickness": "28 mm",
        "web_width": "130 mm",
        "pin_length": "50 mm",
        "pin_diameter": "85 mm",
        "throw": "68.5 mm",
        "shear_modulus": "80 GPa",
    },
)


def petrov_torque(
    d: float = 0.05, b: float = 0.06, c: float = 1e-4, n: float = 3000.0, eta: float = 0.02
) -> float:
    """Return the torque of a concentric journal, pi eta omega d^3 b / (4 c) [N m] (Petrov 1883)."""
    return math.pi * eta * (n * math.pi / 30) * d**3 * b / (4 * c)


def warm_clearance() -> float:
    """Return the clearance of a bore of alpha 2.3e-5 at 90 °C and a journal of 1.1e-5 at 110 °C [um]."""
    return 40 + 48e3 * (2.3e-5 * 70 - 1.1e-5 * 90)


def rating_life() -> float:
    """Return the life of a ball bearing under a constant load, (C/P)^3 10^6 turns [h] (ISO 281)."""
    return (40 / 6) ** 3 * 1e6 / (60 * 2500)


def carter_stiffness() -> float:
    """Return the stiffness of a throw of solid journals and pins [N m/rad], after Carter."""
    journal, pin, web = 100.0**4, 85.0**4, 28 * 130.0**3
    lengths = (45 + 0.8 * 28) / journal + 0.75 * 50 / pin + 1.5 * 68.5 / web
    return math.pi / 32 * 80e9 / (lengths * 1e9)


def searched(
    free: str, span: tuple[float, float, float], unit: str, require: str, sense: str, objective: str
) -> Search:
    """Return a search; `require` is such as `minimum_film_thickness >= 3 um; power_loss <= 900 W`."""
    parts = [[*one.split(), "1"][:4] for one in require.split("; ")]
    return Search(
        free, *span, unit, tuple((a, sign, float(limit), u) for a, sign, limit, u in parts), sense, objective
    )


WIDTH = (15.0, 40.0, 0.5)
CLEARANCE = (30.0, 120.0, 5.0)
