"""Bands agree with hand calculations, and with their meaning: |v - t| ≤ e |t|."""

import math

import numpy as np
import pytest
from seeds import seeded

from templates.core.criteria.bands import Estimate, band, relative_error, relative_width, value_and_bounds
from templates.core.units.relation import parse

INF, NAN = math.inf, math.nan


@pytest.mark.parametrize(
    ("value", "error", "expected"),
    [
        (3.0, 0.0, (3.0, 3.0)),
        (3.0, 0.25, (2.4, 4.0)),  # 3/1.25, 3/0.75
        (-3.0, 0.25, (-4.0, -2.4)),
        (3.0, 1.0, (1.5, INF)),
        (3.0, 2.0, (1.0, INF)),
        (-3.0, 1.0, (-INF, -1.5)),
        (0.0, 0.5, (0.0, 0.0)),
        (0.0, 1.0, (-INF, INF)),  # any truth is off by all of itself
        (INF, 0.1, (INF, INF)),
    ],
)
def test_analytic_band_by_hand(value, error, expected):
    assert band(value, error) == pytest.approx(expected)
    arrays = band(np.array([value]), np.array([error]))
    assert [float(end[0]) for end in arrays] == pytest.approx(list(expected))


@pytest.mark.parametrize(("value", "error"), [(NAN, 0.1), (1.0, NAN), (NAN, NAN)])
def test_what_is_not_known_has_no_bounds(value, error):
    assert np.isnan(band(value, error)).all()
    assert np.isnan(band(np.array([value]), np.array([error]))).all()


def test_property_the_band_holds_every_truth_of_that_error_and_no_other():
    random = np.random.default_rng(seeded(1))
    truth = random.normal(size=2000)
    error = random.uniform(0, 0.99, size=2000)
    value = truth * (1 + error * random.uniform(-1, 1, size=2000))
    low, high = band(value, error)
    slack = 1e-12 * np.abs(truth)
    assert ((low <= truth + slack) & (truth - slack <= high)).all()
    for end in (low, high):  # each end is itself a truth that is off by exactly the error
        np.testing.assert_allclose(np.abs(value - end), error * np.abs(end), rtol=1e-9, atol=1e-15)


def test_analytic_measured_error_is_of_the_truth():
    assert relative_error(2.0, 1.0) == 1.0
    assert relative_error(0.5, 1.0) == 0.5
    assert relative_error(0.3, 0.2, scale=math.pi / 2) == pytest.approx(0.2 / math.pi)
    assert relative_error(0.0, 0.0) == 0.0
    assert relative_error(1.0, 0.0) == INF


def test_property_the_band_of_a_measured_error_ends_at_the_truth():
    random = np.random.default_rng(seeded(2))
    value, truth = random.uniform(0.1, 3, size=(2, 500))
    low, high = band(value, relative_error(value, truth))
    nearest = np.where(truth <= value, low, high)
    np.testing.assert_allclose(nearest, truth, rtol=1e-9)


def test_analytic_error_of_an_angle_is_of_a_right_angle():
    low, high = Estimate(0.1, 0.2, scale=math.pi / 2).bounds()
    assert (low, high) == pytest.approx((0.1 - 0.25 * math.pi / 2, 0.1 + 0.25 * math.pi / 2))


def test_analytic_error_of_a_curve_is_of_its_largest_value():
    curve = np.array([[-2.0, 0.0, 1.0], [1.0, 4.0, 2.0]])  # two points, three places
    low, high = Estimate(curve, np.array([0.5, 0.2]), axes=1).bounds()
    half = np.array([[2.0], [1.0]])  # e/(1 - e) of 2 and of 4
    np.testing.assert_allclose(low, curve - half)
    np.testing.assert_allclose(high, curve + half)


def test_analytic_changes_of_uncertain_names_are_added():
    """w = 2 a - b with a = 10 (e 0.25: 8 … 13.33), b = 3 (e 0.5: 2 … 6): 17 - 4 - 3 … 17 + 6.67 + 1."""
    estimates = {"a": Estimate(10.0, 0.25), "b": Estimate(3.0, 0.5)}
    assert value_and_bounds(parse("2 * a - b"), estimates)[1] == pytest.approx((10.0, 24 + 2 / 3))


def test_exact_names_leave_an_expression_exact():
    assert value_and_bounds(parse("2 * a + 1"), {"a": Estimate(1.5)})[1] == (4.0, 4.0)


def test_an_unknown_error_leaves_the_band_that_the_known_ones_make():
    """w = a + b with b = 1 (e 0.25: 0.8 … 1.333), a of an error that is not known in the second point."""
    estimates = {"a": Estimate(np.array([1.0, 2.0]), np.array([0.0, NAN])), "b": Estimate(1.0, 0.25)}
    _, (low, high), known = value_and_bounds(parse("a + b"), estimates)
    np.testing.assert_allclose([low, high], [[1.8, 2.8], [7 / 3, 10 / 3]])
    assert np.asarray(known).tolist() == [True, False]


def test_an_open_end_stays_open_and_never_narrows():
    _, (low, high), known = value_and_bounds(
        parse("1 / a"), {"a": Estimate(2.0, 1.0)}
    )  # a from 1 to infinity
    assert (low, high, known) == (0.0, 1.0, True)
    _, _, known = value_and_bounds(parse("a - a"), {"a": Estimate(2.0, 1.0)})  # infinity less infinity
    assert not known


@pytest.mark.parametrize(("value", "error"), [(3.0, 0.2), (-3.0, 0.2), (5.0, 0.0)])
def test_width_of_a_band_is_the_error_that_made_it(value, error):
    assert relative_width(value, *band(value, error)) == pytest.approx(error)


def test_width_of_an_open_band_is_not_known():
    assert relative_width(3.0, 1.0, INF) is None
