"""Where a leader to the face of a dimension may end: on its edges, or on their extension lines."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import cos, dist, inf, pi, radians, sin

from cad.drafting.curves import Point
from cad.drafting.dimension_layout import PlacedDimension
from cad.drafting.plan import Plan
from cad.drafting.room import Room
from cad.drafting.views import View

_CLEAR = 1e-4  # [mm]
_OFF = 4.0
"""From a dimension line, and from the end of an edge, to the end of a leader [mm on paper]: a frame with its
arrow on the dimension line itself would be about an axis (ISO 1101)."""

_MOST_ALIKE = 4  # other places of a size whose edges are tried
_SHARES = (0.5, 0.25, 0.75)  # of an edge
_TURNS = range(0, 360, 30)  # [deg] round a circle


def targets(
    placed: PlacedDimension, views: Sequence[tuple[View, float]], plan: Plan, room: Room
) -> list[Point]:
    """Return the places on the paper, the best ones first."""
    measure = placed.dimension.measure
    if placed.ends is None:
        on = plan.paper(measure.points[1], placed.right)
        if measure.form != "circle" or measure.points[0] == (0.0, 0.0):
            return [on, plan.paper(measure.points[0], placed.right)] if measure.form == "aligned" else [on]
        centre = plan.paper(measure.points[0], placed.right)
        radius, turns = dist(centre, on), [pi * turn / 180 for turn in _TURNS]
        return [on, *((centre[0] + radius * cos(t), centre[1] + radius * sin(t)) for t in turns)]
    along = 1 if measure.form == "up" else 0
    extended = (place for point in measure.points for place in _on_extension(point, placed, plan, along))
    found = [place for place in extended if not room.is_in_view(place)]
    edges = [edge for view, right in views if right == placed.right for edge in view.straight]
    every = [point for one in (measure, *placed.dimension.alike[:_MOST_ALIKE]) for point in one.points]
    on_edges = [p for point in every for p in _on_edges(point, placed, edges, plan, along)]
    if not on_edges:
        unseen = [edge for view, right in views if right == placed.right for edge in view.unseen]
        on_edges = [p for point in every for p in _on_edges(point, placed, unseen, plan, along)]
    if not on_edges:
        homes = [view for view, right in views if right == placed.right and _holds(view, measure.points[0])]
        straight = [edge for view in homes for edge in view.straight]
        on_edges = [p for q in measure.points for p in _on_edges(q, placed, straight, plan, along, inf)]
    found += [*on_edges, *_on_arcs(placed, views, plan)]
    return found or [plan.paper(point, placed.right) for point in measure.points]


def hidden_targets(placed: PlacedDimension, views: Sequence[tuple[View, float]], plan: Plan) -> list[Point]:
    """Return places on hidden edges, as of the second of two equal holes of which one is cut open."""
    if placed.ends is None:
        return []
    along = 1 if placed.dimension.measure.form == "up" else 0
    edges = [edge for view, right in views if right == placed.right for edge in view.unseen]
    points = [point for one in placed.dimension.alike[:_MOST_ALIKE] for point in one.points]
    return [place for point in points for place in _on_edges(point, placed, edges, plan, along)]


def _on_arcs(placed: PlacedDimension, views: Sequence[tuple[View, float]], plan: Plan) -> Iterator[Point]:
    """Yield places on the visible arcs of a diameter that is measured across them, as of half a bore."""
    measure = placed.dimension.measure
    if (measure.sort, measure.form, measure.place) != ("diameter", "across", "end"):
        return
    (x, _), (u, _) = measure.points
    curves = (curve for view, right in views if right == placed.right for curve in view.visible)
    for arc in (curve.arc for curve in curves if curve.arc):
        is_same = abs(2 * arc.radius - measure.value) < _CLEAR and abs(arc.centre[0] - (x + u) / 2) < _CLEAR
        if is_same and not arc.is_whole:
            for share in _SHARES:
                turn = radians(arc.start + share * arc.turn)
                on = arc.centre[0] + arc.radius * cos(turn), arc.centre[1] + arc.radius * sin(turn)
                yield plan.paper(on, placed.right)


def _on_extension(point: Point, placed: PlacedDimension, plan: Plan, along: int) -> Iterator[Point]:
    """Yield places on an extension line between an edge and the dimension line."""
    assert placed.ends is not None
    start, stop = plan.paper(point, placed.right)[1 - along], placed.ends[0][1 - along]
    at, size = plan.paper(point, placed.right)[along], abs(stop - start)
    for share in _SHARES:
        if size * (1 - share) > _OFF:
            place = start + share * (stop - start)
            yield (place, at) if along else (at, place)


def _holds(view: View, point: Point) -> bool:
    (left, low), (right, high) = view.box
    return left - _CLEAR < point[0] < right + _CLEAR and low - _CLEAR < point[1] < high + _CLEAR


def _on_edges(
    point: Point,
    placed: PlacedDimension,
    edges: Sequence[tuple[Point, Point]],
    plan: Plan,
    along: int,
    reach: float = _CLEAR,
) -> Iterator[Point]:
    """Yield places on the straight edges that touch a point, or are at its level within a reach [mm]."""
    at, across = point[along], point[1 - along]
    for one, other in edges:
        low, high = sorted((one[1 - along], other[1 - along]))
        is_level = abs(one[along] - at) + abs(other[along] - at) < _CLEAR
        if is_level and low - reach < across < high + reach:
            for share in _SHARES:
                place = low + share * (high - low)
                yield plan.paper((place, at) if along else (at, place), placed.right)
