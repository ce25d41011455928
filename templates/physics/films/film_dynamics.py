"""Linear stiffness and damping of a static journal film, by perturbing its discrete equations.

The extent of the film is held constant: at a free rupture, pressure and gradient vanish, so its motion has a
second-order effect. Axes: x along the load, y ahead of x in the sense of rotation. K = k c W⁻¹ and B = b c
omega_h W⁻¹ with radial clearance c and load W; force on the journal = −k·x − b·dx/dt.

References
----------
J. W. Lund and K. K. Thomsen, Topics in Fluid Film Bearing and Rotor Bearing System Design,
ASME 1978, p. 1.
"""

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.physics.films.complementarity import Rupture
from templates.physics.films.film_equations import dual_widths, midpoints, perturbed_equations, squeeze
from templates.physics.films.film_measures import force
from templates.physics.films.film_mesh import Mesh, gap
from templates.physics.films.reynolds import static_field
from templates.physics.numerics.arrays import require


@dataclass(frozen=True)
class Coefficients:
    """Linear film forces about a static equilibrium position."""

    So: float
    """Sommerfeld number F psi²/(B D eta omega_h) of the static film."""
    attitude: float
    """Angle from load to narrowest gap in the sense of rotation [rad]."""
    K: Array
    """(2, 2) stiffness k c/W."""
    B: Array
    """(2, 2) damping b c omega_h/W."""


def plain_coefficients(eps: float, ratio: float, around: int = 128, across: int = 16) -> Coefficients:
    """Return the stiffness and damping of the film of `reynolds.static_film`; its supply line stays in place.

    Parameters
    ----------
    eps
        Relative eccentricity, above 0 to 1 − 1e-7 [-].
    ratio
        Width over diameter B/D [-].
    around
        Number of circumferential intervals.
    across
        Number of intervals over half the width.

    Raises
    ------
    ValueError
        If an argument lies outside its range.
    """
    require(np.asarray(eps > 0), "eps must be above 0: without load, coefficients over load do not exist")
    field = static_field(eps, ratio, around, across)
    return in_load_axes([linear_forces(eps, ratio, field.mesh, field.rupture)])


def linear_forces(eps: float, ratio: float, mesh: Mesh, film: Rupture) -> Array:
    """Return So along and ahead of the line of centres, and their derivatives, (2, 5) [-].

    The columns are the force itself, its derivatives by displacement along and ahead, and by velocity along
    and ahead.
    """
    middle = midpoints(mesh.phi)
    changes = [(-np.cos(mesh.phi), -np.cos(middle)), (-np.sin(mesh.phi), -np.sin(middle))]
    H, H_mid = gap(mesh.phi, eps), gap(middle, eps)
    stiff = [-perturbed_equations(mesh, ratio, H, H_mid, *change).residual(film.P) for change in changes]
    damp = [squeeze(mesh, change)[:, None] * dual_widths(mesh.zeta) for change, _ in changes]
    response = film.matrix.solve(film.film, np.stack(stiff + damp, axis=-1))
    fields = [film.P, *np.moveaxis(response, -1, 0)]
    return np.array([force(mesh, P) for P in fields]).T


def in_load_axes(forces: list[Array]) -> Coefficients:
    """Return the coefficients of the sum of all lands, rotated from the line of centres to the load."""
    total = np.sum(forces, axis=0)
    along, ahead = total[:, 0]
    So = float(np.hypot(along, ahead))
    turn = np.array([[along, ahead], [-ahead, along]]) / So
    K, B = turn @ total[:, 1:3] @ turn.T / So, turn @ total[:, 3:5] @ turn.T / So
    return Coefficients(So, float(np.arctan2(-ahead, along)), K, B)
