"""Closed forms of the long journal bearing: no axial flow, pressure along the circumference only.

Three boundary conditions, which differ by −20 and +50 % in load at eps 0.5; each name says its own.
H = 1 + eps cos(theta) from the widest gap; gamma is Sommerfeld's angle, H = (1−eps²)/(1−eps cos gamma).

References
----------
A. Sommerfeld, Z. Math. Phys. 50, 1904, p. 97; L. Gümbel, Monatsbl. Berl. Bez.-Ver. VDI, 1914;
H. W. Swift, Proc. Inst. Civ. Eng. 233, 1932, p. 267; W. Stieber, Das Schwimmlager, VDI 1933.
"""

import numpy as np

from templates.core.arrays import Array
from templates.physics.films.long_bearing import rupture_Swift_Stieber
from templates.physics.numerics.arrays import require_film

_rupture = np.vectorize(rupture_Swift_Stieber)


def load_Sommerfeld_1904(eps: Array) -> Array:
    r"""Sommerfeld number So of a full film that bears tension; its attitude is 90° [-].

    .. math:: So = \frac{6\pi\epsilon}{(2+\epsilon^2)\sqrt{1-\epsilon^2}}

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].

    Examples
    --------
    >>> round(float(load_Sommerfeld_1904(0.5)), 6)
    4.836798

    References
    ----------
    Sommerfeld 1904.
    """
    require_film(eps, np.ones(()))
    return 6 * np.pi * eps / ((2 + eps**2) * np.sqrt((1 - eps) * (1 + eps)))


def _force_Gumbel(eps: Array) -> tuple[Array, Array]:
    """So along and across the line of centres of Sommerfeld's pressure over the converging half [-]."""
    along = 6 * eps**2 / ((2 + eps**2) * (1 - eps) * (1 + eps))
    return along, load_Sommerfeld_1904(eps) / 2


def load_Gumbel_1914(eps: Array) -> Array:
    r"""Sommerfeld number So of the half film: Sommerfeld's pressure where it is positive [-].

    .. math:: So = \frac{3\epsilon\sqrt{4\epsilon^2 + \pi^2(1-\epsilon^2)}}{(2+\epsilon^2)(1-\epsilon^2)}

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].

    Examples
    --------
    >>> round(float(load_Gumbel_1914(0.5)), 6)
    2.576583

    References
    ----------
    Gümbel 1914.
    """
    return np.hypot(*_force_Gumbel(eps))


def attitude_Gumbel_1914(eps: Array) -> Array:
    r"""Angle between load and narrowest gap of the half film [rad].

    .. math:: \tan\beta = \frac{\pi\sqrt{1-\epsilon^2}}{2\epsilon}

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].

    Examples
    --------
    >>> round(float(np.degrees(attitude_Gumbel_1914(0.5))), 4)
    69.819

    References
    ----------
    Gümbel 1914.
    """
    require_film(eps, np.ones(()))
    return np.arctan2(np.pi * np.sqrt((1 - eps) * (1 + eps)), 2 * eps)


def force_Swift_Stieber(eps: Array) -> tuple[Array, Array]:
    r"""So along the line of centres (towards the widest gap) and across it [-].

    .. math::
        So_\parallel = \frac{3\epsilon(1-\cos\gamma_r)^2}{2(1-\epsilon^2)(1-\epsilon\cos\gamma_r)}

                So_\perp = \frac{3\epsilon(\gamma_r-\sin\gamma_r\cos\gamma_r)}
        {2\sqrt{1-\epsilon^2}(1-\epsilon\cos\gamma_r)}

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].

    References
    ----------
    Swift 1932; Stieber 1933; integrals by parts of the pressure in `pressure_Swift_Stieber`.
    """
    gamma = _rupture(eps)
    s2, one = (1 - eps) * (1 + eps), 1 - eps * np.cos(gamma)
    along = 1.5 * eps * (1 - np.cos(gamma)) ** 2 / (s2 * one)
    across = 1.5 * eps * (gamma - np.sin(gamma) * np.cos(gamma)) / (np.sqrt(s2) * one)
    return along, across


def load_Swift_Stieber(eps: Array) -> Array:
    """Sommerfeld number So of the long bearing whose film starts at the widest gap and ruptures freely [-].

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].

    Examples
    --------
    >>> round(float(load_Swift_Stieber(0.5)), 5)
    3.22778

    References
    ----------
    Swift 1932; Stieber 1933.
    """
    return np.hypot(*force_Swift_Stieber(eps))


def pressure_Swift_Stieber(eps: Array, gamma: Array) -> Array:
    r"""Pressure P = p psi²/(eta omega) at Sommerfeld's angle, zero beyond the rupture [-].

    .. math::
        P = \frac{3\epsilon}{(1-\epsilon^2)^{3/2}(1-\epsilon\cos\gamma_r)}
        \left[2(\sin\gamma - \gamma\cos\gamma_r) +
        \epsilon(2\cos\gamma_r\sin\gamma - \gamma - \sin\gamma\cos\gamma)\right]

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].
    gamma
        Sommerfeld's angle from the widest gap, 0 … 2 pi [rad].

    References
    ----------
    Swift 1932; Stieber 1933.
    """
    end = _rupture(eps)
    s2, sin, cos, cos_end = (1 - eps) * (1 + eps), np.sin(gamma), np.cos(gamma), np.cos(end)
    bracket = 2 * (sin - gamma * cos_end) + eps * (2 * cos_end * sin - gamma - sin * cos)
    return np.where(gamma < end, 3 * eps * bracket / (s2**1.5 * (1 - eps * cos_end)), 0.0)
