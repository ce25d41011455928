"""Read the parameters of a shaft of many throws back from the surfaces of the finished solid.

Each feature is recognised by its position, never by its expected size: the planes across the shaft are, in
order, the faces of the ends and of the webs. If a dimension is common to all throws, each throw must have it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import atan2, degrees, hypot, remainder

from cadquery import Vector

from cad.cranks.planes_across import PlanesAcross, within
from cad.cranks.throw_readback import ThrowReadback, Webs, stubs
from cad.surfaces import Face, PartSurfaces, Place, Size, Surface, Z, alike, faces_of

_CLEAR = 1e-6  # [mm], also used as the sine of an angle


@dataclass(frozen=True)
class ShaftReadback:
    """The features of a shaft of many throws, read from its surfaces and their planes across it."""

    seen: PartSurfaces
    planes: PlanesAcross

    @property
    def split(self) -> bool:
        """Return whether the pins are split."""
        return self.planes.split

    @cached_property
    def beside(self) -> list[Surface]:
        """Return the cylinders that are parallel to the shaft but not coaxial with it."""
        return [c.turned(Z) for c in self.seen.cylinders if c.along(Z) and not c.about(Z)]

    @cached_property
    def throws(self) -> list[ThrowReadback]:
        """Return the throws, from front to rear.

        Each throw has four planes across the shaft, or six with split pins. In front of the throws are the
        end of the nose and its shoulder, if any; behind them are at most three planes: the shoulder of the
        flange, the bottoms of its holes, and its end.

        Raises
        ------
        LookupError
            If there is no throw, or if a throw has no pin.
        """
        levels, count = self.planes.levels, self.planes.of_throw
        found = []
        for place in range(self.planes.first, len(levels) - count, count):
            faces = tuple(levels[place : place + count])
            pins = (self._pin_between(*faces[at : at + 2]) for at in range(1, count - 1, 2))
            found.append(ThrowReadback(tuple(pins), faces))
        if not found:
            raise LookupError("the file has no pin between two webs")
        return found

    def _pin_between(self, low: float, high: float) -> Surface:
        pins = self._beside_within(low, high)
        if not pins:
            raise LookupError(f"the file has no pin between the webs at {low:.9g} and {high:.9g} mm")
        return max(pins, key=lambda c: c.diameter)

    def _beside_within(self, low: float, high: float) -> list[Surface]:
        """Return the cylinders parallel to the shaft but not coaxial with it, within a range of z."""
        return within(self.beside, low, high)

    @property
    def ends(self) -> tuple[list[Surface], list[Surface]]:
        """Return the coaxial cylinders before the first web and after the last, starting at the web."""
        first, last = self.throws[0].faces, self.throws[-1].faces
        front, rear = stubs(self.seen, Webs((first[0], first[1], last[-2], last[-1])))
        rings = self._rings
        return [c for c in front if c.face not in rings], [c for c in rear if c.face not in rings]

    @cached_property
    def _rings(self) -> set[Face]:
        """Return the faces of the cylinders of collars."""
        return {ring.face for *_, rings in self.planes.collars for ring in rings}

    @property
    def shoulders(self) -> tuple[float, float]:
        """Return the positions at which the nose and the flange meet their journals.

        The thinner of two cylinders with a fillet ends at the fillet, the other one at the shoulder.
        """
        (front, nose), (rear, flange) = (end[:2] for end in self.ends)
        return -_meeting(front, nose), _meeting(rear, flange)

    @cached_property
    def end_fillets(self) -> tuple[list[Surface], list[Surface]]:
        """Return the tori between the nose and its journal, and between the flange and its journal.

        Raises
        ------
        LookupError
            If a torus is missing.
        """
        (front, nose), (rear, flange) = (end[:2] for end in self.ends)
        return self._between(front, nose, -1), self._between(rear, flange, 1)

    def _between(self, journal: Surface, end: Surface, side: int) -> list[Surface]:
        size = end.reach[0] - journal.reach[1]
        if size < _CLEAR:
            return []
        z = side * (journal.reach[1] if end.diameter > journal.diameter else end.reach[0])
        found = [t for t in self.seen.tori if abs(t.point.z - z) < _CLEAR > abs(t.diameter / 2 - size)]
        if not found:
            raise LookupError(f"the file has no fillet of {size:.9g} mm at an end of the shaft")
        return found

    def common(self) -> dict[str, float]:
        """Return the dimensions that all throws share."""
        throws = self.throws
        pins = [pin for throw in throws for pin in throw.pins]
        reach = alike((hypot(pin.point.x, pin.point.y) for pin in pins), "throws")
        return {
            **self._journals(),
            "pin_diameter": Size.diameter(pins),
            "pin_length": Size.repeated((self._apart(*span) for t in throws for span in t.pin_spans), "pins"),
            "throw": Size.distance(reach, self.journals(), pins),
            "pin_bore": self._diameter(self._pin_bores, "pin bores"),
            "web_thickness": Size.repeated((self._apart(*web) for t in throws for web in t.webs), "webs"),
            "web_width": self.web_width,
            "fillet": self._fillet(),
            "oil_drilling_diameter": self._drilling(),
            "face_inclination": self._inclination(),
        }

    def _apart(self, low: float, high: float) -> float:
        """Return the distance between the planes at two positions along the shaft [mm]."""
        return self.seen.apart(Z, low, high)

    def journals(self) -> list[Surface]:
        """Return the cylinders of the main journals, from front to rear.

        Raises
        ------
        LookupError
            If one is missing.
        """
        front, rear = (end[0] for end in self.ends)
        inner = []
        for low, high in self._gaps():
            between = [c for c in within(self.seen.about(Z), low, high) if c.face not in self._rings]
            if not between:
                raise LookupError(
                    f"the file has no main journal between the webs at {low:.9g} and {high:.9g} mm"
                )
            inner += between
        return [front, *inner, rear]

    def _gaps(self) -> list[tuple[float, float]]:
        """Return the start and end of the main journals between two throws, including their fillets."""
        pairs = zip(self.throws[:-1], self.throws[1:], strict=True)
        return [(before.faces[-1], behind.faces[0]) for before, behind in pairs]

    def _journals(self) -> dict[str, float]:
        first, last = self.throws[0].faces[0], self.throws[-1].faces[-1]
        front, rear = self.shoulders
        spans = [(front, first), *self._gaps(), (last, rear)]
        return {
            "journal_diameter": Size.diameter(self.journals()),
            "journal_length": Size.repeated((self._apart(*span) for span in spans), "journals"),
            "journal_bore": self._diameter(self._journal_bores, "journal bores"),
        }

    def _diameter(self, bores: Callable[[ThrowReadback], list[list[Surface]]], what: str) -> float:
        """Return the common diameter of the bores of all throws; 0 if no throw has a bore.

        Raises
        ------
        LookupError
            If some are missing, or they differ.
        """
        each = [some for throw in self.throws for some in bores(throw)]
        alike((max((c.diameter for c in some), default=0.0) for some in each), what)
        return Size.diameter([c for some in each for c in some]) if each[0] else 0.0

    def _pin_bores(self, throw: ThrowReadback) -> list[list[Surface]]:
        """Return the cylinders that continue from each pin through its webs, for each pin."""
        if self.split:
            inner = throw.faces[1], throw.faces[-2]
            return [
                [c for c in self.beside if c.reach[0] < z - _CLEAR < z + _CLEAR < c.reach[1]] for z in inner
            ]
        _, front, rear, _ = throw.faces
        return [[c for c in self.beside if c.reach[0] < front - _CLEAR and rear + _CLEAR < c.reach[1]]]

    def _journal_bores(self, throw: ThrowReadback) -> list[list[Surface]]:
        """Return the coaxial cylinders that pass through each outer face of a throw."""
        about = self.seen.about(Z)
        return [
            [c for c in about if c.reach[0] < face - _CLEAR < face + _CLEAR < c.reach[1]]
            for face in (throw.faces[0], throw.faces[-1])
        ]

    @property
    def web_width(self) -> float:
        """Return the web width: twice the distance from the axis to the sides of the webs."""
        along = [p for p in self.seen.planes if abs(p.direction.dot(Z)) < _CLEAR and self._is_behind_nose(p)]
        for normal, distance in self._sides_of_middle_webs() if self.split else ():
            sides = [plane for plane in along if _lies(plane, normal, distance)]
            if not sides:
                raise LookupError("the sides of the middle webs are missing")
            along.remove(sides[0])
        away = [(abs(p.point.dot(p.direction)), p) for p in along]
        distances = [distance for distance, _ in away if distance > _CLEAR]
        if not distances:
            raise LookupError("the sides of the webs are missing")
        nearest = min(distances)
        sides = [plane for distance, plane in away if abs(distance - nearest) < _CLEAR]
        return _across(2 * nearest, sides)

    def _is_behind_nose(self, plane: Surface) -> bool:
        """Return whether the middle of a plane is behind the nose, which may have a keyway."""
        return plane.middle is None or plane.middle.z > self.shoulders[0]

    def _sides_of_middle_webs(self) -> Iterator[tuple[Vector, float]]:
        """Yield the normal of each side of each middle web, and its distance from the axis."""
        half = self.middle_web()["middle_web_width"] / 2
        for throw in self.throws:
            first, last = (Vector(pin.point.x, pin.point.y, 0) for pin in throw.pins)
            normal = (last - first).cross(Z).normalized()
            for side in (-half, half):
                yield normal, first.dot(normal) + side

    def middle_web(self) -> dict[str, float]:
        """Return the thickness of the middle webs, and their width (the diameter of their round ends)."""
        spans = [throw.faces[2:4] for throw in self.throws]
        ends = [c for low, high in spans for c in self._beside_within(low, high)]
        thick = (self._apart(*span) for span in spans)
        return {
            "middle_web_thickness": Size.repeated(thick, "middle webs"),
            "middle_web_width": Size.diameter(ends),
        }

    def pin_split(self, near: float) -> float:
        """Return the angle from front to rear pins [deg], in the turn nearest to the requested one."""
        turns = [degrees(rear - front) for front, rear in (throw.angles for throw in self.throws)]
        return near + alike((remainder(turn - near, 360) for turn in turns), "split pins")

    def _fillet(self) -> float:
        at_ends = {torus.face for tori in self.end_fillets for torus in tori}
        tori = [torus for torus in self.seen.tori if torus.face not in at_ends]
        each = self.planes.of_throw
        if tori and len(tori) != each * len(self.throws):
            raise LookupError(f"each throw must have {each} fillets; the whole crankshaft has {len(tori)}")
        return Size.radius(tori) if tori else 0.0

    def _drilling(self) -> float:
        askew = [c for c in self.seen.cylinders if not c.along(Z)]
        if askew and len(askew) < sum(len(throw.pins) for throw in self.throws):
            raise LookupError(f"each pin must have a drilling; the file has only {len(askew)}")
        return Size.diameter(askew) if askew else 0.0

    def _inclination(self) -> float:
        """Return the angle [deg] of the planes that are oblique to the shaft."""
        leaning = [p for p in self.seen.planes if _leans(p.direction)]
        if not leaning:
            return 0.0
        normals = (p.direction for p in leaning)
        angle = alike((degrees(atan2(hypot(n.x, n.y), abs(n.z))) for n in normals), "faces")
        return Size(angle, "angle", Place(faces_of(leaning)))

    def pin_angles(self, near: Sequence[float]) -> list[float]:
        """Return the pin angles [deg], in the turn nearest to the requested angles [deg]."""
        seen = [degrees(throw.angles[0]) for throw in self.throws]
        if len(seen) != len(near):
            raise LookupError(f"the crankshaft must have {len(near)} throws; the file has {len(seen)}")
        return [wanted + remainder(angle - wanted, 360) for angle, wanted in zip(seen, near, strict=True)]


def _leans(normal: Vector) -> bool:
    """Return whether a normal is oblique: neither parallel nor perpendicular to the shaft."""
    return min(hypot(normal.x, normal.y), abs(normal.z)) > _CLEAR


def _across(width: float, sides: Sequence[Surface]) -> Size:
    """Return the distance between planes on opposite sides of the axis."""
    normal = sides[0].direction
    ahead = [p for p in sides if p.along(normal) and p.point.dot(normal) > 0]
    behind = [p for p in sides if p.along(normal) and p.point.dot(normal) < 0]
    return Size.distance(width, ahead, behind)


def _meeting(journal: Surface, end: Surface) -> float:
    """Return the position along their axis at which a journal and an end of the shaft meet."""
    return end.reach[0] if end.diameter > journal.diameter else journal.reach[1]


def _lies(plane: Surface, normal: Vector, distance: float) -> bool:
    """Return whether a plane has this normal, in either direction, and this distance from the origin."""
    return plane.along(normal) and abs(plane.point.dot(normal) - distance) < _CLEAR
