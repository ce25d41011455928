"""How far apart the levels of a cycle's film are, at every point of an array on its own."""

from types import SimpleNamespace

import numpy as np
import pytest

from templates.physics.orbits import cyclic_film


@pytest.fixture
def orbits(monkeypatch):
    """Largest eccentricities by level, in place of orbits that take long."""
    eps_max = {"mobility_short": np.array([0.8, 0.9, 0.5]), "mobility": np.array([0.75, 0.9, 0.4])}
    monkeypatch.setattr(
        cyclic_film, "cycle_orbit", lambda level, duty: SimpleNamespace(eps_max=eps_max[level])
    )


def test_analytic_largest_over_smallest_film_of_each_point(orbits):
    spread = cyclic_film.level_spread("transient", None, np.array([0.9, 0.8, 0.4]))
    assert spread == pytest.approx([0.25 / 0.1 - 1, 0.2 / 0.1 - 1, 0.6 / 0.5 - 1], rel=1e-12)


def test_analytic_a_level_is_not_compared_with_itself(orbits):
    spread = cyclic_film.level_spread("mobility", None, np.array([0.9, 0.9, 0.9]))
    assert spread == pytest.approx([0.2 / 0.1 - 1, 0, 0.5 / 0.1 - 1], rel=1e-12)


def test_property_a_level_without_a_film_has_no_spread(orbits):
    spread = cyclic_film.level_spread("transient", None, np.array([1.0, 0.8, np.nan]))
    assert np.isnan(spread).tolist() == [True, False, True]
