"""Linear stiffness and damping of a static journal film, by perturbing its discrete equations.

The film's extent is held: at a free rupture pressure and gradient vanish, so its motion is of second
order. Axes: x along the load, y ahead of x in the sense of rotation. K = k c W⁻¹ and
B = b c omega_h W⁻¹ with radial clearance c and load W; force on the journal = −k·x − b·dx/dt.

References:
    J. W. Lund and K. K. Thomsen, Topics in Fluid Film Bearing and Rotor Bearing System Design,
    ASME 1978, p. 1.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from templates.physics.arrays import Array, require, require_film
from templates.physics.complementarity import Rupture, rupture
from templates.physics.film_equations import dual_widths, midpoints, perturbed_equations, squeeze
from templates.physics.film_measures import force
from templates.physics.film_mesh import Mesh, gap, land_mesh
from templates.physics.reynolds import journal_equations, static_field


@dataclass(frozen=True)
class Coefficients:
    """Linear film forces about a static position."""

    So: float
    """Sommerfeld number F psi²/(B D eta omega_h) of the static film."""
    attitude: float
    """Angle from load to narrowest gap in the sense of rotation [rad]."""
    K: Array
    """(2, 2) stiffness k c/W."""
    B: Array
    """(2, 2) damping b c omega_h/W."""


def plain_coefficients(eps: float, ratio: float, around: int = 128, across: int = 16) -> Coefficients:
    """Stiffness and damping of the film of `reynolds.static_film`, its supply line fixed in space.

    Args:
        eps: relative eccentricity, above 0 to 1 − 1e-7 [-].
        ratio: width over diameter B/D [-].
        around: intervals around.
        across: intervals across half the width.

    Raises:
        ValueError: if an argument lies outside its range.
    """
    require(np.asarray(eps > 0), "eps must be above 0: without load, coefficients over load do not exist")
    field = static_field(eps, ratio, around, across)
    return _in_load_axes([linear_forces(eps, ratio, field.mesh, field.rupture)])


def grooved_coefficients(
    eps: float, ratio: float, grooves: list[tuple[float, float]], around: int = 128, across: int = 16
) -> Coefficients:
    """Stiffness and damping of a bearing with axial grooves at ambient pressure, its attitude found.

    Args:
        eps: relative eccentricity, above 0 to 0.99: the meshes of the lands are not graded [-].
        ratio: width over diameter B/D [-].
        grooves: (centre, width) of each, from the load in the sense of rotation, rising [rad].
        around: intervals around each land.
        across: intervals across half the width.

    Raises:
        ValueError: if an argument lies outside its range, or no attitude in (0, pi/2) balances the load.
    """
    require_film(np.asarray(eps), np.asarray(ratio))
    require(np.asarray((eps > 0) & (eps <= 0.99)), "eps must lie in (0, 0.99] for grooved bearings")
    lands = _lands(grooves)

    def films(attitude: float) -> list[tuple[Mesh, Rupture]]:
        meshes = [land_mesh(start - attitude, end - attitude, around, across) for start, end in lands]
        return [(mesh, rupture(journal_equations(eps, ratio, mesh))) for mesh in meshes]

    def across_load(attitude: float) -> float:
        along, ahead = np.sum([force(mesh, film.P) for mesh, film in films(attitude)], axis=0)
        return float(along * np.sin(attitude) + ahead * np.cos(attitude))

    attitude = brentq(across_load, 1e-3, np.pi / 2, xtol=1e-10)
    return _in_load_axes([linear_forces(eps, ratio, mesh, film) for mesh, film in films(attitude)])


def _lands(grooves: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Start and end of the lands between grooves of a given centre and width [rad]."""
    following = [*grooves[1:], (grooves[0][0] + 2 * np.pi, grooves[0][1])]
    lands = [(a + wa / 2, b - wb / 2) for (a, wa), (b, wb) in zip(grooves, following, strict=True)]
    require(np.asarray([end > start for start, end in lands]), "grooves must rise in angle and not overlap")
    return lands


def linear_forces(eps: float, ratio: float, mesh: Mesh, film: Rupture) -> Array:
    """So along and ahead of the line of centres, and their derivatives, (2, 5).

    Columns: the force itself, by displacement along and ahead, by velocity along and ahead.
    """
    middle = midpoints(mesh.phi)
    changes = [(-np.cos(mesh.phi), -np.cos(middle)), (-np.sin(mesh.phi), -np.sin(middle))]
    H, H_mid = gap(mesh.phi, eps), gap(middle, eps)
    stiff = [-perturbed_equations(mesh, ratio, H, H_mid, *change).residual(film.P) for change in changes]
    damp = [squeeze(mesh, change)[:, None] * dual_widths(mesh.zeta) for change, _ in changes]
    response = film.matrix.solve(film.film, np.stack(stiff + damp, axis=-1))
    fields = [film.P, *np.moveaxis(response, -1, 0)]
    return np.array([force(mesh, P) for P in fields]).T


def _in_load_axes(forces: list[Array]) -> Coefficients:
    """Add up the lands and turn from the line of centres to the load."""
    total = np.sum(forces, axis=0)
    along, ahead = total[:, 0]
    So = float(np.hypot(along, ahead))
    turn = np.array([[along, ahead], [-ahead, along]]) / So
    K, B = turn @ total[:, 1:3] @ turn.T / So, turn @ total[:, 3:5] @ turn.T / So
    return Coefficients(So, float(np.arctan2(-ahead, along)), K, B)
