"""Smallest permissible film of a journal bearing in design, after DIN 31652-3 / ISO 7902-3, table 1.

The numbers are quoted from textbooks; they were not checked against the standard, of which we found no public
copy.

References
----------
DIN 31652-3:1983; ISO 7902-3:1998: from experience, against wear and dirt, for Rz of the journal up to 4 µm.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units

_DATA = Path(__file__).with_name("smallest_film_iso_7902.csv")
_WIDEST = 2.5  # m


@cache
def _table() -> tuple[Array, Array, Array]:
    """Return the lower ends of the ranges of diameter [m] and speed [m/s], and the film for each [m]."""
    header, *rows = [
        line.split(",") for line in _DATA.read_text(encoding="utf-8").splitlines() if not line.startswith("#")
    ]
    values = np.array(rows, dtype=float)
    speeds = np.array([float(name.removeprefix("speed_")) for name in header[1:]])
    return values[:, 0] * 1e-3, speeds, values[:, 1:] * 1e-6


@units("m", "m/s", returns="m")
def smallest_film_ISO_7902(d: Array, U: Array) -> Array:
    """Return the smallest permissible film [m] for a journal of diameter d [m] with sliding speed U [m/s].

    The result is NaN for journals up to 24 mm and above 2500 mm, which the table does not cover.
    """
    diameters, speeds, films = _table()
    row = np.searchsorted(diameters, d, side="left") - 1
    column = np.maximum(np.searchsorted(speeds, np.abs(U), side="left") - 1, 0)
    covered = (row >= 0) & (d <= _WIDEST) & np.isfinite(U)
    return np.where(covered, films[np.maximum(row, 0), column], np.nan)[()]
