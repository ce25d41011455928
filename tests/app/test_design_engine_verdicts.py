"""Criteria of rows have the verdicts and numbers of separate designs."""

import copy
from collections import Counter

import numpy as np
import pytest
from row_designs import BEARING, CURVES, FILM, alone, calculated, engine_of, ref, spread

from app.designs.engine.verdicts import judged
from templates.core.criteria.comparison import (
    MET,
    MET_ERROR_UNKNOWN,
    NOT_CHECKED,
    NOT_MET,
    VERDICTS,
    WORST_FIRST,
)
from templates.core.errors import InvalidInputs
from templates.core.language.criteria import EvaluatedValues, estimate_of
from templates.core.language.evaluate import evaluate
from templates.core.language.levels import accuracy
from templates.core.units.units import unit
from templates.door import built_in


def chained(level="fit"):
    """A second film whose load and heat follow from the uncertain first one."""
    raw = copy.deepcopy(BEARING)
    raw["steps"]["film"]["level"] = level
    inputs = {name: value for name, value in raw["steps"]["film"]["inputs"].items() if "supply" not in name}
    raw["steps"]["second"] = {
        "template": "oil_film",
        "version": 2,
        "level": "map",
        "outputs": [
            "minimum_film_thickness",
            "maximum_pressure",
            "stiffness_xx",
            "smallest_permissible_film",
        ],
        "limits": {"permissible_pressure": "250 MPa", "permissible_film": "1.1 um"},
        "inputs": {
            **inputs,
            "radial_load": "= load * (film.minimum_film_thickness / 2 um)**0.5",
            "heat_transfer": "= 25 W/K + film.power_loss / 200 K",
            "ambient_temperature": "40 degC",
        },
    }
    raw["criteria"] = {
        "film": {"require": "film.minimum_film_thickness >= 1.9 um"},
        "second_film": {"require": "second.minimum_film_thickness >= 1.5 um"},
        "both": {"require": "second.maximum_pressure / 100 + film.power_loss * 1e3 Pa/W <= 2 MPa"},
        "load": {"require": "second.radial_load <= 25 kN"},
        "given": {"require": "load <= 26 kN"},
        "error_not_stated": {"require": "idle.power_loss <= 1 kW"},
        "second.film_exists": {"waived": "accepted in test 12"},
    }
    return raw


def curves():
    """Criteria along curves, against values of their own points."""
    raw = copy.deepcopy(CURVES)
    raw["criteria"] = {
        "film": {"require": "film.film_thickness >= 0.1 * clearance"},
        "smallest": {"require": "film.minimum_film_thickness >= 6 um"},
        "load": {"require": "abs(loads.main_load_x) <= 11.5 kN"},
        "factor": {"require": "factor <= 1.2"},
    }
    return raw


AT_LENGTH = "chained at length"
DESIGNS = {
    "chained": (chained(), ("diameter", "width", "clearance", "load"), 12),
    AT_LENGTH: (chained(), ("diameter", "width", "clearance", "load"), 36),
    "curves": (curves(), ("speed", "factor", "clearance"), 24),  # as many rows as places
    "few rows": (curves(), ("bore", "clearance"), 3),
}


def assert_equal_numbers(judgement, column, row):
    """The numbers of a judgement, in its unit, are those of a row in SI."""
    scale = unit(judgement.unit)

    def assert_close(si, shown, place):
        np.testing.assert_allclose(scale.from_si(np.array(si)), shown, rtol=1e-12, atol=1e-12, err_msg=place)

    if judgement.value is not None:
        assert_close(column.value[row], judgement.value, judgement.name)
    if judgement.limit is not None:
        assert_close(column.limit[row], judgement.limit, judgement.name)
    if judgement.band is not None:
        assert_close([column.low[row], column.high[row]], judgement.band, judgement.name)
    elif judgement.verdict != "not_checked":
        assert not judgement.error_known
    if judgement.utilisation is not None:
        np.testing.assert_allclose(column.utilisation[row], judgement.utilisation, rtol=1e-12)
    if judgement.margin is not None:
        factor = 1.0 if judgement.margin_unit == "delta_degC" else scale.factor
        size = 1e-12 * (
            abs(column.value[row]) + abs(column.limit[row])
        )  # the difference of two large numbers
        np.testing.assert_allclose(column.margin[row], judgement.margin * factor, rtol=1e-12, atol=size)


def assert_judged_as_designs(raw, varied, count):
    """The verdicts and numbers of each row are those of a design of its own; how often each verdict is."""
    engine = engine_of(raw, *varied)
    rows = spread(engine, count, 0.8, 1.2)
    table = engine(rows, [], judge=True)
    verdicts = Counter()
    for row in range(count):
        judgements = judged(calculated(alone(raw, rows, row, engine)))
        assert {judgement.name for judgement in judgements} == table.verdicts.keys()
        for judgement in judgements:
            code = table.verdicts[judgement.name][row]
            verdict = VERDICTS[code]
            assert (judgement.name, verdict) == (judgement.name, judgement.verdict)
            if verdict == "met":
                assert (code == MET) == judgement.error_known, judgement.name
            assert_equal_numbers(judgement, table.judged[judgement.name], row)
            verdicts[verdict] += 1
    return verdicts


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=pytest.mark.slow if name == AT_LENGTH else ()) for name in DESIGNS],
)
@pytest.mark.sampled(1)
def test_property_verdicts_of_rows_equal_those_of_designs(name):
    verdicts = assert_judged_as_designs(*DESIGNS[name])
    assert verdicts.keys() == set(WORST_FIRST) or name == "few rows"


def test_rows_that_are_refused_are_not_checked():
    raw = chained()
    engine = engine_of(raw, "width", "load")
    width, load = np.array([18, -1, 18, 18]) / 1e3, np.array([25e3, 25e3, 1e9, 28e3])
    rows = {ref("width"): width, ref("load"): load}
    table = engine(rows, [FILM], judge=True)
    assert table.refusals.keys() == {1, 2}
    assert table.verdicts["given"].tolist() == [MET, MET, NOT_MET, NOT_MET]
    for name in ("film", "film.film_exists", "film.specific_load", "second_film", "both", "load"):
        assert (table.verdicts[name][1:3] == NOT_CHECKED).all()
    assert table.verdicts["film.film_exists"][[0, 3]].tolist() == [MET, MET]


def test_only_named_criteria_are_calculated_and_judged():
    engine = engine_of(chained(), "clearance")
    rows = spread(engine, 5)
    table = engine(rows, [ref("clearance")], criteria=["film"])
    assert table.verdicts.keys() == {"film"}
    assert not table.judged
    assert table.levels == {"film": "fit"}
    table = engine(rows, [], criteria=["film", "given"], judge=True)
    assert table.judged.keys() == {"film", "given"}
    with pytest.raises(InvalidInputs, match="second_film"):
        engine(rows, [], criteria=["second_films"])


def test_criteria_of_outputs_that_are_left_out_can_be_named():
    engine = engine_of(chained(), "clearance")
    assert "film.pressure" not in engine.criteria()
    table = engine(spread(engine, 3), [], criteria=["film.rigid"], levels={"film": "map"}, judge=True)
    assert (table.verdicts["film.rigid"] == MET).all()
    assert (table.judged["film.rigid"].utilisation < 1).all()


def test_chunks_make_no_difference_to_verdicts():
    engine = engine_of(chained(), "clearance", "load")
    rows = spread(engine, 11)
    whole, parts = engine(rows, [], judge=True), engine(rows, [], judge=True, chunk=4)
    for name, codes in whole.verdicts.items():
        np.testing.assert_array_equal(parts.verdicts[name], codes)
        np.testing.assert_allclose(parts.judged[name].low, whole.judged[name].low, rtol=1e-12)
        assert parts.judged[name].is_known == whole.judged[name].is_known


def test_errors_that_are_not_stated_are_said():
    table = engine_of(chained(), "clearance")({ref("clearance"): np.array([5e-5, 6e-5])}, [], judge=True)
    assert table.judged["film"].is_known
    assert table.judged["given"].is_known
    loads = engine_of(curves(), "speed")({ref("speed"): np.array([300.0])}, [], criteria=["load"], judge=True)
    assert not loads.judged["load"].is_known


@pytest.mark.slow
def test_error_upstream_that_is_not_known_in_some_rows_is_said_of_these():
    """The error of the speed at which a very wide bearing whirls was not measured."""
    raw = copy.deepcopy(BEARING)
    raw["steps"]["film"]["outputs"].append("whirl_threshold_speed")
    raw["steps"]["second"] = copy.deepcopy(raw["steps"]["film"])
    raw["steps"]["second"]["inputs"]["speed"] = "= 5000 rpm + film.whirl_threshold_speed / 1000"
    raw["criteria"] = {"film": {"require": "second.minimum_film_thickness >= 1 um"}}
    engine = engine_of(raw, "width", "load")
    width = np.geomspace(0.05, 0.5, 12)
    rows, whirl = {ref("width"): width, ref("load"): 1e5 * width}, ref("film.whirl_threshold_speed")
    table = engine(rows, [whirl], judge=True)
    assert np.isfinite(table.columns[whirl]).all()
    unknown = np.isnan(table.errors[whirl])
    assert unknown.any()
    assert not unknown.all()
    assert table.verdicts["film"].tolist() == np.where(unknown, MET_ERROR_UNKNOWN, MET).tolist()
    for row in range(table.count):
        for one in judged(calculated(alone(raw, rows, row, engine))):
            assert (one.name, VERDICTS[table.verdicts[one.name][row]]) == (one.name, one.verdict)


def test_criteria_on_measures_wait_for_them():
    raw = {
        "name": "shell",
        "models": {"shell": {"id": "plain_bearing", "version": 1, "parameters": {"inner_diameter": "48 mm"}}},
        "criteria": {
            "light": {"require": "shell.mass <= 0.15 kg"},
            "wide": {"require": "shell.width >= 10 mm"},
        },
    }
    bore = {ref("shell.inner_diameter"): np.array([0.048, 0.05])}
    table = engine_of(raw, "shell.inner_diameter")(bore, [], judge=True)
    assert table.verdicts["light"].tolist() == [NOT_CHECKED, NOT_CHECKED]
    assert table.verdicts["wide"].tolist() == [MET, MET]
    engine = engine_of(raw, "shell.inner_diameter", "shell.mass")
    table = engine({**bore, ref("shell.mass"): np.array([0.1, 0.2])}, [], judge=True)
    assert table.verdicts["light"].tolist() == [MET, NOT_MET]
    np.testing.assert_allclose(table.judged["light"].margin, [0.05, -0.05], rtol=1e-12)


def test_points_without_a_size_leave_the_errors_of_others():
    """The error of a stiffness is relative to the largest of four, which no film has that bears no load."""
    template = built_in().get("oil_film", 2)
    load = {"value": [25.0, 1e9], "unit": "kN"}
    result = evaluate(template, {**template.example, "radial_load": load}, outputs=["stiffness_xx"])
    measured = accuracy(template)
    evaluated = EvaluatedValues(result.template, result.outputs, result.error, measured)
    estimate = estimate_of(evaluated, "stiffness_xx")
    assert np.isnan(estimate.error).tolist() == [False, True]
    assert estimate.error[0] == result.error["stiffness_xx"][0]
