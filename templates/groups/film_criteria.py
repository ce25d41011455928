"""Criteria shared by films of several kinds of bearings."""

from __future__ import annotations

ISOVISCOUS: dict[str, object] = {
    "require": "maximum_pressure <= 500 MPa",
    "words": "the pressure does not make the oil thousands of times thicker",
    "source": "Barus 1893, 20 1/GPa for mineral oil: at 500 MPa it is e**10 = 22 000 times as thick",
    "warning": "pressure_thickens_oil",
}


def hot_oil(temperature: str) -> dict[str, object]:
    """Return the criterion for the highest oil temperature at which plain bearings operate."""
    return {
        "require": f"{temperature} <= 125 degC",
        "words": "the oil is no hotter than plain bearings run with, in exceptional cases too",
        "source": "DIN 31652-3, largest value in its table of temperatures, as textbooks quote it",
        "unverified": "customary, source not verified: no public copy of DIN 31652-3 was at hand",
        "warning": "oil_too_hot",
    }


def temperature(output: str, words: str) -> dict[str, object]:
    """Return the criterion for the permissible temperature of the bearing material, for an output."""
    return {
        "require": f"{output} <= permissible_temperature",
        "words": words,
        "limits": {
            "permissible_temperature": {
                "unit": "degC",
                "words": "largest temperature that the bearing material bears",
                "from": "bearing_material",
            }
        },
    }


def film_exists(thickness: str = "minimum_film_thickness") -> dict[str, object]:
    """Return the criterion that a full film exists, for the relation that gives its thickness."""
    return {
        "require": f"{thickness} >= 0.05 um",
        "words": "the film is not thinner than the finest surfaces are rough",
        "source": "ISO 1302:1992, grade N2: Ra 0.05 um, lapped or superfinished",
        "warning": "film_too_thin",
    }
