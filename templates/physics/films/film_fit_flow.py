"""Side flow of a journal bearing by the formula of ISO 7902-2 / DIN 31652-2.

References
----------
DIN 31652-2:1983; ISO 7902-2:1998, clause 5.
"""

from templates.core.arrays import Array


def side_flow_ISO_7902(eps: Array, ratio: Array) -> Array:
    r"""Return the oil flow out of both ends due to the film's own pressure, Q/(R³ psi omega_h) [-].

    .. math:: \frac{Q_3}{D^3\psi\omega_h} = \frac{1}{4}\left(b - 0.223\,b^3\right)\epsilon

    Parameters
    ----------
    eps
        Relative eccentricity [-].
    ratio
        Width over diameter b = B/D, 1/8 … 1 [-].

    Examples
    --------
    >>> round(side_flow_ISO_7902(0.5, 0.5), 4)
    0.4721
    """
    return 2 * (ratio - 0.223 * ratio**3) * eps
