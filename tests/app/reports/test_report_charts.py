"""Charts of a report: ticks, gaps, equal scales, texts of users escaped; equal charts give equal bytes."""

import re
from xml.etree import ElementTree

import pytest

from app.reports.charts import Chart, Series, svg


def elements(chart, tag):
    root = ElementTree.fromstring(svg(chart))
    return [one for one in root.iter() if one.tag.endswith(f"}}{tag}")]


def lines(chart):
    return [one.get("d") for one in elements(chart, "path") if one.get("stroke-width") == "1.6"]


def test_a_gap_interrupts_a_line():
    (path,) = lines(Chart("x", "y", [Series("a", [0, 1, 2, 3], [0, None, 2, 3])]))
    assert path.count("M") == 2


def test_ticks_are_round_and_texts_are_escaped():
    texts = [one.text for one in elements(Chart("a < b", "y & z", [Series("", [0, 720], [-3, 12])]), "text")]
    assert {"a < b", "y & z", "0", "200", "5", "10"} <= set(texts)


def test_a_circle_is_round_on_equal_scales():
    chart = Chart("x", "y", [Series("", [-1, 0, 1, 0], [0, 5, 0, -5])], square=True)
    points = [tuple(map(float, pair)) for pair in re.findall(r"([\d.]+),([\d.]+)", lines(chart)[0])]
    across, upright = points[2][0] - points[0][0], points[3][1] - points[1][1]
    assert upright / across == pytest.approx(5, rel=0.01)


def test_a_logarithmic_axis_leaves_out_what_is_not_positive():
    chart = Chart("x", "y", [Series("a", [0.1, 1, 10], [1e-3, 0, 1e-1], marked=True)], logarithmic=True)
    assert len(elements(chart, "circle")) == 2


@pytest.mark.parametrize("values", [[], [None], [float("nan")]])
def test_nothing_is_drawn_of_nothing(values):
    assert svg(Chart("x", "y", [Series("a", values, values)])) == ""


def test_a_level_line_and_many_points_are_drawn():
    chart = Chart("x", "y", [Series("a", list(range(10_000)), [2.0] * 10_000)])
    assert svg(chart) == svg(chart)
    assert len(lines(chart)[0]) < 40_000
