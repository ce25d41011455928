"""Mobility of the short bearing: the exact half film, and the closed form that Booker fitted to it.

Only axial flow, P = 0 at the ends and wherever the gap grows (half film). Angles and components as in
`moving_film`: a load at an angle chi from the narrowest gap moves the journal's centre with
d(eps)/dt = M F psi²/(B D eta), M given along the line of centres and ahead of it.

References
----------
J. F. Booker, Trans. ASME J. Basic Eng. 87, 1965, p. 537; J. Lubr. Technol. 93, 1971, p. 168.
"""

import numpy as np

from templates.core.arrays import Array
from templates.physics.numerics.arrays import require, require_film
from templates.physics.numerics.roots import bracketed_root

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(32)


def squeeze_force_Booker_1965(eps: Array, ratio: Array, direction: Array) -> Array:
    r"""Load borne by the half film of a short bearing whose journal moves, F psi²/(B D eta v/c) [-].

    .. math:: \vec R = 2 b^2 \int_{\alpha-\pi/2}^{\alpha+\pi/2}
        \frac{(\cos\varphi, \sin\varphi)\cos(\varphi-\alpha)}{(1-\epsilon\cos\varphi)^3}\,d\varphi

    integrated over Sommerfeld's angle, in which it is a trigonometric polynomial, to rounding.

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].
    ratio
        Width over diameter b = B/D [-].
    direction
        Angle alpha of the velocity from the narrowest gap, 0 … pi [rad].

    Returns
    -------
    (2, ...) along the line of centres (towards the narrowest gap) and ahead of it.

    Raises
    ------
    ValueError
        If an argument lies outside its range.

    Examples
    --------
    >>> squeeze_force_Booker_1965(0.0, 0.5, 1.0).round(6)
    array([0.424352, 0.66089 ])
    """
    require_film(eps, ratio)
    eps, ratio, direction = np.broadcast_arrays(*(np.asarray(x, float) for x in (eps, ratio, direction)))
    s = np.sqrt((1 - eps) * (1 + eps))
    start, end = _sommerfeld_angle(direction - np.pi / 2, eps), _sommerfeld_angle(direction + np.pi / 2, eps)
    half = (end - start) / 2
    gamma = np.multiply.outer(_NODES, half) + (start + end) / 2
    cos, sin = 2 * np.cos(gamma / 2) ** 2 - (1 - eps), s * np.sin(gamma)
    weight = np.multiply.outer(_WEIGHTS, half) * (cos * np.cos(direction) + sin * np.sin(direction))
    return np.asarray(2 * ratio**2 / s**5 * np.sum(weight * np.stack([cos, sin]), axis=1))


def mobility_Booker_1965(eps: Array, ratio: Array, load_direction: Array) -> Array:
    """Mobility M of the short bearing's half film, by inversion of `squeeze_force_Booker_1965` [-].

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].
    ratio
        Width over diameter B/D [-].
    load_direction
        Angle chi of the load on the journal from the narrowest gap, −pi … pi [rad].

    Returns
    -------
    (2, ...) along the line of centres and ahead of it.

    Raises
    ------
    ValueError
        If an argument lies outside its range.
    """
    _require_direction(load_direction)
    eps, ratio, chi = np.broadcast_arrays(*(np.asarray(x, float) for x in (eps, ratio, load_direction)))
    turn = np.clip(np.abs(chi), 0, np.pi)

    def excess(direction: Array) -> Array:
        along, ahead = squeeze_force_Booker_1965(eps, ratio, direction)
        return np.asarray(np.arctan2(np.abs(ahead), along) - turn)

    alpha = bracketed_root(excess, np.zeros(chi.shape), np.full(chi.shape, np.pi))
    alpha = np.where(np.isnan(alpha), turn, alpha)  # along the line of centres rounding hides the root
    force = squeeze_force_Booker_1965(eps, ratio, alpha)
    return np.stack([np.cos(alpha), np.copysign(np.sin(alpha), chi)]) / np.hypot(*force)


def mobility_Booker_1971(eps: Array, ratio: Array, load_direction: Array) -> Array:
    r"""Booker's closed form for the mobility M of the short bearing's half film, a fit [-].

    .. math:: M_\xi = \frac{(1-\xi)^{5/2}}{\pi b^2}, \quad M_\eta = -\frac{4\,\eta\,(1-\xi)^{3/2}}{\pi^2 b^2}

    with :math:`\xi = \epsilon\cos\chi, \eta = -\epsilon\sin\chi` the eccentricity along the load and
    ahead of it. Its error over the size of M, at the worst direction, against `mobility_Booker_1965`:
    1.0 % up to eps 0.2, 2.6 % to 0.5, 5.7 % to 0.8, 7.5 % to 0.9, 10.4 % to 0.99, 11.6 % beyond.

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].
    ratio
        Width over diameter b = B/D [-].
    load_direction
        Angle chi of the load on the journal from the narrowest gap, −pi … pi [rad].

    Returns
    -------
    (2, ...) along the line of centres and ahead of it.

    Raises
    ------
    ValueError
        If an argument lies outside its range.
    """
    require_film(eps, ratio)
    _require_direction(load_direction)
    eps, ratio, chi = np.broadcast_arrays(*(np.asarray(x, float) for x in (eps, ratio, load_direction)))
    cos, sin = np.cos(chi), np.sin(chi)
    thin = (1 - eps) + 2 * eps * np.sin(chi / 2) ** 2
    along = thin**2.5 / (np.pi * ratio**2)
    ahead = 4 * eps * sin * thin**1.5 / (np.pi * ratio) ** 2
    return np.stack([along * cos - ahead * sin, along * sin + ahead * cos])


def _require_direction(load_direction: Array) -> None:
    """Refuse an angle outside −pi … pi."""
    require(np.abs(load_direction) <= np.pi, "load_direction must lie in [-pi, pi]")


def _sommerfeld_angle(phi: Array, eps: Array) -> Array:
    """Sommerfeld's angle from the narrowest gap, continuous for phi from −2 pi to 2 pi [rad]."""
    return np.asarray(2 * np.arctan2(np.sin(phi / 2) * np.sqrt(1 + eps), np.cos(phi / 2) * np.sqrt(1 - eps)))
