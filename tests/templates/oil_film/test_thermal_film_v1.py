"""`thermal_film` 1: equal to oil_film without heating, and its results with heating."""

import numpy as np
import pytest

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_v2 import OilFilm
from templates.oil_film.thermal_film_v1 import ThermalFilm

FILM = "minimum_film_thickness"
NO_COOLING = {"heat_transfer_coefficient": None, "ambient_temperature": None}


def outputs(raw=None, level="field", **options):
    merged = {**ThermalFilm.example, **(raw or {})}
    given = {name: value for name, value in merged.items() if value is not None}
    return {
        name: one.value for name, one in evaluate(ThermalFilm, given, level=level, **options).outputs.items()
    }


@pytest.fixture(scope="module")
def example():
    return outputs()


@pytest.fixture(scope="module")
def even():
    """A viscosity that does not depend on the temperature, and the film of `oil_film` 2 with that groove."""
    oil = {"dynamic_viscosity": "20 mPa*s", "supply_pressure": "0 bar"}
    shared = {n: ThermalFilm.example[n] for n in ("radial_load", "diametral_clearance", "bearing_diameter",
                                                  "bearing_width", "speed")}  # fmt: skip
    groove = {"grooves": {"value": [[180, 18]], "unit": "deg"}}
    film = evaluate(OilFilm, {**shared, **groove, "dynamic_viscosity": "20 mPa*s"}, level="mass_conserving")
    return outputs(oil, "fine_field"), {name: one.value for name, one in film.outputs.items()}


class TestLimits:
    def test_limit_even_viscosity_is_the_grooved_film_of_oil_film_2(self, even):
        """By other equations, another mesh and an extrapolation there."""
        thermal, film = even
        assert thermal["relative_eccentricity"] == pytest.approx(film["relative_eccentricity"], rel=4e-3)
        assert thermal["attitude_angle"] == pytest.approx(film["attitude_angle"], abs=0.4)
        assert thermal["maximum_pressure"] == pytest.approx(film["maximum_pressure"], rel=1e-2)
        assert thermal["side_flow"] == pytest.approx(film["side_flow"], rel=3e-2)

    def test_limit_even_viscosity_makes_both_temperatures_one_film(self, even):
        thermal, _ = even
        assert thermal["film_ratio"] == pytest.approx(1, rel=1e-6)
        assert thermal["loss_ratio"] == pytest.approx(1, rel=1e-6)
        assert thermal["unseen_rise"] > 1

    def test_limit_level_one_temperature_is_the_heat_balance_of_oil_film_2(self):
        raw = {name: value for name, value in ThermalFilm.example.items() if name in OilFilm.inputs}
        raw |= {"supply_pressure": None, "heat_transfer": f"{80 * np.pi * 0.1 * 0.08} W/K"}
        raw = {name: value for name, value in raw.items() if value is not None}
        film = {name: one.value for name, one in evaluate(OilFilm, raw, level="map").outputs.items()}
        one = outputs(level="one_temperature")
        assert one["effective_temperature"] == pytest.approx(film["film_temperature"], rel=1e-9)
        for name in (FILM, "attitude_angle", "maximum_pressure", "side_flow", "power_loss"):
            assert one[name] == pytest.approx(film[name], rel=1e-9), name
        assert one["film_ratio"] is None
        assert one["bush_temperature"] is None or np.isnan(one["bush_temperature"]).all()


class TestAnswers:
    def test_energy_what_arises_leaves(self, example):
        parts = [example[f"heat_by_{way}"] for way in ("oil", "bush", "journal")]
        assert sum(parts) == pytest.approx(example["heat_generated"], rel=1e-9)
        assert example["heat_residual"] == 0
        pumped = 0.7e5 * example["side_flow"] / 60e3
        assert example["power_loss"] < example["heat_generated"] < example["power_loss"] + 1.01 * pumped

    def test_temperatures_are_in_order(self, example):
        bush = np.asarray(example["bush_temperature"])
        assert bush.shape == (72,)
        assert 40 < example["groove_temperature"] < example["outlet_temperature"]
        assert example["outlet_temperature"] < example["greatest_bush_temperature"]
        assert bush.max() <= example["greatest_bush_temperature"] <= example["greatest_film_temperature"]
        assert bush[36] == pytest.approx(example["groove_temperature"], rel=1e-12)
        # hottest past the narrowest gap, which lies at the attitude angle, and before the groove
        assert example["attitude_angle"] < example["bush_angle"][bush.argmax()] < 171
        assert 40 < example["journal_temperature"] < example["greatest_film_temperature"]

    def test_one_temperature_is_compared(self, example):
        ratio = example["film_of_one_temperature"] / example[FILM]
        assert example["film_ratio"] == pytest.approx(ratio, rel=1e-12)
        assert example["film_ratio"] > 1.05
        assert example["loss_ratio"] > 1.05
        assert example["mesh_error"] < 0.01

    @pytest.mark.parametrize(
        ("change", "name", "rises"),
        [
            ({"supply_temperature": "50 degC"}, FILM, False),
            ({"heat_transfer_coefficient": "2000 W/(m**2*K)"}, "greatest_bush_temperature", False),
            ({**NO_COOLING, "held_bush_temperature": "70 degC"}, "journal_temperature", True),
            ({"held_journal_temperature": "70 degC"}, "greatest_film_temperature", True),
            ({"carry_over": 0.3}, "groove_temperature", False),
            ({"speed": "6000 rpm"}, "greatest_film_temperature", True),
        ],
    )
    @pytest.mark.sampled(2)
    def test_property_changes_go_where_they_should(self, example, change, name, rises):
        assert (outputs(change)[name] > example[name]) == rises

    def test_a_held_bush_has_its_temperature(self):
        found = outputs({**NO_COOLING, "held_bush_temperature": "55 degC"})
        bush = np.asarray(found["bush_temperature"])
        assert np.delete(bush, [35, 36, 37]) == pytest.approx(55, abs=1e-9)
        assert found["heat_by_bush"] != 0


class TestRefusals:
    @pytest.mark.parametrize(
        ("change", "name"),
        [
            ({"groove_angle": "0 deg", "supply_pressure": "0 bar", "radial_load": "60 kN"},
             "relative_eccentricity"),
            ({**NO_COOLING, "radial_load": "1 mN", "supply_pressure": "0 bar"}, "relative_eccentricity"),
            ({"radial_load": "1e6 kN"}, "relative_eccentricity"),
            ({"ambient_temperature": None}, "heat_transfer_coefficient"),
            ({"held_bush_temperature": "50 degC"}, "held_bush_temperature"),
            ({"radial_load": "0 N"}, "radial_load"),
            ({"speed": "0 rpm"}, "speed"),
            ({"groove_width": "120 deg"}, "groove_width"),
        ],
    )  # fmt: skip
    def test_what_has_no_film_or_makes_no_sense_is_named(self, change, name):
        with pytest.raises(InvalidInputs) as refusal:
            outputs(change)
        assert {name} == {fault.name for fault in refusal.value.faults}

    @pytest.mark.slow
    def test_among_many_points_the_others_stand(self, example):
        loads = {"value": [6, 1e6], "unit": "kN"}
        found = outputs({"radial_load": loads})
        assert found[FILM][0] == pytest.approx(example[FILM], rel=1e-9)
        assert np.isnan(found[FILM][1])
        assert np.isnan(found["bush_temperature"][1]).all()
        assert np.isfinite(found["bush_temperature"][0]).all()

    @pytest.mark.slow  # test_catalogue_properties.py asks the same of points that cost less
    def test_random_bearings_are_finite_or_refused(self):
        """Decades away from the example."""
        rng = np.random.default_rng(17)
        raw = {
            "radial_load": {"value": 6 * 10 ** rng.uniform(-1, 1, 6), "unit": "kN"},
            "speed": {"value": 3000 * 10 ** rng.uniform(-0.7, 0.5, 6), "unit": "rpm"},
            "bearing_width": {"value": 80 * 10 ** rng.uniform(-0.7, 0.3, 6), "unit": "mm"},
            "supply_pressure": {"value": rng.uniform(0, 10, 6), "unit": "bar"},
        }
        found = outputs(raw)
        borne = np.isfinite(found["relative_eccentricity"])
        assert 2 < borne.sum()
        for name in (FILM, "greatest_film_temperature", "film_ratio", "power_loss", "journal_temperature"):
            assert (np.isfinite(found[name]) == borne).all(), name
        assert (np.asarray(found["heat_residual"])[borne] == 0).all()
