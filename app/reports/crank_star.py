"""Draw the crank star: the crankpins of an engine seen from its flywheel, each with its cylinders.

`static/crank_star.js` draws the same star in the page. The angle convention is that of `engine` 1: x points
up and y to the left. The shaft therefore turns anticlockwise. Pins at the same angle share one ray, whichever
throws they belong to.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, radians, sin

WIDTH, HEIGHT = 560, 240  # as wide as the charts next to it
RAY, WORDS = 74, 98  # radius of the pins, and of their labels
_SAME = 0.05  # pins closer than this are drawn as one [deg]


def rays(angles: Sequence[float]) -> list[tuple[float, list[int]]]:
    """Return the distinct angles of pins [deg, 0 to 360], each with its cylinders, counted from 1."""
    star: list[tuple[float, list[int]]] = []
    for cylinder, angle in enumerate(angles, 1):
        for at, cylinders in star:
            if abs((angle - at + 180) % 360 - 180) < _SAME:
                cylinders.append(cylinder)
                break
        else:
            star.append((angle % 360, [cylinder]))
    return star


def crank_star(angles: Sequence[float]) -> str:
    """Return the star as SVG for the pin angles of the cylinders [deg]; empty without pins."""
    if not angles:
        return ""
    drawn = [_ray(angle, cylinders) for angle, cylinders in rays(angles)]
    box = f"-{WIDTH // 2} -{HEIGHT // 2} {WIDTH} {HEIGHT}"
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" '
    look = (
        'font-family="Liberation Sans, Arial, sans-serif" font-size="12" text-anchor="middle" fill="#1b2733"'
    )
    circle = f'<circle r="{RAY}" fill="none" stroke="#c3cad1" stroke-dasharray="3 3"/>'
    turning = '<path d="M20,-22a30,30 0 0,0 -40,0m1,-7l-2,8l8,1" fill="none" stroke="#5a5f66"/>'
    return f'{head}{look}>{circle}{turning}{"".join(drawn)}<circle r="7" fill="#1b4f7f"/></svg>'


def _ray(angle: float, cylinders: Sequence[int]) -> str:
    """Return the SVG of one pin and its web."""
    left, up = sin(radians(angle)), cos(radians(angle))
    x, y = _place(-RAY * left), _place(-RAY * up)
    at_x, at_y = _place(-WORDS * left), _place(-WORDS * up + 4)
    names = ", ".join(map(str, cylinders))
    return (
        f'<path d="M0,0L{x},{y}" stroke="#1b4f7f" stroke-width="5"/>'
        f'<circle cx="{x}" cy="{y}" r="9" fill="#b5651d"/><text x="{at_x}" y="{at_y}">{names}</text>'
    )


def _place(value: float) -> str:
    """Return a coordinate, with −0 replaced by 0."""
    return f"{value + 0.0 if abs(value) >= 0.05 else 0.0:.1f}"
