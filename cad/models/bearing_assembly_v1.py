"""An assembled main bearing: journal, two half shells, block and cap; see the class below."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi

from cadquery import Solid, Vector

from cad.model import BRIGHT_STEEL, BRONZE, STEEL, Box, CadModel, Part, mm
from cad.shells.half_shell import HalfShell
from cad.shells.housing import Housing
from cad.surfaces import PartSurfaces, Size, X, Y, Z
from templates.core.language.template import Array, Truth, derived, formula, given, require, units

IRON = (0.42, 0.44, 0.47)
IRON_DENSITY = 7200.0  # kg/m³, grey cast iron (EN 1561: 7.10 to 7.30 g/cm³)
SAME = 1e-11  # relative; sizes are written with twelve digits
LINING_DENSITY = 3110.0  # kg/m³, of AlSn20Cu: mixture of its elements by mass


@units("m", returns="1")
def is_a_gap(length: Array) -> Truth:
    """Return whether a length [m] is large enough for the kernel to treat as a gap: at least 0.1 µm."""
    return length >= 1e-7


class BearingAssembly(CadModel):
    """Main bearing assembly: journal, half shells and housing, with clearance and crush height measured.

    z is along the shaft, y = 0 the joint of the block; the cap is at -y. The journal is at the middle of the
    upper shell. The bore of the shells is the journal diameter plus the clearance. Set the clearance by a
    relation to the diametral clearance of a film template; the service then measures it between bore and
    journal of the file.

    Block and cap hold the shells without play unless you give a larger housing bore. The crush height is that
    of each end of a shell: before the bolts are tightened, the shells touch each other and the gap between
    cap and block is twice the crush height. The model shows and measures this state.

    No two parts may overlap. A rule refuses a housing smaller than the shells, and the solids in the file are
    intersected pair by pair; the message about an interference names both parts and the volume that they
    share.

    Limits
    ------
    The shells have no groove, tang or relief (`plain_bearing` has them), and the housing is two boxes without
    bolts (`bearing_housing` has them). The parts are not deformed: the tightened shell and its contact
    pressure are not calculated.

    References
    ----------
    ISO 3548-1:2014, Plain bearings, thin-walled half bearings, part 1: crush height.
    """

    example = {
        "journal_diameter": "48 mm",
        "diametral_clearance": "0.055 mm",
        "wall": "2.4 mm",
        "width": "22 mm",
        "lining_thickness": "0.6 mm",
        "crush_height": "0 mm",
        "housing_bore": "52.875 mm",
        "housing_breadth": "100 mm",
        "block_height": "65 mm",
        "cap_height": "44 mm",
        "journal_length": "30 mm",
    }
    keeps_apart = True
    toleranced = {
        "journal_diameter": {"datum": "A", "cylindricity": 0.5},
        "journal_length": {"perpendicularity": 1, "to": "A"},
        "width": {},
        "lining_thickness": {},
        "crush_height": {},
        "housing_bore": {"cylindricity": 0.5},
        "housing_breadth": {},
        "block_height": {},
        "cap_height": {},
        "wall": {},
    }

    d: Array = given("mm", "journal diameter", symbol="d_j", ge=5, le=2000, also=("bearing diameter",))

    @derived("mm", "diametral clearance", symbol="C", ge=0, le=100)
    def C(self) -> Array:
        return 1e-3 * self.d

    @derived("mm", "wall", symbol="t", ge=0.2, le=200)
    def t(self) -> Array:
        return 0.05 * self.d

    @derived("mm", "width", symbol="B", ge=0.5, le=2000, also=("bearing width",))
    def B(self) -> Array:
        """Return the default width of shells and housing."""
        return 0.5 * self.d

    @derived("mm", "lining thickness", symbol="t_l", ge=0.02, le=50)
    def t_l(self) -> Array:
        return 0.125 * self.t

    @derived("mm", "crush height", symbol="a", ge=0, le=50)
    def a(self) -> Array:
        """Return the default: no crush height, so the cap touches the block."""
        return 0 * self.d

    @formula("mm", "outside of the shells", name="shell_diameter", symbol="D")
    def D(self) -> Array:
        return self.d + self.C + 2 * self.t

    @derived("mm", "housing bore", symbol="D_h", ge=5, le=3000)
    def D_h(self) -> Array:
        return self.D

    @derived("mm", "housing breadth", symbol="A_h", ge=5, le=5000)
    def A(self) -> Array:
        return 2 * self.D

    @derived("mm", "block height", symbol="H_b", ge=2, le=5000)
    def H_b(self) -> Array:
        return 1.2 * self.D

    @derived("mm", "cap height", symbol="H_c", ge=2, le=5000)
    def H_c(self) -> Array:
        return 0.85 * self.D

    @derived("mm", "journal length", symbol="L_j", ge=0.5, le=5000)
    def L_j(self) -> Array:
        return 1.4 * self.B

    @formula("mm", "play of the shells in the housing", name="seat_play", symbol="s")
    def s(self) -> Array:
        return self.D_h - self.D

    @formula("mm", "cap's distance from the block", name="cap_gap", symbol="g")
    def g(self) -> Array:
        return 2 * self.a

    @require("diametral_clearance", "journal_diameter", remedy="make the clearance smaller, or 0 for none")
    def clearance_is_small(self) -> Truth:
        """The clearance is at most 5 % of the journal, and 0 or at least 0.1 µm."""
        return (self.C <= 0.05 * self.d) & ((self.C <= 0) | is_a_gap(self.C))

    @require("housing_bore", "journal_diameter", "diametral_clearance", "wall",
             remedy="make the housing bore larger or the wall thinner")  # fmt: skip
    def shells_fit_the_housing(self) -> Truth:
        """The outer diameter of the shells is at most the housing bore.

        Otherwise shells and housing interfere.
        """
        return self.D_h >= self.D * (1 - SAME)

    @require("housing_bore", "wall", remedy="make the housing bore smaller")
    def shells_lie_in_the_housing(self) -> Truth:
        """The play of the shells in the housing is at most half a wall; 0, or at least 0.1 µm."""
        play = self.D_h - self.D
        return (play <= 0.5 * self.t) & ((play <= SAME * self.D) | is_a_gap(play))

    @require("lining_thickness", "wall", remedy="make the lining thinner or the wall thicker")
    def back_is_steel(self) -> Truth:
        """The lining is at most 60 % of the wall."""
        return self.t_l <= 0.6 * self.t

    @require("wall", "journal_diameter", remedy="make the wall thinner")
    def wall_is_thin(self) -> Truth:
        """The wall is at most 20 % of the journal's diameter."""
        return self.t <= 0.2 * self.d

    @require("crush_height", "journal_diameter", remedy="make the crush height smaller, or 0 for none")
    def crush_is_small(self) -> Truth:
        """The crush height is at most 1 % of the journal's diameter, and 0 or at least 1 µm."""
        return (self.a <= 0.01 * self.d) & ((self.a <= 0) | is_a_gap(self.a / 10))

    @require("crush_height", "diametral_clearance", remedy="leave play for the journal, or draw no crush")
    def journal_stands_free(self) -> Truth:
        """With a crush height there is also a clearance."""
        return (self.a <= 0) | (self.C > 0)

    @require("housing_breadth", "housing_bore", remedy="make the housing broader")
    def bore_has_sides(self) -> Truth:
        """The housing is at least 5 % broader than its bore."""
        return self.A >= 1.05 * self.D_h

    @require("block_height", "cap_height", "housing_bore", remedy="make block and cap higher")
    def bore_has_a_roof(self) -> Truth:
        """The heights of block and cap are each at least 55 % of the bore diameter."""
        return (self.H_b >= 0.55 * self.D_h) & (self.H_c >= 0.55 * self.D_h)

    def build(self) -> tuple[Part, ...]:
        """Return the journal, both shells with their linings, block and cap."""
        shell, housing = self.drawn(), self.housing()
        half, radius, down = mm(self.L_j) / 2, mm(self.d) / 2, Vector(0, -2 * shell.crush, 0)
        journal = Solid.makeCylinder(radius, 2 * half, Vector(0, 0, -half), Vector(0, 0, 1))
        back, lining = shell.back(), shell.lining_piece()
        lower_back, lower_lining = (body.mirror("XZ").translate(down) for body in (back, lining))
        steel, soft, iron = "", "AlSn20Cu", "cast iron"
        cap = housing.cap(2 * shell.crush)
        backs, linings = shell.back_volume(), shell.lining_volume()
        return (
            Part("journal", journal, pi * radius**2 * 2 * half, BRIGHT_STEEL),
            Part("upper_back", back, backs, STEEL, material=steel),
            Part("upper_lining", lining, linings, BRONZE, LINING_DENSITY, material=soft),
            Part("lower_back", lower_back, backs, STEEL, material=steel),
            Part("lower_lining", lower_lining, linings, BRONZE, LINING_DENSITY, material=soft),
            Part("block", housing.block(), housing.block_volume(), IRON, IRON_DENSITY, material=iron),
            Part("cap", cap, housing.cap_volume(), IRON, IRON_DENSITY, material=iron),
        )

    def drawn(self) -> HalfShell:
        """Return the upper shell."""
        bore = (mm(self.d) + mm(self.C)) / 2
        return HalfShell(
            bore=bore,
            lining=bore + mm(self.t_l),
            outside=mm(self.D) / 2,
            half_width=mm(self.B) / 2,
            inner_chamfer=0.0,
            outer_chamfer=0.0,
            crush=mm(self.a),
            relief=None,
            groove=None,
            hole=0.0,
            tang=None,
            flange=None,
        )

    def housing(self) -> Housing:
        """Return the block and cap."""
        return Housing(
            bore=mm(self.D if self.s <= SAME * self.D else self.D_h) / 2,
            half_width=mm(self.B) / 2,
            half_breadth=mm(self.A) / 2,
            block_height=mm(self.H_b),
            cap_height=mm(self.H_c),
        )

    def bounding_box(self) -> Box:
        """Return the box of the housing, extended to the journal where that is longer."""
        a, b = mm(self.A) / 2, max(mm(self.B), mm(self.L_j)) / 2
        return Box((-a, -mm(self.H_c) - 2 * mm(self.a), -b), (a, mm(self.H_b), b))

    def dimensions(self, seen: Mapping[str, PartSurfaces]) -> dict[str, float]:
        """Return every parameter.

        The clearance is read between bore and journal, the crush height at a joint.
        """
        journal, lining, back = seen["journal"], seen["upper_lining"], seen["upper_back"]
        block, cap = seen["block"], seen["cap"]
        bore, outside, joint = lining.rings(Z), back.rings(Z)[-1], back.levels(Y)[0]
        return {
            "journal_diameter": journal.diameters(Z)[0],
            "diametral_clearance": bore[0][0].diameter - journal.diameters(Z)[0],
            "wall": Size.wall(bore[0], outside),
            "width": back.length(Z),
            "lining_thickness": Size.wall(bore[0], bore[-1]),
            "crush_height": Size.distance(-joint + 0.0, bore[0], back.planes_at(Y, joint)),
            "housing_bore": block.diameters(Z)[0],
            "housing_breadth": block.length(X),
            "block_height": block.length(Y),
            "cap_height": cap.length(Y),
            "journal_length": journal.length(Z),
        }
