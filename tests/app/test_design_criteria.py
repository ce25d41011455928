"""Criteria of designs without a server: names, units, waivers, propagated errors."""

import pytest

from app.calculations.json_values import rendered
from app.designs import results
from app.designs.document import Document, merge
from app.designs.engine.calculate import calculate
from app.designs.engine.verdicts import judged
from app.designs.graph import Catalogues, build_graph
from app.designs.service import resolved
from cad.catalogue import models
from templates.door import built_in

CATALOGUES = Catalogues(built_in(), models())
OIL_FILM = built_in().get("oil_film", 2)
FILM = dict(OIL_FILM.example)


def film(level="fit", **more):
    return {"template": "oil_film", "version": 2, "level": level, "inputs": {**FILM, **more}}


def document(criteria=None, **more):
    steps = more.pop("steps", {"film": film()})
    return {"name": "bearing", "steps": steps, "criteria": criteria or {}, **more}


def graph_of(raw):
    return build_graph(resolved(Document.model_validate(raw), CATALOGUES), CATALOGUES)


def calculated(raw):
    graph, faults = graph_of(raw)
    assert not faults
    result = calculate(graph, lambda shape: None, lambda *question: None)
    assert not result.faults
    return result


def verdicts(raw):
    return {judgement.name: judgement for judgement in judged(calculated(raw))}


def faults_of(raw):
    return {fault.name: fault for fault in graph_of(raw)[1]}


def test_analytic_own_criterion_of_a_design():
    """At level fit the film is 2.7467 um, off by 4.7 %: 2.6234 … 2.8822 um."""
    judged = verdicts(
        document(
            {
                "low": {"require": "film.minimum_film_thickness >= 2.6 um", "source": "me"},
                "near": {"require": "film.minimum_film_thickness >= 2.7 um"},
                "high": {"require": "film.minimum_film_thickness >= 3 um", "words": "thick enough"},
                "load": {"require": "film.radial_load <= 25 kN"},
            }
        )
    )
    assert {name: judged[name].verdict for name in ("low", "near", "high", "load")} == {
        "low": "met",
        "near": "undecided",
        "high": "not_met",
        "load": "met",
    }
    low = judged["low"]
    assert (low.source, low.unit, low.level) == ("me", "um", "fit")
    assert low.band == pytest.approx((2.6234, 2.8822), abs=1e-4)
    assert low.truth
    assert judged["high"].words == "thick enough"
    assert judged["near"].words == "minimum film thickness ≥ 2.7 um"


def test_criteria_of_templates_have_the_step_in_their_names_and_take_its_limits():
    judged = verdicts(document(steps={"film": {**film(), "limits": {"permissible_film": "2 um"}}}))
    assert (judged["film.own_film"].verdict, judged["film.own_film"].limit) == ("met", pytest.approx(2))
    assert judged["film.pressure_times_speed"].give == ("film.permissible_pressure_times_speed",)


def test_a_waived_criterion_is_judged_all_the_same():
    raw = document({"film.film": {"waived": "accepted in test 12"}})
    found = verdicts(raw)
    assert (found["film.film"].verdict, found["film.film"].waived) == ("not_met", "accepted in test 12")
    assert not rendered(judged(calculated(raw)))["verdict"]["green"]


def test_an_overridden_criterion_demands_what_the_design_says():
    require = "film.minimum_film_thickness >= 1 um"
    judged = verdicts(document({"film.film": {"require": require, "source": "our handbook"}}))
    assert (judged["film.film"].verdict, judged["film.film"].limit) == ("met", pytest.approx(1))
    assert (judged["film.film"].source, judged["film.film"].unverified) == ("our handbook", None)


def test_an_output_that_a_criterion_needs_is_computed_although_the_step_leaves_it_out():
    step = {**film(), "outputs": ["relative_eccentricity"]}
    raw = document({"own": {"require": "film.minimum_film_thickness >= 2 um"}}, steps={"film": step})
    assert verdicts(raw)["own"].verdict == "met"


@pytest.mark.parametrize(
    ("criteria", "name", "code"),
    [
        ({"own": {"require": "film.minimum_film_thicknes >= 2 um"}}, "criteria.own", "unknown_name"),
        ({"own": {"require": "film.oil_grade >= 2"}}, "criteria.own", "unknown_name"),
        ({"own": {"require": "film.lubrication_regime >= 2"}}, "criteria.own", "unknown_name"),
        ({"own": {"require": "film.minimum_film_thickness >= 2 s"}}, "criteria.own", "unit_mismatch"),
        ({"own": {"require": "film.minimum_film_thickness > 2 um"}}, "criteria.own", "syntax"),
        ({"own": {"source": "me"}}, "criteria.own", "missing"),
        ({"film.fil": {"waived": "yes"}}, "criteria.film.fil", "unknown_name"),
        (
            {"fil.film": {"require": "film.minimum_film_thickness >= 2 um"}},
            "criteria.fil.film",
            "unknown_name",
        ),
    ],
)
def test_a_wrong_criterion_is_a_fault_of_its_place(criteria, name, code):
    faults = faults_of(document(criteria))
    assert list(faults) == [name]
    assert faults[name].code == code


def test_all_wrong_criteria_are_named_at_once():
    raw = document({"a": {"require": "film.x >= 1"}, "b": {"require": "film.y >= 1"}})
    assert set(faults_of(raw)) == {"criteria.a", "criteria.b"}


@pytest.mark.parametrize(
    ("limits", "code"),
    [
        ({"permissible_fil": "2 um"}, "unknown_name"),
        ({"permissible_film": "2 s"}, "wrong_unit"),
        ({"permissible_film": "= 2 s"}, "unit_mismatch"),
        ({"bearing_material": "cheese"}, "unknown_name"),
    ],
)
def test_wrong_limits_of_a_step_are_faults_of_their_place(limits, code):
    faults = faults_of(document(steps={"film": {**film(), "limits": limits}}))
    assert list(faults) == [f"film.limits.{next(iter(limits))}"]
    assert next(iter(faults.values())).code == code


def test_relations_and_criteria_together_are_limited_in_length():
    long = {
        f"c{n}": {"require": "film.minimum_film_thickness >= " + "1 um + " * 250 + "1 um"} for n in range(40)
    }
    assert faults_of(document(long))["design"].code == "too_long"


def test_a_document_without_criteria_or_limits_is_that_of_before():
    plain = Document.model_validate({"name": "a", "steps": {"film": film()}}).model_dump(mode="json")
    assert "criteria" not in plain
    assert "limits" not in plain["steps"]["film"]


def test_a_patch_replaces_a_criterion_whole_and_null_removes_it():
    first = {"require": "film.minimum_film_thickness >= 2 um", "source": "me"}
    raw = document({"own": first, "other": first})
    changed = merge(raw, {"criteria": {"own": {"require": "film.power_loss <= 1 kW"}, "other": None}})
    assert changed["criteria"] == {"own": {"require": "film.power_loss <= 1 kW"}}
    limits = merge(raw, {"steps": {"film": {"limits": {"permissible_film": "2 um"}}}})
    assert limits["steps"]["film"]["limits"] == {"permissible_film": "2 um"}
    assert limits["steps"]["film"]["inputs"] == raw["steps"]["film"]["inputs"]


def test_what_a_revision_stores_is_what_was_judged():
    raw = document({"own": {"require": "film.minimum_film_thickness >= 2 um"}})
    result = calculated(raw)
    stored = results.stored(result, [])
    assert stored["criteria"] == rendered(judged(result))["criteria"]
    assert stored["criteria"][0]["name"] == stored["verdict"]["governing"]
    assert "criteria" not in stored["steps"]["film"]
    assert stored == results.stored(calculated(raw), [])  # equal revisions are equal


def test_a_criterion_that_is_not_met_warns_once_in_its_step():
    steps = calculated(document(steps={"film": film(radial_load="2500 kN")}))
    codes = [w["code"] for w in results.stored(steps, [])["steps"]["film"]["warnings"]]
    assert codes.count("film_below_roughness") == 1
