"""Solving a design finds each value of one parameter that gives a wanted output, through relations."""

import json

import numpy as np
import pytest
from serving import API, faults, problem

from app.designs.document import Document
from app.designs.graph import Catalogues
from app.designs.schemas.solution import DesignSolution
from app.designs.service import resolved
from app.designs.solution import solved
from app.designs.tasks import DesignTask
from cad.catalogue import models
from templates.core.errors import InvalidInputs, Unreachable
from templates.core.language.evaluate import evaluate
from templates.core.language.solve import solve
from templates.door import built_in

CATALOGUES = Catalogues(built_in(), models())
FILM = {
    "radial_load": "25 kN", "bearing_diameter": "48 mm", "bearing_width": "18 mm", "speed": "7000 rpm",
    "diametral_clearance": "0.05 mm", "supply_temperature": "80 degC",
}  # fmt: skip
FRICTION = {
    "journal_diameter": "= 2 * radius", "bearing_width": "20 mm", "radial_clearance": "30 um",
    "speed": "= speed", "dynamic_viscosity": "10 mPa*s",
}  # fmt: skip
PETROFF = {
    "name": "Petroff",
    "parameters": {"radius": "25 mm", "speed": "3000 rpm", "half": "= speed / 2"},
    "steps": {"idle": {"template": "journal_friction", "version": 1, "inputs": FRICTION}},
}
FILMS = {
    "name": "film",
    "parameters": {"clearance": "0.05 mm", "gap": "= clearance + 1 um"},
    "steps": {
        "film": {
            "template": "oil_film",
            "version": 2,
            "outputs": ["minimum_film_thickness"],
            "inputs": {**FILM, "diametral_clearance": "= gap"},
        }
    },
    "criteria": {"thick": {"require": "film.minimum_film_thickness >= 1.9 um"}},
}
THIN = "film.minimum_film_thickness"


def asked(raw, unknown, low, high, name, value, **more):
    plain = resolved(Document.model_validate(raw), CATALOGUES).model_dump(mode="json", by_alias=True)
    body = {"unknown": unknown, "between": [low, high], "target": {name: value}, **more}
    return solved(DesignTask.of(plain, CATALOGUES), 7, json.dumps(body))


def test_analytic_power_grows_with_the_square_of_the_speed_and_the_cube_of_the_radius():
    """Petroff's power is proportional to n² r³ here, so both solutions are closed forms."""
    idle = {**FRICTION, "journal_diameter": "50 mm", "speed": "3000 rpm"}
    power = evaluate(built_in().get("journal_friction", 1), idle).outputs["power_loss"].value
    fourfold = {"value": 4 * power, "unit": "W"}
    for unknown, low, high, expected in (
        ("speed", "100 rpm", "20000 rpm", 6000.0),
        ("radius", "1 mm", "200 mm", 25 * 4 ** (1 / 3)),
    ):
        solution = asked(PETROFF, unknown, low, high, "idle.power_loss", fourfold)
        assert [root.value for root in solution.roots] == [pytest.approx(expected, rel=1e-12)]
        assert (solution.roots[0].crossing, solution.touching, solution.jumps) == ("rises", [], [])
        assert solution.revision == 7


@pytest.mark.slow
def test_both_clearances_of_one_film_are_found_through_a_chain_of_relations():
    """The same roots as the template's own solve, less the 1 µm that the chain adds."""
    solution = asked(FILMS, "clearance", "2 um", "0.5 mm", THIN, "2 um")
    given = {name: value for name, value in FILM.items() if name != "diametral_clearance"}
    alone = solve(
        built_in().get("oil_film", 2), given, "diametral_clearance", ["3 um", "0.501 mm"],
        {"minimum_film_thickness": "2 um"}, outputs=["minimum_film_thickness"],
    )  # fmt: skip
    assert len(solution.roots) == 2
    expected = [root.value - 0.001 for root in alone.roots]
    assert [root.value for root in solution.roots] == pytest.approx(expected, rel=1e-9)
    assert [root.crossing for root in solution.roots] == ["rises", "falls"]
    assert {root.level for root in solution.roots} == {alone.roots[0].level}


@pytest.mark.slow
def test_each_solution_carries_the_verdict_of_every_criterion_of_the_design():
    """A film of 2 µm meets the design's own 1.9 µm; one of 1.8 µm does not."""
    met, missed = (
        asked(FILMS, "clearance", "2 um", "0.5 mm", THIN, film).roots for film in ("2 um", "1.8 um")
    )
    assert {root.verdicts["thick"] for root in met} == {"met"}
    assert {root.verdicts["thick"] for root in missed} == {"not_met"}
    assert "film.film_exists" in met[0].verdicts


@pytest.mark.slow
def test_the_curve_passes_the_target_at_every_solution():
    solution = asked(FILMS, "clearance", "2 um", "0.5 mm", THIN, "2 um")
    x, y = np.array(solution.curve.x.value), np.array(solution.curve.y.value)
    assert (solution.curve.x.unit, solution.target.unit) == ("mm", "um")
    at_roots = np.interp([root.value for root in solution.roots], x, y)
    assert at_roots == pytest.approx([2.0, 2.0], rel=1e-3)


@pytest.mark.slow
def test_a_tolerance_confirms_at_another_level_than_that_of_the_curve():
    coarse = {**FILMS, "steps": {"film": {**FILMS["steps"]["film"], "tolerance": 0.05}}}
    solution = asked(coarse, "clearance", "20 um", "60 um", THIN, "2 um", tolerance=1e-4)
    assert solution.curve.level == "map"
    assert solution.roots[0].level == "reynolds"
    [finer] = solution.finer
    levels = (solution.levels["film"], solution.finer_levels["film"])
    assert (finer.level, *levels) == ("reynolds", "map", "reynolds")
    assert min(finer.x.value) < solution.roots[0].value < max(finer.x.value)
    assert solution.roots[0].value in finer.x.value
    assert np.interp(solution.roots[0].value, finer.x.value, finer.y.value) == pytest.approx(2, rel=1e-9)
    finest = asked(FILMS, "clearance", "20 um", "60 um", THIN, "2 um", tolerance=1e-4)
    assert solution.roots[0].value == pytest.approx(finest.roots[0].value, rel=1e-8)


def test_a_tolerance_that_the_level_of_the_design_misses_is_said():
    """The design names level fit, which states 3 % or so there."""
    fixed = {**FILMS, "steps": {"film": {**FILMS["steps"]["film"], "level": "fit"}}}
    question = ("clearance", "20 um", "60 um", THIN, "2 um")
    [warning] = asked(fixed, *question, tolerance=1e-3).warnings
    assert warning.code == "tolerance_unmet"
    assert warning.detail.endswith("not within the tolerance of 0.1 %: the design fixes level fit for film")
    assert asked(fixed, *question, tolerance=0.5).warnings == []


def test_criteria_that_follow_from_unknown_errors_are_named():
    """Petroff's power states an error near its solution only where a load is given."""
    design = {**PETROFF, "criteria": {"cool": {"require": "idle.power_loss <= 1 kW"}}}
    [unknown] = asked(design, "speed", "100 rpm", "20000 rpm", "idle.power_loss", "100 W").roots
    assert (unknown.verdicts["cool"], "cool" in unknown.error_unknown) == ("met", True)
    [known] = asked(FILMS, "clearance", "20 um", "60 um", THIN, "2 um").roots
    assert (known.verdicts["thick"], known.error_unknown) == ("met", [])


def test_what_is_out_of_reach_says_what_can_be_reached():
    with pytest.raises(Unreachable, match=r"out of reach: between the bounds film.minimum_f\w+ is") as out:
        asked(FILMS, "clearance", "2 um", "0.5 mm", THIN, "20 um")
    assert out.value.reachable[1] == pytest.approx(2.2, rel=0.02)


@pytest.mark.parametrize(
    ("change", "name", "words"),
    [
        ({"unknown": "gap"}, "gap", "gap is calculated"),
        ({"unknown": "width"}, "width", "no name|unknown|did you mean"),
        ({"between": ["0.5 mm", "2 um"]}, "between", "below the second"),
        ({"between": ["2 N", "0.5 mm"]}, "between", "length|mm"),
        ({"target": {THIN: "2 N"}}, f"target.{THIN}", "um|length"),
        ({"target": {"film.thickness": "2 um"}}, "film.thickness", "minimum_film_thickness|no"),
    ],
)  # fmt: skip
def test_every_fault_of_a_question_is_named(change, name, words):
    question = {"unknown": "clearance", "between": ["2 um", "0.5 mm"], "target": {THIN: "2 um"}, **change}
    plain = resolved(Document.model_validate(FILMS), CATALOGUES).model_dump(mode="json", by_alias=True)
    with pytest.raises(InvalidInputs, match=words) as refused:
        solved(DesignTask.of(plain, CATALOGUES), 1, json.dumps(question))
    assert [fault.name for fault in refused.value.faults] == [name]


class TestOverHttp:
    def test_a_solution_is_answered_as_the_client_reads_it(self, http, client):
        design = http.post(f"{API}/designs", json=PETROFF).json()["id"]
        body = {
            "unknown": "speed",
            "between": ["100 rpm", "20000 rpm"],
            "target": {"idle.power_loss": "100 W"},
        }
        answer = http.post(f"{API}/designs/{design}/solve", json=body, headers={"Prefer": "wait=30"})
        assert answer.status_code == 200
        solution = client.solve_design(
            design, "speed", ["100 rpm", "20000 rpm"], {"idle.power_loss": "100 W"}
        )
        assert solution.roots == DesignSolution.model_validate(answer.json()).roots

    def test_out_of_reach_is_a_problem_with_the_range(self, http):
        design = http.post(f"{API}/designs", json=PETROFF).json()["id"]
        body = {"unknown": "speed", "between": ["100 rpm", "200 rpm"], "target": {"idle.power_loss": "1 MW"}}
        answer = http.post(f"{API}/designs/{design}/solve", json=body, headers={"Prefer": "wait=30"})
        assert len(problem(answer, 422, "unreachable")["reachable"]) == 2

    def test_faults_of_the_body_are_named(self, http):
        design = http.post(f"{API}/designs", json=PETROFF).json()["id"]
        body = {"unknown": "half", "between": ["100 rpm", "200 rpm"], "target": {"idle.power_loss": "1 W"}}
        answer = http.post(f"{API}/designs/{design}/solve", json=body, headers={"Prefer": "wait=30"})
        assert "half" in faults(answer)


def test_other_values_hold_for_the_question_alone():
    """Petroff's power is proportional to n² r³: at twice the speed a quarter of r³ gives the same."""
    place, between = "radius", ("1 mm", "100 mm")
    idle = {**FRICTION, "journal_diameter": "50 mm", "speed": "3000 rpm"}
    power = evaluate(built_in().get("journal_friction", 1), idle).outputs["power_loss"].value
    target = ("idle.power_loss", f"{power} W")
    plain = asked(PETROFF, place, *between, *target)
    fast = asked(PETROFF, place, *between, *target, **{"with": {"speed": "6000 rpm"}})
    assert plain.roots[0].value == pytest.approx(25, rel=1e-9)
    assert fast.roots[0].value == pytest.approx(25 * 0.25 ** (1 / 3), rel=1e-9)


@pytest.mark.parametrize(("others", "name", "code"), [
    ({"speeed": "1 rpm"}, "with.speeed", "unknown_name"),
    ({"speed": "1 kN"}, "with.speed", "wrong_unit"),
    ({"idle.bearing_width": "1 kN"}, "with.idle.bearing_width", "wrong_unit"),
    ({"radius": "1 mm"}, "with.radius", "conflict"),
])  # fmt: skip
def test_other_values_that_do_not_fit_are_refused(others, name, code):
    with pytest.raises(InvalidInputs) as refused:
        asked(PETROFF, "radius", "1 mm", "100 mm", "idle.power_loss", "5 W", **{"with": others})
    assert [(fault.name, fault.code) for fault in refused.value.faults] == [(name, code)]


def test_other_values_go_over_http(http):
    design = http.post(f"{API}/designs", json=PETROFF).json()["id"]
    body = {"unknown": "radius", "between": ["1 mm", "100 mm"], "target": {"idle.power_loss": "5 W"}}
    slow, fast = (
        http.post(f"{API}/designs/{design}/solve", json={**body, "with": others}).json()
        for others in ({}, {"speed": "6000 rpm"})
    )
    assert fast["roots"][0]["value"] == pytest.approx(slow["roots"][0]["value"] * 0.25 ** (1 / 3), rel=1e-9)
