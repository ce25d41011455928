"""Volume of a crank throw [mm³] from its dimensions alone: an independent check of the kernel.

The parts touch only at faces, so their volumes add up. The rules of the models ensure that each cut lies
inside one part or crosses it completely. Fillets are calculated by Pappus's theorem. The drilling is
integrated over its chords: at a distance y from the plane of the crank all chords have the same length,
because both mouths lie in cylinders along z. The bores that the drilling crosses shorten the chords in the
same way.
"""

from __future__ import annotations

from math import cos, pi, sin, sqrt, tan

from scipy.integrate import quad

from cad.cranks.keyway import Keyway
from cad.cranks.throw import Collar, End, Throw
from cad.revolution import sheet_under_arc


def volume(throw: Throw) -> float:
    """Return the volume of webs, pin and journals minus bores and drilling."""
    return 2 * web(throw) + pin(throw) + 2 * journal(throw) - drilling(throw)


def web(t: Throw) -> float:
    """Return the volume of a plate with two holes, minus what its inclined face removes."""
    slope = tan(t.inclination)
    at_pin = t.web_thickness - slope * max(t.outline.throw - t.incline_start, 0.0)
    bores = pi * (t.journal_bore**2 * t.web_thickness + t.pin_bore**2 * at_pin)
    return t.outline.area * t.web_thickness - slope * t.outline.moment_beyond(t.incline_start) - bores


def pin(t: Throw) -> float:
    """Return the volume of a pin with a fillet at either end."""
    return pi * (t.pin**2 - t.pin_bore**2) * t.pin_length + 2 * fillet(t.pin, t.fillet)


def journal(t: Throw) -> float:
    """Return the volume of a journal with a fillet at one end."""
    return pi * (t.journal**2 - t.journal_bore**2) * t.journal_length + fillet(t.journal, t.fillet)


def end_volume(end: End, bore: float, journal: float) -> float:
    """Return the volume of an end with its fillet at a journal of this radius, minus chamfer and bore."""
    whole = pi * (end.radius**2 - bore**2) * end.length
    bevel = pi * end.chamfer**2 * (end.radius - end.chamfer / 3)  # a triangle, revolved (Pappus)
    return whole + fillet(min(end.radius, journal), end.fillet) - bevel


def collar_volume(collar: Collar, journal: float) -> float:
    """Return the volume that a collar adds around a journal, whose fillet it shifts."""
    return pi * (collar.radius**2 - journal**2) * collar.height


def keyway_volume(keyway: Keyway, nose: End) -> float:
    """Return the volume that a keyway removes from a nose; its chamfer has removed a part of it already."""
    half, floor = keyway.width / 2, nose.radius - keyway.depth

    def section(radius: float) -> float:
        return sheet_under_arc(radius, half) - floor * keyway.width

    bevel = quad(lambda s: section(nose.radius - nose.chamfer + s), 0.0, nose.chamfer, epsabs=0, epsrel=1e-12)
    return bevel[0] + section(nose.radius) * (keyway.length - nose.chamfer)


def fillet(radius: float, size: float) -> float:
    """Return the volume of a fillet around a cylinder: a square minus a quarter circle, revolved (Pappus)."""
    return 2 * pi * ((1 - pi / 4) * size**2 * radius + (5 / 6 - pi / 4) * size**3)


def drilling(t: Throw) -> float:
    """Return the volume that the oil drilling removes from pin, web and journal."""
    if t.drilling == 0:
        return 0.0
    top, bottom = t.drilled
    way = top - bottom
    return quad(_slice, 0.0, pi / 2, args=(t,), epsabs=0, epsrel=1e-12)[0] * way.Length / way.x


def _slice(angle: float, t: Throw) -> float:
    """Return the section of the drilling at y = a sin(angle) along x, times dy/d(angle) [mm³].

    The sine removes the singularity of the square root from the integrand.
    """
    y = t.drilling * sin(angle)
    pin, journal, pin_bore, journal_bore = (
        sqrt(max(r**2 - y**2, 0.0)) for r in (t.pin, t.journal, t.pin_bore, t.journal_bore)
    )
    along_x = t.outline.throw + pin + journal - 2 * (pin_bore + journal_bore)
    return 4 * (t.drilling * cos(angle)) ** 2 * along_x
