"""`oil_film_cycle`: load supported by a groove's pressure, holes under the load, warnings.

Analytic: the pressure integrated by hand, a load that is less by as much. Property: errors that are stated
for grooves.
"""

from bisect import bisect_left
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from benchmarks.film_cycle_duties import CHEAP, OUTPUTS
from benchmarks.film_cycle_ensemble import BOUNDED
from benchmarks.supplied_duties import random_duty
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.core.language.levels import accuracy
from templates.oil_film.oil_film_cycle_v1 import OilFilmCycle
from templates.physics.orbits.grooved_mobility import Groove, lift_of, lifting
from templates.physics.orbits.rotation import PartRotation
from templates.physics.supplied.fed_cycle import fed_orbit
from templates.physics.supplied.supplied_orbit import NEAR_HOLES, supplied_orbit

D, PSI, ETA, OMEGA, RATIO = 0.1, 1e-3, 0.02, 300.0, 0.5
COUNT = 72
ANGLE = np.arange(COUNT) * 2 * np.pi / COUNT
SCALE = ETA * OMEGA * D * D * RATIO / PSI**2
X, Y = 2 + 3 * np.exp(6 * (np.cos(ANGLE - 0.4) - 1)) + 0.5 * np.cos(2 * ANGLE), np.sin(ANGLE)
PRESSURE = 3e5
P_S = PRESSURE * PSI**2 / (ETA * OMEGA)
FULL = {"groove_width": "10 mm", "supply_pressure": "3 bar"}
HALF = {**FULL, "groove_start": "-90 deg", "groove_extent": "180 deg"}
PIN = {"pin_hole_length": "5 mm", "supply_pressure": "3 bar"}
HOLE = {"sleeve_hole_length": "8 mm", "sleeve_hole_arc": "10 mm", "supply_pressure": "3 bar"}
FILM = ("minimum_film_thickness", "film_thickness", "maximum_pressure", "power_loss", "side_flow")


FEEDS = {"groove_width", "sleeve_hole_length", "pin_hole_length"}


def si(value, unit):
    return {"value": np.asarray(value, dtype=float).tolist(), "unit": unit}


def inputs(x, y, **changes):
    x, y = (np.broadcast_to(np.asarray(v, dtype=float), (COUNT,)) for v in (x, y))
    return {
        "crank_angle": si(np.degrees(ANGLE), "deg"),
        "load_x": si(x * SCALE, "N"),
        "load_y": si(y * SCALE, "N"),
        "speed": si(OMEGA, "rad/s"),
        "bearing_diameter": si(D, "m"),
        "bearing_width": si(D * RATIO, "m"),
        "diametral_clearance": si(D * PSI, "m"),
        "dynamic_viscosity": si(ETA, "Pa*s"),
        **({} if FEEDS & changes.keys() else {"oil_supply": "flooded_ends"}),
        **changes,
    }


def outputs(raw, level=None):
    return {name: answer.value for name, answer in evaluate(OilFilmCycle, raw, level=level).outputs.items()}


def unused(raw, level=None):
    warnings = evaluate(OilFilmCycle, raw, level=level).warnings
    return {warning.name for warning in warnings if warning.code == "unused_input"}


class TestLift:
    @pytest.mark.parametrize("extent", [0.3, np.pi / 2, np.pi, 4.0, 2 * np.pi])
    def test_analytic_lift_is_the_pressure_over_groove_and_lands(self, extent):
        """p falls evenly over the lands: its mean over the width is p (1 + g)/2, at every angle."""
        share, pressure = 0.2, 0.5
        across = 2 * quad(lambda z: min(1.0, (1 - z) / (1 - share)), 0, 1, points=[share])[0] / 2
        along = quad(lambda angle: np.cos(angle) / 2, -extent / 2, extent / 2)[0]
        lift = lift_of(np.array(share), np.array(extent), np.array(pressure))
        assert float(lift) == pytest.approx(pressure * across * along, abs=1e-9)

    def test_analytic_no_groove_lifts_nothing(self):
        assert float(lift_of(np.array(0.0), np.array(np.pi), np.array(np.nan))) == 0

    def test_analytic_force_comes_out_of_the_groove_and_turns_with_the_sleeve(self):
        angle = np.array([0.0, np.pi / 2, np.pi])
        sleeve = PartRotation(np.array([1.0]), 2 * np.pi, np.zeros((1, 3)))
        groove = Groove(np.array([0.2]), np.array([-np.pi / 2]), np.array([np.pi]))
        force = lifting(np.array([2.0]), sleeve, groove, angle)
        assert force[:, 0] == pytest.approx(np.array([[2, 0, -2], [0, 2, 0]]), abs=1e-12)

    def test_analytic_groove_under_a_load_bears_a_part_of_it(self):
        """The same film as under a load that is less by the lift, none of it taken off again."""
        lift = float(lift_of(np.array(0.2), np.array(np.pi), np.array(P_S)))
        assert lift > 0.02
        found = outputs(inputs(X, Y, **HALF))
        fed = OilFilmCycle.from_quantities(inputs(X - lift, Y, **HALF)).at("mobility_grooved").fed
        orbit = fed_orbit("mobility_grooved", replace(fed, pressure=np.float64(0.0)))
        clearance = D * PSI / 2 * 1e6
        assert found["film_thickness"] == pytest.approx(clearance * orbit.gap, rel=1e-9)
        assert found["minimum_film_thickness"] == pytest.approx(clearance * (1 - orbit.eps_max), rel=1e-9)

    def test_analytic_groove_all_around_bears_nothing(self):
        lift = lift_of(np.array(0.2), np.array(2 * np.pi), np.array(P_S))
        assert lift == pytest.approx(0, abs=1e-15)

    def test_property_more_pressure_under_a_constant_load_means_more_film(self):
        films = [
            outputs(inputs(3.0, 0.0, **HALF | {"supply_pressure": f"{bar} bar"}))["minimum_film_thickness"]
            for bar in (1, 5, 20)
        ]
        assert films[0] < films[1] < films[2]

    def test_property_many_points_at_once(self):
        raw = inputs(X, Y, **HALF)
        pressures = [1.0, 4.0, 9.0]
        many = outputs(raw | {"supply_pressure": si(pressures, "bar")})
        for k, bar in enumerate(pressures):
            alone = outputs(raw | {"supply_pressure": f"{bar} bar"})
            for name in FILM:
                assert many[name][k] == pytest.approx(alone[name], rel=1e-9), name


def test_second_method_power_loss_as_the_report_writes_it():
    """Shear of a full film, and the load's work on the centre seen from axes that turn at half the speed."""
    angle = np.arange(360) * 2 * np.pi / 360
    x, y = 2 + 3 * np.exp(6 * (np.cos(angle - 0.4) - 1)) + 0.5 * np.cos(2 * angle), np.sin(angle)
    curves = {"load_x": si(x * SCALE, "N"), "load_y": si(y * SCALE, "N")}
    film = outputs(
        inputs(0.0, 0.0) | curves | {"crank_angle": si(np.degrees(angle), "deg")}, level="mobility"
    )
    eps = np.asarray(film["eccentricity_x"]) + 1j * np.asarray(film["eccentricity_y"])
    slope = (np.roll(eps, -1) - np.roll(eps, 1)) / (2 * angle[1])
    v = PSI * D / 2 * OMEGA * (slope - 0.5j * eps)
    shear = np.pi * ETA * RATIO * D * D**3 * OMEGA**2 / (2 * PSI * D * np.sqrt(1 - np.abs(eps) ** 2))
    work = ((x + 1j * y) * SCALE * v.conj()).real
    assert abs(work.mean()) > 0.05 * shear.mean()
    assert film["power_loss"] == pytest.approx((shear + work).mean(), rel=1e-3)


class TestRefusals:
    @pytest.mark.parametrize(
        ("changes", "name", "words"),
        [
            ({"sleeve_speed": si(0.3 * OMEGA, "rad/s")}, "sleeve_speed", "`groove_extent` of 360 deg"),
            ({**PIN, "crank_speed": si(0.7 * OMEGA, "rad/s")}, "crank_speed", "speeds in rpm"),
            ({"bearing_diameter": "0.05 mm"}, "diametral_clearance", "journal diameter, in mm"),
            (
                {"load_x": si(np.zeros(COUNT), "N"), "load_y": si(np.zeros(COUNT), "N")},
                "load_number",
                "in kN",
            ),
        ],
    )
    def test_property_refusals_name_input_unit_and_what_is_right(self, changes, name, words):
        with pytest.raises(InvalidInputs) as refused:
            evaluate(OilFilmCycle, inputs(X, Y, **HALF) | changes)
        details = {name: fault.detail for fault in refused.value.faults for name in fault.names}
        assert words in details[name]

    def test_property_load_that_no_film_bears_is_refused_with_what_to_change(self):
        turning = inputs(4 * np.cos(ANGLE), 4 * np.sin(ANGLE), crank_speed=si(OMEGA / 2, "rad/s"))
        with pytest.raises(InvalidInputs, match="mean speed of journal and sleeve"):
            evaluate(OilFilmCycle, turning)


class TestWarnings:
    def test_property_inputs_that_a_level_does_not_read_are_named(self):
        assert unused(inputs(X, Y, **HALF)) == set()
        assert unused(inputs(X, Y, **HALF), "mobility") == {"groove_width"}
        assert unused(inputs(X, Y, **PIN)) == {"pin_hole_length", "supply_pressure"}
        assert unused(inputs(X, Y, **PIN | HALF)) == {"pin_hole_length"}
        assert unused(inputs(X, Y)) == set()

    @pytest.mark.slow
    def test_property_level_flooded_reads_no_supply(self):
        feed = HALF | PIN | {name: value for name, value in HOLE.items() if name.startswith("sleeve")}
        warned = unused(inputs(3.0, 0.0, **feed), "flooded")
        assert warned == {"groove_width", "pin_hole_length", "sleeve_hole_length", "supply_pressure"}


def stated(raw, level=None, names=OUTPUTS):
    """The errors stated for outputs."""
    result = evaluate(OilFilmCycle, raw, level=level)
    return {name: result.error[name] for name in names}


def law(case, level, output, attributes):
    """The bound of the accuracy file, by hand."""
    content = accuracy(OilFilmCycle).content
    bound = content["cases"][case][level][output]
    for axis in content["axes"]:
        bound = bound[bisect_left(axis["values"][1:-1], attributes[axis["attribute"]])]
    if bound is None:
        return np.nan
    for name, exponent in content["powers"][case][level][output].items():
        low, high = content["within"][case][name]
        assert low <= attributes[name] <= high, name
        bound *= attributes[name] ** exponent
    return bound


def attributes(times, ratio, x=X, y=Y):
    """Attributes of a duty under a load times a factor, at a pressure of 3 bar."""
    size, along = np.hypot(x, y), np.unwrap(np.arctan2(np.append(y, y[0]), np.append(x, x[0])))
    mean, rate = size.mean(), np.diff(along) / ANGLE[1]
    return {
        "S_max": times * size.max(), "b": ratio, "wide": max(ratio / 0.5, 1.0), "peak": size.max() / mean,
        "turns": 1.05 - np.hypot(x.mean(), y.mean()) / mean,
        "whirls": 0.05 + np.mean((rate > 0.2) & (rate < 0.8)), "P_s": P_S,
    }  # fmt: skip


class TestStatedErrors:
    """Bounds of the model's error, by supply and motion of the sleeve, as powers of the duty."""

    @pytest.mark.parametrize("level", CHEAP)
    @pytest.mark.parametrize("times", [1.0, 5.0])
    @pytest.mark.parametrize("ratio", [0.3, 0.7])
    @pytest.mark.parametrize(("kind", "groove"), [("full_groove", FULL), ("half_groove", HALF)])
    def test_example_the_duty_of_a_groove_has_its_own(self, level, times, ratio, kind, groove):
        raw = inputs(times * X, times * Y, **groove) | {"bearing_width": si(D * ratio, "m")}
        for axis in ("load_x", "load_y"):
            raw[axis] = si(np.asarray(raw[axis]["value"]) * ratio / RATIO, "N")
        found = stated(raw, level)
        for name in OUTPUTS:
            if name in BOUNDED:
                expected = law(f"{kind}, fixed", level, name, attributes(times, ratio))
                assert found[name] == pytest.approx(expected, rel=1e-9, nan_ok=True), name
            else:
                assert np.isnan(found[name]), name

    @pytest.mark.parametrize("level", CHEAP[:2])
    def test_example_hole_that_is_seldom_under_the_load_has_its_own(self, level):
        raw = inputs(X, Y, **HOLE, sleeve_hole_angle="180 deg")
        assert outputs(raw, level=level)["feed_under_load"] <= 0.1
        bound = law("sleeve_hole, fixed", level, "minimum_film_thickness", attributes(1.0, RATIO))
        assert stated(raw, level)["minimum_film_thickness"] == pytest.approx(bound, rel=1e-9)

    def test_example_a_rod_that_swings_is_a_case_of_its_own(self):
        swing, x, y = -0.25 * OMEGA * np.cos(ANGLE), X + 3 * np.cos(ANGLE) - 1, Y + 3 * np.sin(ANGLE)
        raw = inputs(x, y, **HALF, sleeve_speed=si(swing, "rad/s"))
        case = "half_groove, swinging", "mobility_grooved", "power_loss"
        bound = law(*case, attributes(1.0, RATIO, x, y))
        assert stated(raw)["power_loss"] == pytest.approx(bound, rel=1e-9)

    @pytest.mark.parametrize(
        "motion",
        [
            {"sleeve_speed": si(0.3 * OMEGA, "rad/s")},
            {"frame_speed": si(OMEGA, "rad/s")},
            {"crank_speed": si(0.7 * OMEGA, "rad/s")},
        ],
    )
    def test_property_none_where_parts_or_axes_turn_otherwise(self, motion):
        assert np.isnan(list(stated(inputs(X, Y, **FULL) | motion).values())).all()

    @pytest.mark.parametrize(
        "raw",
        [
            inputs(0.02 * X, 0.02 * Y, **FULL),
            inputs(25 * X, 25 * Y, **FULL),
            inputs(X, Y, **FULL) | {"bearing_width": si(1.3 * D, "m")},
            inputs(X, Y, **FULL) | {"bearing_width": si(0.14 * D, "m")},
            inputs(X, Y, **FULL | PIN),
            inputs(X, Y, **HALF) | {"groove_extent": "100 deg"},
            inputs(X, Y, **HALF) | {"groove_extent": "300 deg"},
            inputs(X, Y, **PIN, pin_hole_angle="180 deg"),
            inputs(X, Y, **HOLE, sleeve_hole_angle="0 deg"),
            inputs(X, Y),
            inputs(X, Y, **FULL | {"supply_pressure": f"{4.0 / P_S * 3} bar"}),
        ],
    )
    def test_property_none_outside_the_bands_and_for_other_supplies(self, raw):
        assert np.isnan(list(stated(raw).values())).all()

    @pytest.mark.slow
    def test_property_level_supplied_states_the_error_of_each_answer(self):
        names = ("minimum_film_thickness", "maximum_eccentricity", "power_loss", "side_flow")
        raw = inputs(X, Y, **FULL)
        found, errors = outputs(raw, "supplied"), stated(raw, "supplied", names)
        assert errors["minimum_film_thickness"] == found["numerical_error"] > 5e-3
        gap = found["minimum_film_thickness"] / (D * PSI / 2 * 1e6)
        assert errors["maximum_eccentricity"] == pytest.approx(found["numerical_error"] * gap / (1 - gap))
        assert all(0 < errors[name] < 0.06 for name in names), errors

    @pytest.mark.parametrize("groove", [FULL, HALF])
    def test_property_pressures_have_none(self, groove):
        assert np.isnan(
            list(stated(inputs(X, Y, **groove), None, ("maximum_pressure", "peak_pressure")).values())
        ).all()

    def test_property_points_in_and_outside_the_bands_at_once(self):
        sizes = np.array([0.02, 1.0, 5.0, 25.0])[:, None]
        raw = inputs(X, Y, **FULL)
        for axis, load in (("load_x", X), ("load_y", Y)):
            raw[axis] = si(sizes * load * SCALE, "N")
        film = np.broadcast_to(stated(raw)["minimum_film_thickness"], (4,))
        case = "full_groove, fixed", "mobility_grooved", "minimum_film_thickness"
        assert np.isnan(film[[0, 3]]).all()
        bounds = [law(*case, attributes(times, RATIO)) for times in (1.0, 5.0)]
        assert film[1:3] == pytest.approx(bounds, rel=1e-9)


class TestSupplied:
    """Meshes near holes."""

    @pytest.mark.slow
    def test_convergence_hole_under_the_load_goes_on_to_finer_meshes(self):
        """A main bearing whose hole is under the load for 69 % of the cycle, against the mesh FINEST.

        That of `benchmarks.supplied_orbits near`: its smallest gap is 0.037242.
        """
        duty = random_duty(17, 50)
        orbit = supplied_orbit(duty.load, duty.sliding, duty.ratio, duty.supply, near_holes=NEAR_HOLES)
        assert orbit.under_load == pytest.approx(0.69, abs=0.01)
        assert len(orbit.cycles) == 4
        missed = orbit.least_gap / 0.037242 - 1
        assert abs(missed) < 0.005
        assert abs(missed) < orbit.error.gap < 0.06
