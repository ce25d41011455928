"""Limits, scatter, yields and shares agree with known results of closed forms."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats
from seeds import examples

from app.tolerances.factors import Factor, inverse, lattice, placed, scattered, sobol
from app.tolerances.scatter import SCRAMBLINGS, Rows, scatter
from app.tolerances.shares import shares
from app.tolerances.worst import worst
from templates.core.criteria.comparison import MET, NOT_CHECKED, NOT_MET, UNDECIDED

A = Factor("a", 1.0, 0.9, 1.1, "normal")
B = Factor("b", 2.0, 1.8, 2.2, "uniform")
C = Factor("c", 0.0, -0.5, 0.5, "triangular")
ABC = (A, B, C)
WIDTH_OF_CUT = stats.truncnorm(-3, 3).std()  # of three standard deviations that are cut: 0.98658
VARIANCE = {"normal": (WIDTH_OF_CUT / 3) ** 2, "uniform": 1 / 3, "triangular": 1 / 6}  # between −1 and 1


def variance(factor):
    return VARIANCE[factor.distribution] * ((factor.high - factor.low) / 2) ** 2


def linear(x):
    return 3 * x[:, 0] + 2 * x[:, 1] - x[:, 2]


def one(function):
    return lambda x: function(x)[:, np.newaxis]


def judging(function, limit, error=0.0):
    """Rows of a function that must be at least a limit, of which the model may be off by an error."""

    def judged(x):
        y = function(x)
        codes = np.select([y - error >= limit, y + error < limit], [MET, NOT_MET], UNDECIDED)
        return Rows(y[:, np.newaxis], {"k": codes}, {"k": y - limit})

    return judged


@pytest.mark.parametrize("distribution", ["normal", "uniform", "triangular"])
def test_distributions_have_their_limits_mean_and_variance(distribution):
    shares_below = (np.arange(200_000) + 0.5) / 200_000
    values = inverse(distribution, shares_below)
    assert np.all(np.diff(values) >= 0)
    assert inverse(distribution, np.array([0.0, 0.5, 1.0])) == pytest.approx([-1, 0, 1], abs=1e-12)
    assert values.mean() == pytest.approx(0, abs=1e-9)
    assert values.var() == pytest.approx(VARIANCE[distribution], rel=1e-4)


def test_a_normal_distribution_is_that_of_scipy_cut_at_three_sigma():
    share = np.array([0.01, 0.2, 0.7, 0.999])
    assert inverse("normal", share) == pytest.approx(stats.truncnorm(-3, 3).ppf(share) / 3, rel=1e-9)


@given(st.integers(1, 14))
@settings(max_examples=14, deadline=None)
def test_the_lattice_has_the_middle_and_its_most_rows(count):
    rows = lattice(count)
    assert (rows == 0).all(axis=1).any()
    assert len(np.unique(rows, axis=0)) == len(rows)
    assert len(rows) == (3**count if count <= 6 else 1 + 2 * count + (2**count if count <= 12 else 0))


def test_positions_are_placed_on_the_limits_exactly():
    ends = placed(ABC, np.array([[-1.0] * 3, [1.0] * 3]))
    assert ends.tolist() == [[0.9, 1.8, -0.5], [1.1, 2.2, 0.5]]


def test_extremes_of_a_linear_function_are_corners():
    [(low, high)] = worst(ABC, one(linear), 1).ends
    assert low.value == pytest.approx(2.7 + 3.6 - 0.5, rel=1e-12)
    assert high.value == pytest.approx(3.3 + 4.4 + 0.5, rel=1e-12)
    assert low.at.tolist() == [0.9, 1.8, 0.5]
    assert high.at.tolist() == [1.1, 2.2, -0.5]


def test_an_extreme_within_the_limits_is_met():
    """The best clearance of a film lies within its tolerance: corners and slopes miss it."""

    def film(x):
        return x[:, 0] - 4 * (x[:, 2] - 0.22) ** 2 - 0.1 * x[:, 1]

    [(low, high)] = worst(ABC, one(film), 1).ends
    assert high.value == pytest.approx(1.1 - 0.18, rel=1e-9)
    assert high.at == pytest.approx([1.1, 1.8, 0.22], rel=1e-4)
    assert low.value == pytest.approx(0.9 - 4 * 0.72**2 - 0.22, rel=1e-12)


def test_a_narrow_extreme_of_many_factors_is_met():
    factors = [Factor(f"x{n}", 0.0, -1.0, 1.0) for n in range(8)]
    peak = np.array([0.3, -0.2, 0.1, 0.4, -0.5, 0.25, -0.1, 0.6])
    [(_, high)] = worst(factors, one(lambda x: -((x - peak) ** 2).sum(axis=1)), 1).ends
    assert high.value == pytest.approx(0, abs=1e-6)
    assert high.at == pytest.approx(peak, abs=1e-3)


def test_refused_rows_are_counted_and_left_out():
    def refusing(x):
        return np.where(x[:, :1] > 1.05, np.nan, x[:, :1] * np.ones((1, 2)))

    extremes = worst(ABC, refusing, 1)
    assert 0 < extremes.refused < extremes.rows
    assert extremes.first_refused[0] > 1.05
    low, high = extremes.ends[0]
    assert low.value == 0.9
    assert 1.0 <= high.value <= 1.05


def test_an_output_without_any_value_has_no_ends_spread_or_yield():
    def nothing(x):
        return np.full((len(x), 1), np.nan)

    assert worst(ABC, nothing, 1).ends == [None]
    judged = scatter(
        ABC,
        lambda x: Rows(nothing(x), {"k": np.full(len(x), NOT_CHECKED)}, {"k": nothing(x)[:, 0]}),
        1024,
        1,
    )
    assert (judged.spreads, judged.yields, judged.refused) == ([None], {"k": None}, 1024)
    assert shares(ABC, nothing, 1024, 1).outputs == [None]


def test_a_constant_output_has_no_shares():
    def constant(x):
        return np.full((len(x), 1), 7.0)

    assert shares(ABC, constant, 1024, 1).outputs == [None]
    [spread] = scatter(ABC, lambda x: Rows(constant(x), {}, {}), 1024, 1).spreads
    assert (spread.mean, spread.deviation) == (7.0, 0.0)
    assert sum(spread.counts) == 1024


@pytest.mark.parametrize("distribution", ["normal", "uniform", "triangular"])
@pytest.mark.parametrize("seed", range(3))
def test_the_yield_of_one_factor_is_its_distribution_function(distribution, seed):
    factor = Factor("x", 0.0, -1.0, 1.0, distribution)
    for limit in (-0.6, -0.1, 0.35):
        sample = scatter([factor], judging(lambda x: x[:, 0], limit), 16_384, seed).yields["k"]
        exact = {
            "normal": stats.truncnorm(-3, 3).sf(3 * limit),
            "uniform": (1 - limit) / 2,
            "triangular": stats.triang(0.5, -1, 2).sf(limit),
        }[distribution]
        assert abs(sample.value - exact) <= 3 * sample.standard_error
        assert sample.standard_error <= 5e-4


def test_scatter_of_a_linear_function_has_its_mean_deviation_and_normal_quantiles():
    factors = [Factor(f"x{n}", 1.0, 0.0, 2.0) for n in range(4)]
    sample = scatter(factors, lambda x: Rows(x.sum(axis=1, keepdims=True), {}, {}), 16_384, 1)
    [spread] = sample.spreads
    deviation = 2 * np.sqrt(VARIANCE["normal"])
    assert spread.mean == pytest.approx(4, abs=1e-3)
    assert spread.deviation == pytest.approx(deviation, rel=2e-3)
    assert spread.quantiles[0.5] == pytest.approx(4, abs=5e-3)
    assert spread.quantiles[0.00135] == pytest.approx(4 - 3 * deviation, abs=0.15 * deviation)
    assert spread.quantiles[0.99865] == pytest.approx(4 + 3 * deviation, abs=0.15 * deviation)
    assert sum(spread.counts) == 16_384


def test_the_model_error_stands_beside_the_yield():
    factor = Factor("x", 0.0, -1.0, 1.0, "uniform")
    sample = scatter([factor], judging(lambda x: x[:, 0], 0.2, error=0.1), 16_384, 1).yields["k"]
    assert sample.value == pytest.approx(0.4, abs=1e-3)
    assert sample.with_model_error == pytest.approx((0.35, 0.45), abs=1e-3)
    exact = scatter([factor], judging(lambda x: x[:, 0], 0.2), 16_384, 1).yields["k"]
    assert exact.with_model_error == (exact.value, exact.value)


def test_a_refused_row_meets_nothing():
    factor = Factor("x", 0.0, -1.0, 1.0, "uniform")

    def judged(x):
        value = np.where(x[:, 0] > 0.5, np.nan, x[:, 0])
        codes = np.select([np.isnan(value), value >= 0], [NOT_CHECKED, MET], NOT_MET)
        return Rows(value[:, np.newaxis], {"k": codes}, {"k": value})

    sample = scatter([factor], judged, 16_384, 1)
    assert sample.yields["k"].value == pytest.approx(0.25, abs=1e-3)
    assert sample.yields["k"].with_model_error == pytest.approx((0.25, 0.25), abs=1e-3)
    assert sample.refused == pytest.approx(4096, abs=20)


def test_a_yield_of_one_has_a_standard_error_of_a_row():
    sample = scatter(ABC, judging(linear, 0.0), 4096, 1).yields["k"]
    assert (sample.value, sample.standard_error) == (1.0, 1 / 4096)


def test_the_same_seed_gives_the_same_scatter_and_another_one_another():
    first, again, other = (scatter(ABC, judging(linear, 6.6), 1024, seed) for seed in (1, 1, 2))
    assert first.yields == again.yields
    assert first.spreads[0].quantiles == again.spreads[0].quantiles
    assert first.spreads[0].mean != other.spreads[0].mean


def test_shares_of_a_linear_function_are_its_variances():
    [output] = shares(ABC, one(linear), 2048, 1).outputs
    parts = np.array([9 * variance(A), 4 * variance(B), variance(C)])
    for share, exact in zip(output.shares, parts / parts.sum(), strict=True):
        assert abs(share.first - exact) <= 4 * share.first_error + 1e-12
        assert abs(share.total - exact) <= 4 * share.total_error + 1e-12
        assert share.first_error <= 0.01
    assert abs(output.sum - 1) <= 3 * output.sum_error


def test_shares_of_a_product_have_what_two_values_do_together():
    factors = [Factor("a", 1.0, -1.0, 3.0, "uniform"), Factor("b", 1.0, -1.0, 3.0, "uniform"), C]
    [output] = shares(factors, one(lambda x: x[:, 0] * x[:, 1]), 8192, 1).outputs
    alone = variance(factors[0])  # mean 1, so the variance of a b is 2 v + v²
    exact = alone / (2 * alone + alone**2)
    for share in output.shares[:2]:
        assert abs(share.first - exact) <= 4 * share.first_error
        assert abs(share.total - (1 - exact)) <= 4 * share.total_error
    assert output.shares[2].first == output.shares[2].total == 0
    assert abs(output.sum - 2 * exact) <= 4 * output.sum_error
    assert output.sum < 1 - 3 * output.sum_error


def test_ishigamis_shares_are_those_published():
    """Ishigami and Homma 1990: a = 7, b = 0.1."""
    factors = [Factor(f"x{n}", 0.0, -np.pi, np.pi, "uniform") for n in range(3)]

    def ishigami(x):
        return np.sin(x[:, 0]) + 7 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])

    [share] = shares(factors, one(ishigami), 16_384, 1).outputs
    assert [s.first for s in share.shares] == pytest.approx([0.3139, 0.4424, 0.0], abs=0.01)
    assert [s.total for s in share.shares] == pytest.approx([0.5576, 0.4424, 0.2437], abs=0.01)


@given(
    st.lists(
        st.tuples(st.floats(-3, 3), st.floats(-3, 3), st.sampled_from(sorted(VARIANCE))),
        min_size=1,
        max_size=5,
    ),
    st.integers(0, 100),
)
@settings(max_examples=examples(40), deadline=None)
def test_first_shares_sum_to_at_most_one(terms, seed):
    factors = [Factor(f"x{n}", 0.0, -1.0, 1.0, name) for n, (_, _, name) in enumerate(terms)]

    def function(x):
        parts = [a * x[:, n] + b * x[:, n] ** 2 * x[:, n - 1] for n, (a, b, _) in enumerate(terms)]
        return np.sum(parts, axis=0)

    [output] = shares(factors, one(function), 2048, seed).outputs
    if output is not None:
        assert output.sum <= 1 + 5 * output.sum_error + 1e-9
        for share in output.shares:
            assert share.first <= share.total + 5 * np.hypot(share.first_error, share.total_error) + 1e-9


def test_further_points_are_sampled_until_the_standard_error_is_as_aimed():
    few = scatter(ABC, judging(linear, 6.6), 1024, 1)
    more = scatter(ABC, judging(linear, 6.6), 1024, 1, most=131_072)
    assert (few.rows, few.yields["k"].standard_error > 5e-4) == (1024, True)
    assert more.rows > 1024
    assert more.yields["k"].standard_error <= 5e-4
    assert more.rows == sum(more.spreads[0].counts)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("limit", [6.2, 6.6, 7.0, 7.5])
def test_yields_are_those_of_a_million_random_products(limit, seed):
    sample = scatter(ABC, judging(linear, limit), 16_384, seed, most=131_072).yields["k"]
    random = scattered(ABC, np.random.default_rng(2).random((1_000_000, 3)))
    exact = float((linear(random) >= limit).mean())
    noise = np.sqrt(exact * (1 - exact) / 1e6)
    assert abs(sample.value - exact) <= 3 * np.hypot(sample.standard_error, noise)
    assert sample.standard_error <= 5e-4


def test_eight_scramblings_differ():
    first, second = (sobol(3, 256, (1, 2, number)) for number in range(2))
    assert SCRAMBLINGS == 8
    assert not np.isin(first, second).any()
