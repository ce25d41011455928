"""Linear stiffness and damping of the short bearing with a half film, in closed form.

References
----------
R. Holmes, J. Mech. Eng. Sci. 2, 1960, p. 337; E. Krämer, Dynamics of Rotors and Foundations, 1993,
section 3.4. In these sources y is along the load; here x is along the load, and y ahead of x in the sense
of rotation.
"""

import numpy as np

from templates.core.arrays import Array
from templates.physics.numerics.arrays import require, require_film


def coefficients_Holmes_1960(eps: Array) -> tuple[Array, Array]:
    r"""Return the stiffness K = k c/W and damping B = b c omega_h/W, (..., 2, 2) each [-].

    With :math:`A = 4/[\pi^2 + (16-\pi^2)\epsilon^2]^{3/2}` every entry is A times a polynomial in eps²
    over eps and :math:`\sqrt{1-\epsilon^2}`.

    Parameters
    ----------
    eps
        Relative eccentricity, above 0 to 1 − 1e-7 [-].

    Raises
    ------
    ValueError
        If eps lies outside its range.

    Examples
    --------
    >>> K, B = coefficients_Holmes_1960(0.5)
    >>> K.round(3).tolist(), B.round(3).tolist()
    ([[2.923, 3.977], [-0.858, 2.21]], [[6.615, 2.245], [2.245, 3.054]])
    """
    require_film(eps, np.ones(()))
    require(np.asarray(eps) > 0, "eps must be above 0: without load, coefficients over load do not exist")
    e2, p2 = np.asarray(eps, float) ** 2, np.pi**2
    s = np.sqrt((1 - eps) * (1 + eps))
    A = 4 / (p2 + (16 - p2) * e2) ** 1.5
    quartic = p2 + (32 + p2) * e2 + (32 - 2 * p2) * e2**2
    K_xx, K_yy = quartic / s**2, 2 * p2 + (16 - p2) * e2
    K_xy = np.pi / 4 * quartic / (eps * s)
    K_yx = -np.pi / 4 * (p2 - 2 * p2 * e2 - (16 - p2) * e2**2) / (eps * s)
    B_xx = np.pi / 2 * (p2 + (48 - 2 * p2) * e2 + p2 * e2**2) / (eps * s)
    B_yy = np.pi / 2 * s / eps * (p2 + (2 * p2 - 16) * e2)
    B_xy = 2 * p2 + (4 * p2 - 32) * e2
    return _matrix(A, K_xx, K_xy, K_yx, K_yy), _matrix(A, B_xx, B_xy, B_xy, B_yy)


def _matrix(A: Array, xx: Array, xy: Array, yx: Array, yy: Array) -> Array:
    return np.stack([np.stack([A * xx, A * xy], axis=-1), np.stack([A * yx, A * yy], axis=-1)], axis=-2)
