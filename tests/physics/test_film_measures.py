"""Analytic: quantities derived from a solved film, its shear and rupture, by quadrature and at nodes."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import quad

from templates.physics.films.film_measures import _streamer_shear, rupture_angle
from templates.physics.films.reynolds import static_field


@pytest.mark.parametrize("eps", [0.2, 0.7, 0.95])
@pytest.mark.parametrize("end", [0.2, 0.9, 2.5])
def test_analytic_shear_of_a_film_and_of_its_streamers(eps, end):
    """Shear 1/H where the film is full, and of streamers of the width H_end/H beyond."""

    def gap(phi):
        return 1 - eps * np.cos(phi)

    full = quad(lambda phi: 1 / gap(phi), -np.pi, end)[0]
    streamers = quad(lambda phi: gap(end) / gap(phi) ** 2, end, np.pi)[0]
    field = SimpleNamespace(eps=eps, mesh=SimpleNamespace(weight_zeta=np.array([1.0, 3.0])))
    assert _streamer_shear(field, np.array([end, end])) == pytest.approx(full + streamers, rel=1e-7)


@pytest.mark.parametrize("eps", [0.3, 0.8])
def test_a_film_ruptures_within_a_step_of_its_last_pressure(eps):
    field = static_field(eps, 0.5, 96, 12)
    phi, P = field.mesh.phi, field.rupture.P
    for angle, pressure in zip(rupture_angle(field)[:-1], P[:, :-1].T, strict=True):
        last = np.flatnonzero(pressure > 0)[-1]
        assert phi[last] <= angle <= phi[last + 1]
        assert 0 < angle < np.pi  # beyond the narrowest gap, before the widest
