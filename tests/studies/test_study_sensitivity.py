"""Analytic: slopes, Morris effects and Sobol' indices agree with closed forms."""

import sys

import numpy as np
import pytest

from app.designs.slopes import Local
from app.studies.methods.sensitivity import (
    MorrisPoints,
    SobolPoints,
    effects,
    indices,
    slopes,
)
from app.studies.methods.space import Interval, Space
from templates.core.errors import InvalidInputs

PI = np.pi
ISHIGAMI = Space(tuple(Interval(name, -PI, PI) for name in ("x1", "x2", "x3")))


def ishigami(x, a=7.0, b=0.1):
    return np.sin(x[:, 0]) + a * np.sin(x[:, 1]) ** 2 + b * x[:, 2] ** 4 * np.sin(x[:, 0])


def ishigami_indices(a=7.0, b=0.1):
    """Ishigami and Homma 1990: variances of the parts, in closed form."""
    one = 0.5 * (1 + b * PI**4 / 5) ** 2
    two = a**2 / 8
    both = b**2 * PI**8 * (1 / 18 - 1 / 50)
    whole = one + two + both
    return np.array([one, two, 0]) / whole, np.array([one + both, two, both]) / whole


def test_ishigami_indices_are_within_a_hundredth():
    points = SobolPoints(ISHIGAMI, 8192, seed=0)
    result = indices(points, "y", ishigami(points.rows(0, points.count)))
    first, total = ishigami_indices()
    assert result.first == pytest.approx(first, abs=0.01)
    assert result.total == pytest.approx(total, abs=0.01)
    assert ((result.first_confidence > 0) & (result.first_confidence < 0.05)).all()
    assert ((result.total_confidence > 0) & (result.total_confidence < 0.05)).all()


def test_indices_repeat_with_their_seed():
    points = SobolPoints(ISHIGAMI, 256, seed=0)
    y = ishigami(points.rows(0, points.count))
    first, again = (indices(points, "y", y) for _ in range(2))
    assert first.total_confidence.tolist() == again.total_confidence.tolist()
    other = SobolPoints(ISHIGAMI, 256, seed=0).rows(100, 200)
    assert other.tobytes() == points.rows(0, points.count)[100:200].tobytes()


def test_morris_finds_the_effects_of_a_plane_and_an_interaction():
    space = Space((Interval("a", 0.0, 2.0), Interval("b", 10.0, 1000.0, "log"), Interval("c", 0.0, 1.0)))
    points = MorrisPoints(space, 200, seed=4)
    x = points.rows(0, points.count)
    result = effects(points, "y", 3 * x[:, 0] - np.log10(x[:, 1]) + 0 * x[:, 2])
    assert result.mean == pytest.approx([6.0, -2.0, 0.0], abs=1e-9)
    assert result.mean_absolute == pytest.approx([6.0, 2.0, 0.0], abs=1e-9)
    assert result.spread == pytest.approx([0, 0, 0], abs=1e-9)
    product = effects(points, "y", x[:, 0] * x[:, 2])
    assert product.spread[0] > 0.1
    assert product.confidence[0] > 0


def test_local_slopes_and_elasticities_of_a_power_law():
    at = np.array([2.0, 0.5, 0.0])
    points = Local(at, np.array([1e-4, 1e-4, 1e-4]))
    x = points.rows(0, points.count)
    assert points.count == len(x) == 7
    result = slopes(points, "y", x[:, 0] ** 3 / x[:, 1] + np.sin(x[:, 2]))
    assert result.value == pytest.approx(16)
    assert result.slopes == pytest.approx([24, -32, 1], rel=1e-6)
    assert result.elasticities == pytest.approx([3, -1, 0], rel=1e-6)


def test_the_elasticity_of_nothing_is_not_a_number():
    points = Local(np.array([1.0]), np.array([0.1]))
    result = slopes(points, "y", np.array([0.0, -1.0, 1.0]))
    assert result.slopes.tolist() == [10.0]
    assert np.isnan(result.elasticities).all()


@pytest.mark.parametrize("kind", ["sobol", "morris"])
def test_refused_rows_are_refused_with_their_share(kind):
    points = SobolPoints(ISHIGAMI, 64, 1) if kind == "sobol" else MorrisPoints(ISHIGAMI, 80, 1)
    y = ishigami(points.rows(0, points.count))
    y[:32] = np.nan
    with pytest.raises(
        InvalidInputs, match=r"32 of 320 rows \(10.0%\) have no value of film\.loss"
    ) as refused:
        (indices if kind == "sobol" else effects)(points, "film.loss", y)
    assert [(fault.name, fault.code) for fault in refused.value.faults] == [("film.loss", "refused_rows")]


def test_a_constant_output_has_no_indices():
    points = SobolPoints(ISHIGAMI, 64, 1)
    with pytest.raises(InvalidInputs, match="in all rows") as refused:
        indices(points, "y", np.full(points.count, 3.25))
    assert refused.value.faults[0].code == "constant"


def test_the_base_is_a_power_of_two():
    with pytest.raises(InvalidInputs, match="power of two"):
        SobolPoints(ISHIGAMI, 100, 1)


def test_without_the_extra_the_method_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "SALib.sample", None)
    monkeypatch.delitem(sys.modules, "SALib.sample.sobol", raising=False)
    with pytest.raises(InvalidInputs, match=r"crankwright\[study\]") as refused:
        SobolPoints(ISHIGAMI, 64, 1).rows(0, 1)
    assert refused.value.faults[0].code == "not_installed"
