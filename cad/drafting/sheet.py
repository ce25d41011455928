"""A drawing on its sheet as DXF: views, dimensions, table of parameters and title block, all in millimetres.

The section stands at its true coordinates, everything is drawn 1:1, and the A3 sheet around it is as large as
the scale requires; so a DIMENSION measures what the part measures. Each carries the name of its parameter.
"""

from __future__ import annotations

import io
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from math import atan2, cos, pi, sin
from typing import Any

from ezdxf import units
from ezdxf._options import options
from ezdxf.document import Drawing
from ezdxf.entities.text import Text
from ezdxf.filemanagement import new

from cad.drafting.lanes import Lanes
from cad.drafting.matching import Dimension, matched, references
from cad.drafting.measures import Measure, measures
from cad.drafting.standing import standing
from cad.drafting.views import Point, Polyline, View, hatch, views
from cad.header import Header
from cad.stamp import BLOCK, MARK, line_of
from cad.step import Body

SHEET = (420.0, 297.0)  # A3 [mm]
APP = "CRANKWRIGHT"
STYLE = "CRANKWRIGHT"
TEXT = 3.5  # height of letters [mm on paper]

_LEFT, _EDGE = 20.0, 10.0  # margins (ISO 5457)
_COLUMN = 104.0  # of table and title block
_TITLE = 64.0  # height of the title block
_ROOM = 24.0  # around and between views, beside the dimensions
_ROW = 7.5  # from one line of the title block to the next
_LANE = 9.0  # from one dimension line to the next
_HATCH = 2.5
_SCALES = [f * 10.0**n for n in range(3, -4, -1) for f in (5, 2, 1)]
_LAYERS = {
    "OUTLINE": (7, 50, "CONTINUOUS"),
    "SMOOTH": (8, 18, "CONTINUOUS"),
    "HIDDEN": (8, 25, "DASHED"),
    "CENTRE": (1, 18, "CENTER"),
    "HATCH": (8, 13, "CONTINUOUS"),
    "DIMENSIONS": (5, 18, "CONTINUOUS"),
    "FRAME": (7, 35, "CONTINUOUS"),
    "TEXT": (7, 25, "CONTINUOUS"),
}  # colour, line weight [1/100 mm], line type


def write_dxf(bodies: Sequence[Body], header: Header | None) -> bytes:
    """A dimensioned drawing; equal bodies and headers give equal bytes."""
    stream = io.StringIO()
    with _no_times():
        document = draw(bodies, header)
        _register_classes(document)
        document.write(stream)
    return stream.getvalue().encode()


def _register_classes(document: Drawing) -> None:
    """List the classes in one order; ezdxf itself would walk a set, whose order differs by process."""
    for name in sorted(document.entitydb.dxf_types_in_use()):
        document.classes.add_class(name)


@contextmanager
def _no_times() -> Iterator[None]:
    """Let ezdxf write neither times nor random ids."""
    kept = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = kept


def draw(bodies: Sequence[Body], header: Header | None) -> Drawing:
    """The drawing as a document of ezdxf."""
    section, end = views(bodies)
    seen = [*measures(bodies, section, end), *standing(bodies, section, end)]
    parameters = header.parameters if header else {}
    matches, unseen = matched(parameters, seen)
    plan = Plan.of(section, end, [*matches, *references(matches, seen)])
    document = _document(plan)
    page = Page(document, plan)
    page.view(section, 0.0)
    page.view(end, plan.beside)
    page.centres(section, end)
    page.dimensions()
    page.frame()
    page.words(header, parameters, unseen)
    return document


@dataclass(frozen=True)
class Plan:
    """Size of the drawing and places of its pieces, in the coordinates of the section."""

    scale: float  # of the paper: mm on paper for each mm of the part
    beside: float  # by how much the end view is moved to the right
    corner: Point  # lower left corner of the sheet
    lanes: Lanes

    @staticmethod
    def of(section: View, end: View, wanted: Iterable[Dimension]) -> Plan:
        """The largest common scale at which everything has room."""
        lanes = Lanes.sorted(wanted, section.box, end.box)
        (left, low), (right, high) = section.box
        (end_left, end_low), (end_right, end_high) = end.box
        across, bottom, top = right - left + end_right - end_left, min(low, end_low), max(high, end_high)
        width, height = SHEET[0] - _LEFT - _EDGE - _COLUMN, SHEET[1] - 2 * _EDGE
        sides = [n * _LANE for n in lanes.counts]
        taken = 3 * _ROOM + sides[0] + sides[1] + sides[2], 2 * _ROOM + sides[3] + sides[4]
        fitting = (
            s for s in _SCALES if s * across + taken[0] <= width and s * (top - bottom) + taken[1] <= height
        )
        scale = next(fitting, _SCALES[-1])
        gap = (_ROOM + sides[1]) / scale
        spare = (width - scale * across - taken[0]) / 2, (height - scale * (top - bottom) - taken[1]) / 2
        x = left - (_LEFT + _ROOM + sides[0] + spare[0]) / scale
        y = bottom - (_EDGE + _ROOM + sides[3] + spare[1]) / scale
        return Plan(scale, right + gap - end_left, (x, y), lanes)

    def at(self, x: float, y: float) -> Point:
        """A place on the paper [mm from its lower left corner] in the drawing's coordinates."""
        return self.corner[0] + x / self.scale, self.corner[1] + y / self.scale

    @property
    def scale_text(self) -> str:
        """The scale in words."""
        return f"{self.scale:g}:1" if self.scale >= 1 else f"1:{1 / self.scale:g}"


def _document(plan: Plan) -> Drawing:
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
        "dimexe": 1.5,
        "dimexo": 0.8,
        "dimgap": 0.9,
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
    """Draws the pieces."""

    def __init__(self, document: Drawing, plan: Plan) -> None:
        self.space, self.plan = document.modelspace(), plan

    def view(self, view: View, right: float) -> None:
        """The lines of a view, moved to the right."""
        for layer, lines in (("HIDDEN", view.hidden), ("SMOOTH", view.smooth), ("OUTLINE", view.visible)):
            for line in lines:
                self.space.add_lwpolyline([(x + right, y) for x, y in line], dxfattribs={"layer": layer})
        for cut in view.cut:
            for a, b in hatch(cut.outlines, _HATCH / self.plan.scale, falling=bool(cut.part % 2)):
                self.space.add_line(a, b, dxfattribs={"layer": "HATCH"})

    def centres(self, section: View, end: View) -> None:
        """The shaft's axis in both views."""
        over = 5 / self.plan.scale
        (left, _), (right, _) = section.box
        (end_left, low), (end_right, high) = end.box
        beside = self.plan.beside
        low, high = min(low, 0.0), max(high, 0.0)
        self._centre((left - over, 0.0), (right + over, 0.0))
        self._centre((end_left + beside - over, 0.0), (end_right + beside + over, 0.0))
        self._centre((beside, low - over), (beside, high + over))

    def _centre(self, one: Point, other: Point) -> None:
        self.space.add_line(one, other, dxfattribs={"layer": "CENTRE"})

    def dimensions(self) -> None:
        """Every dimension in its lane, or at its place."""
        for dimension, base in self.plan.lanes.placed(self.plan.scale, _LANE):
            right = self.plan.beside if dimension.measure.place == "end" else 0.0
            override = self._drawn(dimension.measure, base, right, _text(dimension))
            override.dimension.dxf.layer = "DIMENSIONS"
            override.render()
            if dimension.name:
                override.dimension.set_xdata(APP, [(1000, dimension.name)])

    def _drawn(self, measure: Measure, base: Point, right: float, text: str) -> Any:
        """A DIMENSION of the right kind."""
        points: Any = [(x + right, y) for x, y in measure.points]
        style: Any = {"text": text, "dimstyle": STYLE}
        level: Any = {**style, "override": {"dimtih": 1, "dimtoh": 1}}
        match measure.form:
            case "across":
                one, other = points
                return self.space.add_linear_dim((base[0] + right, base[1]), one, other, angle=0, **style)
            case "up":
                one, other = points
                return self.space.add_linear_dim((base[0] + right, base[1]), one, other, angle=90, **style)
            case "aligned":
                one, other = sorted(points)
                return self.space.add_aligned_dim(one, other, -8 / self.plan.scale, **style)
            case "circle":
                size, place = measure.value / 2, self._beyond(*points)
                return self.space.add_diameter_dim(points[0], radius=size, location=place, **level)
            case "arc":
                size, place = measure.value, self._beyond(*points)
                return self.space.add_radius_dim(points[0], radius=size, location=place, **level)
        return self.space.add_angular_dim_3p(self._between(points), *_counter_clockwise(points), **style)

    def _beyond(self, centre: Point, on: Point) -> Point:
        """The point of a circle's words: outside it, or within a large one."""
        away = on[0] - centre[0], on[1] - centre[1]
        radius = (away[0] ** 2 + away[1] ** 2) ** 0.5
        large = radius * self.plan.scale > 25
        share = 0.6 if large else 1 + 9 / (radius * self.plan.scale)
        return centre[0] + share * away[0], centre[1] + share * away[1]

    def _between(self, points: Sequence[Point]) -> Point:
        """A place of the arc of an angle: on the middle between its legs."""
        corner, one, other = points
        legs = [(p[0] - corner[0], p[1] - corner[1]) for p in (one, other)]
        size = min((x * x + y * y) ** 0.5 for x, y in legs) * 0.75
        first, last = _counter_clockwise(points)[1:]
        turn = _angle(corner, first), _angle(corner, last)
        middle = turn[0] + ((turn[1] - turn[0]) % (2 * pi)) / 2
        return corner[0] + size * cos(middle), corner[1] + size * sin(middle)

    def frame(self) -> None:
        """The border of the sheet and of the title block."""
        width, height = SHEET
        right = width - _EDGE
        column = right - _COLUMN
        lines = [
            [(0, 0), (width, 0), (width, height), (0, height), (0, 0)],
            [
                (_LEFT, _EDGE),
                (right, _EDGE),
                (right, height - _EDGE),
                (_LEFT, height - _EDGE),
                (_LEFT, _EDGE),
            ],
            [(column, _EDGE), (column, height - _EDGE)],
            [(column, _EDGE + _TITLE), (right, _EDGE + _TITLE)],
        ]
        for line in lines:
            self._polyline(line, "FRAME")

    def _polyline(self, line: Polyline, layer: str) -> None:
        self.space.add_lwpolyline([self.plan.at(x, y) for x, y in line], dxfattribs={"layer": layer})

    def words(self, header: Header | None, parameters: Any, unseen: Sequence[str]) -> None:
        """Title block and table of parameters."""
        left, top = SHEET[0] - _EDGE - _COLUMN + 3, SHEET[1] - _EDGE - 7
        self._write("Parameters", left, top, 4.5)
        for row, (name, text) in enumerate(parameters.items(), 1):
            mark = " *" if name in unseen else ""
            self._write(name.replace("_", " ") + mark, left, top - 6 * row, 3.0)
            self._write(text, left + 64, top - 6 * row, 3.0)
        if unseen:
            self._write(
                "* not between two surfaces that are drawn", left, top - 6 * (len(parameters) + 1), 2.5
            )
        title = f"{header.model.replace('_', ' ')}, version {header.version}" if header else "part"
        for row, name in enumerate(BLOCK, 1):
            line = self._write(line_of(name), left, _EDGE + _TITLE - 8 - _ROW * row, 3.0)
            line.set_xdata(APP, [(1000, f"{MARK}{name}")])
        lines = [
            (f"scale {self.plan.scale_text} on A3, first-angle projection", 3.0),
            ("dimensions in mm, measured on the solid; ( ) for reference", 2.5),
            (f"build {header.build[:32]}" if header else "", 2.5),
            ("checked:", 3.0),
        ]
        self._write(title, left, _EDGE + _TITLE - 8, 5.0)
        lowest = _EDGE + _TITLE - 8 - _ROW * (len(BLOCK) + len(lines))
        for row, (text, size) in enumerate(reversed(lines)):
            self._write(text, left, lowest + _ROW * row, size)
        self._write("date:", left + 64, lowest, 3.0)

    def _write(self, text: str, x: float, y: float, size: float) -> Text:
        attributes = {"layer": "TEXT", "style": STYLE, "height": size / self.plan.scale}
        return self.space.add_text(text, dxfattribs={**attributes, "insert": self.plan.at(x, y)})


def _text(dimension: Dimension) -> str:
    measure = dimension.measure
    several = f"{measure.count}×" if measure.count > 1 else ""
    sign = "Ø" if measure.sort == "diameter" and measure.form != "circle" else ""  # circles have theirs
    label = f"{several}{sign}<>"
    return label if dimension.name else f"({label})"


def _angle(corner: Point, point: Point) -> float:
    return atan2(point[1] - corner[1], point[0] - corner[0])


def _counter_clockwise(points: Sequence[Point]) -> tuple[Point, Point, Point]:
    """Corner and legs of an angle below 180°, the legs in the order in which it opens."""
    corner, one, other = points
    cross = (one[0] - corner[0]) * (other[1] - corner[1]) - (one[1] - corner[1]) * (other[0] - corner[0])
    return (corner, one, other) if cross >= 0 else (corner, other, one)
