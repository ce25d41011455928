"""Analytic and literature: the plane slider agrees with its closed forms."""

import numpy as np
import pytest
from finite_slider import finite_slider, leakage_factor
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from templates.physics.pads.slider import (
    centre_of_pressure_Rayleigh_1918,
    film_velocity,
    friction_incline_Rayleigh_1918,
    load_incline_Rayleigh_1918,
    pressure_incline_Rayleigh_1918,
)

RATIOS = [0.3, 0.95, 1 + 1e-9, 1.05, 1.0999, 1.1, 2.0, 5.0, 100.0]


def test_load_of_the_references() -> None:
    """References README: film ratio 2, and the best, 2.1889."""
    assert load_incline_Rayleigh_1918(np.asarray(2.0)) == pytest.approx(0.02648051, abs=5e-9)
    best = minimize_scalar(lambda a: -load_incline_Rayleigh_1918(np.asarray(a)), (1.5, 3))
    assert best.x == pytest.approx(2.1889, abs=5e-4)
    assert -best.fun == pytest.approx(0.02670719, abs=5e-9)


@pytest.mark.parametrize("a", RATIOS)
def test_load_and_centre_are_moments_of_the_pressure(a: float) -> None:
    load = quad(lambda x: pressure_incline_Rayleigh_1918(x, a), 0, 1, epsabs=0)[0]
    moment = quad(lambda x: x * pressure_incline_Rayleigh_1918(x, a), 0, 1, epsabs=0)[0]
    assert load_incline_Rayleigh_1918(np.asarray(a)) == pytest.approx(load, rel=1e-7)
    assert centre_of_pressure_Rayleigh_1918(np.asarray(a)) == pytest.approx(moment / load, rel=1e-7)


@pytest.mark.parametrize("a", [0.5, 1.0, 1.5, 3.0])
def test_friction_integrates_the_wall_shear(a: float) -> None:
    def shear(x: float, side: int) -> float:
        h, step = a - (a - 1) * x, 1e-5
        slope = (
            pressure_incline_Rayleigh_1918(x + step, a) - pressure_incline_Rayleigh_1918(x - step, a)
        ) / (2 * step)
        return float(1 / h + side * 3 * h * slope)

    inner = (1e-5, 1 - 1e-5)
    moving, pad = friction_incline_Rayleigh_1918(np.asarray(a))
    assert quad(shear, *inner, args=(1,))[0] == pytest.approx(moving, rel=1e-4)
    assert quad(shear, *inner, args=(-1,))[0] == pytest.approx(pad, rel=1e-4)


def test_parallel_pad_bears_nothing() -> None:
    assert load_incline_Rayleigh_1918(np.asarray(1.0)) == 0
    assert centre_of_pressure_Rayleigh_1918(np.asarray(1.0)) == pytest.approx(0.5)
    assert friction_incline_Rayleigh_1918(np.asarray(1.0)) == pytest.approx((1.0, 1.0))


def test_film_velocity_meets_both_faces() -> None:
    """The course's printed form, without z in its last terms, does not."""
    assert film_velocity(0.0, 2e-5, 1e9, 0.02, 3.0) == 0
    assert film_velocity(2e-5, 2e-5, 1e9, 0.02, 3.0) == pytest.approx(3.0)


@pytest.mark.parametrize("a", [0.0, -1.0, np.nan, np.inf])
def test_senseless_film_ratio_is_refused(a: float) -> None:
    with pytest.raises(ValueError, match="film ratio"):
        load_incline_Rayleigh_1918(np.asarray(a))


@pytest.mark.parametrize("a", [1.2, 2.1889, 10.0])
def test_wide_pad_nears_the_one_without_leakage(a: float) -> None:
    """What is missing halves with l/b."""
    missing = [1 - leakage_factor(a, width) for width in (12.5, 25.0, 50.0)]
    assert missing[0] / missing[1] == pytest.approx(2, rel=0.03)
    assert missing[1] / missing[2] == pytest.approx(2, rel=0.03)


def test_narrow_pad_nears_the_short_form() -> None:
    """Pressure from axial flow alone: P = 3 (b/2l)² (a − 1)(1 − zeta²)/H³, integrated in closed form."""
    a, width = 2.0, 0.01
    inverse_cubes = (1 - 1 / a**2) / (2 * (a - 1))
    short = 3 * (width / 2) ** 2 * (a - 1) * inverse_cubes * (2 / 3) / 6
    assert finite_slider(a, width, 512, 16).load == pytest.approx(short, rel=0.02)


@pytest.mark.parametrize(("a", "width"), [(1.5, 0.3), (2.2, 1.0), (8.0, 4.0)])
def test_finite_pad_converges_and_loses_no_oil(a: float, width: float) -> None:
    loads = [finite_slider(a, width, 32 * k, 8 * k).load for k in (1, 2, 4)]
    assert np.log2((loads[1] - loads[0]) / (loads[2] - loads[1])) >= 1.8
    film = finite_slider(a, width)
    assert 0 < film.side_flow < film.inlet_flow
    assert film.friction - film.friction_pad == pytest.approx(6 * (a - 1) * film.load)


def test_parallel_finite_pad_bears_nothing() -> None:
    film = finite_slider(1.0, 0.5)
    assert (film.load, film.centre, film.friction) == (0.0, 0.5, 1.0)


@pytest.mark.parametrize(("a", "width"), [(0.9, 1.0), (np.nan, 1.0), (2.0, 0.0), (2.0, 101.0)])
def test_pads_outside_the_range_are_refused(a: float, width: float) -> None:
    with pytest.raises(ValueError, match=r"film ratio|width"):
        finite_slider(a, width)
