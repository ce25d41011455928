r"""Swift–Stieber film rupture as a complementarity problem, solved by an active-set method.

.. math:: P \ge 0, \quad A P - b \ge 0, \quad P\,(A P - b) = 0

At each step the nodes of the film solve A P = b by banded Cholesky factorisation, and the others have P = 0;
then nodes with P < 0 leave the film and nodes that gain oil join it. A is an M-matrix, so the pressure rises
from step to step, and the set is final after finitely many steps. A coarser mesh gives the initial set.

References
----------
M. Hintermüller, K. Ito, K. Kunisch, SIAM J. Optim. 13, 2003, p. 865.
"""

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array, Mask
from templates.physics.films.banded_matrix import BandedMatrix, IncrementalSolver, banded
from templates.physics.films.film_equations import Equations

_MOST_STEPS = 1000


@dataclass(frozen=True)
class Rupture:
    """A solved complementarity problem."""

    P: Array
    """(n + 1, m + 1) pressure, 0 outside the film."""
    film: Mask
    """(n + 1, m + 1) nodes inside the film."""
    matrix: BandedMatrix
    """The matrix, for further right-hand sides on the same film."""
    steps: int
    """Linear solutions used."""


def rupture(equations: Equations, film: Mask | None = None) -> Rupture:
    """Return the pressure and the extent of the film.

    Parameters
    ----------
    equations
        The flow balances.
    film
        Initial mask of the nodes inside the film; by default those to which motion brings oil.

    Raises
    ------
    ArithmeticError
        If the active set still changes after 1000 steps, which no film should need.
    """
    matrix = banded(equations)
    may = np.zeros(matrix.shape, bool)
    may[matrix.order, :-1] = True
    b = equations.brought
    if equations.ring:
        b = b.copy()
        b[0] += b[-1]
    film = (may & (b > 0)) if film is None else may & film
    noise = 1e-13 * np.abs(b).max()
    solver = IncrementalSolver(matrix)
    for step in range(1, _MOST_STEPS):
        P = solver.solve(film, b)
        if equations.ring:
            P[-1] = P[0]
        after = may & np.where(film, P > 0, equations.residual(P) < -noise)
        if np.array_equal(after, film):
            return Rupture(P, film, matrix, step)
        film = after
    raise ArithmeticError("the film's extent did not converge")


def finer(film: Mask) -> Mask:
    """Return the mask of a film on a mesh with twice as many intervals in each direction."""
    n, m = film.shape
    fine = np.zeros((2 * n - 1, 2 * m - 1), bool)
    fine[::2, ::2] = film
    fine[1::2] = fine[:-1:2] | fine[2::2]
    fine[:, 1::2] = fine[:, :-1:2] | fine[:, 2::2]
    return fine
