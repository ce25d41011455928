"""Pressure and side flow of the short bearing under a moving load, by Booker's fit.

Only axial flow, P = 0 at the ends and wherever the gap grows (half film). A load moves the journal's centre
with d(eps)/dt = M F psi²/(B D eta). In a frame with xi along the load and eta ahead of it, the fit of 1971 is
M = (1−xi)^(5/2)/(pi b²) along the load and −4 eta (1−xi)^(3/2)/(pi b)² ahead of it, b = B/D. Its error
relative to M, in the worst direction, compared with the exact half film
(`tests/references/short_mobility.py`), is 1.0 % up to eps 0.2, 2.6 % to 0.5, 5.7 % to 0.8, 7.5 % to 0.9, 10.4
% to 0.99, and 11.6 % beyond.

References
----------
J. F. Booker, Trans. ASME J. Basic Eng. 87, 1965, p. 537; J. Lubr. Technol. 93, 1971, p. 168.
"""

import numpy as np

from templates.core.arrays import Array

_BLOCK = 4096
"""Most points that are solved together."""


def short_film_under_load(xi: Array, eta: Array, ratio: Array) -> Array:
    r"""Return the results of the half film under a load, with the journal velocity of Booker 1971 [-].

    .. math:: p_{max} = \tfrac32\frac{\eta B^2 v}{h^3}\cos(\varphi-\alpha) \text{ at its largest},\quad
        \sin(\varphi-\alpha)+\epsilon\sin(2\varphi-\alpha)+2\epsilon\sin\alpha = 0

    Parameters
    ----------
    xi
        Relative eccentricity along the load on the journal [-].
    eta
        The same ahead of the load [-].
    ratio
        Width over diameter B/D [-].

    Returns
    -------
    (2, ...) as in `mobility_map.mapped_film_under_load`: largest pressure p_max B D/F, and side flow
    Q/(B D v), which is 1, because all the displaced oil leaves at the sides.
    """
    xi, eta, ratio = np.broadcast_arrays(*(np.asarray(x, float) for x in (xi, eta, ratio)))
    eps = np.hypot(xi, eta)
    along, ahead = (1 - xi) ** 2.5 / (np.pi * ratio**2), -4 * eta * (1 - xi) ** 1.5 / (np.pi * ratio) ** 2
    direction = np.arctan2(ahead, along) - np.arctan2(eta, xi)
    turn = np.abs((direction + np.pi) % (2 * np.pi) - np.pi)
    rise = np.empty(eps.shape)
    for start in range(0, eps.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        rise.reshape(-1)[part] = _steepest(eps.ravel()[part], turn.ravel()[part])
    return np.stack([6 * ratio**2 * np.hypot(along, ahead) * rise, np.ones_like(rise)])


def _steepest(eps: Array, direction: Array) -> Array:
    """Return the largest cos(phi − alpha)/H³ over the half film.

    Newton's method starts from the best of a set of sampled angles.
    """
    start, end = _sommerfeld_angle(direction - np.pi / 2, eps), _sommerfeld_angle(direction + np.pi / 2, eps)
    gamma = start + np.linspace(0, 1, 49)[:, None] * (end - start)
    phi = 2 * np.arctan2(np.sin(gamma / 2) * np.sqrt(1 - eps), np.cos(gamma / 2) * np.sqrt(1 + eps))

    def height(at: Array) -> Array:
        return np.asarray(np.cos(at - direction) / ((1 - eps) + 2 * eps * np.sin(at / 2) ** 2) ** 3)

    best = np.take_along_axis(phi, height(phi).argmax(axis=0)[None], axis=0)[0]
    top = best
    for _ in range(4):
        slope = np.cos(top - direction) + 2 * eps * np.cos(2 * top - direction)
        left = np.sin(top - direction) + eps * np.sin(2 * top - direction) + 2 * eps * np.sin(direction)
        top = top - left / np.where(slope == 0, 1.0, slope)
    return np.fmax(height(best), np.where(np.cos(top - direction) >= 0, height(top), 0.0))


def _sommerfeld_angle(phi: Array, eps: Array) -> Array:
    """Return Sommerfeld's angle from the narrowest gap, continuous for phi from −2 pi to 2 pi [rad]."""
    return np.asarray(2 * np.arctan2(np.sin(phi / 2) * np.sqrt(1 + eps), np.cos(phi / 2) * np.sqrt(1 - eps)))
