"""Centre lines of a view, and its section marks: label, cutting line, arrows (ISO 128-2, ISO 128-3)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from math import atan2, degrees, hypot

from cad.drafting.curves import Curve, Point, joined
from cad.drafting.dimension_layout import PlacedDimension
from cad.drafting.letter_width import width_of
from cad.drafting.page import Page
from cad.drafting.plan import Plan
from cad.drafting.room import Room
from cad.drafting.symbols import arrow
from cad.drafting.views import View
from cad.inspect import look_at
from cad.step import Body, rigid
from cad.surfaces import Z

LETTERS = 5.0  # height of the letters that name a section [mm on paper]
_OVER = 3.0  # of a centre line beyond what it is the centre of [mm on paper]
_LEAST = 0.8  # radius of a circle that gets centre lines [mm on paper]
_MOST = 80  # centre lines of a view
_OFF = 1.0  # from the letters of a section to other words and lines [mm on paper]
_CLEAR = 1e-5

Segment = tuple[Point, Point]


@dataclass(frozen=True)
class Centres:
    """Centre lines and pitch circles, in the drawing's coordinates."""

    lines: list[Segment]
    circles: list[tuple[Point, float]]


def centre_lines(section: View, end: View, bodies: Sequence[Body], plan: Plan) -> Centres:
    """Return the centre lines of both views."""
    over = _OVER / plan.scale
    (left, _), (right, _) = section.box
    (end_left, low), (end_right, high) = end.box
    low, high = min(low, 0.0), max(high, 0.0)
    shaft: list[Segment] = [
        ((left - over, 0.0), (right + over, 0.0)),
        ((end_left - over, 0.0), (end_right + over, 0.0)),
        ((0.0, low - over), (0.0, high + over)),
    ]
    axes = _distinct(_axes(section, bodies, over))
    crosses = _distinct(_crosses(section, plan, over))
    pitch, of_end = _pitched(end, plan, over)
    own = [*shaft[1:], *_distinct(of_end)]
    across = _distinct(_longer(axis, over) for axis in end.axes)
    own += [axis for axis in across if not any(_on_one_line(axis, other) for other in own)]
    moved = [(_right(a, plan.beside), _right(b, plan.beside)) for a, b in _beside(own, end)]
    lines = [*_beside([shaft[0], *axes, *crosses], section), *moved]
    return Centres(lines, [((plan.beside, 0.0), radius) for radius in pitch])


def _beside(lines: Sequence[Segment], view: View) -> list[Segment]:
    """Return centre lines, each drawn once, where no outline covers them (ISO 128-2)."""
    curves = joined([Curve([*line]) for line in lines], view.visible)
    return [(one.points[0], one.points[-1]) for one in curves if one.arc is None and len(one.points) == 2]


def pitch_circles(placed: Sequence[PlacedDimension]) -> list[tuple[Point, float]]:
    """Return the dimensioned circles about the shaft on which holes are arranged."""
    return [
        ((one.right, 0.0), one.dimension.measure.value / 2)
        for one in placed
        if one.dimension.measure.form == "circle"
        and one.dimension.measure.place == "end"
        and one.dimension.measure.points[0] == (0.0, 0.0)
    ]


def _axes(view: View, bodies: Sequence[Body], over: float) -> Iterator[Segment]:
    """Yield the axes of cylinders in the plane of the section, except the shaft's own."""
    normal = view.frame.towards
    for body in bodies:
        seen = look_at([body])[body.name]
        for place in body.places:
            moved = rigid(place)
            for cylinder in (one.moved(*moved) for one in seen.cylinders):
                point, direction = cylinder.point, cylinder.direction
                is_within = abs(point.dot(normal)) < _CLEAR and abs(direction.dot(normal)) < _CLEAR
                if not is_within or cylinder.about(Z):
                    continue
                start = point.dot(direction)
                low, high = (reach - start for reach in cylinder.reach)
                ends = (point + direction * (low - over), point + direction * (high + over))
                yield view.frame.flat(ends[0]), view.frame.flat(ends[1])


def _middles(view: View, plan: Plan) -> dict[Point, float]:
    """Return the centres of circles, each with the largest radius about it."""
    radii: dict[Point, float] = {}
    for circle in view.circles:
        middle = round(circle.centre[0], 4) + 0.0, round(circle.centre[1], 4) + 0.0
        if circle.radius * plan.scale >= _LEAST:
            radii[middle] = max(radii.get(middle, 0.0), circle.radius)
    return radii


def _crosses(view: View, plan: Plan, over: float) -> Iterator[Segment]:
    """Yield a horizontal and a vertical line through the centre of every circle."""
    for (x, y), radius in _middles(view, plan).items():
        reach = radius + min(over, radius)
        yield (x - reach, y), (x + reach, y)
        yield (x, y - reach), (x, y + reach)


def _pitched(view: View, plan: Plan, over: float) -> tuple[list[float], Iterator[Segment]]:
    """Return the radii of pitch circles about the shaft, and the centre lines of all holes."""
    middles = {at: radius for at, radius in _middles(view, plan).items() if at != (0.0, 0.0)}
    turns = defaultdict[float, list[float]](list)
    for x, y in middles:
        turns[round(hypot(x, y), 3)].append(round(degrees(atan2(y, x)), 3) % 360)
    pitch = [size for size, some in turns.items() if size > 0 and _are_even(sorted(some))]

    def lines() -> Iterator[Segment]:
        for (x, y), radius in middles.items():
            size, reach = hypot(x, y), radius + min(over, radius)
            u, v = (x / size, y / size) if round(size, 3) in pitch else (0.0, 1.0)
            yield (x - reach * u, y - reach * v), (x + reach * u, y + reach * v)
            if round(size, 3) not in pitch:
                yield (x - reach, y), (x + reach, y)

    return pitch, lines()


def _are_even(turns: Sequence[float]) -> bool:
    """Return whether at least three directions [deg] are evenly spaced round a circle."""
    step = 360 / max(len(turns), 1)
    return len(turns) > 2 and all(abs(turn - turns[0] - n * step) < 1e-2 for n, turn in enumerate(turns))


def _longer(segment: Segment, over: float) -> Segment:
    """Return a segment that is extended by the same length at both ends."""
    (x, y), (u, v) = segment
    size = hypot(u - x, v - y) or 1.0
    a, b = (u - x) / size * over, (v - y) / size * over
    return (x - a, y - b), (u + a, v + b)


def _on_one_line(one: Segment, other: Segment) -> bool:
    """Return whether two segments are on the same line."""
    (x, y), (u, v) = other
    size = hypot(u - x, v - y) or 1.0
    return all(abs((u - x) * (b - y) - (v - y) * (a - x)) / size < 1e-3 for a, b in one)


def _distinct(segments: Iterable[Segment]) -> list[Segment]:
    """Return each line once, up to a limit on their number."""
    seen: dict[tuple[float, ...], Segment] = {}
    for one, other in segments:
        ends = sorted((one, other))
        seen.setdefault(tuple(round(c, 3) for end in ends for c in end), (ends[0], ends[1]))
    return list(seen.values())[:_MOST]


def _right(point: Point, away: float) -> Point:
    return point[0] + away, point[1]


def cutting_line(page: Page, section: View, end: View, room: Room) -> None:
    """Draw the cutting line of the section in the end view, with thick ends, arrows and letters.

    The viewer is to the right of the end view, so the arrows point left, as in first-angle projection.
    """
    if not section.cut:
        return
    plan = page.plan
    (_, low), (_, high) = end.box
    middle, top = plan.paper((0.0, high), plan.beside)
    _, bottom = plan.paper((0.0, low), plan.beside)
    width = width_of("A", LETTERS)
    for start, out in ((top + 2.0, 1), (bottom - 2.0, -1)):
        stop = start + 6.0 * out
        page.line([(middle, start), (middle, stop)], "CUTTING")
        page.symbol(arrow((middle - 9.0, stop), (middle, stop), 4.0))
        left = clear_of_extensions((middle + 1.5, middle - 10.5 - width), width, plan, is_above=out > 0)
        page.write("A", left, stop - LETTERS / 2, LETTERS)
        room.add((left - 0.5, stop - LETTERS / 2 - 0.5, left + width, stop + LETTERS / 2 + 0.5))
        room.add((middle - 9.5, min(start, stop) - 0.5, middle + 0.5, max(start, stop) + 1.0))


def clear_of_extensions(lefts: Sequence[float], width: float, plan: Plan, *, is_above: bool) -> float:
    """Return the left side of a letter above or below the views that the fewest extension lines cross.

    The letters come before the dimensions, whose extension lines lead past them wherever their lanes are.
    """
    lanes = plan.lanes
    of_section, of_end = (lanes.above, lanes.end_above) if is_above else (lanes.below, lanes.end_below)
    ends = [
        plan.paper(point, right)[0]
        for side, right in ((of_section, 0.0), (of_end, plan.beside))
        for one in side
        for point in one.measure.points
    ]
    return min(lefts, key=lambda left: sum(left - _OFF < end < left + width + _OFF for end in ends))


def section_label(page: Page, view: View, letter: str, room: Room, least: float = 3.0) -> None:
    """Draw a label such as A–A at the nearest free place above a section, at least so far above it [mm]."""
    (left, _), (right, high) = view.box
    text = f"{letter}–{letter}"
    width = width_of(text, LETTERS)
    x, y = page.plan.paper(((left + right) / 2, high))
    x, y = x - width / 2, y + least
    ways = sorted(product(range(-30, 31, 5), range(120)), key=lambda way: 3 * abs(way[0]) + way[1])
    boxes = (
        (x + aside - _OFF, y + up - _OFF, x + aside + width + _OFF, y + up + LETTERS + _OFF)
        for aside, up in ways
    )
    place = room.first((box, (box[0] + _OFF, box[1] + _OFF)) for box in boxes)
    page.write(text, *(place or (x, y)), LETTERS)
