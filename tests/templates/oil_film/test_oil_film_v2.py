"""`oil_film` 2: literature at every level, statics of forces and speeds, heat balance, extremes.

Tables: Butenschön 1976 (the converged film of the standards; printed So is low by up to 0.55 % at eps 0.99),
Raimondi & Boyd 1958 (about 1.5 %, 3 % at eps 0.97), in tests/references with their definitions.
"""

import csv
from pathlib import Path

import numpy as np
import pytest

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.core.language.solve import solve
from templates.core.units.quantity import Typed
from templates.oil_film.oil_film_v2 import OilFilm
from templates.physics.films.short_bearing import attitude_Ocvirk_1952

REFERENCES = Path(__file__).parents[2] / "references"
D, PSI, ETA, OMEGA = 0.1, 1e-3, 0.02, 100.0


def table(name):
    lines = (REFERENCES / name).read_text(encoding="utf-8").splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    return {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}


def si(value, unit):
    """An SI value as if typed, in a unit of its kind."""
    return Typed(None, unit, value if np.ndim(value) == 0 else np.asarray(value, float), {})


def bearing(So, b, **others):
    """A bearing of given Sommerfeld number and width ratio, its viscosity given."""
    So, b = (np.float64(a) if np.ndim(a) == 0 else np.asarray(a, float) for a in (So, b))
    load = So * b * D**2 * ETA * OMEGA / PSI**2
    number = float if np.ndim(load) == 0 else np.asarray
    return {
        "radial_load": si(number(load), "N"),
        "bearing_width": si(number(b * D) if np.ndim(b) else float(b * D), "m"),
        "bearing_diameter": si(D, "m"),
        "diametral_clearance": si(PSI * D, "m"),
        "dynamic_viscosity": si(ETA, "Pa*s"),
        "speed": si(OMEGA, "rad/s"),
        **others,
    }


def outputs(raw, *names, **options):
    answers = evaluate(OilFilm, raw, outputs=names or None, **options).outputs
    values = {name: answer.value for name, answer in answers.items()}
    return values[names[0]] if len(names) == 1 else values


def case(**others):
    return {**OilFilm.example, **others}


def without(*names, **others):
    return {name: value for name, value in case(**others).items() if name not in names}


def balanced(**cooling):
    """The example cooled by a heat balance instead of known temperatures."""
    return without("oil_inlet_temperature", "oil_outlet_temperature", **cooling)


class TestLiterature:
    @pytest.mark.parametrize(("level", "film", "angle"), [("map", 0.012, 0.12), ("fit", 0.1, 3.0)])
    def test_literature_butenschoen_1976(self, level, film, angle):
        rows = table("static_film_butenschoen_1976.csv")
        inside = (rows["width_ratio"] >= 0.125) & (rows["width_ratio"] <= 1)
        rows = {name: values[inside] for name, values in rows.items()}
        result = outputs(bearing(rows["So"], rows["width_ratio"]), level=level)
        np.testing.assert_allclose(1 - result["relative_eccentricity"], 1 - rows["eps"], rtol=film)
        np.testing.assert_allclose(result["attitude_angle"], rows["beta_deg"], atol=angle)

    def test_literature_butenschoen_1976_at_full_solution(self):
        rows = table("static_film_butenschoen_1976.csv")
        some = slice(4, None, 23)
        result = outputs(bearing(rows["So"][some], rows["width_ratio"][some]), level="reynolds")
        np.testing.assert_allclose(1 - result["relative_eccentricity"], 1 - rows["eps"][some], rtol=0.012)
        np.testing.assert_allclose(result["attitude_angle"], rows["beta_deg"][some], atol=0.12)

    def test_literature_raimondi_boyd_1958(self):
        rows = table("raimondi_boyd_1958.csv")
        friction = outputs(bearing(1 / (2 * np.pi * rows["S"]), rows["length_ratio"]), "friction_coefficient")
        np.testing.assert_allclose(friction / PSI, rows["friction"], rtol=0.04)

    def test_literature_short_bearing_with_numbers(self):
        """R 50 mm, L 25 mm, 100 µm radial, 20 mPa s, 1 kN, 3000 rpm: shared reference, after Ocvirk."""
        raw = {
            "radial_load": "1 kN", "bearing_diameter": "100 mm", "bearing_width": "25 mm",
            "speed": "3000 rpm", "diametral_clearance": "200 um", "dynamic_viscosity": "20 mPa*s",
        }  # fmt: skip
        result = outputs(raw, level="short_bearing")
        assert result["relative_eccentricity"] == pytest.approx(0.6757879254, rel=1e-9)
        assert result["minimum_film_thickness"] == pytest.approx(32.421207, rel=1e-7)
        attitude = np.degrees(attitude_Ocvirk_1952(0.6757879254))
        assert result["attitude_angle"] == pytest.approx(attitude, rel=1e-9)

    def test_literature_oil_of_the_paper(self):
        """SAE 15W-40: 110 and 14.5 mm²/s at 40 and 100 °C (Bhadke et al. 2015)."""
        for temperature, viscosity in (("40 degC", 110), ("100 degC", 14.5)):
            raw = case(oil_inlet_temperature=temperature, oil_outlet_temperature=temperature)
            assert outputs(raw, "kinematic_viscosity") == pytest.approx(viscosity, rel=1e-12)

    def test_literature_oil_of_the_paper_by_vogel(self):
        """The same two viscosities, through which Vogel's law passes with Cameron's offset of 95 K."""
        for temperature, viscosity in (("40 degC", 110), ("100 degC", 14.5)):
            raw = case(
                oil_inlet_temperature=temperature, oil_outlet_temperature=temperature, viscosity_law="vogel"
            )
            assert outputs(raw, "kinematic_viscosity") == pytest.approx(viscosity, rel=1e-12)

    @pytest.mark.parametrize(
        ("grade", "at_40", "at_100"),
        [("iso_vg_46", 46, 6.644), ("sae_30", 97.78, 10.9), ("sae_5w_30", 68.4, 10.9)],
    )
    def test_literature_oil_by_grade(self, grade, at_40, at_100):
        for temperature, viscosity in (("40 degC", at_40), ("100 degC", at_100)):
            raw = case(oil_inlet_temperature=temperature, oil_outlet_temperature=temperature, oil_grade=grade)
            assert outputs(raw, "kinematic_viscosity") == pytest.approx(viscosity, rel=1e-12)

    def test_literature_lund_thomsen_1978(self):
        """Two axial grooves of 20° at ±90° to the load: eccentricity, attitude, all coefficients."""
        rows = table("lund_thomsen_1978.csv")
        grooves = {"value": [[90, 20], [270, 20]], "unit": "deg"}
        So = 1 / (2 * np.pi * rows["S"])
        for i in range(len(So)):
            result = outputs(bearing(float(So[i]), float(rows["length_ratio"][i]), grooves=grooves))
            assert result["relative_eccentricity"] == pytest.approx(rows["eps"][i], abs=0.002)
            assert result["attitude_angle"] == pytest.approx(rows["phi_deg"][i], abs=0.3)
            unit = (
                So[i] * rows["length_ratio"][i] * 2 * ETA * OMEGA * D / PSI**3
            )  # load over radial clearance
            for xy in ("xx", "xy", "yx", "yy"):
                over_load = result[f"stiffness_{xy}"] / unit
                assert over_load == pytest.approx(rows[f"K{xy}"][i], rel=0.05, abs=0.03), xy
            for xy in ("xx", "xy", "yy"):
                over_load = result[f"damping_{xy}"] * OMEGA / unit
                assert over_load == pytest.approx(rows[f"B{xy}"][i], rel=0.05, abs=0.03), xy

    @pytest.mark.parametrize(
        ("d", "rpm", "film"), [(50, 300, 3), (50, 5000, 7), (100, 100, 4), (500, 3000, 16)]
    )
    def test_literature_smallest_permissible_film(self, d, rpm, film):
        """DIN 31652-3, table 1, as textbooks quote it: not checked against the standard."""
        size = {"bearing_diameter": f"{d} mm", "bearing_width": f"{d / 2} mm"}
        raw = case(diametral_clearance=f"{d / 1000} mm", speed=f"{rpm} rpm", **size)
        assert outputs(raw, "smallest_permissible_film") == film


class TestLevels:
    def test_analytic_levels_meet_where_all_hold(self):
        """At B/D 1/4 and medium load closed form, map and both solutions tell the same film."""
        raw = bearing(0.2, 0.25)
        films = {level: outputs(raw, "minimum_film_thickness", level=level) for level in OilFilm.levels}
        assert films["reynolds"] == pytest.approx(films["map"], rel=1e-4)
        assert films["mass_conserving"] == pytest.approx(films["map"], rel=2e-3)
        assert films["fit"] == pytest.approx(films["map"], rel=0.05)
        assert films["short_bearing"] == pytest.approx(films["map"], rel=0.1)

    def test_property_fit_refuses_outside_its_widths(self):
        with pytest.raises(InvalidInputs, match=r"width ratio would be 2; it must be ≥ 0.125 and ≤ 1"):
            outputs(bearing(1, 2.0), "relative_eccentricity", level="fit")
        values = evaluate(OilFilm, bearing(np.ones(2), np.array([0.5, 2])), level="fit").outputs
        assert np.isnan(values["relative_eccentricity"].value).tolist() == [False, True]
        assert "width_ratio must be ≥ 0.125" in values["relative_eccentricity"].reasons[1]

    def test_property_short_bearing_warns_where_it_is_not_short(self):
        warnings = evaluate(OilFilm, bearing(1, 0.5), level="short_bearing").warnings
        assert [w.name for w in warnings] == ["width_ratio"]
        assert evaluate(OilFilm, bearing(1, 0.2), level="short_bearing").warnings == []

    def test_property_level_and_boundary_are_told(self):
        for level in OilFilm.levels:
            evaluation = evaluate(OilFilm, bearing(1, 0.5), outputs=["boundary_condition"], level=level)
            assert evaluation.level == level
            assert evaluation.outputs["boundary_condition"].value
        assert evaluate(OilFilm, bearing(1, 0.5)).level == "map"

    def test_property_feed_takes_the_level_that_knows_it(self):
        grooves = {"value": [[90, 20], [270, 20]], "unit": "deg"}
        evaluation = evaluate(OilFilm, bearing(1, 0.5, grooves=grooves), outputs=["relative_eccentricity"])
        assert evaluation.level == "mass_conserving"
        named = evaluate(OilFilm, bearing(1, 0.5, supply_pressure="2 bar"), level="map")
        assert {w.code for w in named.warnings} == {"unused_input"}

    def test_analytic_supply_pressure_adds_flow(self):
        dry, fed = (
            outputs(bearing(1, 0.5, supply_pressure=p), "side_flow", level="mass_conserving")
            for p in ("0 bar", "5 bar")
        )
        assert fed > dry

    def test_property_dear_levels_take_few_points(self):
        with pytest.raises(InvalidInputs, match="level reynolds takes at most 400 points at once, not 500"):
            evaluate(OilFilm, bearing(np.ones(500), np.ones(500)), level="reynolds")

    def test_property_tables_are_checked(self):
        shapes = ([1, 2, 3], [[[1, 2]]], [[90, 20]] * 13, [[90, -400]], [[900, 10]])
        for wrong in ({"value": rows, "unit": "deg"} for rows in shapes):
            with pytest.raises(InvalidInputs, match="grooves are at most 12 rows of angle from the load"):
                evaluate(OilFilm, bearing(1, 0.5, grooves=wrong))


class TestSolve:
    @pytest.mark.parametrize("level", [None, "short_bearing", "reynolds", "mass_conserving"])
    def test_property_load_for_a_film_at_any_level(self, level):
        raw = bearing(1.0, 0.5)
        del raw["radial_load"]
        target = {"minimum_film_thickness": "10 um"}
        result = solve(OilFilm, raw, "radial_load", ["1 N", "1 MN"], target, level=level)
        answer = result.evaluation.outputs["minimum_film_thickness"].value
        assert result.evaluation.level == (level or "map")
        assert answer == pytest.approx(10, rel=1e-4 if level == "mass_conserving" else 1e-8)

    def test_property_solve_with_a_tolerance(self):
        raw = bearing(1.0, 0.5)
        del raw["radial_load"]
        target = {"minimum_film_thickness": "10 um"}
        result = solve(
            OilFilm, raw, "radial_load", ["1 N", "1 MN"], target, tolerance=0.1, outputs=list(target)
        )
        assert result.evaluation.level == "fit"
        assert result.evaluation.outputs["minimum_film_thickness"].value == pytest.approx(10, rel=1e-8)


class TestMotion:
    def test_analytic_only_the_hydrodynamic_speed_makes_a_film(self):
        still = outputs(bearing(1, 0.5), "relative_eccentricity")
        turned = bearing(1, 0.5, speed="20 rad/s", sleeve_speed="40 rad/s", load_speed="-20 rad/s")
        assert outputs(turned, "relative_eccentricity") == pytest.approx(still, rel=1e-12)
        assert outputs(turned, "sliding_speed") == -20

    def test_analytic_reversed_speed_is_a_mirror_image(self):
        forward = outputs(bearing(1, 0.5))
        assert outputs(bearing(1, 0.5, speed="-100 rad/s")) == forward

    def test_analytic_power_is_the_work_of_all_torques(self):
        """Shear couple and load couple against journal, sleeve and the load's own motion."""
        speeds = {"speed": "120 rad/s", "sleeve_speed": "30 rad/s", "load_speed": "25 rad/s"}
        out = outputs(bearing(1, 0.5, **speeds))
        shear, couple = out["shear_torque"], out["load_couple"]
        work = (shear + couple) * 120 - (shear - couple) * 30 - 2 * couple * 25
        assert out["power_loss"] == pytest.approx(work, rel=1e-12)

    def test_property_no_speed_is_refused_by_name(self):
        for speeds in ({"speed": "0 rpm"}, {"sleeve_speed": "-100 rad/s"}, {"load_speed": "50 rad/s"}):
            with pytest.raises(InvalidInputs, match="hydrodynamic speed would be 0"):
                outputs(bearing(1, 0.5, **speeds), "minimum_film_thickness")

    def test_analytic_no_load(self):
        out = outputs(bearing(0.0, 0.5))
        assert out["relative_eccentricity"] == 0
        assert out["friction_torque"] == pytest.approx(np.pi * ETA * OMEGA * 0.5 * D**3 / (2 * PSI))
        reason = evaluate(OilFilm, bearing(0.0, 0.5)).outputs["friction_coefficient"].reason
        assert "no load" in reason
        assert np.isfinite([out[f"stiffness_{xy}"] for xy in ("xx", "xy", "yx", "yy")]).all()

    def test_analytic_coefficients_are_derivatives_of_the_load(self):
        """k_xx and k_yx by moving the static position along the load line: their sum balances dF."""
        low, high = (outputs(bearing(So, 0.5)) for So in (1.0, 1.0001))
        middle = outputs(bearing(1.00005, 0.5))
        x, y = (
            np.array([f(np.radians(o["attitude_angle"])) * o["relative_eccentricity"] for o in (low, high)])
            for f in (np.cos, np.sin)
        )
        step = np.array([np.diff(x)[0], np.diff(y)[0]]) * PSI * D / 2
        K = np.array([[middle[f"stiffness_{i}{j}"] for j in "xy"] for i in "xy"])
        load = 0.5 * D**2 * ETA * OMEGA / PSI**2 * 1e-4
        np.testing.assert_allclose(K @ step, [load, 0], rtol=2e-2, atol=2e-2 * load)

    def test_analytic_whirl_threshold(self):
        """M omega² = threshold mass: four times the mass halves the speed; a heavy load never whirls."""
        light = bearing(0.1, 0.5, rotor_mass="100 kg")
        heavy = bearing(0.1, 0.5, rotor_mass="400 kg")
        assert outputs(light, "whirl_threshold_speed") == pytest.approx(
            2 * outputs(heavy, "whirl_threshold_speed")
        )
        answer = evaluate(OilFilm, bearing(30.0, 0.5)).outputs["whirl_threshold_speed"]
        assert answer.value is None
        assert "stable at every speed" in answer.reason


VOGEL = {
    "viscosity_law": "vogel",
    "vogel_factor": "0.1 mPa*s",
    "vogel_slope": "900 K",
    "vogel_offset": "90 K",
}


class TestVogel:
    def test_analytic_constants_make_the_viscosity(self):
        raw = case(**VOGEL, oil_inlet_temperature="70 degC", oil_outlet_temperature="90 degC")
        assert outputs(raw, "dynamic_viscosity") == pytest.approx(0.1 * np.exp(900 / 170), rel=1e-12)

    def test_analytic_constants_found_are_those_that_made_the_viscosities(self):
        """Two viscosities of a Vogel oil give its constants back."""
        at = {t: 0.1 * np.exp(900 / (t + 90)) for t in (40, 100)}
        rho = {t: 0.875 * (1 - 0.0007 * (t - 20)) for t in at}
        nu = [f"{at[t] / rho[t]:.15g} mm**2/s" for t in at]
        raw = case(
            viscosity_law="vogel",
            vogel_offset="90 K",
            kinematic_viscosity_1=nu[0],
            kinematic_viscosity_2=nu[1],
        )
        result = outputs(raw, "vogel_factor", "vogel_slope")
        assert result["vogel_factor"] == pytest.approx(0.1, rel=1e-10)
        assert result["vogel_slope"] == pytest.approx(900, rel=1e-10)

    def test_property_laws_agree_between_their_points_and_part_beyond(self):
        def film(law, temperature):
            t = f"{temperature} degC"
            raw = case(viscosity_law=law, oil_inlet_temperature=t, oil_outlet_temperature=t)
            return outputs(raw, "dynamic_viscosity")

        assert film("vogel", 70) == pytest.approx(film("walther", 70), rel=0.02)
        assert abs(film("vogel", -20) / film("walther", -20) - 1) > 0.05

    def test_analytic_heat_balance_closes_with_vogels_viscosity(self):
        raw = balanced(**VOGEL, supply_temperature="40 degC")
        result = outputs(raw)
        assert result["dynamic_viscosity"] == pytest.approx(
            0.1 * np.exp(900 / (result["film_temperature"] + 90))
        )
        carried = 1.8e6 * result["side_flow"] / 6e4 * result["temperature_rise"]
        assert carried == pytest.approx(result["power_loss"], rel=1e-8)

    @pytest.mark.parametrize(
        ("change", "names"),
        [
            ({"vogel_slope": None}, {"vogel_factor", "vogel_slope"}),
            ({"vogel_factor": None}, {"vogel_factor", "vogel_slope"}),
            ({"viscosity_law": "walther"}, {"viscosity_law"}),
            ({"vogel_factor": None, "vogel_slope": None, "vogel_offset": "-60 K"},
             {"temperature_1", "temperature_2", "vogel_offset"}),
            ({"oil_inlet_temperature": "-90 degC", "oil_outlet_temperature": "-91 degC"},
             {"dynamic_viscosity"}),
        ],
    )  # fmt: skip
    def test_property_half_given_or_beyond_the_pole_is_refused_by_name(self, change, names):
        raw = {name: value for name, value in {**case(**VOGEL), **change}.items() if value is not None}
        with pytest.raises(InvalidInputs) as refusal:
            outputs(raw, "minimum_film_thickness")
        assert {name for fault in refusal.value.faults for name in fault.names} == names

    def test_property_arrays_are_masked_where_the_oil_is_stiff(self):
        t = {"value": [-95.0, -60.0, 80.0], "unit": "degC"}
        raw = case(**VOGEL, oil_inlet_temperature=t, oil_outlet_temperature=t)
        answer = evaluate(OilFilm, raw, outputs=["minimum_film_thickness"]).outputs["minimum_film_thickness"]
        assert np.isnan(answer.value).tolist() == [True, False, False]
        assert "pole" in answer.reasons[0]


class TestHeatBalance:
    @pytest.mark.parametrize(
        "cooling",
        [
            {"supply_temperature": "40 degC"},
            {"supply_temperature": "-40 degC"},
            {"ambient_temperature": "20 degC", "heat_transfer": "20 W/K"},
            {"supply_temperature": "90 degC", "ambient_temperature": "-20 degC", "heat_transfer": "5 W/K"},
        ],
    )
    @pytest.mark.parametrize("load", ["1 N", "1 kN", "25 kN"])
    def test_property_converges_and_reports_its_residual(self, cooling, load):
        out = outputs(balanced(radial_load=load, **cooling), level="map")
        assert abs(out["heat_balance_residual"]) < 1e-9
        by_air = float(cooling.get("heat_transfer", "0 W").split()[0])
        air = float(cooling.get("ambient_temperature", "0 degC").split()[0])
        rise = 0.0 if out["temperature_rise"] is None else out["temperature_rise"]
        carried = 1.8e6 * out["side_flow"] / 6e4 * rise + by_air * (out["film_temperature"] - air)
        assert carried == pytest.approx(out["power_loss"], rel=1e-8)

    def test_property_temperature_does_not_depend_on_level(self):
        raw = balanced(supply_temperature="60 degC")
        result = {level: outputs(raw, "film_temperature", level=level) for level in OilFilm.levels}
        assert len(set(result.values())) == 1

    def test_property_array_is_pointwise(self):
        rng = np.random.default_rng(1)
        supply, load = rng.uniform(0, 120, 50), 10 ** rng.uniform(0, 5, 50)
        together = outputs(
            balanced(
                supply_temperature={"value": supply.tolist(), "unit": "degC"},
                radial_load={"value": load.tolist(), "unit": "N"},
            ),
            "film_temperature",
        )
        for i in range(0, 50, 7):
            alone = balanced(
                supply_temperature={"value": float(supply[i]), "unit": "degC"},
                radial_load={"value": float(load[i]), "unit": "N"},
            )
            assert outputs(alone, "film_temperature") == pytest.approx(together[i], rel=1e-9)

    def test_property_no_balance_is_refused_by_name(self):
        """Without load no oil leaves the film, and nothing carries the heat off."""
        with pytest.raises(InvalidInputs, match="heat balance finds none below 500 °C"):
            outputs(balanced(radial_load="0 N", supply_temperature="40 degC"), "film_temperature")

    def test_property_unknown_temperature_is_refused_by_name(self):
        with pytest.raises(InvalidInputs, match="viscosity follows from some temperature") as refusal:
            outputs(balanced(), "minimum_film_thickness")
        assert {name for fault in refusal.value.faults for name in fault.names} == {
            "oil_inlet_temperature",
            "oil_outlet_temperature",
        }

    def test_property_overruled_temperatures_are_told(self):
        warnings = evaluate(OilFilm, case(supply_temperature="60 degC")).warnings
        assert {w.code for w in warnings} == {"unused_input"}


class TestAbsence:
    def test_property_optional_outputs_are_absent_with_reason(self):
        raw = without("journal_roughness", "bearing_roughness")
        answers = evaluate(OilFilm, raw).outputs
        for name, word in {
            "film_parameter": "journal_roughness",
            "lubrication_regime": "journal_roughness",
            "outlet_temperature": "supply_temperature",
            "heat_balance_residual": "supply_temperature",
        }.items():
            assert answers[name].value is None
            assert word in answers[name].reason, name

    def test_property_viscosity_given_needs_no_temperature(self):
        answers = evaluate(OilFilm, bearing(1, 0.5)).outputs
        assert answers["dynamic_viscosity"].value == pytest.approx(20)
        assert answers["film_temperature"].value is None
        assert answers["film_reynolds_number"].value > 0

    def test_property_regime(self):
        for roughness, regime in ((0.2, "full_film"), (1.2, "mixed"), (5, "boundary")):
            raw = case(journal_roughness=f"{roughness} um", bearing_roughness="0 um")
            assert outputs(raw, "lubrication_regime") == regime

    def test_property_turbulence_warns(self):
        raw = bearing(0.1, 0.5, speed="20000 rad/s", dynamic_viscosity="0.1 mPa*s")
        assert "turbulence_ratio" in {w.name for w in evaluate(OilFilm, raw).warnings}

    @pytest.mark.parametrize("name", list(OilFilm.inputs))
    def test_property_every_input_is_taken(self, name):
        declared = OilFilm.inputs[name]
        typical = {
            "oil_grade": "iso_vg_68", "viscosity_law": "vogel",
            "grooves": {"value": [180, 20], "unit": "deg"},
            "sleeve_speed": "100 rpm", "load_speed": "100 rpm", "dynamic_viscosity": "15 mPa*s",
            "supply_temperature": "50 degC",
            "ambient_temperature": "20 degC", "heat_transfer": "20 W/K", "supply_pressure": "3 bar",
            "kinematic_viscosity_1": "100 mm**2/s", "kinematic_viscosity_2": "12 mm**2/s",
            "rotor_mass": "5 kg", "temperature_1": "50 degC", "temperature_2": "90 degC",
            "reference_temperature": "15 degC",
            "reference_density": "860 kg/m**3", "heat_capacity": "1700 kJ/(m**3*K)",
        }  # fmt: skip
        companions = VOGEL if name.startswith("vogel") else {}
        raw = case(**{**companions, name: typical.get(name, companions.get(name, OilFilm.example.get(name)))})
        assert (
            evaluate(OilFilm, raw, outputs=["minimum_film_thickness"]).inputs[declared.name].source == "given"
        )


class TestExtremes:
    """physics.md, section 5: each a finite number, or none with its reason; never NaN, inf or a hang."""

    def test_property_ten_thousand_draws(self):
        rng, n = np.random.default_rng(5), 10_000
        raw = {
            "radial_load": si(10 ** rng.uniform(-6, 9, n) * (rng.random(n) > 0.05), "N"),
            "bearing_diameter": si(D * np.ones(n), "m"),
            "bearing_width": si(D * 10 ** rng.uniform(-2.02, 2.02, n), "m"),
            "diametral_clearance": si(D * 10 ** rng.uniform(-5, -1, n), "m"),
            "speed": si(rng.choice([-1, 0, 1], n, p=[0.3, 0.1, 0.6]) * 10 ** rng.uniform(-3, 4, n), "rad/s"),
            "oil_inlet_temperature": si(rng.uniform(213, 573, n), "K"),
            "oil_outlet_temperature": si(rng.uniform(213, 573, n), "K"),
            "kinematic_viscosity_1": si(10 ** rng.uniform(-7, -3, n), "m**2/s"),
            "kinematic_viscosity_2": si(10 ** rng.uniform(-7, -4, n), "m**2/s"),
            "journal_roughness": si(2e-7, "m"),
            "bearing_roughness": si(2e-7, "m"),
        }
        for level in ("short_bearing", "fit", "map"):
            answers = evaluate(OilFilm, raw, level=level).outputs
            assert_finite_or_reasoned(answers, n)
            assert np.isfinite(answers["minimum_film_thickness"].value).sum() > n / 20

    def test_property_ten_thousand_heat_balances(self):
        rng, n = np.random.default_rng(6), 10_000
        raw = balanced(
            radial_load=si(10 ** rng.uniform(-3, 7, n), "N"),
            speed=si(10 ** rng.uniform(-1, 4, n), "rad/s"),
            supply_temperature=si(rng.uniform(213, 573, n), "K"),
            ambient_temperature=si(rng.uniform(213, 333, n), "K"),
            heat_transfer=si(10 ** rng.uniform(-2, 3, n), "W/K"),
        )
        answers = evaluate(OilFilm, raw).outputs
        assert_finite_or_reasoned(answers, n)
        residual = answers["heat_balance_residual"].value
        assert np.isfinite(residual).sum() > n / 2
        assert np.nanmax(np.abs(residual)) < 1e-5  # of a power that a rounding of T outweighs

    @pytest.mark.parametrize("level", ["short_bearing", "fit", "map"])
    def test_property_film_falls_with_load(self, level):
        for b in (0.01, 0.2, 1.0, 10.0, 100.0):
            if level == "fit" and not 0.125 <= b <= 1:
                continue
            film = outputs(bearing(np.geomspace(1e-8, 1e6, 4000), b), "minimum_film_thickness", level=level)
            assert (np.diff(film[np.isfinite(film)]) < 0).mean() > 0.7  # below 1e-16 of the gap it cannot
            assert (np.diff(film[np.isfinite(film)]) <= 0).all()

    @pytest.mark.slow
    def test_property_odd_feeds_answer_or_refuse_by_name(self):
        """Grooves anywhere, supply pressure, load or none, speeds of either sense or none."""
        rng, refused = np.random.default_rng(8), []
        for _ in range(60):
            raw = bearing(
                10 ** rng.uniform(-8, 3) * (rng.random() > 0.1),
                10 ** rng.uniform(-2, 2),
                speed=si(rng.choice([-1, 0, 1], p=[0.3, 0.1, 0.6]) * 10 ** rng.uniform(-2, 4), "rad/s"),
                load_speed=si(rng.choice([0, -30, 50]), "rad/s"),
                supply_pressure=si(rng.choice([0.0, 10 ** rng.uniform(2, 8)]), "Pa"),
                grooves=si(np.radians([[rng.uniform(-360, 720), w] for w in rng.uniform(0, 80, 3)]), "rad"),
            )
            try:
                answers = evaluate(OilFilm, raw).outputs
            except InvalidInputs as refusal:
                refused += [fault.name for fault in refusal.faults]
                continue
            for name, answer in answers.items():
                assert answer.reason or answer.unit is None or np.isfinite(answer.value), name
        assert set(refused) <= {"relative_eccentricity", "hydrodynamic_speed"}
        assert 0 < len(refused) < 40

    @pytest.mark.parametrize(
        "grooves",
        [[[450, 20], [270, 20]], [[-270, 20], [-90, 20]], [[90, 20], [90, 20], [270, 20]],
         [[90, 20], [95, 10], [270, 20]]],
    )  # fmt: skip
    def test_analytic_grooves_turned_full_circle_or_doubled_are_the_same(self, grooves):
        def film(rows):
            return outputs(
                bearing(1.0, 0.5, grooves={"value": rows, "unit": "deg"}), "minimum_film_thickness"
            )

        assert film(grooves) == pytest.approx(film([[90, 20], [270, 20]]), rel=1e-6)

    @pytest.mark.parametrize("width", [-20, 361])
    def test_property_groove_of_impossible_width_is_refused(self, width):
        raw = bearing(1.0, 0.5, grooves={"value": [[90, 20], [270, width]], "unit": "deg"})
        with pytest.raises(InvalidInputs, match="each groove is 0° to 360° wide") as refusal:
            outputs(raw, "minimum_film_thickness")
        assert [fault.name for fault in refusal.value.faults] == ["grooves"]

    def test_property_a_groove_all_around_bears_nothing(self):
        raw = bearing(1.0, 0.5, grooves={"value": [[0, 360]], "unit": "deg"})
        with pytest.raises(InvalidInputs, match="move the grooves"):
            outputs(raw, "minimum_film_thickness")

    def test_property_groove_of_no_width_is_a_line(self):
        line, narrow = (
            outputs(
                bearing(1.0, 0.5, grooves={"value": [[200, width]], "unit": "deg"}), "relative_eccentricity"
            )
            for width in (0, 1)
        )
        assert line == pytest.approx(narrow, abs=0.01)

    @pytest.mark.slow
    @pytest.mark.parametrize("level", ["reynolds", "mass_conserving"])
    def test_property_solutions_at_extremes(self, level):
        rng = np.random.default_rng(7)
        n = 20
        for _ in range(3):
            raw = bearing(10 ** rng.uniform(-8, 6, n), 10 ** rng.uniform(-2, 2, n))
            assert_finite_or_reasoned(evaluate(OilFilm, raw, level=level).outputs, n)


def assert_finite_or_reasoned(answers, n):
    for name, answer in answers.items():
        if answer.unit is None:
            continue
        value = np.broadcast_to(np.asarray(answer.value, float), n)
        reasons = np.full(n, answer.reason) if answer.reasons is None else answer.reasons
        assert not np.isinf(value).any(), name
        np.testing.assert_array_equal(np.isnan(value), reasons != None, err_msg=name)  # noqa: E711
