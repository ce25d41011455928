"""Warnings about violated rules and criteria: each sentence agrees with its own numbers."""

import re

import pytest
from true_numbers import assert_true_of_its_numbers

from templates.core.criteria.judgement import told_apart
from templates.core.language.evaluate import evaluate
from templates.door import built_in

LIFT, CYCLES = {"level": "mobility"}, ("cycle_heat_balance", "oil_film_cycle")
UNFED = {**dict.fromkeys(["groove_width", "groove_start", "groove_extent"]), "oil_supply": "flooded_ends"}
MASSLESS = {"crank_unbalance": None, "web_unbalance": None, "counterweights": None}
GAUGE = {
    "gas_cycle": "table",
    "pressure": {"value": [1.0, 1.0, 10.0, 40.0, 10.0, 3.0, 1.0, 1.0, 1.0], "unit": "bar"},
    "pressure_angle": {"value": [0, 90, 180, 270, 360, 450, 540, 630, 719], "unit": "deg"},
    "crankcase_pressure": "0 bar",
}

COARSE = {**GAUGE, "crankcase_pressure": "1 bar"}


def hole(part):
    return {f"{part}_hole_length": "6 mm", f"{part}_hole_arc": "4 mm", f"{part}_hole_angle": "0 deg"}


VIOLATED = [  # a template, the input that the warning names, and what violates its rule
    ("bearing_load", "crank_angle_step", {"crank_angle_step": "20 deg"}, {}),
    ("bearing_load", "combustion_pressure", {"combustion_pressure": "5 bar"}, {}),
    ("bearing_load", "crankcase_pressure", {"crankcase_pressure": "0 bar"}, {}),
    ("bearing_load", "speed", {"speed": "-2000 rpm"}, {}),
    ("bearing_load", "crank_mass",
     {"crank_mass": "0 kg", "crankpin_mass": "0 kg", "counterweight_mass": "0 kg"}, {}),
    ("engine", "combustion_pressure", {"combustion_pressure": "5 bar"}, {}),
    ("engine", "crankcase_pressure", {"crankcase_pressure": "0 bar"}, {}),
    ("engine", "speed", {"speed": "-2000 rpm"}, {}),
    ("engine", "crank_angle_step", {"crank_angle_step": "20 deg"}, {}),
    ("flywheel", "crank_angle_step", {"crank_angle_step": "20 deg"}, {}),
    ("flywheel", "combustion_pressure", {"gas_cycle": "otto", "combustion_pressure": "5 bar"}, {}),
    ("flywheel", "crankcase_pressure", {"crankcase_pressure": "0 bar"}, {}),
    ("flywheel", "speed", {"speed": "-2000 rpm"}, {}),
    ("cycle_heat_balance", "groove_width", {}, LIFT),
    ("cycle_heat_balance", "oil_supply", {"oil_supply": "flooded_ends"}, {}),
    ("oil_film_cycle", "groove_width", {}, LIFT),
    ("oil_film_cycle", "oil_supply", {"oil_supply": "flooded_ends"}, {}),
    ("oil_film_cycle", "permissible_film", {"permissible_film": "200 um"}, LIFT),
    ("oil_film_cycle", "permissible_film", {"permissible_film": "2.858 um"}, {}),
    ("oil_film_cycle", "permissible_pressure", {"permissible_pressure": "1 MPa"}, LIFT),
    ("elastic_film", "pressure_viscosity", {"pressure_viscosity": "2e-8 1/Pa"}, {"level": "rigid"}),
    ("hydrostatic_pad", "capillary_length", {"restrictor": "orifice", "capillary_length": "10 mm"}, {}),
    ("hydrostatic_pad", "pump_flow", {"pump_flow": "1 l/min"}, {}),
    ("oil_film", "preload", {"bore_shape": "lemon"}, {}),
    ("oil_film", "bell_mouth_depth", {"bell_mouth_depth": "5 um"}, {}),
    ("stress_life", "mean_stress", {"mean_stress": "-20 MPa"}, {}),
    ("stress_life", "fillet_radius", {"fillet_radius": "0.4 mm"}, {}),
    ("flywheel", "crank_mass",
     {"crank_mass": "0 kg", "crankpin_mass": "0 kg", "counterweight_mass": "0 kg"}, {}),
    ("engine", "crank_unbalance", MASSLESS, {}),
    *[(id, "pressure", COARSE, {}) for id in ("bearing_load", "engine", "flywheel")],
    *[(id, "pressure", GAUGE, {}) for id in ("bearing_load", "engine", "flywheel")],
    *[(id, f"{part}_hole_length", hole(part), LIFT) for part in ("pin", "sleeve") for id in CYCLES],
    *[(id, "supply_pressure", UNFED, LIFT) for id in CYCLES],
    ("cycle_heat_balance", "hths_viscosity", {"dynamic_viscosity": "8 mPa*s"}, {}),
    ("hydrostatic_pad", "restrictor_diameter", {"restrictor": "constant_flow", "pump_flow": "1 l/min"}, {}),
    ("oil_film", "oil_inlet_temperature",
     {"supply_temperature": "60 degC", "ambient_temperature": "20 degC", "heat_transfer": "5 W/K"}, {}),
    ("oil_film", "grooves", {"grooves": {"value": [[0, 10]], "unit": "deg"}}, {"level": "map"}),
    ("oil_film", "supply_pressure", {"supply_pressure": "2 bar"}, {"level": "map"}),
    ("oil_film", "start_line", {"start_line": "moving", "bore_shape": "lemon", "preload": 0.5}, {}),
]  # fmt: skip


def newest(id):
    return max((cls for cls in built_in() if cls.id == id), key=lambda cls: cls.version)


@pytest.mark.parametrize(("id", "name", "changes", "fidelity"), VIOLATED)
def test_property_the_warning_of_a_violated_rule_states_what_is(id, name, changes, fidelity):
    cls = newest(id)
    rules = {rule.warning: rule for rule in cls.requirements if rule.warning and name in rule.names}
    raw = {name: value for name, value in {**cls.example, **changes}.items() if value is not None}
    warnings = evaluate(cls, raw, **fidelity).warnings
    said = [warning for warning in warnings if warning.name == name and warning.code in rules]
    assert said
    for warning in said:
        assert rules[warning.code].sentence not in warning.detail  # which says what ought to be
        stated = warning.detail.removesuffix(f"; {rules[warning.code].remedy}")
        if not assert_true_of_its_numbers(stated):
            of_input = cls.inputs[name].meaning.words if hasattr(cls.inputs[name], "meaning") else name
            assert stated.startswith((of_input, name.replace("_", " "))), stated
            assert ("is not used" in stated) == (warning.code == "unused_input")


def test_every_rule_that_warns_is_violated_once():
    rules = {
        (cls.id, rule.warning, rule.names[0])
        for cls in built_in()
        for rule in cls.requirements
        if rule.warning
    }
    violated = {(id, name) for id, name, *_ in VIOLATED}
    missing = [(id, code) for id, code, name in rules if (id, name) not in violated]
    assert sorted(missing) == []


@pytest.mark.parametrize(("peak", "warned"), [("60 bar", False), ("5 bar", True)])
def test_a_point_that_another_rule_refuses_is_not_warned_about(peak, warned):
    cls = newest("engine")
    raw = {**cls.example, "compression_ratio": [10, 0.5], "combustion_pressure": peak}
    said = [w.detail for w in evaluate(cls, raw).warnings if w.code == "pressure_falls"]
    assert bool(said) == warned
    for one in said:
        assert assert_true_of_its_numbers(one)
        assert "worst of 1 among 2 values" in one


def test_a_crank_without_masses_is_said_to_have_none():
    cls = newest("engine")
    raw = {name: value for name, value in {**cls.example, **MASSLESS}.items() if value is not None}
    said = {warning.detail for warning in evaluate(cls, raw).warnings if warning.code == "massless_crank"}
    (one,) = said
    assert one.startswith(
        "the greatest unbalance of throws, webs and counterweights 0 kg·mm is not above 0 kg·mm;"
    )


def test_a_film_below_its_limit_is_said_to_be_below_it():
    cls = newest("oil_film_cycle")
    warnings = evaluate(cls, {**cls.example, "permissible_film": "200 um"}, level="mobility").warnings
    (said,) = [warning.detail for warning in warnings if warning.code == "below_permissible_film"]
    film = r"minimum film thickness 2\.\d+ µm is below permissible film 200 µm"
    assert re.match(film, said)


@pytest.mark.parametrize(("one", "other"), [(3.0, 2.9999999), (0.1, 0.1 + 1e-15), (5.0, 4.0)])
def test_two_numbers_that_differ_are_written_apart(one, other):
    texts = told_apart(one, other)
    assert texts[0] != texts[1]
    assert (float(texts[0]) > float(texts[1])) == (one > other)


def test_equal_numbers_are_written_alike():
    assert told_apart(3.0, 3.0) == ("3", "3")


def test_property_the_warning_of_every_criterion_states_what_is():
    """Limits far on either side of the value, for every template: the sentence holds for its numbers."""
    count = 0
    for cls in built_in():
        limits = {limit.name: f"{size} {limit.unit}" for c in cls.declared_criteria for limit in c.limits
                  for size in ("1e-9",)}  # fmt: skip
        for size in ("1e-9", "1e9"):
            given = {name: text.replace("1e-9", size) for name, text in limits.items()}
            try:
                result = evaluate(cls, dict(cls.example), limits=given)
            except ValueError:
                continue
            codes = {criterion.warning for criterion in cls.declared_criteria if criterion.warning}
            for warning in result.warnings:
                if warning.code in codes:
                    count += assert_true_of_its_numbers(warning.detail)
    assert count >= 4
