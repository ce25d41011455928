"""Onset of whirl of a rigid rotor in journal films, from their eight linear coefficients.

References
----------
J. W. Lund, Trans. ASME J. Appl. Mech. 87, 1965, p. 911; J. S. Rao, Rotor Dynamics, 1996, section 7.5.
"""

import numpy as np

from templates.core.arrays import Array


def whirl_stiffness(K: Array, B: Array) -> Array:
    r"""Return the effective film stiffness of a journal that whirls at the threshold, in the unit of K.

    .. math:: k_0 = \frac{K_{xx}B_{yy} + K_{yy}B_{xx} - K_{xy}B_{yx} - K_{yx}B_{xy}}{B_{xx} + B_{yy}}

    Parameters
    ----------
    K
        (..., 2, 2) stiffness.
    B
        (..., 2, 2) damping.
    """
    mixed = K[..., 0, 0] * B[..., 1, 1] + K[..., 1, 1] * B[..., 0, 0]
    cross = K[..., 0, 1] * B[..., 1, 0] + K[..., 1, 0] * B[..., 0, 1]
    return np.asarray((mixed - cross) / (B[..., 0, 0] + B[..., 1, 1]))


def whirl_ratio_squared(K: Array, B: Array) -> Array:
    r"""Return the squared whirl frequency ratio at the threshold; 0 or less if every mass is stable [-].

    .. math:: \gamma^2 = \frac{(K_{xx}-k_0)(K_{yy}-k_0) - K_{xy}K_{yx}}{B_{xx}B_{yy} - B_{xy}B_{yx}}

    Parameters
    ----------
    K
        (..., 2, 2) stiffness k c/W.
    B
        (..., 2, 2) damping b c omega/W.
    """
    reduced = K - whirl_stiffness(K, B)[..., None, None] * np.eye(2)
    return np.asarray(np.linalg.det(reduced) / np.linalg.det(B))


def threshold_mass(K: Array, B: Array) -> Array:
    """Return the largest stable mass per film, M c omega²/W = k_0/gamma²; infinite if none whirls [-].

    Parameters
    ----------
    K
        (..., 2, 2) stiffness k c/W.
    B
        (..., 2, 2) damping b c omega/W.
    """
    ratio = whirl_ratio_squared(K, B)
    return np.where(ratio > 0, whirl_stiffness(K, B) / np.where(ratio > 0, ratio, 1.0), np.inf)
