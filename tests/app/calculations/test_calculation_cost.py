"""Estimates of cost: calculations of milliseconds are below the limit, long ones above it."""

import pytest

from app.catalogue.discovery import find_templates
from app.pool.cost import EXPENSIVE, IN_SERVER, MeasuredTimes, estimated_seconds, solving_seconds

CATALOGUE = find_templates(())
FILM = CATALOGUE.get("oil_film", 2)


def many(count):
    return {"value": [10.0 + number for number in range(count)], "unit": "kN"}


COSTLY = {"cycle_heat_balance"}  # the balance needs several orbits, 0.2 s in all


@pytest.mark.parametrize("cls", list(CATALOGUE), ids=lambda cls: f"{cls.id}_{cls.version}")
def test_every_example_is_cheap_at_its_usual_level(cls):
    seconds = estimated_seconds(cls, cls.example)
    assert 0 < seconds < (1.0 if cls.id in COSTLY else EXPENSIVE)
    assert (seconds > EXPENSIVE) == (cls.id in COSTLY)


@pytest.mark.parametrize(
    ("level", "points", "is_expensive"),
    [
        ("map", 1, False),
        ("map", 100, False),
        ("map", 2000, True),
        ("reynolds", 1, False),
        ("reynolds", 10, True),
        ("mass_conserving", 10, True),
    ],
)
def test_levels_and_points_make_the_cost(level, points, is_expensive):
    inputs = {**FILM.example, "radial_load": many(points) if points > 1 else "25 kN"}
    assert (estimated_seconds(FILM, inputs, level) > EXPENSIVE) == is_expensive


def test_points_multiply_the_cost():
    one, many_points = (
        estimated_seconds(FILM, {**FILM.example, "radial_load": many(count)}, "reynolds")
        for count in (2, 200)
    )
    assert many_points > 50 * one


def test_level_flooded_takes_longest():
    cls = CATALOGUE.get("oil_film_cycle", 1)
    others = [level for level in cls.levels if level != "flooded"]
    longest = estimated_seconds(cls, cls.example, "flooded")
    assert longest > 3 * max(estimated_seconds(cls, cls.example, level) for level in others)


def test_outputs_that_do_not_depend_on_the_level_cost_nothing_of_it():
    assert estimated_seconds(FILM, FILM.example, "mass_conserving", outputs=["sommerfeld_number"]) < 0.01


def test_a_fed_bearing_costs_what_its_only_level_does():
    fed = {**FILM.example, "supply_pressure": "3 bar"}
    assert estimated_seconds(FILM, fed) == pytest.approx(estimated_seconds(FILM, fed, "mass_conserving"))


def test_a_tolerance_may_climb_to_the_finest_level():
    assert estimated_seconds(FILM, FILM.example, tolerance=1e-3) > estimated_seconds(
        FILM, FILM.example, "reynolds"
    )


def test_solving_costs_more_than_evaluating():
    cls = CATALOGUE.get("oil_film", 1)
    target = ["minimum_film_thickness"]
    assert solving_seconds(cls, cls.example, target=target) > estimated_seconds(cls, cls.example)
    evaluating = estimated_seconds(FILM, FILM.example, "mass_conserving")
    solving = solving_seconds(FILM, FILM.example, "mass_conserving", target=target)
    assert solving > max(EXPENSIVE, 2 * evaluating)


@pytest.mark.parametrize(
    "raw", [None, True, [], {}, [[]], {"value": {}}, "no quantity", {"value": [[1], "x"]}]
)
def test_whatever_is_sent_has_a_cost(raw):
    inputs = {**FILM.example, "radial_load": raw, "nonsense": raw}
    assert estimated_seconds(FILM, inputs, "no level", 0.1, ["no output"]) > 0


def test_a_claim_beyond_all_numbers_has_a_cost():
    deep = 1.0
    for _ in range(120):
        deep = [deep] * 1000
    assert estimated_seconds(FILM, {**FILM.example, "radial_load": deep}) > EXPENSIVE


KIND = (FILM, "map", None, frozenset({"minimum_film_thickness"}), 15)


def test_without_a_measurement_the_estimate_decides_where_an_array_is_evaluated():
    times = MeasuredTimes()
    assert times.leaves(KIND, 1.1 * EXPENSIVE)
    assert not times.leaves(KIND, 0.9 * EXPENSIVE)


def test_a_measured_time_decides_against_the_estimate():
    times = MeasuredTimes()
    times.note(KIND, 2 * IN_SERVER)
    assert times.leaves(KIND, 0.0)
    assert not times.leaves((*KIND[:-1], 14), 0.0)
    quick = MeasuredTimes()
    quick.note(KIND, IN_SERVER / 2)
    assert not quick.leaves(KIND, 2 * EXPENSIVE)


def test_a_long_measured_time_is_measured_again_after_a_while():
    times = MeasuredTimes()
    times.note(KIND, 2 * IN_SERVER)
    away = 0
    while times.leaves(KIND, 0.0):
        away += 1
    assert 60 < away < 80
    times.note(KIND, 4 * IN_SERVER)
    assert times.leaves(KIND, 0.0)
