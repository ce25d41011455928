"""Oils by grade: SAE J300 engine oils and ISO 3448 industrial oils, from `oil_grades.csv`.

A grade specifies the viscosity at one temperature only; the table states the assumption for the other. At the
shear rates of a bearing a multigrade oil is thinner than its kinematic viscosity suggests, by up to a third;
give `dynamic_viscosity` if that matters.

References
----------
SAE J300:2015. ISO 3448:1992. ASTM D2270-10 (viscosity index).
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units
from templates.physics.journals.oil import MM2_PER_S

_DATA = Path(__file__).with_name("oil_grades.csv")


@cache
def _table() -> dict[str, tuple[float, float]]:
    """Return the kinematic viscosities at 40 and 100 °C by grade [mm²/s]."""
    return {row[0]: (float(row[1]), float(row[2])) for row in _rows()}


def _rows() -> list[list[str]]:
    """Return the cells of the table, without its header."""
    lines = _DATA.read_text(encoding="utf-8").splitlines()
    return [line.split(",") for line in lines if not line.startswith("#")][1:]


def grades() -> tuple[str, ...]:
    """Return all grades in the table."""
    return tuple(_table())


def basis(grade: str) -> str:
    """Return the source from which the viscosities of a grade are taken."""
    return next(row[4] for row in _rows() if row[0] == grade)


@units(None, returns="m**2/s")
def viscosity_at_40(grade: str) -> Array:
    """Return the kinematic viscosity of a grade at 40 °C [m²/s]."""
    return np.asarray(_table()[grade][0] * MM2_PER_S)


@units(None, returns="m**2/s")
def viscosity_at_100(grade: str) -> Array:
    """Return the kinematic viscosity of a grade at 100 °C [m²/s]."""
    return np.asarray(_table()[grade][1] * MM2_PER_S)
