"""Limits of a step that are relations: values, upstream errors, waiting, faults; also over HTTP."""

from types import SimpleNamespace

import numpy as np
import pytest
from test_design_criteria import CATALOGUES, calculated, document, faults_of, film, graph_of, verdicts

from app.designs.document import Document, merge
from app.designs.drives import network_of
from app.designs.engine.calculate import calculate
from app.designs.engine.columns import RowEstimate
from app.designs.engine.design_engine import DesignEngine
from app.designs.engine.shifts import Upstream
from app.designs.engine.verdicts import _operations
from app.reference import Reference
from templates.core.criteria.bands import Estimate
from templates.core.criteria.comparison import VERDICTS

RELATED = {"permissible_film": "= share * least"}
PARAMETERS = {"least": "4 um", "share": "0.5"}


def related(limits=RELATED, parameters=PARAMETERS, level="fit", **steps):
    raw = document(parameters=parameters, steps={"film": {**film(level), "limits": limits}, **steps})
    return raw


def test_analytic_limit_by_a_relation():
    """At level fit the film is 2.7467 um; half of 4 um is below its band, all of 4 um above it."""
    judged = verdicts(related())["film.own_film"]
    assert (judged.verdict, judged.limit, judged.unit) == ("met", pytest.approx(2, abs=1e-12), "um")
    assert judged.source.endswith("permissible_film = share * least")
    assert verdicts(related(parameters={**PARAMETERS, "share": "1"}))["film.own_film"].verdict == "not_met"


def test_analytic_a_criterion_is_compared_once_and_shifted_twice_by_each_error():
    """100 points, three operations on each: as they are, and up and down for one estimate and two outputs."""
    criterion = SimpleNamespace(value=SimpleNamespace(parts=2), limit=SimpleNamespace(parts=1))
    upstream = Upstream(uncertain=frozenset(map(Reference.parse, ("warm.clearance", "loads.force"))))
    estimates = {"film": RowEstimate(Estimate(np.ones(100), np.zeros(100)))}
    assert _operations(criterion, estimates, upstream) == 100 * 3 * (1 + 2 * (1 + 2))


def test_the_error_of_a_limit_counts():
    """The first film is 2.7467 um at level fit, off by 4.7 %; so is a limit of the second that it sets.

    The second film is that of level map and is exact beside it. A hand calculation of the band decides.
    """
    factor = 0.98  # the first film times this, and its 4.7 %, spans the second film
    limits = {"permissible_film": f"= {factor} * film.minimum_film_thickness"}
    steps = {"film": film("fit"), "next": {**film("map"), "limits": limits}}
    judged = verdicts(document(steps=steps))["next.own_film"]
    assert judged.verdict == "undecided"
    exact = {"permissible_film": f"{judged.limit} um"}
    same = verdicts(document(steps={**steps, "next": {**film("map"), "limits": exact}}))["next.own_film"]
    assert same.limit == pytest.approx(judged.limit, rel=1e-12)
    assert same.verdict in ("met", "not_met")  # the same number by hand is exact


def test_a_limit_may_follow_from_its_own_step():
    judged = verdicts(related({"permissible_film": "= film.smallest_permissible_film"}))["film.own_film"]
    other = verdicts(document())["film.film"]
    assert judged.limit == pytest.approx(other.limit, rel=1e-12)


def test_an_output_that_only_a_limit_uses_is_computed():
    limits = {"permissible_film": "= film.diametral_clearance / 2 * (1 - film.relative_eccentricity)"}
    step = {**film(), "outputs": ["minimum_film_thickness"], "limits": limits}
    judged = verdicts(document(steps={"film": step}))["film.own_film"]
    assert judged.limit == pytest.approx(judged.value, rel=1e-9)


def test_a_relation_wins_over_a_row_of_the_library():
    limits = {"bearing_material": "tin_bronze", "permissible_pressure": "= 2 * bearing_strength"}
    raw = related(limits, {"bearing_strength": "10 MPa"})
    assert verdicts(raw)["film.pressure"].limit == pytest.approx(20)


def test_a_limit_that_waits_for_a_solid_is_not_checked_although_a_row_has_a_value():
    limits = {"bearing_material": "tin_bronze", "permissible_pressure": "= model.mass / (1 kg) * (1 MPa)"}
    raw = related(limits, {}) | {"models": {"model": {"id": "plain_bearing", "parameters": SHELL}}}
    judged = verdicts(raw)["film.pressure"]
    assert (judged.verdict, judged.limit) == ("not_checked", None)
    assert "film.limits.permissible_pressure has no value yet" in judged.reason


SHELL = {"inner_diameter": "48 mm", "width": "18 mm", "wall": "3 mm"}


@pytest.mark.parametrize(
    ("limit", "code"),
    [
        ("= leats", "unknown_name"),
        ("= share", "unit_mismatch"),
        ("= least +", "syntax"),
        ("= least / (share - share)", "not_finite"),
    ],
)
def test_a_wrong_relation_is_a_fault_of_the_limit(limit, code):
    raw = related({"permissible_film": limit})
    graph, faults = graph_of(raw)
    faults = faults or calculate(graph, lambda shape: None, lambda *question: None).faults
    assert {fault.name: fault.code for fault in faults} == {"film.limits.permissible_film": code}


def test_a_row_of_the_library_is_no_relation():
    assert list(faults_of(related({"bearing_material": "= least"}))) == ["film.limits.bearing_material"]


def test_relations_of_limits_are_counted_with_all_others():
    limits = {"permissible_film": "= " + "1 um + " * 9000 + "1 um"}
    assert faults_of(related(limits))["design"].code == "too_long"


def test_what_drives_what_shows_what_drives_a_limit_from_outside():
    limits = {"permissible_film": "= share * film.smallest_permissible_film"}
    relations = network_of(calculated(related(limits)).graph).relations
    assert [(one.target, one.source) for one in relations] == [("film.limits.permissible_film", "share")]


def test_rows_are_judged_as_designs_of_their_own():
    """Limits by relations, and films without a threshold of whirl, in one array call."""
    steps = {
        "film": {**film("map"), "limits": {**RELATED, "bearing_material": "tin_bronze"}},
        "next": {**film("map"), "limits": {"permissible_film": "= 0.98 * film.minimum_film_thickness"}},
    }
    raw = document(parameters=PARAMETERS, steps=steps)
    load, share = Reference("film", None, "radial_load"), Reference("share")
    rows = {load: np.array([1e3, 6e3, 25e3, 60e3]), share: np.array([0.5, 0.6, 0.8, 0.9])}
    table = DesignEngine.of(Document.model_validate(raw), CATALOGUES, rows)(rows, [], judge=True)
    words = {name: [VERDICTS[code] for code in codes] for name, codes in table.verdicts.items()}
    assert set(words["film.own_film"]) == {"met", "not_met"}
    for row in range(4):
        one = merge(raw, {"parameters": {"share": repr(float(rows[share][row]))}})
        one = merge(one, {"steps": {"film": {"inputs": {"radial_load": f"{rows[load][row]} N"}}}})
        single = {name: judged.verdict for name, judged in verdicts(one).items()}
        assert single == {name: column[row] for name, column in words.items()}
