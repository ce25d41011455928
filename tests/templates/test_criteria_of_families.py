"""Each criterion of each family has a case that meets it and one that does not, with value and limit.

Closed forms stand as a hand calculation; a film, pressure or load that a solver finds stands with its digits,
which the tests of that template hold against the literature.
"""

from math import hypot, pi, sqrt

import numpy as np
import pytest
from criteria_of_engines import CASES as OF_ENGINES
from criteria_of_pads import CASES as OF_PADS
from criteria_of_shafts import CASES as OF_SHAFTS

from templates.core.criteria.evaluation import judge
from templates.core.language.criteria import EvaluatedValues, estimates_of
from templates.core.language.evaluate import evaluate
from templates.door import built_in

RPM = pi / 30
AREA = 48 * 18  # mm², of the film's bearing
PSI = 0.055 / 48
STIFF = 231e3  # MPa


def inputs(id, version, changes):
    example = built_in().get(id, version).example
    return {name: value for name, value in {**example, **changes}.items() if value is not None}


def judged(id, version, changes, limits=None, name=None):
    result = evaluate(built_in().get(id, version), inputs(id, version, changes), limits=limits)
    return next(j for j in result.criteria if j.name == name), {notice.code for notice in result.warnings}


HEAVY = {"radial_load": "2500 kN"}
THIN_OIL = {
    "dynamic_viscosity": "0.2 mPa*s", "oil_inlet_temperature": None, "oil_outlet_temperature": None,
    "radial_load": "10 N", "speed": "20000 rpm", "diametral_clearance": "0.3 mm",
}  # fmt: skip
LIGHT = {"radial_load": "1 kN"}
ROUGH = {"journal_roughness": "1.2 um", "bearing_roughness": "1.6 um"}
ROUGHER = {"journal_roughness": "3 um", "bearing_roughness": "4 um"}
SHEAR_FILM = {"inlet_film": "0.06 um", "outlet_film": "0.03 um", "sliding_speed": "1 m/s"}
BRONZE, BABBITT = {"bearing_material": "tin_bronze"}, {"bearing_material": "tin_babbitt_b23_2"}
COMPRESSED = {
    "nominal_stress_amplitude": None, "nominal_mean_stress": None,
    "stress_amplitude": "100 MPa", "mean_stress": "-5000 MPa",
}  # fmt: skip
PULLED = {**COMPRESSED, "mean_stress": "300 MPa"}
ONE_CYLINDER = {
    "cylinders": 1, "firing_order": [1], "cylinder_positions": {"value": [0], "unit": "m"},
}  # fmt: skip
RANGE = "speed_range"
PRESSED = ("pressure_deforms_bearing", "pressure_thickens_oil")
FILM_1, FILM = ("oil_film", 1), ("oil_film", 2)
CYCLE = ("oil_film_cycle", 1)
PAD, PETROV, WARM = ("slider_bearing", 1), ("journal_friction", 1), ("thermal_clearance", 1)
LOADS, ENGINE = ("bearing_load", 1), ("flywheel", 1)
CHAIN, FATIGUE = ("torsional_vibration", 1), ("stress_life", 1)

CASES = [
    *OF_ENGINES,
    *OF_SHAFTS,
    *OF_PADS,  # criterion, what differs from the example, limits given, verdict, value and limit by hand
    # The paper prints 3.2449 µm for its example; the bound of its error is 24 %.
    (FILM_1, "film", {}, {"smallest_permissible_film": "2.5 um"}, "met", 3.2449, 2.5),
    (FILM_1, "film", {}, {"smallest_permissible_film": "4.5 um"}, "not_met", 3.2449, 4.5),
    (FILM_1, "film_exists", {}, {}, "met", 3.2449, 0.05),
    (FILM_1, "specific_load", {}, BRONZE, "met", 25e3 / AREA, 30),
    (FILM_1, "specific_load", {}, BABBITT, "not_met", 25e3 / AREA, 5.5),
    (FILM_1, "temperature", {}, BABBITT, "met", 87.762, 150),
    (FILM_1, "temperature", {}, {"permissible_temperature": "80 degC"}, "not_met", 87.762, 80),
    # 48 mm at 5000 rpm slide at 12.6 m/s: above 24 mm and 10 m/s the table has 7 µm.
    (FILM, "film", LIGHT, {}, "met", 14.8395, 7),
    (FILM, "film", {}, {}, "not_met", 55 / 2 * (1 - 0.903371), 7),
    (FILM, "own_film", {}, {"permissible_film": "2 um"}, "met", 55 / 2 * (1 - 0.903371), 2),
    (FILM, "own_film", {}, {"permissible_film": "0.003 mm"}, "not_met", 55 / 2 * (1 - 0.903371), 3),
    (FILM, "film_exists", HEAVY, {}, "met", 0.0713991, 0.05),
    (FILM, "film_exists", {"radial_load": "1e9 N"}, {}, "not_met", 2.11552e-4, 0.05),
    (FILM, "roughness", ROUGH, {}, "met", 2.65729 / hypot(1.2, 1.6), 1),
    (FILM, "roughness", ROUGHER, {}, "not_met", 2.65729 / hypot(3, 4), 1),
    (FILM, "full_film", {}, {}, "met", 2.65729 / hypot(0.2, 0.4), 3),
    (FILM, "full_film", ROUGH, {}, "not_met", 2.65729 / hypot(1.2, 1.6), 3),
    (FILM, "pressure", {}, {"permissible_pressure": "200 MPa"}, "met", 149.9176, 200),
    (FILM, "pressure", {}, BABBITT, "not_met", 149.9176, 20.6),
    (FILM, "rigid", {}, {}, "met", 149.9176, STIFF * PSI),
    (FILM, "rigid", HEAVY, {}, "not_met", 59550.28, STIFF * PSI),
    (FILM, "isoviscous", {}, {}, "met", 149.9176, 500),
    (FILM, "isoviscous", HEAVY, {}, "not_met", 59550.28, 500),
    (FILM, "specific_load", {}, BRONZE, "met", 25e3 / AREA, 30),
    (FILM, "specific_load", {}, {"bearing_material": "lead_bronze"}, "not_met", 25e3 / AREA, 20),
    (FILM, "temperature", {}, {"bearing_material": "aluminium_alloy"}, "met", (80 + 87.762) / 2, 125),
    (FILM, "temperature", {}, {"permissible_temperature": "350 K"}, "not_met", (80 + 87.762) / 2, 76.85),
    (FILM, "hot_oil", {}, {}, "met", 83.881, 125),
    (FILM, "hot_oil", {"oil_outlet_temperature": "200 degC"}, {}, "not_met", 140, 125),
    (FILM, "oil_temperature", {}, {"permissible_oil_temperature": "105 degC"}, "met", 83.881, 105),
    (FILM, "oil_temperature", {}, {"permissible_oil_temperature": "80 degC"}, "not_met", 83.881, 80),
    # rho omega D c/(4 eta) against 41.3 sqrt(D/c)
    (FILM, "laminar", {}, {}, "met", 835.871 * 5000 * RPM * 0.048 * 55e-6 / (4 * 0.0184209),
     41.3 / sqrt(PSI)),
    (FILM, "laminar", THIN_OIL, {}, "not_met", 875 * 20000 * RPM * 0.048 * 3e-4 / (4 * 2e-4),
     41.3 * sqrt(48 / 0.3)),
    (FILM, "whirl", LIGHT, {}, "met", 5000, 14535.2),
    (FILM, "whirl", {**LIGHT, "speed": "20000 rpm"}, {}, "not_met", 20000, 15060.0),
    (FILM, "pressure_times_speed", {}, {"permissible_pressure_times_speed": "400 MPa*m/s"}, "met",
     25e3 / AREA * 5000 * RPM * 0.024, 400),
    (FILM, "pressure_times_speed", {}, {"permissible_pressure_times_speed": "300 N/mm**2*m/s"}, "not_met",
     25e3 / AREA * 5000 * RPM * 0.024, 300),
    (PAD, "film", {}, {"smallest_permissible_film": "20 um"}, "met", 30, 20),
    (PAD, "film", {"inlet_film": "15 um"}, {"smallest_permissible_film": "20 um"}, "not_met", 15, 20),
    (PAD, "film_exists", {}, {}, "met", 30, 0.05),
    (PAD, "film_exists", SHEAR_FILM, {}, "not_met", 0.03, 0.05),
    (PAD, "pressure", {}, BABBITT, "met", 2.62278, 20.6),
    (PAD, "pressure", {}, {"permissible_pressure": "20 bar"}, "not_met", 2.62278, 2),
    (PAD, "rigid", {}, {}, "met", 2.62278, STIFF * 0.03 / 50),
    (PAD, "rigid", SHEAR_FILM, {}, "not_met", 262278.2, STIFF * 3e-5 / 50),
    (PAD, "isoviscous", {}, {}, "met", 2.62278, 500),
    (PAD, "isoviscous", SHEAR_FILM, {}, "not_met", 262278.2, 500),
    (PAD, "specific_load", {}, BABBITT, "met", 2886.505 / 2500, 5.5),
    (PAD, "specific_load", {}, {"bearing_material": "rubber"}, "not_met", 2886.505 / 2500, 0.35),
    (PAD, "laminar", {}, {}, "met", 860 * 10 * 60e-6 / 0.03, 1000),
    (PAD, "laminar", {"inlet_film": "6 mm", "outlet_film": "3 mm"}, {}, "not_met",
     860 * 10 * 6e-3 / 0.03, 1000),
    (PETROV, "film", {}, {"smallest_permissible_film": "200 um"}, "met", 250 * (1 - 0.038035), 200),
    (PETROV, "film", {}, {"smallest_permissible_film": "0.245 mm"}, "not_met", 250 * (1 - 0.038035), 245),
    (PETROV, "film_exists", {}, {}, "met", 250 * (1 - 0.038035), 0.05),
    (PETROV, "film_exists", {"radial_load": "30 MN"}, {}, "not_met", 9.499314e-4, 0.05),
    (PETROV, "laminar", {}, {}, "met", 875 * 50 * pi * 0.025 * 0.25e-3 / 0.011877, 413),
    (PETROV, "laminar", {"speed": "150000 rpm"}, {}, "not_met", 7232.712, 413),
    (PETROV, "specific_load", {"radial_load": "3 kN"}, BRONZE, "met", 0.6, 30),
    (PETROV, "specific_load", {"radial_load": "3 kN"}, {"bearing_material": "rubber"}, "not_met", 0.6, 0.35),
    (LOADS, "crankpin_load", {}, {"permissible_crankpin_load": "30 kN"}, "met", 29081.33, 30e3),
    (LOADS, "crankpin_load", {}, {"permissible_crankpin_load": "25 kN"}, "not_met", 29081.33, 25e3),
    (LOADS, "main_load", {}, {"permissible_main_load": "30 kN"}, "met", 28794.86, 30e3),
    (LOADS, "main_load", {}, {"permissible_main_load": "25 kN"}, "not_met", 28794.86, 25e3),
    (LOADS, "gas_pressure", {}, {"permissible_gas_pressure": "8 MPa"}, "met", 60, 80),
    (LOADS, "gas_pressure", {}, {"permissible_gas_pressure": "5 MPa"}, "not_met", 60, 50),
    # 2 s n
    (LOADS, "piston_speed", {}, {"permissible_piston_speed": "15 m/s"}, "met", 2 * 0.086 * 50, 15),
    (LOADS, "piston_speed", {"speed": "6000 rpm"}, {"permissible_piston_speed": "15 m/s"}, "not_met",
     2 * 0.086 * 100, 15),
    (ENGINE, "flywheel", {}, {"planned_flywheel_inertia": "7 kg*m**2"}, "met", 6.0843, 7),
    (ENGINE, "flywheel", {}, {"planned_flywheel_inertia": "5 kg*m**2"}, "not_met", 6.0843, 5),
    (ENGINE, "shaking_force", {}, {"permissible_shaking_force": "1 N"}, "met", 0, 1),
    # At its largest, on top: (M + m_rec (1 + 1/n)) omega² r
    (ENGINE, "shaking_force", ONE_CYLINDER, {"permissible_shaking_force": "5 kN"}, "not_met",
     (2.641667 + 1.983333 * (1 + 1 / 3.8)) * (1500 * RPM) ** 2 * 0.06, 5000),
    (ENGINE, "primary_couple", {}, {"permissible_couple": "200 N*m"}, "met", 171.397, 200),
    (ENGINE, "primary_couple", {}, {"permissible_couple": "150 N*m"}, "not_met", 171.397, 150),
    (ENGINE, "piston_speed", {}, {"permissible_piston_speed": "10 m/s"}, "met", 2 * 0.12 * 25, 10),
    (ENGINE, "piston_speed", {}, {"permissible_piston_speed": "5 m/s"}, "not_met", 2 * 0.12 * 25, 5),
    # Order 4 meets mode 1 at 1204.1 rpm, order 6 at 802.7 rpm. By hand: middle and half of the widened range.
    (CHAIN, "separation", {RANGE: {"value": [1000, 1050], "unit": "rpm"}}, {}, "met",
     1204.11777 - (1155 + 900) / 2, (1155 - 900) / 2),
    (CHAIN, "separation", {RANGE: {"value": [1150, 1190], "unit": "rpm"}}, {}, "not_met",
     1204.11777 - (1309 + 1035) / 2, (1309 - 1035) / 2),
    (CHAIN, "separation", {RANGE: None},
     {"lowest_running_speed": "1000 rpm", "highest_running_speed": "1050 rpm"}, "met",
     1204.11777 - (1155 + 900) / 2, (1155 - 900) / 2),
    (FATIGUE, "strength", PULLED, {}, "met", 400, 800),
    (FATIGUE, "strength", COMPRESSED, {}, "not_met", 5100, 800),
    (FATIGUE, "yield", PULLED, {}, "met", 400, 600),
    (FATIGUE, "yield", COMPRESSED, {}, "not_met", 5100, 600),
    # Goodman: 100/(1 - 300/800); Basquin at 1e7: 1150 (2e7)^-0.09
    (FATIGUE, "life", PULLED, {}, "met", 160, 1150 * 2e7**-0.09),
    (FATIGUE, "life", {**PULLED, "stress_amplitude": "200 MPa"}, {}, "not_met", 320, 1150 * 2e7**-0.09),
    (FATIGUE, "safety", PULLED, {"required_safety_factor": 0.9}, "met",
     1 / (100 / (1150 * 2e7**-0.09) + 300 / 800), 0.9),
    (FATIGUE, "safety", PULLED, {"required_safety_factor": 1.5}, "not_met",
     1 / (100 / (1150 * 2e7**-0.09) + 300 / 800), 1.5),
    # 48 mm of aluminium, 80 K warmer, on steel, 90 K warmer: 55 + 88.32 - 47.52 µm
    (WARM, "runs", {}, {}, "met", 95.8, 0),
    (WARM, "runs", {"housing_temperature": "20 degC", "journal_temperature": "140 degC"}, {}, "not_met",
     55 - 63.36, 0),
    (WARM, "least_clearance", {}, {"smallest_permissible_clearance": "90 um"}, "met", 95.8, 90),
    (WARM, "least_clearance", {}, {"smallest_permissible_clearance": "0.1 mm"}, "not_met", 95.8, 100),
]  # fmt: skip
NAMES = [f"{case[0][0]}-{case[0][1]}-{case[1]}-{case[4]}-{i}" for i, case in enumerate(CASES)]
WIDE = {(FILM_1, "film_exists")}
"""The bound of the paper's fit reaches beyond any film that it may give: never not met (below)."""
COLUMNS = ("template", "name", "changes", "limits", "verdict", "value", "limit")


@pytest.mark.sampled(80)
@pytest.mark.parametrize(COLUMNS, CASES, ids=NAMES)
def test_by_hand(template, name, changes, limits, verdict, value, limit):
    judgement, _ = judged(*template, changes, limits, name)
    assert judgement.verdict == verdict
    assert judgement.value == pytest.approx(value, rel=2e-5, abs=1e-9)
    assert judgement.limit == pytest.approx(limit, rel=2e-5)


def test_every_criterion_has_a_case_of_both_verdicts():
    others = (c for c in built_in() if (c.id, c.version) != CYCLE)  # see test_fed_criteria
    declared = {((c.id, c.version), one.name) for c in others for one in c.declared_criteria}
    for verdict, left_out in (("met", set()), ("not_met", WIDE)):
        assert declared - {(case[0], case[1]) for case in CASES if case[4] == verdict} == left_out


CYCLE_CASES = [
    ("film", {"permissible_film": "2 um"}, "met", 2.90276, 2),
    ("film", {"permissible_film": "3 um"}, "not_met", 2.90276, 3),
    ("pressure", {"permissible_pressure": "80 MPa"}, "met", 74.4904, 80),
    ("pressure", {"permissible_pressure": "70 MPa"}, "not_met", 74.4904, 70),
    ("film_exists", {}, "met", 2.90276, 0.05),
    ("film_exists", {"dynamic_viscosity": "0.02 mPa*s"}, "not_met", 0.01456005, 0.05),
    ("rigid", {"dynamic_viscosity": "1 Pa*s"}, "met", 1.78698, 24.30052 / 2),
    ("rigid", {}, "not_met", 3.774199, 2.90276 / 2),
    ("isoviscous", {}, "met", 74.4904, 500),
    ("isoviscous", {"dynamic_viscosity": "0.02 mPa*s"}, "not_met", 659.26477, 500),
]  # fmt: skip


@pytest.mark.parametrize(("name", "changes", "verdict", "value", "limit"), CYCLE_CASES)
def test_the_cycle_without_a_supply_is_judged_by_its_value_since_no_bound_of_its_error_is_stated(
    name, changes, verdict, value, limit
):
    changes = {
        **dict.fromkeys(["groove_width", "groove_start", "groove_extent", "supply_pressure"]),
        "oil_supply": "flooded_ends",
        **changes,
    }
    judgement, warnings = judged(*CYCLE, changes, {}, name)
    assert (judgement.verdict, judgement.error_known) == (verdict, False)
    assert (judgement.warning in warnings) == (verdict == "not_met" and judgement.warning is not None)
    assert judgement.value == pytest.approx(value, rel=2e-5)
    assert judgement.limit == pytest.approx(limit, rel=2e-5)


def test_a_film_of_a_nanometre_is_warned_of_though_its_error_is_larger():
    judgement, warnings = judged(*FILM_1, {"radial_load": "8500 kN"}, {}, "film_exists")
    assert (judgement.verdict, judgement.value) == ("undecided", pytest.approx(1.01378e-3, rel=1e-5))
    assert "film_too_thin" in warnings


@pytest.mark.parametrize(("template", "changes", "codes"), [
    (FILM, HEAVY, {"film_below_roughness", "mixed_friction", *PRESSED}),
    (FILM, {"radial_load": "1e9 N"}, {"film_too_thin", "film_below_roughness", "mixed_friction", *PRESSED}),
    (FILM, THIN_OIL, {"turbulent_flow"}),
    (FILM, {**LIGHT, "speed": "20000 rpm"}, {"journal_whirls"}),
    (FILM, {}, set()),
    (PAD, SHEAR_FILM, {"film_too_thin", *PRESSED}),
    (FATIGUE, COMPRESSED, {"static_overload", "yields"}),
    (FATIGUE, PULLED, set()),
])  # fmt: skip
def test_what_cannot_exist_is_named_among_the_warnings(template, changes, codes):
    cls = built_in().get(*template)
    result = evaluate(cls, inputs(*template, changes))
    declared = {criterion.warning for criterion in cls.declared_criteria}
    assert {notice.code for notice in result.warnings} & declared == codes


def test_the_table_of_iso_7902_is_unverified_wherever_it_is_used():
    judgement, _ = judged(*FILM, LIGHT, {}, "film")
    assert (judgement.verdict, judgement.is_certain) == ("met", False)
    assert "ISO 7902-3" in judgement.unverified
    using = [c for cls in built_in() for c in cls.declared_criteria if "smallest_permissible_film" in c.names]
    taken = [c for c in using if not c.limits]
    assert [c.name for c in taken if c.unverified is None] == []
    assert len(taken) == 1  # of oil_film 2


def test_the_reason_of_a_missing_safety_factor_is_the_true_one():
    def safety(**changes):
        limits = {"required_safety_factor": 1.5}
        return judged(*FATIGUE, {**COMPRESSED, **changes}, limits, "safety")[0]

    endless = safety(mean_stress_correction="morrow")
    assert (endless.verdict, endless.give) == ("not_checked", ())
    assert "compression outweighs the amplitude" in endless.reason
    unloaded = safety(stress_amplitude="0 MPa", mean_stress="0 MPa")
    assert "there is no stress" in unloaded.reason
    unknown = safety(mean_stress="0 MPa", endurance_limit=None, design_life=None)
    assert unknown.reason == "needs endurance_limit or design_life, and some stress"


NO_THRESHOLD = "there is no threshold: the film is stable at every speed, or carries no mass"


def test_a_bearing_that_is_stable_at_every_speed_says_so():
    judgement, _ = judged(*FILM, {}, {}, "whirl")
    assert (judgement.verdict, judgement.reason) == ("met", NO_THRESHOLD)
    assert (judgement.value, judgement.limit, judgement.error_known) == (5000, None, True)
    weightless, _ = judged(*FILM, {**LIGHT, "rotor_mass": "0 kg"}, {}, "whirl")
    assert (weightless.verdict, weightless.reason) == ("met", NO_THRESHOLD)
    result = evaluate(built_in().get(*FILM), inputs(*FILM, {}), level="fit")
    fit = next(j for j in result.criteria if j.name == "whirl")
    assert (fit.verdict, "level `fit` cannot tell" in fit.reason) == ("not_checked", True)


def test_a_film_that_is_stable_only_within_its_error_is_undecided():
    result = evaluate(built_in().get(*FILM), inputs(*FILM, {}), level="short_bearing")
    whirl = next(j for j in result.criteria if j.name == "whirl")
    assert (whirl.verdict, whirl.reason) == (
        "undecided", f"within the error of the calculation: {NO_THRESHOLD}",
    )  # fmt: skip


def test_points_without_a_threshold_are_judged_with_those_that_have_one():
    cls = built_in().get(*FILM)
    values = {**inputs(*FILM, {}), "radial_load": {"value": [1, 25, 60], "unit": "kN"}}
    mixed = next(j for j in evaluate(cls, values).criteria if j.name == "whirl")
    assert (mixed.counts, mixed.where[0].value, mixed.reason) == ({"met": 3}, 1, None)
    assert mixed.limit == pytest.approx(14535.2, rel=1e-4)
    heavy = {**values, "radial_load": {"value": [25, 60], "unit": "kN"}}
    none = next(j for j in evaluate(cls, heavy).criteria if j.name == "whirl")
    assert (none.verdict, none.limit, none.reason) == ("met", None, NO_THRESHOLD)


@pytest.mark.parametrize("seed", range(20))
def test_what_is_judged_without_a_threshold_says_the_same_where_there_is_one(seed):
    """The comparison without a root against speed and threshold: random loads, masses and speeds."""
    random = np.random.default_rng(seed)
    changes = {
        "radial_load": f"{10 ** random.uniform(-2, 0.7)} kN",
        "rotor_mass": f"{10 ** random.uniform(0, 4)} kg",
        "speed": f"{random.uniform(500, 9000)} rpm",
        "sleeve_speed": f"{random.uniform(0, 2000)} rpm",
    }
    cls = built_in().get(*FILM)
    result = evaluate(cls, inputs(*FILM, changes))
    speed, threshold = (result.template.omega_J, result.template.omega_w)
    whirl = next(one for one in cls.declared_criteria if one.name == "whirl")
    instead = whirl.absent["whirl_threshold_speed"].instead
    estimates, absent = estimates_of(
        EvaluatedValues(result.template, result.outputs, result.error, None), instead
    )
    judgement = judge(instead, estimates, absent)
    assert (judgement.value <= judgement.limit) == (abs(speed) <= threshold)
    assert judgement.value / judgement.limit == pytest.approx((speed / threshold) ** 2, rel=1e-9)


def test_criteria_over_arrays_of_bearings():
    loads = {"value": [1, 25, 2500], "unit": "kN"}
    judgement, warnings = judged(*FILM, {"radial_load": loads}, BRONZE, "specific_load")
    assert (judgement.verdict, judgement.points, dict(judgement.counts)) == (
        "not_met", 3, {"met": 2, "not_met": 1},
    )  # fmt: skip
    assert judgement.value == pytest.approx(2500e3 / AREA)
    assert "pressure_deforms_bearing" in warnings


def test_the_source_of_a_limit_comes_from_its_row():
    by_row, _ = judged(*FILM, {}, BABBITT, "pressure")
    assert "ASTM B23" in by_row.source
    by_hand, _ = judged(*FILM, {}, {**BABBITT, "permissible_pressure": "20 MPa"}, "pressure")
    assert by_hand.source is None
    assert by_hand.limit == pytest.approx(20)


def test_the_note_on_swapped_bank_signs():
    assert "Bank angles with opposite signs" in built_in().get(*ENGINE).documentation()
