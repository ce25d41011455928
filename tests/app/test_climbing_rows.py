"""Rows of a design that are decided at the least cost: equal to the template's own, and to finer levels."""

import copy

import numpy as np
import pytest
from row_designs import BEARING, CURVES, FILM, net_of, ref, spread

from app.designs.climbing_rows import decide_rows
from templates.core.errors import InvalidInputs
from templates.core.judging.comparison import MET, NOT_CHECKED, NOT_MET, UNDECIDED
from templates.core.language.deciding import decide_rows as decide_template
from templates.door import built_in


def bearing(criteria=None, **film):
    """A bearing at a given viscosity, with a permissible film."""
    raw = copy.deepcopy(BEARING)
    step = raw["steps"]["film"]
    step["inputs"] = {**step["inputs"], "dynamic_viscosity": "10 mPa*s", **film}
    del step["inputs"]["supply_temperature"]
    step["limits"] = {"permissible_film": "2.5 um"}
    raw["criteria"] = criteria or {}
    return raw


def test_verdicts_equal_those_of_the_template_alone():
    net = net_of(bearing(), "diameter", "width", "clearance", "load")
    rows = spread(net, 300, 0.7, 1.3)
    decided = decide_rows(net, rows, ["film.own_film"])
    names = {"diameter": "bearing_diameter", "width": "bearing_width", "clearance": "diametral_clearance"}
    raw = {name: {"value": rows[ref(place)].tolist(), "unit": "m"} for place, name in names.items()} | {
        "radial_load": {"value": rows[ref("load")].tolist(), "unit": "N"},
        "speed": "5000 rpm",
        "dynamic_viscosity": "10 mPa*s",
    }
    template = built_in().get("oil_film", 2)
    alone = decide_template(template, raw, "own_film", limits={"permissible_film": "2.5 um"})
    np.testing.assert_array_equal(decided.verdicts["film.own_film"], alone.codes)
    assert [trial.rows for trial in decided.trials] == [trial.rows for trial in alone.trials]
    assert decided.levels["film"].tolist() == alone.levels.tolist()
    assert decided.stopped == "decided"
    assert {MET, NOT_MET} == set(decided.verdicts["film.own_film"].tolist())


def test_no_verdict_is_contradicted_by_the_finest_level():
    net = net_of(
        bearing({"film": {"require": "film.minimum_film_thickness >= 2.8 um"}}), "clearance", "width"
    )
    rows = spread(net, 24, 0.8, 1.2)
    decided = decide_rows(net, rows, ["film"])
    truth = net(rows, [FILM], levels={"film": "reynolds"}).columns[FILM] >= 2.8e-6
    codes = decided.verdicts["film"]
    assert not (codes == UNDECIDED).any()
    np.testing.assert_array_equal(codes == MET, truth)
    assert decided.trials[0].rows == 24
    assert [trial.rows for trial in decided.trials] == sorted((t.rows for t in decided.trials), reverse=True)


def test_verdicts_are_those_of_each_row_at_its_level():
    """Two steps, of which the second follows from the first."""
    raw = bearing({"second": {"require": "second.minimum_film_thickness >= 2.3 um"}})
    raw["steps"]["second"] = copy.deepcopy(raw["steps"]["film"])
    raw["steps"]["second"]["inputs"]["radial_load"] = "= load * (film.minimum_film_thickness / 2.5 um)**0.2"
    net = net_of(raw, "clearance", "load")
    rows = spread(net, 60, 0.8, 1.2)
    decided = decide_rows(net, rows, ["second", "film.own_film"])
    assert decided.stopped == "decided"
    assert len(decided.trials) > 2
    for row in range(60):
        levels = {step: column[row] for step, column in decided.levels.items()}
        one = {place: column[row : row + 1] for place, column in rows.items()}
        table = net(one, [], criteria=["second", "film.own_film"], levels=levels, judge=True)
        for name, codes in decided.verdicts.items():
            if table.verdicts[name][0] != UNDECIDED:
                assert codes[row] == table.verdicts[name][0]
            else:  # it was decided at an earlier level of the other step
                assert codes[row] in (MET, NOT_MET)
    for name, codes in decided.verdicts.items():
        margin = decided.judged[name].margin
        assert (margin[codes == MET] >= 0).all()
        assert (margin[codes == NOT_MET] < 0).all()


def test_rows_that_a_cheap_level_refuses_climb():
    """Level fit is refused above B/D = 1; nothing answers a width below zero, and that does not climb."""
    net = net_of(bearing(), "width")
    rows = {ref("width"): np.array([0.018, 0.06, -0.018])}
    decided = decide_rows(net, rows, ["film.own_film"], levels={"film": "fit"})
    assert decided.verdicts["film.own_film"][1] in (MET, NOT_MET)
    assert decided.levels["film"].tolist()[1:] == ["map", None]
    assert decided.verdicts["film.own_film"][2] == NOT_CHECKED
    assert all(trial.levels["film"] != "reynolds" for trial in decided.trials)


def test_supply_pressure_in_one_row_takes_all_rows_to_the_level_that_knows_it():
    net = net_of(bearing(), "film.supply_pressure")
    rows = {ref("film.supply_pressure"): np.array([0.0, 1e5])}
    decided = decide_rows(net, rows, ["film.own_film"])
    assert decided.levels["film"].tolist() == ["mass_conserving", "mass_conserving"]
    assert len(decided.trials) == 1


def test_budget_ends_the_climb():
    net = net_of(bearing(), "clearance")
    rows = spread(net, 40, 0.6, 1.4)
    decided = decide_rows(net, rows, ["film.own_film"], budget=0)
    assert len(decided.trials) == 1
    assert decided.stopped == "budget"
    assert decided.undecided().any()


def test_limits_that_nobody_gives_do_not_climb():
    raw = bearing()
    del raw["steps"]["film"]["limits"]
    net = net_of(raw, "clearance")
    decided = decide_rows(net, spread(net, 5), ["film.own_film"])
    assert (decided.verdicts["film.own_film"] == NOT_CHECKED).all()
    assert len(decided.trials) == 1
    assert decided.stopped == "decided"


def test_steps_whose_errors_are_not_stated_stay():
    raw = {**CURVES, "criteria": {"load": {"require": "loads.wall_force_max <= 5 kN"}}}
    net = net_of(raw, "speed")
    decided = decide_rows(net, spread(net, 4), ["load"])
    assert len(decided.trials) == 1


def test_unknown_criteria_are_refused():
    net = net_of(bearing(), "clearance")
    with pytest.raises(InvalidInputs, match=r"film\.own_film"):
        decide_rows(net, spread(net, 2), ["film.own_fil"])
