"""A keyway in the nose of a shaft, open at its end."""

from __future__ import annotations

from dataclasses import dataclass

from cadquery import Solid, Vector


@dataclass(frozen=True)
class Keyway:
    """A slot along the nose at +x, from its end to a square inner end [mm]."""

    width: float
    depth: float  # from the top of the nose
    length: float

    def tool(self, nose: float, low: float) -> Solid:
        """Return the solid that it removes from a nose of this radius that begins at z = `low`.

        It extends beyond the nose at its top and at its end.
        """
        floor, over = nose - self.depth, self.depth
        corner = Vector(floor, -self.width / 2, low - over)
        return Solid.makeBox(self.depth + over, self.width, self.length + over, corner)
