"""Cut shapes by a plane: the faces in the plane, the solids behind it, and their edges on paper."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, degrees

from cadquery import BoundBox, Edge, Face, Shape, Solid, Vector

from cad.drafting.curves import Curve, Point, Round, Vertex, outline, recognised, rounded

_TURN = 0.05  # [rad] between two points of a curve
CLEAR = 1e-5  # [mm]; boxes of the kernel are good to some 1e-7


@dataclass(frozen=True)
class Frame:
    """The directions in space that point right and up in a view, and towards the viewer."""

    right: Vector
    up: Vector

    @property
    def towards(self) -> Vector:
        """Return the unit vector from the paper towards the viewer."""
        return self.right.cross(self.up)

    def flat(self, point: Vector) -> Point:
        """Return the projection of a point in space onto the paper."""
        return point.dot(self.right), point.dot(self.up)


@dataclass(frozen=True)
class Arc:
    """A circular edge of a section."""

    centre: Point
    radius: float
    middle: Point
    whole: bool


@dataclass(frozen=True)
class Cut:
    """A cut face: its outlines, the outer one first and then the holes, and the number of its part."""

    part: int
    outlines: list[list[Vertex]]


def cut_of(part: int, face: Face, frame: Frame) -> Cut:
    """Return a cut face of a part, projected onto the paper."""
    wires = face.outerWire(), *face.innerWires()
    return Cut(part, [outline([curve_of(edge, frame) for edge in wire.Edges()]) for wire in wires])


def reach_of(shape: Shape) -> float:
    """Return a size [mm] for planes and boxes that are to contain a shape and the origin."""
    box = BoundBox._fromTopoDS(shape.wrapped, None, False)  # loose, a hundred times as fast
    sides = (box.xmin, box.xmax, box.ymin, box.ymax, box.zmin, box.zmax)
    return 2.5 * float(max(abs(side) for side in sides))


def faces_across(shape: Shape, normal: Vector) -> list[Face]:
    """Return the faces in which a plane through the origin cuts a shape."""
    size = reach_of(shape)
    plane = Face.makePlane(2 * size, 2 * size, Vector(0, 0, 0), normal)
    return list(plane.intersect(shape).Faces())


def half_behind(shape: Shape, normal: Vector) -> list[Shape]:
    """Return the parts of a shape behind a plane through the origin."""
    size = reach_of(shape)
    low = Vector(-size, -size, -size) + normal * -size
    box = Solid.makeBox(2 * size, 2 * size, 2 * size, low)
    return list(shape.intersect(box).Solids())


def curve_of(edge: Edge, frame: Frame) -> Curve:
    """Return an edge of a cut face as a curve on the paper."""
    if edge.geomType() == "LINE":
        return Curve([frame.flat(edge.startPoint()), frame.flat(edge.endPoint())])
    if edge.geomType() == "CIRCLE":
        return _round(edge, frame)
    steps = max(8, int(6.3 / _TURN))
    return recognised([frame.flat(edge.positionAt(i / steps)) for i in range(steps + 1)])


def _round(edge: Edge, frame: Frame) -> Curve:
    """Return a circular edge in the plane of the paper as a curve."""
    centre, radius = frame.flat(edge.arcCenter()), edge.radius()
    turn = min(degrees(edge.Length() / radius), 360.0)
    begin, middle, end = (frame.flat(edge.positionAt(share)) for share in (0.0, 0.25, 1.0))
    is_counter = (begin[0] - centre[0]) * (middle[1] - centre[1]) > (begin[1] - centre[1]) * (
        middle[0] - centre[0]
    )
    first = begin if is_counter else end
    start = degrees(atan2(first[1] - centre[1], first[0] - centre[0]))
    return rounded(Round(centre, radius, start, 360.0 if turn > 360 - 1e-6 else turn))


def arc_of(edge: Edge, frame: Frame) -> Arc:
    """Return a circular edge of a section."""
    whole = bool(edge.startPoint().sub(edge.endPoint()).Length < CLEAR)
    return Arc(frame.flat(edge.arcCenter()), edge.radius(), frame.flat(edge.positionAt(0.5)), whole)
