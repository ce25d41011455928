"""The throw star: pins at equal angles, their positions, and its use by both calculations."""

from types import SimpleNamespace
from xml.etree import ElementTree

import pytest

from app.calculations.schemas.evaluations import Output
from app.reports.crank_star import RAY, crank_star, rays
from app.reports.pictures import MOST_PINS, pictures
from app.reports.plots import drawn

V8 = [45.0, 45.0, 135.0, 135.0, 315.0, 315.0, -135.0, 225.0]
DECLARED = SimpleNamespace(
    inputs={"properties": {}},
    outputs={"properties": {"crankpin_angles": {"title": "crankpin angles", "unit": "deg"}}},
)


def step(angles):
    outputs = {"crankpin_angles": Output(value=angles, unit="deg")}
    return SimpleNamespace(inputs={}, outputs=outputs)


def found(angles, tag):
    root = ElementTree.fromstring(crank_star(angles))
    return [one for one in root.iter() if one.tag.endswith(f"}}{tag}")]


def test_pins_at_one_angle_are_one_ray():
    assert rays([0, 180, 540, 360.0]) == [(0, [1, 4]), (180, [2, 3])]
    assert [cylinders for _, cylinders in rays(V8)] == [[1, 2], [3, 4], [5, 6], [7, 8]]
    assert rays([359.99, 0.0])[0][1] == [1, 2]


def test_x_is_up_and_y_left_as_the_engine_counts():
    first, second = ((float(one.get("cx")), float(one.get("cy"))) for one in found([0, 90], "circle")[1:3])
    assert first == pytest.approx((0, -RAY))
    assert second == pytest.approx((-RAY, 0))


def test_every_cylinder_is_named_once():
    assert [one.text for one in found(V8, "text")] == ["1, 2", "3, 4", "5, 6", "7, 8"]
    assert "-0.0" not in crank_star([0, 90, 180, 270])


def test_an_engine_shows_its_star_on_the_page_and_in_the_report():
    (picture,) = pictures(DECLARED, step(V8))
    assert picture.for_script("engine") == {"kind": "star", "scope": "engine", "angles": "crankpin_angles"}
    (plot,) = drawn(DECLARED, step(V8))
    assert plot.svg == crank_star(V8)
    assert [one.kind for one in pictures(DECLARED, step([0.0]))] == ["star"]


@pytest.mark.parametrize("angles", [[], None, [[0.0, 180.0]], [None, 0.0]])
def test_no_star_of_what_is_no_list_of_angles(angles):
    assert pictures(DECLARED, step(angles)) == []


@pytest.mark.parametrize(("count", "kinds"), [(MOST_PINS, ["star"]), (MOST_PINS + 1, [])])
def test_a_worksheet_with_many_angles_draws_no_star(count, kinds):
    """Anybody's template may have an output of this name, of any length."""
    shown = pictures(DECLARED, step([0.5 * number for number in range(count)]))
    assert [picture.kind for picture in shown] == kinds
