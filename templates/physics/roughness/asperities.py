r"""Contact of two rough surfaces with normally distributed summits, after Greenwood and Tripp.

.. math::
    p_c = \frac{16\sqrt2\,\pi}{15}(\sigma\beta\eta)^2\sqrt{\sigma/\beta}\,E'\,F_{5/2}(h/\sigma), \quad
    F_{5/2}(u) = \frac{1}{\sqrt{2\pi}}\int_u^\infty (s-u)^{5/2} e^{-s^2/2}\,ds

sigma is the composite rms roughness, beta the radius of the summits, eta their number per unit area, 1/E' the
sum of (1 − nu²)/E of both surfaces. A spline through exact values represents F_{5/2}.

References
----------
J. A. Greenwood, J. H. Tripp: The contact of two nominally flat rough surfaces, Proc. Instn Mech. Engrs 185,
1970–71, p. 625.
"""

from functools import cache

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.special import gamma, pbdv

from templates.core.arrays import Array
from templates.core.language.declare import units

FARTHEST = 10.0
"""Ratio of gap to roughness above which no summits touch: F_{5/2} is 2e-25 there [-]."""

_KNOTS = 801
_POINTS = 48


def summit_integral(u: Array) -> Array:
    """Return F_{5/2} at gap/roughness of 0 or more, exactly, by the parabolic cylinder function [-].

    Examples
    --------
    >>> round(float(summit_integral(np.asarray(0.0))), 5)
    0.61663
    """
    return gamma(3.5) / np.sqrt(2 * np.pi) * np.exp(-np.square(u) / 4) * pbdv(-3.5, u)[0]


@cache
def _logarithm() -> CubicSpline:
    """Return the spline of ln F_{5/2} over 0 … FARTHEST, accurate to 1e-9."""
    u = np.linspace(0, FARTHEST, _KNOTS)
    return CubicSpline(u, np.log(summit_integral(u)))


@cache
def _quadrature() -> tuple[Array, Array]:
    """Return Gauss points and weights on −1 … 1."""
    x, weight = np.polynomial.legendre.leggauss(_POINTS)
    return x, weight


def splined_summit_integral(u: Array) -> Array:
    """Return F_{5/2} at gap/roughness of 0 or more, from the spline; 0 above `FARTHEST` [-]."""
    return np.where(u < FARTHEST, np.exp(_logarithm()(np.minimum(u, FARTHEST))), 0.0)


@units("1", "1", "Pa", returns="Pa", latex=r"\frac{{16\sqrt{{2}}\,\pi}}{{15}}\,{0}^2\sqrt{{{1}}}\,{2}")
def contact_scale(product: Array, slenderness: Array, modulus: Array) -> Array:
    """Return the ratio of contact pressure to F_{5/2} [Pa].

    Parameters
    ----------
    product
        sigma beta eta [-].
    slenderness
        sigma over beta [-].
    modulus
        Composite modulus E' [Pa].
    """
    return 16 * np.sqrt(2) * np.pi / 15 * product**2 * np.sqrt(slenderness) * modulus


def contact_integrals(eps: Array, roughness: Array) -> tuple[Array, Array]:
    """Return the integrals of the contact pressure along the line of centres and around the circle [-].

    They are the integrals over the angle of F_{5/2} cos(phi) and of F_{5/2}, with phi from the narrowest gap.

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 [-].
    roughness
        sigma over radial clearance [-].
    """
    x, weight = _quadrature()
    eps, roughness = np.broadcast_arrays(eps, roughness)
    far = (1 - FARTHEST * roughness) / np.where(eps > 0, eps, 1e-300)
    half = np.arccos(np.clip(far, -1, 1))[..., None]
    phi = half * (1 + x) / 2
    gap = 1 - eps[..., None] * np.cos(phi)
    contact = splined_summit_integral(gap / np.maximum(roughness, 1e-300)[..., None]) * weight * half
    return (contact * np.cos(phi)).sum(-1), contact.sum(-1)
