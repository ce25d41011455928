"""`oil_film` 2: shapes, tilt, start line, and grooves under the load."""

import numpy as np
import pytest
from bearings import ETA, OMEGA, PSI, D, balanced, bearing, si

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_v2 import OilFilm

FILM, EPS = "minimum_film_thickness", "relative_eccentricity"
SPLIT = {"value": [[90, 20], [270, 20]], "unit": "deg"}
COUPLE = 1e-9
"""Of a film's couples in the units of this bearing's: none [N m]."""


def values(raw, *names, **options):
    answers = evaluate(OilFilm, raw, outputs=names, **options).outputs
    numbers = [answers[name].value for name in names]
    return numbers[0] if len(names) == 1 else numbers


class TestShapes:
    def test_property_level_follows_shape_and_feed(self):
        lemon = bearing(1.0, 0.5, bore_shape="lemon", preload=0.4)
        assert evaluate(OilFilm, lemon, outputs=[FILM]).level == "reynolds"
        assert evaluate(OilFilm, {**lemon, "grooves": SPLIT}, outputs=[FILM]).level == "mass_conserving"
        assert evaluate(OilFilm, bearing(1.0, 0.5), outputs=[FILM]).level == "map"

    @pytest.mark.parametrize("level", ["short_bearing", "fit", "map"])
    @pytest.mark.parametrize(
        "shape",
        [{"bore_shape": "lemon", "preload": 0.4}, {"tilt_across_load": "0.1 mrad"},
         {"bell_mouth_depth": "5 um", "bell_mouth_length": "5 mm"}],
    )  # fmt: skip
    def test_property_levels_of_a_plain_bore_refuse_others(self, level, shape):
        with pytest.raises(InvalidInputs, match="need level `reynolds` or `mass_conserving`"):
            values(bearing(1.0, 0.5, **shape), FILM, level=level)

    def test_property_a_point_without_shape_is_that_of_the_plain_bore(self):
        raw = bearing([1.0, 1.0], [0.5, 0.5], tilt_along_load=si([0.0, 1e-4], "rad"))
        plain, tilted = values(raw, FILM, level="reynolds")
        assert plain == pytest.approx(values(bearing(1.0, 0.5), FILM, level="reynolds"), rel=1e-12)
        assert tilted < 0.99 * plain

    @pytest.mark.parametrize("level", ["reynolds", "mass_conserving"])
    def test_property_no_shape_left_is_the_plain_film(self, level):
        """A tilt that displaces the ends by a millionth of the clearance: solved on the whole width."""
        raw = bearing(1.0, 0.5, tilt_along_load=si(1e-6 * PSI / 0.5, "rad"))
        names = (EPS, "attitude_angle", FILM, "maximum_pressure", "power_loss", "side_flow", "stiffness_xx")
        tilted = values(raw, *names, level=level)
        plain = values(bearing(1.0, 0.5), *names, level=level)
        np.testing.assert_allclose(tilted, plain, rtol=1.2e-2)
        np.testing.assert_allclose(tilted[:4], plain[:4], rtol=5e-4)

    def test_property_shapes_thin_the_film_and_tilt_is_resisted(self):
        film = values(bearing(1.0, 0.5), FILM)
        for shape in ({"tilt_along_load": "0.3 mrad"}, {"bore_shape": "lemon", "preload": 0.5}):
            assert values(bearing(1.0, 0.5, **shape), FILM) < film
        along, across = values(bearing(1.0, 0.5, tilt_along_load="0.3 mrad"), "couple_along_load",
                               "couple_across_load")  # fmt: skip
        assert along > abs(across) > COUPLE

    def test_analytic_power_is_torque_times_speed(self):
        raw = bearing(1.0, 0.5, bore_shape="multi_lobe", lobes=3, preload=0.5, lobe_angle="20 deg")
        torque, power = values(raw, "friction_torque", "power_loss")
        assert power == pytest.approx(torque * OMEGA, rel=1e-12)

    def test_property_lemon_is_two_lobes_and_offset_is_their_end(self):
        lemon, lobed, turned, halves = (
            values(bearing(1.0, 0.5, preload=0.5, **shape), FILM)
            for shape in (
                {"bore_shape": "lemon"},
                {"bore_shape": "multi_lobe", "lobes": 2},
                {"bore_shape": "lemon", "lobe_offset": 1},
                {"bore_shape": "offset"},
            )
        )
        assert lemon == lobed
        assert turned == halves
        assert lemon != halves

    @pytest.mark.parametrize(
        ("wrong", "names"),
        [({"preload": 0.3}, {"preload", "bore_shape"}),
         ({"bore_shape": "lemon", "preload": 0.3, "sleeve_speed": "10 rpm"}, {"sleeve_speed"}),
         ({"bell_mouth_depth": "5 um", "bell_mouth_length": "30 mm"}, {"bell_mouth_length"}),
         ({"preload": 1, "bore_shape": "lemon"}, {"preload"})],
    )  # fmt: skip
    def test_property_impossible_shapes_are_refused_by_name(self, wrong, names):
        with pytest.raises(InvalidInputs) as refusal:
            values(bearing(1.0, 0.5, **wrong), FILM)
        assert names & {fault.name for fault in refusal.value.faults}

    def test_property_tilt_that_touches_is_refused(self):
        with pytest.raises(InvalidInputs, match="no film was found that bears this: change load, clearance"):
            values(bearing(1.0, 0.5, tilt_along_load="5 mrad"), FILM)

    @pytest.mark.parametrize("grooves", [[[0, 360]], [[180, 350]]])
    def test_property_grooves_all_around_are_refused(self, grooves):
        """No node is left between them, on one mesh or on all."""
        with pytest.raises(InvalidInputs, match="If a groove lies near the load"):
            values(bearing(1.0, 0.5, grooves={"value": grooves, "unit": "deg"}), FILM)

    @pytest.mark.parametrize("lobes", [3, 8])
    def test_limit_a_light_load_leaves_the_journal_in_the_middle_of_tight_lobes(self, lobes):
        """The coarsest mesh does not resolve all lobes; without it the place is within its mesh error."""
        raw = bearing(1e-3, 0.5, bore_shape="multi_lobe", lobes=lobes, preload=0.9)
        film, error = values(raw, FILM, "mesh_error")
        assert film == pytest.approx(PSI * D / 2 * 1e6, rel=error)

    @pytest.mark.parametrize(("shape", "count"), [({"bore_shape": "lemon"}, 1), ({}, 0)])
    def test_property_lobes_without_preload_are_remarked(self, shape, count):
        warnings = evaluate(OilFilm, bearing(1.0, 0.5, **shape)).warnings
        assert [w.detail for w in warnings if w.name == "preload"] == [
            "preload 0 is not above 0; give preload, such as 0.5, or set `bore_shape` to `plain`"
        ] * count

    def test_property_the_error_stated_is_that_of_the_mesh(self):
        lemon = evaluate(OilFilm, bearing(1.0, 0.5, bore_shape="lemon", preload=0.4))
        assert 0 < lemon.outputs["mesh_error"].value == lemon.error[FILM] < 0.01
        assert np.isnan(lemon.error["power_loss"])
        assert "plain" in evaluate(OilFilm, bearing(1.0, 0.5)).outputs["mesh_error"].reason


class TestLightLoad:
    """Bores of lobes and grooves under loads that the force of a coarse mesh outweighs."""

    def test_literature_two_lobes_of_someya(self):
        """Shared cases, table Film: Someya 1989, eps 0.0172 at 81.2°; a finer mesh has 0.0175."""
        raw = {
            "bearing_diameter": "100 mm", "bearing_width": "100 mm", "diametral_clearance": "0.1 mm",
            "dynamic_viscosity": "20 mPa*s", "speed": "100 rad/s", "radial_load": "72.2 N",
            "bore_shape": "lemon", "preload": 2 / 3,
            "grooves": {"value": [[90, 10], [270, 10]], "unit": "deg"},
        }  # fmt: skip
        answer = evaluate(OilFilm, raw, level="mass_conserving")
        eps, attitude = (answer.outputs[name].value for name in ("relative_eccentricity", "attitude_angle"))
        assert eps == pytest.approx(0.0172, rel=0.03)
        assert attitude == pytest.approx(81.2, abs=0.5)
        assert abs(eps / 0.0175 - 1) < answer.error["relative_eccentricity"] < 0.1

    def test_property_a_heat_balance_leaves_the_error_unknown(self):
        """It takes its power and flow from a plain bearing."""
        raw = balanced(supply_temperature="70 degC", bore_shape="lemon", preload=0.4)
        answer = evaluate(OilFilm, raw, outputs=[FILM, "mesh_error"])
        assert answer.outputs["mesh_error"].value > 0
        assert np.isnan(answer.error[FILM])


class TestStartLine:
    def stiffness(self, line, eps_0=0.1, **options):
        """K over W/c at B/D 1, and the whirl limit."""
        from templates.physics.films.film_map import mapped_load

        So = float(mapped_load(np.array(eps_0), np.array(1.0)))
        raw = bearing(So, 1.0, start_line=line)
        names = ("stiffness_xx", "stiffness_xy", "stiffness_yx", "stiffness_yy")
        *K, whirl = values(raw, *names, "whirl_threshold_speed", **options)
        load = So * D**2 * ETA * OMEGA / PSI**2
        return np.array(K) * PSI * D / 2 / load, whirl

    def test_property_both_values_of_the_docs(self):
        fixed, moving = (self.stiffness(line) for line in ("fixed", "moving"))
        assert fixed[0][0] == pytest.approx(0.83, abs=0.01)
        assert moving[0][0] == pytest.approx(1.91, abs=0.01)
        assert moving[1] / fixed[1] == pytest.approx(1.11, abs=0.01)

    def test_analytic_moving_stiffness_is_the_slope_of_the_solved_film(self):
        """Forces of films whose line lies opposite the journal, by differences; level reynolds."""
        from templates.physics.films.reynolds import static_film

        def force(x, y):
            film = static_film(float(np.hypot(x, y)), 1.0, 256, 32)
            angle = np.arctan2(y, x) - film.attitude
            return film.So * np.array([np.cos(angle), np.sin(angle)])

        film = static_film(0.3, 1.0, 256, 32)
        x, y, h = 0.3 * np.cos(film.attitude), 0.3 * np.sin(film.attitude), 1e-4
        slope = [(force(x + dx, y + dy) - force(x - dx, y - dy)) / (2 * h) for dx, dy in ((h, 0), (0, h))]
        K = self.stiffness("moving", 0.3, level="reynolds")[0]
        np.testing.assert_allclose(K, np.array(slope).T.ravel() / film.So, rtol=3e-3)

    def test_property_the_short_bearing_knows_no_difference(self):
        fixed, moving = (self.stiffness(line, level="short_bearing")[0] for line in ("fixed", "moving"))
        np.testing.assert_allclose(fixed, moving, rtol=1e-6)

    def test_property_moving_is_absent_where_it_is_not_known(self):
        answers = evaluate(OilFilm, bearing(1.0, 0.5, start_line="moving"), level="mass_conserving").outputs
        assert "moving start line" in answers["stiffness_xx"].reason
        tilted = bearing(1.0, 0.5, start_line="moving", tilt_along_load="0.1 mrad")
        assert "moving start line" in evaluate(OilFilm, tilted).outputs["stiffness_xx"].reason

    def test_property_unused_start_line_warns(self):
        raw = bearing(1.0, 0.5, start_line="moving", grooves=SPLIT)
        evaluation = evaluate(OilFilm, raw)
        assert [w.code for w in evaluation.warnings] == ["unused_input"]
        assert evaluation.outputs["stiffness_xx"].value > 0


class TestGrooveInTheLoadLine:
    @pytest.mark.parametrize("angle", [-10, 0])
    def test_property_refusal_says_why(self, angle):
        raw = bearing(1.5, 0.5, grooves={"value": [[angle, 20]], "unit": "deg"}, supply_pressure="0.4 bar")
        with pytest.raises(InvalidInputs, match="move that groove away, or raise the supply pressure"):
            values(raw, FILM)

    def test_property_a_film_that_passes_the_groove_is_solved(self):
        """At 20°: relative pressure 0.2, eps 0.916."""
        pressure = 0.2 * ETA * OMEGA / PSI**2
        raw = bearing(
            1.5, 0.5, grooves={"value": [[20, 20]], "unit": "deg"}, supply_pressure=si(pressure, "Pa")
        )
        assert values(raw, EPS) == pytest.approx(0.9157, abs=2e-3)
