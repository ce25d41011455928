"""Match sizes in a drawing with parameters, by their values and by the kind that their names suggest."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import dist, isclose

from cad.drafting.curves import Point
from cad.drafting.measures import Measure, Sort
from cad.tolerances import Limits
from templates.core.units.units import unit

_WORDS: dict[str, tuple[Sort, ...]] = {
    "diameter": ("diameter",),
    "bore": ("diameter",),
    "radius": ("radius",),
    "fillet": ("radius",),
    "angle": ("angle",),
    "inclination": ("angle",),
    "wall": ("gap",),
    "depth": ("gap", "length", "width"),
    "throw": ("offset",),
    "spread": (),  # a difference of two shapes, of which one is drawn
}
_LENGTHS: tuple[Sort, ...] = ("length", "width", "offset", "gap")
_ANY: tuple[Sort, ...] = (*_LENGTHS, "diameter", "radius")
_AMOUNT = re.compile(
    r"(-?[0-9.eE+-]+) (\S+)(?: [A-Za-z]{1,2}[0-9]{1,2}| [-+±].*)?"
)  # with a tolerance behind it
_WITHIN = ("aligned", "circle", "arc", "angle")  # dimensions that do not stand beside the view
_PRECISION = 1e-6  # relative and in mm


@dataclass(frozen=True)
class Dimension:
    """A size to be drawn; `name` is the parameter that it is, None for one that is given for reference."""

    measure: Measure
    name: str | None
    limits: Limits | None = None
    alike: tuple[Measure, ...] = ()  # others that show the same parameter in the same way


def matched(
    parameters: Mapping[str, str], measures: Sequence[Measure], limits: Mapping[str, Limits] | None = None
) -> tuple[list[Dimension], list[str]]:
    """Return a dimension for each parameter that is seen, and the names of those that are not.

    `parameters` are as in the header of a STEP file: `{"inner_diameter": "50 mm", "shells": "upper"}`;
    `limits` are those of toleranced ones.
    """
    matches: list[Dimension] = []
    unseen: list[str] = []
    for name, text in parameters.items():
        size = _size(text)
        if size is None or size[0] == 0:
            continue  # a word, a count, or what is not there
        fitting = _fitting(name, *size, measures)
        fresh = [m for m in fitting if all(m.points != taken.measure.points for taken in matches)]
        if fitting:
            measure = _clearest(fresh or fitting, matches)
            alike = tuple(m for m in fresh if _kind(m) == _kind(measure) and m is not measure)
            matches.append(Dimension(measure, name, (limits or {}).get(name), alike))
        else:
            unseen.append(name)
    return matches, unseen


def _clearest(fitting: Sequence[Measure], matches: Sequence[Dimension]) -> Measure:
    """Return the first; of equal ones drawn within the view, that which is farthest from the others there."""
    others = [d.measure.points[0] for d in matches if d.measure.form in _WITHIN]
    first = fitting[0]
    if first.form not in _WITHIN or not others:
        return first
    alike = [m for m in fitting if _kind(m) == _kind(first)]
    return max(alike, key=lambda m: min(dist(m.points[0], other) for other in others))


def _kind(measure: Measure) -> tuple[str, str, str]:
    return measure.sort, measure.place, measure.form


def _fitting(name: str, value: float, is_angle: bool, measures: Sequence[Measure]) -> list[Measure]:
    sorts = _sorts(name, is_angle)
    is_length = "length" in name.split("_")  # no distance of a plane from the shaft
    close = [
        m
        for m in measures
        if m.sort in sorts
        and _same(m.value, value)
        and not (is_length and (m.sort, m.place) == ("offset", "end"))
    ]
    return sorted(close, key=lambda m: (sorts.index(m.sort), m.place != "section", m.form == "circle"))


def _same(one: float, other: float) -> bool:
    return isclose(one, other, rel_tol=_PRECISION, abs_tol=_PRECISION)


def _sorts(name: str, is_angle: bool) -> tuple[Sort, ...]:
    if is_angle:
        return ("angle",)
    words = name.split("_")
    forms = next((_WORDS[word] for word in reversed(words) if word in _WORDS), None)
    if forms is not None:
        return forms
    return _LENGTHS if {"length", "width", "thickness", "height"} & set(words) else _ANY


def length_of(text: str) -> float:
    """Return a length in millimetres.

    Raises
    ------
    ValueError
        If the text is none.
    """
    size = _size(text)
    if size is None or size[1]:
        raise ValueError(f"{text!r} is no length")
    return size[0]


def _size(text: str) -> tuple[float, bool] | None:
    """Return a length in millimetres or an angle in degrees, and which of them it is."""
    match = _AMOUNT.fullmatch(text)
    if match is None:
        return None
    scale, value = unit(match[2]), float(match[1])
    if scale.base == unit("m").base:
        return float(unit("mm").from_si(scale.to_si(value))), False
    if scale.base == unit("rad").base:
        return float(unit("deg").from_si(scale.to_si(value))), True
    return None


def references(
    taken: Sequence[Dimension], measures: Sequence[Measure], elsewhere: Sequence[Point] = ()
) -> Iterator[Dimension]:
    """Yield reference lengths: between planes that nothing locates, and overall.

    What dimensions join is located by them, also those `elsewhere`, of which the two ends along the shaft are
    given; two planes that lie alike on either side of the origin are joined with it by the dimension between
    them.
    """
    lengths = [m for m in measures if m.sort == "length" and m.place == "section"]
    places = sorted({round(point[0], 6) for m in lengths for point in m.points})
    dimensioned = [
        _span(d.measure) for d in taken if (d.measure.form, d.measure.place) == ("across", "section")
    ]
    groups = _Groups()
    for low, high in [*dimensioned, *elsewhere]:
        groups.join(low, high)
        if abs(low + high) < _PRECISION:
            groups.join(low, 0.0)
    spans = [*pairwise(places), *([(places[0], places[-1])] if len(places) > 2 else [])]
    for low, high in spans:
        is_whole = (low, high) == (places[0], places[-1])
        fits = (m for m in lengths if _span(m) == (low, high))
        if (low, high) in dimensioned or (groups.joins(low, high) and not is_whole):
            continue
        if measure := next(fits, None):
            groups.join(low, high)
            yield Dimension(measure, None)


class _Groups:
    """Places that dimensions join."""

    def __init__(self) -> None:
        self._of: dict[float, set[float]] = {}

    def join(self, one: float, other: float) -> None:
        both = self._of.get(one, {one}) | self._of.get(other, {other})
        self._of.update(dict.fromkeys(both, both))

    def joins(self, one: float, other: float) -> bool:
        return other in self._of.get(one, {one})


def _span(measure: Measure) -> tuple[float, float]:
    return round(measure.points[0][0], 6), round(measure.points[-1][0], 6)
