"""Separation of surfaces by a film: the film parameter lambda, and the lubrication regime.

References
----------
Hamrock, Schmid, Jacobson: Fundamentals of Fluid Film Lubrication, 2nd ed. 2004, section 1.3: boundary below
1, mixed from 1 to 3, full film above 3.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units

BOUNDARY, FREE = 0.5, 0.0001
"""Shares of the load carried by contact: friction is boundary above the first, the film is full up to the
second.
"""


@units("m", "m", "m", returns="1", latex=r"\frac{{{0}}}{{\sqrt{{{1}^2+{2}^2}}}}")
def film_parameter(h: Array, R_1: Array, R_2: Array) -> Array:
    """Return the smallest film h, divided by the composite of the rms roughnesses R_1 and R_2 [-]."""
    roughness = np.hypot(R_1, R_2)
    return np.where(roughness > 0, h / np.where(roughness > 0, roughness, 1.0), np.nan)[()]


@units("1", returns="1")
def lubrication_regime(parameter: Array) -> Any:
    """Return the regime at a film parameter [1]: boundary, mixed or full_film; empty where it is NaN."""
    parameter = np.asarray(parameter)
    words = np.select([parameter < 1, parameter <= 3, parameter > 3], ["boundary", "mixed", "full_film"], "")
    return words if words.ndim else str(words)


@units("1", returns="1")
def regime_of_contact(share: Array) -> Any:
    """Return the regime from the fraction of the load carried by contact [1]; empty where it is NaN.

    The regime is boundary if the contact carries more than the film, full_film if it carries at most 0.0001
    of the load, and mixed in between. The film parameter gives the same regime only under light load: at high
    pressure the film carries nearly all the load even at a parameter below 1.
    """
    share = np.asarray(share)
    words = np.select([share > BOUNDARY, share > FREE, share >= 0], ["boundary", "mixed", "full_film"], "")
    return words if words.ndim else str(words)


@units("Pa*s", "rad/s", "m", "m", "N", returns="1", latex=r"\frac{{{0}\,\left|{1}\right|\,{2}\,{3}}}{{{4}}}")
def duty_parameter(eta: Array, omega: Array, D: Array, W: Array, F: Array) -> Array:
    """Return Stribeck's duty parameter eta |omega|/p with p = F/(D W) [1]; NaN without load.

    References
    ----------
    R. Stribeck, Z. VDI 46, 1902; M. D. Hersey, 1914 (with revolutions instead of radians).
    """
    loaded = np.asarray(F) > 0
    return np.where(loaded, eta * np.abs(omega) * D * W / np.where(loaded, F, 1.0), np.nan)[()]


@units("N*m", "N", "m", returns="1", latex=r"\frac{{{0}}}{{{1}\,{2}/2}}")
def friction_coefficient(torque: Array, F: Array, D: Array) -> Array:
    """Return the friction coefficient from a torque [N m], a load F [N] and the diameter D [m].

    The result is NaN without load.
    """
    loaded = np.asarray(F) > 0
    return np.where(loaded, torque / (np.where(loaded, F, 1.0) * D / 2), np.nan)[()]
