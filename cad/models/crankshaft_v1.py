"""Crankshaft of a single-cylinder engine: a throw, its two main journals, a flywheel end and a timing end.

For mass, inertia and torsion of a whole shaft. Its throw is that of `crank_throw`; what its words mean is
said in the class below, which users read.
"""

from collections.abc import Mapping

from cad.cranks.crank import CrankModel
from cad.cranks.throw import End
from cad.cranks.throw_readback import Webs, stubs
from cad.model import mm
from cad.surfaces import Seen
from templates.core.language.template import Array, Truth, derived, formula, require


class Crankshaft(CrankModel):
    """Crankshaft with one throw: two main journals, a flywheel end and a timing end.

    z is the axis on which the shaft turns, x points from it to the pin, z = 0 is mid-pin. The timing end is
    the front, at -z; the flywheel end is the rear, at +z. Both main journals are drawn in their whole length.
    Beyond each stands a plain cylinder: a seat for a wheel or, if it is wider than the journal, a flange. A
    bore, fillet, oil drilling, counterweight or inclination of 0 is none.

    Fillets run round the pin and the journals where they meet a web. The journals' bore goes through the
    whole shaft, the pin's through the pin and both webs. The oil drilling is straight: from mid-pin, on the
    side away from the shaft, through the web at +z, to mid-length of the rear journal, on its other side. The
    counterweights are sectors about the shaft opposite to the pin, as thick as their webs.

    The face inclination takes material off the outer face of each web, from beside the journal's fillet to
    the end beyond the pin: 0 is the heaviest web. To add material there, as Punewale et al. do, make it
    smaller.

    Limits
    ------
    One throw with two webs alike, at least 2 % wider than journal and pin with their fillets. Journals, pin
    and ends are plain cylinders without grooves, keyways, threads or fillets at the ends' shoulders; a
    counterweight spans at most half a turn.

    References
    ----------
    Punewale, Khobragade, Chaudhari and Khandre 2015: a crankshaft changed at pin, journals, throw and on the
        face inclination of its webs.
    """

    example = {
        "journal_diameter": "40 mm",
        "journal_length": "32 mm",
        "journal_bore": "12 mm",
        "pin_diameter": "36 mm",
        "pin_length": "26 mm",
        "pin_bore": "10 mm",
        "web_thickness": "16 mm",
        "web_width": "60 mm",
        "web_shape": "rectangular",
        "throw": "40 mm",
        "fillet": "2.5 mm",
        "oil_drilling_diameter": "5 mm",
        "counterweight_radius": "64 mm",
        "counterweight_angle": "130 deg",
        "face_inclination": "10 deg",
        "front_length": "45 mm",
        "front_diameter": "30 mm",
        "rear_length": "12 mm",
        "rear_diameter": "70 mm",
    }
    toleranced = {
        "journal_diameter": {"cylinders": "z", "datum": "A", "cylindricity": 0.5},
        "journal_bore": {"cylinders": "z"},
        "pin_diameter": {"beside": "z", "cylindricity": 0.5, "parallelism": 1, "to": "A"},
        "pin_bore": {"beside": "z"},
        "throw": {"between": ["journal_diameter", "pin_diameter"]},
        "oil_drilling_diameter": {"askew": True},
        "front_diameter": {"cylinders": "z", "end": "low", "cylindricity": 0.5},
        "rear_diameter": {"cylinders": "z", "end": "high"},
    }

    @formula("mm", "journal length on each side", name="journal_side", symbol="L_s")
    def L_s(self) -> Array:
        return self.L_j

    @derived("mm", "front length", symbol="L_f", ge=0.05, le=5000)
    def L_f(self) -> Array:
        return 0.8 * self.D_j

    @derived("mm", "front diameter", symbol="D_f", ge=0.1, le=5000)
    def D_f(self) -> Array:
        return 0.8 * self.D_j

    @derived("mm", "rear length", symbol="L_r", ge=0.05, le=5000)
    def L_r(self) -> Array:
        return 0.8 * self.D_j

    @derived("mm", "rear diameter", symbol="D_r", ge=0.1, le=5000)
    def D_r(self) -> Array:
        return 0.9 * self.D_j

    @formula("mm", "overall length", symbol="L")
    def L(self) -> Array:
        return self.L_f + 2 * (self.L_j + self.L_w) + self.L_c + self.L_r

    @formula("mm", "wall at the front end", name="front_wall", symbol="w_f")
    def w_f(self) -> Array:
        return (self.D_f - self.d_j) / 2

    @formula("mm", "wall at the rear end", name="rear_wall", symbol="w_r")
    def w_r(self) -> Array:
        return (self.D_r - self.d_j) / 2

    @require("front_diameter", "journal_bore", remedy="make the front end thicker or the bore smaller")
    def front_has_wall(self) -> Truth:
        """The journals' bore takes at most 98 % of the front end's diameter."""
        return self.d_j <= 0.98 * self.D_f

    @require("rear_diameter", "journal_bore", remedy="make the rear end thicker or the bore smaller")
    def rear_has_wall(self) -> Truth:
        """The journals' bore takes at most 98 % of the rear end's diameter."""
        return self.d_j <= 0.98 * self.D_r

    @require("front_diameter", "journal_diameter", remedy="make them equal, or change one by 0.1 %")
    def front_shoulder_is_drawable(self) -> Truth:
        """The front end is as thick as the journal, or differs from it by at least 0.1 %."""
        return (abs(self.D_f - self.D_j) <= 1e-12 * self.D_j) | (abs(self.D_f - self.D_j) >= 1e-3 * self.D_j)

    @require("rear_diameter", "journal_diameter", remedy="make them equal, or change one by 0.1 %")
    def rear_shoulder_is_drawable(self) -> Truth:
        """The rear end is as thick as the journal, or differs from it by at least 0.1 %."""
        return (abs(self.D_r - self.D_j) <= 1e-12 * self.D_j) | (abs(self.D_r - self.D_j) >= 1e-3 * self.D_j)

    def ends(self) -> tuple[End, End]:
        """Return the timing end and flywheel end."""
        return End(mm(self.D_f) / 2, mm(self.L_f)), End(mm(self.D_r) / 2, mm(self.L_r))

    def dimensions(self, seen: Mapping[str, Seen]) -> dict[str, float]:
        """Return those of the throw, and the cylinders that come last at either end."""
        found = seen[self.id]
        front, rear = stubs(found, Webs.of(found))
        return {
            **super().dimensions(seen),
            "front_length": front[1].reach[1] - front[0].reach[1],
            "front_diameter": front[1].diameter,
            "rear_length": rear[1].reach[1] - rear[0].reach[1],
            "rear_diameter": rear[1].diameter,
        }
