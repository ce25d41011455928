"""Fits of ISO 286, such as `H7/f7`: the least and the greatest clearance of a hole and a shaft."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Self

import numpy as np

from templates.core.arrays import Array
from templates.core.errors import FaultyText
from templates.core.units.fits import deviations, zones

_FIT = re.compile(r"([A-Z]{1,2}[0-9]{1,2})\s*/\s*([a-z]{1,2}[0-9]{1,2})")
HOLES, SHAFTS = ("H6", "H7", "H8"), "defgh"


@dataclass(frozen=True)
class Fit:
    """A fit: the zone of the hole and the zone of the shaft."""

    hole: str
    shaft: str

    @property
    def name(self) -> str:
        """Return the fit as a drawing states it."""
        return f"{self.hole}/{self.shaft}"

    @classmethod
    def read(cls, text: str) -> Self:
        """Return the fit with this name.

        Raises
        ------
        FaultyText
            If it is no fit, or a zone is not available.
        """
        match = _FIT.fullmatch(text.strip())
        if match is None:
            raise FaultyText(
                "not_a_fit", f"{text[:40]!r} is not a fit of a hole and a shaft, such as `H7/f7`"
            )
        for zone in match.groups():
            if zone not in zones():
                deviations(zone, 0.01)
        return cls(*match.groups())

    def clearance(self, size: float) -> tuple[float, float]:
        """Return the least and the greatest clearance [m] at a nominal size [m].

        Raises
        ------
        FaultyText
            If a zone is not available for this size.
        """
        (hole_low, hole_high), (low, high) = deviations(self.hole, size), deviations(self.shaft, size)
        return hole_low - high, hole_high - low

    def ends(self, sizes: Array) -> Array:
        """Return the least and the greatest clearance [m] at some sizes [m], shape (N, 2); NaN if none."""
        distinct, which = np.unique(sizes, return_inverse=True)
        return np.array([self._ends(size) for size in distinct.tolist()])[which.reshape(-1)]

    def _ends(self, size: float) -> tuple[float, float]:
        try:
            return self.clearance(size)
        except FaultyText:
            return float("nan"), float("nan")


def clearance_fits() -> list[Fit]:
    """Return the usual fits with clearance: the holes H6 to H8 with the shafts d5 to h9."""
    shafts = [zone for zone in zones() if zone[0] in SHAFTS and zone[1:].isdigit() and int(zone[1:]) <= 9]
    return [Fit(hole, shaft) for hole in HOLES for shaft in shafts]


def zone_ends(zone: str, sizes: Array) -> Array:
    """Return the limits [m] of some sizes [m] in a zone, shape (N, 2); NaN where the zone has none."""
    distinct, which = np.unique(sizes, return_inverse=True)
    return np.array([_limits(zone, size) for size in distinct.tolist()])[which.reshape(-1)]


def _limits(zone: str, size: float) -> tuple[float, float]:
    try:
        lower, upper = deviations(zone, size)
    except FaultyText:
        return float("nan"), float("nan")
    return size + lower, size + upper
