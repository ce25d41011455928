r"""Displacement of a bearing: the liner as columns, the housing as a thick ring in plane strain.

A bonded liner that is much thinner than the extent of the pressure cannot expand sideways: each column
shortens by p t (1 + nu)(1 − 2 nu)/(E (1 − nu)).

The ring is loaded by the pressure in its bore, distributed as cos(n theta), and by nothing outside. For n = 0
this is Lamé's solution. For n ≥ 2 the Airy stress function is Michell's

.. math:: (A r^n + B r^{n+2} + C r^{-n} + D r^{2-n})\cos n\theta

n = 1 is the load itself. The reaction of the ring's supports moves the whole bore, which is eccentricity in
the gap. Therefore n = 1 is omitted here, and the eccentricity is relative to the displaced bore.

References
----------
J. H. Michell: Proceedings of the London Mathematical Society 31, 1899, p. 100.
J. R. Barber: Elasticity, 3rd ed. 2010, tables 8.1 and 9.1, for stresses and displacements.
G. Lamé: Leçons sur la théorie mathématique de l'élasticité, 1852.
"""

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units

HARMONICS = 40
"""Highest harmonic n of the ring's deformation."""
THINNEST = 1.0005
"""Outer over inner radius above which a ring counts as one [-]."""
_ENDLESS = 1e-6
"""Inner over outer radius below which a ring deforms as an infinite body, to rounding error [-]."""


@units("m", "Pa", "1", returns="m/Pa", latex=r"\frac{{{0}\,(1+{2})(1-2\,{2})}}{{{1}\,(1-{2})}}")
def liner_compliance(thickness: Array, modulus: Array, poisson: Array) -> Array:
    """Return the shortening of a bonded layer under pressure [m/Pa].

    Parameters
    ----------
    thickness
        Thickness of the layer [m].
    modulus
        Young's modulus [Pa].
    poisson
        Poisson's ratio, below 1/2 [-].

    Examples
    --------
    >>> f"{float(liner_compliance(0.5e-3, 50e9, 0.35)):.3g}"
    '6.23e-15'
    """
    return thickness * (1 + poisson) * (1 - 2 * poisson) / (modulus * (1 - poisson))


def ring_compliance(inner: Array, outer: Array, modulus: Array, poisson: Array) -> Array:
    """Return the radial displacement of a ring's bore under 1 Pa cos(n theta), n = 0 … `HARMONICS` [m/Pa].

    Parameters
    ----------
    inner, outer
        Radii (...) [m].
    modulus
        Young's modulus (...) [Pa].
    poisson
        Poisson's ratio, below 1/2 (...) [-].

    Returns
    -------
    (..., HARMONICS + 1); 0 for n = 1, NaN throughout without a ring.
    """
    a, b, E, nu = np.broadcast_arrays(*(np.asarray(v, float) for v in (inner, outer, modulus, poisson)))
    valid = np.isfinite(a * b * E * nu) & (b > THINNEST * a) & (a > 0) & (E > 0)
    wide = np.full((*valid.shape, HARMONICS + 1), np.nan)
    if valid.any():
        a, b, E, nu = a[valid], b[valid], E[valid], nu[valid]
        found = np.zeros((a.size, HARMONICS + 1))
        found[:, 0] = a * (1 + nu) / E * ((1 - 2 * nu) * a**2 + b**2) / ((b - a) * (b + a))
        found[:, 2:] = (
            _michell(np.maximum(a / b, _ENDLESS), nu, np.arange(2.0, HARMONICS + 1))
            * (a * (1 + nu) / E)[:, None]
        )
        wide[valid] = found
    return wide


def _michell(ratio: Array, nu: Array, n: Array) -> Array:
    """Return 2 mu u_r(a)/(a p) for every ring (R,) with ratio a/b and every n (N,), (R, N) [-].

    Powers that increase with r are scaled to the outer face, those that decrease to the inner face.
    """
    q, n = ratio[:, None], n[None, :]
    one = np.ones_like(q * n)
    grow, fall = (
        q ** (n - 2),
        q**n,
    )  # decay of increasing powers to the inner face and of decreasing ones to the outer face

    def stresses(power: Array, at: Array, r: Array) -> tuple[Array, Array]:
        """Return radial and shear stress of the term r**power, with magnitude `at` at the face, for a = 1."""
        return (power - n**2) * at / r**2, n * (power - 1) * at / r**2

    outside = 1 / q * one
    faces: list[list[Array]] = [[], [], [], []]
    values = ((n, grow * q**2, one), (n + 2, grow * q**2 * q**2, one), (-n, one, fall),
              (2 - n, one, fall / q**2))  # fmt: skip
    for power, inside, beyond in values:
        for row, (at, r) in zip((0, 2), ((inside, one), (beyond, outside)), strict=True):
            radial, shear = stresses(power, at, r)
            faces[row].append(radial * one)
            faces[row + 1].append(shear * one)
    matrix = np.stack([np.stack(row, axis=-1) for row in faces], axis=-2)
    right = np.zeros((*matrix.shape[:-1], 1))
    right[..., 0, 0] = -1
    factors = np.linalg.solve(matrix, right)[..., 0]
    kappa = (3 - 4 * nu)[:, None]
    moves = np.stack([-n * values[0][1], (kappa - n - 1) * values[1][1], n * one, (kappa + n - 1) * one], -1)
    return np.asarray((factors * moves).sum(axis=-1))
