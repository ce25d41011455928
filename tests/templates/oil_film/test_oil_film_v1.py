"""`oil_film` 1 against its paper: Bhadke, Chaudhari, Sharma, IJETR 3(5), 2015.

The print gives of its worked case F = 25 kN, c = 0.055 mm, D = 48 mm and h0 = 3.2449 µm, but neither width,
speed nor temperatures. From h0 follow eps = 0.8821 and So = 3.948, and no more than that is compared.
Oil: SAE 15W-40 with 110 and 14.5 mm²/s at 40 and 100 °C, 875 kg/m³ at 20 °C. The constants k1, k2 stand in
the paper's table of the fit.
"""

from math import pi

import numpy as np
import pytest

from templates.core.errors import InvalidInputs, Unreachable
from templates.core.language.evaluate import evaluate
from templates.core.language.solve import solve
from templates.oil_film.oil_film_v1 import OilFilm

CASE = {"radial_load": "25 kN", "diametral_clearance": "0.055 mm", "bearing_diameter": "48 mm"}
K_TABLE = [(1.0, 0.798, 0.073), (9.999, 0.798, 0.073), (10.0, 0.897, 0.022), (100.0, 0.897, 0.022),
           (100.01, 0.980, 0.0028), (200.0, 0.980, 0.0028)]  # fmt: skip


def outputs(raw, *names, **options):
    answers = evaluate(OilFilm, raw, outputs=names or None, **options).outputs
    return {name: answer.value for name, answer in answers.items()}


def case(width, speed, temperature, **others):
    """The worked case with a width [mm], a speed [rpm] and a temperature [°C]."""
    return {
        **CASE,
        "bearing_width": f"{width} mm",
        "speed": f"{speed} rpm",
        "oil_inlet_temperature": f"{temperature} degC",
        "oil_outlet_temperature": f"{temperature} degC",
        **others,
    }


def load_for(sommerfeld, **case_of):
    """The inputs with the load that gives a Sommerfeld number, at the W/D of the fit."""
    raw = case(18.07, 4000, 90, **case_of)
    unit = outputs({**raw, "radial_load": "1 N"}, "sommerfeld_number")["sommerfeld_number"]
    return {**raw, "radial_load": f"{sommerfeld / unit:.17g} N"}


def speed_for(sommerfeld, width, temperature):
    """The worked case at the speed that gives a Sommerfeld number."""
    at_one = outputs(case(width, 1, temperature), "sommerfeld_number")["sommerfeld_number"]
    return case(width, f"{at_one / sommerfeld:.17g}", temperature)


class TestLiterature:
    @pytest.mark.parametrize("width", [12, 18.07, 30])
    @pytest.mark.parametrize("temperature", [60, 84, 120])
    def test_literature_worked_case(self, width, temperature):
        result = outputs(speed_for(3.948, width, temperature))
        assert result["sommerfeld_number"] == pytest.approx(3.948, rel=1e-12)
        assert result["relative_eccentricity"] == pytest.approx(0.8821, abs=5e-5)
        assert result["minimum_film_thickness"] == pytest.approx(3.245, abs=5e-4)

    def test_literature_example_is_the_worked_case(self):
        result = outputs(OilFilm.example)
        assert result["minimum_film_thickness"] == pytest.approx(3.2449, abs=5e-5)
        assert result["journal_diameter"] == pytest.approx(47.945)

    @pytest.mark.parametrize(("temperature", "viscosity"), [(40, 110), (100, 14.5)])
    def test_literature_oil_at_its_two_temperatures(self, temperature, viscosity):
        """SAE 15W-40 as the paper gives it."""
        result = outputs(case(18, 3000, temperature), "kinematic_viscosity")
        assert result["kinematic_viscosity"] == pytest.approx(viscosity, rel=1e-9)

    @pytest.mark.parametrize(("sommerfeld", "k1", "k2"), K_TABLE)
    def test_literature_table_of_the_fit(self, sommerfeld, k1, k2):
        """10 and 100 are nudged into their row: by rounding the computed So may fall on either side."""
        nudged = sommerfeld * {10.0: 1 + 1e-12, 100.0: 1 - 1e-12}.get(sommerfeld, 1)
        result = outputs(load_for(nudged))
        assert (result["fit_factor"], result["fit_exponent"]) == (k1, k2)
        assert result["relative_eccentricity"] == pytest.approx(k1 * sommerfeld**k2, rel=1e-10)

    def test_literature_fit_drops_at_its_seams(self):
        """Errata: eps 0.9441 → 0.9436 at So = 10, where h0 jumps up 0.8 %; at 100 h0 falls by 1 %."""
        below, above = (outputs(load_for(10 * f)) for f in (1 - 1e-9, 1 + 1e-9))
        assert below["relative_eccentricity"] == pytest.approx(0.9441, abs=5e-5)
        assert above["relative_eccentricity"] == pytest.approx(0.9436, abs=5e-5)
        assert above["minimum_film_thickness"] / below["minimum_film_thickness"] == pytest.approx(
            1.008, abs=1e-3
        )
        below, above = (outputs(load_for(100 * f)) for f in (1 - 1e-9, 1 + 1e-9))
        assert above["minimum_film_thickness"] / below["minimum_film_thickness"] == pytest.approx(
            0.99, abs=1e-3
        )

    def test_literature_every_intermediate_value_is_there(self):
        """The rows of the paper's worksheet, recalculated here step by step from its formulas."""
        result = evaluate(OilFilm, OilFilm.example).template
        F, c, D, W, omega, T = 25e3, 55e-6, 48e-3, 18e-3, 5000 * pi / 30, (80 + 87.762) / 2 + 273.15
        d, C = D - c, c / (D - c)
        rho = 875 * (1 - 0.0007 * (T - 293.15))
        y1, y2 = np.log10(np.log10([110.7, 15.2]))
        x1, x2 = np.log10([313.15, 373.15])
        B = (y1 - y2) / (x2 - x1)
        A = y2 + B * x2
        nu = (10**10 ** (A - B * np.log10(T)) - 0.7) * 1e-6
        eta = nu * rho
        So = F * C**2 / (D * W * eta * omega)
        eps = 0.798 * So**0.073
        h0 = D * C * (1 - eps) / 2
        expected = {"d": d, "C": C, "T": T, "rho": rho, "B": B, "A": A, "nu": nu, "eta": eta, "S_0": So,
                    "k_1": 0.798, "k_2": 0.073, "eps": eps, "h_0": h0}  # fmt: skip
        assert {name: getattr(result, name) for name in expected} == pytest.approx(expected, rel=1e-12)


class TestUnits:
    def test_literature_any_unit_gives_the_same(self):
        si = {**CASE, "bearing_width": "18 mm", "speed": "5000 rpm", "oil_inlet_temperature": "80 degC",
              "oil_outlet_temperature": "90 degC"}  # fmt: skip
        other = {
            "radial_load": f"{25e3 / 4.4482216152605:.15g} lbf",
            "diametral_clearance": f"{0.055 / 25.4:.15g} inch",
            "bearing_diameter": {"value": 48e-3, "unit": "m"},
            "bearing_width": f"{18 / 25.4:.15g} in",
            "speed": f"{5000 * pi / 30:.15g} rad/s",
            "oil_inlet_temperature": "353.15 K",
            "oil_outlet_temperature": "194 degF",
            "reference_temperature": "68 °F",
            "kinematic_viscosity_1": "1.1 cm²/s",
            "kinematic_viscosity_2": "14.5 cSt",
        }
        assert outputs(other) == pytest.approx(outputs(si), rel=1e-12)

    @pytest.mark.parametrize(("unit", "factor"), [("mm", 1e-3), ("inch", 1e-3 / 25.4), ("um", 1.0)])
    def test_analytic_output_in_the_unit_asked_for(self, unit, factor):
        shown = evaluate(OilFilm, OilFilm.example, units={"minimum_film_thickness": unit}).outputs
        micrometres = outputs(OilFilm.example)["minimum_film_thickness"]
        assert shown["minimum_film_thickness"].value == pytest.approx(micrometres * factor)
        assert shown["minimum_film_thickness"].unit == unit


class TestLimits:
    @pytest.mark.parametrize("sommerfeld", [0.5, 250.0])
    def test_literature_warns_outside_the_fit(self, sommerfeld):
        (warning,) = evaluate(OilFilm, load_for(sommerfeld), outputs=["minimum_film_thickness"]).warnings
        assert (warning.code, warning.name) == ("outside_published_range", "sommerfeld_number")
        assert "≥ 1 and ≤ 200" in warning.detail
        assert f"{sommerfeld:g}" in warning.detail

    def test_literature_warns_of_another_width(self):
        """W/D does not enter h0, so the limit must be checked although nothing asks for the ratio."""
        raw = {**speed_for(3.948, 48, 90)}
        (warning,) = evaluate(OilFilm, raw, outputs=["minimum_film_thickness"]).warnings
        assert warning.name == "width_ratio"
        assert "32/85 = 0.376" in warning.detail
        assert warning.detail.count("here it is 1;") == 1

    @pytest.mark.parametrize("sommerfeld", [1.0000001, 199.999])
    def test_literature_does_not_warn_within(self, sommerfeld):
        assert evaluate(OilFilm, load_for(sommerfeld)).warnings == []

    def test_literature_nothing_that_needs_no_fit_warns(self):
        assert evaluate(OilFilm, speed_for(0.5, 48, 90), outputs=["dynamic_viscosity"]).warnings == []

    def test_literature_fit_ends_at_1360(self):
        """From there on k1 So^k2 ≥ 1: (1 / 0.98)^(1 / 0.0028) = 1360."""
        assert outputs(load_for(1355))["relative_eccentricity"] < 1
        with pytest.raises(InvalidInputs, match="relative eccentricity would be 1") as refusal:
            outputs(load_for(1365))
        (fault,) = refusal.value.faults
        assert (fault.name, fault.code) == ("relative_eccentricity", "outside_domain")
        assert "1360" in fault.detail
        assert "radial_load" in fault.detail

    @pytest.mark.parametrize(
        ("name", "value", "code"),
        [
            ("speed", "0 rpm", "out_of_range"),
            ("speed", "-3000 rpm", "out_of_range"),
            ("diametral_clearance", "-4 um", "out_of_range"),
            ("diametral_clearance", "48 mm", "inconsistent"),
            ("kinematic_viscosity_2", "0.3 mm²/s", "out_of_range"),
            ("kinematic_viscosity_2", "200 mm²/s", "inconsistent"),
            ("temperature_2", "40 degC", "inconsistent"),
            ("oil_inlet_temperature", "-300 degC", "out_of_range"),
            ("bearing_width", "40 MPa", "wrong_unit"),
            ("speed", "50 Hz", "ambiguous_unit"),
        ],
    )
    def test_literature_refuses_by_name(self, name, value, code):
        with pytest.raises(InvalidInputs) as refusal:
            outputs({**OilFilm.example, name: value})
        assert (name, code) in {(one, fault.code) for fault in refusal.value.faults for one in fault.names}

    def test_literature_all_wrong_inputs_at_once(self):
        wrong = {"speed": "50 1/s", "bearing_width": True, "diametral_clearance": "-4 um", "lenght": "1 mm"}
        with pytest.raises(InvalidInputs) as refusal:
            evaluate(OilFilm, wrong, outputs=["film"], units={"density": "mm"})
        names = {name for fault in refusal.value.faults for name in fault.names}
        missing = {"radial_load", "bearing_diameter", "oil_inlet_temperature", "oil_outlet_temperature"}
        assert names == {*wrong, *missing, "film", "units.density"}


class TestExtremes:
    """physics.md, section 5, as far as it touches version 1."""

    def test_analytic_no_load_means_concentric(self):
        result = outputs({**OilFilm.example, "radial_load": "0 N"})
        assert result["relative_eccentricity"] == 0
        assert result["minimum_film_thickness"] == pytest.approx(24e3 * 0.055 / 47.945)

    def test_analytic_equal_viscosities_do_not_change_with_temperature(self):
        result = outputs({**OilFilm.example, "kinematic_viscosity_2": "110 mm²/s"})
        assert result["kinematic_viscosity"] == pytest.approx(110)

    def test_property_whole_range_is_finite_or_refused(self):
        rng, n = np.random.default_rng(5), 20_000
        D = 10 ** rng.uniform(-3, 0, n)
        answers = evaluate(
            OilFilm,
            {
                "radial_load": {"value": (10 ** rng.uniform(-6, 9, n)).tolist(), "unit": "N"},
                "bearing_diameter": {"value": D.tolist(), "unit": "m"},
                "diametral_clearance": {"value": (D * 10 ** rng.uniform(-5, -1, n)).tolist(), "unit": "m"},
                "bearing_width": {"value": (D * 10 ** rng.uniform(-2, 2, n)).tolist(), "unit": "m"},
                "speed": {"value": (10 ** rng.uniform(-3, 6, n)).tolist(), "unit": "rpm"},
                "oil_inlet_temperature": {"value": rng.uniform(-60, 300, n).tolist(), "unit": "degC"},
                "oil_outlet_temperature": {"value": rng.uniform(-60, 300, n).tolist(), "unit": "degC"},
            },
        ).outputs
        thickness, sommerfeld = (answers[name] for name in ("minimum_film_thickness", "sommerfeld_number"))
        assert np.isfinite(sommerfeld.value).all()
        present = np.isfinite(thickness.value)
        np.testing.assert_array_equal(present, 0.98 * sommerfeld.value**0.0028 < 1)
        assert (thickness.value[present] > 0).all()
        assert all("1360" in reason for reason in thickness.reasons[~present])

    def test_analytic_million_points(self):
        speed = np.linspace(1000, 8000, 10**6)
        answer = evaluate(OilFilm, {**OilFilm.example, "speed": {"value": speed.tolist(), "unit": "rpm"}})
        thickness = answer.outputs["minimum_film_thickness"].value
        one = outputs({**OilFilm.example, "speed": "8000 rpm"})["minimum_film_thickness"]
        assert thickness.shape == (10**6,)
        assert thickness[-1] == pytest.approx(one, rel=1e-12)
        assert (np.diff(thickness) > 0).sum() >= 10**6 - 3


class TestSolve:
    RAW = {name: value for name, value in OilFilm.example.items() if name != "bearing_width"}

    def test_literature_width_of_the_worked_case(self):
        result = solve(
            OilFilm, self.RAW, "bearing_width", ["10 mm", "80 mm"], {"minimum_film_thickness": "3.2449 um"}
        )
        assert result.evaluation.outputs["minimum_film_thickness"].value == pytest.approx(3.2449, rel=1e-12)
        assert result.evaluation.outputs["relative_eccentricity"].value == pytest.approx(0.8821, abs=5e-5)
        assert (result.unit, result.warnings) == ("mm", [])

    def test_literature_out_of_reach_says_what_is(self):
        with pytest.raises(Unreachable, match="out of reach") as error:
            solve(OilFilm, self.RAW, "bearing_width", ["10 mm", "80 mm"], {"minimum_film_thickness": "50 um"})
        ends = [
            outputs({**self.RAW, "bearing_width": w})["minimum_film_thickness"] for w in ("10 mm", "80 mm")
        ]
        assert error.value.reachable == pytest.approx(ends)
        assert error.value.unit == "um"

    def test_literature_not_monotone_at_the_seam(self):
        """h0 jumps at So = 10: both solutions beside the jump are found, and said."""
        seam = outputs(load_for(10 * (1 - 1e-9)), "minimum_film_thickness")["minimum_film_thickness"]
        raw = {name: value for name, value in load_for(1).items() if name != "radial_load"}
        target = {"minimum_film_thickness": f"{1.004 * seam} um"}
        result = solve(OilFilm, raw, "radial_load", ["1 kN", "200 kN"], target)
        assert {w.code for w in result.warnings} == {"not_monotone", "several_solutions"}
        assert result.evaluation.outputs["sommerfeld_number"].value < 10

    def test_literature_target_within_a_jump(self):
        """At So = 100 h0 falls by 1 %: no load gives a value between."""
        above = outputs(load_for(100 * (1 - 1e-9)), "minimum_film_thickness")["minimum_film_thickness"]
        raw = {name: value for name, value in load_for(1).items() if name != "radial_load"}
        target = {"minimum_film_thickness": f"{0.995 * above} um"}
        with pytest.raises(Unreachable, match="jump"):
            solve(OilFilm, raw, "radial_load", ["1 kN", "2000 kN"], target)
