"""The random bearings behind the errors of `thrust_bearing`, `mixed_friction` and `thermal_film`."""

import json

import numpy as np
import pytest

from benchmarks.film_ensembles import ENSEMBLES, SEED, at, sampled
from templates.core.language.levels import accuracy_file

FEWEST = 59
WRITTEN = [name for name, one in ENSEMBLES.items() if accuracy_file(one.template).exists()]


def stated(name):
    return json.loads(accuracy_file(ENSEMBLES[name].template).read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", WRITTEN)
class TestFile:
    def test_a_cell_with_too_few_bearings_states_nothing(self, name):
        content = stated(name)
        counts = np.array(content["ensemble"]["cells"])
        assert content["ensemble"]["seed"] == SEED
        for level in content["levels"].values():
            for table in level["errors"].values():
                known = np.array(table, dtype=float)
                assert known.shape == counts.shape
                assert np.isnan(known[counts < FEWEST]).all()

    def test_bounds_hold_on_bearings_of_another_seed(self, name):
        """At least 93 % of them: bounds of the 95 % quantile, and some 150 bearings held out."""
        held_out = stated(name)["held_out"]
        assert held_out["seed"] != SEED
        shares = [good / count for level in held_out["held"].values() for good, count in level.values()]
        assert shares
        assert min(shares) >= 0.93

    def test_every_level_states_its_cost_for_one_and_for_many(self, name):
        for level in stated(name)["levels"].values():
            assert 0 < level["cost"]["vectorised"] <= level["cost"]["single"]


@pytest.mark.parametrize("name", ["thrust_bearing", pytest.param("mixed_friction", marks=pytest.mark.slow)])
def test_property_bounds_hold_on_fresh_bearings(name):
    """Thirty of a third seed, which may miss a bound of 95 % four times."""
    ensemble, content = ENSEMBLES[name], stated(name)
    sample = sampled(ensemble, 5, 30)
    x, y = sample.places
    (_, _, rows), (_, _, columns) = ensemble.axes
    i, j = np.searchsorted(rows, x, side="right") - 1, np.searchsorted(columns, y, side="right") - 1
    inside = (i >= 0) & (i < len(rows) - 1) & (j >= 0) & (j < len(columns) - 1)
    for level in ensemble.levels:
        for output, table in content["levels"][level]["errors"].items():
            bound = np.array(table, dtype=float)[np.where(inside, i, 0), np.where(inside, j, 0)]
            missed = inside & (sample.errors[level][output] > bound)
            assert missed.sum() <= 4, (level, output)


def test_the_answers_of_an_ensemble_are_those_of_the_template():
    ensemble = ENSEMBLES["mixed_friction"]
    values, template = at(ensemble.template, dict(ensemble.template.example), ensemble.outputs, "map")
    assert values["film_parameter"] == pytest.approx(float(template.film_parameter))
