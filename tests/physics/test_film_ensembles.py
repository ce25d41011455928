"""What stands behind the bounds of `oil_film_cycle` 1: order statistics, samples that have every supply."""

import json
from collections import Counter

import numpy as np
import pytest

from benchmarks.film_cycle_duties import (
    FRESH,
    KEPT,
    LOADS,
    MARCH,
    OTHER_SEED,
    OUTPUTS,
    SEED,
    WIDTHS,
    band,
    drawn,
    kept,
    wanted,
)
from benchmarks.film_cycle_ensemble import FILE, HOLDS, admitted, bound, coverage, rounded_up, tables
from benchmarks.supplied_duties import SUPPLIES
from benchmarks.supplied_orbits import DUTIES, sampled


class TestBounds:
    """One-sided tolerance bounds."""

    def test_example_the_largest_of_59_is_the_first_bound(self):
        errors = [float(k) for k in range(1, 60)]
        assert bound(errors) == 59
        assert bound(errors[:-1]) is None

    def test_example_of_93_one_may_starve(self):
        errors = [float(k) for k in range(1, 93)]
        assert bound([*errors, np.inf]) == 92
        assert bound([*errors[:-1], np.inf, np.inf]) is None

    def test_property_lies_above_the_quantile_as_often_as_stated(self):
        rng = np.random.default_rng(3)
        held = [bound(list(rng.random(93))) >= 0.95 for _ in range(1000)]
        assert np.mean(held) > 0.94

    @pytest.mark.parametrize(
        ("value", "stated"), [(0.7201, 0.73), (0.72, 0.72), (1.21, 1.3), (1.0, 1.0), (0.0, 0.0), (3e-4, 3e-4)]
    )
    def test_example_rounded_up_to_two_digits(self, value, stated):
        assert rounded_up(value) == pytest.approx(stated, rel=1e-12)


def test_example_a_bound_that_holds_too_seldom_with_the_other_seed_is_withdrawn():
    stated = {
        "half_groove": {"mobility": {"film": [[0.5, None]], "loss": [[0.2, 0.3]], "flow": [[0.1, 0.1]]}}
    }
    held = {"half_groove": {"mobility": {"film": [93, 100], "loss": [92, 100]}}}
    left = admitted(stated, held)["half_groove"]["mobility"]
    assert left["film"] == [[0.5, None]]
    assert left["loss"] == [[None, None], [None, None]]
    assert left["flow"] == [[0.1, 0.1]]


class TestFile:
    """The bounds that the service states are those of the kept duties."""

    def test_golden_bounds_and_counts_follow_from_the_kept_lines(self):
        lines, stated = kept(), json.loads(FILE.read_text(encoding="utf-8"))
        first = [line for line in lines if line["seed"] == SEED]
        held = coverage(tables(first), [line for line in lines if line["seed"] == OTHER_SEED])
        assert stated["held_with_another_seed"] == held
        assert stated["cases"] == admitted(tables(first), held)

    @pytest.mark.parametrize("kind", ["half_groove", "full_groove"])
    def test_property_every_bound_of_grooves_holds_for_93_of_100_fresh_duties(self, kind):
        stated = json.loads(FILE.read_text(encoding="utf-8"))
        assert sum(line["kind"] == kind and line["seed"] == OTHER_SEED for line in kept()) == FRESH
        counts = stated["held_with_another_seed"][kind]
        assert len(counts) == 3
        for level, outputs in counts.items():
            for output, (good, of) in outputs.items():
                assert of == FRESH, (level, output)
                assert good >= HOLDS * FRESH, (level, output)
                assert None not in np.ravel(stated["cases"][kind][level][output]), (level, output)

    @pytest.mark.parametrize("kind", ["sleeve_hole", "pin_hole"])
    def test_property_holes_are_bounded_where_59_duties_and_the_fresh_ones_support_it(self, kind):
        """None of these starved, so nothing else makes a bound null."""
        stated = json.loads(FILE.read_text(encoding="utf-8"))
        assert stated["cases"][kind].keys() == {"mobility_short", "mobility"}
        for level, outputs in stated["cases"][kind].items():
            counts = stated["held_with_another_seed"].get(kind, {}).get(level, {})
            for output in OUTPUTS:
                good, of = counts.get(output, (0, 0))
                for (i, j), value in np.ndenumerate(np.array(outputs[output], dtype=object)):
                    few = stated["duties"][kind].get(f"{i},{j}", 0) < 59
                    assert (value is None) == (few or good < HOLDS * of), (level, output, i, j)

    def test_property_holes_in_the_sleeve_have_a_bound_of_their_film(self):
        stated = json.loads(FILE.read_text(encoding="utf-8"))
        for level, outputs in stated["cases"]["sleeve_hole"].items():
            assert None not in np.ravel(outputs["minimum_film_thickness"]), level

    def test_property_the_record_is_small(self):
        assert KEPT.stat().st_size < 1e6


def test_property_no_duty_counts_twice_or_outside_the_bands():
    lines = kept()
    named = Counter((line["seed"], line["kind"], line["number"]) for line in lines)
    assert set(named.values()) == {1}
    assert all(LOADS[0] <= line["S"] <= LOADS[-1] for line in lines)
    assert all(WIDTHS[0] <= line["b"] <= WIDTHS[-1] for line in lines)


def test_example_one_band_alone_has_the_same_duties_as_in_all_bands():
    def numbers(*bands):
        return [number for number, _ in wanted(1, "full_groove", 3, *bands)]

    inside = [
        number
        for number, duty in wanted(1, "full_groove", 3)
        if band(float(np.hypot(*duty.load.S).max()), duty.ratio) == (0, 1)
    ]
    assert numbers(frozenset({(0, 1)})) == inside
    assert len(inside) == 3


def test_property_the_sample_has_each_supply_with_each_kind_of_load_alike():
    numbers = [number for number in range(DUTIES) if sampled(number)]
    alike = Counter((SUPPLIES[number // 2 % len(SUPPLIES)], number % 2) for number in numbers)
    assert len(numbers) == 60
    assert set(alike.values()) == {6}
    assert len(alike) == 10


def test_property_lines_that_count_are_of_one_march():
    assert {line["march"] for line in kept()} <= {MARCH}


def test_property_duties_are_the_same_from_whatever_number_they_are_drawn():
    numbers = [number for _, (number, _) in zip(range(6), drawn(1, "pin_hole"), strict=False)]
    later = drawn(1, "pin_hole", numbers[3])
    assert [next(later)[0] for _ in range(3)] == numbers[3:]
