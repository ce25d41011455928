"""Analytic: `encode` of a new solution gives the values that the maps store.

The maps are read without it, so only this holds the functions to the data that was made with them.
"""

import numpy as np
import pytest

from templates.physics.films.film_dynamics import linear_forces
from templates.physics.films.film_map import encode, encode_linear, film_map
from templates.physics.films.film_measures import measure
from templates.physics.films.reynolds import static_field
from templates.physics.numerics.uniform_spline import surface
from templates.physics.numerics.volume_spline import volume
from templates.physics.orbits import mobility_map
from templates.physics.orbits.film_mobility import Motion, film_mobility


@pytest.mark.parametrize(("eps", "ratio"), [(0.3, 0.4), (0.8, 1.2)])
def test_a_static_film_encodes_to_what_the_film_map_keeps(eps, ratio):
    field, data = static_field(eps, ratio, 256, 32), film_map()
    x, y = np.array([np.arctanh(eps)]), np.array([np.log(ratio)])
    kept = surface(data.static, data.eccentricity, data.width, x, y)[:, 0]
    values = encode(eps, ratio, measure(field))
    assert values[:7] == pytest.approx(kept[:7], rel=5e-3, abs=2e-3)
    assert values[7] == pytest.approx(kept[7], abs=np.pi / 256)  # the film ruptures at a node
    forces = linear_forces(eps, ratio, field.mesh, field.rupture)
    kept = surface(data.linear, data.eccentricity, data.width, x, y)[:, 0]
    assert encode_linear(eps, forces) == pytest.approx(kept, rel=1e-2, abs=1e-2)
    assert np.ptp(kept) > 0.5  # eight different values


@pytest.mark.parametrize(("xi", "eta", "ratio"), [(0.5, 0.3, 0.5), (-0.2, 0.4, 1.5)])
def test_a_moving_film_encodes_to_what_the_mobility_map_keeps(xi, eta, ratio):
    eps, chi = float(np.hypot(xi, eta)), float(np.arctan2(-eta, xi))
    motion = film_mobility(eps, ratio, chi, 192, 24)
    turn = np.array([[np.cos(chi), np.sin(chi)], [-np.sin(chi), np.cos(chi)]])
    along = Motion(turn @ motion.velocity, motion.P_max, motion.side_flow, motion.film)
    data = mobility_map.mobility_map()
    places = np.array([*mobility_map.coordinates(np.array(xi), np.array(eta)), np.log(ratio)])[:, None]
    kept = np.concatenate(
        [volume(getattr(data, part), data.axes, places)[:, 0] for part in ("motion", "film")]
    )
    assert mobility_map.encode(xi, eta, ratio, along) == pytest.approx(kept, rel=1e-2, abs=1e-2)
