"""Cross's law keeps its limits and HTHS viscosity, is monotone, and is finite over any inputs.

No published flow curve with Cross's constants of an engine oil was at hand.
"""

import numpy as np
import pytest
from seeds import seeded

from templates.physics.journals.shear_thinning import (
    HTHS_RATE,
    critical_rate_at,
    critical_rate_of_HTHS,
    viscosity_Cross_1965,
)

OIL = (0.0049, 0.0024)  # low and endless shear, near an SAE 15W-40 at 150 °C


@pytest.mark.parametrize("n", [0.6, 0.8, 1.0])
@pytest.mark.parametrize("hths", [0.0029, 0.0037, 0.0045])
def test_analytic_law_meets_its_hths_viscosity(hths, n):
    critical = critical_rate_of_HTHS(hths, *OIL, n)
    assert viscosity_Cross_1965(HTHS_RATE, *OIL, critical, n) == pytest.approx(hths, rel=1e-14)


def test_limit_low_and_endless_shear():
    assert viscosity_Cross_1965(0.0, *OIL, 1e6, 0.8) == OIL[0]
    assert viscosity_Cross_1965(1e-30, *OIL, 1e6, 0.8) == pytest.approx(OIL[0])
    assert viscosity_Cross_1965(1e30, *OIL, 1e6, 0.8) == pytest.approx(OIL[1])
    assert viscosity_Cross_1965(1e6, *OIL, 1e6, 0.8) == pytest.approx(sum(OIL) / 2)


def test_limit_an_oil_that_does_not_thin_is_newtonian():
    rates = np.geomspace(1, 1e9, 50)
    np.testing.assert_allclose(viscosity_Cross_1965(rates, 0.01, 0.01, 1e6, 0.8), 0.01, rtol=1e-15)


def test_property_falls_with_the_rate_and_slope_by_differences():
    rates = np.geomspace(1e2, 1e10, 400)
    eta = viscosity_Cross_1965(rates, *OIL, 1e6, 0.8)
    assert (np.diff(eta) < 0).all()
    slope = np.gradient(np.log((OIL[0] - eta) / (eta - OIL[1])), np.log(rates))
    np.testing.assert_allclose(slope[1:-1], 0.8, rtol=1e-6)


@pytest.mark.parametrize("hths", [OIL[0], 0.006, OIL[1], 0.001])
def test_property_an_hths_viscosity_outside_is_none(hths):
    assert np.isnan(critical_rate_of_HTHS(hths, *OIL, 0.8))


def test_analytic_product_with_the_viscosity_stays():
    there = viscosity_Cross_1965(1e6, 0.005, 0.003, 2e6, 0.8) / 0.005
    critical = critical_rate_at(2e6, 0.005, 0.05)
    assert viscosity_Cross_1965(1e5, 0.05, 0.03, critical, 0.8) / 0.05 == pytest.approx(there)


def test_property_random_inputs_are_finite_or_none():
    rng, count = np.random.default_rng(seeded(31)), 100_000
    eta_0, hths, eta_inf = (10 ** rng.uniform(-4, 2, count) for _ in range(3))
    rate, n = 10 ** rng.uniform(-6, 12, count), rng.uniform(0.1, 2, count)
    critical = critical_rate_of_HTHS(hths, eta_0, eta_inf, n)
    thins = (hths < eta_0) & (hths > eta_inf)
    assert (np.isfinite(critical) == thins).all()
    eta = viscosity_Cross_1965(rate[thins], eta_0[thins], eta_inf[thins], critical[thins], n[thins])
    assert ((eta <= eta_0[thins] * (1 + 1e-12)) & (eta >= eta_inf[thins] * (1 - 1e-12))).all()
