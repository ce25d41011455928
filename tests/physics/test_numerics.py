"""Analytic: each numerical method beneath the films agrees with an exact case or a second method."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline, RectBivariateSpline

from templates.physics.films.short_bearing import load_Ocvirk_1952
from templates.physics.numerics.arrays import ECCENTRICITY_LIMIT, largest_load, require_film, spread
from templates.physics.numerics.eccentricity import eccentricity
from templates.physics.numerics.periodic_steps import differences, imbalance, newton_step
from templates.physics.numerics.power_fit import exponent_k2, factor_k1
from templates.physics.numerics.reserve import above, below
from templates.physics.numerics.roots import bracketed_root
from templates.physics.numerics.spline_slopes import at_thirds, surfaces_with_slopes
from templates.physics.numerics.uniform_spline import (
    Axis,
    line,
    spline_coefficients,
    surface,
    surface_coefficients,
)
from templates.physics.numerics.volume_spline import at_third, volume

RANDOM = np.random.default_rng(5)
X, Y, Z = Axis(-1.0, 0.25, 9), Axis(2.0, 0.5, 11), Axis(0.5, 0.125, 7)


class CycleCounts:
    """A function that counts how often it is asked."""

    def __init__(self, function):
        self.function, self.calls = function, 0

    def __call__(self, x):
        self.calls += 1
        return self.function(x)


class TestRoots:
    def test_many_roots_at_once(self):
        cubes = np.array([1e-9, 0.3, 1.0, 2.0, 900.0])
        roots = bracketed_root(lambda x: x**3 - cubes, np.zeros(5), np.full(5, 10.0))
        assert roots == pytest.approx(np.cbrt(cubes), rel=1e-14)

    def test_a_root_at_either_end_and_none(self):
        low, high = np.array([0.0, -1.0, 1.0]), np.array([1.0, 0.0, 2.0])
        roots = bracketed_root(lambda x: x, low, high)
        assert roots[:2] == pytest.approx([0, 0], abs=1e-300)
        assert np.isnan(roots[2])

    def test_an_inverse_parabola_is_met_at_once(self):
        """x = (f + 1.2)² - 1: two ends, a bisection, the parabola through the three, and its check."""
        counted = CycleCounts(lambda x: np.sqrt(x + 1) - 1.2)
        assert bracketed_root(counted, np.array([0.0]), np.array([1.0])) == pytest.approx(0.44, rel=1e-14)
        assert counted.calls <= 7

    @pytest.mark.parametrize("function", [lambda x: np.cos(x) - x, lambda x: np.exp(x) - 5, np.tan])
    def test_it_is_faster_than_bisection(self, function):
        """Halving an interval of 3 down to 4e-16 takes 53 steps."""
        counted = CycleCounts(function)
        root = bracketed_root(counted, np.array([-1.4]), np.array([1.5 if function is np.tan else 1.7]))
        assert function(root) == pytest.approx(0, abs=4e-15)
        assert counted.calls < 20

    def test_a_loose_tolerance_ends_sooner_and_keeps_it(self):
        loose, tight = CycleCounts(lambda x: x**5 - 2), CycleCounts(lambda x: x**5 - 2)
        low, high = np.array([0.0]), np.array([3.0])
        rough = bracketed_root(loose, low, high, 1e-3)
        assert rough == pytest.approx(2**0.2, rel=4e-3)
        bracketed_root(tight, low, high)
        assert loose.calls < tight.calls

    def test_a_step_is_found_by_halving(self):
        root = bracketed_root(lambda x: np.where(x < 1 / 3, -1.0, 1.0), np.array([0.0]), np.array([1.0]))
        assert root == pytest.approx(1 / 3, rel=1e-14)


class TestSplines:
    """Against SciPy's splines with not-a-knot ends; more points than are evaluated at a time."""

    VALUES = RANDOM.normal(size=(9, 11, 7, 2))
    COUNT = 4500

    def places(self, axis):
        return RANDOM.uniform(axis.places()[0], axis.places()[-1], self.COUNT)

    def test_nodes_are_equally_spaced_from_the_first_on(self):
        assert X.places() == pytest.approx([-1, -0.75, -0.5, -0.25, 0, 0.25, 0.5, 0.75, 1])

    def test_a_surface_and_its_slopes(self):
        values = self.VALUES[:, :, :2, 0]
        x, y = self.places(X), self.places(Y)
        coefficients = surface_coefficients(values)
        which = RANDOM.integers(0, 2, self.COUNT)
        stacked = np.stack([coefficients[..., :1], coefficients[..., 1:]])
        sloped = surfaces_with_slopes(stacked, which, X, Y, x, y)[:, 0]
        plain = surface(coefficients, X, Y, x, y)
        for function in (0, 1):
            scipys = RectBivariateSpline(X.places(), Y.places(), values[..., function])
            assert plain[function] == pytest.approx(scipys.ev(x, y), abs=1e-10)
            own = which == function
            for row, (dx, dy) in enumerate([(0, 0), (1, 0), (0, 1)]):
                assert sloped[row, own] == pytest.approx(scipys.ev(x, y, dx, dy)[own], abs=1e-9)

    def test_a_cubic_goes_on_beyond_its_ends(self):
        cubic = np.polynomial.Polynomial([1, -2, 0.5, 3])
        coefficients = spline_coefficients(cubic(X.places()))
        x = np.array([-1.2, -1.0, 0.1, 1.0, 1.3])
        cell, weights = X.weights(x)
        assert (weights * coefficients[cell[:, None] + np.arange(4)]).sum(axis=1) == pytest.approx(cubic(x))

    def test_a_line_of_a_surface(self):
        values, y = self.VALUES[:, :, 0, :1], self.places(Y)[:20]
        along = line(surface_coefficients(values)[..., 0], Y, y)
        crossed = CubicSpline(Y.places(), values[..., 0], axis=1)(y)
        assert along == pytest.approx(spline_coefficients(crossed).T, abs=1e-10)

    def test_a_volume_and_its_surfaces(self):
        inner = np.moveaxis(spline_coefficients(np.moveaxis(self.VALUES, 2, 0)), 0, 2)
        flat = inner.reshape(9, 11, -1)
        coefficients = surface_coefficients(flat).reshape(11, 13, 9, 2)
        x, y, z = self.places(X), self.places(Y), self.places(Z)
        values = volume(coefficients, (X, Y, Z), np.stack([x, y, z]))
        for n in (0, 1, self.COUNT - 1):
            at_z = CubicSpline(Z.places(), self.VALUES, axis=2)(z[n])
            at_y = CubicSpline(Y.places(), at_z, axis=1)(y[n])
            assert values[:, n] == pytest.approx(CubicSpline(X.places(), at_y)(x[n]), abs=1e-10)
            cut = at_third(coefficients, Z, float(z[n]))
            assert surface(cut, X, Y, x[n : n + 1], y[n : n + 1])[:, 0] == pytest.approx(values[:, n])
            assert at_thirds(coefficients, Z, z[n : n + 1])[0] == pytest.approx(cut)


class TestPeriodicSteps:
    """Linear equations e' = M e + g on a ring: one step solves them, as a full matrix does."""

    CASES, NODES = 3, 12
    STEPS = RANDOM.uniform(0.3, 1.0, NODES)
    M = RANDOM.normal(size=(2, 2, CASES)) - 3 * np.eye(2)[:, :, None]
    G = RANDOM.normal(size=(2, CASES, NODES))

    def rate(self, e):
        return np.einsum("ijc,jcn->icn", self.M, e) + self.G

    def slopes(self):
        return np.repeat(self.M[..., None], self.NODES, axis=-1)

    def by_matrix(self, case):
        n, a = self.NODES, differences(self.STEPS)
        back = [np.roll(np.eye(n), -k, axis=1) for k in range(3)]  # row n picks node n - k
        operator = sum(a[k][:, None] * back[k] for k in range(3))
        whole = np.kron(operator, np.eye(2)) - np.kron(np.eye(n), self.M[..., case])
        return np.linalg.solve(whole, self.G[:, case].T.ravel()).reshape(n, 2).T

    def test_one_step_solves_linear_equations(self):
        a, e = differences(self.STEPS), RANDOM.normal(size=(2, self.CASES, self.NODES))
        e = e + newton_step(a, imbalance(a, e, self.rate(e)), self.slopes())
        assert imbalance(a, e, self.rate(e)) == pytest.approx(0, abs=1e-10)
        for case in range(self.CASES):
            assert e[:, case] == pytest.approx(self.by_matrix(case), abs=1e-9)

    def test_a_case_without_an_answer_does_not_spoil_the_others(self):
        a, e = differences(self.STEPS), np.zeros((2, self.CASES, self.NODES))
        slopes = self.slopes()
        slopes[:, :, 1] = np.nan
        change = newton_step(a, imbalance(a, e, self.rate(e)), slopes)
        assert np.isnan(change[:, 1]).all()
        for case in (0, 2):
            assert change[:, case] == pytest.approx(self.by_matrix(case), abs=1e-9)

    def test_differences_are_exact_for_parabolas_on_unequal_steps(self):
        t = np.cumsum(self.STEPS)
        for power, slope in ((0, 0 * t), (1, 1 + 0 * t), (2, 2 * t)):
            past = [np.roll(t, k) ** power for k in range(3)]
            backward = sum(a * e for a, e in zip(differences(self.STEPS), past, strict=True))
            assert backward[2:] == pytest.approx(slope[2:], abs=1e-9)


class TestEccentricity:
    def test_it_inverts_the_load(self):
        eps, ratio = np.array([1e-9, 0.2, 0.5, 0.99, 1 - 1e-6]), np.array([[0.1], [2.0]])
        inverse = eccentricity(load_Ocvirk_1952, load_Ocvirk_1952(eps, ratio), ratio)
        assert inverse == pytest.approx(np.broadcast_to(eps, (2, 5)), rel=1e-9)

    def test_no_load_and_more_than_the_film_bears(self):
        most = load_Ocvirk_1952(np.asarray(ECCENTRICITY_LIMIT), np.asarray(1.0))
        positions = eccentricity(load_Ocvirk_1952, np.array([0.0, most * 1.01]), np.asarray(1.0))
        assert positions[0] == 0
        assert np.isnan(positions[1])

    @pytest.mark.parametrize("load", [-1.0, np.nan, np.inf])
    def test_a_load_that_is_none_is_refused(self, load):
        with pytest.raises(ValueError, match="So must be 0 or more"):
            eccentricity(load_Ocvirk_1952, np.asarray(load), np.asarray(1.0))


class TestDomains:
    @pytest.mark.parametrize(("eps", "ratio"), [(0, 1e-300), (ECCENTRICITY_LIMIT, 1e300)])
    def test_the_ends_belong_to_the_film(self, eps, ratio):
        require_film(np.asarray(eps), np.asarray(ratio))

    @pytest.mark.parametrize(
        ("eps", "ratio", "name"),
        [
            *((-1e-300, 1, "eps"), (1 - 5e-8, 1, "eps"), (np.nan, 1, "eps")),
            *((0.5, 0, "ratio"), (0.5, -1, "ratio"), (0.5, np.inf, "ratio"), (0.5, np.nan, "ratio")),
        ],
    )
    def test_beyond_them_one_point_is_enough(self, eps, ratio, name):
        with pytest.raises(ValueError, match=name):
            require_film(np.array([0.5, eps]), np.array([1.0, ratio]))

    def test_a_limit_that_is_not_set_asks_for_nothing(self):
        def never():
            raise AssertionError

        assert above(np.asarray(np.nan), never) is True
        assert below(np.asarray([np.nan, np.nan]), never) is True

    def test_a_limit_may_be_met_exactly_and_each_point_counts(self):
        limits, values = np.array([np.nan, 2.0, 2.0, 2.0]), lambda: np.array([9.0, 1.0, 2.0, 3.0])
        assert above(limits, values).tolist() == [True, False, True, True]
        assert below(limits, values).tolist() == [True, True, True, False]


def test_the_largest_load_of_a_cycle():
    x, y = np.array([[3.0, 0.0, 1.0], [0.0, 5.0, 0.0]]), np.array([[4.0, 4.5, -1.0], [0.0, -12.0, 0.0]])
    assert largest_load(x, y) == pytest.approx([5, 13])
    assert spread(np.array([2.0, 3.0]), np.array([1.0, 10.0])).tolist() == [[2, 20], [3, 30]]


def test_literature_the_rows_of_the_fit():
    """Bhadke et al. 2015: So up to 10, 10 to 100, above."""
    So = np.array([1.0, 9.999, 10.0, 100.0, 100.001, 500.0])
    assert factor_k1(So).tolist() == [0.798, 0.798, 0.897, 0.897, 0.980, 0.980]
    assert exponent_k2(So).tolist() == [0.073, 0.073, 0.022, 0.022, 0.0028, 0.0028]
