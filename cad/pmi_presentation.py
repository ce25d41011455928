"""Drawn annotations of AP242: the text of a tolerance and a leader to its faces, as lines in space.

A viewer that shows no list of annotations shows these lines, in the axes of the file: parts stand at their
(first) positions. All texts stand in the plane of x and z through the middle of the parts, in rows to the
right of their box. A leader runs from each text to the nearest point of its face.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from cadquery import Edge, Shape, Vector, Vertex
from OCP.BRep import BRep_Builder
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.TopoDS import TopoDS_Compound

_HEIGHT = 0.025
"""Height of the letters over the diagonal of the bounding box of the parts."""
_WIDE, _TALL = 4.0, 6.0  # grid on which letters are drawn
_ADVANCE, _ROW = 6.0, 11.0  # spacing of letters and of rows on this grid

_DECIMALS = 9  # of a leader's end [mm]; the kernel's last digits are noise

Stroke = tuple[tuple[float, float], ...]

_STROKES: dict[str, str] = {
    "0": "00 40 46 06 00", "1": "15 26 20", "2": "06 46 43 03 00 40", "3": "06 46 40 00,13 43",
    "4": "06 03 43,46 40", "5": "46 06 03 43 40 00", "6": "46 06 00 40 43 03", "7": "06 46 10",
    "8": "00 40 46 06 00,03 43", "9": "43 03 06 46 40 00", ".": "20 21", "-": "13 33", "+": "13 33,22 24",
    "±": "14 34,23 25,12 32", "/": "00 46", "R": "00 06 46 43 03,23 40", "S": "46 06 03 43 40 00",
    "Ø": "11 31 35 15 11,00 46", "x": "00 44,04 40", "⌭": "00 24,20 44,12 13 22 32 33 24 14 13",
    "⊥": "00 40,20 26", "∥": "10 26,20 36", "A": "00 26 40,13 33", "B": "00 06 36 43 00,03 33 40 00",
    "C": "46 06 00 40", "D": "00 06 36 43 40 30 00", " ": "",
}  # fmt: skip
"""Strokes of a letter on the grid: points `xy`, separated by spaces; a comma lifts the pen."""


class Sheet:
    """The rows of annotations beside the parts, of which each call takes the next."""

    def __init__(self, parts: Shape) -> None:
        box = parts.BoundingBox()
        self._unit = _HEIGHT * box.DiagonalLength / _TALL
        self._corner = Vector(box.xmax + 0.1 * box.DiagonalLength, (box.ymin + box.ymax) / 2, box.zmax)
        self._rows = 0

    def drawn(self, text: str, faces: Sequence[Shape]) -> TopoDS_Compound:
        """Return the lines of a text [mm], and a leader to it from each point.

        Parameters
        ----------
        text
            Letters for which `_STROKES` has strokes; others are omitted.
        points
            Points of the solid [mm] at which the leaders end.
        """
        start = self._corner - Vector(0, 0, self._rows * _ROW * self._unit)
        self._rows += 1
        lines = [*self._letters(text, start), *self._leaders(start, faces)]
        compound, builder = TopoDS_Compound(), BRep_Builder()
        builder.MakeCompound(compound)
        for first, second in lines:
            builder.Add(compound, Edge.makeLine(first, second).wrapped)
        return compound

    def _letters(self, text: str, start: Vector) -> Iterator[tuple[Vector, Vector]]:
        for number, letter in enumerate(text):
            for stroke in strokes(letter):
                points = [start + Vector(number * _ADVANCE + x, 0, y) * self._unit for x, y in stroke]
                yield from pairwise(points)

    def _leaders(self, start: Vector, faces: Sequence[Shape]) -> Iterator[tuple[Vector, Vector]]:
        knee = start + Vector(-_WIDE, 0, _TALL / 2) * self._unit
        yield knee, start + Vector(-1, 0, _TALL / 2) * self._unit
        for face in faces:
            if (point := _nearest(knee, face)) != knee:
                yield point, knee


def _nearest(point: Vector, face: Shape) -> Vector:
    """Return the point of a face [mm] that is nearest to a point."""
    measured = BRepExtrema_DistShapeShape(Vertex.makeVertex(*point.toTuple()).wrapped, face.wrapped)
    return Vector(*(round(x, _DECIMALS) for x in Vector(measured.PointOnShape2(1)).toTuple()))


def strokes(letter: str) -> list[Stroke]:
    """Return the strokes of a letter on a grid of 4 by 6; an empty list if it has none."""
    return [
        tuple((float(point[0]), float(point[1])) for point in stroke.split())
        for stroke in _STROKES.get(letter, "").split(",")
        if stroke
    ]
