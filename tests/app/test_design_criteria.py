"""Criteria of designs, calculated without a server: names, units, waivers, errors carried downstream."""

import numpy as np
import pytest

from app.calculations.criteria import rendered
from app.designs import results
from app.designs.calculate import calculate
from app.designs.document import Document, merge
from app.designs.graph import Catalogues, build_graph
from app.designs.judging import judged
from app.designs.service import resolved
from cad.catalogue import models
from templates.core.language.evaluate import evaluate
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
    found = verdicts(
        document(
            {
                "low": {"require": "film.minimum_film_thickness >= 2.6 um", "source": "me"},
                "near": {"require": "film.minimum_film_thickness >= 2.7 um"},
                "high": {"require": "film.minimum_film_thickness >= 3 um", "words": "thick enough"},
                "load": {"require": "film.radial_load <= 25 kN"},
            }
        )
    )
    assert {name: found[name].verdict for name in ("low", "near", "high", "load")} == {
        "low": "met",
        "near": "undecided",
        "high": "not_met",
        "load": "met",
    }
    low = found["low"]
    assert (low.source, low.unit, low.level) == ("me", "um", "fit")
    assert low.band == pytest.approx((2.6234, 2.8822), abs=1e-4)
    assert low.truth
    assert found["high"].words == "thick enough"
    assert found["near"].words == "minimum film thickness ≥ 2.7 um"


def test_criteria_of_templates_have_the_step_in_their_names_and_take_its_limits():
    found = verdicts(document(steps={"film": {**film(), "limits": {"permissible_film": "2 um"}}}))
    assert (found["film.own_film"].verdict, found["film.own_film"].limit) == ("met", pytest.approx(2))
    assert found["film.pressure_times_speed"].give == ("film.permissible_pressure_times_speed",)


def test_a_waived_criterion_is_judged_all_the_same():
    raw = document({"film.film": {"waived": "accepted in test 12"}})
    found = verdicts(raw)
    assert (found["film.film"].verdict, found["film.film"].waived) == ("not_met", "accepted in test 12")
    assert not rendered(judged(calculated(raw)))["verdict"]["green"]


def test_an_overridden_criterion_demands_what_the_design_says():
    require = "film.minimum_film_thickness >= 1 um"
    found = verdicts(document({"film.film": {"require": require, "source": "our handbook"}}))
    assert (found["film.film"].verdict, found["film.film"].limit) == ("met", pytest.approx(1))
    assert (found["film.film"].source, found["film.film"].unverified) == ("our handbook", None)


def test_an_output_that_a_criterion_needs_is_computed_although_the_step_leaves_it_out():
    step = {**film(), "outputs": ["relative_eccentricity"]}
    raw = document({"own": {"require": "film.minimum_film_thickness >= 2 um"}}, steps={"film": step})
    assert verdicts(raw)["own"].verdict == "met"


def chain(level="fit", **second):
    """A second bearing whose clearance is 20 times the smallest film of the first."""
    clearance = "= film.minimum_film_thickness * ratio"
    return {
        "parameters": {"ratio": "20"},
        "steps": {"film": film(level), "next": film("fit", diametral_clearance=clearance, **second)},
    }


REQUIRED = {"next": {"require": "next.minimum_film_thickness >= 1 um"}}


def smallest(level, clearance_um):
    inputs = {**FILM, "diametral_clearance": f"{float(clearance_um)!r} um"}
    result = evaluate(OIL_FILM, inputs, outputs=["minimum_film_thickness"], level=level)
    return result.outputs["minimum_film_thickness"].value, result.error["minimum_film_thickness"]


def test_an_error_upstream_is_carried_by_shifting_it_to_both_ends():
    judgement = verdicts(document(REQUIRED, **chain()))["next"]
    first, error = smallest("fit", 55.0)
    value, own = smallest("fit", 20 * first)
    ends = [smallest("fit", 20 * first / (1 + sign * error))[0] for sign in (1, -1)]
    low = value / (1 + own) + min(0, *(end - value for end in ends))
    high = value / (1 - own) + max(0, *(end - value for end in ends))
    assert judgement.value == pytest.approx(value)
    assert judgement.band == pytest.approx((low, high))
    assert judgement.relative_error == pytest.approx(max(1 - value / high, value / low - 1))
    assert judgement.is_stated


def test_what_does_not_follow_from_an_uncertain_value_has_no_share_of_its_error():
    raw = document({"speed": {"require": "next.sliding_speed <= 1000 rpm"}}, **chain())
    judgement = verdicts(raw)["speed"]
    assert judgement.band == (judgement.value, judgement.value)


def test_both_sides_of_a_criterion_have_the_error_of_what_they_follow_from():
    raw = document({"pair": {"require": "film.power_loss >= ratio * 30 W"}}, **chain())
    alone = verdicts(raw)["pair"]
    follows = {"pair": {"require": "film.power_loss >= next.power_loss"}}
    both = verdicts(document(follows, **chain()))["pair"]
    assert alone.band == pytest.approx(both.band)
    assert both.verdict == "undecided"


def test_an_unknown_error_upstream_leaves_it_undecided():
    raw = chain()
    raw["steps"]["film"]["inputs"]["bearing_width"] = "7 mm"  # B/D 0.146
    raw["steps"]["friction"] = friction("= film.minimum_film_thickness * 10")
    required = {"loss": {"require": "next.minimum_film_thickness >= friction.friction_force * 1 um/N"}}
    judgement = verdicts(document(required, **raw))["loss"]
    assert judgement.verdict == "undecided"  # without a load the error of journal_friction is not known
    assert "friction.friction_force" in judgement.reason


def friction(clearance):
    inputs = {
        "journal_diameter": "48 mm",
        "bearing_width": "18 mm",
        "radial_clearance": clearance,
        "speed": "5000 rpm",
        "dynamic_viscosity": "18 mPa*s",
    }
    return {"template": "journal_friction", "version": 1, "inputs": inputs}


def test_an_error_that_nobody_stated_upstream_is_said():
    crank = {"template": "crank_stiffness", "version": 1}
    crank["inputs"] = dict(built_in().get("crank_stiffness", 1).example)
    load = "= 25 kN * crank.stiffness_carter / crank.stiffness_wilson"
    required = {"own": {"require": "film.minimum_film_thickness >= 0.1 um"}}
    raw = document(required, steps={"crank": crank, "film": film(radial_load=load)})
    judgement = verdicts(raw)["own"]
    assert not judgement.is_stated
    assert "crank.stiffness_carter" in judgement.reason


def test_an_expensive_step_carries_no_error_and_says_so():
    raw = chain()
    raw["steps"]["next"]["level"] = "mass_conserving"
    judgement = verdicts(document(REQUIRED, **raw))["next"]
    assert (judgement.verdict, judgement.is_stated) == ("met", False)
    assert "film.minimum_film_thickness" in judgement.reason


def test_a_value_refused_at_an_end_of_the_band_is_not_decided():
    """At short_bearing the first film may be 27.5 um: 2000 times that is more than the bore of the second."""
    raw = chain("short_bearing")
    raw["parameters"]["ratio"] = "2000"
    judgement = verdicts(document({"next": {"require": "next.minimum_film_thickness >= 1 nm"}}, **raw))[
        "next"
    ]
    assert (judgement.verdict, judgement.band) == ("undecided", None)


def test_arrays_upstream_are_shifted_row_by_row():
    loads = {"value": [10, 25, 40], "unit": "kN"}
    raw = chain()
    raw["steps"]["film"]["inputs"]["radial_load"] = loads
    limit = {"next": {"require": "next.minimum_film_thickness >= 2.5 um"}}
    together = verdicts(document(limit, **raw))["next"]
    single = []
    for load in loads["value"]:
        raw["steps"]["film"]["inputs"]["radial_load"] = f"{load} kN"
        single.append(verdicts(document(limit, **raw))["next"])
    assert [int(row) for row in together.rows] == [judgement.rows for judgement in single]
    worst = single[together.where[0].value - 1]
    assert together.band == pytest.approx(worst.band)
    assert len({judgement.verdict for judgement in single}) > 1


def test_a_chain_of_parameters_may_be_long():
    links = {f"p{n}": f"= p{n - 1} + 0 um" for n in range(1, 400)}
    parameters = {"p0": "= film.minimum_film_thickness", **links}
    raw = document({"end": {"require": "p399 >= 2.6 um"}}, parameters=parameters)
    end = verdicts(raw)["end"]
    alone = verdicts(document({"end": {"require": "film.minimum_film_thickness >= 2.6 um"}}))["end"]
    assert (end.verdict, end.unit) == ("met", "m")
    assert np.array(end.band) * 1e6 == pytest.approx(alone.band)


def test_only_so_many_outputs_are_carried_and_the_others_are_named():
    outputs = [name for name, error in film_errors().items() if error][:14]
    assert len(outputs) == 14
    sum_of_all = " + ".join(f"0 * film.{name} / film.{name}" for name in outputs)
    parameters = {"factor": f"= 1 + {sum_of_all}"}
    steps = {"film": film("map")}
    raw = document({"own": {"require": "factor >= 0.5"}}, parameters=parameters, steps=steps)
    own = verdicts(raw)["own"]
    assert (own.verdict, own.is_stated) == ("met", False)
    assert sum(f"film.{name}" in own.reason for name in outputs) == 2


def film_errors():
    """The stated errors of the outputs of the film by name; none of texts."""
    errors = evaluate(OIL_FILM, FILM, level="map").error
    return {
        n: e for n, e in errors.items() if e == e and n not in ("boundary_condition", "lubrication_regime")
    }


def test_what_waits_for_a_solid_is_not_checked():
    shell = {"shell": {"id": "plain_bearing", "parameters": {"inner_diameter": "= film.bearing_diameter"}}}
    raw = document({"mass": {"require": "shell.mass <= 1 kg"}}, models=shell)
    judgement = verdicts(raw)["mass"]
    assert (judgement.verdict, judgement.limit) == ("not_checked", 1)
    assert "shell.mass waits" in judgement.reason


def test_no_error_is_carried_through_a_solid():
    shell = {
        "shell": {
            "id": "plain_bearing",
            "parameters": {"inner_diameter": "= film.minimum_film_thickness * 20000"},
        }
    }
    raw = document({"mass": {"require": "shell.mass <= 1 kg"}}, models=shell)
    graph, faults = graph_of(raw)
    assert not faults
    measures = {"mass": 0.5, "volume": 1.0}
    result = calculate(graph, lambda shape: measures, lambda *question: None)
    (judgement,) = [j for j in judged(result) if j.name == "mass"]
    assert (judgement.verdict, judgement.is_stated) == ("met", False)
    assert "film.minimum_film_thickness" in judgement.reason


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


def test_property_a_band_is_never_narrower_than_without_upstream_errors():
    shifted, alone = (verdicts(document(REQUIRED, **chain(level)))["next"] for level in ("fit", "map"))
    widths = [np.diff(judgement.band)[0] / judgement.value for judgement in (shifted, alone)]
    assert widths[0] > widths[1]
