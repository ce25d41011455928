"""No leader crosses a dimension line or a foreign view, no words overlap, and no line crosses words."""

from itertools import pairwise
from math import dist, hypot

import numpy as np
import pytest
from seeds import seeded
from slow_models import DRAWN, quick_for

from cad.catalogue import models
from cad.drafting.content import declared_of
from cad.drafting.dimension_layout import GAP
from cad.drafting.labels import TEXT
from cad.drafting.room import around, crossed, overlap
from cad.drafting.sheet import laid_out
from cad.header import read_header
from cad.model import CadModel
from cad.regenerate import as_text, regenerate_class
from cad.step import read_step


def laid(model: type[CadModel], share: float):
    """The content and layout of the example's sheet, a share of its sizes with random limits."""
    rng = np.random.default_rng(seeded(3702))
    texts = as_text(model.from_quantities(model.example))
    for name in model.toleranced:
        if name in texts and not texts[name].startswith(("0 ", "[")) and rng.random() < share:
            texts[name] = f"{texts[name]} +{rng.integers(2, 9) / 100}/-0.01 mm"
    step = regenerate_class(model, texts).step
    bodies, header = read_step(step), read_header(step)
    seen, declared = declared_of(bodies, header)
    return laid_out(bodies, seen, header, declared)


def cross(one, other) -> bool:
    """Whether two straight lines cross within both."""
    (a, b), (c, d) = (np.array(line, dtype=float) for line in (one, other))
    u, v, w = b - a, d - c, c - a
    across = u[0] * v[1] - u[1] * v[0]
    if abs(across) < 1e-12:
        return False
    s, t = (w[0] * v[1] - w[1] * v[0]) / across, (w[0] * u[1] - w[1] * u[0]) / across
    return bool(0.02 < s < 0.98 and 0.0 < t < 1.0)


def is_in(point, box) -> bool:
    return bool(box[0] - 1 <= point[0] <= box[2] + 1 and box[1] - 1 <= point[1] <= box[3] + 1)


def away(point, box) -> float:
    """The distance of a point from a rectangle, such as that of an extension line from its view."""
    left, low, right, high = box
    return hypot(max(left - point[0], point[0] - right, 0), max(low - point[1], point[1] - high, 0))


def words_of(placed, plan):
    """The rectangle of a dimension's words beside its line, on the paper."""
    (x, y), (u, v) = placed.ends
    across, up = placed.label.width(TEXT), placed.label.height(TEXT)
    above = GAP + up / 2
    if placed.words is not None:
        middle = plan.paper(placed.words)
    else:
        middle = ((x + u) / 2 - above, (y + v) / 2) if x == u else ((x + u) / 2, (y + v) / 2 + above)
    return around(middle, up, across) if x == u else around(middle, across, up)


def sides(box):
    left, low, right, high = box
    corners = [(left, low), (right, low), (right, high), (left, high)]
    return zip(corners, [*corners[1:], corners[0]], strict=True)


@pytest.mark.parametrize("share", [0.4, pytest.param(1.0, marks=pytest.mark.slow)])
@quick_for(*DRAWN)
def test_leaders_keep_off_dimension_lines_and_foreign_views(model: type[CadModel], share: float) -> None:
    _, sheet = laid(model, share)
    lines = [placed.ends for placed in sheet.placed if placed.ends]
    for leader in sheet.room.leaders:
        assert not [line for line in lines if cross(leader, line)], leader
        home = min(sheet.room.views, key=lambda view: away(leader[0], view))
        foreign = [view for view in sheet.room.views if view is not home and not is_in(leader[0], view)]
        assert not [view for view in foreign if any(cross(leader, side) for side in sides(view))], leader
    for placed in (one for one in sheet.placed if one.ends):
        box = words_of(placed, sheet.page.plan)
        assert not crossed(sheet.room._lines.array, box, -0.15).any(), placed.dimension.name
        assert not crossed(sheet.room._outlines.array, box, -0.1).any(), placed.dimension.name
    words = sheet.room.words
    overlapping = [(a, b) for n, a in enumerate(words) for b in words[:n] if overlap(a, b, -0.2)]
    assert overlapping == []


@pytest.fixture(scope="module")
def rod():
    """The sheet of a rod whose sizes all have tolerances: it has the longest words beside the most arcs."""
    return laid(models().get("connecting_rod", 1), 1.0)


def one_of(sheet, name: str):
    """The placed dimension of a parameter."""
    (placed,) = [placed for placed in sheet.placed if placed.dimension.name == name]
    return placed


@pytest.mark.slow
def test_the_leader_of_a_fillet_crosses_no_outline(rod) -> None:
    content, sheet = rod
    plan, placed = sheet.page.plan, one_of(sheet, "big_end_fillet")
    outlines = [
        (plan.paper(a, plan.beside), plan.paper(b, plan.beside))
        for curve in content.end.visible
        for a, b in pairwise(curve.points)
    ]
    assert not [line for line in outlines if cross(placed.leader[:2], line)]


@pytest.mark.slow
def test_a_drilling_along_a_bar_is_a_circle_in_the_section_across_it(rod) -> None:
    content, sheet = rod
    (section,) = content.removed
    assert "oil_drilling_diameter" in section.names
    assert one_of(sheet, "oil_drilling_diameter").dimension.measure.form == "circle"
    assert content.missing() == []


@pytest.mark.slow
def test_the_words_of_a_narrow_angle_stand_on_its_arc(rod) -> None:
    _, sheet = rod
    plan, placed = sheet.page.plan, one_of(sheet, "shank_taper")
    corner, one, other = placed.dimension.measure.points
    shifted = corner[0] + placed.right, corner[1]
    apart = abs(dist(placed.words, shifted) - dist(placed.base, shifted)) * plan.scale
    assert apart == pytest.approx(GAP + TEXT / 2)  # the words nearly touch the line
    half = dist(one, other) * plan.scale / 2
    beyond = abs(placed.words[0] - shifted[0]) * plan.scale - half
    assert 0 < beyond < placed.label.width(TEXT) / 2 + 10  # and begin soon after a leg


def test_a_height_at_the_left_of_the_end_view_stands_there() -> None:
    """At its right the extension lines of the saddle height would lead through the bolt."""
    _, sheet = laid(models().get("bearing_housing", 1), 0.0)
    view = max(sheet.room.views)
    assert [at for at, _ in one_of(sheet, "saddle_height").ends] == pytest.approx([view[0] - 10] * 2)
    assert min(at for at, _ in one_of(sheet, "bolt_hole_depth").ends) > view[2]


def test_broken_out_sections_hide_nothing() -> None:
    """Behind the bolt that is not cut, the dowel's edges are not dashed; beside it, in the view, they are."""
    content, _ = laid(models().get("bearing_housing", 1), 0.0)
    (low, high) = (pick(p[0] for side in content.end.broken for p in side.points) for pick in (min, max))
    assert [curve for curve in content.end.hidden if all(p[0] < low for p in curve.points)]
    assert not [curve for curve in content.end.hidden if all(low < p[0] < high for p in curve.points)]


def test_the_leg_of_an_angle_begins_at_its_hole() -> None:
    content, _ = laid(models().get("thrust_washer", 1), 0.0)
    (angle,) = [one for one in content.dimensions if one.measure.form == "angle" and one.measure.count == 1]
    assert min(abs(dist(leg, (0, 0)) - 27) for leg in angle.measure.points[1:]) < 1e-3


@pytest.mark.slow
def test_the_view_along_a_crankshaft_hides_all_but_its_bolt_holes() -> None:
    content, _ = laid(models().get("crankshaft", 1), 0.0)
    radii = {round(dist(curve.arc.centre, (0, 0)), 2) for curve in content.end.hidden}
    assert radii == {34}
