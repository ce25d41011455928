"""Sections across a shaft (ISO 128-3): one through each web that differs, with its direction and its size.

A side view shows of several throws neither which pin follows at which angle nor which web has which
counterweight. Equal webs share a section, and its letter stands at each of them. A section is seen along the
shaft as the end view is, and gives the angle of its pin from the upright centre line, the radius of its
counterweight, and the parameters that only its own faces carry.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import atan2, cos, degrees, hypot, radians, sin
from string import ascii_uppercase

from cad.drafting.curves import Curve, Point
from cad.drafting.declaration import DrawingDeclaration
from cad.drafting.measures import Measure, flank_angles, on, plane_widths
from cad.drafting.parameter_match import Dimension, matched
from cad.drafting.protrusions import of_slots
from cad.drafting.removed_section import RemovedSection, section_view
from cad.drafting.section import CLEAR, Frame
from cad.drafting.views import View
from cad.step import Body
from cad.surfaces import PartSurfaces, Surface, Z

_LETTERS = [letter for letter in ascii_uppercase if letter not in "AIOQ"]
_MOST = 12  # sections of a sheet
_NEAR = 1e-4  # [mm, deg]


@dataclass(frozen=True)
class _Web:
    """A stretch of the shaft with flanks: its section, its surfaces, and where along the shaft it is cut."""

    view: View
    seen: PartSurfaces
    stations: tuple[float, ...]
    axes: tuple[Point, ...]  # of its pins, in the view

    def is_like(self, other: _Web) -> bool:
        """Return whether both sections look the same."""
        one, two = (sorted(_corners(web.view)) for web in (self, other))
        return len(one) == len(two) and all(
            hypot(a[0] - b[0], a[1] - b[1]) < 2e-3 for a, b in zip(one, two, strict=True)
        )


def cross_sections(
    declared: DrawingDeclaration,
    parameters: Mapping[str, str],
    bodies: Sequence[Body],
    seen: Mapping[str, PartSurfaces],
    end: View,
) -> list[RemovedSection]:
    """Return the sections across a shaft with webs in several directions; none of any other part."""
    if not declared.is_shaft or len(bodies) != 1:
        return []
    webs: list[_Web] = []
    for web in _webs(bodies[0], seen[bodies[0].name], end.frame):
        same = next((n for n, other in enumerate(webs) if other.is_like(web)), None)
        if same is None:
            webs.append(web)
        else:
            webs[same] = replace(webs[same], stations=(*webs[same].stations, *web.stations))
    if not 1 < len(webs) <= _MOST:
        return []  # of one web the end view shows everything
    return [*_dimensioned(webs, declared, parameters)]


def _webs(body: Body, seen: PartSurfaces, frame: Frame) -> Iterator[_Web]:
    """Yield the stretches between neighbouring planes across the shaft that have flanks along it."""
    levels = seen.levels(Z)
    flanks = [p.middle.z for p in seen.planes if p.middle is not None and abs(p.direction.dot(Z)) < CLEAR]
    for low, high in pairwise(levels):
        if not any(low < z < high for z in flanks):
            continue
        middle = (low + high) / 2
        view = section_view(0, body, Z, middle, frame)
        own = replace(
            seen,
            planes=tuple(p for p in seen.planes if p.middle is not None and low < p.middle.z < high),
            cylinders=tuple(c for c in _along(seen) if low < sum(c.reach) / 2 < high),
        )
        yield _Web(view, own, (middle,), _pins(seen, (low, high), frame))


def _along(seen: PartSurfaces) -> list[Surface]:
    """Return the cylinders along the shaft."""
    return [c.turned(Z) for c in seen.cylinders if c.along(Z)]


def _is_beside(cylinder: Surface) -> bool:
    return bool(cylinder.point.cross(Z).Length > _NEAR)


def _pins(seen: PartSurfaces, span: tuple[float, float], frame: Frame) -> tuple[Point, ...]:
    """Return the axes beside the shaft of a web's round ends and bores, else that of the nearest pin."""
    beside = [c for c in _along(seen) if _is_beside(c)]
    within = [c for c in beside if span[0] < sum(c.reach) / 2 < span[1]]
    middle = sum(span) / 2
    next_to = [c for c in beside if min(abs(a - b) for a in span for b in c.reach) < c.diameter / 4]
    nearest = sorted(next_to, key=lambda c: (abs(sum(c.reach) / 2 - middle), -c.diameter))[:1]
    points = (frame.flat(c.point) for c in within or nearest)
    return tuple(dict.fromkeys((round(x, 4) + 0.0, round(y, 4) + 0.0) for x, y in points))


def _corners(view: View) -> Iterator[Point]:
    """Yield the corners of the outer outlines; bores and drillings make no web another one."""
    for cut in view.cut:
        yield from ((round(x, 3) + 0.0, round(y, 3) + 0.0) for x, y, _ in cut.outlines[0])


def _dimensioned(
    webs: Sequence[_Web], declared: DrawingDeclaration, parameters: Mapping[str, str]
) -> Iterator[RemovedSection]:
    """Yield the sections with their dimensions; an angle that an earlier one gives stands in brackets."""
    given: set[float] = set()
    left = dict(parameters)
    for letter, web in zip(_LETTERS, webs, strict=False):
        shown = [*flank_angles(web.seen, web.view), *of_slots(web.seen, web.view)]
        radii = [*_counterweight(web)]
        shown += [*plane_widths(web.seen, web.view), *_round_ends(web), *radii]
        own, _ = matched(left, declared.sizes, shown, declared.limits)
        left = {name: text for name, text in left.items() if name not in {one.name for one in own}}
        if not any(one.measure in radii for one in own):
            own += [Dimension(measure, None) for measure in radii]
        for measure in _directions(web):
            turn = round(degrees(atan2(*measure.points[-1])), 3)
            own.append(Dimension(measure, None, is_reference=turn in given))
            given.add(turn)
        dimensions = tuple(replace(one, measure=replace(one.measure, place="section")) for one in own)
        yield RemovedSection(letter, web.view, 0.0, dimensions, tuple(sorted(web.stations)))


def _round_ends(web: _Web) -> Iterator[Measure]:
    """Yield the diameters of bores and round ends beside the shaft."""
    for cylinder in filter(_is_beside, web.seen.cylinders):
        (x, y), radius = web.view.frame.flat(cylinder.point), cylinder.diameter / 2
        tip = x + radius * x / hypot(x, y), y + radius * y / hypot(x, y)
        yield Measure("diameter", cylinder.diameter, "end", "circle", ((x, y), tip), 1, on(cylinder))


def _directions(web: _Web) -> Iterator[Measure]:
    """Yield the angles of pins from the upright centre line, where the centre lines do not show them."""
    for x, y in web.axes:
        turn = round(degrees(atan2(x, y)), 4)  # from upright, clockwise
        if min(abs(turn) % 90, 90 - abs(turn) % 90) > _NEAR:
            reach = hypot(x, y)
            legs: tuple[Point, Point] = (0.0, reach), (x, y)
            yield Measure("angle", abs(turn), "end", "angle", ((0.0, 0.0), *legs))


def _counterweight(web: _Web) -> Iterator[Measure]:
    """Yield the radius of the sector between flanks that lead to the shaft."""
    if not any(plane.holds(Z) for plane in web.seen.planes):
        return
    arcs = [c for c in web.view.visible if c.arc and hypot(*c.arc.centre) < _NEAR and not c.arc.is_whole]
    if arcs:
        longest = max(arcs, key=_radius)
        assert longest.arc
        at = radians(longest.arc.start + longest.arc.turn / 4)
        tip = longest.arc.radius * cos(at), longest.arc.radius * sin(at)
        rims = (c for c in web.seen.cylinders if abs(c.diameter / 2 - longest.arc.radius) < _NEAR)
        faces = on(*(c for c in rims if c.about(Z)))
        yield Measure("radius", longest.arc.radius, "end", "arc", ((0.0, 0.0), tip), 1, faces)


def _radius(curve: Curve) -> float:
    assert curve.arc
    return round(curve.arc.radius, 4)
