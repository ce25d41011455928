"""Newton's matrix on one pattern, and a start from a similar film: equal results with less work."""

import numpy as np
import pytest
from scipy.sparse import csc_array, diags_array, random_array

from templates.physics.cavities.cavitating_film import measured, solved_ring
from templates.physics.cavities.cavitating_network import Groove
from templates.physics.cavities.scaled_sum import ColumnScaledSum


@pytest.mark.parametrize("seed", range(5))
def test_a_sum_on_one_pattern_is_that_of_scipy(seed):
    rng = np.random.default_rng(seed)
    first, second = (csc_array(random_array((30, 30), density=0.1, rng=rng)) for _ in range(2))
    total = ColumnScaledSum.of(first, second)
    for _ in range(2):  # the second time on the values of the first
        a, b, d = rng.normal(size=(3, 30))
        wanted = (first @ diags_array(a) + second @ diags_array(b) + diags_array(d)).toarray()
        assert total.scaled(a, b, d).toarray() == pytest.approx(wanted, rel=1e-14, abs=1e-300)


def test_entries_at_one_place_add():
    twice = csc_array(([1.0, 2.0], ([0, 0], [1, 1])), shape=(2, 2))
    total = ColumnScaledSum.of(twice, csc_array((2, 2)))
    assert total.scaled(np.ones(2), np.ones(2), np.zeros(2)).toarray().tolist() == [[0, 3], [0, 0]]


@pytest.mark.parametrize("reach", [3, 60])
def test_some_unknowns_in_another_order_are_solved_for_as_densely(reach):
    """By bands where the values are near the diagonal (3), by a sparse LU where they are not (60)."""
    rng, count = np.random.default_rng(reach), 80
    bands = {"offsets": [-reach, 0, reach], "shape": (count, count)}
    first, second = (csc_array(diags_array(values, **bands)) for values in rng.uniform(1, 2, (2, 3, count)))
    unknowns = np.concatenate([np.arange(70, 80), np.arange(65)])
    some = ColumnScaledSum.of(first, second).among(unknowns)
    a, b, right = rng.uniform(0.5, 1, (3, unknowns.size))
    d = rng.uniform(8, 9, unknowns.size)
    dense = [matrix.toarray()[np.ix_(unknowns, unknowns)] for matrix in (first, second)]
    assert some.times(a, b) == pytest.approx(dense[0] @ a + dense[1] @ b, rel=1e-13)
    assert some.diagonals() == pytest.approx(np.array([matrix.diagonal() for matrix in dense]), rel=1e-14)
    wanted = np.linalg.solve(dense[0] * a + dense[1] * b + np.diag(d), right)
    assert some.factorised(a, b, d)(right) == pytest.approx(wanted, rel=1e-11)


@pytest.mark.parametrize("centre", [np.pi, -2.0, 0.3, 3.1])
def test_with_a_groove_anywhere_neighbours_are_near_each_other(centre):
    """Numbered from the groove on, no neighbour is farther than the bearing is wide."""
    solved = solved_ring(0.5, 0.8, [Groove(centre, 0.3)], 0.0, 32, 6)
    free = solved.network.free
    assert sorted(free) == np.flatnonzero(~solved.network.fixed).tolist()
    assert ColumnScaledSum.of(solved.network.A, solved.network.T).among(free).width == 6


def test_a_singular_sum_is_refused():
    nothing = csc_array((3, 3))
    with pytest.raises(RuntimeError, match="singular"):
        ColumnScaledSum.of(nothing, nothing).factorised(*np.ones((2, 3)), np.zeros(3))


@pytest.mark.parametrize(
    "grooves", [[Groove(np.pi, 0.0, P=0.1)], [Groove(2.0, 0.3, P=0.4), Groove(-1.9, 0.3, P=0.4)]]
)
def test_a_film_from_one_nearby_is_that_from_coarse_meshes(grooves):
    near = solved_ring(0.6, 0.5, grooves, 0.0, 64, 8)
    started, alone = (
        measured(solved_ring(0.65, 0.5, grooves, 0.0, 128, 16, start)) for start in (near, None)
    )
    for name in ("So", "attitude", "P_max", "friction", "side_flow", "supply_flow"):
        assert getattr(started, name) == pytest.approx(getattr(alone, name), rel=1e-9), name
