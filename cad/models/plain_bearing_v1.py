"""Plain bearing: half shells in the housing or in their free state, or a full bush.

The docstring of the class below explains the parameters to users. Parameters and rules are in `cad.shells`.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from cadquery import Location, Vector

from cad.model import BRIGHT_STEEL, STEEL, Box, Part, mm
from cad.shells.half_shell import Flange, FullBush, Groove, HalfShell, Tang
from cad.shells.parameters import joints
from cad.shells.relief import Relief
from cad.shells.rules import ShellRules
from cad.shells.shell_readback import ShellReadback
from cad.shells.spread import FreeShellReadback, half_angle, reach_of
from cad.surfaces import PartSurfaces
from templates.core.language.template import (
    Array,
    Truth,
    choice,
    derived,
    formula,
    require,
    units,
)

LINING_DENSITY = 3110.0  # kg/m³, of AlSn20Cu: mixture of its elements by mass
_ANGLE_DIGITS = 12  # decimals of an angle [rad], so that equal parameters give equal bytes
WHOLE = 3.14159  # rad; a groove of this extent goes from joint to joint
LININGS = ("upper_lining", "lower_lining", "full_lining")
BACKS = ("upper_back", "lower_back", "full_back")


@units(None, returns="1")
def is_fitted(state: str) -> Truth:
    """Return whether a shell is drawn as fitted in the housing."""
    return np.asarray(state == "fitted")


class PlainBearing(ShellRules):
    """Plain bearing: a pair of half shells, a single one, or a full bush; fitted or in the free state.

    z is along the shaft, the joint is in the plane y = 0, and the crown of the upper shell is at +y. The
    upper shell has the oil groove and the oil hole; the lower one is plain. Back and lining are separate
    bodies, the back of steel, the lining of an aluminium-tin alloy. A groove from joint to joint that is
    deeper than the lining divides the lining into two rings. A shell without lining is one body of steel. The
    bore is the finished bore; it must already include the clearance.

    - *Full*: a closed bush with its oil hole at the crown, without joint, tang, relief and crush height. A
      groove of 180° runs all round; a shorter one is centred on the crown.
    - *Tang*: the lip on the back that locates the shell, next to the joint on the side +x. Its length is
      measured along the wall; its middle is at a quarter of the width, on the side -z. The lower shell is the
      mirror image of the upper one, so the tangs meet. The notch on the inside, from which the tang was
      pressed out, is not drawn.
    - *Relief*: near each joint the bore opens gradually, to the depth of the relief at the joint.
    - *Wall reduction*: an eccentric bore, whose wall is thinner towards the joints. The reduction is the
      difference between the wall at the crown and the wall at the reduction height above the joint, measured
      radially; 0 makes a concentric bore. Bore and wall are those at the crown. The back stays round, so the
      lining is thinner towards the joints.
    - *Chamfers* of 45°: on the bore at both ends, on the back at ends without a flange.
    - *Groove angle*: the angle of the groove, centred on the crown; at 180° it runs from joint to joint.
    - *Flanges*: thrust flanges of the back, one at +z or two.
    - *Crush height*: the straight length by which each end of the wall extends beyond the half circle before
      the cap is tightened. The crown of the upper shell keeps its position; in a pair the shells are moved
      apart accordingly.
    - *Free spread*: the difference between the width of a free shell over the outer edges of its joints and
      its outer diameter in the housing. The spread holds a shell in its seat during assembly.
    - *State*: `fitted` draws the shell in its housing, and the free spread does not affect the shape. `free`
      draws the unloaded shell: an arc of larger radius and less than half a turn. The middle line of its wall
      is as long as in the housing, so the volume of a plain wall is the same. Sizes at a joint (tang, relief,
      crush height) are relative to that joint; the groove keeps its length along the wall. In both states,
      give diameters and groove angle as in the housing.

    A size of 0 omits a lining, tang, relief, hole, flange, chamfer or groove.

    Limits
    ------
    The features of a shell and their names are those of ISO 3548-1, which gives no sizes for most of them.
    Default sizes are typical of engines and do not come from a standard: the free spread is 1 % of the bore;
    Cummins' manual states about 0.64 mm. A shell with an eccentric bore is fitted, has a lining and no joint
    relief.

    The curvature of a free shell changes uniformly: the model neglects that grooves and flanges change the
    local stiffness, the contact pressure of the seat, and the loss of spread in a hot engine. In the file of
    a free shell the diameters of bore and flange have no tolerance, because no face has these diameters.

    The tolerance of a wall with a lining refers to a face of the lining and a face of the back, so in the
    file it belongs to two parts.

    References
    ----------
    ISO 3548-1:2014, Plain bearings, thin-walled half bearings, part 1: tolerances, design features and
        methods of test; 4.4, free spread.
    TM 5-3820-256-24-5 (Cummins CGES-185-3), Connecting rods, pistons, rings and sleeves, figure 11: bearing
        spread, the width over the open ends beyond the bore of rod or crankcase.
    IPD, Measuring wall thickness of main and rod bearings (Engine Builder, December 2011): eccentricity as
        the difference between the wall at the crown and about 3/8 in (9.5 mm) above the parting line.
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
        "state": "fitted",
        "free_spread": "0.6 mm",
    }
    film_bore = "inner_diameter"
    rounds_noise = True
    toleranced = {
        "inner_diameter": {"datum": "A", "cylindricity": 0.5},
        "wall": {},
        "lining_thickness": {},
        "width": {"perpendicularity": 1, "to": "A"},
        "flange_diameter": {},
        "flange_thickness": {},
        "oil_hole_diameter": {},
        "oil_groove_width": {},
        "crush_height": {},
        "inner_chamfer": {},
        "outer_chamfer": {},
        "relief_height": {},
        "relief_depth": {},
        "tang_width": {},
        "tang_length": {},
        "tang_height": {},
        "oil_groove_depth": {},
    }  # fmt: skip

    state: str = choice("fitted", "free", words="state", default="fitted")

    @derived("mm", "free spread", symbol="s_f", ge=0, le=500)
    def s_f(self) -> Array:
        """Return the default: a hundredth of the bore, or 0 for a full bush."""
        return joints(self.shells) * 0.01 * self.d

    @formula("mm", "length of the wall's middle from crown to leg", name="half_length", symbol="L_h")
    def L_h(self) -> Array:
        return np.pi / 4 * (self.d + self.t)

    @formula("mm", "width over the joints, free", name="free_width", symbol="W_f")
    def W_f(self) -> Array:
        return self.D + self.s_f

    @formula("deg", "angle from crown to joint, free", name="free_angle", symbol=r"\varphi_f")
    def phi_f(self) -> Array:
        return half_angle(self.L_h, self.t, self.a, self.W_f)

    @formula("mm", "bore's radius, free", name="free_bore_radius", symbol="r_f")
    def r_f(self) -> Array:
        return self.L_h / self.phi_f - self.t / 2

    @require("free_spread", "inner_diameter", remedy="make the free spread smaller")
    def spread_is_small(self) -> Truth:
        """The free spread is at most 10 % of the bore."""
        return self.s_f <= 0.1 * self.d

    @require("state", "free_spread", "inner_diameter",
             remedy="make the free spread larger, or draw the shell fitted")  # fmt: skip
    def a_free_shell_is_spread(self) -> Truth:
        """A shell in the free state has a free spread of at least 0.05 % of the bore."""
        return is_fitted(self.state) | (self.s_f >= 0.0005 * self.d)

    @require("state", "wall", "inner_diameter", remedy="make the wall thinner, or draw the shell fitted")
    def a_free_shell_is_thin(self) -> Truth:
        """The wall of a shell in the free state is at most 20 % of the bore."""
        return is_fitted(self.state) | (self.t <= 0.2 * self.d)

    @require("state", "wall_reduction", remedy="draw the shell fitted, or with a wall reduction of 0")
    def an_eccentric_shell_is_fitted(self) -> Truth:
        """A shell with an eccentric bore is drawn fitted."""
        return is_fitted(self.state) | (self.delta <= 0)

    @require(
        "state", "free_spread", "shells", remedy="draw it fitted with a free spread of 0, or half shells"
    )
    def a_full_bush_is_fitted(self) -> Truth:
        """A full bush has no free spread and is always fitted."""
        return (joints(self.shells) > 0) | (is_fitted(self.state) & (self.s_f <= 0))

    def build(self) -> tuple[Part, ...]:
        """Return the back and lining of each shell."""
        if self.shells == "full":
            return tuple(self._parts("full", self.drawn("full"), 1))
        parts = []
        for which, side in (("upper", 1), ("lower", -1)):
            if self.shells in ("pair", which):
                parts += self._parts(which, self.drawn(which), side)
        return tuple(parts)

    def _parts(self, name: str, shell: HalfShell, side: int) -> list[Part]:
        away = Location(Vector(0, side * shell.crush if self.shells == "pair" else 0, 0))
        back = shell.back() if side > 0 else shell.back().mirror("XZ")
        parts = [Part(f"{name}_back", back, shell.back_volume(), STEEL, places=(away,))]
        if shell.is_lined:
            lining = shell.lining_piece() if side > 0 else shell.lining_piece().mirror("XZ")
            pieces = shell.lining_places()
            places, volume = tuple(away * place for place in pieces), shell.lining_volume() / len(pieces)
            parts.append(
                Part(
                    f"{name}_lining",
                    lining,
                    volume,
                    BRIGHT_STEEL,
                    LINING_DENSITY,
                    places,
                    material="AlSn20Cu",
                )
            )
        return parts

    def drawn(self, which: str) -> HalfShell:
        """Return the parameters of one shell in its state, converted to radii and half lengths."""
        upper, fitted = which != "lower", self.state == "fitted"
        bore = mm(self.d / 2 if fitted else self.r_f)
        angle = np.pi / 2 if fitted else round(float(self.phi_f), _ANGLE_DIGITS)
        wider = bore - mm(self.d) / 2
        form = FullBush if which == "full" else HalfShell
        return form(
            bore=bore,
            lining=bore + mm(self.t_l),
            outside=mm(self.D) / 2 + wider,
            half_width=mm(self.B) / 2,
            inner_chamfer=mm(self.c_i),
            outer_chamfer=mm(self.c_o),
            crush=mm(self.a),
            relief=Relief(bore, mm(self.h_r), mm(self.d_r)) if self.d_r > 0 else None,
            groove=Groove(
                bore + mm(self.t_g), mm(self.w_g) / 2, float(self.phi_g) * angle / (np.pi / 2),
                bool(self.phi_g > WHOLE),
            ) if upper and self.t_g > 0 else None,
            hole=mm(self.d_h) / 2 if upper else 0.0,
            tang=Tang(mm(self.w_t), mm(self.l_t), mm(self.h_t), -mm(self.B) / 4) if self.w_t > 0 else None,
            flange=Flange(mm(self.D_f) / 2 + wider, mm(self.b_f), round(float(self.n_f)))
            if self.D_f > 0 else None,
            lift=np.pi / 2 - angle,
            offset=mm(self.offset),
            reduction_height=mm(self.h_delta),
        )  # fmt: skip

    def bounding_box(self) -> Box:
        """Return the box of the back or its flanges, including the tang on the side +x and the legs."""
        shell = self.drawn("full" if self.shells == "full" else "upper")
        left, right, low = reach_of(shell)
        high, b = shell.flange.radius if shell.flange else shell.outside, shell.half_width
        far = high + shell.crush
        bottom, top = {
            "pair": (-far, far), "upper": (low, high), "lower": (-high, -low), "full": (-high, high),
        }[self.shells]  # fmt: skip
        return Box((-left, bottom, -b), (right, top, b))

    def dimensions(self, seen: Mapping[str, PartSurfaces]) -> dict[str, float]:
        """Return every length of the shells, read from the upper shell if there is one."""
        which = "upper" if self.shells == "pair" else self.shells
        back = seen[f"{which}_back"]
        shown = back, seen.get(f"{which}_lining", back), self.drawn(which)
        if self.state == "free":
            return FreeShellReadback(*shown).free_sizes(with_oil=which == "upper")
        side = {"upper": 1, "lower": -1, "full": 0}[which]
        return ShellReadback(*shown).sizes(with_oil=which != "lower", side=side)
