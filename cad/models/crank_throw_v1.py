"""Crank throw: two webs, the crankpin between them, and half a main journal on each side.

The part of a crankshaft from mid-journal to mid-journal, as stiffness formulas and finite elements take it.
Without oil drilling it is its own mirror image in z = 0, and always in y = 0. The class below, which users
read, explains the parameters; parameters, rules and the solid are those of `cad.cranks`.
"""

from collections.abc import Mapping
from math import sin

from cad.cranks.rules import CrankRules
from cad.cranks.throw import Throw
from cad.cranks.throw_readback import (
    Webs,
    counterweight,
    drilling,
    fillet,
    inclination,
    journal_bore,
    pin,
    stubs,
)
from cad.cranks.volume import volume
from cad.fillets import Crank
from cad.model import Box, Part, mm
from cad.shaft import Shaft
from cad.surfaces import PartSurfaces, Size, Y
from templates.core.language.template import Array, formula


class CrankThrow(CrankRules):
    """Crank throw from mid-journal to mid-journal, solid or bored, with fillets and counterweights.

    z is the axis of the main journals, x points from it to the pin, z = 0 is mid-pin; the cut faces stand
    across the shaft at z = ±(pin_length + 2 web_thickness + journal_length)/2. Of the journal_length half is
    drawn on each side. A bore, fillet, oil drilling, counterweight or inclination of 0 is none.

    Fillets run round the pin and the journals where they meet a web. The journals' bore goes through the
    journals and their webs, the pin's through the pin and both webs. The oil drilling is straight: from
    mid-pin, on the side away from the shaft, through the web at +z, to mid-length of the half journal, on its
    other side. The counterweights are sectors about the shaft opposite to the pin, as thick as their webs.

    The face inclination takes material off the outer face of each web, from beside the journal's fillet to
    the end beyond the pin: 0 is the heaviest web. To add material there, as Punewale et al. do, make it
    smaller.

    Limits
    ------
    One throw with two webs alike, at least 2 % wider than journal and pin with their fillets. Journals and
    pin are plain cylinders without grooves; edges other than at the fillets are sharp; a counterweight spans
    at most half a turn.

    References
    ----------
    Punewale, Khobragade, Chaudhari and Khandre 2015: material on the face inclination of the webs, and what
        it does to stiffness.
    """

    example = {
        "journal_diameter": "55 mm",
        "journal_length": "40 mm",
        "journal_bore": "16 mm",
        "pin_diameter": "48 mm",
        "pin_length": "32 mm",
        "pin_bore": "14 mm",
        "web_thickness": "18 mm",
        "web_width": "80 mm",
        "throw": "42 mm",
        "fillet": "3 mm",
        "oil_drilling_diameter": "5 mm",
        "counterweight_radius": "75 mm",
        "counterweight_angle": "120 deg",
        "face_inclination": "8 deg",
    }
    toleranced = {
        "journal_diameter": {"datum": "A", "cylindricity": 0.5},
        "journal_bore": {},
        "pin_diameter": {"cylindricity": 0.5, "parallelism": 1, "to": "A"},
        "pin_bore": {},
        "throw": {},
        "oil_drilling_diameter": {},
        "pin_length": {"perpendicularity": 1, "to": "A"},
        "web_thickness": {},
        "web_width": {},
        "fillet": {},
        "counterweight_radius": {},
    }

    @formula("mm", "journal length on each side", name="journal_side", symbol="L_s")
    def L_s(self) -> Array:
        return self.L_j / 2

    def drawn(self) -> Throw:
        """Return the parameters as radii, lengths and angles of the drawn shape."""
        return self.throw_drawn(mm(self.R_w))

    def build(self) -> tuple[Part, ...]:
        """Return one solid."""
        throw = self.drawn()
        return (Part(self.id, throw.solid(), volume(throw)),)

    def bounding_box(self) -> Box:
        """Return the webs and counterweights together."""
        throw = self.drawn()
        web, end = throw.outline, throw.journal_end
        wide = max(web.half_width, web.counterweight * sin(web.half_angle))
        return Box((-max(web.half_width, web.counterweight), -wide, -end), (web.tip, wide, end))

    def shaft(self) -> Shaft:
        """Return the planes at which it is held and loaded: its end faces at -z and +z."""
        end = self.drawn().journal_end
        return Shaft(-end, end)

    @classmethod
    def is_throw(cls) -> bool:
        """Return True: it is one throw from mid-journal to mid-journal."""
        return True

    def throw_sizes(self) -> Crank:
        """Return the plain sizes of the throw."""
        drawn = self.drawn()
        return Crank(
            drawn.outline.throw,
            drawn.pin,
            drawn.pin_length,
            drawn.journal,
            drawn.web_thickness,
            drawn.fillet,
        )

    def dimensions(self, seen: Mapping[str, PartSurfaces]) -> dict[str, float]:
        """Return every parameter; the angle of a counterweight only if there is one."""
        surfaces, webs = seen[self.id], Webs.of(seen[self.id])
        front, rear = (stub[0] for stub in stubs(surfaces, webs))
        before, behind = -front.reach[1], rear.reach[1]  # the end faces, in mid-journal
        return {
            "journal_diameter": Size.diameter([front, rear]),
            "journal_length": webs.faces[0] - before + behind - webs.faces[3],
            "journal_bore": journal_bore(surfaces, webs),
            **pin(surfaces, webs),
            "pin_length": webs.apart(surfaces),
            "web_thickness": webs.thickness(surfaces),
            "web_width": surfaces.length(Y),
            "fillet": fillet(surfaces),
            "oil_drilling_diameter": drilling(surfaces),
            **counterweight(surfaces, webs),
            "face_inclination": inclination(surfaces),
        }
