"""Sizes of what stands out of a cylinder, lies beside the shaft or is bevelled: lugs, joints, chamfers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import hypot, isclose

from cad.drafting.measures import Measure, Sort
from cad.drafting.views import View
from cad.inspect import look_at
from cad.step import Body
from cad.surfaces import Seen, X, Y, Z

_CLEAR = 1e-6  # [mm]


def standing(bodies: Sequence[Body], section: View, end: View) -> list[Measure]:
    """Every such size that the views show."""
    seen = look_at(bodies).values()
    beside = [measure for one in seen for measure in (*of_circles(one, end), *of_levels(one, end))]
    return [*beside, *of_bevels(section)]


def of_circles(seen: Seen, end: View) -> Iterator[Measure]:
    """The circles about the shaft on which the axes of holes lie."""
    for cylinder in seen.cylinders:
        if cylinder.along(Z) and not cylinder.about(Z):
            right, up = end.frame.flat(cylinder.point)
            yield Measure("diameter", 2 * hypot(right, up), "end", "circle", ((0.0, 0.0), (right, up)))


def of_levels(seen: Seen, end: View) -> Iterator[Measure]:
    """From the largest cylinder about the shaft to planes beyond it, and from the shaft to each plane."""
    radius = max(seen.diameters(Z), default=0.0) / 2
    for axis in (X, Y):
        right, up = end.frame.flat(axis)
        for level in seen.levels(axis):
            if abs(level) < _CLEAR:
                continue
            side = level * (right + up)
            for start in (0.0, radius if side > 0 else -radius):
                if abs(side) > abs(start) + _CLEAR:
                    ends = ((start, 0.0), (side, 0.0)) if up == 0 else ((0.0, start), (0.0, side))
                    sort: Sort = "gap" if start else "offset"
                    yield Measure(sort, abs(side - start), "end", "across" if up == 0 else "up", ends)


def of_bevels(section: View) -> Iterator[Measure]:
    """The width of edges of the section at 45°, along the shaft."""
    for (x, y), (z, v) in section.edges:
        if abs(z - x) > _CLEAR and isclose(abs(z - x), abs(v - y), rel_tol=1e-6):
            low, high = sorted(((x, y), (z, v)))
            yield Measure("length", abs(z - x), "section", "across", (low, high))
