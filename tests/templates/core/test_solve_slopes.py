"""The slope at each solution of `solve`: closed forms, bounds of the interval, kinks, inflections, levels."""

import numpy as np
import pytest

from templates.core.language.evaluate import evaluate
from templates.core.language.solve import solve
from templates.core.language.template import Template, formula, given
from templates.oil_film.oil_film_v1 import OilFilm as Paper
from templates.oil_film.oil_film_v2 import OilFilm


class Curves(Template):
    """Curves with known slopes, in units other than SI."""

    example = {"x": "1 mm", "a": "1 mm", "warmth": "350 K"}

    x = given("mm", "x")
    a = given("mm", "a")
    warmth = given("degC", "warmth", default="20 degC")

    @formula("1", "cubic")
    def cubic(self):
        return (self.x - self.a) * (self.x - 2 * self.a) * (self.x + self.a) / self.a**3

    @formula("kN/m**2", "inverse")
    def inverse(self):
        return self.a**3 / self.x**3

    @formula("1", "inflection")
    def inflection(self):
        return ((self.x - self.a) / self.a) ** 3

    @formula("1", "bent")
    def bent(self):
        return np.where(self.x < self.a, self.x, 3 * self.x - 2 * self.a) / self.a

    @formula("1", "heated")
    def heated(self):
        return np.exp((self.warmth - 300) / 10)


def solved(output, target, low, high, unknown="x", **raw):
    return solve(Curves, {"a": "2 mm", **raw}, unknown, [low, high], {output: target}, outputs=[output])


def slopes(result):
    return [root.slope for root in result.roots]


def test_analytic_slopes_of_a_cubic():
    """At the zeros a, 2a, -a of (x - a)(x - 2a)(x + a)/a^3 the slope is -2/a, 3/a, 6/a."""
    result = solved("cubic", 0, "-20 mm", "20 mm")
    assert [root.crossing for root in result.roots] == ["rises", "falls", "rises"]
    assert slopes(result) == pytest.approx([6 / 2e-3, -2 / 2e-3, 3 / 2e-3], rel=1e-6)


@pytest.mark.parametrize("x", [0.002, 0.05, 1.0, 30.0])
def test_analytic_slope_of_a_power_over_five_decades(x):
    """a^3 x^-3 has the slope -3 a^3 x^-4."""
    result = solved("inverse", {"value": (2 / x) ** 3 / 1000, "unit": "kN/m**2"}, "0.001 mm", "100 mm")
    assert slopes(result) == pytest.approx([-3 * 2e-3**3 / (x * 1e-3) ** 4], rel=1e-4)


@pytest.mark.parametrize(("low", "high"), [("2 mm", "50 mm"), ("0.5 mm", "2 mm")])
def test_analytic_slope_at_a_bound_of_the_interval(low, high):
    result = solved("inverse", "0.001 kN/m**2", low, high)
    assert slopes(result) == pytest.approx([-3 / 2e-3], rel=1e-4)


def test_analytic_slope_over_a_temperature():
    """exp((T - 300 K)/(10 K)) has the slope of its value by 10 K."""
    result = solved("heated", float(np.exp(2.0)), "40 degC", "60 degC", "warmth", x="1 mm")
    assert slopes(result) == pytest.approx([np.exp(2.0) / 10], rel=1e-4)


def test_analytic_close_roots():
    """Two roots 1e-4 a apart, where the slope changes its sign between them."""
    top = 1e-8
    result = solved("cubic", _peak() - top, "-2 mm", "4 mm")
    exact = [_cubic_slope(root.value * 1e-3) for root in result.roots]
    assert len(exact) == 2
    assert slopes(result) == pytest.approx(exact, rel=1e-4)


def _peak():
    u = (2 - np.sqrt(7)) / 3
    return (u - 1) * (u - 2) * (u + 1)


def _cubic_slope(x):
    u = x / 2e-3
    return (3 * u**2 - 4 * u - 1) / 2e-3


@pytest.mark.parametrize(
    ("output", "target", "reason"),
    [
        ("inflection", 0, "the output is flat here"),
        ("bent", 1, "the output has a kink here: its slopes below and above differ"),
    ],
)
def test_analytic_without_a_slope(output, target, reason):
    """(x - a)^3 is flat at a; the other curve has the slopes 1/a and 3/a there."""
    (root,) = solved(output, target, "-1 mm", "5.1 mm").roots
    assert (root.crossing, root.slope, root.no_slope) == ("rises", None, reason)


@pytest.mark.parametrize("cls", [Paper, OilFilm])
def test_a_slope_is_that_of_a_fit_through_the_neighbourhood(cls):
    """A second method: the derivative of a cubic through 41 points within 1 % of each solution."""
    name, unknown = "minimum_film_thickness", "diametral_clearance"
    raw = {key: value for key, value in cls.example.items() if key != unknown}
    result = solve(cls, raw, unknown, ["2 um", "0.5 mm"], {name: "2 um"}, outputs=[name])
    assert len(result.roots) == 2
    for root in result.roots:
        near = root.value * np.linspace(0.99, 1.01, 41)
        swept = evaluate(cls, {**raw, unknown: {"value": near.tolist(), "unit": "mm"}}, outputs=[name])
        fit = np.polynomial.Polynomial.fit(near, swept.outputs[name].value, 3)
        assert root.slope == pytest.approx(fit.deriv()(root.value) * 1e-3, rel=2e-3)
