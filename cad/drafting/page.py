"""Draw views, centre lines, section marks, dimensions and symbols as DXF entities."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, degrees, dist, pi, remainder, sqrt
from typing import Any

from ezdxf import units
from ezdxf.document import Drawing
from ezdxf.entities.text import Text
from ezdxf.filemanagement import new

from cad.drafting.breaks import zigzag
from cad.drafting.curves import Curve, Point
from cad.drafting.dimension_layout import ASIDE, EXTENSION, GAP, PlacedDimension
from cad.drafting.labels import TEXT
from cad.drafting.plan import Plan
from cad.drafting.symbols import Symbol, arrow
from cad.drafting.views import View

APP = "CRANKWRIGHT"
STYLE = "CRANKWRIGHT"

_HATCH = 2.5  # from line to line [mm on paper]
_ANSI31 = 3.175  # from line to line of the pattern of that name [mm]
_LAYERS = {
    "OUTLINE": (7, 50, "CONTINUOUS"),
    "SMOOTH": (8, 18, "CONTINUOUS"),
    "HIDDEN": (8, 25, "DASHED"),
    "CENTRE": (1, 18, "CENTER"),
    "CUTTING": (7, 70, "CONTINUOUS"),
    "BREAK": (7, 18, "CONTINUOUS"),
    "HATCH": (8, 13, "CONTINUOUS"),
    "DIMENSIONS": (5, 18, "CONTINUOUS"),
    "SYMBOLS": (7, 25, "CONTINUOUS"),
    "FRAME": (7, 35, "CONTINUOUS"),
    "TEXT": (7, 25, "CONTINUOUS"),
}  # colour, line weight [1/100 mm], line type


def document_of(plan: Plan) -> Drawing:
    """Return an empty drawing with layers and styles."""
    document = new("R2010", setup=["linetypes"], units=units.MM)
    document.header["$LTSCALE"] = 0.35 / plan.scale
    document.appids.add(APP)
    for name, (colour, weight, line) in _LAYERS.items():
        document.layers.add(name, color=colour, lineweight=weight, linetype=line)
    document.styles.add(STYLE, font="isocpeur.ttf")
    style = document.dimstyles.add(STYLE)
    sizes = {
        "dimtxt": TEXT,
        "dimasz": 3.0,
        "dimexe": EXTENSION,
        "dimexo": 0.8,
        "dimgap": GAP,
        "dimscale": 1 / plan.scale,
    }
    words = {
        "dimtad": 1,
        "dimdec": 3,
        "dimzin": 8,
        "dimadec": 2,
        "dimazin": 2,
        "dimdsep": ord("."),
        "dimtxsty": STYLE,
    }
    for name, value in {**sizes, **words, "dimtih": 0, "dimtoh": 0, "dimlfac": 1.0, "dimclrt": 7}.items():
        style.set_dxf_attrib(name, value)
    return document


class Page:
    """Draws the entities of a sheet; positions on the paper are in millimetres from its lower left corner."""

    def __init__(self, document: Drawing, plan: Plan) -> None:
        self.document = document
        self.space: Any = document.modelspace()
        self.plan = plan

    def view(self, view: View, right: float) -> None:
        """Draw the lines and the cut faces of a view, moved to the right."""
        for layer, curves in (("HIDDEN", view.hidden), ("SMOOTH", view.smooth), ("OUTLINE", view.visible)):
            for curve in curves:
                self._curve(curve, right, layer)
        for side in view.broken:
            points = [(x + right, y) for x, y in zigzag(side.points, self.plan.scale)]
            self.space.add_lwpolyline(points, dxfattribs={"layer": "BREAK"})
        scale = _HATCH / self.plan.scale / _ANSI31
        line = [[45.0, (0.0, 0.0), (-_ANSI31 / sqrt(2), _ANSI31 / sqrt(2)), []]]
        for cut in view.cut:
            hatch = self.space.add_hatch(dxfattribs={"layer": "HATCH"})
            angle = 90.0 * (cut.part % 2)
            hatch.set_pattern_fill("ANSI31", color=256, angle=angle, scale=scale, definition=line)
            for number, outline in enumerate(cut.outlines):
                flags = 1 if number == 0 else 16  # the outermost, and holes in it
                hatch.paths.add_polyline_path([(x + right, y, b) for x, y, b in outline], flags=flags)

    def _curve(self, curve: Curve, right: float, layer: str) -> None:
        attributes = {"layer": layer}
        if (arc := curve.arc) is None:
            points = [(x + right, y) for x, y in curve.points]
            if len(points) == 2:
                self.space.add_line(*points, dxfattribs=attributes)
            else:
                self.space.add_lwpolyline(points, dxfattribs=attributes)
            return
        centre = arc.centre[0] + right, arc.centre[1]
        if arc.is_whole:
            self.space.add_circle(centre, arc.radius, dxfattribs=attributes)
        else:
            start = arc.start % 360
            self.space.add_arc(centre, arc.radius, start, start + arc.turn, dxfattribs=attributes)

    def centres(self, lines: Sequence[tuple[Point, Point]], circles: Sequence[tuple[Point, float]]) -> None:
        """Draw centre lines and pitch circles."""
        for one, other in lines:
            self.space.add_line(one, other, dxfattribs={"layer": "CENTRE"})
        for centre, radius in circles:
            self.space.add_circle(centre, radius, dxfattribs={"layer": "CENTRE"})

    def dimension(self, placed: PlacedDimension) -> None:
        """Draw a dimension at its position, and attach the name of its parameter."""
        override = self._drawn(placed)
        override.dimension.dxf.layer = "DIMENSIONS"
        override.render()
        if placed.leader:
            self._led(override.dimension, placed)
        if placed.dimension.name:
            override.dimension.set_xdata(APP, [(1000, placed.dimension.name)])

    def _drawn(self, placed: PlacedDimension) -> Any:
        """Return a DIMENSION entity of the right kind."""
        measure, base = placed.dimension.measure, placed.base
        points: Any = [(x + placed.right, y) for x, y in measure.points]
        style: Any = {"text": placed.label.mtext, "dimstyle": STYLE}
        level: Any = {**style, "override": {"dimtih": 1, "dimtoh": 1}}
        match measure.form:
            case "across" | "up":
                along = int(measure.form == "up")
                one, other = sorted(points, key=lambda point: point[along])
                drawn = self.space.add_linear_dim(base, one, other, angle=90 * along, **style)
                if placed.words is not None:
                    drawn.set_location(placed.words)
                    self._line_under(placed, along)
                return drawn
            case "aligned":
                drawn = self.space.add_aligned_dim(*sorted(points), -ASIDE / self.plan.scale, **style)
                drawn.dimension.dxf.text_rotation = 0.0
                drawn.set_location(placed.words, leader=True)
                return drawn
            case "circle":
                return self.space.add_diameter_dim(
                    points[0], radius=measure.value / 2, location=base, **level
                )
            case "arc":
                return self.space.add_radius_dim(points[0], radius=measure.value, location=base, **level)
        if placed.words is None:
            return self.space.add_angular_dim_3p(base, *_counter_clockwise(points), **style)
        free: Any = {**style, "override": {"dimtmove": 2}}  # its words do not move the arc
        drawn = self.space.add_angular_dim_3p(base, *_counter_clockwise(points), **free)
        drawn.set_location(placed.words)
        self._arc_under(placed, points)
        return drawn

    def _led(self, dimension: Any, placed: PlacedDimension) -> None:
        """Draw an arc's or circle's dimension as a leader with its words, in place of what ezdxf draws.

        Ezdxf lets a leader neither come across the centre of an arc, nor end with the words above it.
        """
        assert placed.leader
        assert placed.words
        _, bend, end = (self.plan.at(*point) for point in placed.leader)
        block = dimension.get_geometry_block()
        block.delete_all_entities()
        drawn = arrow(placed.leader[0], placed.leader[1])
        for line in drawn.lines:
            block.add_line(*(self.plan.at(*point) for point in line))
        for corners in drawn.filled:
            block.add_solid([self.plan.at(*point) for point in corners])
        block.add_line(bend, end)
        text = placed.label.text.replace("<>", placed.label.number)
        style = {"style": STYLE, "char_height": TEXT / self.plan.scale, "attachment_point": 5, "color": 7}
        block.add_mtext(text, dxfattribs={**style, "insert": placed.words})
        dimension.dxf.text_midpoint = placed.words

    def _line_under(self, placed: PlacedDimension, along: int) -> None:
        """Extend a dimension line below a text that stands beyond its end."""
        assert placed.ends is not None
        assert placed.words is not None
        half = placed.label.width(TEXT) / 2
        middle = self.plan.paper(placed.words)[along]
        ends = sorted(end[along] for end in placed.ends)
        if ends[0] <= middle <= ends[1]:
            return
        place = placed.ends[0][1 - along]
        span = (ends[1], middle + half) if middle > ends[1] else (middle - half, ends[0])
        self.line([(place, at) if along else (at, place) for at in span], "DIMENSIONS")

    def _arc_under(self, placed: PlacedDimension, points: Sequence[Point]) -> None:
        """Extend the arc of an angle below its text, from the nearer leg."""
        assert placed.words is not None
        corner = points[0]
        radius = dist(corner, placed.base)
        at, *legs = (atan2(y - corner[1], x - corner[0]) for x, y in (placed.words, *points[1:]))
        half = placed.label.width(TEXT) / 2 / self.plan.scale / radius
        offsets = [remainder(leg - at, 2 * pi) for leg in legs]  # from the text to each leg
        nearer = min(offsets, key=abs)
        start, stop = (at - half, at + nearer) if nearer > 0 else (at + nearer, at + half)
        self.space.add_arc(corner, radius, degrees(start), degrees(stop), dxfattribs={"layer": "DIMENSIONS"})

    def symbol(self, symbol: Symbol, layer: str = "SYMBOLS") -> None:
        """Draw a symbol on the paper."""
        attributes = {"layer": layer}
        for line in symbol.lines:
            self.space.add_lwpolyline([self.plan.at(*p) for p in line], dxfattribs=attributes)
        for line in symbol.centres:
            self.space.add_lwpolyline([self.plan.at(*p) for p in line], dxfattribs={"layer": "CENTRE"})
        for centre, radius in symbol.circles:
            self.space.add_circle(self.plan.at(*centre), radius / self.plan.scale, dxfattribs=attributes)
        for corners in symbol.filled:
            self.space.add_solid([self.plan.at(*p) for p in corners], dxfattribs=attributes)

    def line(self, points: Sequence[Point], layer: str) -> None:
        """Draw a line on the paper."""
        self.space.add_lwpolyline([self.plan.at(*p) for p in points], dxfattribs={"layer": layer})

    def write(self, text: str, x: float, y: float, size: float) -> Text:
        """Write a line of text on the paper; return its entity."""
        attributes = {"layer": "TEXT", "style": STYLE, "height": size / self.plan.scale}
        written: Text = self.space.add_text(text, dxfattribs={**attributes, "insert": self.plan.at(x, y)})
        return written


def _counter_clockwise(points: Sequence[Point]) -> tuple[Point, Point, Point]:
    """Return the corner and legs of an angle below 180°, with the legs in counter-clockwise order."""
    corner, one, other = points
    cross = (one[0] - corner[0]) * (other[1] - corner[1]) - (one[1] - corner[1]) * (other[0] - corner[0])
    return (corner, one, other) if cross >= 0 else (corner, other, one)
