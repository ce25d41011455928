"""Read the parameters of a shaft of many throws back from the surfaces of the finished solid.

Each feature is recognised by its position, never by its expected size: the planes across the shaft are, in
order, the faces of the ends and of the webs. Where all throws share a dimension, each throw must have it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import atan2, degrees, hypot, pi, radians, remainder

from cadquery import Vector

from cad.cranks.throw_readback import Webs, stubs
from cad.surfaces import PartSurfaces, Surface, Z

_CLEAR = 1e-6  # [mm], and as the sine of an angle
_ANGLE = 1e-8  # [rad]


def alike(values: Iterable[float], what: str) -> float:
    """Return the one value of a dimension that several features share.

    Raises
    ------
    LookupError
        If there is none, or they differ.
    """
    found = list(values)
    if not found or max(found) - min(found) > 2 * _CLEAR:
        raise LookupError(f"all {what} must have one size; the file has {found}")
    return sum(found) / len(found)


@dataclass(frozen=True)
class ThrowReadback:
    """A throw: its pins, and where the faces of its webs lie [mm], from front to rear.

    An undivided pin counts once; split pins count as two, with a middle web between them.
    """

    pins: tuple[Surface, ...]
    faces: tuple[float, ...]

    @property
    def angles(self) -> tuple[float, float]:
        """Return the angles of the pins beside its front and its rear web, from x towards y [rad]."""
        first, last = (atan2(pin.point.y, pin.point.x) for pin in (self.pins[0], self.pins[-1]))
        return first, last

    @property
    def pin_spans(self) -> list[tuple[float, float]]:
        """Return from where to where its pins reach, with their fillets."""
        return [(self.faces[at], self.faces[at + 1]) for at in range(1, len(self.faces) - 1, 2)]

    @property
    def webs(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return from where to where its webs reach, the middle one left out."""
        return self.faces[:2], self.faces[-2:]


@dataclass(frozen=True)
class ShaftReadback:
    """The features of a shaft of many throws, as read from its surfaces; `split` if its pins are."""

    seen: PartSurfaces
    split: bool = False

    @cached_property
    def beside(self) -> list[Surface]:
        """Return the cylinders along the shaft that do not turn about its axis."""
        return [c.turned(Z) for c in self.seen.cylinders if c.along(Z) and not c.about(Z)]

    @cached_property
    def throws(self) -> list[ThrowReadback]:
        """Return the throws, from front to rear.

        Each has four planes across the shaft, six with split pins. Before them lie the end of the nose and
        its shoulder, if it has one; behind them at most three: shoulder of the flange, bottom of its holes,
        its end.

        Raises
        ------
        LookupError
            If there is none, or one without a pin.
        """
        levels = self.seen.levels(Z)
        first = 1 + any(_spans(c, levels[0], levels[1]) for c in self.seen.about(Z))
        found = []
        count = 6 if self.split else 4
        for place in range(first, len(levels) - count, count):
            faces = tuple(levels[place : place + count])
            pins = (self._pin_between(*faces[at : at + 2]) for at in range(1, count - 1, 2))
            found.append(ThrowReadback(tuple(pins), faces))
        if not found:
            raise LookupError("there is no pin between two webs")
        return found

    def _pin_between(self, low: float, high: float) -> Surface:
        pins = self._beside_within(low, high)
        if not pins:
            raise LookupError(f"there is no pin between the webs at {low:.9g} and {high:.9g} mm")
        return max(pins, key=lambda c: c.diameter)

    def _beside_within(self, low: float, high: float) -> list[Surface]:
        """Return the cylinders along the shaft, not about it, within a stretch of it."""
        return [c for c in self.beside if low - _CLEAR < c.reach[0] and c.reach[1] < high + _CLEAR]

    @property
    def ends(self) -> tuple[list[Surface], list[Surface]]:
        """Return the cylinders about the shaft before the first web and behind the last, from the web on."""
        first, last = self.throws[0].faces, self.throws[-1].faces
        return stubs(self.seen, Webs((first[0], first[1], last[-2], last[-1])))

    def common(self) -> dict[str, float]:
        """Return the dimensions that all throws share."""
        throws = self.throws
        return {
            **self._journals(),
            "pin_diameter": alike((pin.diameter for t in throws for pin in t.pins), "pins"),
            "pin_length": alike((high - low for t in throws for low, high in t.pin_spans), "pins"),
            "throw": alike((hypot(p.point.x, p.point.y) for t in throws for p in t.pins), "throws"),
            "pin_bore": self._each(self._pin_bore, "pin bores"),
            "web_thickness": alike((high - low for t in throws for low, high in t.webs), "webs"),
            "web_width": self.web_width,
            "fillet": self._fillet(),
            "oil_drilling_diameter": self._drilling(),
            "face_inclination": self._inclination(),
        }

    def _journals(self) -> dict[str, float]:
        front, rear = (end[0] for end in self.ends)
        first, last = self.throws[0].faces[0], self.throws[-1].faces[-1]
        lengths, diameters = [front.reach[1] + first, rear.reach[1] - last], [front.diameter, rear.diameter]
        for before, behind in zip(self.throws[:-1], self.throws[1:], strict=True):
            low, high = before.faces[-1], behind.faces[0]
            lengths.append(high - low)
            diameters.append(max((c.diameter for c in self._about(low, high)), default=0.0))
        return {
            "journal_diameter": alike(diameters, "journals"),
            "journal_length": alike(lengths, "journals"),
            "journal_bore": self._each(self._journal_bore, "journal bores"),
        }

    def _about(self, low: float, high: float) -> list[Surface]:
        """Return the cylinders about the shaft within a stretch of it."""
        cylinders = self.seen.about(Z)
        return [c for c in cylinders if low - _CLEAR < c.reach[0] and c.reach[1] < high + _CLEAR]

    def _each(self, read: Callable[[ThrowReadback], float], what: str) -> float:
        return alike(map(read, self.throws), what)

    def _pin_bore(self, throw: ThrowReadback) -> float:
        """Return the diameter of the cylinder that continues from each pin through its webs."""
        if self.split:
            inner = throw.faces[1], throw.faces[-2]
            crossing = (
                [c for c in self.beside if c.reach[0] < z - _CLEAR < z + _CLEAR < c.reach[1]] for z in inner
            )
            return alike((max((c.diameter for c in each), default=0.0) for each in crossing), "pin bores")
        _, front, rear, _ = throw.faces
        through = (c for c in self.beside if c.reach[0] < front - _CLEAR and rear + _CLEAR < c.reach[1])
        return max((c.diameter for c in through), default=0.0)

    def _journal_bore(self, throw: ThrowReadback) -> float:
        """Return the diameter of the cylinder about the shaft that passes through both outer faces."""
        sizes = []
        for face in (throw.faces[0], throw.faces[-1]):
            through = (
                c for c in self.seen.about(Z) if c.reach[0] < face - _CLEAR < face + _CLEAR < c.reach[1]
            )
            sizes.append(max((c.diameter for c in through), default=0.0))
        return alike(sizes, "journal bores")

    @property
    def web_width(self) -> float:
        """Return twice the distance of the sides of webs from the axis, the nearest planes along it."""
        along = [p for p in self.seen.planes if abs(p.direction.dot(Z)) < _CLEAR]
        for normal, distance in self._sides_of_middle_webs() if self.split else ():
            sides = [plane for plane in along if _lies(plane, normal, distance)]
            if not sides:
                raise LookupError("the sides of the middle webs are missing")
            along.remove(sides[0])
        distances = [d for d in (abs(p.point.dot(p.direction)) for p in along) if d > _CLEAR]
        if not distances:
            raise LookupError("the sides of the webs are missing")
        return 2 * min(distances)

    def _sides_of_middle_webs(self) -> Iterator[tuple[Vector, float]]:
        """Yield the normal of each side of each middle web, and its distance from the axis along it."""
        half = self.middle_web()["middle_web_width"] / 2
        for throw in self.throws:
            first, last = (Vector(pin.point.x, pin.point.y, 0) for pin in throw.pins)
            normal = (last - first).cross(Z).normalized()
            for side in (-half, half):
                yield normal, first.dot(normal) + side

    def middle_web(self) -> dict[str, float]:
        """Return the thickness of the middle webs, and their width, which is that of their round ends."""
        spans = [throw.faces[2:4] for throw in self.throws]
        ends = (c.diameter for low, high in spans for c in self._beside_within(low, high))
        return {
            "middle_web_thickness": alike((high - low for low, high in spans), "middle webs"),
            "middle_web_width": alike(ends, "middle webs"),
        }

    def pin_split(self, near: float) -> float:
        """Return the angle from front to rear pins [deg], in the turn nearest to the requested angle."""
        turns = [degrees(rear - front) for front, rear in (throw.angles for throw in self.throws)]
        return near + alike((remainder(turn - near, 360) for turn in turns), "split pins")

    def _fillet(self) -> float:
        tori = self.seen.tori
        each = 6 if self.split else 4
        if tori and len(tori) != each * len(self.throws):
            raise LookupError(f"each throw must have {each} fillets; all throws have {len(tori)}")
        return alike(tori, "fillets") if tori else 0.0

    def _drilling(self) -> float:
        askew = [c.diameter for c in self.seen.cylinders if not c.along(Z)]
        if askew and len(askew) < sum(len(throw.pins) for throw in self.throws):
            raise LookupError(f"each pin must have a drilling; all pins have {len(askew)}")
        return alike(askew, "oil drillings") if askew else 0.0

    def _inclination(self) -> float:
        """Return the angle [deg] of the planes that are inclined to the shaft."""
        normals = [p.direction for p in self.seen.planes]
        leaning = [n for n in normals if min(hypot(n.x, n.y), abs(n.z)) > _CLEAR]
        return (
            alike((degrees(atan2(hypot(n.x, n.y), abs(n.z))) for n in leaning), "faces") if leaning else 0.0
        )

    def pin_angles(self, near: Sequence[float]) -> list[float]:
        """Return the pin angles [deg], in the turn that is nearest to the requested angles [deg]."""
        seen = [degrees(throw.angles[0]) for throw in self.throws]
        if len(seen) != len(near):
            raise LookupError(f"there must be {len(near)} throws; there are {len(seen)}")
        return [wanted + remainder(angle - wanted, 360) for angle, wanted in zip(seen, near, strict=True)]

    def counterweights(self) -> list[float]:
        """Return the radius of each web's counterweight [mm]; 0 for none."""
        width = self.web_width
        rims = ([c.diameter for c in self._about(*web)] for throw in self.throws for web in throw.webs)
        return [max((d for d in rim if d > 1.01 * width), default=0.0) / 2 for rim in rims]

    def counterweight_angle(self, radii: Sequence[float], near: float) -> float:
        """Return the angle of all counterweights [deg]; flanks of several throws may lie on one plane.

        A flank is a plane through the axis. The half angle is one at which each throw with a counterweight
        has both flanks; of several such, which is rare, the one nearest to that wanted [deg].

        Raises
        ------
        LookupError
            If there is none.
        """
        normals = [p.direction for p in self.seen.planes if p.holds(Z) and abs(p.direction.z) < _CLEAR]
        lines = [atan2(n.y, n.x) + pi / 2 for n in normals]
        angles = [angle for throw in self.throws for angle in throw.angles]
        heavy = [angle for angle, radius in zip(angles, radii, strict=True) if radius > 0]
        candidates = {self._fold(line - heavy[0]) for line in lines}
        shared = [
            half
            for half in candidates
            if all(_shown(angle + side * half, lines) for angle in heavy for side in (-1, 1))
        ]
        if not shared:
            raise LookupError("the flanks of the counterweights are missing")
        return min((2 * degrees(half) for half in shared), key=lambda angle: abs(angle - near))

    @staticmethod
    def _fold(angle: float) -> float:
        """Return the angle between two lines, at most a right one [rad]."""
        return abs(remainder(angle, pi))

    def bolts(self) -> dict[str, float]:
        """Return holes in the flange: how many, their diameter, circle and depth; none if there are none."""
        end = self.seen.levels(Z)[-1]
        behind = self.throws[-1].faces[-1] - _CLEAR
        holes = [c for c in self.beside if c.reach[0] > behind and abs(c.reach[1] - end) < _CLEAR]
        if not holes:
            return {"bolt_hole_diameter": 0.0}
        self._check_spacing([atan2(h.point.y, h.point.x) for h in holes])
        circle = alike((hypot(h.point.x, h.point.y) for h in holes), "bolt holes")
        return {
            "bolt_holes": float(len(holes)),
            "bolt_hole_diameter": alike((h.diameter for h in holes), "bolt holes"),
            "bolt_circle_diameter": 2 * circle,
            "bolt_hole_depth": alike((h.reach[1] - h.reach[0] for h in holes), "bolt holes"),
        }

    @staticmethod
    def _check_spacing(angles: Sequence[float]) -> None:
        step = 2 * pi / len(angles)
        if any(abs(remainder(angle, step)) > radians(1e-5) for angle in angles):
            raise LookupError("the bolt holes are not evenly spaced on their circle")


def _spans(cylinder: Surface, low: float, high: float) -> bool:
    """Return whether a cylinder reaches from one plane to another."""
    return abs(cylinder.reach[0] - low) < _CLEAR and abs(cylinder.reach[1] - high) < _CLEAR


def _lies(plane: Surface, normal: Vector, distance: float) -> bool:
    """Return whether a plane has this normal, either way round, at this distance from the origin."""
    return plane.along(normal) and abs(plane.point.dot(normal) - distance) < _CLEAR


def _shown(line: float, lines: Iterable[float]) -> bool:
    """Return whether a line through the axis is among others."""
    return any(abs(remainder(line - other, pi)) < 100 * _ANGLE for other in lines)
