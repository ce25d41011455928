"""Designs read turns, radians and hertz alike in relations, criteria, parameters and inputs."""

import math

import pytest
from serving import API, created, faults

from templates.core.units.units import unit

DESIGNS = f"{API}/designs"
N = 5000 * 2 * math.pi / 60
FILM = {
    "radial_load": "25 kN",
    "bearing_diameter": "48 mm",
    "bearing_width": "18 mm",
    "speed": "= n",
    "diametral_clearance": "0.05 mm",
    "supply_temperature": "80 degC",
}
PARAMETERS = {
    "n": "5000 rpm",
    "w": "100 rad/s",
    "f": "50 Hz",
    "d": "48 mm",
    "t": "0.1 s",
    "v": "10 m/s",
    "torque": "2 N*m",
}


@pytest.fixture(scope="module")
def design(http):
    step = {"template": "oil_film", "version": 2, "outputs": ["minimum_film_thickness"], "inputs": FILM}
    return created(http, {"name": "rates", "parameters": PARAMETERS, "steps": {"film": step}})


def previewed(http, design, **patch):
    return http.post(f"{DESIGNS}/{design['id']}/preview", params={"worksheet": True}, json=patch)


def details(answer):
    assert faults(answer)
    return {fault["name"]: fault["detail"] for fault in answer.json()["errors"]}


def speed(http, design, relation, **parameters):
    answer = previewed(http, design, steps={"film": {"inputs": {"speed": relation}}}, parameters=parameters)
    assert answer.status_code == 200, answer.text
    (used,) = (f for f in [answer.json()["steps"]["film"]["inputs"]["speed"]])
    return used


class TestRelations:
    @pytest.mark.parametrize(
        ("relation", "rpm"),
        [
            ("= n", 5000),
            ("= w", 954.9297),
            ("= 2*pi*f", 3000),
            ("= 1 turn / t", 600),
            ("= 1 rad / t", 95.49297),
            ("= v / d * 1 rad", 1989.437),
            ("= max(n, w)", 5000),
            ("= n / 2", 2500),
            ("= 50 turn/s", 3000),
        ],
    )
    def test_a_speed_that_a_relation_gives(self, http, design, relation, rpm):
        used = speed(http, design, relation)
        assert used["unit"] == "rpm"
        assert used["value"] == pytest.approx(rpm, rel=1e-6)

    @pytest.mark.parametrize(
        ("relation", "remedies"),
        [
            ("= f", ["2*pi*f"]),
            ("= v / d", ["(v / d) * 1 turn", "(v / d) * 1 rad"]),
            ("= 1 / t", ["1 turn / t", "1 rad / t"]),
            ("= n / (2*pi)", ["(n / (2*pi)) * 1 turn"]),
            ("= pi * f", ["2*pi * f"]),
        ],
    )
    def test_what_is_no_speed_is_refused_with_remedies(self, http, design, relation, remedies):
        answer = previewed(http, design, steps={"film": {"inputs": {"speed": relation}}})
        detail = details(answer)["film.speed"]
        for remedy in remedies:
            assert remedy in detail
            assert speed(http, design, f"= {remedy}")["value"] > 0

    @pytest.mark.parametrize("relation", ["= 2*pi*n", "= pi*n/30", "= 30*w/pi"])
    def test_factors_of_turns_are_refused(self, http, design, relation):
        answer = previewed(http, design, steps={"film": {"inputs": {"speed": relation}}})
        assert "omit" in details(answer)["film.speed"]

    @pytest.mark.parametrize("typed", ["5000 rpm", f"{5000 / 60!r} rev/s", f"{N!r} rad/s", "30000 deg/s"])
    def test_a_value_does_not_depend_on_how_a_speed_is_typed(self, http, design, typed):
        assert speed(http, design, "= n", n=typed)["value"] == pytest.approx(5000, rel=1e-12)


class TestBothReadings:
    CASES = (
        ("diametral_clearance", "= t * {n} * 1 um", 1),
        ("radial_load", "= 2*pi*torque*{n} / v", 1),
        ("bearing_width", "= 10 m/s / {n}", -1),
    )

    @pytest.mark.parametrize(("name", "relation", "power"), CASES)
    def test_an_input_without_an_angle(self, http, design, name, relation, power):
        answer = previewed(http, design, steps={"film": {"inputs": {name: relation.format(n="n")}}})
        detail = details(answer)[f"film.{name}"]
        assert "n is given in turns" in detail
        assert relation.removeprefix("= ").format(n="(n/(2*pi))") in detail
        assert "n/(1 rad)" in detail
        same = self.used(http, design, name, relation.format(n="n"), n=f"{N!r} rad/s")
        for remedy, factor in (("(n/(2*pi))", 1 / (2 * math.pi)), ("(n/(1 rad))", 1)):
            own = self.used(http, design, name, relation.format(n=remedy))
            assert own == pytest.approx(same * factor**power, rel=1e-9)

    def used(self, http, design, name, relation, **parameters):
        """The value [SI] of an input that a relation gives, even if the film cannot be calculated with it."""
        answer = previewed(http, design, parameters={**parameters, "own": relation})
        assert answer.status_code == 200, answer.text
        own = answer.json()["parameters"]["own"]
        return unit(own["unit"]).to_si(own["value"])

    def test_it_is_told_behind_a_parameter_too(self, http, design):
        steps = {"film": {"inputs": {"radial_load": "= force"}}}
        answer = previewed(http, design, steps=steps, parameters={"force": "= 2*pi*torque*n / v"})
        assert "n is given in turns" in details(answer)["film.radial_load"]
        answer = previewed(http, design, steps=steps, parameters={"force": "= torque*w / v"})
        assert answer.status_code == 200, answer.text

    @pytest.mark.parametrize(
        "require",
        [
            "pi * d * n <= 60 m/s",
            "60 m/s >= pi * d * film.speed",
            "2*pi*torque*n <= 9 kW",
            "n <= 100 1/s",
            "film.speed <= 100 1/s",
            "n <= 100 Hz",
            "w >= f",
        ],
    )
    def test_a_criterion_is_refused(self, http, design, require):
        answer = previewed(http, design, criteria={"own": {"require": require}})
        assert any(word in details(answer)["criteria.own"] for word in ("in turns", "turn/s", "2*pi"))

    @pytest.mark.parametrize(
        ("require", "verdict"),
        [
            ("pi * d * (n/(2*pi)) <= 12.6 m/s", "met"),
            ("d / 2 * (n/(1 rad)) <= 12.5 m/s", "not_met"),
            ("n <= 100 turn/s", "met"),
            ("n <= 500 rad/s", "not_met"),
            ("w <= 99 1/s", "not_met"),
            ("2*pi*f <= 315 rad/s", "met"),
            ("w/(2*pi) <= 16 Hz", "met"),
            ("v / d <= 209 rad/s", "met"),
            ("n / w <= 5", "not_met"),
        ],
    )
    def test_a_criterion_that_says_what_it_means(self, http, design, require, verdict):
        answer = previewed(http, design, criteria={"own": {"require": require}})
        assert answer.status_code == 200, answer.text
        (own,) = (one for one in answer.json()["criteria"] if one["name"] == "own")
        assert own["verdict"] == verdict


class TestParameters:
    @pytest.mark.parametrize(
        ("relation", "value", "unit"),
        [
            ("= w / (2*pi)", 15.91549, "1/s"),
            ("= 2 * f", 100, "Hz"),
            ("= f * t", 5, "1"),
            ("= n", N, "rad/s"),
            ("= v / d", 208.3333, "1/s"),
            ("= w + v / d", 308.3333, "rad/s"),
            ("= f + 1 / t", 60, "Hz"),
        ],
    )
    def test_a_rate_keeps_what_it_counts(self, http, design, relation, value, unit):
        answer = previewed(http, design, parameters={"own": relation})
        assert answer.status_code == 200, answer.text
        assert answer.json()["parameters"]["own"] == {"value": pytest.approx(value, rel=1e-6), "unit": unit}

    @pytest.mark.parametrize(
        "relation", ["= w + f", "= max(n, f)", "= n + 1 / t", "= if n > f then 1 else 2"]
    )
    def test_rates_that_count_differently_do_not_meet(self, http, design, relation):
        assert "own" in faults(previewed(http, design, parameters={"own": relation}))
