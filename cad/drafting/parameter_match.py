"""Match parameters with the measures that the views show, by the faces that carry them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import dist, isclose

from cad.drafting.curves import Point
from cad.drafting.measures import Measure, Sort
from cad.surfaces import Kind, PartSurfaces, Size, Z
from cad.tolerances import Limits
from templates.core.units.units import unit

_SORTS: dict[Kind, tuple[Sort, ...]] = {
    "diameter": ("diameter",),
    "sphere": ("diameter",),
    "radius": ("radius",),
    "circle": ("diameter",),
    "distance": ("length", "width", "gap", "offset"),
    "chamfer": ("chamfer",),
    "angle": ("angle",),
    "edge": ("edge",),
}
_AMOUNT = re.compile(
    r"(-?[0-9.eE+-]+) (\S+)(?: [A-Za-z]{1,2}[0-9]{1,2}(?:, in table)?| [-+±].*)?"
)  # with a tolerance behind it
_WITHIN = ("aligned", "circle", "arc", "angle")  # dimensions that do not stand beside the view
_PRECISION = 1e-6  # relative and in mm


@dataclass(frozen=True)
class Dimension:
    """A size to be drawn; `name` is its parameter, or None if it shows no parameter.

    A reference dimension follows from other dimensions and is drawn in brackets.
    """

    measure: Measure
    name: str | None
    limits: Limits | None = None
    alike: tuple[Measure, ...] = ()  # others that show the same parameter in the same way
    is_reference: bool = False


def matched(
    parameters: Mapping[str, str],
    sizes: Mapping[str, Size],
    measures: Sequence[Measure],
    limits: Mapping[str, Limits],
) -> tuple[list[Dimension], list[str]]:
    """Return a dimension for each parameter that the views show, and the names of all other parameters.

    Parameters
    ----------
    parameters
        Parameters as in the header of a STEP file: `{"inner_diameter": "50 mm", "shells": "upper"}`.
    sizes
        Sizes that faces of the solid carry, by parameter.
    measures
        Sizes that the views show.
    limits
        Limit deviations of toleranced parameters.
    """
    matches: list[Dimension] = []
    unseen: list[str] = []
    for name, text in parameters.items():
        size = size_of(text)
        if size is None or size[0] == 0:
            continue  # a word, a count, or a missing feature
        if fitting := _fitting(sizes[name], measures) if name in sizes else []:
            measure = _clearest(fitting, matches)
            alike = tuple(m for m in fitting if _kind(m) == _kind(measure) and m is not measure)
            if (several := len(sizes[name].places)) > 1:
                measure = replace(measure, count=measure.count * several)
            matches.append(Dimension(measure, name, limits.get(name), alike))
        else:
            unseen.append(name)
    return matches, unseen


def spans_of(size: Size, seen: Mapping[str, PartSurfaces]) -> list[Point]:
    """Return the start and end of a repeated length at each place along the shaft; empty for others."""
    if size.kind != "distance" or len(size.places) < 2:
        return []
    at = {plane.face: plane.point.z for one in seen.values() for plane in one.planes if plane.along(Z)}
    if not all({place.first[0], place.second[0]} <= at.keys() for place in size.places):
        return []
    ends = ((at[place.first[0]], at[place.second[0]]) for place in size.places)
    return sorted((round(min(pair), 6), round(max(pair), 6)) for pair in ends)


def _clearest(fitting: Sequence[Measure], matches: Sequence[Dimension]) -> Measure:
    """Return the best measure to draw.

    It is the first one. If that one is drawn within the view, it is the equivalent one that is farthest from
    other dimensions there.
    """
    others = [d.measure.points[0] for d in matches if d.measure.form in _WITHIN]
    first = fitting[0]
    if first.form not in _WITHIN or not others:
        return first
    alike = [m for m in fitting if _kind(m) == _kind(first)]
    return max(alike, key=lambda m: min(dist(m.points[0], other) for other in others))


def _kind(measure: Measure) -> tuple[str, str, str]:
    return measure.sort, measure.place, measure.form


def _fitting(size: Size, measures: Sequence[Measure]) -> list[Measure]:
    """Return the measures taken on the faces of a size, in order of preference."""
    sorts = _SORTS[size.kind]
    shown = [m for m in measures if m.sort in sorts and _same(m.value, size) and is_on(m, size)]
    return sorted(shown, key=lambda m: (sorts.index(m.sort), m.place != "section", m.form == "circle"))


def _same(one: float, other: float) -> bool:
    return isclose(one, other, rel_tol=_PRECISION, abs_tol=_PRECISION)


def is_on(measure: Measure, size: Size) -> bool:
    """Return whether a measure is taken on the faces of a size.

    A measure from an axis has no second faces; the faces of the size are then about that axis. Those of a
    pitch circle are its holes.
    """
    for place in size.places:
        sides = (place.first, place.second), (place.second, place.first)
        for first, second in sides[:1] if size.kind == "circle" else sides:
            if not measure.first.isdisjoint(first) and (
                not (measure.second and second) or not measure.second.isdisjoint(second)
            ):
                return True
    return False


def length_of(text: str) -> float:
    """Return a length in millimetres.

    Raises
    ------
    ValueError
        If the text is not a length.
    """
    size = size_of(text)
    if size is None or size[1]:
        raise ValueError(f"{text!r} is not a length")
    return size[0]


def size_of(text: str) -> tuple[float, bool] | None:
    """Return a length [mm] or an angle [degrees], and whether it is an angle; None for other texts."""
    match = _AMOUNT.fullmatch(text)
    if match is None:
        return None
    scale, value = unit(match[2]), float(match[1])
    if scale.base == unit("m").base:
        return float(unit("mm").from_si(scale.to_si(value))), False
    if scale.base == unit("rad").base:
        return float(unit("deg").from_si(scale.to_si(value))), True
    return None
