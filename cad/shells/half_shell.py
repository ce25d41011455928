"""Build a half shell or a full bush of steel with its lining, with the crown at +y; compute its volumes."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, degrees, pi, sin, sqrt

from cadquery import Edge, Location, Shape, Solid, Vector
from cadquery.func import cut, extrude, face, fuse, polyline, segment, wire
from scipy.integrate import quad

from cad.revolution import Point, area, drill, drilled_volume, outline, sheet_under_arc, turned, turned_volume
from cad.shells.eccentric import EccentricBore
from cad.shells.relief import Relief

_BEYOND = 10.0  # [deg] by which the tool for a groove from joint to joint extends beyond the joints


@dataclass(frozen=True)
class Groove:
    """An oil groove round the bore [mm]."""

    bottom: float  # radius
    half_width: float
    turn: float  # [rad], rotation about the crown
    is_whole: bool  # whether the groove goes from joint to joint


@dataclass(frozen=True)
class Tang:
    """The locating lip on the back, next to the joint on the side +x [mm]."""

    width: float
    length: float
    height: float
    z: float


@dataclass(frozen=True)
class Flange:
    """Flanges at one end (+z) or at both [mm]."""

    radius: float
    thickness: float
    count: int


@dataclass(frozen=True)
class HalfShell:
    """Sizes of a half shell [mm]: radii about z.

    The joint is at y = -crush, to which the wall continues straight.

    The arc of a shell in its free state ends above the plane y = 0 by the angle `lift` on either side;
    features at a joint are built at y = 0 and rotated about z by this angle.

    Without a lining, the lining radius is that of the bore, and the whole wall is the back.
    """

    bore: float
    lining: float  # radius of the back of the lining
    outside: float
    half_width: float
    inner_chamfer: float
    outer_chamfer: float
    crush: float
    relief: Relief | None
    groove: Groove | None
    hole: float
    tang: Tang | None
    flange: Flange | None
    lift: float = 0.0  # [rad]
    offset: float = 0.0  # of the axis of an eccentric bore, which has no relief and is not free
    reduction_height: float = 0.0  # above the joint, where the wall reduction is measured

    @property
    def eccentric(self) -> EccentricBore:
        """Return the bore, whose axis may be offset."""
        return EccentricBore(self.bore, self.offset)

    @property
    def turn(self) -> float:
        """Return the angle of the arc [rad]."""
        return pi - 2 * self.lift

    @property
    def is_lined(self) -> bool:
        """Return whether there is a lining."""
        return self.lining > self.bore

    @property
    def is_split(self) -> bool:
        """Return whether the groove divides the lining into two rings."""
        deep = self.groove and self.groove.is_whole and self.groove.bottom > self.lining
        return bool(self.is_lined and deep)

    def back_section(self) -> list[Point]:
        """Return the section of the steel back as a closed line through (r, z), without a groove."""
        return outline(*self._back_ends())

    def _back_ends(self, *groove: Point) -> list[Point]:
        b, edge = self.half_width, max(self.bore + self.inner_chamfer - self.lining, 0.0)
        flanges = self.flange.count if self.flange else 0
        low, high = self._end(flanges == 2), self._end(flanges >= 1)
        ends = [(r, -b + up) for r, up in low] + [(r, b - up) for r, up in reversed(high)]
        inside = self.lining
        return [
            (inside, edge - b),
            (inside + edge, -b),
            *ends,
            (inside + edge, b),
            (inside, b - edge),
            *groove,
        ]

    def _end(self, has_flange: bool) -> list[Point]:
        """Return the corners of one end of the back, as radius and distance from that end."""
        if has_flange and self.flange:
            collar = self.flange
            return [(collar.radius, 0.0), (collar.radius, collar.thickness), (self.outside, collar.thickness)]
        return [(self.outside - self.outer_chamfer, 0.0), (self.outside, self.outer_chamfer)]

    def back_joint(self) -> list[Point]:
        """Return the section of the back at its joint, minus a groove that extends to the joint."""
        return outline(*self._back_ends(*self._notch(self.lining, self.outside)))

    def lining_joint(self) -> list[Point]:
        """Return the section of the lining at its joint.

        If the groove divides the lining, return the section of the piece on the side +z.
        """
        b, c, s = self.half_width, self.inner_chamfer, self.lining
        inside = self.eccentric.joint + (self.relief.depth if self.relief else 0.0)
        up = [(s, max(self.bore + c - s, 0.0)), (min(self.bore + c, s), max(self.bore + c - s, 0.0))]
        up.append((inside, max(self.bore + c - inside, 0.0)))
        if c == 0:
            up = [(s, 0.0), (inside, 0.0)]
        high = [(r, b - down) for r, down in up]
        if self.is_split and self.groove:
            w = self.groove.half_width
            return outline((inside, w), (s, w), *high)
        low = [(r, down - b) for r, down in reversed(up)]
        return outline(*low, *high, *self._notch(inside, s))

    def _notch(self, inside: float, outside: float) -> list[Point]:
        """Return the corners of a groove that extends from joint to joint, above the inside."""
        groove = self.groove
        if groove is None or not groove.is_whole or groove.bottom <= inside or groove.bottom >= outside:
            return []
        w = groove.half_width
        return [(inside, w), (groove.bottom, w), (groove.bottom, -w), (inside, -w)]

    def back(self) -> Shape:
        """Return the steel back: the section revolved, with legs and lip, minus groove and hole."""
        body = turned(self.back_section(), degrees(self.lift), degrees(self.turn))
        if self.groove and self.groove.bottom > self.lining:
            body = cut(body, self._ring(self.groove))
        if self.hole > 0:
            body = cut(body, drill(self.hole, self.outside))
        body = self._with_legs(body, self.back_joint())
        return fuse(body, self._lip(self.tang)) if self.tang else body

    def _with_legs(self, body: Shape, joint: list[Point]) -> Shape:
        """Return a body extended by the crush height below both joints."""
        if self.crush == 0:
            return body
        if self.lift > 0:
            return fuse(body, *(self._leg(body, side) for side in (1, -1)))
        for side in (1, -1):
            foot = face(polyline(*(Vector(side * r, 0.0, z) for r, z in joint)))
            body = fuse(body, extrude(foot, (0, -self.crush, 0)))
        return body

    def _leg(self, body: Shape, side: int) -> Shape:
        """Extrude the joint face to a leg.

        Another face with vertices that differ by 1e-15 mm would change the bytes.
        """
        normal = Vector(side * sin(self.lift), -cos(self.lift), 0)
        feet = [f for f in body.Faces() if f.geomType() == "PLANE" and f.normalAt().dot(normal) > 1 - 1e-12]
        foot = min(feet, key=lambda f: abs(f.Center().dot(normal)))
        return extrude(foot, (normal * self.crush).toTuple())

    def _at_joint(self, body: Shape, side: int) -> Shape:
        """Rotate a shape that was built at y = 0 to the joint on the given side."""
        if self.lift == 0:
            return body
        return body.rotate(Vector(0, 0, 0), Vector(0, 0, 1), degrees(side * self.lift))

    def _lip(self, tang: Tang) -> Shape:
        """Return the box of the locating lip, which begins inside the back."""
        edge = sqrt(self.outside**2 - tang.length**2)
        foot = edge - 0.1 * (self.outside - self.lining)
        if self.groove and self.groove.bottom >= foot:
            foot = (edge + self.groove.bottom) / 2  # the lip never fills the groove below it
        lip = Solid.makeBox(
            self.outside + tang.height - foot, tang.length + self.crush, tang.width,
            Vector(foot, -self.crush, tang.z - tang.width / 2),
        )  # fmt: skip
        return self._at_joint(lip, 1)

    def _ring(self, groove: Groove) -> Shape:
        """Return the solid that the groove removes; it begins inside the bore."""
        w, low = groove.half_width, 0.9 * self.bore
        section = outline((low, -w), (groove.bottom, -w), (groove.bottom, w), (low, w))
        turn = 180.0 + 2 * _BEYOND if groove.is_whole else degrees(groove.turn)
        return turned(section, 90 - turn / 2, turn)

    def lining_piece(self) -> Shape:
        """Return the lining, or its half on the side +z if the groove divides it.

        See `lining_places`.
        """
        low = self.groove.half_width if self.is_split and self.groove else -self.half_width
        body: Shape = extrude(self._lining_face(low), (0, 0, self.half_width - low))
        if self.inner_chamfer > 0:
            for side in (1,) if self.is_split else (1, -1):
                body = cut(body, self._cone(side))
        if self.groove and not self.is_split:
            body = cut(body, self._ring(self.groove))
        if self.hole > 0:
            body = cut(body, drill(self.hole, self.outside))
        return self._with_legs(body, self.lining_joint())

    def _cone(self, side: int) -> Shape:
        """Return the solid, slightly oversized, that the chamfer of the bore removes at one end."""
        c, b, r = self.inner_chamfer, self.half_width, self.bore
        over, inside = 0.5 * c, 0.1 * r
        section = outline(
            (r - inside, side * (b - c - inside)), (r + c + over, side * (b + over)),
            (r - inside, side * (b + over)),
        )  # fmt: skip
        return turned(section, -_BEYOND, 180.0 + 2 * _BEYOND)

    def _lining_face(self, z: float) -> Shape:
        """Return the cross-section of the lining with both reliefs."""
        right, left = self.lift, pi - self.lift
        edges = [self._arc(self.lining, right, left, z)]
        deep, inner = self.eccentric.joint, [self._arc(self.bore, right, left, z)]
        if self.offset > 0:
            ends = [self._at(deep, end, z) for end in (right, left)]
            inner = [Edge.makeThreePointArc(ends[0], Vector(0, self.bore, z), ends[1])]
        if self.relief:
            deep, angle = self.bore + self.relief.depth, self.relief.angle
            inner = [
                self._arc(self.bore, right + angle, left - angle, z),
                *(self._relief_arc(self.relief, joint, sign, z) for joint, sign in ((right, 1), (left, -1))),
            ]
        edges += [segment(self._at(deep, end, z), self._at(self.lining, end, z)) for end in (right, left)]
        return face(wire(*edges, *inner))

    def _relief_arc(self, relief: Relief, joint: float, sign: int, z: float) -> Shape:
        return Edge.makeThreePointArc(*(self._at(r, joint + sign * angle, z) for r, angle in relief.arc()))

    def _arc(self, radius: float, low: float, high: float, z: float) -> Shape:
        return Edge.makeThreePointArc(*(self._at(radius, a, z) for a in (low, (low + high) / 2, high)))

    def _at(self, radius: float, angle: float, z: float) -> Vector:
        if angle in (0.0, pi):
            return Vector(radius if angle == 0 else -radius, 0, z)
        return Vector(radius * cos(angle), radius * sin(angle), z)

    def lining_places(self) -> tuple[Location, ...]:
        """Return the axial ranges of the lining: one, or one on each side of the groove."""
        other = Location(Vector(0, 0, 0), Vector(0, 1, 0), 180)
        return (Location(), other) if self.is_split else (Location(),)

    def back_volume(self) -> float:
        """Return the volume of the back: revolved section, legs and lip, minus groove and hole [mm³]."""
        volume = (
            turned_volume(self.back_section(), degrees(self.turn)) + 2 * area(self.back_joint()) * self.crush
        )
        if self.tang:
            reach, length = self.outside + self.tang.height, self.tang.length
            lip = reach * length - sheet_under_arc(self.outside, length) / 2
            volume += (lip + self.tang.height * self.crush) * self.tang.width
        taken = self._groove_between(self.lining, self.outside) + self._hole(self.lining, self.outside)
        return volume - taken

    def lining_volume(self) -> float:
        """Return the volume of the whole lining, in one piece or two [mm³]."""
        r, s = self.bore, self.lining
        volume = self.eccentric.sector(s, self.turn) * 2 * self.half_width
        volume += 2 * area(self.lining_joint()) * self.crush * (2 if self.is_split else 1)
        volume -= self._groove_between(r, s) + self._hole(r, s) + 2 * self._chamfer()
        if self.relief:
            whole = self.groove and self.groove.is_whole
            width = 2 * self.half_width - (2 * self.groove.half_width if whole and self.groove else 0.0)
            volume -= 2 * self.relief.area() * width - 4 * self._relief_in_chamfer(self.relief)
        return volume

    def _groove_between(self, inside: float, outside: float) -> float:
        if self.groove is None or self.groove.bottom <= inside:
            return 0.0
        turn = self.turn if self.groove.is_whole else self.groove.turn
        within = EccentricBore(inside, self.offset if inside == self.bore else 0.0)
        return within.sector(min(self.groove.bottom, outside), turn) * 2 * self.groove.half_width

    def _hole(self, inside: float, outside: float) -> float:
        offset = self.offset if inside == self.bore else 0.0
        if self.groove is None or self.groove.bottom <= inside:
            return drilled_volume(self.hole, outside, inside, offset=offset)
        bottom = min(self.groove.bottom, outside)
        return drilled_volume(self.hole, outside, inside, bottom, self.groove.half_width, offset)

    def _chamfer(self) -> float:
        """Return the volume of lining that the bore's chamfer removes at one end [mm³]."""
        c, r = self.inner_chamfer, self.bore
        if c == 0:
            return 0.0
        if self.offset > 0:
            return self.eccentric.chamfered(c, self.lining)
        reach = min(c, self.lining - r)
        section = outline((r, 0.0), (r, c), (r + reach, c - reach), (r + reach, 0.0))
        return turned_volume(section, degrees(self.turn))

    def _relief_in_chamfer(self, relief: Relief) -> float:
        """Return the volume that belongs to both a chamfer and a relief [mm³]."""
        c, r = self.inner_chamfer, self.bore
        if c == 0:
            return 0.0

        def ring(s: float) -> float:
            return s * relief.angle_at(s) * (c - (s - r))

        return float(quad(ring, r, r + min(c, relief.depth), epsabs=0, epsrel=1e-10)[0])


class FullBush(HalfShell):
    """A full bush without joints: a groove from joint to joint becomes a ring; the hole is at the crown."""

    @property
    def turn(self) -> float:
        """Return a full turn [rad]."""
        return 2 * pi

    def back(self) -> Shape:
        """Return the steel back: the revolved section with its ring groove, minus other cuts."""
        body = turned(self.back_joint())
        if self.groove and not self.groove.is_whole and self.groove.bottom > self.lining:
            body = cut(body, self._ring(self.groove))
        return cut(body, drill(self.hole, self.outside)) if self.hole > 0 else body

    def lining_piece(self) -> Shape:
        """Return the lining, or its ring on the side +z if the groove divides it."""
        body = turned(self.lining_joint())
        if self.groove and not self.groove.is_whole:
            body = cut(body, self._ring(self.groove))
        return cut(body, drill(self.hole, self.outside)) if self.hole > 0 else body
