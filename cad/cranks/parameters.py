"""Parameters and derived quantities of a crank throw, shared by the models of a throw and of a shaft.

Each model adds the length of main journal that it draws on each side of the throw (`L_s`). A parameter of 0
omits the feature: bores, fillet, oil drilling, counterweight, inclination. Without a `counterweight_radius`,
the counterweight angle has no effect.

The *face inclination* is the angle by which the outer face of each web leans towards the middle of the throw,
starting next to the journal fillet and ending beyond the pin. At 0 the face is flat and the web heaviest; a
larger angle removes more material. To add material on an inclined face, as Punewale et al. (2015) do to
stiffen a shaft, reduce `face_inclination`.
"""

from __future__ import annotations

import numpy as np

from cad.cranks.outline import Outline
from cad.cranks.throw import Throw
from cad.model import CadModel, mm
from templates.core.language.template import Array, choice, derived, formula, given


class CrankParameters(CadModel):
    """Parameters of a crank throw."""

    L_s: Array  # length of the main journal drawn on each side

    D_j: Array = given(
        "mm",
        "journal diameter",
        symbol="D_j",
        ge=1,
        le=2000,
        also=("main journal diameter", "shaft diameter"),
    )

    @derived("mm", "journal length", symbol="L_j", ge=0.05, le=5000)
    def L_j(self) -> Array:
        """Return the default: 0.7 of the journal diameter, which is common in engines."""
        return 0.7 * self.D_j

    @derived("mm", "journal bore", symbol="d_j", ge=0, le=2000)
    def d_j(self) -> Array:
        """Return the default: no bore."""
        return 0 * self.D_j

    @derived("mm", "pin diameter", symbol="D_c", ge=0.1, le=2000, also=("crankpin diameter",))
    def D_c(self) -> Array:
        """Return the default: slightly less than the journal diameter."""
        return 0.85 * self.D_j

    @derived("mm", "pin length", symbol="L_c", ge=0.05, le=5000, also=("crankpin length",))
    def L_c(self) -> Array:
        """Return the default: slightly less than the journal length."""
        return 0.6 * self.D_j

    @derived("mm", "pin bore", symbol="d_c", ge=0, le=2000)
    def d_c(self) -> Array:
        """Return the default: no bore."""
        return 0 * self.D_j

    @derived("mm", "web thickness", symbol="L_w", ge=0.05, le=5000)
    def L_w(self) -> Array:
        """Return the default: a third of the journal diameter."""
        return 0.33 * self.D_j

    @derived("mm", "web width", symbol="W", ge=0.1, le=10000)
    def W(self) -> Array:
        """Return the default: wide enough for journal and pin with their fillets."""
        return 1.4 * np.maximum(self.D_j, self.D_c)

    web_shape: str = choice("obround", "rectangular", words="web shape", default="obround")

    @derived("mm", "throw", symbol="R", ge=0.01, le=10000, also=("crank radius",))
    def R(self) -> Array:
        """Return the default; with the other defaults, pin and journal overlap."""
        return 0.75 * self.D_j

    @derived("mm", "fillet", symbol="r_f", ge=0, le=500)
    def r_f(self) -> Array:
        """Return the default: a usual fillet, or the largest one for which there is room."""
        return np.minimum(
            np.minimum(0.05 * np.minimum(self.D_j, self.D_c), 0.1 * np.minimum(self.L_j, self.L_c)),
            0.25 * np.abs(self.W - np.maximum(self.D_j, self.D_c)),
        )

    @derived("mm", "oil drilling diameter", symbol="d_o", ge=0, le=500)
    def d_o(self) -> Array:
        """Return the default: no oil drilling."""
        return 0 * self.D_j

    @derived("mm", "counterweight radius", symbol="R_w", ge=0, le=10000)
    def R_w(self) -> Array:
        """Return the default: no counterweight."""
        return 0 * self.D_j

    phi_w: Array = given("deg", "counterweight angle", symbol=r"\varphi_w", default="120 deg", ge=10, le=180)

    beta: Array = given("deg", "face inclination", symbol=r"\beta", default="0 deg", ge=0, le=80)

    @formula("mm", "overlap", symbol="s")
    def s(self) -> Array:
        """Overlap of journal and pin, seen along the shaft; negative without overlap."""
        return (self.D_j + self.D_c) / 2 - self.R

    @formula("mm", "journal wall", symbol="w_j")
    def w_j(self) -> Array:
        """Thickness between the bore and the surface of the journal."""
        return (self.D_j - self.d_j) / 2

    @formula("mm", "pin wall", symbol="w_c")
    def w_c(self) -> Array:
        """Thickness between the bore and the surface of the pin."""
        return (self.D_c - self.d_c) / 2

    @formula("mm**2", "counterweight sector", symbol="A_w")
    def A_w(self) -> Array:
        """Area of the counterweight sector, measured from the journal axis."""
        return self.phi_w / 2 * self.R_w**2

    @formula("mm", "incline start", symbol="x_b")
    def x_b(self) -> Array:
        """Position at which a web's outer face begins to slope: beyond the journal and its fillet."""
        return 0.51 * self.D_j + self.r_f

    @formula("mm", "web end thickness", symbol="L_e")
    def L_e(self) -> Array:
        """Thickness of a web at its end beyond the pin, where the inclined face removes most material."""
        return self.L_w - np.tan(self.beta) * (self.R + self.W / 2 - self.x_b)

    @formula("mm", "drilling rise", symbol="h_o")
    def h_o(self) -> Array:
        """Length of the oil drilling along the shaft, from mid-pin to the middle of the drawn journal."""
        return (self.L_c + self.L_s) / 2 + self.L_w

    @formula("1", "drilling lean", symbol="k_o")
    def k_o(self) -> Array:
        """Slope of the oil drilling: length along the shaft per length across it."""
        return self.h_o / (self.R + (self.D_j + self.D_c) / 2)

    @formula("mm", "drilling section", symbol="e_o")
    def e_o(self) -> Array:
        """Half the length of the drilling's section in the face of a web."""
        return self.d_o / 2 * np.sqrt(1 + 1 / self.k_o**2)

    @formula("mm", "drilling mouth in the pin", name="pin_mouth", symbol="m_c")
    def m_c(self) -> Array:
        """Largest half length of the mouth along the pin."""
        return self.d_o / 2 * np.sqrt(1 + self.k_o**2) + self.k_o * self.d_o**2 / (2 * self.D_c)

    @formula("mm", "drilling mouth in the journal", name="journal_mouth", symbol="m_j")
    def m_j(self) -> Array:
        """Largest half length of the mouth along the journal."""
        return self.d_o / 2 * np.sqrt(1 + self.k_o**2) + self.k_o * self.d_o**2 / (2 * self.D_j)

    @formula("mm", "drilling height at the web's inner face", name="inner_crossing", symbol="x_1")
    def x_1(self) -> Array:
        """Position above the journal axis."""
        return self.R + self.D_c / 2 - self.L_c / 2 / self.k_o

    @formula("mm", "drilling height at the web's outer face", name="outer_crossing", symbol="x_2")
    def x_2(self) -> Array:
        """Position above the journal axis."""
        return self.R + self.D_c / 2 - (self.L_c / 2 + self.L_w) / self.k_o

    @formula("mm", "drilling cover at the start of the incline", name="cover_at_start", symbol="c_1")
    def c_1(self) -> Array:
        """Distance from the drilling's axis to the inclined face, along its normal."""
        return np.cos(self.beta) * self.k_o * (self.x_b - self.x_2)

    @formula("mm", "drilling cover at the web's inner face", name="cover_at_inner_face", symbol="c_2")
    def c_2(self) -> Array:
        """Distance from the drilling's axis to the inclined face, along its normal."""
        return np.cos(self.beta) * self.L_w - np.sin(self.beta) * (self.x_1 - self.x_b)

    def throw_drawn(self, counterweight: float) -> Throw:
        """Return the throw as radii, lengths and angles of the shape.

        `counterweight` is the counterweight radius of this throw [mm].
        """
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
            journal_length=mm(self.L_s),
            pin=mm(self.D_c) / 2,
            pin_bore=mm(self.d_c) / 2,
            pin_length=mm(self.L_c),
            fillet=mm(self.r_f),
            drilling=mm(self.d_o) / 2,
            inclination=float(self.beta),
            incline_start=mm(self.x_b),
        )
