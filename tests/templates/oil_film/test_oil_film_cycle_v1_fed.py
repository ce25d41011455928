"""`oil_film_cycle`: grooves, supplies, conventions, what is refused; the cheap levels.

Analytic: limits and transformations. Level supplied: test_fed_cycle.
"""

import numpy as np
import pytest

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_cycle_v1 import OilFilmCycle

D, PSI, ETA, OMEGA = 0.1, 1e-3, 0.02, 300.0
COUNT = 72
ANGLE = np.arange(COUNT) * 2 * np.pi / COUNT
X, Y = 2 + 3 * np.exp(6 * (np.cos(ANGLE - 0.4) - 1)) + 0.5 * np.cos(2 * ANGLE), np.sin(ANGLE)
GROOVE = {"groove_width": "10 mm", "supply_pressure": "3 bar"}
HALF = {**GROOVE, "groove_start": "-90 deg", "groove_extent": "180 deg"}
PIN = {"pin_hole_length": "5 mm", "supply_pressure": "3 bar"}
FILM = ("minimum_film_thickness", "maximum_pressure", "power_loss", "side_flow", "film_thickness")


FEEDS = {"groove_width", "sleeve_hole_length", "pin_hole_length"}


def si(value, unit):
    return {"value": np.asarray(value, dtype=float).tolist(), "unit": unit}


def inputs(x, y, ratio=0.5, **changes):
    """A bearing of B/D under loads of So's size: x, y are F psi²/(B D eta omega)."""
    scale = ETA * OMEGA * D * D * ratio / PSI**2
    shape = np.broadcast_shapes(np.shape(x), np.shape(y), (COUNT,))
    x, y = (np.broadcast_to(np.asarray(v, dtype=float), shape) for v in (x, y))
    return {
        "crank_angle": si(np.degrees(ANGLE), "deg"),
        "load_x": si(x * scale, "N"),
        "load_y": si(y * scale, "N"),
        "speed": si(OMEGA, "rad/s"),
        "bearing_diameter": si(D, "m"),
        "bearing_width": si(D * ratio, "m"),
        "diametral_clearance": si(D * PSI, "m"),
        "dynamic_viscosity": si(ETA, "Pa*s"),
        **({} if FEEDS & changes.keys() else {"oil_supply": "flooded_ends"}),
        **changes,
    }


def outputs(raw, level=None, **keywords):
    return {n: a.value for n, a in evaluate(OilFilmCycle, raw, level=level, **keywords).outputs.items()}


def refusal(raw, level=None):
    with pytest.raises(InvalidInputs) as refused:
        evaluate(OilFilmCycle, raw, level=level)
    return {name: fault.detail for fault in refused.value.faults for name in fault.names}


class TestMobility:
    def test_analytic_constant_load_rests(self):
        result = outputs(inputs(3.0, 0.0, **GROOVE))
        assert np.ptp(result["film_thickness"]) < 1e-6 * result["minimum_film_thickness"]

    def test_analytic_opposite_sense_turns_the_load(self):
        one = outputs(inputs(X, Y, **HALF))
        turned = outputs(inputs(-X, -Y, **HALF, load_sense="sleeve_on_journal"))
        wrong = outputs(inputs(-X, -Y, **HALF))
        assert turned["eccentricity_x"] == pytest.approx(one["eccentricity_x"], abs=1e-12)
        assert wrong["minimum_film_thickness"] > 1.3 * one["minimum_film_thickness"]

    def test_property_film_between_the_angles_and_its_error(self):
        coarse, fine = (np.arange(n) * 2 * np.pi / n for n in (24, 360))
        raws = []
        for angle in (coarse, fine):
            load = np.interp(angle, coarse, 4 + 3 * np.cos(coarse), period=2 * np.pi)
            raw = inputs(1.0, 0.0)
            force = si(load * ETA * OMEGA * D * D * 0.5 / PSI**2, "N")
            nothing = si(np.zeros(angle.size), "N")
            raws.append(
                {**raw, "crank_angle": si(np.degrees(angle), "deg"), "load_x": force, "load_y": nothing}
            )
        one, two = (outputs(raw) for raw in raws)
        name = "minimum_film_thickness"
        assert one[name] == pytest.approx(two[name], rel=one["numerical_error"])
        assert 0 < one["numerical_error"] < 1e-2


class TestGroove:
    def test_analytic_groove_that_the_load_never_passes_is_none(self):
        """However wide it is, down to no width; the supply bears next to nothing."""
        away = inputs(1.0, 0.0, **HALF) | {
            "groove_start": "135 deg",
            "groove_extent": "90 deg",
            "supply_pressure": "1e-9 bar",
        }
        plain = outputs(away, "mobility")
        for width in ("1e-6 mm", "20 mm"):
            grooved = outputs(away | {"groove_width": width})
            for name in FILM:
                assert grooved[name] == pytest.approx(plain[name], rel=1e-9), name

    def test_analytic_groove_that_the_load_passes_is_felt_however_narrow_it_is(self):
        """No pressure at its edges: two bearings of half the width, bearing a quarter of the load."""
        ratio = 0.05
        narrow = outputs(inputs(0.1, 0.0, ratio, **GROOVE | {"groove_width": "1e-6 mm"}))
        quarter = outputs(inputs(0.4, 0.0, ratio), "mobility")
        assert narrow["maximum_eccentricity"] == pytest.approx(quarter["maximum_eccentricity"], rel=2e-3)

    def test_analytic_full_groove_is_two_bearings_of_half_the_land(self):
        """Each of the two lands bears half the load."""
        share, ratio = 0.2, 0.5
        grooved = outputs(inputs(X, Y, ratio, **GROOVE))
        land = ratio * (1 - share) / 2
        alone = inputs(X, Y, ratio)
        halved = {axis: si(np.asarray(alone[axis]["value"]) / 2, "N") for axis in ("load_x", "load_y")}
        one = outputs({**alone, **halved, "bearing_width": si(D * land, "m")}, "mobility")
        for name in ("film_thickness", "eccentricity_x", "eccentricity_y", "peak_pressure"):
            assert grooved[name] == pytest.approx(one[name], rel=1e-6), name
        assert grooved["minimum_film_thickness"] == pytest.approx(one["minimum_film_thickness"], rel=1e-9)
        c, h = D * PSI / 2, D * PSI / 2 * np.asarray(grooved["film_thickness"]) / (D * PSI / 2 * 1e6)
        eps = 1 - h / c
        driven = 3e5 * np.pi * D * (c**3 * (1 + 1.5 * eps**2)).mean() / (6 * ETA * D * land)
        assert grooved["side_flow"] == pytest.approx(2 * one["side_flow"] + driven * 60_000, rel=1e-6)

    def test_analytic_groove_turns_with_the_frame(self):
        """The same bearing seen in axes that stand askew: load, groove and all turned by 40°."""
        turn = np.radians(40)
        c, s = np.cos(turn), np.sin(turn)
        one = outputs(inputs(X, Y, **HALF))
        two = outputs(inputs(c * X - s * Y, s * X + c * Y, **HALF | {"groove_start": "-50 deg"}))
        for name in FILM:
            assert two[name] == pytest.approx(one[name], rel=1e-8), name

    def test_analytic_groove_of_a_sleeve_that_turns_with_the_load(self):
        """Seen from a frame that turns with the crank, a resting groove runs round the other way."""
        angle = np.arange(720) * np.pi / 360
        x, y = 2 + 3 * np.exp(6 * (np.cos(angle - 0.4) - 1)), np.sin(angle)
        c, s = np.cos(angle), np.sin(angle)
        scale = ETA * OMEGA * D * D * 0.5 / PSI**2
        raw = inputs(1.0, 0.0, **HALF) | {"crank_angle": si(np.degrees(angle), "deg")}
        still = raw | {"load_x": si(x * scale, "N"), "load_y": si(y * scale, "N")}
        turned = raw | {
            "load_x": si((x * c + y * s) * scale, "N"),
            "load_y": si((y * c - x * s) * scale, "N"),
            "frame_speed": si(OMEGA, "rad/s"),
        }
        one, two = outputs(still), outputs(turned)
        assert two["film_thickness"] == pytest.approx(one["film_thickness"], rel=3e-3)
        assert two["power_loss"] == pytest.approx(one["power_loss"], rel=1e-3)

    def test_property_uneven_angles_tell_their_rings_apart(self):
        angle = np.radians(
            np.concatenate([np.arange(0, 20, 1.0), np.arange(20, 60, 1.6), np.arange(60, 360, 4.0)])
        )
        scale = ETA * OMEGA * D * D * 0.5 / PSI**2
        curves = {
            "crank_angle": si(np.degrees(angle), "deg"),
            "load_x": si(np.interp(angle, ANGLE, X, period=2 * np.pi) * scale, "N"),
            "load_y": si(np.interp(angle, ANGLE, Y, period=2 * np.pi) * scale, "N"),
        }
        expected = outputs(inputs(X, Y, **HALF))["minimum_film_thickness"]
        results = outputs(inputs(X, Y, **HALF) | curves)["minimum_film_thickness"]
        assert results == pytest.approx(expected, rel=5e-3)

    def test_property_groove_in_the_load_thins_the_film(self):
        films = [outputs(inputs(X, Y, **HALF | {"groove_start": start}))["minimum_film_thickness"]
                 for start in ("-90 deg", "90 deg")]  # fmt: skip
        plain = outputs(inputs(X, Y), "mobility")["minimum_film_thickness"]
        assert films[0] < 0.6 * plain
        assert films[0] < films[1] <= plain * 1.05

    def test_property_many_grooves_at_once(self):
        widths = np.array([2.0, 5.0, 10.0, 40.0])
        raw = inputs(X, Y, **HALF)
        many = outputs(raw | {"groove_width": si(widths, "mm")})
        for k, width in enumerate(widths):
            alone = outputs(raw | {"groove_width": si(width, "mm")})
            for name in FILM:
                assert many[name][k] == pytest.approx(alone[name], rel=1e-9), name


class TestLevels:
    def test_property_groove_takes_its_level(self):
        assert evaluate(OilFilmCycle, inputs(X, Y, **GROOVE)).level == "mobility_grooved"
        assert evaluate(OilFilmCycle, inputs(X, Y)).level == "mobility"
        assert evaluate(OilFilmCycle, inputs(X, Y, **PIN)).level == "mobility"

    @pytest.mark.parametrize("level", ["mobility_short", "mobility"])
    def test_property_level_that_knows_no_groove_says_so(self, level):
        result = evaluate(OilFilmCycle, inputs(X, Y, **GROOVE), level=level)
        assert ("unused_input", "groove_width") in [(w.code, w.name) for w in result.warnings]

    def test_property_kind_of_supply_is_named(self):
        slot = {"sleeve_hole_length": "20 mm", "sleeve_hole_arc": "8 mm", "supply_pressure": "3 bar"}
        kinds = {
            "none": {}, "full_groove": GROOVE, "half_groove": HALF, "pin_hole": PIN, "sleeve_hole": slot,
            "several": HALF | PIN, "partial_groove": HALF | {"groove_extent": "60 deg"},
        }  # fmt: skip
        for kind, feed in kinds.items():
            assert outputs(inputs(X, Y, **feed), outputs=["supply"])["supply"] == kind

    def test_property_hole_that_stays_under_the_load_warns(self):
        """A load that turns with the pin presses on its hole all the time."""
        turning = inputs(2 * np.cos(ANGLE), 2 * np.sin(ANGLE), **PIN)
        for angle, share in (("0 deg", 1.0), ("180 deg", 0.0)):
            result = evaluate(OilFilmCycle, turning | {"pin_hole_angle": angle})
            assert result.outputs["feed_under_load"].value == pytest.approx(share)
            assert ("feed_under_load" in {w.code for w in result.warnings}) == (share > 0.6)

    def test_property_no_error_is_stated_without_a_supply(self):
        result = evaluate(OilFilmCycle, inputs(X, Y), outputs=["minimum_film_thickness", "width_ratio"])
        assert np.isnan(result.error["minimum_film_thickness"])
        assert result.error["width_ratio"] == 0


class TestRefusals:
    @pytest.mark.parametrize(
        ("changes", "name", "words"),
        [
            ({"groove_width": "10 mm"}, "supply_pressure", "the pressure above ambient, such as 4 bar"),
            ({"pin_hole_length": "4 mm"}, "supply_pressure", "if there is a groove or hole"),
            ({**GROOVE, "supply_pressure": "0 bar"}, "supply_pressure", "it must be > 0 bar"),
            ({**GROOVE, "groove_width": "49 mm"}, "groove_width", "at most 95 % of that of the bearing"),
            ({**GROOVE, "groove_width": "0 mm"}, "groove_width", "it must be > 0 mm"),
            ({**GROOVE, "groove_extent": "400 deg"}, "groove_extent", "≤ 360 deg"),
            ({**GROOVE, "groove_extent": "0 deg"}, "groove_extent", "> 0 deg"),
            ({**PIN, "pin_hole_length": "60 mm"}, "pin_hole_length", "at most 95 % of the bearing's width"),
            ({**PIN, "pin_hole_arc": "400 mm"}, "pin_hole_arc", "extends at most once around"),
            ({**PIN, "pin_hole_angle": "700 deg"}, "pin_hole_angle", "≤ 360 deg"),
            ({"load_sense": "outwards"}, "load_sense", "journal_on_sleeve, sleeve_on_journal"),
            ({**HALF, "sleeve_speed": si(0.3 * OMEGA, "rad/s")}, "sleeve_speed", "back at its position"),
            ({**PIN, "crank_speed": si(0.7 * OMEGA, "rad/s")}, "crank_speed", "back at its position"),
        ],
    )
    def test_property_wrong_supplies_name_input_unit_and_what_is_right(self, changes, name, words):
        assert words in refusal(inputs(X, Y, **changes))[name]

    def test_property_full_groove_may_turn(self):
        turning = inputs(X, Y, **GROOVE, sleeve_speed=si(0.3 * OMEGA, "rad/s"))
        assert outputs(turning)["minimum_film_thickness"] > 0

    def test_property_level_supplied_needs_a_supply(self):
        detail = refusal(inputs(X, Y), "supplied")["inlets"]
        assert "give `groove_width`, `sleeve_hole_length` or `pin_hole_length`" in detail
        assert "`supply_pressure` in bar" in detail

    def test_property_lands_within_the_map(self):
        narrow = inputs(X, Y, 0.05, groove_width="2 mm", supply_pressure="3 bar")
        assert "narrower `groove_width`" in refusal(narrow)["land_ratio"]

    @pytest.mark.slow
    def test_analytic_level_supplied_marches_each_point_as_it_would_alone(self):
        sizes = np.array([1.0, 2.0])
        many = outputs(inputs(sizes[:, None] * X, sizes[:, None] * Y, **GROOVE), "supplied")
        for k, size in enumerate(sizes):
            one = outputs(inputs(size * X, size * Y, **GROOVE), "supplied")
            for name in ("minimum_film_thickness", "maximum_pressure", "power_loss", "side_flow"):
                assert many[name][k] == pytest.approx(one[name], rel=1e-9), name
        assert many["verdict"] == "repeating"

    @pytest.mark.parametrize("degrees", [np.arange(0, 270, 5.0), np.arange(360, 0, -5.0), np.zeros(COUNT)])
    def test_property_angles_that_are_no_cycle(self, degrees):
        curves = {name: si(np.ones(degrees.size), "N") for name in ("load_x", "load_y")}
        raw = {**inputs(1.0, 0.0, **HALF), **curves, "crank_angle": si(degrees, "deg")}
        assert "cover one cycle of 360° or 720°" in refusal(raw)["crank_angle"]

    @pytest.mark.slow
    def test_analytic_holes_of_two_sizes_are_two_points_though_nothing_else_is(self):
        def of_holes(length):
            return outputs(inputs(X, Y, **PIN | {"pin_hole_length": si(length, "mm")}), "supplied")

        many, alone = of_holes([5.0, 6.0]), [of_holes(5.0), of_holes(6.0)]
        for name in ("minimum_film_thickness", "side_flow", "numerical_error"):
            assert many[name].tolist() == [float(one[name]) for one in alone], name


class TestRandom:
    """Whatever is given: every value is finite, or has a reason."""

    @pytest.mark.parametrize("level", ["mobility_short", "mobility", "mobility_grooved"])
    def test_property_no_nan_without_a_reason(self, level):
        check_random(level, seed=17, count=40)

    @pytest.mark.slow
    @pytest.mark.parametrize("level", ["mobility_short", "mobility", "mobility_grooved"])
    def test_property_no_nan_without_a_reason_of_many(self, level):
        check_random(level, seed=18, count=2000)


def check_random(level, seed, count):
    rng = np.random.default_rng(seed)
    order = np.arange(6)[:, None, None]
    size = rng.normal(size=(6, count, 4)) / (1 + order)
    waves = np.stack([np.cos(order * ANGLE), np.sin(order * ANGLE)])
    x, y = np.einsum("ocf,foan->fcn", size[..., :2], waves) * 10 ** rng.uniform(-2, 3, (count, 1))
    raw = inputs(x, y) | {
        "bearing_width": si(D * 10 ** rng.uniform(-1.3, 0.3, count), "m"),
        "diametral_clearance": si(D * 10 ** rng.uniform(-4, -2, count), "m"),
        "groove_width": si(1e-3 * 10 ** rng.uniform(-2, 1.5, count), "m"),
        "groove_start": si(rng.uniform(-180, 180, count), "deg"),
        "groove_extent": si(rng.uniform(1, 360, count), "deg"),
        "supply_pressure": "3 bar",
    }
    answers = evaluate(OilFilmCycle, raw, level=level).outputs
    for name, answer in answers.items():
        if answer.unit is None or answer.reason:
            continue
        values = np.asarray(answer.value)
        holes = np.isnan(values) if values.ndim < 2 else np.isnan(values).any(axis=-1)
        assert np.isfinite(values).all() == ~holes.any(), name
        if holes.any():
            assert all(reason for reason in np.asarray(answer.reasons)[holes]), name
    film = np.asarray(answers["minimum_film_thickness"].value)
    assert np.isfinite(film).mean() > 0.5
