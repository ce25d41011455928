"""Level `elastic` of `elastic_film` 1 agrees with finite elements in the film."""

import numpy as np
import pytest

from templates.physics.elastic.bore_film import BoreSoftness, bore_balances
from templates.physics.elastic.bore_modes import BENDING, modes_along, modes_around
from templates.physics.elastic.elastic_journal import measured
from tests.recorded_bore import recorded_bore
from tests.references.elastic_bore import Bore, begun, second

SO, RATIO, TO_LOAD = 3.0, 0.5, 0.6


@pytest.fixture(scope="module")
def softness():
    """A housing, a liner, harmonics above those of the modes, and oil that thickens."""
    matrix = np.array(recorded_bore())
    tail = np.where(np.arange(41) > 9, 0.05 / np.maximum(np.arange(41), 1), 0.0)
    return BoreSoftness(2e-3, tail, 5.0, 0.01, 0.3, matrix=0.1 / matrix[3, 3] * matrix, share=0.8)


@pytest.mark.slow
def test_second_method_finite_elements_find_the_same_film(softness):
    pairs = bore_balances(SO, RATIO, 0.75, softness, TO_LOAD)
    coarse, fine = (measured(soft.film) for _, soft in pairs)
    found, unsure, _ = second(SO, begun(SO, RATIO, softness, TO_LOAD))
    assert unsure < 2e-3
    for name, value in found.items():
        extrapolated = fine[name] + (fine[name] - coarse[name]) / 3
        assert value == pytest.approx(extrapolated, rel=6e-4), name
    stiff = measured(pairs[-1][0].film)
    assert abs(found["P_max"] / stiff["P_max"] - 1) > 0.1


def test_analytic_modes_of_the_second_method_are_those_of_the_level():
    theta, zeta = np.linspace(0, 6, 50), np.linspace(0, 1, 50)
    bore = Bore(np.eye(38), 9, 2, np.zeros(41), 0.0, 0.8, 0.0)
    around, along = modes_around(theta), modes_along(0.8 * zeta)
    modes = np.concatenate([around * along[:, [k]] for k in range(2)], axis=1)
    np.testing.assert_allclose(bore.shapes(theta, zeta), modes, atol=1e-12)
    assert (bore.bending() == BENDING).all()
