"""Thrust washer: a flat ring or a half ring with radial oil grooves, a pin hole, and a locating lug.

The docstring of the class below explains the parameters to users.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import atan2, cos, degrees, pi, radians, sin, sqrt

import numpy as np
from cadquery import Edge, Shape, Solid, Vector
from cadquery.func import cut, extrude, face, segment, wire

from cad.model import BRONZE, Box, CadModel, Part, mm
from cad.revolution import nearest, sheet_under_arc
from cad.surfaces import PartSurfaces, Size, Surface, X, Y, Z
from templates.core.language.template import (
    Array,
    Truth,
    choice,
    derived,
    formula,
    given,
    require,
    units,
)


@units("m", returns="1")
def drawable(length: Array) -> Truth:
    """Return whether a length [m] is 0, or large enough for the kernel."""
    return (length <= 0) | (length >= 1e-5)


@units(None, "1", returns="rad")
def half_pitch(washer: str, grooves: Array) -> Array:
    """Return half the angle [rad] between neighbouring grooves.

    In a half washer this is also the angle from the joint to the first groove.
    """
    turn = {"full": 2 * pi, "half": pi}[washer]
    return np.minimum(turn / (2 * np.maximum(grooves, 1)), pi / 2)


@units(None, "1", returns="1")
def is_free_at_crown(washer: str, grooves: Array) -> Truth:
    """Return whether there is no groove at the crown, where the lug is."""
    return (np.mod(grooves, 2) == 0) | (washer == "full")


@units(None, "m", returns="1")
def takes_a_pin(washer: str, hole: Array) -> Truth:
    """Return whether a pin hole is allowed: there is none, or the washer is a full ring."""
    return (hole <= 0) | (washer == "full")


@dataclass(frozen=True)
class Washer:
    """Sizes of a washer [mm]: radii, and angles in degrees from +x."""

    bore: float
    outside: float
    thickness: float
    is_half: bool
    grooves: int
    half_groove: float
    groove_depth: float
    pin: float
    pin_circle: float
    half_lug: float
    lug_height: float

    def groove_angles(self) -> list[float]:
        """Return the angles of the grooves; a full ring has no groove at its crown."""
        if self.is_half:
            return [180 * (n + 0.5) / self.grooves for n in range(self.grooves)]
        return [90 + 360 * (n + 0.5) / self.grooves for n in range(self.grooves)]

    def pin_angle(self) -> float:
        """Return the angle midway between two grooves, or opposite the crown if there are no grooves."""
        return 90 + 360 / self.grooves * (self.grooves // 2) if self.grooves else 270.0

    def solid(self) -> Shape:
        """Return the face extruded by the thickness, minus pin hole and grooves."""
        body: Shape = extrude(face(*self._wires()), (0, 0, self.thickness))
        tools = [self._groove(angle) for angle in self.groove_angles()]
        if self.pin > 0:
            a = radians(self.pin_angle())
            foot = Vector(self.pin_circle * cos(a), self.pin_circle * sin(a), -self.thickness)
            tools.append(Solid.makeCylinder(self.pin, 3 * self.thickness, foot, Vector(0, 0, 1)))
        for tool in tools:
            body = cut(body, tool)
        return body

    def _groove(self, angle: float) -> Shape:
        """Return a box from the axis to beyond the outside, with its bottom at that of the groove."""
        box = Solid.makeBox(
            1.5 * self.outside, 2 * self.half_groove, self.thickness,
            Vector(0, -self.half_groove, self.thickness - self.groove_depth),
        )  # fmt: skip
        return box.rotate(Vector(0, 0, 0), Vector(0, 0, 1), angle)

    def _wires(self) -> list[Shape]:
        """Return the outline with the lug at the crown; for a full ring also the outline of the bore."""
        arc = self._arc_outside()
        if self.is_half:
            inner = Edge.makeThreePointArc(*(Vector(self.bore * x, self.bore * y) for x, y in
                                             ((-1, 0), (0, 1), (1, 0))))  # fmt: skip
            ends = (
                self._line((-self.outside, 0), (-self.bore, 0)),
                self._line((self.bore, 0), (self.outside, 0)),
            )
            return [wire(*arc, *ends, inner)]
        return [wire(*arc), wire(Edge.makeCircle(self.bore))]

    def _arc_outside(self) -> list[Shape]:
        """Return the outer arc from +x (half) or -y (full) over the crown to the other end."""
        R, a = self.outside, self.half_lug
        if a == 0:
            return [self._arc(0.0, 180.0)] if self.is_half else [Edge.makeCircle(R)]
        foot = sqrt(R * R - a * a)
        corners = [(a, foot), (a, R + self.lug_height), (-a, R + self.lug_height), (-a, foot)]
        lug = [self._line(one, other) for one, other in pairwise(corners)]
        turn = degrees(atan2(foot, a))
        if self.is_half:
            return [self._arc(0.0, turn), *lug, self._arc(180 - turn, 180.0)]
        return [self._arc(180 - turn, 360 + turn), *lug]

    def _arc(self, low: float, high: float) -> Shape:
        angles = (radians(a) for a in (low, (low + high) / 2, high))
        return Edge.makeThreePointArc(*(Vector(self.outside * cos(a), self.outside * sin(a)) for a in angles))

    def _line(self, one: tuple[float, float], other: tuple[float, float]) -> Shape:
        return segment(Vector(*one), Vector(*other))

    def volume(self) -> float:
        """Return the volume of ring and lug minus pin hole and grooves, which do not intersect [mm³]."""
        ring = pi * (self.outside**2 - self.bore**2) / (2 if self.is_half else 1)
        lug = 2 * self.half_lug * (self.outside + self.lug_height) if self.half_lug > 0 else 0.0
        lug -= sheet_under_arc(self.outside, self.half_lug)
        taken = self.grooves * self._under_groove() * self.groove_depth
        return (ring + lug - pi * self.pin**2) * self.thickness - taken

    def _under_groove(self) -> float:
        """Return the area of a groove, seen along the shaft [mm²]."""
        if self.grooves == 0:
            return 0.0
        outside, bore = (sheet_under_arc(r, self.half_groove) for r in (self.outside, self.bore))
        return outside - bore


class ThrustWasher(CadModel):
    """Thrust washer: a full ring, or a half washer next to a main bearing of an engine.

    z is along the shaft; the back is at z = 0, the running face with its oil grooves at z = thickness. A half
    washer is on the side +y, with its joint in the plane y = 0. The grooves run from the bore to the outside,
    have a rectangular section, and are evenly spaced; in a half washer the first is half a pitch from the
    joint. The locating lug is at the crown +y and as thick as the washer; the hole for a pin is between two
    grooves of a full ring. A number or size of 0 omits the grooves, the lug or the hole.

    Limits
    ------
    The washer is one solid of copper alloy; a steel back and chamfers are not drawn. The default proportions
    are typical of makers (outer diameter 1.6 times, thickness 8 % of the inner diameter) and do not come from
    a standard. A full ring has the features of ISO 6525, a half washer those of ISO 6526.

    References
    ----------
    ISO 6525:1983, Plain bearings, ring type thrust washers made from strip, dimensions and tolerances.
    ISO 6526:1983, Plain bearings, pressed bimetallic half thrust washers, features and tolerances.
    """

    example = {
        "inner_diameter": "42 mm",
        "outer_diameter": "66 mm",
        "thickness": "2.5 mm",
        "oil_grooves": 3,
        "oil_groove_width": "3 mm",
        "oil_groove_depth": "0.6 mm",
        "pin_hole_diameter": "4 mm",
        "pin_circle_diameter": "54 mm",
        "lug_width": "10 mm",
        "lug_height": "4 mm",
    }

    toleranced = {
        "inner_diameter": {"datum": "A"},
        "outer_diameter": {},
        "thickness": {"perpendicularity": 1, "to": "A"},
        "pin_hole_diameter": {},
        "pin_circle_diameter": {},
        "oil_groove_width": {},
        "oil_groove_depth": {},
        "lug_width": {},
        "lug_height": {},
    }

    d: Array = given("mm", "inner diameter", symbol="d", ge=1, le=2000, also=("bearing diameter", "bore"))

    @derived("mm", "outer diameter", symbol="D", ge=1, le=10000)
    def D(self) -> Array:
        return 1.6 * self.d

    @derived("mm", "thickness", symbol="t", ge=0.01, le=1000)
    def t(self) -> Array:
        return 0.08 * self.d

    washer: str = choice("full", "half", words="washer", default="full")

    n_g: Array = given("1", "oil grooves", symbol="n_g", default="0", integer=True, ge=0, le=32)

    @derived("mm", "oil groove width", symbol="w_g", ge=0.01, le=500)
    def w_g(self) -> Array:
        return 0.06 * self.d

    @derived("mm", "oil groove depth", symbol="t_g", ge=0.001, le=500)
    def t_g(self) -> Array:
        return 0.3 * self.t

    @derived("mm", "pin hole diameter", symbol="d_p", ge=0, le=500)
    def d_p(self) -> Array:
        """Return the default: no hole for a pin."""
        return 0 * self.d

    @derived("mm", "pin circle diameter", symbol="D_p", ge=1, le=10000)
    def D_p(self) -> Array:
        return (self.d + self.D) / 2

    @derived("mm", "lug width", symbol="w_l", ge=0, le=1000)
    def w_l(self) -> Array:
        """Return the default: no lug."""
        return 0 * self.d

    @derived("mm", "lug height", symbol="h_l", ge=0.01, le=1000)
    def h_l(self) -> Array:
        return 0.1 * self.d

    @formula("mm", "chord from groove to groove at the bore", name="groove_chord", symbol="p_g")
    def p_g(self) -> Array:
        """Pitch of the grooves.

        In a half washer it is also twice the distance from the joint to the first groove.
        """
        return self.d * np.sin(half_pitch(self.washer, self.n_g))

    @require("outer_diameter", "inner_diameter", remedy="make the outer diameter larger")
    def has_a_face(self) -> Truth:
        """The outer diameter is at least 2 % larger than the inner one."""
        return self.D >= 1.02 * self.d

    @require("oil_groove_depth", "thickness", remedy="make the grooves shallower or the washer thicker")
    def grooves_have_a_bottom(self) -> Truth:
        """The depth of the oil grooves is at least 10 µm and at most 80 % of the thickness."""
        return (self.n_g <= 0) | ((self.t_g <= 0.8 * self.t) & drawable(self.t_g))

    @require("oil_groove_width", "oil_grooves", "inner_diameter", remedy="take fewer or narrower grooves")
    def grooves_keep_apart(self) -> Truth:
        """Oil grooves do not meet each other or the joint at the bore: at least 5 % of the pitch is left."""
        return (self.n_g <= 0) | (self.w_g <= 0.95 * self.p_g)

    @require("pin_hole_diameter", "washer", remedy="take a full ring, or 0 for no hole")
    def pin_holds_a_full_ring(self) -> Truth:
        """Only a full ring has a hole for a pin; a half washer is held by its lug."""
        return takes_a_pin(self.washer, self.d_p)

    @require(
        "pin_hole_diameter", "pin_circle_diameter", "inner_diameter", "outer_diameter",
        remedy="make the hole smaller, or move its circle",
    )  # fmt: skip
    def pin_keeps_within_the_face(self) -> Truth:
        """The hole for a pin lies within the face, clear of its edges by 1 % of the diameters."""
        inside = (self.D_p - self.d_p >= 1.01 * self.d) & (self.D_p + self.d_p <= 0.99 * self.D)
        return (self.d_p <= 0) | inside

    @require(
        "pin_hole_diameter", "oil_groove_width", "oil_grooves", "pin_circle_diameter",
        remedy="make the hole smaller, or take fewer or narrower grooves",
    )  # fmt: skip
    def pin_clears_grooves(self) -> Truth:
        """The hole for a pin is clear of the grooves next to it by 2 %."""
        clear = self.D_p * np.sin(half_pitch(self.washer, self.n_g)) >= 1.02 * (self.d_p + self.w_g)
        return (self.d_p <= 0) | (self.n_g <= 0) | clear

    @require("lug_width", "outer_diameter", remedy="make the lug narrower")
    def lug_is_narrow(self) -> Truth:
        """The lug is at most 80 % as wide as the washer."""
        return self.w_l <= 0.8 * self.D

    @require("lug_width", "oil_grooves", "washer", remedy="take an even number of grooves, or no lug")
    def lug_has_no_groove(self) -> Truth:
        """No groove of a half washer runs into its lug, so the number of grooves is even."""
        return (self.w_l <= 0) | is_free_at_crown(self.washer, self.n_g)

    @require(
        "lug_width", "oil_groove_width", "oil_grooves", "outer_diameter",
        remedy="make the lug narrower, or take fewer or narrower grooves",
    )  # fmt: skip
    def lug_clears_grooves(self) -> Truth:
        """The lug is clear of the grooves next to it by 2 % of their width."""
        foot = np.sqrt(np.maximum(self.D**2 - self.w_l**2, 0 * self.D**2))
        turn = half_pitch(self.washer, self.n_g)
        clear = foot * np.sin(turn) - self.w_l * np.cos(turn) >= 1.02 * self.w_g
        return (self.w_l <= 0) | (self.n_g <= 0) | clear

    @require("pin_hole_diameter", "lug_width", remedy="use 0 for none")
    def features_are_drawable(self) -> Truth:
        """The sizes of the pin hole and the lug are 0, or at least 10 µm so that the kernel is reliable."""
        return drawable(self.d_p) & drawable(self.w_l)

    def build(self) -> tuple[Part, ...]:
        """Return one washer."""
        washer = self.drawn()
        return (Part("washer", washer.solid(), washer.volume(), BRONZE, density=8800, material="CuSn8P"),)

    def drawn(self) -> Washer:
        """Return the parameters converted to radii and half lengths."""
        return Washer(
            bore=mm(self.d) / 2,
            outside=mm(self.D) / 2,
            thickness=mm(self.t),
            is_half=self.washer == "half",
            grooves=round(float(self.n_g)),
            half_groove=mm(self.w_g) / 2,
            groove_depth=mm(self.t_g),
            pin=mm(self.d_p) / 2,
            pin_circle=mm(self.D_p) / 2,
            half_lug=mm(self.w_l) / 2,
            lug_height=mm(self.h_l),
        )

    def bounding_box(self) -> Box:
        """Return a box as wide as the outer diameter and as high as the lug.

        The box of a half washer is on the crown's side.
        """
        R, top = mm(self.D) / 2, mm(self.D) / 2 + (mm(self.h_l) if self.w_l > 0 else 0.0)
        return Box((-R, 0.0 if self.washer == "half" else -R, 0.0), (R, top, mm(self.t)))

    def dimensions(self, seen: Mapping[str, PartSurfaces]) -> dict[str, float]:
        """Return every parameter; the sizes of grooves, pin hole and lug only if they exist."""
        washer, wanted = seen["washer"], self.drawn()
        about, levels = washer.diameters(Z), washer.levels(Z)
        outside = washer.rings(Z)[-1]
        pins = [c for c in washer.cylinders if c.along(Z) and not c.about(Z)]
        sizes: dict[str, float] = {
            "inner_diameter": about[0],
            "outer_diameter": about[-1],
            "thickness": washer.length(Z),
            "oil_grooves": 0.0,
            "pin_hole_diameter": Size.diameter(pins) if pins else 0.0,
        }
        if len(levels) == 3:
            floors = [p for p in washer.planes if p.along(Z) and abs(p.point.z - levels[1]) < 1e-6]
            within = (levels[1] + levels[2]) / 2
            upright = [p for p in washer.planes if not p.along(Z) and p.middle is not None]
            sides = [p for p in upright if p.middle and abs(p.middle.z - within) < 1e-6]
            width = nearest((2 * abs(p.point.dot(p.direction)) for p in sides), 2 * wanted.half_groove)
            faces = [p for p in sides if abs(2 * abs(p.point.dot(p.direction)) - width) < 1e-6]
            sizes["oil_grooves"] = float(len(floors))
            sizes["oil_groove_width"] = Size.repeated(_across(width, faces), "oil grooves")
            sizes["oil_groove_depth"] = washer.between(Z, 1, 2)
        if pins:
            sizes["pin_circle_diameter"] = Size.circle(pins, washer.rings(Z)[0])
        if wanted.half_lug > 0:
            half, top = nearest((abs(x) for x in washer.levels(X)), wanted.half_lug), washer.levels(Y)[-1]
            sizes["lug_width"] = washer.apart(X, -half, half, Vector(0, top, 0))
            sizes["lug_height"] = Size.distance(top - about[-1] / 2, outside, washer.planes_at(Y, top))
        return sizes


def _across(width: float, sides: Sequence[Surface]) -> Iterator[Size]:
    """Yield the width of each groove, between its two sides."""
    grooves = defaultdict[tuple[float, float], list[Surface]](list)
    for side in sides:
        along = side.direction.cross(Z)
        outwards = along if side.middle is not None and along.dot(side.middle) > 0 else -along
        grooves[round(outwards.x, 6) + 0.0, round(outwards.y, 6) + 0.0].append(side)
    for one, other in grooves.values():
        yield Size.distance(width, [one], [other])
