r"""Integrals across a film whose viscosity varies from the sleeve to the journal (Dowson 1962).

With :math:`Y = y/h` from the sleeve (0) to the journal (1), and fluidity :math:`f = \eta_s/\eta`:

.. math::
    F_0 = \int f\,dY,\quad F_1 = \int Y f\,dY,\quad
    F_2 = \int Y\left(Y - F_1/F_0\right) f\,dY

The flow is :math:`-F_2 h^3/\eta_s\,\nabla p + U h (1 - F_1/F_0)`. Fluidity is constant in each strip, so
every integral is exact, and the flows of the strips add up to that of the film.

References
----------
D. Dowson: A generalized Reynolds equation for fluid-film lubrication, Int. J. Mech. Sci. 4, 1962, p. 159.
"""

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array


@dataclass(frozen=True)
class Across:
    """The integrals at N circumferential places; the last axis is that of J strips, from the sleeve."""

    conductance: Array
    """(N,) F_2; 1/12 at uniform viscosity [-]."""
    carried: Array
    """(N,) fraction of U h that the journal drags along, 1 − F_1/F_0; 1/2 at uniform viscosity [-]."""
    shear: Array
    """(N,) 1/F_0, the shear stress of a film without a pressure gradient in eta_s U/h [-]."""
    by_pressure: Array
    """(N, J) flow of each strip per unit of pressure gradient; their sum is −F_2 [-]."""
    by_drag: Array
    """(N, J) flow of each strip by drag; their sum is `carried` [-]."""
    heat_of_pressure: Array
    """(N, J) ∫ f (Y − F_1/F_0)² dY, dissipation by the square of the pressure gradient [-]."""
    heat_of_both: Array
    """(N, J) 2 ∫ f (Y − F_1/F_0) dY/F_0, dissipation by gradient times drag; their sum is 0 [-]."""
    heat_of_drag: Array
    """(N, J) ∫ f dY/F_0², dissipation by drag; their sum is 1/F_0 [-]."""


def strip_edges(count: int) -> Array:
    """Return the edges of the strips across, (J + 1,), 0 … 1 [-], finer towards the walls."""
    even = np.linspace(0, 1, count + 1)
    return (even + (1 - np.cos(np.pi * even)) / 2) / 2


def across(fluidity: Array, edges: Array) -> Across:
    """Return the integrals across the film.

    Parameters
    ----------
    fluidity
        (N, J) eta_s over the viscosity of each strip [-].
    edges
        (J + 1,) edges of the strips across [-].
    """
    Y, step = edges[:-1], np.diff(edges)
    first, second, third = (np.diff(edges**k) / k for k in (1, 2, 3))
    parts_0, parts_1 = fluidity * first, fluidity * second
    F_0, F_1 = parts_0.sum(axis=1), parts_1.sum(axis=1)
    centre = (F_1 / F_0)[:, None]
    below_0, below_1 = (np.cumsum(parts, axis=1) - parts for parts in (parts_0, parts_1))
    speed_0 = below_0 * step + fluidity * step**2 / 2
    speed_1 = below_1 * step + fluidity * (third / 2 - Y**2 * step / 2)
    moved = parts_1 - centre * parts_0
    squared = fluidity * third - 2 * centre * parts_1 + centre**2 * parts_0
    drag = 1 / F_0[:, None]
    return Across(
        conductance=squared.sum(axis=1),
        carried=1 - centre[:, 0],
        shear=drag[:, 0],
        by_pressure=speed_1 - centre * speed_0,
        by_drag=speed_0 * drag,
        heat_of_pressure=squared,
        heat_of_both=2 * moved * drag,
        heat_of_drag=parts_0 * drag**2,
    )
