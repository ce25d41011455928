"""Rupture of the long journal bearing's film: no axial flow, pressure along the circumference only.

H = 1 + eps cos(theta) from the widest gap; gamma is Sommerfeld's angle, H = (1−eps²)/(1−eps cos gamma). Tests
compare with the closed forms of its load and pressure in `tests/references/long_bearing.py`.

References
----------
H. W. Swift, Proc. Inst. Civ. Eng. 233, 1932, p. 267; W. Stieber, Das Schwimmlager, VDI 1933.
"""

from math import cos, pi, sin

import numpy as np
from scipy.optimize import brentq

from templates.physics.numerics.arrays import require_film


def rupture_Swift_Stieber(eps: float) -> float:
    r"""Return Sommerfeld's angle gamma of film rupture, P = dP/dtheta = 0, in (pi, 3 pi/2) [rad].

    .. math:: \epsilon(\sin\gamma\cos\gamma - \gamma) + 2(\sin\gamma - \gamma\cos\gamma) = 0

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].

    Raises
    ------
    ValueError
        If the eccentricity lies outside its range.

    References
    ----------
    Swift 1932; Stieber 1933.
    """
    eps = float(eps)
    require_film(np.asarray(eps), np.ones(()))

    def pressure(gamma: float) -> float:
        s, c = sin(gamma), cos(gamma)
        return eps * (s * c - gamma) + 2 * (s - gamma * c)

    return float(brentq(pressure, pi, 1.5 * pi, xtol=1e-300, rtol=4 * np.finfo(float).eps))
