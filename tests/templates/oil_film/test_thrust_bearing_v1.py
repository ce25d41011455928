"""`thrust_bearing` 1 against polar finite differences, `slider_bearing` 1, balances and limits."""

import numpy as np
import pytest
from scipy.sparse import lil_array
from scipy.sparse.linalg import spsolve
from seeds import seeded

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.oil_film.slider_bearing_v1 import SliderBearing
from templates.oil_film.thrust_bearing_v1 import ThrustBearing
from templates.physics.pads.sector_equations import solved_sectors
from templates.physics.pads.slider_film import finite_pad
from templates.physics.pads.thrust_collar import collar_film


def answer(raw=None, **options):
    merged = {**ThrustBearing.example, **(raw or {})}
    typed = {name: value for name, value in merged.items() if value is not None}
    return evaluate(ThrustBearing, typed, **options)


def outputs(raw=None, **options):
    return {name: one.value for name, one in answer(raw, **options).outputs.items()}


def polar_load(a, angle, reach, n, m):
    """Load of a sector as in `solved_sectors`, by finite differences in r and theta, mean radius 1."""
    r = np.linspace(2 / (1 + reach), 2 * reach / (1 + reach), m + 1)
    dr, step = r[1] - r[0], 1 / n
    matrix, right = lil_array(((n - 1) * (m - 1),) * 2), np.zeros((n - 1) * (m - 1))
    for i in range(1, n):
        H, before, after = (a - (a - 1) * x * step for x in (i, i - 0.5, i + 0.5))
        for j in range(1, m):
            k = (i - 1) * (m - 1) + j - 1
            along = {-1: before**3 / step**2, 1: after**3 / step**2}
            out = {s: angle**2 * H**3 * r[j] * (r[j] + s * dr / 2) / dr**2 for s in (-1, 1)}
            matrix[k, k] = sum(along.values()) + sum(out.values())
            for s in (-1, 1):
                if 0 < i + s < n:
                    matrix[k, k + s * (m - 1)] = -along[s]
                if 0 < j + s < m:
                    matrix[k, k + s] = -out[s]
            right[k] = (a - 1) * r[j] ** 2
    P = spsolve(matrix.tocsr(), right).reshape(n - 1, m - 1)
    return (P * r[1:-1]).sum() * step * dr / (r[-1] - r[0])


class TestSector:
    @pytest.mark.parametrize(("a", "angle", "reach"), [(2.0, 0.6, 1.8), (1.3, 0.3, 2.5), (4.0, 1.0, 3.0)])
    def test_analytic_load_is_that_of_the_polar_equation(self, a, angle, reach):
        coarse, fine = polar_load(a, angle, reach, 24, 24), polar_load(a, angle, reach, 48, 48)
        load = collar_film(*(np.array([one]) for one in (a, angle, reach))).load
        assert load[0] == pytest.approx(fine + (fine - coarse) / 3, rel=1e-3)

    def test_limit_narrow_ring_is_a_row_of_rectangles(self):
        """slider_bearing 1 at b = l, 50 mm, 60 over 30 um, on a ring of a mean diameter of 50 km."""
        ring = [np.array([one]) for one in (2.0, 1e-6, (1 + 5e-7) / (1 - 5e-7))]
        pad = collar_film(*ring)
        slider = evaluate(SliderBearing, SliderBearing.example).outputs
        load = slider["load"].value * 30e-6**2 / (6 * 0.03 * 10 * 0.05**2 * 0.05)
        assert pad.load[0] == pytest.approx(load, rel=1e-4)
        friction = slider["friction_coefficient"].value / (30e-6 / 0.05)
        assert pad.friction[0] == pytest.approx(friction, rel=1e-4)
        flow = 10 * 30e-6 * 0.05
        assert pad.inlet[0] * flow * 1e6 == pytest.approx(slider["inlet_flow"].value, rel=1e-3)
        assert pad.side[0] * flow * 1e6 == pytest.approx(slider["side_flow"].value, rel=2e-3)

    def test_convergence_is_of_second_order(self):
        pad = [np.array([one]) for one in (2.0, 0.6, 1.8)]
        loads = [solved_sectors(*pad, n, n // 4)[0, 0] for n in (16, 32, 64, 128)]
        steps = np.diff(loads)
        assert steps[0] / steps[1] == pytest.approx(4, abs=0.3)
        assert steps[1] / steps[2] == pytest.approx(4, abs=0.2)

    def test_property_differences_of_the_rectangle(self):
        """What the template's page says at outer over inner diameter 2."""
        a, angle, reach = np.array([2.0]), np.radians([30.0]), np.array([2.0])
        sector = collar_film(a, angle, reach)
        rectangle = finite_pad(a, 2 * (reach - 1) / ((reach + 1) * angle), 32, 8)
        torque = (rectangle.friction_moving / 6 / (sector.friction * sector.load))[0]
        assert 0.90 < torque < 0.92
        assert 0.97 < (rectangle.load / sector.load)[0] < 1.01


class TestBalance:
    def test_analytic_load_is_borne_at_the_viscosity_shown(self):
        result = outputs()
        pad = collar_film(*(np.array([x]) for x in (result["film_ratio"], 0.2 * np.pi, 200 / 110)))
        omega, h = 1500 * np.pi / 30, result["minimum_film_thickness"] * 1e-6
        scale = 6 * result["dynamic_viscosity"] * 1e-3 * omega * 0.0775**2 * 0.2 * np.pi / h**2
        assert result["specific_load"] * 1e6 == pytest.approx(scale * pad.load[0], rel=1e-9)

    @pytest.mark.parametrize("share", [0, 0.5, 1])
    def test_analytic_heat(self, share):
        """The fresh oil carries off what the collar rubs: it leaves at sides and outlets, warmer."""
        result = outputs({"carried_over_share": share})
        outlet = (1 - share) * (result["inlet_flow"] - result["side_flow"])
        carried = outlet * result["outlet_temperature"] + result["side_flow"] * result["film_temperature"]
        warmed = carried - 40 * (outlet + result["side_flow"])
        assert result["fresh_oil_flow"] == pytest.approx(outlet + result["side_flow"])
        assert 1.8e6 * warmed / 60e3 == pytest.approx(result["power_loss"], rel=1e-9)

    def test_analytic_carried_oil_heats(self):
        shares = {"value": np.linspace(0, 1, 11).tolist(), "unit": "1"}
        result = outputs({"carried_over_share": shares})
        assert (np.diff(result["film_temperature"]) > 0).all()
        assert (np.diff(result["minimum_film_thickness"]) < 0).all()

    def test_analytic_given_viscosity(self):
        """Without a supply the film is that of the viscosity; with one the heat is an output too."""
        warm = outputs()
        viscosity = {"dynamic_viscosity": f"{warm['dynamic_viscosity']} mPa*s"}
        cold = answer({**viscosity, "supply_temperature": None}).outputs
        assert cold["minimum_film_thickness"].value == pytest.approx(warm["minimum_film_thickness"])
        assert cold["outlet_temperature"].reason == "needs supply_temperature"
        both = outputs(viscosity)
        assert both["outlet_temperature"] == pytest.approx(warm["outlet_temperature"])

    def test_property_film_falls_with_the_load(self):
        loads = {"value": np.geomspace(0.1, 300, 60).tolist(), "unit": "kN"}
        result = outputs({"load": loads})
        assert (np.diff(result["minimum_film_thickness"]) < 0).all()
        assert (np.diff(result["film_ratio"]) > 0).all()

    def test_property_film_grows_with_the_speed(self):
        speeds = {"value": np.geomspace(30, 10_000, 40).tolist(), "unit": "rpm"}
        result = outputs({"speed": speeds})
        assert (np.diff(result["minimum_film_thickness"]) > 0).all()
        assert (np.diff(result["power_loss"]) > 0).all()


class TestInputs:
    @pytest.mark.parametrize(
        ("raw", "name"),
        [
            ({"inner_diameter": "200 mm"}, "inner_diameter"),
            ({"inner_diameter": "20 mm"}, "diameter_ratio"),
            ({"pads": 2.5}, "pads"),
            ({"pads": 800}, "width_ratio"),
            ({"pad_share": 1}, "pad_share"),
            ({"supply_temperature": None}, "supply_temperature"),
            ({"load": "1 GN"}, "film_ratio"),
            ({"load": "1e-25 N"}, "film_ratio"),
            ({"heat_capacity": "0.01 kJ/(m**3*K)", "dynamic_viscosity": "30 mPa*s"}, "film_ratio"),
        ],
    )
    def test_property_refuses_by_name(self, raw, name):
        with pytest.raises(InvalidInputs) as refusal:
            outputs(raw)
        assert name in {one for fault in refusal.value.faults for one in fault.names}

    @pytest.mark.parametrize("count", [300, pytest.param(10_000, marks=pytest.mark.slow)])
    def test_property_whole_range_is_finite_or_refused(self, count):
        rng = np.random.default_rng(seeded(17))

        def drawn(low, high, unit):
            return {"value": (10 ** rng.uniform(low, high, count)).tolist(), "unit": unit}

        inner = 10 ** rng.uniform(0, 3.5, count)
        raw = {
            "load": drawn(-3, 5, "kN"),
            "outer_diameter": {"value": (inner * rng.uniform(1.01, 5.2, count)).tolist(), "unit": "mm"},
            "inner_diameter": {"value": inner.tolist(), "unit": "mm"},
            "pads": {"value": rng.integers(1, 40, count).tolist(), "unit": "1"},
            "pad_share": {"value": rng.uniform(0.01, 0.99, count).tolist(), "unit": "1"},
            "taper": drawn(-1, 3, "um"),
            "speed": drawn(-2, 5, "rpm"),
            "carried_over_share": {"value": rng.uniform(0, 1, count).tolist(), "unit": "1"},
            "supply_temperature": {"value": rng.uniform(-60, 200, count).tolist(), "unit": "degC"},
        }
        outputs = evaluate(ThrustBearing, raw).outputs
        for name, one in outputs.items():
            values = np.broadcast_to(np.asarray(one.value, dtype=float), count)
            assert not np.isinf(values).any(), name
            reasons = np.full(count, one.reason) if one.reasons is None else one.reasons
            assert all(reasons[i] for i in np.flatnonzero(np.isnan(values))), name
        present = np.isfinite(outputs["film_temperature"].value)
        assert present.sum() > count / 20
        assert (outputs["side_flow"].value[present] > 0).all()


def test_a_film_hotter_than_the_viscosity_law_knows_is_none():
    """Refused for one point; at a point of an array no result stands, and each says why."""
    hot = {"taper": "0.001 um"}
    with pytest.raises(InvalidInputs, match="below 500 °C"):
        answer(hot)
    both = answer({"taper": {"value": [30.0, 0.001], "unit": "um"}})
    for name in ("minimum_film_thickness", "outlet_temperature", "temperature_rise", "power_loss"):
        one = both.outputs[name]
        assert np.isfinite(one.value).tolist() == [True, False], name
        assert one.reasons[0] is None, name
        assert "below 500 °C" in one.reasons[1], name
