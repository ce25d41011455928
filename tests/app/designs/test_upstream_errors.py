"""Errors of upstream steps are propagated to a design's criteria, or named."""

import numpy as np
import pytest
from test_design_criteria import FILM, OIL_FILM, document, film, graph_of, verdicts

from app.designs.engine.calculate import calculate
from app.designs.engine.verdicts import judged
from templates.core.language.evaluate import evaluate
from templates.door import built_in


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
    assert judgement.error_known


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


def test_an_unknown_error_upstream_is_named():
    raw = chain()
    raw["steps"]["film"]["inputs"]["bearing_width"] = "7 mm"  # B/D 0.146
    raw["steps"]["friction"] = friction("= film.minimum_film_thickness * 10")
    required = {"loss": {"require": "next.minimum_film_thickness >= friction.friction_force * 1 um/N"}}
    judgement = verdicts(document(required, **raw))["loss"]
    assert (judgement.verdict, judgement.error_known) == ("not_met", False)  # no load, no error of friction
    assert "friction: friction force" in judgement.reason


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
    assert not judgement.error_known
    assert "crank: stiffness carter" in judgement.reason


def test_an_expensive_step_carries_no_error_and_says_so():
    raw = chain()
    raw["steps"]["next"]["level"] = "mass_conserving"
    judgement = verdicts(document(REQUIRED, **raw))["next"]
    assert (judgement.verdict, judgement.error_known) == ("met", False)
    assert "film: minimum film thickness" in judgement.reason


def test_a_value_refused_at_an_end_of_the_band_has_no_known_error():
    """At short_bearing the first film may be 27.5 um: 2000 times that is more than the bore of the second."""
    raw = chain("short_bearing")
    raw["parameters"]["ratio"] = "2000"
    judgement = verdicts(document({"next": {"require": "next.minimum_film_thickness >= 1 nm"}}, **raw))[
        "next"
    ]
    assert (judgement.verdict, judgement.error_known, judgement.band) == ("met", False, None)


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
    assert (end.verdict, end.unit) == ("met", "mm")
    assert np.array(end.band) * 1e3 == pytest.approx(alone.band)


def test_only_so_many_outputs_are_carried_and_the_others_are_named():
    outputs = [name for name, error in film_errors().items() if error][:14]
    assert len(outputs) == 14
    sum_of_all = " + ".join(f"0 * film.{name} / film.{name}" for name in outputs)
    parameters = {"factor": f"= 1 + {sum_of_all}"}
    steps = {"film": film("map")}
    raw = document({"own": {"require": "factor >= 0.5"}}, parameters=parameters, steps=steps)
    own = verdicts(raw)["own"]
    assert (own.verdict, own.error_known) == ("met", False)
    assert sum(f"film: {name}".replace("_", " ") in own.reason for name in outputs) == 2


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
    assert (judgement.verdict, judgement.error_known) == ("met", False)
    assert "film: minimum film thickness" in judgement.reason


def test_property_a_band_is_never_narrower_than_without_upstream_errors():
    shifted, alone = (verdicts(document(REQUIRED, **chain(level)))["next"] for level in ("fit", "map"))
    widths = [np.diff(judgement.band)[0] / judgement.value for judgement in (shifted, alone)]
    assert widths[0] > widths[1]
