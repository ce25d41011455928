"""Read the counterweights of a shaft of many throws back from the surfaces of the finished solid."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from math import atan2, degrees, pi, remainder

from cad.cranks.crankshaft_readback import ShaftReadback
from cad.cranks.planes_across import within
from cad.surfaces import Place, Size, Surface, Z, alike, faces_of

_CLEAR = 1e-6  # the sine of an angle
_ANGLE = 1e-8  # [rad]


@dataclass(frozen=True)
class CounterweightReadback:
    """The counterweights of a shaft: rims about the shaft, and flanks, which are planes through its axis."""

    shaft: ShaftReadback

    @property
    def radii(self) -> list[float]:
        """Return the radius of each web's counterweight [mm]; 0 for none."""
        return [max((c.diameter for c in rim), default=0.0) / 2 for rim in self._rims]

    def radius(self) -> float:
        """Return the radius that the counterweights of all webs share [mm]; 0 if there are none.

        Raises
        ------
        LookupError
            If they differ.
        """
        alike(self.radii, "counterweights")
        rims = [cylinder for rim in self._rims for cylinder in rim]
        return Size.radius(rims) if rims else 0.0

    @cached_property
    def _rims(self) -> list[list[Surface]]:
        """Return the cylinders about the shaft that are wider than the web, for each web."""
        least = 1.01 * self.shaft.web_width
        about = self.shaft.seen.about(Z)
        webs = (web for throw in self.shaft.throws for web in throw.webs)
        return [[c for c in within(about, *web) if c.diameter > least] for web in webs]

    def angle(self, near: float) -> float:
        """Return the common angle of the counterweights [deg].

        A flank is a plane through the axis, and flanks of several throws may lie in one plane. At half the
        angle each throw with a counterweight has both flanks. In the rare case that several angles fit, the
        result is the one nearest to the expected angle [deg].

        Raises
        ------
        LookupError
            If no angle fits.
        """
        flanks = [p for p in self.shaft.seen.planes if p.holds(Z) and abs(p.direction.z) < _CLEAR]
        lines = [_line(plane) for plane in flanks]
        angles = [angle for throw in self.shaft.throws for angle in throw.angles]
        heavy = [angle for angle, radius in zip(angles, self.radii, strict=True) if radius > 0]
        candidates = {_fold(line - heavy[0]) for line in lines}
        shared = [
            half
            for half in candidates
            if all(_shown(angle + side * half, lines) for angle in heavy for side in (-1, 1))
        ]
        if not shared:
            raise LookupError("the flanks of the counterweights are missing")
        half = min(shared, key=lambda half: abs(2 * degrees(half) - near))
        sides = (
            faces_of(p for p in flanks if _shown(heavy[0] + side * half, [_line(p)])) for side in (-1, 1)
        )
        return Size(2 * degrees(half), "angle", Place(*sides))


def _fold(angle: float) -> float:
    """Return the acute angle between two lines [rad]."""
    return abs(remainder(angle, pi))


def _line(flank: Surface) -> float:
    """Return the angle of the line in which a plane through the axis meets a plane across it [rad]."""
    return atan2(flank.direction.y, flank.direction.x) + pi / 2


def _shown(line: float, lines: Iterable[float]) -> bool:
    """Return whether a line through the axis coincides with one of the given lines."""
    return any(abs(remainder(line - other, pi)) < 100 * _ANGLE for other in lines)
