"""The plan of a study refuses wrong studies, is equal for equal studies, and estimates the time."""

import pytest
from serving import problem
from study_helpers import CLEARANCE, FILM, LOSS, THICKNESS, asked, new_design

from app.catalogue.catalogues import loaded
from app.studies.chunks import explored
from app.studies.estimate import IN_CALL, Pace
from app.studies.plan import planned
from app.studies.task import Task
from templates.core.errors import InvalidInputs

TWO = {**CLEARANCE, "width": {"between": ["14 mm", "24 mm"]}}
FILM_STEP = FILM["steps"]["film"]
SHELL = {
    **FILM,
    "steps": {
        "film": {
            **FILM_STEP,
            "inputs": {**FILM_STEP["inputs"], "radial_load": "= 20 kN + shell.mass * 10 m/s**2"},
        }
    },
    "models": {
        "shell": {
            "id": "plain_bearing",
            "version": 1,
            "parameters": {"inner_diameter": "= diameter", "width": "18 mm"},
        }
    },
}
BORE = {"diameter": {"between": ["46 mm", "50 mm"]}}


def task(document, **body):
    """A study as a process plans it, and the rows of a table."""
    rows = body.pop("rows", None)
    varied = list(rows if rows is not None else body["vary"])
    return Task.of(document, {"design": "x", "outputs": [LOSS], **body}, varied, {}, loaded(())), rows


LONG = [40 + n / 100 for n in range(501)]


@pytest.mark.parametrize(
    ("body", "count", "solids"),
    [
        ({"method": "grid", "vary": {**BORE, **CLEARANCE}, "steps": 720}, 720**2, 720),
        ({"method": "grid", "vary": {"diameter": {"values": [f"{d} mm" for d in LONG]}}}, 501, 501),
        ({"method": "sample", "vary": BORE, "points": 720}, 720, 720),
        ({"method": "sample", "vary": BORE, "points": 10**6}, 10**6, 10**6),
        ({"method": "table", "rows": {"diameter": {"value": LONG, "unit": "mm"}}}, 501, 501),
        ({"method": "optimise", "vary": BORE, "minimise": [LOSS], "points": 4800}, 4800, 4800),
    ],
    ids=["grid", "values", "sample", "million", "table", "optimise"],
)
def test_a_study_that_needs_too_many_solids_says_how_many(body, count, solids):
    with pytest.raises(InvalidInputs) as refused:
        planned(*task(SHELL, **body), 10.0)
    (fault,) = refused.value.faults
    assert (fault.name, fault.code) == ("diameter", "needs_solids")
    assert f"{count} rows need up to {solids} solids; " in fault.detail


@pytest.mark.parametrize(
    ("body", "solids"),
    [
        ({"method": "grid", "vary": {**BORE, **CLEARANCE}, "steps": {"diameter": 9, "clearance": 400}}, 9),
        ({"method": "sample", "vary": BORE, "points": 500}, 500),
        ({"method": "table", "rows": {"diameter": {"value": [46, 47, 46], "unit": "mm"}}}, 2),
        ({"method": "sensitivity", "vary": BORE}, 3),
        ({"method": "sample", "vary": CLEARANCE, "points": 5000}, 1),
    ],
    ids=["grid", "sample", "table", "local", "one for all rows"],
)
def test_distinct_solids_are_counted_and_their_time_is_estimated(body, solids):
    plan, _ = planned(*task(SHELL, **body), 10.0)
    assert plan.solids == solids
    assert plan.seconds > 10.0 * solids
    assert plan.share(plan.rows, solids) == pytest.approx(1.0)
    assert plan.share(0, 0) == 0.0


def test_rounded_parameters_make_few_solids_of_many_rows():
    document = {**SHELL, "models": {"shell": {**SHELL["models"]["shell"]}}}
    rounded = {"inner_diameter": "= min(diameter, 47 mm)", "width": "18 mm"}
    document["models"]["shell"]["parameters"] = rounded
    values = [f"{40 + n / 50} mm" for n in range(1000)]
    plan, _ = planned(*task(document, method="grid", vary={"diameter": {"values": values}}), 10.0)
    assert plan.solids == 351


def test_a_study_whose_outputs_need_no_solid_needs_none():
    """Only what the study names counts: the shell's mass is used, but not for its clearance."""
    document = {**SHELL, "parameters": {**SHELL["parameters"], "unused": "= shell.mass * 2"}}
    plan, _ = planned(*task(document, method="sample", vary=BORE, points=5000, outputs=["shell.width"]), 10.0)
    assert plan.solids == 0


def test_a_design_that_iterates_builds_no_solid_for_a_row():
    document = {**SHELL, "iterations": [{"through": "shell.mass", "start": "0.1 kg"}]}
    with pytest.raises(InvalidInputs) as refused:
        planned(*task(document, method="sample", vary=BORE, points=5), 10.0)
    (fault,) = refused.value.faults
    assert fault.code == "needs_solids"
    assert "iterates through shell.mass" in fault.detail


@pytest.mark.parametrize("steps", [None, -(10**400), 10**400])
def test_a_number_of_rows_that_no_study_takes_is_refused(steps):
    with pytest.raises(InvalidInputs) as refused:
        planned(*task(SHELL, method="grid", vary=BORE, steps=steps), 10.0)
    assert {fault.code for fault in refused.value.faults} <= {"missing", "too_many_rows"}


def test_the_interface_says_how_many_solids(http):
    answer = asked(http, new_design(http, SHELL), method="sample", vary=BORE, points=720, outputs=[LOSS])
    (fault,) = problem(answer, 422, "invalid-inputs")["errors"]
    assert fault["code"] == "needs_solids"
    assert "720 rows need up to 720 solids" in fault["detail"]


@pytest.mark.slow
def test_a_plan_does_not_follow_from_what_was_measured_before():
    asked_for, rows = task(
        FILM, method="sample", points=9000, vary=TWO, outputs=[THICKNESS], confirm={"tolerance": 0.001}
    )
    first, _ = planned(asked_for, rows, 10.0)
    explored(asked_for, 0, 4096, first.levels, tuple(first.criteria))
    again, _ = planned(asked_for, rows, 10.0)
    assert (again.chunk, again.confirm_chunk) == (first.chunk, first.confirm_chunk)
    assert again.levels == first.levels


def test_a_pace_counts_calls_and_rows():
    pace = Pace(call=0.5, row=0.001)
    assert pace.seconds(2 * IN_CALL + 1) == pytest.approx(1.5 + 0.001 * (2 * IN_CALL + 1))
    assert pace.seconds(800, 100) == pytest.approx(50.8)


def test_more_rows_are_estimated_to_take_longer():
    def seconds(points):
        return planned(*task(FILM, method="sample", points=points, vary=TWO), 10.0)[0].seconds

    assert seconds(10**6) > 10 * seconds(1000)
