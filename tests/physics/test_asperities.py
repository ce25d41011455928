"""Contact of rough faces and flow factors agree with quadrature, the papers' tables and limits.

No public copy of Greenwood and Tripp's own table of F_{5/2} was at hand: the reference is quadrature. The
tables of Patir and Cheng were read in the source of foam-extend 4.0, flowFactorsPatirCheng.C.
"""

import numpy as np
import pytest
from scipy.integrate import dblquad, quad

from templates.physics.films.film_map import mapped_film
from templates.physics.roughness.asperities import (
    FARTHEST,
    contact_integrals,
    contact_scale,
    splined_summit_integral,
    summit_integral,
)
from templates.physics.roughness.flow_factors import (
    PRESSURE,
    SHEAR,
    mean_gap,
    pressure_flow_factor,
    rough_journal,
    shear_flow_factor,
)


def summit_fit(u):
    """The fit 4.4086e-5 (4 − u)^6.804 to F_{5/2}, 0 from u = 4 on, which is common in the literature."""
    return 4.4086e-5 * np.maximum(4 - np.asarray(u), 0) ** 6.804


def exact(u, power=2.5):
    def summits(s):
        return (s - u) ** power * np.exp(-s * s / 2) / np.sqrt(2 * np.pi)

    return quad(summits, u, u + 12, epsabs=0, epsrel=1e-12)[0]


class TestContact:
    @pytest.mark.parametrize("u", [0, 0.5, 1, 1.5, 2, 2.5, 3, 4, 6, 9])
    def test_analytic_summit_integral_is_that_of_quadrature(self, u):
        assert summit_integral(np.asarray(float(u))) == pytest.approx(exact(u), rel=2e-9)
        assert splined_summit_integral(np.asarray(float(u))) == pytest.approx(exact(u), rel=2e-9)

    def test_analytic_spline_between_its_knots(self):
        u = np.linspace(0, FARTHEST, 3333)[:-1]
        np.testing.assert_allclose(splined_summit_integral(u), summit_integral(u), rtol=1e-8)

    def test_literature_common_fit(self):
        """4.4086e-5 (4 − u)^6.804 is low by 3 to 11 % up to 2, and by 74 % at 3."""
        u = np.array([0, 0.5, 1, 2, 3])
        low = 1 - summit_fit(u) / summit_integral(u)
        np.testing.assert_allclose(low, [0.107, 0.077, 0.035, 0.092, 0.742], atol=1e-3)

    def test_analytic_scale_from_single_summits(self):
        """Pairs of summits, Hertz force 4/3 E' √(β/2) w^1.5, w = s − u − r²/(4β) at an offset r."""
        sigma, beta, eta, modulus, u = 1e-6, 1e-4, 5e8, 1e11, 1.0

        def force(r, s):
            w = (s - u) * sigma - r * r / (4 * beta)
            hertz = 4 / 3 * modulus * np.sqrt(beta / 2) * max(w, 0) ** 1.5
            return hertz * 2 * np.pi * r * np.exp(-s * s / 2) / np.sqrt(2 * np.pi)

        pressure = eta**2 * dblquad(
            force, u, u + 8, 0, lambda s: np.sqrt(4 * beta * max(s - u, 0) * sigma), epsrel=1e-7
        )[0]  # fmt: skip
        scale = contact_scale(sigma * beta * eta, sigma / beta, modulus)
        assert scale * summit_integral(np.asarray(u)) == pytest.approx(pressure, rel=1e-5)

    @pytest.mark.parametrize(("eps", "roughness"), [(0.5, 0.3), (0.95, 0.02), (0.999, 0.001), (1, 1e-4)])
    def test_analytic_sums_around_a_journal(self, eps, roughness):
        def pressure(phi, n):
            u = (1 - eps * np.cos(phi)) / roughness
            return float(splined_summit_integral(np.asarray(u)) * np.cos(phi) ** n)

        reach = np.arccos(max((1 - FARTHEST * roughness) / eps, -1))
        expected = [2 * quad(pressure, 0, reach, args=(n,), epsrel=1e-10, limit=200)[0] for n in (1, 0)]
        np.testing.assert_allclose(contact_integrals(np.asarray(eps), roughness), expected, rtol=1e-5)

    def test_limit_smooth_faces_do_not_touch(self):
        eps = np.array([0, 0.5, 1 - 1e-7])
        assert (np.asarray(contact_integrals(eps, 0.0)) == 0).all()
        assert contact_integrals(np.asarray(0.0), 0.5)[0] == pytest.approx(0, abs=1e-12)


class TestFlowFactors:
    @pytest.mark.parametrize("gamma", SHEAR)
    def test_literature_branches_of_the_shear_factor_meet(self, gamma):
        """Patir and Cheng 1979, table 1: at h/sigma = 5 one row's two formulas agree to its digits."""
        near, far = shear_flow_factor(np.array([5, 5 + 1e-9]), gamma)
        assert near == pytest.approx(far, rel=1e-3)

    @pytest.mark.parametrize("gamma", PRESSURE)
    def test_literature_pressure_factor(self, gamma):
        """Patir and Cheng 1978, table 1: to 1 for thick films, below for gamma up to 1, above beyond."""
        factor = pressure_flow_factor(np.linspace(1, 40, 400), gamma)
        assert (np.diff(np.abs(factor - 1)) < 0).all()
        assert ((factor < 1) == (gamma <= 1)).all()
        assert factor[-1] == pytest.approx(1, abs=5e-3)

    def test_literature_isotropic_factors(self):
        assert pressure_flow_factor(np.asarray(3.0)) == pytest.approx(1 - 0.9 * np.exp(-0.56 * 3))
        assert shear_flow_factor(np.asarray(2.0)) == pytest.approx(1.899 * 2**0.98 * np.exp(-1.84 + 0.2))
        assert shear_flow_factor(np.asarray(8.0)) == pytest.approx(1.126 * np.exp(-2))

    @pytest.mark.parametrize("u", [0, 1, 3])
    def test_analytic_mean_gap(self, u):
        assert mean_gap(np.asarray(float(u))) == pytest.approx(exact(-u, 1), rel=1e-9)

    @pytest.mark.parametrize("eps", [0.3, 0.8, 0.99])
    def test_limit_smooth_faces_make_the_film_of_the_map(self, eps):
        load, attitude = rough_journal(eps, 0.5, 0.0, 0.0, 128, 16)
        smooth = mapped_film(np.asarray(eps), np.asarray(0.5))
        assert load == pytest.approx(smooth["So"], rel=5e-4)
        assert attitude == pytest.approx(smooth["attitude"], abs=1e-3)
        fine, _ = rough_journal(eps, 0.5, 1e-5, 0.0, 128, 16)
        assert fine == pytest.approx(load, rel=1e-9)

    def test_property_a_rough_journal_drags_more_oil(self):
        """At a gap of 2.5 times the roughness a rough journal bears less, a rough bearing more."""
        loads = [rough_journal(0.95, 0.5, 0.02, one)[0] for one in (1.0, 0.0, -1.0)]
        assert loads[0] < loads[1] < loads[2]
        smooth = mapped_film(np.asarray(0.95), np.asarray(0.5))["So"]
        np.testing.assert_allclose(np.array(loads[:2]) / smooth - 1, [-0.032, 0.067], atol=2e-3)
