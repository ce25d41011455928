"""Displacement of a bore under an oil film, as a compliance matrix between pressure modes.

A mode is a distribution of pressure or of radial displacement over the whole bore: 1, cos n theta or sin n
theta up to n = 9, uniform along the bore or times Legendre's second polynomial, each with a mean square of 1.
C_ij is the displacement in mode i under a unit pressure in mode j. theta is measured from the block of a
housing, or from the shank of a rod.

C is symmetric (Betti's theorem). No pressure does negative work, so C has no negative eigenvalue. Rows c1 and
s1 are a rigid-body motion of the bore, which the film sees as eccentricity, so these rows are ignored. Their
columns are used, because a pressure in c1 or s1 also bends the bore.

Above n = 9 the bore deforms like a half-plane, 2 (1 − nu²) R/(E n), without coupling of modes.

References
----------
K. P. Oh, P. K. Goenka: Journal of Tribology 107, 1985, p. 389, for modes of an elastic bearing.
K. L. Johnson: Contact Mechanics, 1985, section 13.2, for the half-plane under a wave of pressure.
"""

from __future__ import annotations

import numpy as np

from templates.core.arrays import Array, Truth
from templates.core.language.declare import units
from templates.physics.elastic.compliance import HARMONICS

HIGHEST = 9
"""The highest harmonic of the modes."""
_AROUND = ("m", *(f"{part}{n}" for n in range(1, HIGHEST + 1) for part in "cs"))
MODES = (*_AROUND, *(f"{name}z" for name in _AROUND))
"""Names of the modes: mean, cosines and sines; `z` marks Legendre's polynomial along the bore."""
BENDING = np.array([name not in ("c1", "s1") for name in MODES])
"""The modes that are not a rigid-body motion of the bore."""
_EQUAL = 1e-6
"""Difference of C_ij and C_ji, over the root of C_ii C_jj, up to which the matrix is symmetric [-]."""

Rows = tuple[tuple[float, ...], ...]


def modes_around(theta: Array) -> Array:
    """Return the circumferential factors (..., 19) of the modes at angles (...) from block or shank [rad]."""
    n = np.arange(1, HIGHEST + 1)
    angle = np.asarray(theta)[..., None] * n
    waves = np.sqrt(2) * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    flat = waves.reshape(*angle.shape[:-1], 2 * HIGHEST)
    return np.concatenate([np.ones((*angle.shape[:-1], 1)), flat], axis=-1)


def modes_along(zeta: Array) -> Array:
    """Return the axial factors (..., 2) of the modes [-] at places (...) from the middle 0 to the end 1."""
    zeta = np.asarray(zeta, float)
    return np.stack([np.ones_like(zeta), np.sqrt(5) * (3 * zeta**2 - 1) / 2], axis=-1)


def half_plane(radius: Array, modulus: Array, poisson: Array) -> Array:
    """Return the displacement of a half-plane under 1 Pa cos(n theta), n = 10 … `HARMONICS` [m/Pa].

    The result is 0 for smaller n.

    Parameters
    ----------
    radius
        Radius (...) of the bore, over which the wavelength is 2 pi R/n [m].
    modulus, poisson
        Young's modulus (...) [Pa] and Poisson's ratio (...) [-] of the body.
    """
    n = np.arange(HARMONICS + 1)
    per_n = np.where(n > HIGHEST, 1 / np.maximum(n, 1), 0.0)
    return np.asarray(2 * (1 - poisson**2) * radius / modulus)[..., None] * per_n


@units(None, returns="1")
def is_square(rows: Rows) -> Truth:
    """Return whether a matrix has a row for each mode, or no rows."""
    return len(rows) in (0, len(MODES))


@units(None, returns="1")
def is_mutual(rows: Rows) -> Truth:
    """Return whether a matrix is symmetric; true if it is not square, because another rule reports that."""
    if len(rows) != len(MODES):
        return True
    C = np.array(rows)
    size = np.sqrt(np.abs(np.diag(C)))
    allowed = _EQUAL * np.outer(size, size) + 1e-12 * np.abs(C).max()
    return bool((np.abs(C - C.T) <= allowed).all())


@units(None, returns="1")
def gains_no_energy(rows: Rows) -> Truth:
    """Return whether every pressure does zero or positive work on the bore.

    Another rule checks that the matrix is square.
    """
    if len(rows) != len(MODES):
        return True
    C = np.array(rows)
    own = np.diag(C)
    if (own < 0).any() or np.any(C[own == 0]):
        return False
    size = np.sqrt(np.where(own > 0, own, 1.0))
    scaled = (C + C.T) / 2 / np.outer(size, size)
    return bool(np.linalg.eigvalsh(scaled).min() >= -_EQUAL)


@units(None, returns="1")
def count_modes(rows: Rows) -> Array:
    """Return the number of rows of a matrix."""
    return np.asarray(float(len(rows)))[()]


def matrix_of(rows: Rows) -> Array:
    """Return the rows as a matrix [m/Pa]; zeros if there are none."""
    return np.array(rows) if len(rows) == len(MODES) else np.zeros((len(MODES), len(MODES)))
