"""Base of the models of cranks: from checked parameters to the solid, and from its surfaces back."""

from __future__ import annotations

from collections.abc import Mapping
from math import sin

from cad.cranks.outline import Outline
from cad.cranks.rules import CrankRules
from cad.cranks.throw import End, Throw
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
from cad.surfaces import Seen, Y


class CrankModel(CrankRules):
    """A crank of one solid."""

    def drawn(self) -> Throw:
        """Return the parameters as radii, lengths and angles of what is drawn."""
        front, rear = self.ends()
        return Throw(
            outline=Outline(
                throw=mm(self.R),
                half_width=mm(self.W) / 2,
                rectangular=self.web_shape == "rectangular",
                counterweight=mm(self.R_w),
                half_angle=float(self.phi_w) / 2,
            ),
            web_thickness=mm(self.L_w),
            journal=mm(self.D_j) / 2,
            journal_bore=mm(self.d_j) / 2,
            journal_length=mm(self.L_s),
            pin=mm(self.D_c) / 2,
            pin_bore=mm(self.d_c) / 2,
            pin_length=mm(self.L_c),
            fillet=mm(self.r_f),
            drilling=mm(self.d_o) / 2,
            inclination=float(self.beta),
            incline_start=mm(self.x_b),
            front=front,
            rear=rear,
        )

    def ends(self) -> tuple[End | None, End | None]:
        """Return what lies beyond the main journals, at -z and at +z."""
        return None, None

    def build(self) -> tuple[Part, ...]:
        """Return one solid."""
        throw = self.drawn()
        return (Part(self.id, throw.solid(), volume(throw)),)

    def bounding_box(self) -> Box:
        """Return the webs, counterweights and ends together."""
        throw = self.drawn()
        web, ends = throw.outline, [end for end in (throw.front, throw.rear) if end]
        around = max([0.0, *(end.radius for end in ends)])
        wide = max(web.half_width, web.counterweight * sin(web.half_angle), around)
        low, high = (throw.journal_end + (end.length if end else 0) for end in (throw.front, throw.rear))
        left = max(web.half_width, web.counterweight, around)
        return Box((-left, -wide, -low), (max(web.tip, around), wide, high))

    def shaft(self) -> Shaft:
        """Return where it is held and loaded: by its end faces at -z and at +z."""
        box = self.bounding_box()
        return Shaft(box.low[2], box.high[2])

    @classmethod
    def is_throw(cls) -> bool:
        """Return whether nothing lies beyond the main journals, so that the solid ends mid-journal."""
        return cls.ends is CrankModel.ends

    def throw_sizes(self) -> Crank | None:
        """Return the plain sizes of the throw, if it is one from mid-journal to mid-journal."""
        drawn = self.drawn()
        if not self.is_throw():
            return None
        return Crank(
            drawn.outline.throw,
            drawn.pin,
            drawn.pin_length,
            drawn.journal,
            drawn.web_thickness,
            drawn.fillet,
        )

    def dimensions(self, seen: Mapping[str, Seen]) -> dict[str, float]:
        """Return every parameter; the angle of a counterweight only if there is one."""
        surfaces, webs = seen[self.id], Webs.of(seen[self.id])
        front, rear = (stub[0] for stub in stubs(surfaces, webs))
        length = (front.reach[1] + webs.faces[0] + rear.reach[1] - webs.faces[3]) / 2
        return {
            "journal_diameter": max(front.diameter, rear.diameter),
            "journal_length": length * float(self.L_j / self.L_s),
            "journal_bore": journal_bore(surfaces, webs),
            **pin(surfaces, webs),
            "pin_length": webs.apart,
            "web_thickness": webs.thickness,
            "web_width": surfaces.length(Y),
            "fillet": fillet(surfaces),
            "oil_drilling_diameter": drilling(surfaces),
            **counterweight(surfaces, webs),
            "face_inclination": inclination(surfaces),
        }
