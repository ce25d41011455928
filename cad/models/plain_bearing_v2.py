"""Half shells of a thin-walled plain bearing, with what a drawing of one shows; see the class below.

Beside version 1: back and lining are bodies of their own, upper and lower shell stand together, and there are
tang, joint relief, chamfers, a groove over a part of the bore, flanges and crush height.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from cadquery import Location, Vector

from cad.model import BRIGHT_STEEL, STEEL, Box, CadModel, Part, mm
from cad.shells.half_shell import Flange, Groove, HalfShell, Tang
from cad.shells.relief import Relief
from cad.shells.shell_readback import ShellSeen
from cad.surfaces import Seen
from templates.core.language.template import (
    Array,
    Truth,
    choice,
    derived,
    formula,
    given,
    require,
    units,
)

LINING_DENSITY = 3110.0  # kg/m³, of AlSn20Cu: mixture of its elements by mass
WHOLE = 3.14159  # rad; a groove of so much goes from joint to joint


@units("m", "1", returns="1")
def drawable(length: Array, least: float) -> Truth:
    """True if a length [m] is none, or one that the kernel can tell from none, `least` in micrometres."""
    return (length <= 0) | (length >= 1e-6 * least)


class PlainBearing(CadModel):
    """Half shells of a thin-walled plain bearing: the upper one, the lower one, or the pair.

    z is along the shaft, the joint in the plane y = 0, the crown of the upper shell at +y. The upper shell
    has the oil groove and the oil hole, the lower one is plain. Back and lining are bodies of their own, the
    back of steel, the lining of an aluminium-tin alloy; a groove deeper than the lining, from joint to joint,
    parts it in two rings. The bore is the finished one: the caller adds the clearance.

    - *Tang*: the lip at the back beside the joint on the side +x that locates the shell; its length is
      along the wall, its middle at a quarter of the width, on the side -z. The lower shell mirrors the upper
      one, so the tangs meet. The notch inside, where the tang was pressed out, is not drawn.
    - *Relief*: beside each joint the bore opens gradually, to the relief's depth at the joint.
    - *Chamfers* of 45°: of the bore at both ends, of the back at ends without a flange.
    - *Groove angle*: the turn of the groove about the crown; 180° is from joint to joint.
    - *Flanges*: collars of the back for thrust, one at +z or two.
    - *Crush height*: by so much each end of the wall goes on straight beyond the half circle, as before the
      cap is tightened. The upper shell's crown keeps its place; in a pair the shells stand apart by it.

    A tang, relief, hole, groove, flange or chamfer of no size is none.

    Limits
    ------
    Which features a shell has, and what they are called, is as in ISO 3548-1; it gives no sizes of most of
    them. Sizes by default are typical of engines and no standard's. The free spread is not drawn, and
    the wall is of one thickness (no eccentric bore).

    References
    ----------
    ISO 3548-1:2014, Plain bearings, thin-walled half bearings, part 1: tolerances, design features and
        methods of test.
    ISO 4383:2012, Plain bearings, multilayer materials for thin-walled plain bearings: AlSn20Cu on steel. Its
        density here is that of the mixture of its elements.
    """

    example = {
        "inner_diameter": "48 mm",
        "wall": "2.4 mm",
        "width": "24 mm",
        "shells": "upper",
        "lining_thickness": "0.6 mm",
        "oil_hole_diameter": "4 mm",
        "oil_groove_width": "5 mm",
        "oil_groove_depth": "0.8 mm",
        "oil_groove_angle": "120 deg",
        "tang_width": "4 mm",
        "tang_length": "4 mm",
        "tang_height": "1 mm",
        "relief_height": "6 mm",
        "relief_depth": "0.02 mm",
        "inner_chamfer": "0.2 mm",
        "outer_chamfer": "0.5 mm",
        "flange_diameter": "64 mm",
        "flange_thickness": "2.5 mm",
        "flanges": 1,
        "crush_height": "0.06 mm",
    }
    film_bore = "inner_diameter"
    toleranced = {
        "inner_diameter": {
            "of": ["upper_lining", "lower_lining"], "cylinders": "z", "datum": "A", "cylindricity": 0.5,
        },
        "lining_thickness": {"of": ["upper_lining", "lower_lining"], "walls": "z"},
        "width": {"of": ["upper_back", "lower_back"], "planes": "z", "perpendicularity": 1, "to": "A"},
        "flange_diameter": {"of": ["upper_back", "lower_back"], "cylinders": "z"},
        "flange_thickness": {"of": ["upper_back", "lower_back"], "planes": "z", "levels": [[-2, -1]]},
        "oil_hole_diameter": {"of": "upper_back", "along": "y"},
    }  # fmt: skip

    d: Array = given("mm", "inner diameter", symbol="d", ge=5, le=2000, also=("bearing diameter", "bore"))

    @derived("mm", "wall", symbol="t", ge=0.2, le=200)
    def t(self) -> Array:
        return 0.05 * self.d

    @derived("mm", "width", symbol="B", ge=0.5, le=2000, also=("bearing width",))
    def B(self) -> Array:
        return 0.5 * self.d

    shells: str = choice("pair", "upper", "lower", words="shells", default="pair")

    @derived("mm", "lining thickness", symbol="t_l", ge=0.02, le=50)
    def t_l(self) -> Array:
        return 0.125 * self.t

    @derived("mm", "oil hole diameter", symbol="d_h", ge=0, le=500)
    def d_h(self) -> Array:
        return np.minimum(0.08 * self.d, 0.2 * self.B)

    @derived("mm", "oil groove width", symbol="w_g", ge=0, le=500)
    def w_g(self) -> Array:
        return np.minimum(1.25 * self.d_h, 0.5 * self.B)

    @derived("mm", "oil groove depth", symbol="t_g", ge=0, le=100)
    def t_g(self) -> Array:
        return 0.35 * self.t * np.sign(self.w_g)

    phi_g: Array = given("deg", "oil groove angle", symbol=r"\varphi_g", default="180 deg", ge=20, le=180)

    @derived("mm", "tang width", symbol="w_t", ge=0, le=500)
    def w_t(self) -> Array:
        return 0.12 * self.B

    @derived("mm", "tang length", symbol="l_t", ge=0.05, le=500)
    def l_t(self) -> Array:
        return 0.08 * self.d

    @derived("mm", "tang height", symbol="h_t", ge=0.02, le=200)
    def h_t(self) -> Array:
        return 0.4 * self.t

    @derived("mm", "relief height", symbol="h_r", ge=0.05, le=500)
    def h_r(self) -> Array:
        return 0.12 * self.d

    @derived("mm", "relief depth", symbol="d_r", ge=0, le=20)
    def d_r(self) -> Array:
        return 0.1 * self.t_l

    @derived("mm", "inner chamfer", symbol="c_i", ge=0, le=100)
    def c_i(self) -> Array:
        return 0.2 * self.t

    @derived("mm", "outer chamfer", symbol="c_o", ge=0, le=100)
    def c_o(self) -> Array:
        return 0.25 * self.t

    @derived("mm", "flange diameter", symbol="D_f", ge=0, le=5000)
    def D_f(self) -> Array:
        """None."""
        return 0 * self.d

    @derived("mm", "flange thickness", symbol="b_f", ge=0.02, le=500)
    def b_f(self) -> Array:
        return self.t

    n_f: Array = given("1", "flanges", symbol="n_f", default="2", integer=True, ge=1, le=2)

    @derived("mm", "crush height", symbol="a", ge=0, le=50)
    def a(self) -> Array:
        """None: as built in."""
        return 0 * self.d

    @formula("mm", "outer diameter", symbol="D")
    def D(self) -> Array:
        return self.d + 2 * self.t

    @formula("mm", "length of the groove along the bore", name="groove_length", symbol="L_g")
    def L_g(self) -> Array:
        return self.d / 2 * self.phi_g

    @formula("mm", "steel back", name="back_thickness", symbol="t_s")
    def t_s(self) -> Array:
        return self.t - self.t_l

    @formula("mm", "width between flanges", name="seat_width", symbol="B_s")
    def B_s(self) -> Array:
        """The whole width if there is none."""
        return self.B - np.sign(self.D_f) * self.n_f * self.b_f

    @require("lining_thickness", "wall", remedy="make the lining thinner or the wall thicker")
    def back_is_steel(self) -> Truth:
        """The lining takes at most 60 % of the wall."""
        return self.t_l <= 0.6 * self.t

    @require("wall", "inner_diameter", remedy="make the wall thinner")
    def wall_is_thin(self) -> Truth:
        """The wall is at most 20 % of the bore: the shell is thin."""
        return self.t <= 0.2 * self.d

    @require("oil_groove_width", "inner_chamfer", "width", remedy="make the groove narrower")
    def groove_within_width(self) -> Truth:
        """Oil groove and chamfers of the bore take at most 90 % of the width."""
        return self.w_g + 2 * self.c_i <= 0.9 * self.B

    @require("oil_hole_diameter", "inner_chamfer", "width", remedy="make the hole smaller or the shell wider")
    def hole_within_width(self) -> Truth:
        """Oil hole and chamfers of the bore take at most 90 % of the width."""
        return self.d_h + 2 * self.c_i <= 0.9 * self.B

    @require("oil_hole_diameter", "outer_chamfer", "flange_thickness", "flange_diameter", "width",
             remedy="make the hole smaller or the shell wider")  # fmt: skip
    def hole_within_seat(self) -> Truth:
        """The oil hole keeps off the chamfers of the back and off flanges."""
        edge = np.maximum(self.c_o, np.sign(self.D_f) * self.b_f)
        return self.d_h + 2 * edge <= 0.95 * self.B

    @require("oil_hole_diameter", "inner_diameter", remedy="make the hole smaller")
    def hole_within_bore(self) -> Truth:
        """The oil hole takes at most 40 % of the bore."""
        return self.d_h <= 0.4 * self.d

    @require("oil_groove_depth", "wall", remedy="make the groove shallower or the wall thicker")
    def groove_within_wall(self) -> Truth:
        """The oil groove takes at most 80 % of the wall."""
        return self.t_g <= 0.8 * self.t

    @require("oil_groove_depth", "oil_groove_width", remedy="give the groove both sizes, or neither")
    def groove_has_a_section(self) -> Truth:
        """An oil groove has a width and a depth, or neither."""
        return ((self.t_g <= 0) & (self.w_g <= 0)) | ((self.t_g > 0) & (self.w_g > 0))

    @require("oil_groove_depth", "lining_thickness",
             remedy="end the groove within the lining or in the back, 5 % of the lining off")  # fmt: skip
    def groove_ends_clearly(self) -> Truth:
        """The bottom of the groove is off the back of the lining by 5 % of its thickness."""
        return abs(self.t_g - self.t_l) >= 0.05 * self.t_l

    @require("oil_groove_depth", "relief_depth", remedy="make the groove deeper, or the relief shallower")
    def groove_is_deeper_than_relief(self) -> Truth:
        """A groove is at least 10 % deeper than the joint relief."""
        return (self.t_g <= 0) | (self.t_g >= 1.1 * self.d_r)

    @require("oil_hole_diameter", "oil_groove_width",
             remedy="make the hole as wide as the groove, or change it by 1 %")  # fmt: skip
    def hole_clears_groove_edge(self) -> Truth:
        """An oil hole wider than its groove is wider by 1 %; for less, OpenCASCADE returns wrong solids."""
        return (self.w_g <= 0) | (self.d_h <= self.w_g) | (self.d_h >= 1.01 * self.w_g)

    @require("oil_groove_angle", "oil_hole_diameter", remedy="make the groove longer or the hole smaller")
    def groove_holds_the_hole(self) -> Truth:
        """A groove over a part of the bore is longer than the oil hole is wide, by 10 %."""
        return (self.w_g <= 0) | (self.d * np.sin(self.phi_g / 2) >= 1.1 * self.d_h)

    @require("oil_groove_angle", "relief_height",
             remedy="take 180°, or end the groove 5° above the relief")  # fmt: skip
    def groove_ends_above_relief(self) -> Truth:
        """A groove goes from joint to joint (180°), or ends 5° above the joint relief and at 160° at most."""
        end = np.arcsin(np.minimum(2 * self.h_r / self.d, 1.0)) + np.pi / 36
        return (self.w_g <= 0) | (self.phi_g > 3.14159) | (self.phi_g <= np.minimum(np.pi - 2 * end, 2.8))

    @require("relief_height", "inner_diameter", remedy="make the relief lower")
    def relief_is_low(self) -> Truth:
        """The joint relief is at most 30 % of the bore high."""
        return self.h_r <= 0.3 * self.d

    @require("relief_depth", "lining_thickness", remedy="make the relief shallower")
    def relief_within_lining(self) -> Truth:
        """The joint relief takes at most 80 % of the lining."""
        return self.d_r <= 0.8 * self.t_l

    @require("relief_depth", "relief_height", remedy="make the relief shallower or higher")
    def relief_is_shallow(self) -> Truth:
        """The joint relief is at most a tenth as deep as it is high."""
        return self.d_r <= 0.1 * self.h_r

    @require("inner_chamfer", "outer_chamfer", "wall", remedy="make the chamfers smaller")
    def chamfers_leave_a_face(self) -> Truth:
        """The chamfers together take at most 80 % of the wall."""
        return self.c_i + self.c_o <= 0.8 * self.t

    @require("inner_chamfer", "lining_thickness", remedy="change the chamfer by 5 % of the lining")
    def chamfer_clears_lining(self) -> Truth:
        """The chamfer of the bore ends in the lining or in the back, 5 % of the lining's thickness off."""
        return abs(self.c_i - self.t_l) >= 0.05 * self.t_l

    @require("inner_chamfer", "relief_depth", remedy="make the chamfer larger, or 0 for none")
    def chamfer_is_deeper_than_relief(self) -> Truth:
        """A chamfer of the bore is at least 10 % deeper than the joint relief."""
        return (self.c_i <= 0) | (self.c_i >= 1.1 * self.d_r)

    @require(
        "outer_chamfer",
        "width",
        "flange_thickness",
        "flange_diameter",
        remedy="make the chamfers or flanges smaller",
    )
    def seat_is_left(self) -> Truth:
        """Chamfers and flanges leave at least 30 % of the width to the seat in the housing."""
        return self.B_s - 2 * self.c_o >= 0.3 * self.B

    @require("flange_diameter", "inner_diameter", "wall", remedy="make the flange larger, or 0 for none")
    def flange_stands_out(self) -> Truth:
        """A flange is at least 2 % larger than the outside of the shell, and at most twice as large."""
        return (self.D_f <= 0) | ((self.D_f >= 1.02 * self.D) & (self.D_f <= 2 * self.D))

    @require("flange_thickness", "flange_diameter", "inner_chamfer", "lining_thickness",
             remedy="make the flange thicker or the chamfer smaller")  # fmt: skip
    def flange_holds_chamfer(self) -> Truth:
        """A flange is thicker than what the chamfer of the bore takes."""
        return (self.D_f <= 0) | (self.b_f >= 1.02 * (self.c_i - self.t_l))

    @require("tang_length", "wall", "lining_thickness", "inner_diameter", remedy="make the tang shorter")
    def tang_grows_out_of_the_back(self) -> Truth:
        """Along the tang the back bends away by at most 70 % of the thickness of its steel."""
        R = self.D / 2
        return (self.w_t <= 0) | (self.l_t <= np.sqrt(2 * R * 0.7 * self.t_s * (1 - 0.35 * self.t_s / R)))

    @require("tang_width", "width", "outer_chamfer", "flange_thickness", "flange_diameter",
             remedy="make the tang narrower")  # fmt: skip
    def tang_within_seat(self) -> Truth:
        """The tang keeps off the chamfers of the back and off flanges, by 2 % of the width."""
        edge = np.maximum(self.c_o, np.sign(self.D_f) * self.b_f)
        return (self.w_t <= 0) | (self.w_t / 2 <= 0.23 * self.B - edge)

    @require("tang_width", "oil_groove_width", remedy="change the tang or the groove by 1 % of the width")
    def tang_clears_groove_edge(self) -> Truth:
        """No side of the tang is in the plane of a groove's side; 0.5 % of the width is between them."""
        low, high, off = self.B / 4 - self.w_t / 2, self.B / 4 + self.w_t / 2, 0.005 * self.B
        clear = (abs(low - self.w_g / 2) >= off) & (abs(high - self.w_g / 2) >= off)
        return (self.w_t <= 0) | (self.w_g <= 0) | clear

    @require("tang_height", "wall", remedy="make the tang lower")
    def tang_is_low(self) -> Truth:
        """The tang stands out by at most the thickness of the wall."""
        return self.h_t <= self.t

    @require("tang_height", "flange_diameter", "inner_diameter", "wall", remedy="make the tang lower")
    def tang_is_lower_than_flange(self) -> Truth:
        """Beside a flange the tang is lower, by 1 % of the diameter."""
        return (self.D_f <= 0) | (self.w_t <= 0) | (self.D_f >= 1.01 * (self.D + 2 * self.h_t))

    @require("crush_height", "inner_diameter", remedy="make the crush height smaller")
    def crush_is_small(self) -> Truth:
        """The crush height is at most 1 % of the bore."""
        return self.a <= 0.01 * self.d

    @require("oil_hole_diameter", "oil_groove_width", "oil_groove_depth", "tang_width", "inner_chamfer",
             "outer_chamfer", "crush_height", remedy="use 0 for none")  # fmt: skip
    def features_are_drawable(self) -> Truth:
        """Features measure 0, or at least the 10 µm that the kernel draws reliably."""
        sizes = (self.d_h, self.w_g, self.t_g, self.w_t, self.c_i, self.c_o)
        fits = drawable(self.a, 1.0)
        for size in sizes:
            fits = fits & drawable(size, 10.0)
        return fits

    @require("relief_depth", remedy="use 0 for none")
    def relief_is_drawable(self) -> Truth:
        """The relief is 0 deep, or at least 1 µm."""
        return drawable(self.d_r, 1.0)

    def build(self) -> tuple[Part, ...]:
        """Return the back and lining of each shell."""
        parts = []
        for which, side in (("upper", 1), ("lower", -1)):
            if self.shells in ("pair", which):
                parts += self._parts(which, self.drawn(which), side)
        return tuple(parts)

    def _parts(self, name: str, shell: HalfShell, side: int) -> list[Part]:
        away = Location(Vector(0, side * shell.crush if self.shells == "pair" else 0, 0))
        back, lining = shell.back(), shell.lining_piece()
        if side < 0:
            back, lining = (body.mirror("XZ") for body in (back, lining))
        pieces = shell.lining_places()
        places = tuple(away * place for place in pieces)
        return [
            Part(f"{name}_back", back, shell.back_volume(), STEEL, places=(away,)),
            Part(
                f"{name}_lining", lining, shell.lining_volume() / len(pieces), BRIGHT_STEEL, LINING_DENSITY,
                places, material="AlSn20Cu",
            ),
        ]  # fmt: skip

    def drawn(self, which: str) -> HalfShell:
        """Return the parameters of one shell as radii and halves."""
        upper = which == "upper"
        bore = mm(self.d) / 2
        return HalfShell(
            bore=bore,
            lining=bore + mm(self.t_l),
            outside=mm(self.D) / 2,
            half_width=mm(self.B) / 2,
            inner_chamfer=mm(self.c_i),
            outer_chamfer=mm(self.c_o),
            crush=mm(self.a),
            relief=Relief(bore, mm(self.h_r), mm(self.d_r)) if self.d_r > 0 else None,
            groove=Groove(
                bore + mm(self.t_g), mm(self.w_g) / 2, float(self.phi_g), bool(self.phi_g > WHOLE)
            ) if upper and self.w_g > 0 else None,
            hole=mm(self.d_h) / 2 if upper else 0.0,
            tang=Tang(mm(self.w_t), mm(self.l_t), mm(self.h_t), -mm(self.B) / 4) if self.w_t > 0 else None,
            flange=Flange(mm(self.D_f) / 2, mm(self.b_f), round(float(self.n_f))) if self.D_f > 0 else None,
        )  # fmt: skip

    def bounding_box(self) -> Box:
        """Return the back or its flanges, the tang on the side +x, and the legs."""
        shell = self.drawn("upper")
        reach = shell.flange.radius if shell.flange else shell.outside
        right = max(reach, shell.outside + shell.tang.height if shell.tang else 0.0)
        b, a = shell.half_width, shell.crush
        far = reach + a if self.shells == "pair" else reach
        low, high = {"pair": (-far, far), "upper": (-a, far), "lower": (-far, a)}[self.shells]
        return Box((-reach, low, -b), (right, high, b))

    def dimensions(self, seen: Mapping[str, Seen]) -> dict[str, float]:
        """Return every length that the shells have, of the upper one if it is there."""
        which = "lower" if self.shells == "lower" else "upper"
        one = ShellSeen(seen[f"{which}_back"], seen[f"{which}_lining"], self.drawn(which))
        return one.sizes(with_oil=which == "upper", side=-1 if which == "lower" else 1)
