"""How the numbers of a drawn model change with one parameter: faces, positions, densities and box.

A model is drawn at several values of the parameter. The drawings are comparable only if they have the same
parts and the same kinds of faces, in the same order.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import floor, log10
from typing import NamedTuple

import numpy as np
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS, TopoDS_Face, TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape

from cad.errors import GeometryError
from cad.model import CadModel, Part
from cad.slopes.carriers import Carriers
from cad.slopes.results import Side
from cad.step import rigid
from templates.core.arrays import Array
from templates.core.errors import InvalidInputs
from templates.core.units.units import unit

STEP = 2e-3  # relative to the value of the parameter
STEP_AT_ZERO = 0.01  # in the declared unit
_NEAR = 1e-3  # steps at which a side counts as open
_ROUNDING = 5e-9  # of a second difference: lengths of a model are rounded to 1e-9 mm

Draw = Callable[[CadModel], Sequence[Part]]


class PartDrawing(NamedTuple):
    """A part of a drawing: the carriers of its faces, its positions (m, 3, 4), its density [kg/m³]."""

    name: str
    carriers: Carriers
    places: Array
    density: float


class Drawing(NamedTuple):
    """The parts of a drawn model, and the corners of the box of the model [mm]."""

    parts: tuple[PartDrawing, ...]
    box: Array

    @property
    def form(self) -> list[tuple[str, tuple[int, ...], int]]:
        """Return what must be equal in comparable drawings."""
        return [(part.name, (*part.carriers.kinds.tolist(),), len(part.places)) for part in self.parts]

    @property
    def numbers(self) -> Array:
        """Return everything that may change with a parameter as one row."""
        rows = ((part.carriers.numbers.ravel(), part.places.ravel(), [part.density]) for part in self.parts)
        return np.concatenate([*(column for row in rows for column in row), self.box])

    def with_numbers(self, numbers: Array) -> Drawing:
        """Return a drawing of the same form with other numbers, or with their rates."""
        parts, start = [], 0
        for part in self.parts:
            faces, places = part.carriers.numbers, part.places
            middle, end = start + faces.size, start + faces.size + places.size
            carriers = Carriers(part.carriers.kinds, numbers[start:middle].reshape(faces.shape))
            moved = numbers[middle:end].reshape(places.shape)
            parts.append(PartDrawing(part.name, carriers, moved, float(numbers[end])))
            start = end + 1
        return Drawing(tuple(parts), numbers[start:])


def drawing(model: CadModel, draw: Draw) -> Drawing:
    """Return the drawing of a model."""
    parts = [
        PartDrawing(part.name, Carriers.of(faces_of(part.shape.wrapped)), _places(part), part.density)
        for part in draw(model)
    ]
    box = model.bounding_box()
    return Drawing(tuple(parts), np.array([*box.low, *box.high], dtype=float))


def faces_of(shape: TopoDS_Shape) -> list[TopoDS_Face]:
    """Return the faces of a shape, each once."""
    faces = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, TopAbs_ShapeEnum.TopAbs_FACE, faces)
    return [TopoDS.Face_s(faces.FindKey(n)) for n in range(1, faces.Extent() + 1)]


def _places(part: Part) -> Array:
    return np.array([np.column_stack(rigid(place)) for place in part.places])


@dataclass(frozen=True)
class Variation:
    """The rates of a drawing's numbers over one parameter [1/SI].

    Attributes
    ----------
    rates
        The rates if the parameter changes to either side, or to the only `side` where it can. None if it can
        change to neither.
    span
        The size of the parameter [SI]: its value, or its unit if that is 0.
    ends
        Rates below and above the value, where the two might differ.
    reason
        Why there are no rates, or none on one side.
    """

    rates: Array | None
    span: float = 1.0
    side: Side = "both"
    ends: tuple[Array, Array] | None = None
    reason: str = ""


def variation(model: CadModel, name: str, base: Drawing, draw: Draw) -> Variation:
    """Return how the numbers of a drawing change with one parameter, a single number."""
    si, at = model.inputs_si(), base.numbers
    value, step = float(si[name]), _step(model, name)
    seen: dict[float, Array | str] = {0: at}

    def beside(steps: float) -> Array | str:
        if steps not in seen:
            seen[steps] = _numbers(type(model), {**si, name: value + steps * step}, base, draw)
        return seen[steps]

    above, below = beside(2), beside(-2)
    if isinstance(above, str):
        return _one_sided(beside, -1, step)
    if isinstance(below, str):
        return _one_sided(beside, 1, step)
    far = (above - below) / (4 * step)
    if np.abs(bend := above + below - 2 * at).max(initial=0.0) <= _ROUNDING:
        return Variation(far)
    near_above, near_below = beside(1), beside(-1)
    if isinstance(near_above, str) or isinstance(near_below, str):
        return Variation(None, reason=f"near its value: {near_above or near_below}")
    rates = (4 * (near_above - near_below) / (2 * step) - far) / 3
    near = near_above + near_below - 2 * at
    has_kink = (np.abs(near) > 4 * _ROUNDING) & (np.abs(bend) < 3 * np.abs(near))
    if not has_kink.any():
        return Variation(rates)
    ends = (4 * near_below - below - 3 * at) / (-2 * step), (4 * near_above - above - 3 * at) / (2 * step)
    return Variation(rates, max(abs(value), step), ends=ends)


def _one_sided(beside: Callable[[float], Array | str], sign: int, step: float) -> Variation:
    """Return rates from values on one side, with an error of the fourth order in the step.

    They hold on both sides if the other side is closed only at some distance.
    """
    drawn = [beside(sign * n) for n in range(5)]
    values = [one for one in drawn if not isinstance(one, str)]
    closed = beside(-sign * _NEAR)
    if len(values) < len(drawn):
        return Variation(None, reason=_closed(beside))
    weights = (-25 / 12, 4, -3, 4 / 3, -1 / 4)
    rates = np.asarray(sum(w * v for w, v in zip(weights, values, strict=True)) / (sign * step))
    if not isinstance(closed, str):
        return Variation(rates)
    side: Side = "above" if sign > 0 else "below"
    return Variation(rates, side=side, reason=closed)


def _closed(beside: Callable[[float], Array | str]) -> str:
    """Return why a parameter can change to neither side."""
    reasons = {
        side: next(one for n in steps if isinstance(one := beside(n), str))
        for side, steps in (("below", (-2, -1, -3, -4)), ("above", (2, 1, 3, 4)))
    }
    below, above = reasons.values()
    return below if below == above else f"below: {below}; above: {above}"


def _step(model: CadModel, name: str) -> float:
    """Return the step [SI]: a round number of the declared unit, so that lengths stay on their grid."""
    scale = model.inputs[name].meaning.scale
    value = abs(float(scale.from_si(model.inputs_si()[name])))
    step = STEP * value if value > 0 else STEP_AT_ZERO
    return float(unit(model.inputs[name].meaning.unit).factor * _rounded(step))


def _rounded(step: float) -> float:
    """Return the nearest number below with one digit."""
    digit = 10.0 ** floor(log10(step))
    return floor(step / digit) * digit


def _numbers(cls: type[CadModel], si: Mapping[str, object], base: Drawing, draw: Draw) -> Array | str:
    """Return the numbers of a drawing with other parameters, or why it cannot be compared."""
    try:
        other = drawing(cls.from_si(si), draw)
    except InvalidInputs as error:
        return error.faults[0].detail
    except GeometryError as error:
        return error.detail
    return other.numbers if other.form == base.form else "the solid has other faces"
