"""`decide` uses finer levels only for undecided criteria, and reports its cost and why it stopped."""

import numpy as np
import pytest
from patience import until
from serving import API, created, faults, problem

from app.designs.document import Document
from app.designs.engine.calculate import calculate
from app.designs.engine.decision import Climb
from app.designs.graph import Catalogues, build_graph
from app.designs.service import resolved
from cad.catalogue import models
from templates.core.language.evaluate import evaluate
from templates.door import built_in

CATALOGUES = Catalogues(built_in(), models())
OIL_FILM = built_in().get("oil_film", 2)
FILM = dict(OIL_FILM.example)
DESIGNS = f"{API}/designs"


def document(require, level="short_bearing", **inputs):
    step = {"template": "oil_film", "version": 2, "level": level, "inputs": {**FILM, **inputs}}
    return {"name": "decided", "steps": {"film": step}, "criteria": {"own": {"require": require}}}


def decided(raw, criteria=("own",), budget=60.0):
    graph, graph_faults = build_graph(resolved(Document.model_validate(raw), CATALOGUES), CATALOGUES)
    assert not graph_faults
    calculation = calculate(graph, lambda shape: None, lambda *question: None)
    return Climb(calculation, criteria, budget).decide()


CYCLE = built_in().get("oil_film_cycle", 1)


def cycle_document(require, level="mobility_grooved", **inputs):
    raw = {**CYCLE.example, **inputs}
    step = {
        "template": "oil_film_cycle",
        "version": 1,
        "level": level,
        "inputs": {name: value for name, value in raw.items() if value is not None},
    }
    return {"name": "cycle", "steps": {"film": step}, "criteria": {"own": {"require": require}}}


def own(decision):
    return next(judgement for judgement in decision.criteria if judgement.name == "own")


def film_at(level, **inputs):
    result = evaluate(OIL_FILM, {**FILM, **inputs}, level=level, outputs=["minimum_film_thickness"])
    return result.outputs["minimum_film_thickness"].value


def test_a_cheap_level_that_decides_is_enough():
    decision = decided(document("film.minimum_film_thickness >= 1.5 um"))
    assert (decision.asked, decision.trials, decision.stopped) == ((), (), "decided")
    assert own(decision).verdict == "met"


@pytest.mark.parametrize(("limit", "verdict"), [("2.6 um", "met"), ("2.7 um", "not_met")])
def test_an_undecided_criterion_is_decided_by_a_finer_level(limit, verdict):
    decision = decided(document(f"film.minimum_film_thickness >= {limit}"))
    assert (own(decision).verdict, decision.stopped, decision.undecided) == (verdict, "decided", [])
    assert decision.trials[-1].decided == ("own",)
    assert own(decision).level == decision.trials[-1].level
    levels = [trial.level for trial in decision.trials]
    assert "mass_conserving" not in levels
    assert own(decision).value == pytest.approx(film_at(levels[-1]))


@pytest.mark.parametrize(("limit", "verdict"), [("75 MPa", "not_met"), ("120 MPa", "met")])
def test_a_level_that_states_an_error_is_climbed_to_where_the_error_is_unknown(limit, verdict):
    """No mobility level states an error of the largest pressure; level supplied does: 75.5 MPa within 6 %."""
    decision = decided(cycle_document(f"film.maximum_pressure <= {limit} * 0.9"))
    assert (own(decision).verdict, decision.stopped, decision.error_unknown) == (verdict, "decided", [])
    assert [(trial.level, trial.decided) for trial in decision.trials] == [("supplied", ("own",))]
    assert own(decision).truth == "rigid film"
    assert 0 < own(decision).relative_error < 0.1
    assert decision.trials[0].expected > 0


@pytest.mark.slow
def test_every_bearing_of_a_table_is_decided():
    widths = {"value": [16, 18, 24], "unit": "mm"}
    decision = decided(cycle_document("film.minimum_film_thickness >= 2 um", bearing_width=widths))
    assert (decision.trials[-1].level, decision.trials[-1].rows) == ("supplied", 3)
    assert (own(decision).verdict, own(decision).points, decision.stopped) == ("met", 3, "decided")


@pytest.mark.slow
def test_a_film_that_starves_is_refused_by_name():
    """A load that turns with the pin, and so with its hole."""
    turn = np.arange(24) * np.pi / 12
    turning = {
        "load_x": {"value": (10 * np.cos(turn)).tolist(), "unit": "kN"},
        "load_y": {"value": (10 * np.sin(turn)).tolist(), "unit": "kN"},
        "groove_width": None, "groove_start": None, "groove_extent": None, "pin_hole_length": "4 mm",
    }  # fmt: skip
    decision = decided(cycle_document("film.minimum_film_thickness >= 1 um", "mobility", **turning))
    reasons = {trial.level: trial.reason for trial in decision.trials}
    assert "it refuses: no film repeats: starved" in reasons["supplied"]


def test_at_the_value_itself_it_stays_undecided_and_says_why():
    value = film_at("reynolds")
    decision = decided(document(f"film.minimum_film_thickness >= {value!r} um"))
    assert (own(decision).verdict, decision.stopped) == ("undecided", "no_finer_level")
    assert decision.undecided == ["own"]
    reasons = {trial.level: trial.reason for trial in decision.skipped}
    assert "is not smaller" in reasons["short_bearing"]


def test_levels_of_another_truth_are_left_out():
    """Level mass_conserving counts shear where oil is, the others all around; theirs has a smaller error."""
    result = evaluate(OIL_FILM, FILM, level="mass_conserving", outputs=["power_loss"])
    value, error = result.outputs["power_loss"].value, result.error["power_loss"]
    assert error > evaluate(OIL_FILM, FILM, level="map", outputs=["power_loss"]).error["power_loss"]
    decision = decided(document(f"film.power_loss >= {value!r} W", level="mass_conserving"))
    assert (decision.trials, decision.stopped, decision.undecided) == ((), "no_finer_level", ["own"])
    reasons = {trial.level: trial.reason for trial in decision.skipped}
    assert "another reference" in reasons["map"]


def test_no_level_begins_beyond_the_budget():
    decision = decided(document("film.minimum_film_thickness >= 2.6 um"), budget=1e-6)
    assert (decision.trials, decision.stopped, decision.undecided) == ((), "budget", ["own"])
    assert {(trial.step, "budget" in trial.reason) for trial in decision.skipped} == {("film", True)}


def test_only_criteria_that_are_asked_for_are_decided():
    raw = document("film.minimum_film_thickness >= 2.6 um")
    raw["criteria"]["other"] = {"require": "film.minimum_film_thickness >= 2.7 um"}
    decision = decided(raw, ["other"])
    assert decision.asked == ("other",)
    assert own(decision).verdict == "undecided"


def test_a_step_upstream_climbs_where_its_error_keeps_another_undecided():
    raw = document("film.minimum_film_thickness >= 0.1 um", level="fit")
    clearance = "= film.minimum_film_thickness * 20"
    inputs = {**FILM, "diametral_clearance": clearance}
    raw["steps"]["next"] = {"template": "oil_film", "version": 2, "level": "map", "inputs": inputs}
    exact = film_at("map", diametral_clearance=f"{float(20 * film_at('map'))!r} um")
    raw["criteria"] = {"own": {"require": f"next.minimum_film_thickness <= {1.002 * exact!r} um"}}
    decision = decided(raw)
    assert own(decision).verdict == "met"
    assert {trial.step for trial in decision.trials} == {"film"}


def test_points_beyond_what_a_level_takes_are_said():
    loads = {"value": np.linspace(24.9, 25.1, 101).tolist(), "unit": "kN"}
    raw = document(f"film.minimum_film_thickness >= {film_at('map')!r} um", radial_load=loads)
    decision = decided(raw)
    assert (decision.trials[0].rows, own(decision).points) == (101, 101)
    reasons = {trial.level: trial.reason for trial in decision.skipped}
    assert reasons["reynolds"] == "it takes at most 100 points at once, not 101"


def test_a_design_is_decided_over_http_and_nothing_is_saved(http, client):
    design = created(http, document("film.minimum_film_thickness >= 2.6 um"))
    answer = http.post(f"{DESIGNS}/{design['id']}/decide", json={"criteria": ["own"], "budget": "20 s"})
    assert answer.status_code == 200, answer.text
    body = answer.json()
    assert (body["asked"], body["undecided"], body["stopped"]) == (["own"], [], "decided")
    verdicts = {criterion["name"]: criterion["verdict"] for criterion in body["criteria"]}
    assert verdicts["own"] == "met"
    assert body["tried"][-1]["decided"] == ["own"]
    assert body["budget"] == {"value": 20, "unit": "s"}
    assert body["revision"] == http.get(f"{DESIGNS}/{design['id']}").json()["revision"] == 1
    in_us = http.post(f"{DESIGNS}/{design['id']}/decide?units=us", json={}).json()["criteria"]
    value = next(one["value"] for one in in_us if one["name"] == "own")
    si = next(one["value"]["value"] for one in body["criteria"] if one["name"] == "own")
    assert value == {"value": pytest.approx(si / 25.4), "unit": "thou"}
    assert client.decide(design["id"]).stopped in ("decided", "no_finer_level")
    of_client = {one.name: one.value for one in client.decide(design["id"], units="us").criteria}
    assert {one["name"]: one.get("value") for one in in_us} == {
        name: value and value.model_dump() for name, value in of_client.items()
    }
    assert http.post(f"{DESIGNS}/{design['id']}/decide").status_code == 200


VARIANTS = {
    "main_1": {"film.radial_load": "10 kN"},
    "main_2": {"film.radial_load": "25 kN"},
    "main_10": {"film.radial_load": "24 kN"},
}


def test_every_variant_is_decided_and_named(http, client):
    """At level short_bearing 10 kN keeps 2.6 µm for certain; the others, and the design itself, climb."""
    raw = {**document("film.minimum_film_thickness >= 2.6 um"), "variants": VARIANTS}
    design = created(http, raw)
    path = f"{DESIGNS}/{design['id']}/decide"
    estimate = http.post(path, json={"criteria": ["own"], "estimate_only": True}).json()
    assert (estimate["stopped"], estimate["tried"]) == ("estimated", [])
    assert [trial.get("variant") for trial in estimate["planned"]] == [None, "main_2", "main_10"]
    assert estimate["expected"] == pytest.approx(sum(trial["expected"] for trial in estimate["planned"]))
    assert estimate["expected"] > 0
    answer = http.post(path, json={"criteria": ["own"]}, headers={"Prefer": "wait=30"})
    assert answer.status_code == 200, answer.text
    body = answer.json()
    own_of = {one["name"]: next(c for c in one["criteria"] if c["name"] == "own") for one in body["variants"]}
    assert {name: one["verdict"] for name, one in own_of.items()} == dict.fromkeys(VARIANTS, "met")
    assert [one["asked"] for one in body["variants"]] == [[], ["own"], ["own"]]
    assert body["stopped"] == "decided"
    assert {trial.get("variant") for trial in body["tried"]} == {None, "main_2", "main_10"}
    merged = next(one for one in body["criteria"] if one["name"] == "own")
    assert (merged["verdict"], merged["points"]) == ("met", 4)
    alone = created(http, document("film.minimum_film_thickness >= 2.6 um", radial_load="24 kN"))
    expected = http.post(f"{DESIGNS}/{alone['id']}/decide", json={"criteria": ["own"]}).json()
    value = next(one["value"] for one in expected["criteria"] if one["name"] == "own")
    assert own_of["main_10"]["value"]["value"] == pytest.approx(value["value"], rel=1e-9)
    assert [one.name for one in client.decide(design["id"], ["own"]).variants] == list(VARIANTS)


def test_what_no_level_can_state_stays_open():
    """No level states an error of what oil flows out in all: met, error unknown, and nothing to calculate."""
    decision = decided(document("film.total_oil_flow >= 1e-6 l/min"))
    assert (decision.asked, decision.trials, decision.stopped) == ((), (), "no_finer_level")
    assert decision.error_unknown == ["own"]
    assert own(decision).verdict == "met"


def test_an_expensive_level_goes_on_as_a_job(http):
    value = film_at("map")
    loads = {"value": [16.0 + number for number in range(10)], "unit": "kN"}  # the last is FILM's
    required = f"film.minimum_film_thickness >= {value!r} um"
    design = created(http, document(required, level="map", radial_load=loads))
    wanted = {"criteria": ["own"], "budget": "60 s"}
    path, later = f"{DESIGNS}/{design['id']}/decide?units=us", {"Prefer": "respond-async"}
    answer = http.post(path, json=wanted, headers=later)
    assert answer.status_code == 202, answer.text
    assert answer.json()["stopped"] == "pending"
    job = answer.headers["Location"]
    until(lambda: http.get(job).json()["state"] == "done")
    body = http.get(http.get(job).json()["result"]).json()
    assert body["stopped"] in ("decided", "no_finer_level")
    assert next(one["limit"]["unit"] for one in body["criteria"] if one["name"] == "own") == "thou"
    assert "reynolds" in {trial["level"] for trial in body["tried"]}


@pytest.mark.parametrize(
    ("body", "name"),
    [
        ({"criteria": ["owm"]}, "criteria.owm"),
        ({"budget": "30"}, "budget"),
        ({"budget": "0 s"}, "budget"),
        ({"budget": "1 h"}, "budget"),
        ({"budget": {"value": [1, 2], "unit": "s"}}, "budget"),
        ({"budget": "3 mm"}, "budget"),
    ],
)
def test_wrong_questions_are_refused(http, body, name):
    design = created(http, document("film.minimum_film_thickness >= 2.6 um"))
    assert list(faults(http.post(f"{DESIGNS}/{design['id']}/decide", json=body))) == [name]


def test_a_design_that_does_not_exist_is_not_found(http):
    problem(http.post(f"{DESIGNS}/nowhere/decide", json={}), 404, "not-found")
