"""Criteria of the static film of a journal bearing, shared by the versions of `oil_film`."""

from __future__ import annotations

from templates.groups.film_criteria import ISOVISCOUS, film_exists, hot_oil, temperature

CRITERIA: dict[str, dict[str, object]] = {
    "film": {
        "require": "minimum_film_thickness >= smallest_permissible_film",
        "words": "the smallest film is not thinner than the smallest permissible one",
        "source": "ISO 7902-3:1998, table 1, as textbooks quote it",
        "unverified": "customary, source not verified: no public copy of ISO 7902-3 was at hand, and copies"
        " of its table differ",
    },
    "own_film": {
        "require": "minimum_film_thickness >= permissible_film",
        "words": "the smallest film is not thinner than its user permits",
        "limits": {"permissible_film": {"unit": "um", "words": "smallest film that its user permits"}},
    },
    "film_exists": film_exists(),
    "roughness": {
        "require": "film_parameter >= 1",
        "words": "the smallest film is thicker than the surfaces are rough",
        "source": "Hamrock, Schmid, Jacobson 2004, section 1.3: boundary friction below 1",
        "warning": "film_below_roughness",
    },
    "full_film": {
        "require": "film_parameter >= 3",
        "words": "the film parts the surfaces wholly",
        "source": "Hamrock, Schmid, Jacobson 2004, section 1.3: mixed friction from 1 to 3",
        "warning": "mixed_friction",
    },
    "pressure": {
        "require": "maximum_pressure <= permissible_pressure",
        "words": "the pressure of the film is within what the bearing material bears",
        "limits": {
            "permissible_pressure": {
                "unit": "MPa",
                "words": "largest pressure of the film that the bearing material bears",
                "from": "bearing_material",
            }
        },
    },
    "rigid": {
        "require": "maximum_pressure <= 231 GPa * relative_clearance",
        "words": "the pressure deforms the steel by less than the clearance",
        "source": "elasticity: steel deforms by about p D/E' with E' = 210 GPa/(1 - 0.3**2) = 231 GPa",
        "warning": "pressure_deforms_bearing",
    },
    "isoviscous": ISOVISCOUS,
    "specific_load": {
        "require": "radial_load / (bearing_diameter * bearing_width) <= permissible_specific_load",
        "words": "the load over bore times width is within what the bearing material bears",
        "limits": {
            "permissible_specific_load": {
                "unit": "MPa",
                "words": "largest load over bore times width that the bearing material bears",
                "from": "bearing_material",
            }
        },
    },
    "temperature": temperature("film_temperature", "the film is no hotter than the bearing material bears"),
    "oil_temperature": {
        "require": "film_temperature <= permissible_oil_temperature",
        "words": "the film is no hotter than the oil bears",
        "limits": {
            "permissible_oil_temperature": {
                "unit": "degC",
                "words": "largest temperature that the oil bears, by its supplier",
            }
        },
    },
    "hot_oil": hot_oil("film_temperature"),
    "laminar": {
        "require": "film_reynolds_number <= laminar_limit",
        "words": "the flow in the film is laminar",
        "source": "ISO 7902-1:1998",
        "warning": "turbulent_flow",
    },
    "whirl": {
        "require": "abs(speed) <= whirl_threshold_speed",
        "words": "the journal turns more slowly than where it begins to whirl",
        "source": "Lund 1965, for a rigid rotor",
        "warning": "journal_whirls",
        "absent": {
            "whirl_threshold_speed": {
                "with": "stiffness_xx",
                "reason": "there is no threshold: the film is stable at every speed, or carries no mass",
                # the same without a root: m γ² ω² ≤ k_0 ω_h², k_0 the stiffness and γ the ratio of whirl
                "instead": "rotor_mass * abs(speed)**2 * ((stiffness_xx - (stiffness_xx * damping_yy"
                " + stiffness_yy * damping_xx - stiffness_xy * damping_yx - stiffness_yx * damping_xy)"
                " / (damping_xx + damping_yy)) * (stiffness_yy - (stiffness_xx * damping_yy"
                " + stiffness_yy * damping_xx - stiffness_xy * damping_yx - stiffness_yx * damping_xy)"
                " / (damping_xx + damping_yy)) - stiffness_xy * stiffness_yx)"
                " <= (stiffness_xx * damping_yy + stiffness_yy * damping_xx - stiffness_xy * damping_yx"
                " - stiffness_yx * damping_xy) / (damping_xx + damping_yy) * hydrodynamic_speed**2"
                " * (damping_xx * damping_yy - damping_xy * damping_yx)",
            }
        },
    },
    "pressure_times_speed": {
        "require": "radial_load * abs(sliding_speed) / (2 * bearing_width)"
        " <= permissible_pressure_times_speed",
        "words": "specific load times sliding speed is within what its user permits",
        "limits": {
            "permissible_pressure_times_speed": {
                "unit": "MPa*m/s",
                "words": "largest specific load times sliding speed that its user permits",
            }
        },
    },
}
