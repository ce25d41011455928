"""The tolerance analysis over HTTP agrees with single evaluations and random products."""

import itertools

import numpy as np
import pytest
from patience import until
from scipy.interpolate import RegularGridInterpolator
from serving import API, created, faults, problem

from app.tolerances.factors import Factor, scattered
from templates.core.language.evaluate import evaluate
from templates.door import built_in

OIL_FILM = built_in().get("oil_film", 2)
FILM = dict(OIL_FILM.example)
DESIGNS = f"{API}/designs"
THICKNESS = "film.minimum_film_thickness"


def document(level="map", parameters=None, criteria=None, **inputs):
    step = {"template": "oil_film", "version": 2, "level": level, "inputs": {**FILM, **inputs}}
    return {
        "name": "toleranced",
        "parameters": parameters or {},
        "steps": {"film": step},
        "criteria": criteria or {"thick_enough": {"require": f"{THICKNESS} >= 2.6 um"}},
    }


LOW, HIGH = 12.0, 32.0  # um: the film is thickest at about 18 um
CLEARANCE = {"diametral_clearance": "55 ± 10 um", "radial_load": "25 ± 1 kN"}


def asked(http, id, body, query=""):
    """The answer, on a busy machine that of the job which goes on with it."""
    response = http.post(f"{DESIGNS}/{id}/tolerance{query}", json=body)
    if response.status_code == 202:
        job = response.headers["Location"]
        until(lambda: http.get(job).json()["state"] == "done")
        response = http.get(http.get(job).json()["result"])
    assert response.status_code == 200, response.text
    return response


def analysed(http, raw, **body):
    return asked(http, created(http, raw)["id"], body).json()


def thickness(**inputs):
    answer = evaluate(OIL_FILM, {**FILM, **inputs}, level="map", outputs=["minimum_film_thickness"])
    return answer.outputs["minimum_film_thickness"].value


@pytest.fixture(scope="module")
def analysis(http):
    wanted = {"outputs": [THICKNESS, "film.power_loss"], "criteria": ["thick_enough"], "points": 16384}
    return analysed(http, document(**CLEARANCE), **wanted)


def test_the_nominal_value_and_the_limits_are_those_of_single_evaluations(analysis):
    film = analysis[THICKNESS]
    assert film["unit"] == "um"
    assert film["nominal"] == pytest.approx(thickness(), rel=1e-9)
    for end in film["worst"].values():
        at = {name.removeprefix("film."): value for name, value in end["at"].items()}
        assert thickness(**at) == pytest.approx(end["value"], rel=1e-9)


def test_the_worst_case_is_that_of_a_fine_lattice(analysis):
    clearances = {"value": np.repeat(np.linspace(45, 65, 201), 3).tolist(), "unit": "um"}
    loads = {"value": np.tile([24.0, 25.0, 26.0], 201).tolist(), "unit": "kN"}
    values = thickness(diametral_clearance=clearances, radial_load=loads)
    low, high = analysis[THICKNESS]["worst"]["low"], analysis[THICKNESS]["worst"]["high"]
    assert low["value"] == pytest.approx(values.min(), rel=1e-6)
    assert high["value"] >= values.max() * (1 - 1e-9)
    assert high["value"] == pytest.approx(values.max(), rel=1e-4)


def test_the_best_clearance_within_the_limits_is_met(http):
    """The thickest film stands between the limits, where neither corner nor slope finds it."""
    clearance = {"value": np.linspace(LOW, HIGH, 401).tolist(), "unit": "um"}
    values = thickness(diametral_clearance=clearance)
    best = int(np.argmax(values))
    assert 0 < best < 400
    raw = document(diametral_clearance=f"{(LOW + HIGH) / 2:g} ± {(HIGH - LOW) / 2:g} um")
    high = analysed(http, raw, outputs=[THICKNESS], points=1024)[THICKNESS]["worst"]["high"]
    assert high["value"] >= values[best] * (1 - 1e-9)
    assert high["value"] == pytest.approx(values[best], rel=1e-3)
    assert high["at"]["film.diametral_clearance"]["value"] == pytest.approx(
        clearance["value"][best], rel=0.02
    )


def test_the_yield_is_that_of_a_million_products(analysis):
    """The film of one clearance and one load is interpolated over a grid: a million rows are cheap then."""
    axes = np.linspace(45, 65, 81), np.linspace(24, 26, 21)
    grid = np.array(list(itertools.product(*axes)))
    clearances = {"value": grid[:, 0].tolist(), "unit": "um"}
    loads = {"value": grid[:, 1].tolist(), "unit": "kN"}
    values = thickness(diametral_clearance=clearances, radial_load=loads).reshape(81, 21)
    film = RegularGridInterpolator(axes, values, method="cubic")
    factors = [Factor("clearance", 55, 45, 65), Factor("load", 25, 24, 26)]
    random = film(scattered(factors, np.random.default_rng(5).random((1_000_000, 2))))
    exact = float((random >= 2.6).mean())
    estimated = analysis[THICKNESS]["yield"]
    noise = np.sqrt(exact * (1 - exact) / 1e6)
    assert 0.5 < exact < 0.99
    assert abs(estimated["value"] - exact) <= 3 * np.hypot(estimated["standard_error"], noise)
    assert estimated["standard_error"] <= 1e-3
    low, high = estimated["with_model_error"]
    assert low <= estimated["value"] <= high
    assert 0 < high - low < 0.01  # the error of level map is stated, and small
    assert estimated["error_stated"]
    quantiles = np.quantile(random, [0.00135, 0.5, 0.99865])
    stated = [analysis[THICKNESS]["quantiles"][share] for share in ("0.00135", "0.5", "0.99865")]
    assert stated == pytest.approx(quantiles.tolist(), rel=2e-3)
    assert analysis[THICKNESS]["standard_deviation"] == pytest.approx(random.std(), rel=5e-3)


def test_shares_sum_to_at_most_one_and_name_the_larger_cause_first(analysis):
    for output in (THICKNESS, "film.power_loss"):
        shares, total = analysis[output]["shares"], analysis[output]["shares_sum"]
        assert set(shares) == {"film.diametral_clearance", "film.radial_load"}
        assert total["value"] <= 1 + 3 * total["standard_error"]
        assert sum(share["first"] for share in shares.values()) == pytest.approx(total["value"])
        totals = [share["total"] for share in shares.values()]
        assert totals == sorted(totals, reverse=True)


def test_what_was_analysed_is_stated(analysis):
    about = analysis["analysis"]
    assert about["toleranced"]["film.diametral_clearance"] == {
        "nominal": {"value": 55, "unit": "um"},
        "low": {"value": 45, "unit": "um"},
        "high": {"value": 65, "unit": "um"},
        "distribution": "normal",
    }
    assert (about["revision"], about["points"], about["levels"]) == (1, 16384, {"film": "map"})
    assert about["criteria"]["thick_enough"]["value"] == analysis[THICKNESS]["yield"]["value"]
    assert analysis[THICKNESS]["yield"]["limit"] == 2.6
    assert analysis[THICKNESS]["relative_error"] > 0
    histogram = analysis[THICKNESS]["histogram"]
    assert len(histogram["edges"]) == len(histogram["counts"]) + 1
    assert sum(histogram["counts"]) == 16384


def test_one_parameter_used_twice_is_one_random_number(http):
    raw = document(
        parameters={"bore": "48 mm H7", "journal": "47.945 mm ± 5 um", "twice": "= bore - bore + 1 um"},
        diametral_clearance="= bore - journal",
        bearing_diameter="= bore",
    )
    outputs = ["twice", "film.diametral_clearance", THICKNESS]
    answer = analysed(http, raw, outputs=outputs, points=1024)
    assert set(answer["analysis"]["toleranced"]) == {"bore", "journal"}
    assert answer["twice"]["worst"]["low"]["value"] == pytest.approx(answer["twice"]["nominal"])
    assert answer["twice"]["reason"] == "no tolerance changes it"
    ends = [answer["film.diametral_clearance"]["worst"][end]["value"] for end in ("low", "high")]
    assert ends == pytest.approx([0.05, 0.085], rel=1e-9)  # mm
    assert answer["analysis"]["toleranced"]["bore"]["zone"] == "H7"


@pytest.mark.slow
def test_the_same_seed_gives_the_same_answer(http):
    design = created(http, document(**CLEARANCE))
    bodies = ({"seed": seed, "points": 1024} for seed in (7, 7, 8))
    first, again, other = (asked(http, design["id"], body).content for body in bodies)
    assert first == again
    assert first != other


def test_without_a_body_outputs_and_criteria_are_those_of_the_design(http, client):
    design = created(http, document(**CLEARANCE))
    answer = client.tolerance(design["id"])
    assert THICKNESS in answer.outputs
    assert "thick_enough" in answer.analysis.criteria
    assert "film.film" in answer.analysis.criteria
    assert answer.analysis.not_judged["film.own_film"].give == ["film.permissible_film"]
    largest = max(one.standard_error for one in answer.analysis.criteria.values())
    assert largest <= 5e-4
    assert answer.analysis.points > 16384
    assert answer.outputs[THICKNESS].yield_.of in answer.analysis.criteria
    assert http.get(f"{DESIGNS}/{design['id']}").json()["revision"] == 1


def test_units_of_the_answer(http):
    design = created(http, document(**CLEARANCE))
    body = {"criteria": ["thick_enough"], "points": 1024}
    si, us = (asked(http, design["id"], body, f"?units={units}").json()[THICKNESS] for units in ("si", "us"))
    assert us["unit"] == "thou"
    for name in ("nominal", "mean", "standard_deviation"):
        assert us[name] == pytest.approx(si[name] / 25.4)
    assert us["worst"]["low"]["value"] == pytest.approx(si["worst"]["low"]["value"] / 25.4)
    assert us["yield"]["limit"] == pytest.approx(si["yield"]["limit"] / 25.4)
    assert us["yield"]["value"] == si["yield"]["value"]


def test_products_that_the_design_refuses_are_counted(http):
    raw = document(
        parameters={"load": "1 ± 2 kN"},
        radial_load="= load",
        criteria={"thick_enough": {"require": f"{THICKNESS} >= 0.1 um"}},
    )
    answer = analysed(http, raw, outputs=[THICKNESS], criteria=["thick_enough"], points=1024)
    refused = answer["analysis"]["refused"]
    assert refused["rows"] > 0
    assert refused["at"]["load"]["value"] < 0
    assert refused["reason"].startswith("film.radial_load:")
    assert answer[THICKNESS]["yield"]["value"] < 0.95
    assert "refuses" in answer[THICKNESS]["reason"]


def test_tolerances_that_have_no_part_in_it_are_named(http):
    raw = document(parameters={"idle": "3 ± 1 mm", "list": ["1 ± 0.1 mm", "2 mm"]}, **CLEARANCE)
    answer = analysed(http, raw, outputs=[THICKNESS], points=1024)
    warnings = {one["name"]: one["detail"] for one in answer["analysis"]["warnings"]}
    assert "nothing that was asked for follows from it" in warnings["idle"]
    assert "array" in warnings["list"]


def test_a_level_may_be_named(http):
    answer = analysed(http, document(**CLEARANCE), points=1024, levels={"film": "short_bearing"})
    assert answer["analysis"]["levels"] == {"film": "short_bearing"}


def test_an_analysis_that_nobody_waits_for_is_a_job(http):
    design = created(http, document(**CLEARANCE))
    path = f"{DESIGNS}/{design['id']}/tolerance"
    later = http.post(f"{path}?units=us", json={"points": 1024}, headers={"Prefer": "respond-async"})
    assert later.status_code == 202, later.text
    job = later.headers["Location"]
    until(lambda: http.get(job).json()["state"] == "done")
    answer = http.get(http.get(job).json()["result"]).json()
    assert answer == asked(http, design["id"], {"points": 1024}, "?units=us").json()


def test_a_job_can_be_cancelled(http):
    design = created(http, document(level="reynolds", **CLEARANCE))
    path = f"{DESIGNS}/{design['id']}/tolerance"
    body = {"outputs": [THICKNESS], "criteria": ["thick_enough"], "points": 1024}
    later = http.post(path, json=body, headers={"Prefer": "respond-async"})
    assert later.status_code == 202, later.text
    job = later.headers["Location"]
    assert http.delete(job).status_code in (200, 202, 204)
    until(lambda: http.get(job).json()["state"] in ("cancelled", "done"))
    assert http.get(job).json()["state"] == "cancelled"


@pytest.mark.parametrize(
    ("body", "name"),
    [
        ({"outputs": ["film.minimum_film_thicknes"]}, "outputs.film.minimum_film_thicknes"),
        ({"outputs": ["film.oil_grade"]}, "outputs.film.oil_grade"),
        ({"outputs": []}, "outputs"),
        ({"criteria": ["thick_enouh"]}, "criteria.thick_enouh"),
        ({"points": 1000}, "points"),
        ({"points": 3000}, "points"),
        ({"points": 2**20}, "points"),
        ({"seed": -1}, "seed"),
        ({"levels": {"flm": "map"}}, "levels.flm"),
        ({"levels": {"film": "maps"}}, "levels.film.maps"),
        ({"levels": {"film": "mass_conserving"}}, "levels"),
        ({"curious": 1}, "curious"),
    ],
)
def test_wrong_questions_are_refused(http, body, name):
    design = created(http, document(**CLEARANCE))
    assert list(faults(http.post(f"{DESIGNS}/{design['id']}/tolerance", json=body))) == [name]


def test_a_design_without_tolerances_is_refused_with_how_to_write_one(http):
    design = created(http, document())
    answer = http.post(f"{DESIGNS}/{design['id']}/tolerance", json={})
    assert faults(answer) == {"design": "no_tolerance"}
    assert "write it like `55 ± 5 um`" in answer.json()["errors"][0]["detail"]
    problem(http.post(f"{DESIGNS}/nowhere/tolerance", json={}), 404, "not-found")


def test_a_faulty_tolerance_is_refused_when_it_is_saved(http):
    answer = http.post(DESIGNS, json=document(diametral_clearance="55 ± 60 um"))
    assert faults(answer) == {"film.diametral_clearance": "out_of_range"}
    assert "by its tolerance" in answer.json()["errors"][0]["detail"]
    answer = http.post(DESIGNS, json=document(bearing_diameter="48 mm H4"))
    assert faults(answer) == {"film.bearing_diameter": "unknown_zone"}
    assert "grades 5 to 11" in answer.json()["errors"][0]["detail"]
