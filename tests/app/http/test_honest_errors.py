"""Stated errors over REST, on pages and in reports: reference, one level for all points, null if unknown."""

import pytest
from serving import API, created

from templates.oil_film.oil_film_cycle_v1 import OilFilmCycle
from templates.oil_film.oil_film_v2 import OilFilm
from templates.oil_film.slider_bearing_v1 import SliderBearing

FILM = "minimum_film_thickness"
CYCLE = f"{API}/templates/oil_film_cycle/versions/1"
STATIC = f"{API}/templates/oil_film/versions/2"


def evaluated(http, path, inputs, **body):
    answer = http.post(f"{path}/evaluate", json={"inputs": inputs, "outputs": [FILM], **body})
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_the_truth_of_every_level_is_served(http):
    accuracy = http.get(f"{STATIC}/accuracy").json()
    truths = {level: about["truth"]["power_loss"] for level, about in accuracy["levels"].items()}
    assert truths["map"] != truths["mass_conserving"]
    assert len(set(truths.values())) == 2
    assert all(
        accuracy["truths"][name] for about in accuracy["levels"].values() for name in about["truth"].values()
    )


def test_the_cycle_serves_costs_and_no_errors_of_level_flooded(http):
    levels = http.get(f"{CYCLE}/accuracy").json()["levels"]
    assert list(levels) == list(OilFilmCycle.levels)
    assert all(about["cost"]["single"] > 0 for about in levels.values())
    tables = levels["flooded"]["errors"].values()
    assert {error for table in tables for row in table for error in row} == {None}


def test_no_stated_error_answers_at_the_default_level(http):
    plain = {name: raw for name, raw in OilFilmCycle.example.items() if "groove" not in name}
    del plain["supply_pressure"]
    plain["oil_supply"] = "flooded_ends"
    answer = evaluated(http, CYCLE, plain, tolerance=0.01)
    assert (answer["level"], answer["error"]) == ("mobility", {FILM: None})
    assert [w["code"] for w in answer["warnings"]] == ["tolerance_unmet"]


def test_one_level_serves_all_points_unless_each_is_to_have_its_own(http):
    inputs = {**OilFilm.example, "radial_load": {"value": [0.1, 5, 25], "unit": "kN"}}
    assert evaluated(http, STATIC, inputs, tolerance=0.05)["level"] == "map"
    separate = evaluated(http, STATIC, inputs, tolerance=0.05, per_point=True)
    assert separate["level"] == ["short_bearing", "map", "map"]
    assert max(separate["error"][FILM]) <= 0.05
    wrong = http.post(f"{STATIC}/evaluate", json={"inputs": inputs, "per_point": "yes"})
    assert wrong.status_code == 422


@pytest.mark.parametrize("path", ["/templates/slider_bearing/1", "report"])
def test_the_error_of_a_curve_is_printed_as_a_share_of_its_largest_value(http, path):
    """At the ends of the pad the pressure is zero, where an error relative to it would mean nothing."""
    if path == "report":
        step = {"template": "slider_bearing", "version": 1, "inputs": dict(SliderBearing.example),
                "level": "infinite", "outputs": ["pressure", "load"]}  # fmt: skip
        design = created(http, {"name": "pad", "steps": {"pad": step}})
        page = http.get(f"{API}/designs/{design['id']}/report").text
        assert page.count(" of its largest value") == 1
    else:
        page = http.get(path).text
        assert page.count(" % of its largest value</td>") == 2  # pressure and velocity
