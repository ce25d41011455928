"""A second method for axially grooved bearings: each land separately, with rupture after Swift and Stieber.

The independent check of `templates.physics.cavities.fed_film`, which solves the whole circle with cavities
that
re-form: where grooves stand at ambient pressure nearly nothing re-forms outside them, and both agree.
"""

import numpy as np
from scipy.optimize import brentq

from templates.physics.films.complementarity import Rupture, rupture
from templates.physics.films.film_dynamics import Coefficients, in_load_axes, linear_forces
from templates.physics.films.film_measures import force
from templates.physics.films.film_mesh import Mesh, gregory
from templates.physics.films.reynolds import journal_equations
from templates.physics.numerics.arrays import require, require_film


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
    return in_load_axes([linear_forces(eps, ratio, mesh, film) for mesh, film in films(attitude)])


def _lands(grooves: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Start and end of the lands between grooves of a given centre and width [rad]."""
    following = [*grooves[1:], (grooves[0][0] + 2 * np.pi, grooves[0][1])]
    lands = [(a + wa / 2, b - wb / 2) for (a, wa), (b, wb) in zip(grooves, following, strict=True)]
    require(np.asarray([end > start for start, end in lands]), "grooves must rise in angle and not overlap")
    return lands


def land_mesh(start: float, end: float, n: int, m: int) -> Mesh:
    """Uniform mesh of a land between two axial grooves."""
    axial = np.linspace(0, 1, m + 1), 2 * gregory(m) / m
    around = np.linspace(start, end, n + 1), gregory(n) * (end - start) / n
    return Mesh(around[0], axial[0], around[1], axial[1])
