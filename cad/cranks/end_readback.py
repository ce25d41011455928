"""Read the parameters of nose, flange and thrust faces back from the surfaces of the finished shaft."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, pi, radians, remainder

from cad.cranks.crankshaft_readback import ShaftReadback
from cad.surfaces import Place, Size, Surface, X, Y, Z, alike, faces_of

_CLEAR = 1e-6  # [mm]


@dataclass(frozen=True)
class EndReadback:
    """The features of the ends of a shaft, and its thrust faces."""

    shaft: ShaftReadback

    def sizes(self) -> dict[str, float]:
        """Return every parameter of the ends; those of keyway, bolts and collars only if there are any."""
        return {**self._ends(), **self._bevels(), **self._keyway(), **self.bolts(), **self._thrust()}

    def _ends(self) -> dict[str, float]:
        """Return the diameters and lengths of the nose and the flange, and their fillets."""
        nose, flange = (end[1] for end in self.shaft.ends)
        (low, high), seen, levels = self.shaft.shoulders, self.shaft.seen, self.shaft.planes.levels
        return {
            "nose_length": seen.apart(Z, levels[0], low),
            "nose_diameter": Size.diameter([nose]),
            "flange_thickness": seen.apart(Z, high, levels[-1]),
            "flange_diameter": Size.diameter([flange]),
            **{
                name: Size.radius(tori) if tori else 0.0
                for name, tori in zip(("nose_fillet", "flange_fillet"), self.shaft.end_fillets, strict=True)
            },
        }

    def _bevels(self) -> dict[str, float]:
        """Return the chamfers at the free ends; 0 for none."""
        (nose, flange), levels = (end[1] for end in self.shaft.ends), self.shaft.planes.levels
        return {
            "nose_chamfer": self._bevel(-nose.reach[1], levels[0]),
            "flange_chamfer": self._bevel(flange.reach[1], levels[-1]),
        }

    def _bevel(self, start: float, end: float) -> float:
        """Return the size of the cone between a cylinder and the end of the shaft."""
        if (size := abs(end - start)) < _CLEAR:
            return 0.0
        cones = [cone.turned(Z) for cone in self.shaft.seen.cones if cone.about(Z)]
        low, high = sorted((start, end))
        here = [c for c in cones if abs(c.reach[0] - low) < _CLEAR > abs(c.reach[1] - high)]
        if not here:
            raise LookupError(f"the file has no chamfer of {size:.9g} mm at an end of the shaft")
        return Size(size, "chamfer", Place(faces_of(here)))

    def _keyway(self) -> dict[str, float]:
        """Return width, depth and length of the keyway, from the planes on the nose."""
        if not self.shaft.planes.has_keyway:
            return {"keyway_width": 0.0}
        seen, nose = self.shaft.seen, self.shaft.ends[0][1]
        here = [p for p in seen.planes if p.middle is not None and p.middle.z < self.shaft.shoulders[0]]
        walls = sorted((p for p in here if p.along(Y)), key=lambda p: p.point.y)
        floors = [p for p in here if p.along(X)]
        if len(walls) != 2 or len(floors) != 1:
            raise LookupError("the sides and the floor of the keyway are missing")
        levels = seen.levels(Z)
        return {
            "keyway_width": Size.distance(walls[1].point.y - walls[0].point.y, walls[:1], walls[1:]),
            "keyway_depth": Size.distance(nose.diameter / 2 - floors[0].point.x, floors, [nose]),
            "keyway_length": seen.apart(Z, levels[0], levels[1]),
        }

    def _thrust(self) -> dict[str, float]:
        """Return the main journal with collars, and their diameter and height."""
        collars = self.shaft.planes.collars
        if not collars:
            return {"thrust_main": 0.0}
        rings: list[Surface] = [ring for *_, some in collars for ring in some]
        spans = [(min(web, face), max(web, face)) for web, face, _ in collars]
        heights = [self.shaft.seen.apart(Z, low, high) for low, high in spans]
        return {
            "thrust_main": float(self.shaft.planes.thrust_main),
            "thrust_diameter": Size.diameter(rings),
            "thrust_height": Size.repeated(heights, "collars"),
        }

    def bolts(self) -> dict[str, float]:
        """Return number, diameter, pitch circle and depth of the flange holes; None without holes."""
        end = self.shaft.planes.levels[-1]
        behind = self.shaft.throws[-1].faces[-1] - _CLEAR
        holes = [c for c in self.shaft.beside if c.reach[0] > behind and abs(c.reach[1] - end) < _CLEAR]
        if not holes:
            return {"bolt_hole_diameter": 0.0}
        self._check_spacing([atan2(h.point.y, h.point.x) for h in holes])
        bottom = alike((h.reach[0] for h in holes), "bottoms of bolt holes")
        return {
            "bolt_holes": float(len(holes)),
            "bolt_hole_diameter": Size.diameter(holes),
            "bolt_circle_diameter": Size.circle(holes, self.shaft.journals()),
            "bolt_hole_depth": self.shaft.seen.apart(Z, bottom, end),
        }

    @staticmethod
    def _check_spacing(angles: Sequence[float]) -> None:
        step = 2 * pi / len(angles)
        if any(abs(remainder(angle, step)) > radians(1e-5) for angle in angles):
            raise LookupError("the bolt holes are not evenly spaced on their circle")
