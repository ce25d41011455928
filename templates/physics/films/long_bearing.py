"""Rupture of the long journal bearing's film: no axial flow, pressure along the circumference only.

H = 1 + eps cos(theta) from the widest gap; gamma is Sommerfeld's angle, H = (1−eps²)/(1−eps cos gamma).
Closed forms of its load and pressure, with which tests compare, stand in `tests/references/long_bearing.py`.

References
----------
H. W. Swift, Proc. Inst. Civ. Eng. 233, 1932, p. 267; W. Stieber, Das Schwimmlager, VDI 1933.
"""

import numpy as np

from templates.core.arrays import Array
from templates.physics.numerics.arrays import require_film
from templates.physics.numerics.roots import bracketed_root


def rupture_Swift_Stieber(eps: Array) -> Array:
    r"""Sommerfeld's angle gamma at which the film ruptures with P = dP/dtheta = 0, in (pi, 3 pi/2) [rad].

    .. math:: \epsilon(\sin\gamma\cos\gamma - \gamma) + 2(\sin\gamma - \gamma\cos\gamma) = 0

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].

    References
    ----------
    Swift 1932; Stieber 1933.
    """
    require_film(eps, np.ones(()))
    eps = np.asarray(eps, float)

    def pressure(gamma: Array) -> Array:
        sin, cos = np.sin(gamma), np.cos(gamma)
        return np.asarray(eps * (sin * cos - gamma) + 2 * (sin - gamma * cos))

    return bracketed_root(pressure, np.full_like(eps, np.pi), np.full_like(eps, 1.5 * np.pi))
