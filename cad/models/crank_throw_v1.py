"""Crank throw: two webs, the crankpin between them, and half a main journal on each side.

This is the part of a crankshaft from mid-journal to mid-journal that stiffness formulas and finite elements
use. It is symmetric about y = 0 and, without an oil drilling, about z = 0. The docstring of the class below
explains the parameters to users; parameters, rules and the solid come from `cad.cranks`.
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

    z is the axis of the main journals, x points from it to the pin, and z = 0 is mid-pin. The end faces are
    perpendicular to the shaft at z = ±(pin_length + 2 web_thickness + journal_length)/2; half of
    journal_length is drawn on each side. A size of 0 omits a bore, fillet, oil drilling, counterweight or
    inclination.

    Fillets run round the pin and the journals where these meet a web. The bore of the journals passes through
    the journals and their webs, the bore of the pin through the pin and both webs. The oil drilling is
    straight: it runs from mid-pin, on the side away from the shaft, through the web at +z, to the middle of
    the half journal, on its opposite side. The counterweights are sectors about the shaft opposite the pin,
    as thick as their webs.

    The face inclination removes material from the outer face of each web, from next to the journal fillet to
    the end beyond the pin: at 0 the web is heaviest. To add material there, as Punewale et al. do, reduce the
    inclination.

    Limits
    ------
    The throw has two equal webs, at least 2 % wider than journal and pin with their fillets. Journals and
    pin are plain cylinders without grooves; edges other than at the fillets are sharp; a counterweight spans
    at most half a turn.

    References
    ----------
    Punewale, Khobragade, Chaudhari and Khandre 2015: effect of material on the inclined web faces on
        stiffness.
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
        """Return the box of the webs and counterweights together."""
        throw = self.drawn()
        web, end = throw.outline, throw.journal_end
        wide = max(web.half_width, web.counterweight * sin(web.half_angle))
        return Box((-max(web.half_width, web.counterweight), -wide, -end), (web.tip, wide, end))

    def shaft(self) -> Shaft:
        """Return the planes at which an analysis holds and loads the throw: its end faces at -z and +z."""
        end = self.drawn().journal_end
        return Shaft(-end, end)

    @classmethod
    def is_throw(cls) -> bool:
        """Return True, because the model is one throw from mid-journal to mid-journal."""
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
        before, behind = -front.reach[1], rear.reach[1]  # the end faces, at the middle of the journals
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
