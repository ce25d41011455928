"""`hydrostatic_pad` 1 against quadrature of the Reynolds equation, an exercise, optima and limits."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar
from seeds import seeded

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.oil_film.hydrostatic_pad_v1 import HydrostaticPad
from templates.physics.pads.hydrostatic import RESTRICTORS

ORIFICE = {"restrictor": "orifice", "restrictor_diameter": "0.5 mm", "capillary_length": None}
PUMP = {
    "restrictor": "constant_flow",
    "pump_flow": "0.24 l/min",
    "restrictor_diameter": None,
    "capillary_length": None,
}
RING = {"recess_diameter": "85 mm", "recess_inner_diameter": "60 mm", "inner_diameter": "40 mm"}
KINDS = {"capillary": {}, "orifice": ORIFICE, "constant_flow": PUMP}


def answer(raw=None):
    merged = {**HydrostaticPad.example, **(raw or {})}
    return evaluate(HydrostaticPad, {name: value for name, value in merged.items() if value is not None})


def outputs(raw=None):
    return {name: one.value for name, one in answer(raw).outputs.items()}


def many(values, unit):
    return {"value": np.asarray(values).tolist(), "unit": unit}


class TestLiterature:
    def test_literature_exercise(self):
        """R 50 mm, 80 mPa s, 30 um, 60 kN and 4e-6 m3/s: R_0 = 28.5 mm and 50.89 W.

        As printed at tutorbin.com ("a pump capable of maintaining 20 MPa"); the exponent of the flow is lost
        in the print and follows from its answers.
        """
        result = outputs(PUMP)
        assert result["film_thickness"] == pytest.approx(30, rel=1e-3)
        assert result["land_power"] == pytest.approx(50.89, rel=1e-3)
        assert result["pumping_power"] == result["land_power"]

    @pytest.mark.parametrize("ratio", [0.1, 0.5, 0.57, 0.9])
    def test_literature_coefficients_of_the_step_pad(self, ratio):
        """Rippel 1963: a_b = (1 − x²)/(2 ln 1/x), q_b = π/(3(1 − x²)), H_b = 2π ln(1/x)/(3(1 − x²)²)."""
        result = outputs({"recess_diameter": f"{100 * ratio} mm", "load": "10 kN"})
        land = np.log(1 / ratio)
        assert result["load_coefficient"] == pytest.approx((1 - ratio**2) / (2 * land))
        assert result["flow_coefficient"] == pytest.approx(np.pi / (3 * (1 - ratio**2)))
        assert result["power_coefficient"] == pytest.approx(2 * np.pi * land / (3 * (1 - ratio**2) ** 2))

    def test_literature_recess_of_least_power(self):
        """R_0/R = 0.53 spends the least power in the lands: the root of 1 − s + 2 s ln s, s the square."""
        ratios = np.linspace(0.4, 0.7, 3001)
        power = outputs({"recess_diameter": many(100 * ratios, "mm")})["power_coefficient"]
        best = ratios[int(np.argmin(power))]
        assert best == pytest.approx(0.5336, abs=2e-4)
        assert 1 - best**2 + 2 * best**2 * np.log(best**2) == pytest.approx(0, abs=1e-3)

    def test_literature_stiffest_ratios(self):
        """0.5 with a capillary and 0.58 with an orifice: tribology-abc.com, hydrostatic calculators."""
        assert outputs()["stiffest_pressure_ratio"] == 0.5
        assert outputs(ORIFICE)["stiffest_pressure_ratio"] == pytest.approx(0.58, abs=0.01)
        assert answer(PUMP).outputs["stiffest_pressure_ratio"].reason.startswith("a constant flow")


class TestQuadrature:
    """The Reynolds equation in polar coordinates, integrated numerically."""

    def pressure(self, r, radii):
        """Pressure over that of the recess: the integral of 1/(r h³) along the land."""
        inner, recess_in, recess_out, outer = radii
        if recess_in <= r <= recess_out:
            return 1.0
        edge, start = (outer, recess_out) if r > recess_out else (inner, recess_in)
        return quad(lambda x: 1 / x, edge, r)[0] / quad(lambda x: 1 / x, edge, start)[0]

    def borne(self, radii):
        rings = (
            quad(lambda r: 2 * np.pi * r * self.pressure(r, radii), *span, epsrel=1e-10)[0]
            for span in pairwise(radii)
        )
        return sum(rings)

    def test_analytic_load_of_a_ring(self):
        result = outputs({**RING, "load": "10 kN"})
        area = self.borne((0.020, 0.030, 0.0425, 0.050))
        assert result["recess_pressure"] * 1e6 * area == pytest.approx(10e3, rel=1e-9)

    def test_analytic_load_of_a_circle(self):
        result = outputs()
        inside = np.pi * 0.0285**2
        land = quad(lambda r: 2 * np.pi * r * np.log(0.05 / r) / np.log(50 / 28.5), 0.0285, 0.05)[0]
        assert result["effective_area"] == pytest.approx((inside + land) * 1e4, rel=1e-10)

    @pytest.mark.parametrize("raw", [{}, {**RING, "load": "10 kN"}])
    def test_analytic_flow_passes_the_lands(self, raw):
        """h³ p_r/(6 eta) over each land's integral of dr/(2 π r), twice: −h³/(12 eta) dp/dr 2 π r."""
        result = outputs(raw)
        lands = [(0.0425, 0.05), (0.02, 0.03)] if raw else [(0.0285, 0.05)]
        resistance = [quad(lambda r: 12 * 0.08 / (2 * np.pi * r), *land)[0] for land in lands]
        flow = (result["film_thickness"] * 1e-6) ** 3 * result["recess_pressure"] * 1e6
        assert result["flow"] / 60e3 == pytest.approx(sum(flow / r for r in resistance), rel=1e-9)

    @pytest.mark.parametrize("raw", [{}, {**RING, "load": "10 kN"}])
    def test_analytic_friction_of_the_lands(self, raw):
        result = outputs(raw)
        lands = [(0.0425, 0.05), (0.02, 0.03)] if raw else [(0.0285, 0.05)]
        omega, film = 1000 * np.pi / 30, result["film_thickness"] * 1e-6
        torque = sum(quad(lambda r: 0.08 * omega * r / film * 2 * np.pi * r**2, *land)[0] for land in lands)
        assert result["friction_torque"] == pytest.approx(torque, rel=1e-10)
        assert result["friction_power"] == pytest.approx(torque * omega, rel=1e-10)


class TestAnalytic:
    @pytest.mark.parametrize("raw", KINDS.values(), ids=KINDS)
    def test_analytic_stiffness_is_the_slope_of_the_load(self, raw):
        loads = 40 * np.array([1 - 1e-4, 1, 1 + 1e-4])
        result = outputs({**raw, "load": many(loads, "kN")})
        film = result["film_thickness"]
        assert result["stiffness"][1] == pytest.approx(-2 * 0.004e3 / (film[2] - film[0]), rel=1e-6)

    @pytest.mark.parametrize("kind", ["capillary", "orifice"])
    def test_analytic_stiffest_at_that_ratio(self, kind):
        """At one film: S over A_e p_s/h is beta times the factor."""
        loads = np.linspace(1, 90, 4001)
        result = outputs({**KINDS[kind], "load": many(loads, "kN")})
        stiff = result["stiffness"] * result["film_thickness"]
        best = result["pressure_ratio"][int(np.argmax(stiff))]
        assert best == pytest.approx(np.max(result["stiffest_pressure_ratio"]), abs=1e-3)

    def test_analytic_film_of_least_power(self):
        result = outputs()

        def power(film):
            x = film / result["film_thickness"]
            return result["pumping_power"] * x**3 + result["friction_power"] / x

        least = minimize_scalar(power, bounds=(5, 200), method="bounded", options={"xatol": 1e-8})
        assert result["film_of_least_power"] == pytest.approx(least.x, rel=1e-5)

    def test_analytic_viscosity_of_least_power(self):
        result = outputs()

        def power(eta):
            x = eta / 80
            return result["pumping_power"] / x + result["friction_power"] * x

        least = minimize_scalar(power, bounds=(5, 500), method="bounded", options={"xatol": 1e-8})
        assert result["viscosity_of_least_power"] == pytest.approx(least.x, rel=1e-5)

    def test_analytic_heat(self):
        result = outputs()
        heat = 1.8e6 * result["flow"] / 60e3 * result["temperature_rise"]
        assert heat == pytest.approx(result["total_power"])

    def test_limit_narrow_land(self):
        """A land of 1e-9 of the diameter bears half of the recess pressure at its mean diameter."""
        result = outputs({"recess_diameter": {"value": 100 * (1 - 1e-9), "unit": "mm"}})
        assert result["load_coefficient"] == pytest.approx(1 - 1e-9, rel=1e-12)
        assert result["land_conductance"] == pytest.approx(np.pi / 6 * 1e9, rel=1e-6)

    def test_limit_hole_of_a_ring_closes(self):
        """An inner land with a hole that vanishes passes no oil, and bears as much as the recess."""
        holes = {"recess_inner_diameter": "1e-3 mm", "inner_diameter": "1e-9 mm"}
        circle, ring = outputs(), outputs(holes)
        assert ring["effective_area"] == pytest.approx(circle["effective_area"], rel=1e-6)
        assert ring["land_conductance"] == pytest.approx(circle["land_conductance"], rel=0.1)

    def test_limit_load_of_the_supply(self):
        full = outputs()["load_capacity"]
        assert outputs({"load": f"{full * (1 - 1e-9)} kN"})["film_thickness"] < 0.1
        with pytest.raises(InvalidInputs, match="does not lift"):
            outputs({"load": f"{full * (1 + 1e-9)} kN"})

    def test_limit_at_rest(self):
        outputs = answer({"speed": "0 rpm"}).outputs
        assert outputs["friction_power"].value == 0
        assert outputs["film_of_least_power"].reason.startswith("needs speed")
        outputs = answer({"speed": None}).outputs
        assert outputs["film_thickness"].value > 0
        assert outputs["friction_power"].reason == "needs speed"


class TestInputs:
    @pytest.mark.parametrize(
        ("raw", "name"),
        [
            ({"recess_diameter": "100 mm"}, "recess_diameter"),
            ({"inner_diameter": "20 mm"}, "inner_diameter"),
            ({**RING, "inner_diameter": "60 mm"}, "inner_diameter"),
            ({**RING, "recess_diameter": "60 mm"}, "recess_inner_diameter"),
            ({"restrictor_diameter": None}, "restrictor_diameter"),
            ({"capillary_length": None}, "capillary_length"),
            ({"restrictor": "constant_flow"}, "pump_flow"),
            ({"load": "100 kN"}, "pressure_ratio"),
        ],
    )
    def test_property_refuses_by_name(self, raw, name):
        with pytest.raises(InvalidInputs) as refusal:
            outputs(raw)
        assert name in {one for fault in refusal.value.faults for one in fault.names}

    def test_property_turbulence_is_warned_of(self):
        warnings = answer({"dynamic_viscosity": "0.1 mPa*s"}).warnings
        assert {"land_reynolds_number", "capillary_reynolds_number"} <= {one.name for one in warnings}

    @pytest.mark.parametrize(
        ("raw", "unused"),
        [
            ({}, set()),
            (ORIFICE, set()),
            (PUMP, set()),
            ({"pump_flow": "1 l/min"}, {"pump_flow"}),
            ({"restrictor": "orifice"}, {"capillary_length"}),
            ({**PUMP, "restrictor_diameter": "1 mm", "capillary_length": "80 mm"},
             {"restrictor_diameter", "capillary_length"}),
        ],
    )  # fmt: skip
    def test_property_inputs_of_another_restrictor_are_warned_of(self, raw, unused):
        codes = {one.name for one in answer(raw).warnings if one.code == "unused_input"}
        assert codes == unused

    @pytest.mark.parametrize("kind", RESTRICTORS)
    @pytest.mark.parametrize("count", [2_000, pytest.param(100_000, marks=pytest.mark.slow)])
    def test_property_whole_range_is_finite_or_refused(self, kind, count):
        rng = np.random.default_rng(seeded(11))

        def drawn(low, high, unit):
            return many(10 ** rng.uniform(low, high, count), unit)

        recess = 10 ** rng.uniform(0, 3, count)
        raw = {
            "load": drawn(-3, 6, "kN"),
            "outer_diameter": many(recess * 10 ** rng.uniform(0, 1, count), "mm"),
            "recess_diameter": many(recess, "mm"),
            "supply_pressure": drawn(-2, 2, "MPa"),
            "restrictor": kind,
            "restrictor_diameter": drawn(-2, 1, "mm"),
            "capillary_length": drawn(0, 3, "mm"),
            "pump_flow": drawn(-4, 3, "l/min"),
            "dynamic_viscosity": drawn(-1, 4, "mPa*s"),
            "speed": drawn(-2, 5, "rpm"),
        }
        if rng.uniform() < 0.5:
            share = rng.uniform(0.01, 0.99, (2, count))
            raw["recess_inner_diameter"] = many(recess * share[0], "mm")
            raw["inner_diameter"] = many(recess * share.prod(axis=0), "mm")
        for name, one in evaluate(HydrostaticPad, raw).outputs.items():
            values = np.broadcast_to(np.asarray(one.value, dtype=float), count)
            assert not np.isinf(values).any(), name
            reasons = np.full(count, one.reason) if one.reasons is None else one.reasons
            assert all(reasons[i] for i in np.flatnonzero(np.isnan(values))), name
