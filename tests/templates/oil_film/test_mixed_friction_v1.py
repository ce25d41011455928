"""`mixed_friction` 1: balance of load, limits, regimes and the shape of Stribeck's curve."""

import numpy as np
import pytest
from seeds import seeded

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.oil_film.journal_friction_v1 import JournalFriction
from templates.oil_film.mixed_friction_v1 import MixedFriction
from templates.oil_film.oil_film_v2 import OilFilm
from templates.physics.journals.mixed_journal import LEVELS, AveragedFilms
from templates.physics.roughness.flow_factors import rough_journal

SMOOTH = {"journal_roughness": "0 um", "bearing_roughness": "0 um"}
WET = {"oil_temperature": None, "dynamic_viscosity": "20 mPa*s"}


def answer(raw=None, *names, **options):
    merged = {**MixedFriction.example, **(raw or {})}
    typed = {name: value for name, value in merged.items() if value is not None}
    return evaluate(MixedFriction, typed, outputs=names or None, **options)


def outputs(raw=None, *names, **options):
    return {name: one.value for name, one in answer(raw, *names, **options).outputs.items()}


def speeds(low, high, count):
    return {"speed": {"value": np.geomspace(low, high, count).tolist(), "unit": "rpm"}}


class TestBalance:
    @pytest.mark.parametrize("level", LEVELS)
    @pytest.mark.parametrize("speed", ["1 rpm", "30 rpm", "300 rpm"])
    def test_analytic_forces_make_the_load(self, level, speed):
        """The film's force at its attitude, the contact's along the line of centres, its friction across."""
        result = outputs({"speed": speed}, level=level)
        film, contact, mu = result["film_load"], result["contact_load"], 0.12
        beta = np.radians(result["attitude_angle"])
        # by the load's components: along the line of centres, and across it
        along, across = 10e3 * np.cos(beta), 10e3 * np.sin(beta)
        assert (along - contact) ** 2 + (across + mu * contact) ** 2 == pytest.approx(film**2, rel=1e-7)

    def test_limit_smooth_faces_are_oil_film_2(self):
        """Roughness 0: eccentricity, torque and power of oil_film 2 at level map."""
        raw = {**SMOOTH, **WET, "speed": "2000 rpm"}
        smooth = OilFilm.example | {
            "radial_load": "10 kN", "bearing_diameter": "50 mm", "bearing_width": "25 mm",
            "diametral_clearance": "0.05 mm", "speed": "2000 rpm", "dynamic_viscosity": "20 mPa*s",
        }  # fmt: skip
        film = evaluate(OilFilm, smooth, level="map").outputs
        result = outputs(raw)
        assert result["relative_eccentricity"] == pytest.approx(film["relative_eccentricity"].value, rel=1e-9)
        assert result["attitude_angle"] == pytest.approx(film["attitude_angle"].value, rel=1e-7)
        assert result["friction_torque"] == pytest.approx(film["friction_torque"].value, rel=1e-7)
        assert result["power_loss"] == pytest.approx(film["power_loss"].value, rel=1e-7)
        assert result["contact_load"] == 0
        assert result["film_parameter"] is None

    @pytest.mark.parametrize("level", LEVELS)
    def test_limit_roughness_vanishes(self, level):
        smooth = outputs({**SMOOTH, **WET})
        fine = outputs({**WET, "journal_roughness": "1 nm", "bearing_roughness": "1 nm"}, level=level)
        for name in ("relative_eccentricity", "friction_coefficient", "attitude_angle"):
            assert fine[name] == pytest.approx(smooth[name], rel=2e-3 if level == "averaged" else 1e-9)

    @pytest.mark.parametrize("level", LEVELS)
    def test_limit_heavy_load_turns_the_journal_to_the_load_and_costs_power(self, level):
        """The attitude angle falls towards 0 and never below, so the film never drives the journal."""
        loads = ["1e5 N", "1e7 N", "1e8 N", "1e9 N", *(["1e10 N"] if level == "averaged" else [])]
        heavy = [outputs({**WET, "radial_load": load}, level=level) for load in loads]
        assert all(one["film_friction"] > 0 for one in heavy)
        assert np.all(np.diff([one["power_loss"] for one in heavy]) > 0)

    def test_limit_light_load_is_petrov(self):
        raw = {"speed": "3000 rpm", "radial_load": "0.1 N", **WET}
        petrov = evaluate(
            JournalFriction,
            {"journal_diameter": "50 mm", "bearing_width": "25 mm", "radial_clearance": "25 um",
             "speed": "3000 rpm", "dynamic_viscosity": "20 mPa*s"},
        ).outputs["friction_torque"]  # fmt: skip
        assert outputs(raw)["friction_torque"] == pytest.approx(petrov.value, rel=1e-4)

    def test_limit_at_rest_is_dry_friction(self):
        """Nothing but contact: it climbs until its friction holds it, and rubs a little more than mu."""
        result = outputs({"speed": "1e-9 rpm", "radial_load": "1 kN"})
        assert result["attitude_angle"] == pytest.approx(-np.degrees(np.arctan(0.12)), abs=0.01)
        assert result["film_load"] < 1e-3
        assert result["friction_coefficient"] == pytest.approx(0.12 * np.cos(np.arctan(0.12)), rel=5e-3)

    def test_analytic_heavier_load_rubs_and_touches_more(self):
        loads = {"value": np.geomspace(1, 60e3, 60).tolist(), "unit": "N"}
        result = outputs({"radial_load": loads})
        for name in ("relative_eccentricity", "contact_load", "friction_torque", "wear_power"):
            assert (np.diff(result[name]) > -1e-12).all(), name

    @pytest.mark.parametrize(("roughness", "ratio", "asymmetry"), [(0.02, 0.5, -0.6), (0.005, 1.0, 0.5)])
    def test_convergence_of_the_interpolated_average_film(self, roughness, ratio, asymmetry):
        """Between the eccentricities at which the average equation was solved, against a finer mesh."""
        sizes = (np.array([one]) for one in (ratio, roughness, asymmetry))
        films = AveragedFilms(*sizes)
        for eps in (0.3, 0.77, 0.93, 1 - 0.9 * roughness):
            load, attitude = films.at(np.array([eps]), np.array([0]))
            exact = rough_journal(eps, ratio, roughness, asymmetry, 128, 16)
            assert load[0] == pytest.approx(exact[0], rel=2e-3)
            assert attitude[0] == pytest.approx(exact[1], abs=1e-3)


class TestStribeck:
    @pytest.mark.parametrize("level", LEVELS)
    def test_literature_curve_has_its_three_branches(self, level):
        """Stribeck 1902 and the seed paper's figure 1: falling from dry friction, a minimum, rising."""
        result = outputs(level=level)
        friction, share = result["friction_over_speed"], result["contact_share_over_speed"]
        lowest = int(friction.argmin())
        assert 0 < lowest < friction.size - 1
        assert (np.diff(friction[: lowest + 1]) < 0).all()
        assert (np.diff(friction[lowest:]) > 0).all()
        assert (np.diff(share) <= 0).all()
        assert share[0] > 0.7
        assert share[-1] < 1e-6
        assert result["least_friction"] == pytest.approx(friction.min(), rel=5e-2)
        assert result["least_friction"] <= friction.min()

    def test_analytic_curve_is_made_of_single_speeds(self):
        curve = outputs({**WET})
        for k in (0, 17, 28, 40):
            one = outputs({**WET, "speed": f"{float(curve['speed_of_the_curve'][k])!r} rpm"})
            assert one["friction_coefficient"] == pytest.approx(curve["friction_over_speed"][k], rel=1e-9)
            assert one["relative_eccentricity"] == pytest.approx(curve["eccentricity_over_speed"][k])

    def test_property_regimes_follow_the_speed(self):
        result = answer(speeds(1, 10_000, 50)).outputs
        words = list(result["lubrication_regime"].value)
        assert [word for i, word in enumerate(words) if i == 0 or word != words[i - 1]] == [
            "boundary", "mixed", "full_film",
        ]  # fmt: skip
        assert (np.diff(result["film_parameter"].value) > 0).all()

    @pytest.mark.parametrize("level", LEVELS)
    @pytest.mark.parametrize("film", [None, "0.3 um", "2 um"])
    @pytest.mark.sampled(2)
    def test_analytic_transition_speed_has_its_film(self, level, film):
        results = outputs({"transition_film": film}, level=level)
        at = outputs(
            {"transition_film": film, "speed": f"{float(results['transition_speed'])!r} rpm"}, level=level
        )
        assert at["minimum_film_thickness"] == pytest.approx(results["transition_film"], rel=1e-6)
        if film is None:
            assert at["film_parameter"] == pytest.approx(3, rel=1e-6)

    def test_property_least_friction_is_near_the_transition(self):
        result = outputs()
        assert 0.3 < result["speed_of_least_friction"] / result["transition_speed"] < 1.2

    def test_property_rougher_faces_touch_at_higher_speed(self):
        rough = {"value": [0.1, 0.2, 0.4, 0.8], "unit": "um"}
        result = outputs({"journal_roughness": rough, "bearing_roughness": rough})
        assert (np.diff(result["transition_speed"]) > 0).all()
        assert (np.diff(result["contact_load"]) > 0).all()
        assert (np.diff(result["speed_of_least_friction"]) > 0).all()

    def test_property_least_friction_by_parabola(self):
        results = outputs()
        near = outputs(speeds(*(results["speed_of_least_friction"] * np.array([0.8, 1.25])), 201))
        lowest = near["friction_coefficient"].min()
        assert results["least_friction"] == pytest.approx(lowest, rel=3e-3)


class TestInputs:
    @pytest.mark.parametrize(
        ("raw", "name"),
        [
            ({"radial_load": "1e15 N"}, "relative_eccentricity"),
            ({"radial_load": "0 N"}, "radial_load"),
            ({"speed": "0 rpm"}, "speed"),
            ({"diametral_clearance": "60 mm"}, "diametral_clearance"),
            ({"bearing_width": "10 m"}, "width_ratio"),
            ({"roughness_product": 0}, "roughness_product"),
            ({"contact_friction": -0.1}, "contact_friction"),
        ],
    )
    def test_property_refuses_by_name(self, raw, name):
        with pytest.raises(InvalidInputs) as refusal:
            outputs(raw)
        assert name in {one for fault in refusal.value.faults for one in fault.names}

    def test_property_what_is_missing_is_said(self):
        outputs = answer(SMOOTH).outputs
        assert outputs["transition_speed"].reason.startswith("the roughness alone")
        assert outputs["film_parameter"].reason == "the surfaces are perfectly smooth"
        assert outputs["largest_contact_pressure"].value == 0

    def test_property_gaps_below_the_tables_are_warned_of(self):
        (warning,) = answer({"speed": "1 rpm"}).warnings
        assert (warning.name, warning.code) == ("film_parameter", "outside_published_range")

    @pytest.mark.parametrize(
        ("level", "count"),
        [("map", 150), ("averaged", 3), pytest.param("map", 5_000, marks=pytest.mark.slow),
         pytest.param("averaged", 100, marks=pytest.mark.slow)],
    )  # fmt: skip
    def test_property_whole_range_is_finite_or_refused(self, level, count):
        rng = np.random.default_rng(seeded(23))

        def drawn(low, high, unit):
            return {"value": (10 ** rng.uniform(low, high, count)).tolist(), "unit": unit}

        D = 10 ** rng.uniform(0, 3, count)
        raw = {
            "radial_load": drawn(-3, 6, "N"),
            "bearing_diameter": {"value": D.tolist(), "unit": "mm"},
            "bearing_width": {"value": (D * 10 ** rng.uniform(-2, 2, count)).tolist(), "unit": "mm"},
            "diametral_clearance": {"value": (D * 10 ** rng.uniform(-5, -1, count)).tolist(), "unit": "mm"},
            "speed": drawn(-4, 5, "rpm"),
            "dynamic_viscosity": drawn(-1, 4, "mPa*s"),
            "journal_roughness": drawn(-4, 2, "um"),
            "bearing_roughness": drawn(-4, 2, "um"),
            "roughness_product": drawn(-3, 0, "1"),
            "summit_slenderness": drawn(-4, 0, "1"),
            "composite_modulus": drawn(-1, 3, "GPa"),
            "contact_friction": {"value": rng.uniform(0, 1, count).tolist(), "unit": "1"},
        }
        results = evaluate(MixedFriction, raw, level=level).outputs
        for name, one in results.items():
            if name == "lubrication_regime":
                continue
            values = np.asarray(one.value, dtype=float)
            assert not np.isinf(values).any(), name
            values = np.broadcast_to(values, count) if values.ndim == 0 else values.reshape(count, -1)
            missing = np.isnan(values.reshape(count, -1)).any(axis=1)
            reasons = np.full(count, one.reason) if one.reasons is None else one.reasons
            assert all(reasons[i] for i in np.flatnonzero(missing)), name
        assert np.isfinite(results["friction_coefficient"].value).mean() > 0.5
