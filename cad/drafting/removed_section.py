"""Removed sections (ISO 128-3): cross-sections of a bar beside the views, with their own dimensions.

A model declares its removed sections in `sections`, by letter:

    sections = {"B": {"of": "rod", "at": {"centre_distance": 0.5}, "shows": ["shank_width"]}}

`of` is the part. `at` is the position of the cut along y, a sum of parameters with factors. `shows` lists the
parameters that are dimensioned there instead of in the other views.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from math import cos, dist, radians, sin

import numpy as np
from cadquery import Location, Vector

from cad.drafting.curves import Point
from cad.drafting.declaration import DrawingDeclaration
from cad.drafting.definition import Definition
from cad.drafting.dimension_layout import DimensionLayout, NoRoom, PlacedDimension
from cad.drafting.labels import TEXT, label_of
from cad.drafting.lanes import Lane
from cad.drafting.letter_width import width_of
from cad.drafting.marks import LETTERS, clear_of_extensions, section_label
from cad.drafting.measures import Form, Measure, on
from cad.drafting.page import Page
from cad.drafting.parameter_match import Dimension, is_on, length_of, matched
from cad.drafting.plan import LANE, Plan
from cad.drafting.room import Rectangle, Room
from cad.drafting.section import CLEAR, Cut, Frame, curve_of, cut_of, faces_across
from cad.drafting.symbols import arrow
from cad.drafting.views import View
from cad.step import Body
from cad.surfaces import Face, PartSurfaces, Surface, Y, Z

_MARGIN = 12.0  # about a section, beside its lanes [mm on paper]
_AT_ONCE = 200  # places whose room is looked up at once
_STEP = 4.0  # between places that are tried [mm on paper]
_SLANT = radians(45)  # of a leader to a circle, between the centre lines
_LABEL = 14.0  # of a section's label above it [mm on paper]


@dataclass(frozen=True)
class RemovedSection:
    """A removed section: its view about its own origin, its dimensions, and its height in the end view.

    A section across the shaft has the places along the shaft at which it is cut, instead of a height.
    """

    letter: str
    view: View
    height: float
    dimensions: tuple[Dimension, ...]
    stations: tuple[float, ...] = ()
    leaning: frozenset[Face] = frozenset()  # planes that it cuts, of a bar that tapers

    @property
    def names(self) -> set[str | None]:
        """Return the names of the parameters that the section shows."""
        return {one.name for one in self.dimensions}

    def define(self, definition: Definition) -> None:
        """Add the dimensions of the section: horizontal ones are across the shaft, vertical ones along it."""
        sign = self.view.frame.up.dot(Z)
        for measure in (one.measure for one in self.dimensions if not one.is_reference):
            points = measure.points
            if measure.form == "circle" and not self.stations:
                definition.add(measure)
                continue
            if measure.form == "up" and not self.stations:
                points = tuple((y * sign, 0.0) for _, y in points)
                definition.add(replace(measure, form="across", points=points))
            else:
                definition.add(replace(measure, place="end"))


def removed_sections(
    declared: DrawingDeclaration,
    parameters: Mapping[str, str],
    bodies: Sequence[Body],
    seen: Mapping[str, PartSurfaces],
    end: View,
) -> list[RemovedSection]:
    """Return the removed sections of a drawing that show at least one dimension."""
    if (end.frame.up - Y).Length > CLEAR:
        return []  # y is not upright in the view in which the section would be marked
    return [
        one
        for letter in declared.sections
        if (one := _removed(letter, declared, parameters, bodies, seen, end)) is not None
    ]


def _removed(
    letter: str,
    declared: DrawingDeclaration,
    parameters: Mapping[str, str],
    bodies: Sequence[Body],
    seen: Mapping[str, PartSurfaces],
    end: View,
) -> RemovedSection | None:
    said = declared.sections[letter]
    factors, shows = said["at"], said["shows"]
    assert isinstance(factors, Mapping)
    assert isinstance(shows, Sequence)
    height = sum(factor * length_of(parameters[name]) for name, factor in factors.items())
    frame = Frame(end.frame.right, Y.cross(end.frame.right))  # seen from above
    part, body = next((i, body) for i, body in enumerate(bodies) if body.name == said["of"])
    view = section_view(part, body, Y, height, frame)
    if not view.edges:
        return None
    circles = [*_circles(view, seen[body.name])]
    drilled = [name for name, size in declared.sizes.items() if any(is_on(one, size) for one in circles)]
    wanted = {name: parameters[name] for name in (*shows, *drilled) if name in parameters}
    leaning = [*_leaning(view, seen[body.name], height)]
    shown = [*_measures(view, seen[body.name], leaning), *circles]
    dimensions, _ = matched(wanted, declared.sizes, shown, declared.limits)
    planes = on(*(plane for _, plane in leaning))
    return RemovedSection(letter, view, height, tuple(dimensions), leaning=planes) if dimensions else None


def section_view(part: int, body: Body, axis: Vector, place: float, frame: Frame) -> View:
    """Return the view of a body's section across an axis, at a place along it [mm]."""
    faces = faces_across(body.shape.moved(Location(axis * -place)), axis)
    curves = [curve_of(edge, frame) for face in faces for edge in face.Edges()]
    straight = [(c.points[0], c.points[-1]) for c in curves if c.arc is None and len(c.points) == 2]
    return View(frame, curves, [], [], [cut_of(part, face, frame) for face in faces], [], straight)


def _leaning(view: View, seen: PartSurfaces, height: float) -> Iterator[tuple[float, Surface]]:
    """Yield planes along the shaft that are askew, with their places on edges of the section."""
    places = {one[0] for one, other in view.edges if abs(one[0] - other[0]) < CLEAR}
    for plane in seen.planes:
        right, up = view.frame.right.dot(plane.direction), plane.direction.y
        if abs(plane.direction.dot(Z)) < CLEAR < min(abs(right), abs(up)):
            at = (plane.point.dot(plane.direction) - up * height) / right
            yield from ((place, plane) for place in places if abs(place - at) < CLEAR)


def _circles(view: View, seen: PartSurfaces) -> Iterator[Measure]:
    """Yield the diameters of drillings along y that the section cuts: only there they are circles.

    Beside the shank, the extension lines of such a drilling would lead through the ends of the bar.
    """
    rounds = [curve.arc for curve in view.visible if curve.arc is not None and curve.arc.is_whole]
    for cylinder in (one for one in seen.cylinders if one.along(Y)):
        x, y = view.frame.flat(cylinder.point)
        radius = cylinder.diameter / 2
        if any(dist(one.centre, (x, y)) + abs(one.radius - radius) < CLEAR for one in rounds):
            tip = x + radius * cos(_SLANT), y + radius * sin(_SLANT)
            yield Measure("diameter", cylinder.diameter, "section", "circle", ((x, y), tip), 1, on(cylinder))


def _measures(view: View, seen: PartSurfaces, leaning: Sequence[tuple[float, Surface]]) -> Iterator[Measure]:
    """Yield the distances between parallel straight edges, measured at their lowest or leftmost ends."""
    forms: tuple[tuple[int, Form], ...] = ((0, "across"), (1, "up"))
    for along, form in forms:
        feet: dict[float, float] = {}
        for one, other in view.edges:
            if abs(one[along] - other[along]) < CLEAR:
                place, foot = round(one[along], 6), min(one[1 - along], other[1 - along])
                feet[place] = min(feet.get(place, foot), foot)
        axis = view.frame.up if along else view.frame.right
        for low, high in combinations(sorted(feet), 2):
            sides = (_faces_at(axis, level, seen, () if along else leaning) for level in (low, high))
            ends = ((low, feet[low]), (high, feet[high]))
            points = ends if along == 0 else tuple((foot, place) for place, foot in ends)
            yield Measure("width", high - low, "section", form, points, 1, *sides)


def _faces_at(
    axis: Vector, level: float, seen: PartSurfaces, leaning: Iterable[tuple[float, Surface]]
) -> frozenset[Face]:
    """Return the faces at a level of a section: planes across the axis, and those that are askew."""
    return on(*seen.planes_at(axis, level), *(plane for at, plane in leaning if abs(at - level) < CLEAR))


def mark(page: Page, room: Room, removed: RemovedSection, section: View) -> None:
    """Draw the line along which a section is cut, in the end view; the arrows point down.

    The lines of a section across the shaft are in the section along it; their arrows point to the right.
    """
    plan = page.plan
    for station in removed.stations:
        _mark_across(page, room, removed.letter, station, section)
    if removed.stations:
        return
    (left, _), (right, _) = removed.view.box
    width = width_of(removed.letter, LETTERS)
    for side, out in ((left, -1), (right, 1)):
        x, y = plan.paper((side, removed.height), plan.beside)
        start, stop = x + 2.0 * out, x + 8.0 * out
        page.line([(start, y), (stop, y)], "CUTTING")
        page.symbol(arrow((stop, y - 9.0), (stop, y), 4.0))
        at = stop + 1.5 if out > 0 else stop - 1.5 - width
        page.write(removed.letter, at, y - LETTERS - 1.0, LETTERS)
        room.add((min(at, start, stop) - 0.5, y - 9.5, max(at + width, start, stop) + 0.5, y + 1.0))


def _mark_across(page: Page, room: Room, letter: str, station: float, section: View) -> None:
    """Draw the ends of a line across the shaft, beyond the shaft there, with arrows and letters.

    Raises
    ------
    NoRoom
        If it is too near to another one.
    """
    (_, low), (_, high) = section.box
    width = width_of(letter, TEXT)
    for edge, out in ((high, 1), (low, -1)):
        x, y = page.plan.paper((station, edge))
        start, stop = y + 1.5 * out, y + 6.5 * out
        page.line([(x, start), (x, stop)], "CUTTING")
        page.symbol(arrow((x + 6.0, stop), (x, stop)))
        left = clear_of_extensions((x - width - 1.0, x + 7.0), width, page.plan, is_above=out > 0)
        page.write(letter, left, stop - TEXT / 2, TEXT)
        ends = sorted((start, stop - TEXT / 2, stop + TEXT / 2))
        box = min(left, x) - 0.5, ends[0], max(x + 6.5, left + width + 0.5), ends[-1]
        if not room.is_clear(box, 0.0):
            raise NoRoom
        room.add(box)


@dataclass(frozen=True)
class Extent:
    """What a section takes on the paper about its own origin, with its dimensions and its label [mm]."""

    left: float
    below: float
    right: float
    above: float
    inner: Sequence[Dimension]  # vertical ones whose lines run within the section
    beside: Sequence[Dimension]  # the other vertical ones
    label: float  # room for its label and the texts above it

    @staticmethod
    def of(removed: RemovedSection, plan: Plan) -> Extent:
        """Return the extent of a section on a plan."""
        is_across = bool(removed.stations)
        up = [one for one in removed.dimensions if one.measure.form == "up"]
        across = [one for one in removed.dimensions if one.measure.form == "across"]
        inner = [one for one in up if not is_across and _is_within(one, removed.view)]
        beside = [one for one in up if one not in inner]
        is_local = len(up) + len(across) < len(removed.dimensions)
        margin = _MARGIN * 1.5 if is_local else _MARGIN
        label = _LABEL + max((label_of(one).width(TEXT) for one in inner), default=0.0)
        (x, y), (right, high) = removed.view.box
        if is_across:  # its centre lines lead to the axis of the shaft
            x, y, right, high = min(x, 0.0), min(y, 0.0), max(right, 0.0), max(high, 0.0)
        return Extent(
            LANE * len(beside) + margin - x * plan.scale,
            LANE * len(across) + margin - y * plan.scale,
            right * plan.scale + margin,
            high * plan.scale + label,
            inner,
            beside,
            label,
        )


def place(
    page: Page, room: Room, removed: RemovedSection, placing: DimensionLayout, origin: Point | None = None
) -> tuple[list[PlacedDimension], View]:
    """Draw a section with its origin at a position on the paper, or at a free place of the sheet.

    Return its dimensions, and its view there.

    Raises
    ------
    NoRoom
        If the sheet has no free place for it.
    """
    plan = page.plan
    is_across = bool(removed.stations)
    extent = Extent.of(removed, plan)
    shift = plan.at(*(origin or _found(plan, room, removed, extent)))
    inner, beside, above = extent.inner, extent.beside, extent.label
    level = [one for one in removed.dimensions if one.measure.form == "across"]
    local = [one for one in removed.dimensions if one.measure.form not in ("across", "up")]
    view = _shifted(removed.view, shift)
    (x, y), (right, high) = view.box
    room.add_view(
        (*plan.paper((x, y)), *plan.paper((right, high))),
        [[plan.paper(point) for point in one.points] for one in view.visible],
    )
    page.view(view, 0.0)
    over = 3.0 / plan.scale
    middle = (x + right) / 2, (y + high) / 2
    cross = shift if is_across else middle
    page.centres(
        [
            ((min(x, cross[0]) - over, cross[1]), (max(right, cross[0]) + over, cross[1])),
            ((cross[0], min(y, cross[1]) - over), (cross[0], max(high, cross[1]) + over)),
        ],
        [],
    )
    across, up = ([_moved(one, shift) for one in some] for some in (level, beside))
    placed = [
        *placing.lane(Lane(_by_size(across), 0, y, -1, False)),
        *placing.lane(Lane(_by_size(up), 1, x, -1, False)),
    ]
    for one in (_moved(one, shift) for one in inner):
        along = (one.measure.points[0][0] + middle[0]) / 2  # beside the centre line
        placed.append(placing.within(one, along, high))
    placed += placing.local(_moved(one, shift) for one in local)
    section_label(page, view, removed.letter, room, above - LETTERS - 1.5)
    return placed, view


def _by_size(dimensions: Sequence[Dimension]) -> list[Dimension]:
    return sorted(dimensions, key=lambda one: one.measure.value)


def _is_within(one: Dimension, view: View) -> bool:
    """Return whether a dimension ends within the section, as for a web between two pockets."""
    return min(x for x, _ in one.measure.points) > view.box[0][0] + CLEAR


def _found(plan: Plan, room: Room, removed: RemovedSection, extent: Extent) -> Point:
    """Return the origin of a section with its dimensions at the nearest free place [mm on paper]."""
    width, height = extent.left + extent.right, extent.below + extent.above
    near = plan.paper((removed.view.box[1][0], removed.height), plan.beside)

    def away(corner: Point) -> float:
        return abs(corner[0] - near[0]) + abs(corner[1] + height / 2 - near[1])

    corners = sorted(_corners(room.area, width, height), key=away)
    places = np.array(corners).reshape(-1, 2)
    boxes = np.concatenate([places, places + np.array([width, height])], axis=1)
    for start in range(0, len(corners), _AT_ONCE):
        free = np.flatnonzero(room.free(boxes[start : start + _AT_ONCE]))
        if len(free):
            left, low = corners[start + int(free[0])]
            return left + extent.left, low + extent.below
    raise NoRoom


def _corners(area: Rectangle, width: float, height: float) -> Iterator[Point]:
    left, low, right, high = area
    across, up = int((right - left - width) // _STEP), int((high - low - height) // _STEP)
    for i in range(across + 1):
        for j in range(up + 1):
            yield left + i * _STEP, low + j * _STEP


def _moved(one: Dimension, shift: Point) -> Dimension:
    points = tuple((x + shift[0], y + shift[1]) for x, y in one.measure.points)
    return replace(one, measure=replace(one.measure, points=points))


def _shifted(view: View, shift: Point) -> View:
    """Return a view moved by a vector."""
    curves = [curve.moved(shift) for curve in view.visible]
    cut = [
        Cut(
            one.part, [[(x + shift[0], y + shift[1], bulge) for x, y, bulge in line] for line in one.outlines]
        )
        for one in view.cut
    ]
    return replace(view, visible=curves, cut=cut)
