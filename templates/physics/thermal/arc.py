"""The mesh of a film from one edge of its groove around to the other, on half the width.

Angles are measured from the load in the sense of rotation. The groove is stationary, so the nodes do not move
during the search for the journal's position, and the force is continuous. The nodes are graded once towards
the thin film.
"""

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.physics.films.film_equations import dual_widths
from templates.physics.films.film_mesh import graded_across

_FINE = 8000
"""Number of points at which the density of nodes is integrated."""
_INLET, _LAYER = 0.5, 0.01
"""Weight and width [rad] of the finer mesh where fresh oil meets the warm walls."""


@dataclass(frozen=True)
class Arc:
    """Circumferential nodes × axial nodes on half the width; the first and last are the groove's edges."""

    phi: Array
    """(n + 1,) angles from the load, rising by less than a turn [rad]."""
    zeta: Array
    """(m + 1,) axial positions, 0 (middle) … 1 (end)."""
    ratio: float
    """Width over diameter B/D [-]."""

    @property
    def around(self) -> Array:
        """Return the (n + 1,) circumferential lengths of the cells, with half cells at the groove [rad]."""
        return dual_widths(self.phi)

    @property
    def across(self) -> Array:
        """Return the axial lengths of the cells; their sum is 1."""
        return dual_widths(self.zeta)


def groove_arc(start: float, length: float, thin: tuple[float, float], ratio: float, n: int, m: int) -> Arc:
    """Return the nodes from one edge of the groove around to the other.

    Parameters
    ----------
    start
        Angle of the groove's edge at which the film begins [rad].
    length
        Angle from there to the other edge [rad].
    thin
        Relative eccentricity [-], and angle of the narrowest gap [rad], to which nodes are graded.
    ratio
        Width over diameter B/D [-].
    n
        Number of circumferential intervals.
    m
        Number of intervals over half the width.
    """
    eps, attitude = thin
    fine = start + np.linspace(0, length, _FINE + 1)
    away = (fine - attitude + np.pi) % (2 * np.pi) - np.pi
    width = min(np.sqrt((1 - eps) / (1 + eps)), 3 * ratio)
    density = 1 + np.sqrt(1 - eps**2) / (1 - eps * np.cos(away)) + 1 / np.hypot(away, width)
    density += _INLET / np.hypot(fine - start, _LAYER)
    total = np.concatenate([[0.0], np.cumsum((density[1:] + density[:-1]) / 2)])
    phi = np.interp(np.linspace(0, total[-1], n + 1), total, fine)
    phi[[0, -1]] = start, start + length
    return Arc(phi, graded_across(float(np.sqrt(1 - eps)) / ratio, m)[0], ratio)
