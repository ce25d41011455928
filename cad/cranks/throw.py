"""Build the solid of a crank throw, in millimetres.

z is the axis of the main journals, x points from it to the crankpin, z = 0 is the middle of the pin. Each web
lies at pin_length/2 ≤ |z| ≤ pin_length/2 + web_thickness; front is at -z, rear at +z.

Journals and pins are revolved from one outline with their fillets, and the webs are plates. So the parts meet
only at flat faces, and the kernel can fuse them reliably. Only bores, drilling and inclined faces are cut.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import sqrt, tan

from cadquery import Shape, Solid, Vector
from cadquery.func import cut, face, fuse, polygon, wire

from cad.cranks.outline import Outline, Run, draw

_MIDDLE = 1 - sqrt(0.5)  # distance of the middle of a fillet's arc from either end, in radii


@dataclass(frozen=True)
class End:
    """A cylinder beyond a main journal [mm]; a size of 0 omits the feature.

    The fillet lies where the thinner of journal and end meets the other, the chamfer of 45° at the free end.
    """

    radius: float
    length: float
    fillet: float = 0.0
    chamfer: float = 0.0

    def runs(self, journal: float, low: float, top: float) -> list[Run]:
        """Return the outline from a journal's side at `low` over its end at `top` to the end's axis."""
        far, r, c = top + self.length, self.fillet, self.chamfer
        shoulder: Run = ((journal, top), (self.radius, top))
        if self.radius > journal:
            root = tuple(reversed(fillet_run(journal, r, top, -1)))
            meeting: list[Run] = [((journal, low), root[0]), root, (root[-1], shoulder[1])]
            foot = shoulder[1]
        else:
            root = fillet_run(self.radius, r, top, 1)
            meeting = [((journal, low), shoulder[0]), (shoulder[0], root[0]), root]
            foot = root[-1]
        rim = [foot, (self.radius, far - c), (self.radius - c, far), (0.0, far)]
        return [*meeting, *pairwise(rim)]


@dataclass(frozen=True)
class Collar:
    """A ring about a main journal on the outer face of a web, whose face takes axial thrust [mm]."""

    radius: float
    height: float  # along the shaft


@dataclass(frozen=True)
class Throw:
    """A throw with its journals [mm]; a radius of 0 omits the feature."""

    outline: Outline  # of the webs
    web_thickness: float
    journal: float  # radius
    journal_bore: float  # radius; through the journals and their webs
    journal_length: float  # on each side
    pin: float  # radius
    pin_bore: float  # radius; through the pin and both webs
    pin_length: float
    fillet: float
    drilling: float  # radius
    inclination: float  # of the webs' outer faces [rad]
    incline_start: float  # x at which the outer faces begin to slope

    @property
    def inner(self) -> float:
        """Return the z coordinate of the inner face of the web on +z."""
        return self.pin_length / 2

    @property
    def outer(self) -> float:
        """Return the z coordinate of the outer face of the web on +z."""
        return self.inner + self.web_thickness

    @property
    def journal_end(self) -> float:
        """Return the z coordinate of the end of the journal on +z."""
        return self.outer + self.journal_length

    @property
    def drilled(self) -> tuple[Vector, Vector]:
        """Return the points where the axis of the drilling leaves the pin and the journal on +z."""
        top = Vector(self.outline.throw + self.pin, 0, 0)
        return top, Vector(-self.journal, 0, self.outer + self.journal_length / 2)

    def solid(self) -> Shape:
        """Return the pin, webs and journals joined, then bored and drilled at once."""
        web, journal = self.web(), self.journal_solid(None)
        parts = web, web.mirror("XY"), self.pin_solid(), journal.mirror("XY"), journal
        whole = fuse(*parts, glue="partial")  # glueing takes half the time: the parts only touch
        tools = [*self._bores()]
        return whole.cut(*tools) if tools else whole

    def web(self) -> Shape:
        """Return the web on +z."""
        plate = Solid.extrudeLinear(self.outline.wire(self.inner), [], Vector(0, 0, self.web_thickness))
        return cut(plate, self._wedge()) if self.inclination > 0 else plate

    def _bores(self) -> Iterator[Solid]:
        """Yield the solids that the bores and the drilling remove; each extends beyond the part.

        Bores are cut from the whole throw, not from its parts: otherwise a bore would have an edge between
        parts, and a drilling that touches such an edge would come out wrong.
        """
        if self.journal_bore > 0:
            yield bore(self.journal_bore, self.journal_end + self.journal, 0.0)
        if self.pin_bore > 0:
            yield bore(self.pin_bore, self.outer + self.journal_length / 2, self.outline.throw)
        if self.drilling > 0:
            yield self.drill()

    def _wedge(self) -> Solid:
        """Return the wedge that the inclined face removes from the web on +z.

        On its other sides it extends beyond the web.
        """
        room, slope, start = self.outline.half_width / 4, tan(self.inclination), self.incline_start
        left, right = start - room, self.outline.tip + room
        above = self.outer + room * (1 + slope)
        corners = (
            (left, self.outer + slope * room),
            (right, self.outer - slope * (right - start)),
            (right, above),
            (left, above),
        )
        section = polygon(*(Vector(x, -8 * room, z) for x, z in corners))
        return Solid.extrudeLinear(section, [], Vector(0, 16 * room, 0))

    def pin_solid(self) -> Shape:
        """Return the pin with a fillet at either end."""
        z, edge = self.inner, self.pin + self.fillet
        lower = fillet_run(self.pin, self.fillet, -z, 1)
        upper = tuple(reversed(fillet_run(self.pin, self.fillet, z, -1)))
        side: Run = (lower[-1], upper[0])
        return turned(
            [((0, -z), (edge, -z)), lower, side, upper, ((edge, z), (0, z))], self.outline.throw, -1
        )

    def journal_solid(self, end: End | None, collar: Collar | None = None) -> Shape:
        """Return the journal on +z with its adjoining parts."""
        top, radius = self.journal_end, self.journal
        foot = self.journal_foot(collar)
        beyond = (
            end.runs(radius, foot[-1][-1][1], top)
            if end
            else [(foot[-1][-1], (radius, top)), ((radius, top), (0.0, top))]
        )
        return turned([*foot, *beyond], 0.0, 1)

    def journal_foot(self, collar: Collar | None) -> list[Run]:
        """Return the outline of the journal on +z from its axis to the end of its fillet on the journal."""
        z = self.outer
        if collar is None:
            root = fillet_run(self.journal, self.fillet, z, 1)
            return [((0, z), root[0]), root]
        top = z + collar.height
        root = fillet_run(self.journal, self.fillet, top, 1)
        rim = (collar.radius, z), (collar.radius, top)
        return [((0, z), rim[0]), rim, (rim[1], root[0]), root]

    def blind_bore(self) -> Solid:
        """Return the bore of a split pin: it runs from its end at -z through the web on +z, and beyond."""
        length = self.inner + self.outer + self.journal_length / 2
        return Solid.makeCylinder(
            self.pin_bore, length, Vector(self.outline.throw, 0, -self.inner), Vector(0, 0, 1)
        )

    def drill(self) -> Solid:
        """Return the solid that the oil drilling removes, from beyond the pin to beyond the journal."""
        top, bottom = self.drilled
        way = bottom - top
        lean = way.z / -way.x
        # The drill extends beyond the openings by the slant of its flat ends plus a tenth.
        over = way.normalized() * (1.1 * self.drilling * lean)
        return Solid.makeCylinder(self.drilling, (way + over * 2).Length, top - over, way)


def fillet_run(radius: float, size: float, z: float, up: int) -> Run:
    """Return the fillet between a face at z and a cylinder above (1) or below (-1) it.

    Without a fillet, return a single point.
    """
    middle = radius + size * _MIDDLE, z + up * size * _MIDDLE
    return (radius + size, z), middle, (radius, z + up * size)


def bore(radius: float, reach: float, x: float) -> Solid:
    """Return a cylinder along z at x, extending equally far up and down."""
    return Solid.makeCylinder(radius, 2 * reach, Vector(x, 0, -reach), Vector(0, 0, 1))


def turned(runs: Sequence[Run], x: float, side: int) -> Solid:
    """Return the solid of a closed outline (distance from the axis, z) revolved about an axis along z.

    The axis is at x. The seam is on the given side of the axis, away from the mouth of the drilling.
    """
    real = [run for run in runs if run[0] != run[-1]]
    closing = (real[-1][-1], real[0][0])
    edges = [draw(run, lambda r, z: Vector(x + side * r, 0, z)) for run in [*real, closing]]
    return Solid.revolve(face(wire(*edges)), 360, Vector(x, 0, 0), Vector(x, 0, 1))
