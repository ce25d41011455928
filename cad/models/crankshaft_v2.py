"""Crankshaft of any number of throws: main journals, webs with their counterweights, nose, flange with bolts.

The throw is that of `crank_throw`; what its words mean is said in the class below, which users read.
"""

from collections.abc import Mapping

import numpy as np

from cad.cranks.crankshaft_readback import ShaftSeen
from cad.cranks.outline import Outline
from cad.cranks.rules import CrankRules, clear_of_corners, corner
from cad.cranks.throw import End, Throw
from cad.cranks.whole import Bolts, Throws, WholeShaft
from cad.model import Box, Dimension, Part, mm
from cad.shaft import Shaft
from cad.surfaces import Seen
from templates.core.language.template import (
    Array,
    Truth,
    curve,
    derived,
    formula,
    given,
    profile,
    require,
    units,
)

MOST_THROWS = 16


@units("rad", returns="1")
def count(angles: Array) -> Array:
    """Return the number of them."""
    return np.asarray(float(np.shape(angles)[-1]))


@units("m", "1", returns="1")
def webs_of(radii: Array, throws: Array) -> Array:
    """Return the number of webs that have radii: all, if there is one number."""
    return 2 * throws if np.ndim(radii) == 0 else np.asarray(float(np.shape(radii)[-1]))


@units("m", returns="1")
def there_is_none(radii: Array) -> Truth:
    """Return whether no web has a counterweight."""
    return np.all(np.atleast_1d(radii) <= 0, axis=-1)


@units("m", "m", returns="1")
def stand_out(radii: Array, least: Array) -> Truth:
    """Return whether each counterweight that is one reaches so far."""
    if np.ndim(radii) == 0:
        return (radii <= 0) | (radii >= least)
    return np.all((radii <= 0) | (radii >= np.expand_dims(least, -1)), axis=-1)


@units("m", "rad", "1", returns="m**2", latex=r"R_w^2\,\varphi_w / 2")
def sectors(radii: Array, angle: Array, throws: Array) -> Array:
    """Return the area of the sector of each web's counterweight, from the journal's axis on [m²]."""
    each = np.atleast_1d(radii) ** 2 * np.expand_dims(angle, -1) / 2
    return np.broadcast_to(each, (*each.shape[:-1], round(float(2 * throws))))


class Crankshaft(CrankRules):
    """Crankshaft with any number of throws: main journals, counterweights of each web, nose and flange.

    z is the axis on which the shaft turns; z = 0 is the middle of the first main journal. The nose is at -z,
    the flange at +z, where an engine has its flywheel. Pin angles count from x towards y, as those of
    `engine` 1; their number is that of the throws. All throws are alike but for their counterweights.

    A bore, fillet, oil drilling, counterweight, bolt hole or inclination of 0 is none. Counterweight radii
    are one number, or one for each web from the nose on, two for each throw; their angle is common.

    Fillets run round pins and journals where they meet a web. The journals' bore goes through the whole
    shaft, each pin's through the pin and both webs. An oil drilling runs straight from mid-pin, on the side
    away from the shaft, through the web towards the flange, to mid-length of the next main journal, on its
    other side. The counterweights are sectors about the shaft opposite to the pin, as thick as their webs.
    Bolt holes are blind with flat bottoms, the first on the line x.

    The face inclination takes material off the outer face of each web, from beside the journal's fillet to
    the end beyond the pin: 0 is the heaviest web.

    The rotating couple, the integral of z (x + i y) over the mass, follows from what is measured:
    mass centre_z centre_x - inertia_xz, and mass centre_z centre_y - inertia_yz.

    Limits
    ------
    At most 16 throws of one size, each with its own pin and two webs; webs at least 2 % wider than journal
    and pin with their fillets. A pin is not split. Journals, pins, nose and flange are plain cylinders
    without grooves, keyways, threads or fillets at the shoulders of the ends; a counterweight spans at most
    half a turn.

    References
    ----------
    Own closed form of the volume: the parts touch in faces, so their volumes add.
    """

    example = {
        "pin_angles": {"value": [0, 180], "unit": "deg"},
        "journal_diameter": "55 mm",
        "journal_length": "26 mm",
        "journal_bore": "12 mm",
        "pin_diameter": "48 mm",
        "pin_length": "32 mm",
        "pin_bore": "14 mm",
        "web_thickness": "18 mm",
        "web_width": "80 mm",
        "throw": "43 mm",
        "fillet": "2.5 mm",
        "oil_drilling_diameter": "5 mm",
        "counterweight_radius": {"value": [70, 0, 0, 70], "unit": "mm"},
        "counterweight_angle": "130 deg",
        "face_inclination": "6 deg",
        "nose_length": "45 mm",
        "nose_diameter": "35 mm",
        "flange_thickness": "16 mm",
        "flange_diameter": "90 mm",
        "bolt_holes": 6,
        "bolt_hole_diameter": "10 mm",
        "bolt_circle_diameter": "68 mm",
    }
    toleranced = {
        "journal_diameter": {"cylinders": "z", "datum": "A", "cylindricity": 0.5},
        "journal_bore": {"cylinders": "z"},
        "pin_diameter": {"beside": "z", "cylindricity": 0.5, "parallelism": 1, "to": "A"},
        "pin_bore": {"beside": "z"},
        "throw": {"between": ["journal_diameter", "pin_diameter"]},
        "oil_drilling_diameter": {"askew": True},
        "nose_diameter": {"cylinders": "z", "end": "low", "cylindricity": 0.5},
        "flange_diameter": {"cylinders": "z", "end": "high"},
        "bolt_hole_diameter": {"beside": "z"},
        "journal_length": {"shoulders": "journal_diameter"},
        "pin_length": {"shoulders": "pin_diameter", "perpendicularity": 1, "to": "A"},
        "web_thickness": {"discs": ["journal_diameter", "pin_diameter", "nose_diameter", "flange_diameter"]},
    }

    psi: Array = curve(
        "deg", "pin angles", along="throws", symbol=r"\psi", ge=-720, le=720, also=("crankpin angles",)
    )
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
        return self.L_c + 2 * self.L_w + self.L_j

    @profile("mm**2", "counterweight sector", along="webs", symbol="A_w")
    def A_w(self) -> Array:
        """Area of the sector that makes a counterweight, from the journal's axis on."""
        return sectors(self.R_w, self.phi_w, self.n)

    @derived("mm", "nose length", symbol="L_n", ge=0.05, le=5000)
    def L_n(self) -> Array:
        return 0.8 * self.D_j

    @derived("mm", "nose diameter", symbol="D_n", ge=0.1, le=5000)
    def D_n(self) -> Array:
        return 0.8 * self.D_j

    @derived("mm", "flange thickness", symbol="t_f", ge=0.05, le=5000)
    def t_f(self) -> Array:
        return 0.3 * self.D_j

    @derived("mm", "flange diameter", symbol="D_f", ge=0.1, le=5000)
    def D_f(self) -> Array:
        return 1.6 * self.D_j

    n_b: Array = given("1", "bolt holes", symbol="n_b", default="6", integer=True, ge=1, le=64)

    @derived("mm", "bolt hole diameter", symbol="d_b", ge=0, le=1000)
    def d_b(self) -> Array:
        """None."""
        return 0 * self.D_j

    @derived("mm", "bolt circle diameter", symbol="D_b", ge=0.05, le=5000)
    def D_b(self) -> Array:
        return 0.75 * self.D_f

    @derived("mm", "bolt hole depth", symbol="l_b", ge=0.01, le=5000)
    def l_b(self) -> Array:
        return 0.8 * self.t_f

    @formula("mm", "overall length", symbol="L")
    def L(self) -> Array:
        return self.L_n + self.n * self.p + self.L_j + self.t_f

    @formula("mm", "wall at the nose", name="nose_wall", symbol="w_n")
    def w_n(self) -> Array:
        return (self.D_n - self.d_j) / 2

    @formula("mm", "wall at the flange", name="flange_wall", symbol="w_f")
    def w_f(self) -> Array:
        return (self.D_f - self.d_j) / 2

    @formula("mm", "rim outside the bolt holes", name="bolt_rim", symbol="w_b")
    def w_b(self) -> Array:
        return (self.D_f - self.D_b - self.d_b) / 2

    @formula("mm", "width between bolt holes", name="bolt_gap", symbol="g_b")
    def g_b(self) -> Array:
        return self.D_b * np.sin(np.pi / self.n_b) - self.d_b

    @formula("mm", "floor below the bolt holes", name="bolt_floor", symbol="f_b")
    def f_b(self) -> Array:
        return self.t_f - self.l_b

    @require("pin_angles", remedy="give an angle for each throw, 1 to 16 of them")
    def throws_are_few(self) -> Truth:
        """There are at most 16 throws."""
        return self.n <= MOST_THROWS

    @require("counterweight_radius", "pin_angles", remedy="give one number, or two for each throw")
    def each_web_has_its_counterweight(self) -> Truth:
        """Counterweight radii are one number, or one for each web."""
        return webs_of(self.R_w, self.n) == 2 * self.n

    @require("fillet", "journal_length", remedy="make the fillet smaller or the journal longer")
    def fillets_fit_on_journal(self) -> Truth:
        """The two fillets take at most 90 % of a journal's length."""
        return 2 * self.r_f <= 0.9 * self.L_j

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

    @require("nose_diameter", "journal_bore", remedy="make the nose thicker or the bore smaller")
    def nose_has_wall(self) -> Truth:
        """The journals' bore takes at most 98 % of the nose's diameter."""
        return self.d_j <= 0.98 * self.D_n

    @require("flange_diameter", "journal_bore", remedy="make the flange larger or the bore smaller")
    def flange_has_wall(self) -> Truth:
        """The journals' bore takes at most 98 % of the flange's diameter."""
        return self.d_j <= 0.98 * self.D_f

    @require("nose_diameter", "journal_diameter", remedy="make them equal, or change one by 0.1 %")
    def nose_shoulder_is_drawable(self) -> Truth:
        """The nose is as thick as the journal, or differs from it by at least 0.1 %."""
        return (abs(self.D_n - self.D_j) <= 1e-12 * self.D_j) | (abs(self.D_n - self.D_j) >= 1e-3 * self.D_j)

    @require("flange_diameter", "journal_diameter", remedy="make them equal, or change one by 0.1 %")
    def flange_shoulder_is_drawable(self) -> Truth:
        """The flange is as thick as the journal, or differs from it by at least 0.1 %."""
        return (abs(self.D_f - self.D_j) <= 1e-12 * self.D_j) | (abs(self.D_f - self.D_j) >= 1e-3 * self.D_j)

    @require("bolt_circle_diameter", "bolt_hole_diameter", "flange_diameter",
             remedy="make the bolt circle or the holes smaller, or 0 for no holes")  # fmt: skip
    def bolts_keep_within_flange(self) -> Truth:
        """Bolt holes keep within 98 % of the flange's diameter."""
        return (self.d_b <= 0) | (self.D_b + self.d_b <= 0.98 * self.D_f)

    @require("bolt_circle_diameter", "bolt_hole_diameter", "journal_bore",
             remedy="make the circle larger, the holes or the bore smaller, or 0 for none")  # fmt: skip
    def bolts_clear_bore(self) -> Truth:
        """Bolt holes keep off the axis and the journals' bore by 2 % of the bolt circle."""
        return (self.d_b <= 0) | (0.98 * self.D_b >= self.d_j + self.d_b)

    @require("bolt_circle_diameter", "bolt_hole_diameter", "bolt_holes",
             remedy="take fewer or smaller holes, or a larger bolt circle")  # fmt: skip
    def bolts_keep_apart(self) -> Truth:
        """Between neighbouring bolt holes there is at least 5 % of their diameter."""
        return (self.d_b <= 0) | (self.n_b <= 1) | (self.D_b * np.sin(np.pi / self.n_b) >= 1.05 * self.d_b)

    @require("bolt_hole_depth", "flange_thickness", remedy="make the holes less deep or the flange thicker")
    def bolts_are_blind(self) -> Truth:
        """Bolt holes take 1 to 95 % of the flange's thickness."""
        return (self.d_b <= 0) | ((self.l_b <= 0.95 * self.t_f) & (self.l_b >= 0.01 * self.t_f))

    @require("bolt_hole_diameter", "journal_diameter", remedy="use 0 for none")
    def bolts_are_drawable(self) -> Truth:
        """Bolt holes measure 0, or at least 0.2 % of the journal's diameter."""
        return (self.d_b <= 0) | (self.d_b >= 0.002 * self.D_j)

    def drawn(self) -> WholeShaft:
        """Return the parameters as radii, lengths and angles of what is drawn."""
        angles = np.atleast_1d(self.psi).tolist()
        radii = [mm(radius) for radius in np.broadcast_to(self.R_w, 2 * len(angles))]
        return WholeShaft(
            throws=tuple(
                Throws(self._throw(radii[2 * k]), self._throw(radii[2 * k + 1]), angle)
                for k, angle in enumerate(angles)
            ),
            nose=End(mm(self.D_n) / 2, mm(self.L_n)),
            flange=End(mm(self.D_f) / 2, mm(self.t_f)),
            bolts=Bolts(round(float(self.n_b)), mm(self.d_b) / 2, mm(self.D_b) / 2, mm(self.l_b))
            if self.d_b > 0
            else None,
        )

    def _throw(self, counterweight: float) -> Throw:
        return Throw(
            outline=Outline(
                throw=mm(self.R),
                half_width=mm(self.W) / 2,
                rectangular=self.web_shape == "rectangular",
                counterweight=counterweight,
                half_angle=float(self.phi_w) / 2,
            ),
            web_thickness=mm(self.L_w),
            journal=mm(self.D_j) / 2,
            journal_bore=mm(self.d_j) / 2,
            journal_length=mm(self.L_j),
            pin=mm(self.D_c) / 2,
            pin_bore=mm(self.d_c) / 2,
            pin_length=mm(self.L_c),
            fillet=mm(self.r_f),
            drilling=mm(self.d_o) / 2,
            inclination=float(self.beta),
            incline_start=mm(self.x_b),
        )

    def build(self) -> tuple[Part, ...]:
        """Return one solid."""
        shaft = self.drawn()
        return (Part(self.id, shaft.solid(), shaft.volume()),)

    def bounding_box(self) -> Box:
        """Return the webs, counterweights, nose and flange together."""
        return self.drawn().box()

    def shaft(self) -> Shaft:
        """Return where it is held and loaded: by the end of its nose and by its flange."""
        shaft = self.drawn()
        return Shaft(shaft.low, shaft.high)

    def dimensions(self, seen: Mapping[str, Seen]) -> dict[str, Dimension]:
        """Return every parameter; the angle of counterweights and the bolt circle only if there are any."""
        found = ShaftSeen(seen[self.id])
        front, rear = found.ends
        radii = found.counterweights()
        near = np.degrees(np.atleast_1d(self.psi)).tolist()
        dimensions: dict[str, Dimension] = {
            "pin_angles": found.pin_angles(near),
            **found.common(),
            "counterweight_radius": radii,
            "nose_length": front[1].reach[1] - front[0].reach[1],
            "nose_diameter": front[1].diameter,
            "flange_thickness": rear[1].reach[1] - rear[0].reach[1],
            "flange_diameter": rear[1].diameter,
            **found.bolts(),
        }
        if max(radii) > 0:
            wanted = float(np.degrees(self.phi_w))
            dimensions["counterweight_angle"] = found.counterweight_angle(radii, wanted)
        return dimensions
