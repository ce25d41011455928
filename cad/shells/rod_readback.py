"""Read the sizes of a connecting rod back from the surfaces of rod, cap and bush."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import atan, degrees, dist

from cad.contour import Point
from cad.revolution import nearest
from cad.shells.big_end import EndHalf
from cad.shells.rod import Rod
from cad.surfaces import PartSurfaces, Place, Size, Surface, X, Y, Z, alike, faces_of

_SAME = 1e-6  # [mm]
_STEEP = 0.9  # cosine of the angle of a side from the middle of the rod, which is at most 15°


@dataclass(frozen=True)
class RodReadback:
    """Surfaces of the parts of a rod, and its expected sizes, by which equal ones are told apart."""

    seen: Mapping[str, PartSurfaces]
    wanted: Rod

    @property
    def rod(self) -> PartSurfaces:
        """Return the surfaces of the rod."""
        return self.seen["rod"]

    def sizes(self) -> dict[str, float]:
        """Return every parameter by name; of what is not there only the size that is 0."""
        return {**self._big_end(), **self._bosses(), **self._bolts(), **self._small_end(), **self._shank(),
                **self._pockets(), **self._oil()}  # fmt: skip

    def _big_end(self) -> dict[str, float]:
        bore = self.bore
        return {
            "big_end_bore": Size.diameter(bore),
            "big_end_width": self.rod.apart(Z, *bore[0].reach, bore[0].point),
            "big_end_breadth": self.rod.length(X),
            "shoulder_height": self._height(self.rod, self.wanted.big_end.rod, 1),
            "cap_height": self._height(self.seen["cap"], self.wanted.big_end.cap, -1),
        }

    @property
    def bore(self) -> list[Surface]:
        """Return the faces of the big end's bore."""
        return self.rod.rings(Z)[0]

    def _height(self, part: PartSurfaces, half: EndHalf, side: int) -> float:
        """Return the radius of the round of one half, or the height of its square shoulder."""
        bore = part.rings(Z)[0]
        if not half.is_square:
            return Size.radius(part.rings(Z)[1])
        level = nearest(part.levels(Y), side * half.height)
        return Size.distance(side * level, bore, part.planes_at(Y, level))

    def _bosses(self) -> dict[str, float]:
        end, rod, cap = self.wanted.big_end, self.rod, self.seen["cap"]
        sizes = {
            "boss_height": self._seat(rod, end.rod, 1),
            "cap_boss_height": self._seat(cap, end.cap, -1),
        }
        corners = [
            Size.radius(_round(part, (half.half_breadth - half.corner, side * (half.seat - half.corner))))
            for part, half, side in ((rod, end.rod, 1), (cap, end.cap, -1))
            if half.corner > 0
        ]
        return {**sizes, "boss_corner_radius": _in_parts(corners)}

    def _seat(self, part: PartSurfaces, half: EndHalf, side: int) -> float:
        """Return the height of the bosses; of a square half the faces carry the height of its shoulder."""
        if half.seat == 0:
            return 0.0
        level = nearest(part.levels(Y), side * half.seat)
        return side * level if half.is_square else part.apart(Y, min(0.0, level), max(0.0, level))

    def _bolts(self) -> dict[str, float]:
        holes = [hole.turned(Y) for hole in self.rod.cylinders if hole.along(Y) and not hole.about(Y)]
        if not holes:
            return {"bolt_hole_diameter": 0.0}
        left, right = [h for h in holes if h.point.x < 0], [h for h in holes if h.point.x > 0]
        spacing = max(h.point.x for h in right) - min(h.point.x for h in left)
        return {
            "bolt_hole_diameter": Size.diameter(holes),
            "bolt_spacing": Size.distance(spacing, left, right),
            "bolt_hole_depth": self.rod.apart(Y, 0.0, holes[0].reach[1]),
        }

    def _small_end(self) -> dict[str, float]:
        eyes = sorted(
            (c for c in self.rod.cylinders if c.along(Z) and abs(c.point.x) < _SAME and not c.about(Z)),
            key=lambda c: c.diameter,
        )
        inner = [c for c in eyes if c.diameter < eyes[-1].diameter - _SAME]
        outer = [c for c in eyes if c not in inner]
        bush = self.seen["bush"].rings(Z) if "bush" in self.seen else []
        return {
            "centre_distance": Size.distance(inner[0].point.y, self.bore, inner),
            "small_end_bore": Size.diameter(inner),
            "small_end_diameter": Size.diameter(outer),
            "small_end_width": self.rod.apart(Z, *inner[0].reach, inner[0].point),
            "small_end_fillet": self._fillet(self.wanted.small_fillet, self.wanted.fillets()[1]),
            "big_end_fillet": self._fillet(self.wanted.big_fillet, self.wanted.fillets()[0]),
            "bush_wall": Size.wall(*bush) if bush else 0.0,
        }

    def _fillet(self, radius: float, axis: Point) -> float:
        return Size.radius(_round(self.rod, axis)) if radius > 0 else 0.0

    def _shank(self) -> dict[str, float]:
        sides = self._sides(self.wanted.shank_width / 2)
        return {
            "shank_width": self._width(sides),
            "shank_taper": self._taper(sides),
            "shank_thickness": self._thickness(self.wanted.thickness),
        }

    def _sides(self, half_width: float) -> tuple[list[Surface], list[Surface]]:
        """Return the planes along the pin on the right and left that are nearest to a half width halfway."""
        steep = [
            p for p in self.rod.planes if abs(p.direction.dot(Z)) < _SAME and abs(p.direction.x) > _STEEP
        ]
        at = nearest((abs(self._across(plane)) for plane in steep), half_width)
        alike = [plane for plane in steep if abs(abs(self._across(plane)) - at) < _SAME]
        right = [plane for plane in alike if self._across(plane) > 0]
        return right, [plane for plane in alike if plane not in right]

    def _across(self, plane: Surface) -> float:
        """Return where a plane crosses the height halfway along the shank [mm]."""
        normal = plane.direction
        return float(plane.point.dot(normal) - normal.y * self.wanted.halfway) / normal.x

    def _width(self, sides: tuple[Sequence[Surface], Sequence[Surface]]) -> float:
        """Return the distance between two sides halfway along the shank."""
        (right, *_), (left, *_) = sides
        return Size.distance(self._across(right) - self._across(left), *sides)

    def _taper(self, sides: tuple[Sequence[Surface], Sequence[Surface]]) -> float:
        """Return the angle between two sides [deg]."""
        right, left = (degrees(atan(side[0].direction.y / side[0].direction.x)) for side in sides)
        taper = Size(right - left, "angle", Place(faces_of(sides[0]), faces_of(sides[1])))
        return taper if taper > _SAME else 0.0

    def _thickness(self, wanted: float) -> float:
        """Return the distance between the two planes across the pin that are nearest to a thickness."""
        level = nearest([z for z in self.rod.levels(Z) if z > 0], wanted / 2)
        return self.rod.apart(Z, -level, level)

    def _pockets(self) -> dict[str, float]:
        one = self.wanted
        if one.pocket_width == 0:
            return {"pocket_width": 0.0}
        corner = Size.radius(_round(self.rod, *one.pocket_corners())) if one.pocket_corner > 0 else 0.0
        return {
            "pocket_width": self._width(self._sides(one.pocket_width / 2)),
            "web_thickness": self._thickness(one.web),
            "pocket_corner_radius": corner,
        }

    def _oil(self) -> dict[str, float]:
        """Return the diameters of the oil hole and of the drilling in the rod, which continue in the bush."""
        upper, lower = (self._upright(side) for side in (1, -1))
        return {
            "oil_hole_diameter": Size.diameter(upper) if upper else 0.0,
            "oil_drilling_diameter": Size.diameter(lower) if lower else 0.0,
        }

    def _upright(self, side: int) -> list[Surface]:
        """Return the holes along the middle of the rod, beyond the axis of the small end or before it."""
        axis = self.wanted.distance
        return [hole for hole in self.rod.about(Y) if side * (sum(hole.reach) / 2 - axis) > 0]


def _round(part: PartSurfaces, *axes: Point) -> list[Surface]:
    """Return the round edges along the pin whose axes are expected at some points, and mirrored in x = 0."""
    edges = [one for one in part.cylinders if one.along(Z)]
    found: list[Surface] = []
    for axis in axes:
        away = [dist((abs(one.point.x), one.point.y), axis) for one in edges]
        least = nearest(away, 0.0)
        found += [one for one, off in zip(edges, away, strict=True) if off < least + _SAME]
    return found


def _in_parts(sizes: Sequence[Size]) -> float:
    """Return the common value of a size in several parts, with a place in each; 0 if there is none."""
    if not sizes:
        return 0.0
    places = [place for size in sizes for place in size.places]
    return Size(alike(sizes, "sizes in the parts"), sizes[0].kind, *places)
