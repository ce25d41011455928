"""Reach of a web's outline in a direction [mm]: for the box of a shaft with turned throws."""

from __future__ import annotations

from math import cos, pi, remainder, sin

from cad.cranks.outline import Outline


def reach(outline: Outline, direction: float) -> float:
    """Return the farthest point of a web in a direction [rad] from x, counted from the journal's axis."""
    across = abs(sin(direction)) * outline.half_width
    along = cos(direction)
    if outline.rectangular:
        body = max(outline.tip * along, -outline.half_width * along) + across
    else:
        body = outline.half_width + max(outline.throw * along, 0.0)
    return max(body, _sector(outline, direction)) if outline.counterweight > 0 else body


def _sector(outline: Outline, direction: float) -> float:
    """Of the counterweight, a sector about -x: its rim, or the end of its rim nearest to the direction."""
    off = abs(remainder(direction - pi, 2 * pi)) - outline.half_angle
    return outline.counterweight * (cos(off) if off > 0 else 1.0)
