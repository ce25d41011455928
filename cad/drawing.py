"""SVG views: the visible edges of the bodies as lines to scale (1 mm is 1 mm), with hidden edges dashed.

An edge where two faces meet tangentially, as at a fillet, is a thin line.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from cadquery import Compound, Edge, Shape
from OCP.BRepLib import BRepLib
from OCP.GCPnts import GCPnts_TangentialDeflection
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from OCP.HLRAlgo import HLRAlgo_Projector
from OCP.HLRBRep import HLRBRep_Algo, HLRBRep_HLRToShape

from cad.step import Body
from cad.view import view_of

_TURN = 0.1  # [rad] between two pieces of a curve
_SMOOTH = 1e-3  # of the drawing's size: the greatest distance of a piece from its curve
_POINT = 1e-6  # [mm]
_MARGIN = 0.04
_LINE = 0.002  # of the drawing's size

Line = list[tuple[float, float]]


def write_svg(bodies: Sequence[Body]) -> bytes:
    """Return a parallel projection of the bodies with hidden lines, as SVG."""
    shapes = [body.shape.moved(place) for body in bodies for place in body.places]
    hidden_line = _projected(Compound.makeCompound(shapes))
    visible = (hidden_line.VCompound(), hidden_line.OutLineVCompound())
    hidden = (hidden_line.HCompound(), hidden_line.OutLineHCompound())
    smooth = (hidden_line.Rg1LineVCompound(),)
    return _document(*(list(lines_of(some)) for some in (visible, hidden, smooth))).encode()


def _projected(shape: Shape) -> HLRBRep_HLRToShape:
    box = shape.BoundingBox()
    right, _, towards = view_of(np.array([box.xlen, box.ylen, box.zlen])).T
    eye = gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(*towards), gp_Dir(*right))
    algorithm = HLRBRep_Algo()
    algorithm.Add(shape.wrapped)
    algorithm.Projector(HLRAlgo_Projector(eye))
    algorithm.Update()
    algorithm.Hide()
    return HLRBRep_HLRToShape(algorithm)


def lines_of(compounds: Sequence[Any]) -> Iterator[Line]:
    """Yield the edges of projections as polylines; y points downwards, as in SVG."""
    for compound in compounds:
        if compound is None or compound.IsNull():
            continue
        BRepLib.BuildCurves3d_s(compound)  # the projection leaves curves on a plane only
        for edge in Shape.cast(compound).Edges():
            if (size := edge.BoundingBox().DiagonalLength) > _POINT:  # what is seen end on is a point
                yield _line(edge, size)


def _line(edge: Edge, size: float) -> Line:
    curve = edge._geomAdaptor()
    points = GCPnts_TangentialDeflection(curve, _TURN, max(_SMOOTH * size, _POINT))
    values = (points.Value(i) for i in range(1, points.NbPoints() + 1))
    return [(value.X(), -value.Y()) for value in values]


def _document(visible: Sequence[Line], hidden: Sequence[Line], smooth: Sequence[Line]) -> str:
    points = np.array([point for line in (*visible, *hidden) for point in line])
    low, high = points.min(axis=0), points.max(axis=0)
    size = float((high - low).max())
    (x, y), (width, height) = low - _MARGIN * size, high - low + 2 * _MARGIN * size
    stroke = _LINE * size
    thin = f'<path stroke="#5b6671" stroke-width="{stroke / 2:.4g}" d="{_path(smooth)}"/>' if smooth else ""
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<svg xmlns="http://www.w3.org/2000/svg" width="{width:.4g}mm" height="{height:.4g}mm"
  viewBox="{x:.6g} {y:.6g} {width:.6g} {height:.6g}">
<rect x="{x:.6g}" y="{y:.6g}" width="{width:.6g}" height="{height:.6g}" fill="white"/>
<g fill="none" stroke-linejoin="round" stroke-linecap="round" stroke-width="{stroke:.4g}">
<path stroke="#a8b0b8" stroke-dasharray="{3 * stroke:.4g}" d="{_path(hidden)}"/>
{thin}
<path stroke="#1d2733" d="{_path(visible)}"/>
</g>
</svg>
"""


def _path(lines: Sequence[Line]) -> str:
    return "".join("M" + "L".join(f"{x:.6g} {y:.6g}" for x, y in line) for line in lines)
