"""The two views of a drawing: a section along the shaft (z), and the end view along z; all in millimetres.

The section plane is one of two planes through the shaft: one that is not a joint, and of these the one that
contains the axes of more cylinders, such as oil holes and pins. In the section z points right; beside it, in
first-angle projection, is the view from the left. Balls, shafts and round bars are not cut lengthwise (ISO
128-3): they are drawn whole, a shaft with its hidden lines.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from cadquery import Compound, Plane, Shape, Vector
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from OCP.HLRAlgo import HLRAlgo_Projector
from OCP.HLRBRep import HLRBRep_Algo, HLRBRep_HLRToShape

from cad.drafting.breaks import breaks, opened
from cad.drafting.curves import Curve, Point, Round, curves_of, joined
from cad.drafting.section import CLEAR, Arc, Cut, Frame, arc_of, cut_of, faces_across, half_behind, reach_of
from cad.step import Body
from cad.surfaces import Surface, X, Y, Z, look

_DRAWN = 100.0  # [mm], the size at which edges are hidden: of a part of 5 m the kernel takes 25 times as long
_LITTLE = 0.02  # of the depth on the other side: a smaller distance does not form a side of its own


@dataclass(frozen=True)
class View:
    """The lines and faces of one view."""

    frame: Frame
    visible: list[Curve]
    smooth: list[Curve]
    hidden: list[Curve]
    cut: list[Cut]
    arcs: list[Arc]
    edges: list[tuple[Point, Point]]  # straight ones of the section
    axes: list[tuple[Point, Point]] = field(default_factory=list)  # of holes that lie in the paper's plane
    broken: list[Curve] = field(default_factory=list)  # sides of broken-out sections

    @property
    def straight(self) -> list[tuple[Point, Point]]:
        """Return the visible straight lines by their ends."""
        return _straight(self.visible)

    @property
    def unseen(self) -> list[tuple[Point, Point]]:
        """Return the hidden straight lines by their ends."""
        return _straight(self.hidden)

    @property
    def box(self) -> tuple[Point, Point]:
        """Return the lower left and upper right corner of the drawn shape."""
        points = [point for curve in (*self.visible, *self.hidden) for point in curve.points]
        across, up = [x for x, _ in points], [y for _, y in points]
        return (min(across), min(up)), (max(across), max(up))

    @property
    def circles(self) -> list[Round]:
        """Return the visible and hidden circles, including arcs of at least half a turn."""
        turns: dict[tuple[float, ...], list[Round]] = {}
        for curve in (*self.visible, *self.hidden):
            if (arc := curve.arc) is not None:
                key = round(arc.centre[0], 3), round(arc.centre[1], 3), round(arc.radius, 3)
                turns.setdefault(key, []).append(arc)
        return [arcs[0] for arcs in turns.values() if sum(arc.turn for arc in arcs) > 179.9]


def _straight(curves: Sequence[Curve]) -> list[tuple[Point, Point]]:
    return [(c.points[0], c.points[-1]) for c in curves if c.arc is None and len(c.points) == 2]


def views(bodies: Sequence[Body], *, is_shaft: bool = False) -> tuple[View, View]:
    """Return the section and the end view; for a shaft, a side view replaces the section."""
    up = _upright(bodies)
    section, end = Frame(Z, up), Frame(Z.cross(up), up)
    placed = [
        _PlacedPart(part, body.shape.moved(place), is_shaft or _is_whole(body.shape))
        for part, body in enumerate(bodies)
        for place in body.places
    ]
    return _section(placed, section), _end(placed, end, section)


def is_assembly(bodies: Sequence[Body]) -> bool:
    """Return whether the bodies form an assembly: balls, bars or repeated parts with other parts."""
    whole = [_is_whole(body.shape) or len(body.places) > 1 for body in bodies]
    return any(whole) and not all(whole)


def _end(placed: Sequence[_PlacedPart], frame: Frame, section: Frame) -> View:
    """Return the view along the shaft, with broken-out sections at holes that the section does not show."""
    plane = Plane((0, 0, 0), frame.right, frame.towards)
    shapes = [one.shape for one in placed if not one.is_whole]
    normal = section.towards
    shown = [
        c.diameter
        for shape in shapes
        for c in look(shape).cylinders
        if abs(c.point.dot(normal)) < CLEAR and abs(c.direction.dot(normal)) < CLEAR
    ]
    cuts = breaks(shapes, plane, shown)
    reach = max((reach_of(shape) for shape in shapes), default=0.0)
    seen = _projected(
        [one.shape if one.is_whole else opened(one.shape, cuts, plane, reach) for one in placed], frame
    )
    faces = [
        cut_of(one.part, face, frame)
        for one in placed
        if not one.is_whole
        for cut in cuts
        for face in cut.faces(plane, one.shape)
    ]

    def is_side(curve: Curve) -> bool:
        return any(cut.bounds(curve) for cut in cuts)

    return replace(
        seen,
        axes=_axes_across(placed, frame),
        cut=faces,
        visible=[curve for curve in seen.visible if not is_side(curve)],
        hidden=[c for c in seen.hidden if not is_side(c) and not any(cut.holds(c) for cut in cuts)],
        broken=[curve for curve in seen.visible if is_side(curve)],
    )


def _axes_across(placed: Sequence[_PlacedPart], frame: Frame) -> list[tuple[Point, Point]]:
    """Return the axes of cylinders that are parallel to the paper, with their start and end."""
    axes = []
    for cylinder in (c for one in placed for c in look(one.shape).cylinders):
        if abs(cylinder.direction.dot(frame.towards)) < CLEAR:
            foot = cylinder.point - cylinder.direction * cylinder.point.dot(cylinder.direction)
            low, high = (frame.flat(foot + cylinder.direction * reach) for reach in cylinder.reach)
            axes.append((low, high))
    return axes


@dataclass(frozen=True)
class _PlacedPart:
    """A part at its position in the model; `is_whole` if a section does not cut it."""

    part: int
    shape: Shape
    is_whole: bool


def _is_ball(shape: Shape) -> bool:
    return all(face.geomType() == "SPHERE" for face in shape.Faces())


def _is_whole(shape: Shape) -> bool:
    """Return whether a part is not cut lengthwise: a ball, a bar or a bolt."""
    return _is_ball(shape) or _is_bar(shape) or _is_bolt(shape)


def _is_bolt(shape: Shape) -> bool:
    """Return whether a shape is a solid cylinder about z with a hexagon head."""
    seen = look(shape)
    return (len(seen.planes), len(seen.cylinders), len(seen.about(Z))) == (9, 1, 1)


def _is_bar(shape: Shape) -> bool:
    """Return whether a shape is a solid cylinder about the shaft, such as the journal of an assembly."""
    seen = look(shape)
    return (len(shape.Faces()), len(seen.planes), len(seen.about(Z))) == (3, 2, 1)


def _upright(bodies: Sequence[Body]) -> Vector:
    """Return the vertical axis of the section: the section plane contains it and the shaft."""
    seen = [look(body.shape.moved(place)) for body in bodies for place in body.places]
    cylinders = [c for one in seen for c in one.cylinders if not _surrounds(c)]
    planes = [plane for one in seen for plane in one.planes]

    def is_joint(normal: Vector) -> bool:
        return any(p.along(normal) and abs(p.point.dot(normal)) < CLEAR for p in planes)

    def held(normal: Vector) -> int:
        return sum(
            abs(c.point.dot(normal)) < CLEAR and abs(c.direction.dot(normal)) < CLEAR for c in cylinders
        )

    def area(normal: Vector) -> float:
        placed = (body.shape.moved(place) for body in bodies for place in body.places)
        return sum(face.Area() for shape in placed for face in faces_across(shape, normal))

    def parts(normal: Vector) -> bool:
        """Return whether there is material on both sides of the plane."""
        sides = [_sides(body.shape.moved(place), normal) for body in bodies for place in body.places]
        depths = sorted((-min(low for low, _ in sides), max(high for _, high in sides)))
        return depths[0] > max(CLEAR, _LITTLE * depths[1])

    def worth(up: Vector) -> tuple[bool, bool, int, float]:
        normal = up.cross(Z)
        return parts(normal), not is_joint(normal), held(normal), round(area(normal), 6)

    return max((Y, X), key=worth)


def _surrounds(cylinder: Surface) -> bool:
    """Return whether the shaft's axis runs inside a cylinder, such as a bore or a joint relief."""
    return cylinder.along(Z) and cylinder.point.cross(Z).Length < cylinder.diameter / 2


def _sides(shape: Shape, normal: Vector) -> tuple[float, float]:
    """Return the smallest and largest coordinate of a shape along an axis normal to a plane."""
    box = shape.BoundingBox()
    corners = Vector(box.xmin, box.ymin, box.zmin), Vector(box.xmax, box.ymax, box.zmax)
    low, high = sorted(corner.dot(normal) for corner in corners)
    return low, high


def _section(placed: Sequence[_PlacedPart], frame: Frame) -> View:
    """Return the section: cut faces, shapes behind the plane, and uncut parts."""
    sections = [(one, face) for one in placed for face in faces_across(one.shape, frame.towards)]
    faces = [face for _, face in sections]
    behind = [shape for one in placed for shape in _seen(one, frame.towards)]
    view = _projected(behind or [one.shape for one in placed], frame)  # a part beside the plane is seen whole
    cuts = [cut_of(one.part, face, frame) for one, face in sections if not one.is_whole]
    edges = [edge for face in faces for edge in face.Edges()]
    straight = [
        (frame.flat(e.startPoint()), frame.flat(e.endPoint())) for e in edges if e.geomType() == "LINE"
    ]
    arcs = [arc_of(edge, frame) for edge in edges if edge.geomType() == "CIRCLE"]
    hidden = view.hidden if all(one.is_whole for one in placed) else []
    return View(frame, view.visible, view.smooth, hidden, cuts, arcs, straight)


def _seen(one: _PlacedPart, normal: Vector) -> list[Shape]:
    """Return the visible remainder of a part: the half behind the plane, or all of an uncut part."""
    if not one.is_whole:
        return half_behind(one.shape, normal)
    return [one.shape] if _sides(one.shape, normal)[0] < -CLEAR else []


def _projected(shapes: Sequence[Shape], frame: Frame) -> View:
    """Return the visible and the hidden edges of shapes."""
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
        curves_of(some, 1 / shrunk)
        for some in (
            (edges.VCompound(), edges.OutLineVCompound()),
            (edges.Rg1LineVCompound(),),
            (edges.HCompound(), edges.OutLineHCompound()),
        )
    )
    visible = joined(visible)
    return View(frame, visible, joined(smooth, visible), joined(hidden, visible), [], [], [])
