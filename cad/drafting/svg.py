"""The dimensioned drawing as SVG: what the DXF document holds, line by line, on its sheet."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from math import cos, degrees, radians, sin
from typing import Any

from cad.drafting.sheet import APP, SHEET, draw
from cad.header import Header
from cad.stamp import MARK
from cad.step import Body

FONTS = "Inter, 'Liberation Sans', Arial, sans-serif"
_WIDTHS = {"OUTLINE": 0.6, "FRAME": 0.4, "DIMENSIONS": 0.22, "HATCH": 0.12, "SMOOTH": 0.2, "HIDDEN": 0.25}
_COLOURS = {
    "HATCH": "#8593a0",
    "SMOOTH": "#5b6671",
    "HIDDEN": "#8593a0",
    "CENTRE": "#a3221b",
    "DIMENSIONS": "#1b4f7f",
}
_DASHES = {"HIDDEN": "2.4 1.4", "CENTRE": "9 1.5 1.5 1.5"}
_INK = "#1d2733"
_STEP = radians(4)  # between two points of an arc


def write_drawing(bodies: Sequence[Body], header: Header | None) -> bytes:
    """A dimensioned drawing, the sheet in millimetres."""
    document = draw(bodies, header)
    frame: Any = document.modelspace().query('LWPOLYLINE[layer=="FRAME"]').first
    (left, low), (right, _) = frame.get_points("xy")[:2]
    scale = SHEET[0] / (right - left)
    ink = Ink(left, low, scale)
    lines = "\n".join(ink.of(entity, entity.dxf.layer) for entity in document.modelspace())
    width, height = SHEET
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
    """Draws entities of DXF; the sheet's corner lies at (left, low) in their coordinates."""

    def __init__(self, left: float, low: float, scale: float) -> None:
        self.left, self.low, self.scale = left, low, scale

    def at(self, point: Any) -> tuple[float, float]:
        """A place on the paper, y downwards."""
        return (point[0] - self.left) * self.scale, SHEET[1] - (point[1] - self.low) * self.scale

    def of(self, entity: Any, layer: str) -> str:
        """An entity, or what it is made of."""
        match entity.dxftype():
            case "DIMENSION" | "INSERT":
                return "".join(self.of(part, layer) for part in entity.virtual_entities())
            case "LINE":
                return self._path([entity.dxf.start, entity.dxf.end], layer)
            case "LWPOLYLINE":
                return self._path(entity.get_points("xy"), layer)
            case "ARC" | "CIRCLE":
                return self._path([*_round(entity)], layer)
            case "SOLID":
                return self._solid(entity, layer)
            case "TEXT":
                place, size = entity.dxf.insert, entity.dxf.height
                return self._text(entity.dxf.text, place, size, 0.0, "start", 0.0, _mark_of(entity))
            case "MTEXT":
                angle = entity.get_rotation()
                return self._text(
                    entity.plain_text(), entity.dxf.insert, entity.dxf.char_height, angle, "middle", 0.36
                )
        return ""  # points, which only CAD programs need

    def _path(self, points: Sequence[Any], layer: str) -> str:
        d = "M" + "L".join("{:.3f} {:.3f}".format(*self.at(point)) for point in points)
        dash = f' stroke-dasharray="{_DASHES[layer]}"' if layer in _DASHES else ""
        colour, width = _COLOURS.get(layer, _INK), _WIDTHS.get(layer, 0.2)
        return f'<path stroke="{colour}" stroke-width="{width:g}"{dash} d="{d}"/>\n'

    def _solid(self, entity: Any, layer: str) -> str:
        d = "M" + "L".join("{:.3f} {:.3f}".format(*self.at(point)) for point in entity.wcs_vertices()) + "z"
        return f'<path fill="{_COLOURS.get(layer, _INK)}" d="{d}"/>\n'

    def _text(
        self, text: str, place: Any, height: float, angle: float, anchor: str, drop: float, mark: str = ""
    ) -> str:
        x, y = self.at(place)
        size = height * self.scale * 1.3  # letters of that height; a font's size is that of its line
        turn = f' transform="rotate({-angle:.4g} {x:.3f} {y:.3f})"' if angle else ""
        return (
            f'<text{mark} x="{x:.3f}" y="{y:.3f}" dy="{drop * size:.3f}" font-size="{size:.3f}" fill="{_INK}"'
            f' text-anchor="{anchor}"{turn}>{escape(text)}</text>\n'
        )


def _mark_of(entity: Any) -> str:
    """The attribute that says which line of the title block a text is, if a stamp fills it in."""
    if not entity.has_xdata(APP):
        return ""
    return f' data-stamp="{entity.get_xdata(APP)[0].value.removeprefix(MARK)}"'


def _round(entity: Any) -> Iterator[tuple[float, float]]:
    """Points of an arc or a circle."""
    centre, radius = entity.dxf.center, entity.dxf.radius
    whole = entity.dxftype() == "CIRCLE"
    start = 0.0 if whole else radians(entity.dxf.start_angle)
    turn = 360.0 if whole else (entity.dxf.end_angle - entity.dxf.start_angle) % 360
    steps = max(2, int(turn / degrees(_STEP)))
    for i in range(steps + 1):
        angle = start + radians(turn) * i / steps
        yield centre[0] + radius * cos(angle), centre[1] + radius * sin(angle)
