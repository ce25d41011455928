"""`oil_film` 2 with missing or extreme inputs gives finite results or refuses them."""

import numpy as np
import pytest
from bearings import (
    VOGEL,
    assert_finite_or_reasoned,
    balanced,
    bearing,
    case,
    drawn_bearings,
    outputs,
    si,
    without,
)
from seeds import seeded

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_v2 import OilFilm

OF_SHAPES = {
    "lobes": {"bore_shape": "multi_lobe"}, "preload": {"bore_shape": "lemon"},
    "lobe_angle": {"bore_shape": "lemon"}, "lobe_offset": {"bore_shape": "lemon"},
    "bell_mouth_depth": {"bell_mouth_length": "4 mm"}, "bell_mouth_length": {"bell_mouth_depth": "5 um"},
}  # fmt: skip
"""Inputs that belong to another one, and that one."""


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
            "bore_shape": "lemon", "lobes": 3, "preload": 0.4, "lobe_angle": "20 deg", "lobe_offset": 0.7,
            "bell_mouth_depth": "5 um", "bell_mouth_length": "4 mm", "tilt_along_load": "0.02 mrad",
            "tilt_across_load": "0.02 mrad", "start_line": "moving",
        }  # fmt: skip
        companions = VOGEL if name.startswith("vogel") else OF_SHAPES.get(name, {})
        raw = case(**{**companions, name: typical.get(name, companions.get(name, OilFilm.example.get(name)))})
        assert (
            evaluate(OilFilm, raw, outputs=["minimum_film_thickness"]).inputs[declared.name].source == "given"
        )


class TestExtremes:
    """physics.md, section 5: each a finite number, or none with its reason; never NaN, inf or a hang."""

    def test_property_ten_thousand_draws(self):
        rng, n = np.random.default_rng(seeded(5)), 10_000
        raw = drawn_bearings(rng, n)
        for level in ("short_bearing", "fit", "map"):
            answers = evaluate(OilFilm, raw, level=level).outputs
            assert_finite_or_reasoned(answers, n)
            assert np.isfinite(answers["minimum_film_thickness"].value).sum() > n / 20

    def test_property_ten_thousand_heat_balances(self):
        rng, n = np.random.default_rng(seeded(6)), 10_000
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
        with pytest.raises(InvalidInputs, match="Each groove extends over 0° to 360°") as refusal:
            outputs(raw, "minimum_film_thickness")
        assert [fault.name for fault in refusal.value.faults] == ["grooves"]

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
