"""`oil_film` 2: viscosity over temperature, and the heat balance."""

import numpy as np
import pytest
from bearings import VOGEL, balanced, case, outputs

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_v2 import OilFilm


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
        with pytest.raises(InvalidInputs, match="The viscosity is given, or follows from") as refusal:
            outputs(balanced(), "minimum_film_thickness")
        assert {name for fault in refusal.value.faults for name in fault.names} == {
            "oil_inlet_temperature",
            "oil_outlet_temperature",
        }

    def test_property_overruled_temperatures_are_a_warning(self):
        warnings = evaluate(OilFilm, case(supply_temperature="60 degC")).warnings
        assert {w.code for w in warnings} == {"unused_input"}
