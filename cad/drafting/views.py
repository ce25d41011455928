"""The two views of a drawing: a section along the shaft (z), and the end seen along it; all in millimetres.

Of the two planes through the shaft that is cut which holds the axes of more cylinders: an oil hole, a pin. In
the section z points right; beside it, in first-angle projection, stands the view from the left.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import hypot

import numpy as np
from cadquery import Compound, Edge, Face, Shape, Solid, Vector
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from OCP.HLRAlgo import HLRAlgo_Projector
from OCP.HLRBRep import HLRBRep_Algo, HLRBRep_HLRToShape

from cad.drawing import lines_of
from cad.inspect import look_at
from cad.step import Body
from cad.surfaces import X, Y, Z

Point = tuple[float, float]
Polyline = list[Point]

_DRAWN = 100.0  # [mm], the size at which edges are hidden: of a part of 5 m the kernel takes 25 times as long
_TURN = 0.05  # [rad] between two pieces of a curve
_CLEAR = 1e-5  # [mm]; boxes of the kernel are good to some 1e-7


@dataclass(frozen=True)
class Frame:
    """Directions of space on the paper: right and up in a view, and towards the eye."""

    right: Vector
    up: Vector

    @property
    def towards(self) -> Vector:
        """From the paper to the eye."""
        return self.right.cross(self.up)

    def flat(self, point: Vector) -> Point:
        """A point of space on the paper."""
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
    """A cut face: its outlines, holes among them, and of which part it is."""

    part: int
    outlines: list[Polyline]


@dataclass(frozen=True)
class View:
    """The lines and faces of one view."""

    frame: Frame
    visible: list[Polyline]
    smooth: list[Polyline]
    hidden: list[Polyline]
    cut: list[Cut]
    arcs: list[Arc]
    edges: list[tuple[Point, Point]]  # straight ones of the section

    @property
    def box(self) -> tuple[Point, Point]:
        """Lower left and upper right corner of what is drawn."""
        points = np.array([p for line in (*self.visible, *self.hidden) for p in line])
        (left, low), (right, high) = points.min(axis=0), points.max(axis=0)
        return (float(left), float(low)), (float(right), float(high))


def views(bodies: Sequence[Body]) -> tuple[View, View]:
    """Section and end view."""
    up = _upright(bodies)
    section, end = Frame(Z, up), Frame(Z.cross(up), up)
    shapes = [body.shape.moved(place) for body in bodies for place in body.places]
    parts = [part for part, body in enumerate(bodies) for _ in body.places]
    return _section(shapes, parts, section), _projected(shapes, end)


def _upright(bodies: Sequence[Body]) -> Vector:
    """The axis across the shaft whose plane with the shaft is cut."""
    seen = look_at(bodies).values()
    cylinders = [c for one in seen for c in one.cylinders if not c.about(Z)]

    def held(normal: Vector) -> int:
        return sum(
            abs(c.point.dot(normal)) < _CLEAR and abs(c.direction.dot(normal)) < _CLEAR for c in cylinders
        )

    def area(normal: Vector) -> float:
        placed = (body.shape.moved(place) for body in bodies for place in body.places)
        return sum(face.Area() for shape in placed for face in _cut(shape, normal))

    def parts(normal: Vector) -> bool:
        """Whether there is material on both sides: a half shell ends in its joint."""
        sides = [_sides(body.shape.moved(place), normal) for body in bodies for place in body.places]
        return min(low for low, _ in sides) < -_CLEAR and max(high for _, high in sides) > _CLEAR

    def worth(up: Vector) -> tuple[bool, int, float]:
        normal = up.cross(Z)
        return parts(normal), held(normal), round(area(normal), 6)

    return max((Y, X), key=worth)


def _sides(shape: Shape, normal: Vector) -> tuple[float, float]:
    """The reach of a shape against a normal along an axis, and with it."""
    box = shape.BoundingBox()
    corners = Vector(box.xmin, box.ymin, box.zmin), Vector(box.xmax, box.ymax, box.zmax)
    low, high = sorted(corner.dot(normal) for corner in corners)
    return low, high


def _section(shapes: Sequence[Shape], parts: Sequence[int], frame: Frame) -> View:
    """The half behind the plane, and the faces that the plane cuts."""
    sections = [
        (part, face) for part, shape in zip(parts, shapes, strict=True) for face in _cut(shape, frame.towards)
    ]
    faces = [face for _, face in sections]
    behind = [half for shape in shapes for half in _behind(shape, frame.towards)]
    view = _projected(behind or shapes, frame)  # a part beside the plane is seen whole
    outlines = [
        Cut(part, [_polyline(wire.Edges(), frame) for wire in _wires(face)]) for part, face in sections
    ]
    edges = [edge for face in faces for edge in face.Edges()]
    straight = [
        (frame.flat(e.startPoint()), frame.flat(e.endPoint())) for e in edges if e.geomType() == "LINE"
    ]
    arcs = [_arc(edge, frame) for edge in edges if edge.geomType() == "CIRCLE"]
    return View(frame, view.visible, view.smooth, [], outlines, arcs, straight)


def _wires(face: Face) -> list[Shape]:
    return [face.outerWire(), *face.innerWires()]


def _reach(shape: Shape) -> float:
    box = shape.BoundingBox()
    sides = (box.xmin, box.xmax, box.ymin, box.ymax, box.zmin, box.zmax)
    return 2.5 * max(abs(side) for side in sides)


def _cut(shape: Shape, normal: Vector) -> list[Face]:
    """The faces in which a plane through the origin cuts a shape."""
    size = _reach(shape)
    plane = Face.makePlane(2 * size, 2 * size, Vector(0, 0, 0), normal)
    return list(plane.intersect(shape).Faces())


def _behind(shape: Shape, normal: Vector) -> list[Shape]:
    """The parts of a shape behind a plane through the origin."""
    size = _reach(shape)
    low = Vector(-size, -size, -size) + normal * -size
    box = Solid.makeBox(2 * size, 2 * size, 2 * size, low)
    return list(shape.intersect(box).Solids())


def _projected(shapes: Sequence[Shape], frame: Frame) -> View:
    """The edges of shapes as they are seen, with those that are hidden."""
    toward, right = frame.towards, frame.right
    eye = gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(*toward.toTuple()), gp_Dir(*right.toTuple()))
    whole = Compound.makeCompound(shapes)
    shrunk = _DRAWN / whole.BoundingBox().DiagonalLength
    algorithm = HLRBRep_Algo()
    algorithm.Add(whole.scale(shrunk).wrapped)
    algorithm.Projector(HLRAlgo_Projector(eye))
    algorithm.Update()
    algorithm.Hide()
    edges = HLRBRep_HLRToShape(algorithm)
    visible, smooth, hidden = (
        [[(x / shrunk, -y / shrunk) for x, y in line] for line in lines_of(some)]
        for some in (
            (edges.VCompound(), edges.OutLineVCompound()),
            (edges.Rg1LineVCompound(),),
            (edges.HCompound(), edges.OutLineHCompound()),
        )
    )
    return View(frame, visible, smooth, hidden, [], [], [])


def _polyline(edges: Sequence[Edge], frame: Frame) -> Polyline:
    """The edges of a closed wire as one line; edges come in any order and direction."""
    pieces = [_points(edge, frame) for edge in edges]
    line = pieces.pop(0)
    while pieces:
        end = line[-1]
        nearest = min(pieces, key=lambda piece: min(_apart(end, piece[0]), _apart(end, piece[-1])))
        pieces.remove(nearest)
        line += nearest if _apart(end, nearest[0]) <= _apart(end, nearest[-1]) else nearest[::-1]
    return line


def _apart(one: Point, other: Point) -> float:
    return hypot(one[0] - other[0], one[1] - other[1])


def _points(edge: Edge, frame: Frame) -> Polyline:
    if edge.geomType() == "LINE":
        return [frame.flat(edge.startPoint()), frame.flat(edge.endPoint())]
    turn = edge.Length() / edge.radius() if edge.geomType() == "CIRCLE" else 2 * np.pi
    steps = max(8, int(turn / _TURN))
    return [frame.flat(edge.positionAt(i / steps)) for i in range(steps + 1)]


def _arc(edge: Edge, frame: Frame) -> Arc:
    whole = bool(edge.startPoint().sub(edge.endPoint()).Length < _CLEAR)
    return Arc(frame.flat(edge.arcCenter()), edge.radius(), frame.flat(edge.positionAt(0.5)), whole)


def hatch(
    outlines: Sequence[Polyline], apart: float, *, falling: bool = False
) -> Iterator[tuple[Point, Point]]:
    """Lines at 45° within closed outlines; holes among them stay empty."""
    turn = np.array([[1.0, 1.0], [-1.0, 1.0]]) / np.sqrt(2)  # what slopes becomes level
    turned = [np.asarray(line) * ([-1, 1] if falling else [1, 1]) @ turn.T for line in outlines]
    low = min(line[:, 1].min() for line in turned)
    high = max(line[:, 1].max() for line in turned)
    for level in np.arange(np.floor(low / apart) + 0.5, high / apart) * apart:
        crossings = sorted(x for line in turned for x in _crossings(line, level))
        for left, right in zip(crossings[::2], crossings[1::2], strict=False):
            ends = np.array([[left, level], [right, level]]) @ turn * ([-1, 1] if falling else [1, 1])
            yield (float(ends[0, 0]), float(ends[0, 1])), (float(ends[1, 0]), float(ends[1, 1]))


def _crossings(line: np.ndarray, level: float) -> list[float]:
    start, end = line, np.roll(line, -1, axis=0)
    across = (start[:, 1] > level) != (end[:, 1] > level)
    a, b = start[across], end[across]
    return list(a[:, 0] + (level - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0]))
