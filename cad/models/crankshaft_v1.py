"""Crankshaft of any number of throws, undivided or with split pins: journals, counterweights, nose, flange.

Each throw is that of `crank_throw`. The docstring of the class below explains the parameters to users.
"""

from collections.abc import Mapping

import numpy as np

from cad.cranks.counterweight_readback import CounterweightReadback
from cad.cranks.counterweights import count, sectors, stand_out, there_is_none, webs_of
from cad.cranks.crankshaft_readback import ShaftReadback
from cad.cranks.end_features import EndFeatures
from cad.cranks.end_readback import EndReadback
from cad.cranks.planes_across import PlanesAcross
from cad.cranks.rules import clear_of_corners, corner
from cad.cranks.split_parameters import SplitParameters, are_split, shortest, where_split
from cad.cranks.split_pins import SplitPins
from cad.cranks.thrust import ThrustParameters
from cad.cranks.whole import Throws, WholeShaft
from cad.model import Box, Dimension, Part, mm
from cad.shaft import Shaft
from cad.surfaces import PartSurfaces
from templates.core.language.template import Array, Truth, curve, formula, profile, require

MOST_THROWS = 16


class Crankshaft(SplitParameters, ThrustParameters, EndFeatures):
    """Crankshaft with any number of throws, their pins undivided or split: counterweights, nose and flange.

    z is the axis of rotation; z = 0 is the middle of the first main journal. The nose is at -z, the flange at
    +z, where an engine has its flywheel. Pin angles are measured from x towards y, as in `engine` 1; there is
    one for each throw. All throws are equal except for their counterweights.

    With a pin split of 0 each throw has one pin. Otherwise each throw has a front pin at its pin angle and a
    rear pin that is further on by the split, each as long as the pin length and for one rod. Between them is
    a middle web: two half circles about the pins, joined by lines. Each outer web, with its counterweight,
    has the angle of the pin next to it.

    A size of 0 omits a bore, fillet, chamfer, keyway, oil drilling, counterweight, bolt hole or inclination.
    The counterweight radius is one number, or a list with one for each outer web starting at the nose, two
    for each throw; all counterweights have the same angle.

    Fillets run round pins and journals where these meet a web. The bore of the journals passes through the
    whole shaft, the bore of each pin through the pin and both webs; with split pins, through the outer web up
    to the middle web. An oil drilling runs straight from mid-pin, on the side away from the shaft, through
    the web towards the flange, to the middle of the next main journal, on its opposite side; the drilling of
    a front pin runs to the main journal in front of it. The counterweights are sectors about the shaft
    opposite the pin, as thick as their webs. Bolt holes are blind with flat bottoms; the first is on the x
    axis.

    The keyway is open at the end of the nose, where the shaft has a chamfer or none, and its inner end is
    square; it lies on the x axis. The thrust main is the number of a main journal from the nose, 1 for the
    first, 0 for none: each web beside it has a collar, whose face takes the thrust, and an outermost main has
    one collar. The journal length is measured between the webs, not between the collars.

    The face inclination removes material from the outer face of each outer web, from next to the journal
    fillet (with a thrust main from beyond the collars) to the end beyond the pin: at 0 the web is heaviest.

    The rotating couple, the integral of z (x + i y) over the mass, can be calculated from the measurements:
    mass centre_z centre_x - inertia_xz, and mass centre_z centre_y - inertia_yz.

    Limits
    ------
    There are at most 16 throws of one size, all split by the same angle of at least 1 deg; webs are at least
    2 % wider than journal and pin with their fillets. Journals and pins are plain cylinders, and the ends
    have no grooves or threads; a counterweight spans at most half a turn. Two drillings that end in one
    journal must not meet, so drillings are refused if neighbouring pins have nearly the same angle. The
    analysis `unit_loads` does not support split pins, and that of a chain of throws leaves out the collars.

    References
    ----------
    The closed form of the volume is our own: the parts touch only at faces, so their volumes add up.
    """

    example = {
        "pin_angles": {"value": [0, 120, 240], "unit": "deg"},
        "pin_split": "30 deg",
        "middle_web_thickness": "9 mm",
        "journal_diameter": "55 mm",
        "journal_length": "26 mm",
        "journal_bore": "12 mm",
        "pin_diameter": "48 mm",
        "pin_length": "24 mm",
        "pin_bore": "14 mm",
        "web_thickness": "18 mm",
        "web_width": "80 mm",
        "throw": "43 mm",
        "fillet": "2.5 mm",
        "oil_drilling_diameter": "5 mm",
        "counterweight_radius": {"value": [70, 0, 0, 0, 0, 70], "unit": "mm"},
        "counterweight_angle": "130 deg",
        "face_inclination": "6 deg",
        "nose_length": "45 mm",
        "nose_diameter": "35 mm",
        "flange_thickness": "16 mm",
        "flange_diameter": "90 mm",
        "bolt_holes": 6,
        "bolt_hole_diameter": "10 mm",
        "bolt_circle_diameter": "68 mm",
        "nose_fillet": "2 mm",
        "flange_fillet": "3 mm",
        "nose_chamfer": "1.5 mm",
        "flange_chamfer": "1 mm",
        "keyway_width": "8 mm",
        "keyway_depth": "4 mm",
        "keyway_length": "32 mm",
        "thrust_main": 3,
        "thrust_diameter": "66 mm",
        "thrust_height": "1 mm",
    }
    toleranced = {
        "journal_diameter": {"datum": "A", "cylindricity": 0.5},
        "journal_bore": {},
        "pin_diameter": {"cylindricity": 0.5, "parallelism": 1, "to": "A"},
        "pin_bore": {},
        "throw": {},
        "oil_drilling_diameter": {},
        "nose_diameter": {"cylindricity": 0.5},
        "flange_diameter": {},
        "bolt_hole_diameter": {},
        "bolt_circle_diameter": {},
        "journal_length": {},
        "pin_length": {"perpendicularity": 1, "to": "A"},
        "web_thickness": {},
        "middle_web_thickness": {},
        "web_width": {},
        "fillet": {},
        "counterweight_radius": {},
        "nose_length": {},
        "flange_thickness": {},
        "bolt_hole_depth": {},
        "middle_web_width": {},
        "nose_fillet": {},
        "flange_fillet": {},
        "nose_chamfer": {},
        "flange_chamfer": {},
        "keyway_width": {},
        "keyway_depth": {},
        "keyway_length": {},
        "thrust_diameter": {},
        "thrust_height": {},
    }

    R_w: Array = curve(
        "mm",
        "counterweight radius",
        along="webs",
        constant=True,
        symbol="R_w",
        default="0 mm",
        ge=0,
        le=10000,
    )

    @formula("mm", "journal length on each side", name="journal_side", symbol="L_s")
    def L_s(self) -> Array:
        return self.L_j

    @formula("1", "throws", symbol="n")
    def n(self) -> Array:
        return count(self.psi)

    @formula("mm", "pitch of the mains", name="pitch", symbol="p")
    def p(self) -> Array:
        """Distance between neighbouring main journals.

        With split pins it includes two pins and a middle web.
        """
        return self.L_c + where_split(self.delta, self.L_c + self.L_m) + 2 * self.L_w + self.L_j

    @profile("mm**2", "counterweight sector", along="webs", symbol="A_w")
    def A_w(self) -> Array:
        """Area of the counterweight sector, measured from the journal axis."""
        return sectors(self.R_w, self.phi_w, self.n)

    @formula("mm", "overall length", symbol="L")
    def L(self) -> Array:
        return self.L_n + self.n * self.p + self.L_j + self.t_f

    @require("pin_angles", remedy="give an angle for each throw, 1 to 16 of them")
    def throws_are_few(self) -> Truth:
        """There are at most 16 throws."""
        return self.n <= MOST_THROWS

    @require("counterweight_radius", "pin_angles", remedy="give one number, or two for each throw")
    def each_web_has_its_counterweight(self) -> Truth:
        """The counterweight radius is one number, or a list with one number for each web."""
        return webs_of(self.R_w, self.n) == 2 * self.n

    @require("fillet", "journal_length", remedy="make the fillet smaller or the journal longer")
    def fillets_fit_on_journal(self) -> Truth:
        """The two fillets of a journal between two throws occupy at most 90 % of its length."""
        return (self.n <= 1) | (2 * self.r_f <= 0.9 * self.L_j)

    @require(
        "counterweight_radius", "web_width", "web_shape",
        remedy="make the counterweight's radius larger, or 0 for none",
    )  # fmt: skip
    def counterweight_stands_out(self) -> Truth:
        """A counterweight reaches at least 2 % further from the journal's axis than the web does there."""
        return stand_out(self.R_w, 1.02 * corner(self.web_shape, self.W))

    @require("counterweight_angle", "web_shape", remedy="meet the corner exactly, or keep off it by 0.1°")
    def flanks_clear_corners(self) -> Truth:
        """The counterweight's flanks meet corners (obround 180°, rectangular 90°) or miss by 0.1°."""
        return there_is_none(self.R_w) | clear_of_corners(self.web_shape, self.phi_w)

    def drawn(self) -> WholeShaft:
        """Return the parameters as radii, lengths and angles of the drawn shape."""
        angles = np.atleast_1d(self.psi).tolist()
        radii = [mm(radius) for radius in np.broadcast_to(self.R_w, 2 * len(angles))]
        throws = (
            Throws(self.throw_drawn(radii[2 * k]), self.throw_drawn(radii[2 * k + 1]), angle)
            for k, angle in enumerate(angles)
        )
        nose, flange, bolts = self.ends_drawn()
        nose, flange, keyway = self.featured(nose, flange)
        return WholeShaft(tuple(throws), nose, flange, bolts, self._split(), keyway, *self.collar_drawn())

    def _split(self) -> SplitPins | None:
        if not are_split(self.delta):
            return None
        return SplitPins(float(shortest(self.delta)), mm(self.L_m), mm(self.W_m) / 2)

    def build(self) -> tuple[Part, ...]:
        """Return one solid."""
        shaft = self.drawn()
        return (Part(self.id, shaft.solid(), shaft.volume()),)

    def bounding_box(self) -> Box:
        """Return the box of the webs, counterweights, nose and flange together."""
        return self.drawn().box()

    def shaft(self) -> Shaft:
        """Return the planes at which an analysis holds and loads the shaft: the ends of nose and flange."""
        shaft = self.drawn()
        return Shaft(shaft.low, shaft.high)

    def dimensions(self, seen: Mapping[str, PartSurfaces]) -> dict[str, Dimension]:
        """Return every parameter; the angle of counterweights and the bolt circle only if there are any."""
        split = bool(are_split(self.delta))
        throws, thrust = round(float(self.n)), round(float(self.k_t))
        planes = PlanesAcross(seen[self.id], split, bool(self.b_k > 0), thrust, throws)
        found = ShaftReadback(seen[self.id], planes)
        counterweights = CounterweightReadback(found)
        radii = counterweights.radii
        near = np.degrees(np.atleast_1d(self.psi)).tolist()
        dimensions: dict[str, Dimension] = {
            "pin_angles": found.pin_angles(near),
            **found.common(),
            "pin_split": found.pin_split(float(np.degrees(self.delta))),
            "counterweight_radius": radii if np.ndim(self.R_w) else counterweights.radius(),
            **EndReadback(found).sizes(),
        }
        if split:
            dimensions |= found.middle_web()
        if max(radii) > 0:
            wanted = float(np.degrees(self.phi_w))
            dimensions["counterweight_angle"] = counterweights.angle(wanted)
        return dimensions
