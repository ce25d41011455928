"""Factorising a film's matrix only where it changed gives the same factors as factorising all of it."""

from dataclasses import replace

import numpy as np
import pytest

from templates.physics.films.banded_matrix import IncrementalSolver, banded
from templates.physics.films.film_mesh import journal_mesh, ring_mesh
from templates.physics.films.reynolds import journal_equations


@pytest.mark.parametrize("is_ring", [False, True])
@pytest.mark.parametrize(("n", "m"), [(32, 6), (96, 8), (12, 7)])
def test_property_resumed_solutions_are_those_from_the_start(n: int, m: int, is_ring: bool) -> None:
    """Films grow, shrink, have holes anywhere, become empty, and are whole again."""
    mesh = (ring_mesh if is_ring else journal_mesh)(0.7, 0.6, n, m)
    equations = replace(journal_equations(0.7, 0.6, mesh), ring=is_ring)
    matrix = banded(equations)
    resumed, rng = IncrementalSolver(matrix), np.random.default_rng(3)
    film = np.ones((n + 1, m + 1), bool)
    for step in range(40):
        place = matrix.order[rng.integers(matrix.order.size * (3 if step % 2 else 1) // 4, matrix.order.size)]
        film[place:, rng.integers(m) :] ^= True
        if step in (20, 30):
            film[:] = step == 30
        b = rng.normal(size=film.shape)
        whole, parts = matrix.solve(film, b), resumed.solve(film, b)
        np.testing.assert_allclose(parts, whole, rtol=1e-9, atol=1e-11 * np.abs(whole).max())
    assert not film.all()


def test_a_matrix_that_is_not_positive_definite_is_refused() -> None:
    mesh = journal_mesh(0.5, 1.0, 32, 6)
    matrix = banded(journal_equations(0.5, 1.0, mesh))
    turned = IncrementalSolver(replace(matrix, diagonals=-matrix.diagonals))
    with pytest.raises(ArithmeticError, match="positive definite"):
        turned.solve(np.ones(matrix.shape, bool), np.ones(matrix.shape))
