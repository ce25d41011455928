"""A study minimises the power of a bearing with a film limit, explored at a cheap level."""

import numpy as np
import pytest

from app.studies.methods.optimise import optimise
from benchmarks.sizing import Sizing, engine, level, problem
from tests.references.trade import trade

FINE, LIMIT = "map", 2.6e-6


@pytest.fixture(scope="module")
def bearing():
    return Sizing(48, 0.4, 1.1e-3, 28, 5000, {"dynamic_viscosity": "10 mPa*s"})


def by_level(bearing, name):
    return level(engine(bearing), name, LIMIT)


def test_a_level_off_by_a_few_per_cent_is_corrected_to_the_optimum_of_the_confirming_level(bearing):
    fine = by_level(bearing, FINE)
    cheap = optimise(problem(bearing), by_level(bearing, "fit"), fine, seed=1)
    own = optimise(problem(bearing), fine, fine, seed=1)
    assert cheap.rounds[0].verdicts == ("not_met",)  # what `fit` alone would have chosen
    assert (cheap.state, cheap.best.verdicts, own.state) == ("settled", ("met",), "settled")
    assert cheap.best.confirmed[0] == pytest.approx(own.best.confirmed[0], rel=3e-4)
    again = fine(cheap.best.at[None])
    assert again.values[0, 0] == pytest.approx(cheap.best.confirmed[1], rel=1e-12)
    assert again.low[0, 0] >= 0


@pytest.mark.slow
def test_corrections_far_from_the_optimum_do_not_make_it_infeasible(bearing):
    """`short_bearing` is wrong by a factor of two, and its first optimum lies at the other end of the box."""
    fine = by_level(bearing, FINE)
    result = optimise(problem(bearing), by_level(bearing, "short_bearing"), fine, seed=1)
    assert result.rounds[0].confirmed[1] < 0.6 * LIMIT
    assert any(not one.is_feasible for one in result.rounds)
    assert (result.state, result.best.verdicts) == ("settled", ("met",))
    assert fine(result.best.at[None]).low[0, 0] >= 0


def test_trade_shows_what_each_level_would_have_chosen(bearing):
    levels = {name: by_level(bearing, name) for name in ("short_bearing", "fit")}
    table = trade(problem(bearing), levels, by_level(bearing, FINE), seed=1)
    off = {name: one.best.promise[1] / one.best.confirmed[1] - 1 for name, one in table.items()}
    assert off["short_bearing"] > 0.2
    assert 0 < abs(off["fit"]) < 0.1
    assert all(one.explored > 4096 and one.confirmations == 1 for one in table.values())
    assert np.isfinite([one.best.confirmed for one in table.values()]).all()
