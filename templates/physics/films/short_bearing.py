"""Closed forms of the short journal bearing: axial pressure flow only, film over the converging half.

They are valid for B/D up to about 1/4. Compared with the converged Reynolds solution at B/D 0.05, the load is
too high by 0.1–0.8 % up to eps 0.8, by 1.8 % at 0.9 and by 18 % at 0.99. Boundary condition: P = 0 at the
ends, at the widest gap and over the whole diverging half (Gümbel).

References
----------
F. W. Ocvirk, NACA TN 2808, 1952; G. B. DuBois and F. W. Ocvirk, NACA TR 1157, 1953.
"""

import numpy as np

from templates.core.arrays import Array
from templates.physics.numerics.arrays import require_film


def load_Ocvirk_1952(eps: Array, ratio: Array) -> Array:
    r"""Return the Sommerfeld number So = F psi²/(B D eta omega) of a short bearing [-].

    .. math:: So = b^2 \frac{\epsilon}{2(1-\epsilon^2)^2}\sqrt{\pi^2(1-\epsilon^2) + 16\epsilon^2}

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].
    ratio
        Width over diameter b = B/D [-].

    Raises
    ------
    ValueError
        If an argument lies outside its range.

    Examples
    --------
    >>> round(float(load_Ocvirk_1952(0.5, 1.0)), 6)
    1.500762

    References
    ----------
    NACA TN 2808, 1952, equation 27.
    """
    require_film(eps, ratio)
    s2 = (1 - eps) * (1 + eps)
    return ratio**2 * eps / (2 * s2**2) * np.sqrt(np.pi**2 * s2 + 16 * eps**2)


def attitude_Ocvirk_1952(eps: Array) -> Array:
    r"""Return the angle between load and narrowest gap [rad].

    .. math:: \tan\beta = \frac{\pi\sqrt{1-\epsilon^2}}{4\epsilon}

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].

    Examples
    --------
    >>> round(float(np.degrees(attitude_Ocvirk_1952(0.5))), 6)
    53.680201

    References
    ----------
    NACA TN 2808, 1952, equation 28.
    """
    require_film(eps, np.ones(()))
    return np.arctan2(np.pi * np.sqrt((1 - eps) * (1 + eps)), 4 * eps)


def side_flow_Ocvirk_1952(eps: Array, ratio: Array) -> Array:
    """Return the oil flow out of both ends, Q/(R³ psi omega) = 2 b eps [-].

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].
    ratio
        Width over diameter b = B/D [-].

    References
    ----------
    NACA TR 1157, 1953, equation 18.
    """
    require_film(eps, ratio)
    return 2 * ratio * eps


def friction_Ocvirk_1952(eps: Array) -> Array:
    r"""Return the friction force on the journal F_f psi/(B D eta omega), full-circle shear only [-].

    .. math:: \frac{F_f\psi}{BD\eta\omega} = \frac{\pi}{\sqrt{1-\epsilon^2}}

    The pressure term eps So sin(beta)/2 is neglected, as published. Dividing by So gives f/psi.

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].

    References
    ----------
    NACA TR 1157, 1953, equation 15.
    """
    require_film(eps, np.ones(()))
    return np.pi / np.sqrt((1 - eps) * (1 + eps))


def peak_angle_Ocvirk_1952(eps: Array) -> Array:
    r"""Return the angle of the largest pressure from the widest gap [rad].

    .. math:: \cos\theta_m = \frac{1-\sqrt{1+24\epsilon^2}}{4\epsilon}

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].

    References
    ----------
    NACA TN 2808, 1952, equation 33.
    """
    require_film(eps, np.ones(()))
    return np.arccos(-6 * eps / (1 + np.sqrt(1 + 24 * eps**2)))


def peak_pressure_Ocvirk_1952(eps: Array, ratio: Array) -> Array:
    r"""Return the largest pressure P = p psi²/(eta omega) [-].

    .. math:: P_m = \frac{3 b^2 \epsilon \sin\theta_m}{(1+\epsilon\cos\theta_m)^3}

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].
    ratio
        Width over diameter b = B/D [-].

    References
    ----------
    NACA TN 2808, 1952, equation 21.
    """
    require_film(eps, ratio)
    cos = -6 * eps / (1 + np.sqrt(1 + 24 * eps**2))
    return np.asarray(3 * ratio**2 * eps * np.sqrt((1 - cos) * (1 + cos)) / (1 + eps * cos) ** 3)
