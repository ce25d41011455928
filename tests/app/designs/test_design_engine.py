"""A design of N rows gives the results of N separate designs; and what the engine refuses."""

import copy

import numpy as np
import pytest
from row_designs import (
    BEARING,
    CATALOGUES,
    CURVES,
    FILM,
    LOSS,
    assert_equal_to_designs,
    calculated,
    codes,
    engine_of,
    ref,
    spread,
)

from app.designs.document import Document
from app.designs.engine.columns import Column, aligned, scattered
from app.designs.engine.design_engine import DesignEngine
from templates.core.errors import FaultyText, InvalidInputs
from templates.core.language.spec import Text
from templates.door import built_in


def changed(raw, **steps):
    """A document with other inputs of steps; None removes one."""
    plain = copy.deepcopy(raw)
    for name, inputs in steps.items():
        merged = {**plain["steps"][name]["inputs"], **inputs}
        plain["steps"][name]["inputs"] = {n: v for n, v in merged.items() if v is not None}
    return plain


def test_rows_of_a_bearing_equal_designs():
    engine = engine_of(BEARING, "diameter", "width", "clearance")
    rows = spread(engine, 30)
    wanted = [FILM, LOSS, ref("idle.power_loss"), ref("film.bearing_width"), ref("clearance"), ref("load")]
    table = engine(rows, wanted)
    assert assert_equal_to_designs(BEARING, engine, rows, wanted, table) == 0
    assert np.isnan(table.errors[ref("idle.power_loss")]).all()
    assert (table.errors[FILM] > 0).all()


@pytest.mark.parametrize("count", [1, 5, 24])
@pytest.mark.sampled(1)
def test_rows_of_curves_equal_designs(count):
    """24 rows are as many as a curve has places."""
    wanted = [
        ref(name)
        for name in (
            "loads.main_load_x",
            "loads.wall_force_max",
            "loads.crank_angle",
            "film.load_x",
            "film.load_y",
            "film.film_thickness",
            "film.power_loss",
            "factor",
        )
    ]
    engine = engine_of(CURVES, "speed", "factor", "clearance")
    rows = spread(engine, count)
    table = engine(rows, wanted)
    assert assert_equal_to_designs(CURVES, engine, rows, wanted, table) == 0
    assert table.columns[ref("film.film_thickness")].shape == (count, 24)
    assert table.columns[ref("loads.crank_angle")].shape == (count, 24)


def test_varied_curve_and_varied_constant_curve():
    """Speed is a curve that may be one value; here it is an input of the step, not of the design."""
    raw = changed(CURVES, film={"load_x": "= loads.main_load_x", "speed": "3000 rpm"})
    engine = engine_of(raw, "film.speed", "bore")
    rows = spread(engine, 24)
    wanted = [ref("film.film_thickness"), ref("film.speed")]
    assert assert_equal_to_designs(raw, engine, rows, wanted, engine(rows, wanted)) == 0
    speeds = rows[ref("film.speed")][:, None] * np.linspace(0.99, 1.01, 24)
    table = engine({**rows, ref("film.speed"): speeds}, wanted)
    np.testing.assert_array_equal(table.columns[ref("film.speed")], speeds)


def test_lists_of_relations_equal_designs():
    template = built_in().get("torsional_vibration", 1)
    raw = {
        "name": "shaft",
        "parameters": {"k": "60 kN*m/rad", "j": "0.012 kg*m**2"},
        "steps": {
            "shaft": {
                "template": "torsional_vibration",
                "version": 1,
                "outputs": ["natural_frequencies", "mode_shapes"],
                "inputs": {
                    **template.example,
                    "inertias": ["= j", "0.0046 kg*m**2", "= 2 * j", "0.1 kg*m**2"],
                    "stiffnesses": ["= k", "188.2 kN*m/rad", "20 kN*m/rad"],
                },
            }
        },
    }
    engine = engine_of(raw, "k", "j")
    wanted = [ref("shaft.natural_frequencies"), ref("shaft.mode_shapes"), ref("shaft.inertias")]
    for count in (3, 4):  # the numbers of frequencies and of inertias
        rows = spread(engine, count)
        assert assert_equal_to_designs(raw, engine, rows, wanted, engine(rows, wanted)) == 0


def test_masked_rows_are_refused_with_place_and_code():
    """Width below zero is out of range; no film bears 1e8 N."""
    engine = engine_of(BEARING, "width", "load")
    width, load = np.array([18, -1, 18, 18]) / 1e3, np.array([25e3, 25e3, 1e9, 20e3])
    rows, wanted = {ref("width"): width, ref("load"): load}, [FILM, ref("idle.power_loss")]
    table = engine(rows, wanted)
    assert assert_equal_to_designs(BEARING, engine, rows, wanted, table) == 2
    assert "bearing_width must be > 0" in table.refusals[1].detail
    assert np.isnan(table.columns[FILM]).tolist() == [False, True, True, False]
    assert np.isnan(table.errors[FILM]).tolist() == [False, True, True, False]
    assert np.isnan(table.columns[ref("idle.power_loss")]).tolist() == [False, True, True, False]


def test_refusing_call_is_halved_and_rows_keep_the_text():
    """A load that is too large for the arithmetic refuses a curve as a whole."""
    raw = changed(CURVES, film={"crank_angle": "= angle * 1 deg", "load_x": "= loads.main_load_x"})
    raw["parameters"]["angle"] = {"value": (np.arange(24) * 30.0).tolist(), "unit": "1"}
    engine = engine_of(raw, "angle")
    angle = np.tile(engine.nominal(ref("angle")), (9, 1))
    angle[4] *= 10
    wanted = [ref("film.minimum_film_thickness")]
    rows = {ref("angle"): angle}
    table = engine(rows, wanted)
    assert table.refusals.keys() == {4}
    assert assert_equal_to_designs(raw, engine, rows, wanted, table) == 1
    one = calculated({**raw, "parameters": {**raw["parameters"], "angle": angle[4].tolist()}})
    assert table.refusals[4].detail == one.faults[0].detail
    assert np.isfinite(np.delete(table.columns[wanted[0]], 4)).all()


def test_relation_without_a_value_refuses_its_row():
    raw = changed(BEARING, film={"radial_load": "= 25 kN * sqrt(1 - (clearance / 60 um)**2)"})
    engine = engine_of(raw, "clearance")
    rows = {ref("clearance"): np.array([50e-6, 70e-6, np.nan])}
    table = engine(rows, [FILM])
    assert table.refusals[1].place == "film.radial_load"
    assert table.refusals[1].code == table.refusals[2].code == "not_finite"
    assert table.refusals[2].place == "clearance"
    assert np.isnan(table.columns[FILM]).tolist() == [False, True, True]


def test_what_is_wrong_with_the_design_is_said_of_every_row_once():
    raw = changed(BEARING, film={"speed": "0 rpm"})
    table = engine_of(raw, "clearance")({ref("clearance"): np.linspace(40e-6, 60e-6, 5000)}, [FILM])
    assert len(table.refusals) == 5000
    assert {refusal.place for refusal in table.refusals.values()} == {"film.hydrodynamic_speed"}
    assert np.isnan(table.columns[FILM]).all()


def test_only_what_is_wanted_is_calculated():
    raw = changed(BEARING, idle={"speed": "= 5000 rpm * sqrt(0 - clearance / 1 m)"})
    engine, rows = engine_of(raw, "clearance"), {ref("clearance"): np.array([50e-6, 60e-6])}
    table = engine(rows, [FILM])
    assert not table.refusals
    assert table.levels == {"film": "map"}
    assert engine(rows, [ref("idle.power_loss")]).refusals.keys() == {0, 1}


def test_values_that_do_not_follow_from_rows_are_one_view():
    table = engine_of(BEARING, "clearance")({ref("clearance"): np.array([50e-6, 60e-6])}, [ref("load")])
    assert table.columns[ref("load")].tolist() == [25e3, 25e3]
    assert table.columns[ref("load")].strides == (0,)


def test_absent_output_is_no_refusal():
    raw = changed(BEARING, film={"supply_temperature": None, "dynamic_viscosity": "10 mPa*s"})
    wanted = [FILM, ref("film.film_temperature")]
    table = engine_of(raw, "clearance")({ref("clearance"): np.array([50e-6, 60e-6])}, wanted)
    assert not table.refusals
    assert np.isnan(table.columns[wanted[1]]).all()
    assert table.absent == {wanted[1]: "no temperature is given; the dynamic viscosity is"}


def test_single_input_varies_by_groups():
    """The number of cylinders is one value for all points of a call."""
    template = built_in().get("flywheel", 1)
    given = {n: v for n, v in template.example.items() if n not in ("firing_order", "cylinder_positions")}
    given |= {"firing_order": [1], "cylinder_positions": "0 m"}
    raw = {"name": "engine", "steps": {"engine": {"template": "flywheel", "version": 1, "inputs": given}}}
    raw["steps"]["engine"]["outputs"] = ["mean_torque"]
    engine = engine_of(raw, "engine.cylinders", "engine.bore")
    rows = {
        ref("engine.cylinders"): np.array([1.0, 2.0, 1.0]),
        ref("engine.bore"): np.array([0.1, 0.1, 0.11]),
    }
    wanted = [ref("engine.mean_torque")]
    table = engine(rows, wanted)
    assert assert_equal_to_designs(raw, engine, rows, wanted, table) == 1
    assert np.isfinite(table.columns[wanted[0]]).tolist() == [True, False, True]


def test_defaults_may_vary():
    engine = engine_of(BEARING, "film.sleeve_speed", "film.dynamic_viscosity")
    assert engine.unit(ref("film.sleeve_speed")) == "rpm"
    assert engine.nominal(ref("film.sleeve_speed")) == 0
    one = calculated(BEARING)
    viscosity = ref("film.dynamic_viscosity")
    assert engine.nominal(viscosity) == one.value(viscosity)
    rows = {
        ref("film.sleeve_speed"): np.array([0.0, 10.0]),
        ref("film.dynamic_viscosity"): np.array([0.01, 0.02]),
    }
    table = engine(rows, [FILM])
    assert assert_equal_to_designs(BEARING, engine, rows, [FILM], table) == 0


def test_units_and_nominal_values():
    engine = engine_of(CURVES, "speed")
    assert engine.unit(ref("speed")) == "rpm"
    assert engine.unit(ref("film.minimum_film_thickness")) == "um"
    assert engine.nominal(ref("speed")) == pytest.approx(3000 * np.pi / 30, rel=1e-15)
    assert np.shape(engine.nominal(ref("factor"))) == (24,)
    one = calculated(CURVES)
    np.testing.assert_array_equal(engine.nominal(ref("film.load_y")), one.value(ref("film.load_y")))
    assert engine.nominal(ref("film.minimum_film_thickness")) == one.value(ref("film.minimum_film_thickness"))


@pytest.mark.parametrize("place", ["nothing", "film.nothing", "film.power_loss", "film.mass"])
def test_unknown_places_are_refused(place):
    faults, message = codes(BEARING, place)
    assert faults == {place: "unknown_name"}
    assert "unknown" in message


def test_relations_are_not_varied():
    faults, message = codes(BEARING, "film.radial_load", "idle.radial_clearance", "film.oil_grade")
    assert faults == {"film.radial_load": "follows_from", "idle.radial_clearance": "follows_from"} | {
        "film.oil_grade": "not_a_number"
    }
    assert "vary load instead" in message


def test_lists_of_points_are_refused_beside_rows():
    raw = changed(BEARING, film={"speed": {"value": [4000, 5000], "unit": "rpm"}})
    assert codes(raw, "clearance")[0] == {"film.speed": "shape"}
    raw = {**BEARING, "parameters": {**BEARING["parameters"], "load": ["25 kN", "20 kN"]}}
    assert codes(raw, "clearance")[0] == {"film.radial_load": "shape"}
    assert engine_of(raw, "clearance", wanted=[ref("load")])


@pytest.mark.parametrize(
    "rows",
    [
        {},
        {ref("clearance"): np.array(1.0)},
        {ref("clearance"): np.ones((2, 3))},
        {ref("clearance"): np.ones(2), ref("width"): np.ones(2)},
    ],
)
def test_wrong_columns_are_refused(rows):
    with pytest.raises(InvalidInputs) as refused:
        engine_of(BEARING, "clearance")(rows, [FILM])
    assert {fault.code for fault in refused.value.faults} <= {"missing", "shape", "unknown_name"}


def test_wrong_names_of_outputs_are_refused():
    engine = engine_of(BEARING, "clearance")
    with pytest.raises(InvalidInputs, match=r"film\.minimum_film_thickness"):
        engine({ref("clearance"): np.ones(2)}, [ref("film.minimum_film_thicknes")])
    with pytest.raises(InvalidInputs, match="reynolds"):
        engine({ref("clearance"): np.ones(2)}, [FILM], levels={"film": "reynold"})
    with pytest.raises(InvalidInputs, match="not a quantity"):
        engine({ref("clearance"): np.ones(2)}, [ref("film.lubrication_regime")])


def test_columns_align_rows_first():
    rows, curve, both = (
        Column(np.arange(3.0), is_row=True),
        Column(np.ones(3)),
        Column(np.ones((3, 3)), is_row=True),
    )
    values, is_row = aligned({"rows": rows, "curve": curve, "both": both})
    assert is_row
    assert {name: np.shape(value) for name, value in values.items()} == {
        "rows": (3, 1),
        "curve": (3,),
        "both": (3, 3),
    }
    whole = scattered(
        4, [(np.array([0, 2]), Column(np.array([1.0, 2.0]), is_row=True)), (np.array([3]), Column(5.0))]
    )
    np.testing.assert_array_equal(whole.value, [1.0, np.nan, 2.0, 5.0])


def test_faulty_documents_are_refused():
    raw = changed(BEARING, film={"radial_load": "= lod"})
    with pytest.raises(InvalidInputs, match="lod"):
        DesignEngine.of(Document.model_validate(raw), CATALOGUES, [ref("clearance")])


def test_no_rows_give_empty_columns():
    table = engine_of(BEARING, "clearance")({ref("clearance"): np.empty(0)}, [FILM], judge=True)
    assert table.count == 0
    assert table.columns[FILM].shape == (0,)


TORSION = built_in().get("forced_torsion", 1)


def torsion(**relations):
    """A shaft in forced torsion, some of whose inputs follow from a parameter of the design."""
    step = {"template": "forced_torsion", "version": 1, "inputs": {**TORSION.example, **relations}}
    return {"name": "torsion", "parameters": {"p": {"value": 2.0, "unit": "1"}}, "steps": {"s": step}}


def test_curves_of_different_lengths_are_refused_in_words():
    parts = [
        (np.array([0]), Column(np.zeros((1, 3)), is_row=True)),
        (np.array([1]), Column(np.zeros((1, 4)), is_row=True)),
    ]
    with pytest.raises(FaultyText, match="length of its curve differs between rows") as refused:
        scattered(2, parts)
    assert refused.value.code == "shape"


def test_rows_that_all_lack_an_input_are_refused_and_not_grouped():
    engine = engine_of(torsion(highest_order="= sqrt(p)"), "p")
    wanted = [ref(f"s.{name}") for name in TORSION.formulas if not isinstance(TORSION.formulas[name], Text)]
    table = engine({ref("p"): np.array([-1.0, -4.0])}, wanted[:1])
    assert sorted(table.refusals) == [0, 1]
