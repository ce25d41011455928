"""The solver finds the roots of many equations at the same time."""

import numpy as np
import pytest

from templates.physics.numerics.roots import bracketed_root, root_between


def cubic(x, a):
    return x**3 - a


def test_analytic_each_element_has_its_parameter():
    a = np.array([[1.0, 8.0], [27.0, 2.0]])
    assert root_between(cubic, np.zeros_like(a), np.full_like(a, 4.0), a) == pytest.approx(
        np.cbrt(a), rel=1e-14
    )


def test_analytic_both_methods_agree():
    a = np.linspace(0.5, 50.0, 40)
    own = bracketed_root(lambda x: cubic(x, a), np.zeros_like(a), np.full_like(a, 4.0))
    assert root_between(cubic, np.zeros_like(a), np.full_like(a, 4.0), a) == pytest.approx(own, rel=1e-14)


def test_property_without_a_change_of_sign_there_is_no_root():
    roots = root_between(cubic, np.zeros(3), np.full(3, 4.0), np.array([1.0, 100.0, np.nan]))
    assert roots[0] == pytest.approx(1.0)
    assert np.isnan(roots[1:]).all()


def test_property_single_values_give_a_number():
    assert np.ndim(root_between(cubic, np.float64(0), np.float64(4), np.float64(8))) == 0
