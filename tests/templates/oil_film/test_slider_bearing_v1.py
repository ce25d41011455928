"""`slider_bearing` 1 against closed forms, balances and its own finite width.

Course MEC 315; Lord Rayleigh 1918; worked values of the references: W h_o²/(6 eta U l² b) = 0.02648051 at
h_i = 2 h_o, and 0.02670719 at the best film ratio, 2.1889.
"""

import numpy as np
import pytest
from seeds import seeded

from templates.core.errors import InvalidInputs, Unreachable
from templates.core.language.evaluate import evaluate
from templates.core.language.levels import accuracy
from templates.core.language.solve import solve
from templates.oil_film.slider_bearing_v1 import SliderBearing

LEVELS = SliderBearing.levels


def outputs(raw=None, *names, **options):
    answers = evaluate(
        SliderBearing, {**SliderBearing.example, **(raw or {})}, outputs=names or None, **options
    )
    return {name: answer.value for name, answer in answers.outputs.items()}


def load_number(result, h_i):
    """W h_o²/(6 eta U l² b) of the example's pad."""
    return result["load"] * (h_i / 2) ** 2 / (6 * 0.03 * 10 * 0.05**2 * 0.05)


class TestLiterature:
    @pytest.mark.parametrize(("ratio", "printed"), [(2.0, 0.02648051), (2.1889, 0.02670719)])
    def test_literature_load(self, ratio, printed):
        result = outputs({"inlet_film": f"{ratio * 30} um"}, level="infinite")
        number = result["load"] * 30e-6**2 / (6 * 0.03 * 10 * 0.05**2 * 0.05)
        assert number == pytest.approx(printed, abs=5e-9)

    def test_literature_best_film_ratio(self):
        """References README: the load is largest at 2.1889, of 0.02670719."""
        films = {"value": np.linspace(2, 2.4, 4001) * 30, "unit": "um"}
        films["value"] = films["value"].tolist()
        load = outputs({"inlet_film": films}, "load", level="infinite")["load"]
        assert films["value"][int(np.argmax(load))] / 30 == pytest.approx(2.1889, abs=5e-4)

    def test_literature_best_film_ratio_by_solve(self):
        """Two pads carry what is below the best load; the lower film ratio is given, and the other."""
        target = {"load": f"{0.0266 * 6 * 0.03 * 10 * 0.05**2 * 0.05 / 30e-6**2} N"}
        raw = {name: value for name, value in SliderBearing.example.items() if name != "inlet_film"}
        result = solve(SliderBearing, raw, "inlet_film", ["31 um", "150 um"], target, level="infinite")
        assert result.unknown / 30 < 2.1889
        assert {w.code for w in result.warnings} >= {"several_solutions"}
        with pytest.raises(Unreachable, match="out of reach"):
            solve(SliderBearing, raw, "inlet_film", ["31 um", "150 um"], {"load": "20 kN"})

    def test_literature_velocity_meets_both_faces(self):
        """The course's print, without z in its last terms, does not."""
        result = outputs()
        assert result["velocity"][[0, -1]] == pytest.approx([0, 10])
        assert result["height_above_pad"][[0, -1]] == pytest.approx([0, 36])

    def test_literature_numbers_of_the_course(self):
        """R_x = rho u h²/(eta l), sigma_s = rho h²/(eta t): with t = l/u they are the same."""
        result = outputs()
        assert result["reynolds_number_x"] == pytest.approx(860 * 10 * 30e-6**2 / (0.03 * 0.05))
        assert result["squeeze_number"] == pytest.approx(result["reynolds_number_x"])
        slow = outputs({"film_change_time": "1 s"}, "squeeze_number")["squeeze_number"]
        assert slow == pytest.approx(860 * 30e-6**2 / 0.03)


class TestAnalytic:
    @pytest.mark.parametrize("level", LEVELS)
    @pytest.mark.parametrize("film", [31, 45, 60, 300])
    def test_analytic_forces_balance(self, level, film):
        """Friction on the runner less that on the pad is the load's part along the incline."""
        result = outputs({"inlet_film": f"{film} um"}, level=level)
        along = result["load"] * (film - 30) * 1e-6 / 0.05
        assert result["friction_force_moving"] - result["friction_force_fixed"] == pytest.approx(along)

    @pytest.mark.parametrize("level", LEVELS)
    def test_analytic_power_and_coefficient(self, level):
        result = outputs(level=level)
        assert result["power_loss"] == pytest.approx(result["friction_force_moving"] * 10)
        friction = result["friction_force_moving"] / result["load"]
        assert result["friction_coefficient"] == pytest.approx(friction)

    def test_analytic_flow_is_the_same_everywhere_without_leakage(self):
        """U h/2 − h³ p'/(12 eta) at any place, and it enters at the inlet."""
        places = {"value": np.linspace(0, 50, 11).tolist(), "unit": "mm"}
        result = outputs({"place": places}, level="infinite")
        h, slope = result["local_film"] * 1e-6, result["pressure_gradient"] * 1e9
        flow = 0.05 * (10 * h / 2 - h**3 * slope / (12 * 0.03)) * 1e6
        np.testing.assert_allclose(flow, result["inlet_flow"], rtol=1e-12)
        assert result["side_flow"] == 0

    @pytest.mark.parametrize("level", LEVELS)
    def test_analytic_velocity_carries_the_flow(self, level):
        result = outputs({"width": "5 m"}, level=level)
        flow = np.trapezoid(result["velocity"], result["height_above_pad"] * 1e-6) * 5 * 1e6
        assert flow == pytest.approx(result["inlet_flow"], rel=5e-3)

    def test_analytic_flow_closes(self):
        """What enters leaves at the outlet and at the sides, and the narrower the pad, the more there."""
        result = outputs({"width": {"value": [5, 50, 500], "unit": "mm"}})
        outlet = result["inlet_flow"] - result["side_flow"]
        sheared = 10 * 30e-6 / 2 * np.array([0.005, 0.05, 0.5]) * 1e6
        assert (outlet > sheared).all()
        assert (np.diff(result["side_flow"] / result["inlet_flow"]) < 0).all()

    @pytest.mark.parametrize("level", LEVELS)
    def test_analytic_pressure_curve(self, level):
        """Ambient at both ends, its highest the maximum pressure at its place, its slope the gradient."""
        result = outputs(level=level)
        x, p = result["place_along_pad"], result["pressure"]
        assert p[[0, -1]] == pytest.approx([0, 0], abs=1e-12)
        assert x[int(p.argmax())] == pytest.approx(result["place_of_maximum_pressure"], abs=0.5)
        assert p.max() == pytest.approx(result["maximum_pressure"], rel=1e-3)
        slope = (p[81] - p[79]) / (x[81] - x[79])
        assert result["pressure_gradient"] == pytest.approx(slope, rel=5e-3)

    def test_analytic_pressure_carries_the_load_without_leakage(self):
        result = outputs(level="infinite")
        x, p = result["place_along_pad"] * 1e-3, result["pressure"] * 1e6
        assert np.trapezoid(p, x) * 0.05 == pytest.approx(result["load"], rel=2e-4)
        centre = np.trapezoid(p * x, x) / np.trapezoid(p, x)
        assert result["centre_of_pressure"] == pytest.approx(1e3 * centre, rel=1e-4)

    def test_analytic_wide_pad_tends_to_no_leakage(self):
        wide = {"width": "5 m"}
        finite, infinite = outputs(wide), outputs(wide, level="infinite")
        assert finite["load"] == pytest.approx(infinite["load"], rel=0.01)
        assert finite["maximum_pressure"] == pytest.approx(infinite["maximum_pressure"], rel=1e-5)
        assert 2.2 < outputs(level="infinite")["load"] / outputs()["load"] < 2.4

    @pytest.mark.parametrize("level", LEVELS)
    def test_analytic_one_call_for_many_pads(self, level):
        films = [35, 50, 60, 80]
        many = outputs({"inlet_film": {"value": films, "unit": "um"}}, level=level)
        for i, film in enumerate(films):
            one = outputs({"inlet_film": f"{film} um"}, level=level)
            for name in ("load", "centre_of_pressure", "pressure", "velocity"):
                np.testing.assert_allclose(many[name][i], one[name], rtol=1e-10)


class TestLimits:
    @pytest.mark.parametrize("level", LEVELS)
    def test_literature_parallel_pad_bears_nothing(self, level):
        answers = evaluate(
            SliderBearing, {**SliderBearing.example, "inlet_film": "30 um"}, level=level
        ).outputs
        assert answers["load"].value == answers["maximum_pressure"].value == 0
        assert (answers["pressure"].value == 0).all()
        assert answers["friction_force_moving"].value == pytest.approx(0.03 * 10 * 0.05**2 / 30e-6)
        for name in ("centre_of_pressure", "friction_coefficient", "place_of_maximum_pressure"):
            assert answers[name].value is None
            assert "bears nothing" in answers[name].reason

    @pytest.mark.parametrize("level", LEVELS)
    def test_analytic_diverging_pad_ruptures(self, level):
        """It bears nothing, and streamers that carry the inlet's flow shear: the mean of h_i h_o/h² is 1."""
        result = evaluate(SliderBearing, {**SliderBearing.example, "inlet_film": "15 um"}, level=level)
        assert result.outputs["load"].value == 0
        for face in ("moving", "fixed"):
            friction = result.outputs[f"friction_force_{face}"].value
            assert friction == pytest.approx(0.03 * 10 * 0.05**2 / 30e-6)
        assert result.outputs["inlet_flow"].value == pytest.approx(0.05 * 10 * 15e-6 / 2 * 1e6)
        (warning,) = result.warnings
        assert warning.name == "convergence"
        assert "ruptures" in warning.detail

    @pytest.mark.parametrize(
        ("raw", "name"),
        [
            ({"density": "9e4 kg/m**3"}, "reynolds_number_x"),
            (
                {"density": "9e5 kg/m**3", "outlet_film": "1 um", "inlet_film": "60 um"},
                "film_reynolds_number",
            ),
        ],
    )
    def test_literature_inertia_and_turbulence_are_said(self, raw, name):
        warnings = evaluate(SliderBearing, {**SliderBearing.example, **raw}, outputs=["load"]).warnings
        assert name in {warning.name for warning in warnings}

    def test_literature_nothing_is_said_without_density(self):
        raw = {
            name: value for name, value in SliderBearing.example.items() if name not in ("density", "place")
        }
        result = evaluate(SliderBearing, raw)
        assert result.warnings == []
        assert result.outputs["reynolds_number_x"].reason == "needs density"
        assert result.outputs["velocity"].reason == "needs place"

    @pytest.mark.parametrize(
        ("raw", "name", "code"),
        [
            ({"sliding_speed": "0 m/s"}, "sliding_speed", "out_of_range"),
            ({"sliding_speed": "-3 m/s"}, "sliding_speed", "out_of_range"),
            ({"outlet_film": "0 um"}, "outlet_film", "out_of_range"),
            ({"width": "-1 mm"}, "width", "out_of_range"),
            ({"place": "51 mm"}, "place", "inconsistent"),
            ({"inlet_film": "31 mm"}, "film_ratio", "outside_domain"),
            ({"width": "0.4 mm"}, "width_ratio", "outside_domain"),
            ({"width": "6 m"}, "width_ratio", "outside_domain"),
            ({"length": "5 kg"}, "length", "wrong_unit"),
        ],
    )
    def test_literature_refuses_by_name(self, raw, name, code):
        with pytest.raises(InvalidInputs) as refusal:
            outputs(raw)
        assert (name, code) in {(one, fault.code) for fault in refusal.value.faults for one in fault.names}

    @pytest.mark.parametrize("raw", [{"inlet_film": "31 mm"}, {"width": "0.4 mm"}, {"width": "6 m"}])
    def test_analytic_closed_form_has_no_limits_of_a_mesh(self, raw):
        assert outputs(raw, level="infinite")["load"] > 0

    @pytest.mark.parametrize("level", LEVELS)
    def test_property_whole_range_is_finite_or_refused(self, level):
        """10⁴ pads: every number finite, or none with its reason."""
        rng, n = np.random.default_rng(seeded(5)), 10_000
        length = 10 ** rng.uniform(-4, 1, n)
        outlet = 10 ** rng.uniform(-8, -3, n)
        raw = {
            "length": (length, "m"),
            "width": (length * 10 ** rng.uniform(-2.3, 2.3, n), "m"),
            "inlet_film": (outlet * 10 ** rng.uniform(-4, 4, n), "m"),
            "outlet_film": (outlet, "m"),
            "sliding_speed": (10 ** rng.uniform(-6, 3, n), "m/s"),
            "dynamic_viscosity": (10 ** rng.uniform(-6, 3, n), "Pa*s"),
            "density": (10 ** rng.uniform(1, 4, n), "kg/m**3"),
            "place": (length * rng.uniform(-0.1, 1.1, n), "m"),
        }
        typed = {name: {"value": value.tolist(), "unit": unit} for name, (value, unit) in raw.items()}
        for name, answer in evaluate(SliderBearing, typed, level=level).outputs.items():
            value = np.broadcast_to(answer.value, (n, *np.shape(answer.value)[1:])).reshape(n, -1)
            missing = np.isnan(value).any(axis=1)
            assert not np.isinf(value).any(), name
            assert answer.reasons is not None or not missing.any(), name
            assert all(answer.reasons[i] for i in np.flatnonzero(missing)), name
            assert missing.mean() < 0.75, name


class TestAccuracy:
    def test_property_tolerance_climbs_the_ladder(self):
        """Where side leakage matters the closed form will not do; where it does not, it will."""
        wide = {**SliderBearing.example, "width": "5 m"}
        named = {"outputs": ["load", "friction_force_moving"]}
        assert evaluate(SliderBearing, wide, tolerance=0.05, **named).level == "infinite"
        assert evaluate(SliderBearing, wide, tolerance=1e-3, **named).level == "finite"
        assert evaluate(SliderBearing, SliderBearing.example, tolerance=0.05, **named).level == "finite"

    def test_property_profiles_of_two_levels_are_joined(self):
        widths = {"value": [50, 5000], "unit": "mm"}
        raw = {**SliderBearing.example, "width": widths}
        result = evaluate(SliderBearing, raw, tolerance=0.05, outputs=["load", "pressure"], per_point=True)
        assert list(result.level) == ["finite", "infinite"]
        for i, level in enumerate(result.level):
            alone = evaluate(SliderBearing, {**raw, "width": f"{widths['value'][i]} mm"}, level=level)
            np.testing.assert_allclose(result.outputs["pressure"].value[i], alone.outputs["pressure"].value)

    @pytest.mark.parametrize("level", LEVELS)
    def test_property_measured_error_bounds_the_error(self, level):
        """500 pads against a finer mesh; the table holds the largest error of each cell."""
        rng, n = np.random.default_rng(6), 500
        ratio, width = 1 + 10 ** rng.uniform(-3, 1, n), 10 ** rng.uniform(-1, 1, n)
        raw = {
            **SliderBearing.example,
            "inlet_film": {"value": (30 * ratio).tolist(), "unit": "um"},
            "width": {"value": (50 * width).tolist(), "unit": "mm"},
        }
        names = ["load", "friction_force_moving", "inlet_flow"]
        result = evaluate(SliderBearing, raw, outputs=names, level=level)
        true = finer(ratio, width)
        for name in names:
            error = np.abs(result.outputs[name].value / true[name] - 1)
            assert (error <= result.error[name]).mean() >= 0.99, name

    def test_property_every_output_that_has_a_level_is_measured(self):
        measured = accuracy(SliderBearing)
        reported = {
            n for n, f in SliderBearing.formulas.items() if "level" in SliderBearing.ancestors(f.attribute)
        }
        for level in LEVELS:
            assert set(measured.errors[level]) == reported


def finer(ratio, width):
    """The pads solved on 128 × 32 intervals and 64 × 16, extrapolated, with the example's dimensions."""
    from templates.physics.pads.slider_film import finite_pad

    film = finite_pad(ratio, width, 128, 32)
    return {
        "load": 6 * 0.03 * 10 * 0.05**2 * 0.05 * width / 30e-6**2 * film.load,
        "friction_force_moving": 0.03 * 10 * 0.05**2 * width / 30e-6 * film.friction_moving,
        "inlet_flow": 10 * 30e-6 * 0.05 * width * film.inlet_flow * 1e6,
    }
