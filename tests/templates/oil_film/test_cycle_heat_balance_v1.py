"""`cycle_heat_balance` 1: the balance by hand, its limits, groove flow by quadrature, refusals by name."""

import numpy as np
import pytest
from seeds import seeded

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.oil_film.cycle_heat_balance_v1 import CycleHeatBalance
from templates.oil_film.oil_film_cycle_v1 import OilFilmCycle
from templates.physics.heat.cycle_heat import _bracket
from templates.physics.supplied.fed_cycle import gap_cubed

FILM, ETA = "minimum_film_thickness", "effective_viscosity"
PLAIN = {"groove_width": None, "supply_pressure": None, "oil_supply": "flooded_ends"}


def answer(raw=None, **options):
    merged = {**CycleHeatBalance.example, **(raw or {})}
    typed = {name: value for name, value in merged.items() if value is not None}
    return evaluate(CycleHeatBalance, typed, **options)


def outputs(raw=None, **options):
    return {name: one.value for name, one in answer(raw, **options).outputs.items()}


def of_cycle(eta, raw=None, level="mobility_grooved"):
    """What oil_film_cycle 1 answers for the same duty at a viscosity [mPa s]."""
    merged = {**CycleHeatBalance.example, **(raw or {}), "dynamic_viscosity": f"{eta!r} mPa*s"}
    typed = {n: v for n, v in merged.items() if v is not None and n in OilFilmCycle.inputs}
    return {n: one.value for n, one in evaluate(OilFilmCycle, typed, level=level).outputs.items()}


class TestBalance:
    @pytest.mark.parametrize(
        ("level", "raw"),
        [
            ("mobility_grooved", {}),
            ("mobility", PLAIN),
            ("mobility_short", {**PLAIN, "hths_viscosity": None}),
        ],
    )
    def test_second_method_balance_by_hand(self, level, raw):
        """Loss and flow of oil_film_cycle 1 at the viscosity found heat the oil to the temperature found."""
        found = outputs(raw, level=level)
        film = of_cycle(float(found[ETA]), raw, level)
        for name in (FILM, "power_loss", "maximum_pressure"):
            assert found[name] == pytest.approx(film[name], rel=1e-9), name
        assert found["side_flow"] + found["feed_flow"] == pytest.approx(film["side_flow"], rel=1e-9)
        flow = film["side_flow"] / 60_000
        rise = film["power_loss"] / (1.8e6 * flow)
        assert found["temperature_rise"] == pytest.approx(rise, rel=1e-8)
        assert found["film_temperature"] == pytest.approx(90 + rise / 2, rel=1e-8)
        if raw.get("hths_viscosity", "") is None:
            assert found[ETA] == pytest.approx(found["dynamic_viscosity"], rel=1e-8)

    def test_second_method_cross_by_hand(self):
        """HTHS 3.5 mPa s between low and endless shear at 150 °C gives the critical rate, and so the loss."""
        found = outputs()
        hot, here = found["low_shear_viscosity_hot"], found["dynamic_viscosity"]
        critical = 1e6 * (3.5 - hot / 2) / (hot - 3.5) * hot / here
        thin = here / 2 + here / 2 / (1 + found["mean_shear_rate"] / critical)
        assert found[ETA] == pytest.approx(thin, rel=1e-8)
        assert found["shear_loss"] == pytest.approx(1 - thin / here, rel=1e-7)

    def test_second_method_feed_flow_of_a_full_groove(self):
        """Two lands between plates of the gap: p c³ R/(6 eta L) times the mean of 2 pi (1 + 1.5 eps²)."""
        raw = {"groove_extent": "360 deg", "hths_viscosity": None}
        found = outputs(raw, level="mobility_grooved")
        gap = np.asarray(found["film_thickness"]) * 1e-6
        radial = 0.055e-3 / 2
        angles = np.asarray(CycleHeatBalance.example["crank_angle"]["value"])
        assert np.allclose(np.diff(angles), 30)
        mean = (2 * np.pi * (1 + 1.5 * (1 - gap / radial) ** 2)).mean()
        flow = 4e5 * radial**3 * 0.024 * mean / (6 * found[ETA] * 1e-3 * 7.5e-3)
        assert found["feed_flow"] == pytest.approx(flow * 60_000, rel=1e-6)

    def test_second_method_cubed_gap_by_quadrature(self):
        phi = np.linspace(0, 1, 20_001)
        for eps, centre, start, extent in (
            (0.9, 2.0, -1.0, 3.1),
            (0.3, -3.0, 5.0, 2 * np.pi),
            (0.0, 0.0, 1.0, 0.5),
        ):
            x, y = eps * np.cos(centre), eps * np.sin(centre)
            at = start + extent * phi
            wanted = np.trapezoid((1 - x * np.cos(at) - y * np.sin(at)) ** 3, at)
            found = gap_cubed(*(np.array([v]) for v in (x, y, start, extent)))
            assert found[0] == pytest.approx(wanted, rel=1e-7)


class TestSearch:
    @pytest.mark.parametrize(
        ("root", "least", "most"),
        [(-0.3, -0.9, np.inf), (-0.3, -0.31, np.inf), (-2.0, -2.05, -1.0), (-0.5, -np.inf, -0.2)],
    )
    def test_limit_an_orbit_may_exist_only_near_the_root(self, root, least, most):
        """Below `least` the load is too heavy for an orbit, above `most` too light [ln(viscosity)]."""
        top, load = np.zeros(1), np.exp(np.array([root]))

        def lack(x):
            return np.where((x < least) | (x > most), np.nan, root - x)

        (low,), (high,) = _bracket(lack, top, load)
        assert low <= root <= high
        assert np.isfinite(lack(np.array([low, high]))).all()

    def test_limit_without_a_root_there_is_no_bracket(self):
        low, high = _bracket(lambda x: np.where(x < -1, np.nan, -1.5 - x), np.zeros(1), np.ones(1))
        assert np.isnan(low).all()
        assert np.isnan(high).all()

    def test_limit_the_supply_viscosity_may_be_too_low_already(self):
        low, high = _bracket(lambda x: 0 * x, np.full(1, 0.3), np.ones(1))
        assert low == high == 0.3


class TestLimits:
    @pytest.mark.parametrize("cooled", [{"heat_capacity": "1e12 kJ/(m**3*K)"}, {"heat_share": 0}])
    def test_limit_much_cooling_is_isothermal(self, cooled):
        found = outputs({**cooled, "hths_viscosity": None}, level="mobility_grooved")
        assert found["film_temperature"] == pytest.approx(90, abs=1e-6)
        film = of_cycle(float(found["dynamic_viscosity"]))
        assert found[FILM] == pytest.approx(film[FILM], rel=1e-7)

    def test_limit_given_viscosity_is_that_of_the_cycle(self):
        found = outputs({"dynamic_viscosity": "10 mPa*s", "hths_viscosity": None}, level="mobility_grooved")
        film = of_cycle(10.0)
        assert found[ETA] == pytest.approx(10, rel=1e-12)
        assert found[FILM] == pytest.approx(film[FILM], rel=1e-9)
        assert found["temperature_rise"] > 0

    def test_limit_hths_of_low_shear_takes_nothing(self):
        plain = outputs({"hths_viscosity": None})
        hot = plain["low_shear_viscosity_hot"]
        near = outputs({"hths_viscosity": f"{hot * (1 - 1e-6)!r} mPa*s"})
        assert near[ETA] == pytest.approx(plain[ETA], rel=1e-5)

    def test_property_warmer_supply_thinner_film(self):
        found = outputs(
            {"supply_temperature": {"value": [60, 90, 120], "unit": "degC"}}, level="mobility_grooved"
        )
        assert (np.diff(found[ETA]) < 0).all()
        assert (np.diff(found[FILM]) < 0).all()
        assert (np.diff(found["temperature_rise"]) < 0).all()

    def test_property_more_pressure_cools(self):
        found = outputs({"supply_pressure": {"value": [1, 4, 8], "unit": "bar"}}, level="mobility_grooved")
        assert (np.diff(found["feed_flow"]) > 0).all()
        assert (np.diff(found["film_temperature"]) < 0).all()


class TestAnswers:
    def test_property_level_follows_the_groove(self):
        assert answer().level == "mobility_grooved"
        assert answer(PLAIN).level == "mobility"

    def test_property_what_is_not_used_is_warned_of(self):
        def codes(raw):
            return {(notice.code, notice.name) for notice in answer(raw).warnings}

        assert codes({}) == set()
        assert ("unused_input", "supply_pressure") in codes(
            {"groove_width": None, "oil_supply": "flooded_ends"}
        )
        assert ("unused_input", "hths_viscosity") in codes({"dynamic_viscosity": "9 mPa*s"})

    @pytest.mark.parametrize(
        ("raw", "name"),
        [
            ({"hths_viscosity": "5 mPa*s"}, "hths_ratio"),
            ({"hths_viscosity": "2 mPa*s"}, "hths_ratio"),
            ({"supply_pressure": None}, "supply_pressure"),
            ({"supply_temperature": None}, "supply_temperature"),
            ({"groove_width": "17.9 mm"}, "groove_width"),
            ({"sleeve_speed": "700 rpm"}, "sleeve_speed"),
            ({**PLAIN, "load_x": {"value": [1e12] * 24, "unit": "kN"}}, ETA),
        ],
    )
    def test_property_refuses_by_name(self, raw, name):
        with pytest.raises(InvalidInputs) as refusal:
            answer(raw)
        assert name in {one for fault in refusal.value.faults for one in fault.names}

    @pytest.mark.parametrize("count", [3, pytest.param(300, marks=pytest.mark.slow)])
    def test_property_whole_range_is_finite_or_refused(self, count):
        rng = np.random.default_rng(seeded(17))

        def drawn(low, high, unit):
            return {"value": (10 ** rng.uniform(low, high, count)).tolist(), "unit": unit}

        raw = {
            **CycleHeatBalance.example,
            "bearing_diameter": drawn(1, 3, "mm"),
            "diametral_clearance": drawn(-2, 0, "mm"),
            "supply_temperature": {"value": rng.uniform(20, 150, count).tolist(), "unit": "degC"},
            "supply_pressure": drawn(-2, 1.5, "bar"),
        }
        found = evaluate(CycleHeatBalance, raw).outputs
        for name, one in found.items():
            if one.unit is None:
                continue  # a word
            values = np.asarray(one.value, dtype=float)
            assert not np.isinf(values).any(), name
            values = (
                np.broadcast_to(values, count) if values.ndim == 0 else values.reshape(values.shape[0], -1)
            )
            missing = np.isnan(values.reshape(values.shape[0], -1)).any(axis=1)
            reasons = np.full(missing.size, one.reason) if one.reasons is None else one.reasons
            assert all(reasons[i] for i in np.flatnonzero(missing)), name
        assert np.isfinite(found[ETA].value).mean() > 0.5
