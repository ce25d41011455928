"""A connecting rod: its big end, a tapered shank of I section with fillets, the small end and its bush."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin, sqrt, tan

from cadquery import Location, Shape, Solid, Vector
from cadquery.func import cut, fuse
from scipy.integrate import quad

from cad.contour import Arc, Contour, Line, Point, Run
from cad.revolution import drilled_volume
from cad.shells.big_end import BigEnd
from cad.shells.shank import away, meeting, reach, root

CLEAR = 5e-8
"""Gap between a fillet and the end that it touches [mm]. Without it, the rounded numbers of a STEP file could
make their arcs cross, which the kernel finds invalid."""


@dataclass(frozen=True)
class Rod:
    """Sizes of a rod [mm]: the shank runs along +y, from the shoulder of the big end to the small end."""

    big_end: BigEnd
    distance: float  # of the two axes
    bore: float  # radius of the small end's bore
    outside: float  # radius of the small end
    half_width: float  # of the small end, along the pin
    shank_width: float  # across the pin, halfway along the shank
    thickness: float  # of the shank, along the pin
    lean: float = 0.0  # half the taper [rad]
    big_fillet: float = 0.0
    small_fillet: float = 0.0
    pocket_width: float = 0.0  # halfway along the shank
    web: float = 0.0  # thickness between the pockets
    pocket_corner: float = 0.0
    bush: float = 0.0  # thickness of its wall
    oil_hole: float = 0.0  # radius, from the top of the small end to its bore
    drilling: float = 0.0  # radius, from bore to bore

    @property
    def shoulder(self) -> float:
        """Return the distance from the axis of the big end to the start of the shank."""
        return self.big_end.rod.height

    @property
    def halfway(self) -> float:
        """Return the height of the middle of the shank."""
        return (self.shoulder + self.distance - self.outside) / 2

    @property
    def pin_bore(self) -> float:
        """Return the radius of the bore for the pin: of the bush, if there is one."""
        return self.bore - self.bush

    @property
    def pocket(self) -> tuple[float, float]:
        """Return the ends of a pocket, which is as far from the ends of the shank as from its sides."""
        edge = (self.shank_width - self.pocket_width) / 2
        return self.shoulder + edge, self.distance - self.outside - edge

    def side(self) -> tuple[float, float]:
        """Return the distances of a side of the shank from the axes of big end and small end."""
        half, middle = self.shank_width / 2, self.halfway
        return float(away(half, middle, self.lean)), float(away(half, middle - self.distance, self.lean))

    def fillets(self) -> tuple[Point, Point]:
        """Return the axes of the two fillets on the +x side: at the big end and at the small end."""
        low, high = self.side()
        above = self._from(self.distance, high + self.small_fillet, -self._top)
        if self.big_end.rod.is_square:
            return (self._foot[0], self._foot[1] + self.big_fillet), above
        return self._from(0.0, low + self.big_fillet, self._root), above

    @property
    def _rounds(self) -> tuple[float, float]:
        """Return the heights of shoulder and small end on which the fillets are drawn, with their gaps."""
        lower, upper = (CLEAR if radius > 0 else 0.0 for radius in (self.big_fillet, self.small_fillet))
        return self.shoulder + lower, self.outside + upper

    @property
    def _root(self) -> float:
        """Return how far along a side its lower fillet reaches, from the foot of the big end's axis."""
        low, height = self.side()[0], self._rounds[0]
        return float(root(self.big_end.rod.is_square, height, low, self.big_fillet, self.lean))

    @property
    def _top(self) -> float:
        """Return how far along a side its upper fillet reaches, from the foot of the small end's axis."""
        return float(reach(self._rounds[1], self.side()[1], self.small_fillet))

    @property
    def _foot(self) -> Point:
        """Return where the shank, or its fillet, meets the big end."""
        is_square, low, height = self.big_end.rod.is_square, self.side()[0], self._rounds[0]
        x = float(meeting(is_square, height, low, self.big_fillet, self.lean))
        return x, height if is_square else sqrt(height**2 - x**2)

    def _from(self, height: float, across: float, along: float) -> Point:
        """Return a point by its distances along the side's normal and the side, from an axis at a height."""
        u, v = cos(self.lean), sin(self.lean)
        return across * u - along * v, height + across * v + along * u

    def shank(self) -> Contour:
        """Return the section of the shank between the contours of both ends, with its fillets."""
        foot, *_ = sides = self._sides()
        start, above = foot.start, (0.0, self.distance - self.outside)
        is_square = self.big_end.rod.is_square
        base = Line((0.0, start[1]), start) if is_square else _about((0.0, 0.0), (0.0, self.shoulder), start)
        return Contour.symmetric([base, *sides, _about((0.0, self.distance), sides[-1].end, above)])

    def _rooted(self) -> Contour:
        """Return the section of the shank with roots in both ends, so that nothing is joined along an arc."""
        foot, *_ = sides = self._sides()
        (x, y), end = foot.start, sides[-1].end
        deep = (self.shoulder + self.big_end.bore) / 2 / self.shoulder
        below = (x, deep * y) if self.big_end.rod.is_square else (deep * x, deep * y)
        base: Run = Line((0.0, below[1]), below)
        if not self.big_end.rod.is_square:
            base = _about((0.0, 0.0), (0.0, deep * self.shoulder), below)
        return Contour.symmetric([base, Line(below, (x, y)), *sides, Line(end, (0.0, self.distance))])

    def _sides(self) -> list[Run]:
        """Return the side at +x with its fillets, from the big end to the small end."""
        (low, high), (lower, upper), foot = self.side(), self.fillets(), self._foot
        bottom, top = self._from(0.0, low, self._root), self._from(self.distance, high, -self._top)
        share = self._rounds[1] / (self._rounds[1] + self.small_fillet)
        end = share * upper[0], self.distance + share * (upper[1] - self.distance)
        at_big_end = [_about(lower, foot, bottom)] if self.big_fillet > 0 else []
        at_small_end = [_about(upper, top, end)] if self.small_fillet > 0 else []
        return [*at_big_end, Line(bottom, top), *at_small_end]

    def pocket_contour(self) -> Contour:
        """Return the section of a pocket: its sides are parallel to those of the shank."""
        (low, high), c, a = self.pocket, self.pocket_corner, self.lean
        wide, narrow = (self.pocket_width / 2 + (self.halfway - y) * tan(a) for y in (low, high))
        if c == 0:
            return Contour.symmetric(
                [
                    Line((0.0, low), (wide, low)),
                    Line((wide, low), (narrow, high)),
                    Line((narrow, high), (0.0, high)),
                ]
            )
        lower, upper = self.pocket_corners()
        u, v = c * cos(a), c * sin(a)
        feet = (lower[0], low), (lower[0] + u, lower[1] + v), (upper[0] + u, upper[1] + v), (upper[0], high)
        return Contour.symmetric(
            [
                Line((0.0, low), feet[0]),
                Arc(feet[0], feet[1], lower, is_left=True),
                Line(feet[1], feet[2]),
                Arc(feet[2], feet[3], upper, is_left=True),
                Line(feet[3], (0.0, high)),
            ]
        )

    def pocket_corners(self) -> tuple[Point, Point]:
        """Return the axes of the pocket's corners on the side +x."""
        (low, high), c, a = self.pocket, self.pocket_corner, self.lean

        def axis(y: float) -> Point:
            return self.pocket_width / 2 + (self.halfway - y) * tan(a) - c / cos(a), y

        return axis(low + c), axis(high - c)

    def body(self) -> Shape:
        """Return the upper half of the big end, the shank and the small end as one solid."""
        h, b = self.thickness / 2, self.half_width
        shank = self._rooted().prism(-h, h)
        eye = Solid.makeCylinder(self.outside, 2 * b, Vector(0, self.distance, -b), Vector(0, 0, 1))
        end = self.big_end.rod.contour().prism(-self.big_end.half_width, self.big_end.half_width)
        whole = fuse(end, shank, eye)
        if self.pocket_width > 0:
            for low, high in ((self.web / 2, self.thickness), (-self.thickness, -self.web / 2)):
                whole = cut(whole, self.pocket_contour().prism(low, high))
        below = Vector(0, self.distance, -2 * b)
        whole = cut(whole, Solid.makeCylinder(self.bore, 4 * b, below, Vector(0, 0, 1)))
        return self.big_end.drilled(self._oiled(whole))

    def _oiled(self, body: Shape) -> Shape:
        """Return a body after drilling the oil hole and the drilling of the shank."""
        if self.oil_hole > 0:
            body = cut(body, _upright(self.oil_hole, self.distance, self.distance + 1.5 * self.outside))
        if self.drilling > 0:
            body = cut(body, _upright(self.drilling, 0.0, self.distance))
        return body

    def bush_body(self) -> Shape:
        """Return the bush about the origin; see `bush_place`."""
        b, up = self.half_width, Vector(0, 0, 1)
        body: Shape = Solid.makeCylinder(self.bore, 2 * b, Vector(0, 0, -b), up)
        for radius, side in ((self.oil_hole, 1.5), (self.drilling, -1.5)):
            if radius > 0:
                body = cut(body, _upright(radius, *sorted((0.0, side * self.bore))))
        return cut(body, Solid.makeCylinder(self.pin_bore, 4 * b, Vector(0, 0, -2 * b), up))

    @property
    def bush_place(self) -> Location:
        """Return the place of the bush, in the small end."""
        return Location(Vector(0, self.distance, 0))

    def bush_volume(self) -> float:
        """Return the volume of the bush, minus its holes [mm³]."""
        ring = pi * (self.bore**2 - self.pin_bore**2) * 2 * self.half_width
        return ring - sum(
            drilled_volume(one, self.bore, self.pin_bore) for one in (self.oil_hole, self.drilling)
        )

    def volume(self) -> float:
        """Return the volume of the body [mm³], from the areas of its contours."""
        eye = pi * (self.outside**2 - self.bore**2) * 2 * self.half_width
        whole = self.big_end.volume() + self.shank().area * self.thickness + eye - self._pockets()
        return whole - drilled_volume(self.oil_hole, self.outside, self.bore) - self._drilled()

    def _pockets(self) -> float:
        if self.pocket_width <= 0:
            return 0.0
        return self.pocket_contour().area * (self.thickness - self.web)

    def _drilled(self) -> float:
        """Return the volume of the drilling: the cylinder from axis to axis, minus its parts in the bores."""
        a = self.drilling
        if a == 0:
            return 0.0

        def chord(t: float) -> float:
            x = a * sin(t)
            return 2 * (a * cos(t)) ** 2 * (self.distance - sum(sqrt(R * R - x * x) for R in bores))

        bores = self.big_end.bore, self.bore
        return float(2 * quad(chord, 0.0, pi / 2, epsabs=0, epsrel=1e-11)[0])


def _about(centre: Point, start: Point, end: Point) -> Arc:
    """Return the arc about a centre from start to end, clockwise."""
    return Arc(start, end, centre, is_left=False)


def _upright(radius: float, low: float, high: float) -> Solid:
    """Return a cylinder about the middle of the rod, along it."""
    return Solid.makeCylinder(radius, high - low, Vector(0, low, 0), Vector(0, 1, 0))
