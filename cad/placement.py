"""The position of a fixed part in an assembly: relative to a datum, shifted along and rotated about its axes.

A datum is `origin`, the axes of the assembly, or a part and a place on it, such as `cap.low_y`:

- `low_x`, `high_x`, … `high_z`: the middle of that side of the part's box, z pointing out of the part;
- `centre`: the middle of the box, with the axes of the assembly;
- `axis_1`, `axis_2`, …: the axes of the part's cylinders, in ascending order of x, then y, then z of their
  point nearest to the middle of the box; that point is the origin, and z points along the axis.

The x axis of a datum is the axis of the assembly that is most nearly perpendicular to the datum's z axis; of
several equally near axes, the first.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from cadquery import Location, Plane, Vector

from cad.errors import GeometryError
from cad.inspect import bounding_box
from cad.model import Box, Part
from cad.step import Body
from cad.surfaces import AXES, X, Y, Z, look

ORIGIN = "origin"
_SIDE = re.compile(r"(low|high)_([xyz])")
_AXIS = re.compile(r"axis_([1-9][0-9]{0,3})")
_DIGITS = 6  # decimals [mm] to which points of axes are compared


@dataclass(frozen=True)
class Place:
    """Shifts [mm] along the axes of a datum, applied after rotations [deg] about x first, then y, then z."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    turn_x: float = 0.0
    turn_y: float = 0.0
    turn_z: float = 0.0

    @property
    def motion(self) -> Location:
        """Return the position as a CadQuery location."""
        moved = Location(Vector(self.x, self.y, self.z))
        for axis, angle in ((Z, self.turn_z), (Y, self.turn_y), (X, self.turn_x)):
            if angle:
                moved = moved * Location(Vector(), axis, angle)
        return moved


def frame_of(name: str, datum: str, parts: Mapping[str, Part]) -> Location:
    """Return the frame of the datum of a component, among the parts that are already placed.

    Raises
    ------
    GeometryError
        `datum`, naming the available parts or places.
    """
    if datum == ORIGIN:
        return Location()
    part_name, _, place = datum.rpartition(".")
    part = parts.get(part_name)
    if part is None:
        raise _no_datum(
            name, f"no earlier part is named {part_name!r}; the earlier parts are {', '.join(parts)}"
        )
    box = box_of([part.solid.moved(part.places[0])])
    middle = Vector(*((low + high) / 2 for low, high in zip(box.low, box.high, strict=True)))
    if place == "centre":
        return Location(middle)
    if side := _SIDE.fullmatch(place):
        axis = AXES[side[2]]
        corner = Vector(*(box.high if side[1] == "high" else box.low))
        on_side = middle + axis * (corner - middle).dot(axis)
        return _frame(on_side, axis if side[1] == "high" else -axis)
    if numbered := _AXIS.fullmatch(place):
        axes = _axes_of(part, middle)
        if int(numbered[1]) > len(axes):
            raise _no_datum(name, f"{part_name} has {len(axes)} cylinder axes, so there is no {place}")
        return _frame(*axes[int(numbered[1]) - 1])
    raise _no_datum(name, f"{place!r} is not one of low_x, high_x, …, high_z, centre, axis_1, axis_2, …")


def box_of(solids: Sequence[object]) -> Box:
    """Return the bounding box of solids at their positions [mm]."""
    return bounding_box(Body("", solid, (0.0, 0.0, 0.0), (Location(),)) for solid in solids)  # type: ignore[arg-type]


def _axes_of(part: Part, middle: Vector) -> list[tuple[Vector, Vector]]:
    """Return each distinct axis: its point nearest to the middle of the part's box, and its direction."""
    axes = dict[tuple[float, ...], tuple[Vector, Vector]]()
    for cylinder in look(part.solid.moved(part.places[0])).cylinders:
        along = _forward(cylinder.direction)
        point = cylinder.point + along * (middle - cylinder.point).dot(along)
        key = tuple(round(number, _DIGITS) + 0.0 for number in (*point.toTuple(), *along.toTuple()))
        axes.setdefault(key, (point, along))
    return [axes[key] for key in sorted(axes)]


def _forward(direction: Vector) -> Vector:
    """Return a direction or its opposite, whichever has a positive largest component."""
    components = direction.toTuple()
    largest = max(components, key=lambda number: round(abs(number), _DIGITS))
    return direction if largest > 0 else -direction


def _frame(origin: Vector, along: Vector) -> Location:
    flat = min((X, Y, Z), key=lambda axis: round(abs(axis.dot(along)), _DIGITS))
    flat = (flat - along * flat.dot(along)).normalized()
    return Plane(origin, flat, along).location


def _no_datum(name: str, detail: str) -> GeometryError:
    return GeometryError("datum", f"{name}: {detail}")
