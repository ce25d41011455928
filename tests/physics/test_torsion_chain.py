"""The chain of inertias against closed forms, Holzer's transfer of torques, and sign counts in 100 digits."""

from decimal import Decimal, localcontext
from itertools import pairwise
from math import log2, pi, sin

import numpy as np
import pytest

from templates.physics.shafts.torsion_chain import FIXED, FREE, angular_frequencies, mode_shapes

SCALES = [(-9, 9), (-2, 2)]


def random_chain(rng, n, ends, low, high):
    springs = n - (ends == FREE)
    return 10 ** rng.uniform(low, high, n), 10 ** rng.uniform(low, high, springs)


def modes_below(omega, J, k, ends):
    """How many natural frequencies are below omega: negative pivots of K - omega² J, in 100 digits."""
    with localcontext(prec=100):
        square, ground = Decimal(float(omega)) ** 2, [Decimal(float(k[0]))] if ends == FIXED else []
        springs = [*(ground or [Decimal(0)]), *(Decimal(float(x)) for x in k[len(ground) :]), Decimal(0)]
        pivot, count = Decimal(1), 0
        for i, inertia in enumerate(J):
            coupling = springs[i] ** 2 / pivot if i else Decimal(0)
            pivot = springs[i] + springs[i + 1] - square * Decimal(float(inertia)) - coupling
            count += pivot < 0
        return count


def torque_left_over(omega, J, k):
    """Holzer: the torque at the last inertia that keeps a free chain at omega, with 1 at its first."""
    angle, torque = 1.0, 0.0
    for i, inertia in enumerate(J):
        torque += inertia * omega**2 * angle
        if i < len(k):
            angle -= torque / k[i]
    return torque


class TestAnalytic:
    @pytest.mark.parametrize("n", [1, 2, 3, 10, 200, 500])
    def test_analytic_equal_inertias_free(self, n):
        result = angular_frequencies(np.full(n, 0.3), np.full(n - 1, 7.0), FREE)
        exact = [2 * (7 / 0.3) ** 0.5 * sin(m * pi / (2 * n)) for m in range(n)]
        assert result[0] == 0
        assert result == pytest.approx(exact, rel=1e-13, abs=0)

    @pytest.mark.parametrize("n", [1, 2, 3, 10, 200, 500])
    def test_analytic_equal_inertias_fixed(self, n):
        result = angular_frequencies(np.full(n, 0.3), np.full(n, 7.0), FIXED)
        exact = [2 * (7 / 0.3) ** 0.5 * sin((2 * m + 1) * pi / (2 * (2 * n + 1))) for m in range(n)]
        assert result == pytest.approx(exact, rel=1e-13, abs=0)

    @pytest.mark.parametrize(("one", "other"), [(1.0, 2.0), (1e-9, 1e9), (1e-100, 1e100), (1e9, 1e-9)])
    def test_analytic_two_inertias(self, one, other):
        J, k = np.array([one, other]), np.array([3.0])
        assert angular_frequencies(J, k, FREE)[1] == pytest.approx(
            (3 * (1 / one + 1 / other)) ** 0.5, rel=1e-14
        )
        shape = mode_shapes(J, k, FREE)[1]
        assert shape[1] / shape[0] == pytest.approx(-one / other, rel=1e-13, abs=0)

    def test_analytic_finer_chains_tend_to_the_shaft(self):
        """A round bar 50 × 200 mm, one end fixed: 4009.57 Hz (shared reference), by second order."""
        length, polar, G, rho = 0.2, pi / 32 * 0.05**4, 210e9 / 2.6, 7850.0
        exact = (G / rho) ** 0.5 / (4 * length)
        assert exact == pytest.approx(4009.57, abs=5e-3)
        errors = []
        for n in (10, 20, 40):
            step = length / n
            J = np.full(n, rho * polar * step)
            J[-1] /= 2
            result = angular_frequencies(J, np.full(n, G * polar / step), FIXED)[0] / (2 * pi)
            errors.append(exact - result)
        assert [log2(a / b) for a, b in pairwise(errors)] == pytest.approx([2, 2], abs=0.01)

    def test_analytic_many_chains_are_each_as_alone(self):
        rng = np.random.default_rng(5)
        J, k = rng.uniform(1, 2, (3, 4, 6)), rng.uniform(1, 2, (4, 5))
        omega, shapes = angular_frequencies(J, k, FREE), mode_shapes(J, k, FREE)
        assert (omega.shape, shapes.shape) == ((3, 4, 6), (3, 4, 6, 6))
        for point in np.ndindex(3, 4):
            np.testing.assert_array_equal(omega[point], angular_frequencies(J[point], k[point[1]], FREE))
            np.testing.assert_allclose(shapes[point], mode_shapes(J[point], k[point[1]], FREE), atol=1e-13)


class TestProperty:
    @pytest.mark.parametrize("ends", [FREE, FIXED])
    @pytest.mark.parametrize("scale", SCALES)
    @pytest.mark.parametrize("n", [2, 5, 12, 60])
    def test_property_each_frequency_to_rounding(self, n, scale, ends):
        """Between 1 ∓ 1e-13 of the m-th frequency the count of lower ones goes from m to m + 1."""
        J, k = random_chain(np.random.default_rng(n), n, ends, *scale)
        for mode, omega in enumerate(angular_frequencies(J, k, ends)):
            if omega:
                assert modes_below(omega * (1 - 1e-13), J, k, ends) == mode
                assert modes_below(omega * (1 + 1e-13), J, k, ends) == mode + 1

    @pytest.mark.slow
    @pytest.mark.parametrize("ends", [FREE, FIXED])
    def test_property_ten_thousand_chains_to_rounding(self, ends):
        rng = np.random.default_rng(11)
        for _ in range(5000):
            J, k = random_chain(rng, int(rng.integers(1, 8)), ends, -9, 9)
            omega = angular_frequencies(J, k, ends)
            mode = int(rng.integers(len(omega)))
            if omega[mode]:
                assert modes_below(omega[mode] * (1 - 1e-13), J, k, ends) == mode
                assert modes_below(omega[mode] * (1 + 1e-13), J, k, ends) == mode + 1

    @pytest.mark.parametrize("n", [2, 9, 40])
    def test_property_holzer_leaves_no_torque_at_a_frequency(self, n):
        rng = np.random.default_rng(n)
        J, k = rng.uniform(0.5, 2, n), rng.uniform(0.5, 2, n - 1)
        for omega in angular_frequencies(J, k, FREE)[1:]:
            below, above = (torque_left_over(omega * (1 + side * 1e-9), J, k) for side in (-1, 1))
            assert below * above < 0

    @pytest.mark.parametrize("ends", [FREE, FIXED])
    @pytest.mark.parametrize("n", [1, 2, 9, 40])
    def test_property_modes_meet_the_equation_of_motion(self, n, ends):
        rng = np.random.default_rng(n)
        J, k = random_chain(rng, n, ends, -1, 1)
        omega, shapes = angular_frequencies(J, k, ends), mode_shapes(J, k, ends)
        twist = np.diff(shapes, axis=1, prepend=0.0) if ends == FIXED else np.diff(shapes, axis=1)
        torque = k * twist
        ahead = np.pad(torque, ((0, 0), (0, 1)))[:, 1:] if ends == FIXED else np.pad(torque, ((0, 0), (0, 1)))
        behind = torque if ends == FIXED else np.pad(torque, ((0, 0), (1, 0)))
        inertia = J * omega[:, None] ** 2 * shapes
        scale = np.abs(inertia).max() + np.abs(torque).max(initial=1.0)
        assert np.abs(ahead - behind + inertia).max() < 1e-12 * scale
        assert np.abs(shapes).max(axis=1) == pytest.approx(np.ones(n), abs=1e-15)

    @pytest.mark.parametrize("ends", [FREE, FIXED])
    def test_property_modes_are_orthogonal_and_have_as_many_nodes_as_their_number(self, ends):
        rng = np.random.default_rng(7)
        J, k = random_chain(rng, 9, ends, -1, 1)
        shapes = mode_shapes(J, k, ends)
        products = (shapes * J) @ shapes.T
        masses = np.sqrt(np.diag(products))
        assert products / np.outer(masses, masses) == pytest.approx(np.eye(9), abs=1e-14)
        assert [int(np.sum(row[1:] * row[:-1] < 0)) for row in shapes] == list(range(9))
