"""Draw a drawing as SVG: the entities of its DXF in order, at the size of its sheet.

An arc stays an arc instead of becoming a polyline. The SVG contains no scripts, and no style attributes,
because the content security policy of the pages forbids them.
"""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from math import cos, hypot, radians, sin
from typing import Any

from ezdxf import path as paths

from cad.drafting.formats import Format
from cad.drafting.hatch import hatch
from cad.drafting.labels import SMALL, read_stack
from cad.drafting.letter_width import SIZE, width_of
from cad.drafting.page import APP
from cad.drafting.sheet import draw
from cad.header import Header
from cad.stamp import MARK
from cad.step import Body

FONTS = "Inter, 'Liberation Sans', Arial, sans-serif"
_WIDTHS = {
    "OUTLINE": 0.6,
    "FRAME": 0.4,
    "DIMENSIONS": 0.22,
    "BREAK": 0.25,
    "HATCH": 0.12,
    "SMOOTH": 0.2,
    "HIDDEN": 0.25,
    "CUTTING": 0.7,
    "SYMBOLS": 0.3,
}
_COLOURS = {
    "HATCH": "#8593a0",
    "SMOOTH": "#5b6671",
    "HIDDEN": "#8593a0",
    "CENTRE": "#a3221b",
    "DIMENSIONS": "#1b4f7f",
}
_DASHES = {"HIDDEN": "2.4 1.4", "CENTRE": "9 1.5 1.5 1.5"}
_INK = "#1d2733"
_EDGE = 0.7  # of words, white: it interrupts an extension line that crosses them [mm on paper]
_FLAT = 0.02  # greatest distance of a hatched outline from its arcs [mm on paper]


def write_drawing(bodies: Sequence[Body], header: Header | None, whole: Sequence[Body] = ()) -> bytes:
    """Return a dimensioned drawing of all parts of a model, or of one part; the sheet is in millimetres."""
    document, format = draw(bodies, header, whole)
    frame: Any = document.modelspace().query('LWPOLYLINE[layer=="FRAME"]').first
    (left, low), (right, _) = frame.get_points("xy")[:2]
    ink = Ink(left, low, format.width / (right - left), format)
    drawn = "".join(ink.of(entity, entity.dxf.layer) for entity in document.modelspace()).splitlines()
    lines = "\n".join(sorted(drawn, key=lambda line: line.startswith("<text")))  # words lie over lines
    width, height = format.width, format.height
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}mm" height="{height:g}mm"'
        f' viewBox="0 0 {width:g} {height:g}" role="img">\n<title>{escape(_title(header))}</title>\n'
        f'<rect width="{width:g}" height="{height:g}" fill="white"/>\n'
        f'<g fill="none" stroke-linejoin="round" stroke-linecap="butt" font-family="{FONTS}">\n'
        f"{lines}\n</g>\n</svg>\n"
    ).encode()


def _title(header: Header | None) -> str:
    return f"Dimensioned drawing of {header.model} version {header.version}" if header else "Drawing"


class Ink:
    """Draws DXF entities; the corner of the sheet is at (left, low) in their coordinates."""

    def __init__(self, left: float, low: float, scale: float, format: Format) -> None:
        self.left, self.low, self.scale, self.format = left, low, scale, format

    def at(self, point: Any) -> tuple[float, float]:
        """Convert a point to its position on the paper, with y downwards."""
        return (point[0] - self.left) * self.scale, self.format.height - (point[1] - self.low) * self.scale

    def of(self, entity: Any, layer: str) -> str:
        """Return the SVG of an entity, or of the entities it consists of."""
        match entity.dxftype():
            case "DIMENSION" | "INSERT":
                return "".join(self.of(part, layer) for part in entity.virtual_entities())
            case "LINE":
                return self._stroke(self._line([entity.dxf.start, entity.dxf.end]), layer)
            case "LWPOLYLINE":
                return self._stroke(self._line(entity.get_points("xy")), layer)
            case "ARC":
                turn = (entity.dxf.end_angle - entity.dxf.start_angle) % 360
                return self._stroke(self._arc(entity, entity.dxf.start_angle, turn), layer)
            case "CIRCLE":
                return self._stroke(self._arc(entity, 0.0, 360.0), layer)
            case "HATCH":
                return self._hatch(entity, layer)
            case "SOLID":
                d = self._line(entity.wcs_vertices()) + "z"
                return f'<path fill="{_COLOURS.get(layer, _INK)}" d="{d}"/>\n'
            case "TEXT":
                return self._letters(entity)
            case "MTEXT":
                return self._words(entity)
        return ""  # points, which only CAD programs need

    def _line(self, points: Sequence[Any]) -> str:
        return "M" + "L".join("{:.3f} {:.3f}".format(*self.at(point)) for point in points)

    def _arc(self, entity: Any, start: float, turn: float) -> str:
        """Return an arc as one or two SVG arcs, each of at most half a turn; in SVG y points down."""
        (x, y), r = self.at(entity.dxf.center), entity.dxf.radius * self.scale
        parts = 2 if turn > 180 else 1
        angles = [radians(start + turn * i / parts) for i in range(parts + 1)]
        ends = [f"{x + r * cos(angle):.3f} {y - r * sin(angle):.3f}" for angle in angles]
        return f"M{ends[0]}" + "".join(f"A{r:.3f} {r:.3f} 0 0 0 {end}" for end in ends[1:])

    def _hatch(self, entity: Any, layer: str) -> str:
        line = entity.pattern.lines[0]
        apart, is_falling = hypot(line.offset.x, line.offset.y), 90 < line.angle % 180
        outlines = [
            [(p.x, p.y) for p in outline.flattening(_FLAT / self.scale)]
            for outline in paths.from_hatch(entity)
        ]
        lines = hatch(outlines, apart, falling=is_falling)
        d = "".join(self._line(ends) for ends in lines)
        return self._stroke(d, layer) if d else ""

    def _stroke(self, d: str, layer: str) -> str:
        dash = f' stroke-dasharray="{_DASHES[layer]}"' if layer in _DASHES else ""
        colour, width = _COLOURS.get(layer, _INK), _WIDTHS.get(layer, 0.2)
        return f'<path stroke="{colour}" stroke-width="{width:g}"{dash} d="{d}"/>\n'

    def _letters(self, entity: Any) -> str:
        x, y = self.at(entity.dxf.insert)
        size = entity.dxf.height * self.scale * SIZE
        mark = _mark_of(entity)
        return (
            f'<text{mark} x="{x:.3f}" y="{y:.3f}" font-size="{size:.3f}" fill="{_INK}">'
            f"{escape(entity.dxf.text)}</text>\n"
        )

    def _words(self, entity: Any) -> str:
        """Draw the text of a dimension about its middle, followed by the deviations one above the other."""
        height = entity.dxf.char_height * self.scale
        angle = entity.get_rotation()
        x, y = self.at(entity.dxf.insert)
        text, upper, lower = read_stack(entity.text)
        plain = text if upper else entity.plain_text()
        turn = f' transform="rotate({-angle:.4g} {x:.3f} {y:.3f})"' if angle else ""
        if not upper:
            return _text(plain, x, y + 0.36 * SIZE * height, height, "middle", turn)
        small = height * SMALL
        first, rest = width_of(f"{plain} ", height), max(width_of(upper, small), width_of(lower, small))
        left = x - (first + rest) / 2
        return (
            _text(plain, left, y + 0.36 * SIZE * height, height, "start", turn)
            + _text(upper, left + first, y - 0.25 * small, small, "start", turn)
            + _text(lower, left + first, y + 1.15 * small, small, "start", turn)
        )


def _text(text: str, x: float, y: float, height: float, anchor: str, turn: str) -> str:
    return (
        f'<text x="{x:.3f}" y="{y:.3f}" font-size="{height * SIZE:.3f}" fill="{_INK}" stroke="white"'
        f' stroke-width="{_EDGE:g}" paint-order="stroke" text-anchor="{anchor}"{turn}>{escape(text)}</text>\n'
    )


def _mark_of(entity: Any) -> str:
    """Return the attribute that marks a text as a title-block field, if a stamp fills it in."""
    if not entity.has_xdata(APP):
        return ""
    return f' data-stamp="{entity.get_xdata(APP)[0].value.removeprefix(MARK)}"'
