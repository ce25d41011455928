"""Group: load, size and speeds of a journal bearing, and the ratios on which its film depends."""

from __future__ import annotations

from templates.core.language.template import Array, Template, Truth, formula, given, require
from templates.physics.journals.journal_motion import hydrodynamic_speed, sliding_speed

ISO = "ISO 7902-1:1998"


class Journal(Template):
    """Load, size and speeds of a journal bearing."""

    F: Array = given("N", "radial load", ge=0, also=("bearing load", "load"))
    c: Array = given("mm", "diametral clearance", gt=0)
    D: Array = given("mm", "bearing diameter", gt=0)
    W: Array = given("mm", "bearing width", gt=0)
    omega_J: Array = given("rpm", "speed", also=("journal speed",))
    omega_B: Array = given("rpm", "sleeve speed", default="0 rpm")
    omega_F: Array = given("rpm", "load speed", default="0 rpm")

    @require("diametral_clearance", "bearing_diameter", remedy="give the clearance as bore minus journal")
    def clearance_within_bearing(self) -> Truth:
        """The diametral clearance is smaller than the bearing diameter."""
        return self.c < self.D

    @formula("mm", "journal diameter")
    def d(self) -> Array:
        """Bore diameter minus clearance."""
        return self.D - self.c

    @formula("1", "relative clearance", symbol=r"\psi", source=ISO)
    def psi(self) -> Array:
        """Clearance relative to the diameter of the bore."""
        return self.c / self.D

    @formula(
        "1", "width ratio", ge=0.01, le=100, remedy="take a bearing between 0.01 and 100 as wide as its bore"
    )
    def b(self) -> Array:
        """Width over diameter."""
        return self.W / self.D

    @formula(
        "rad/s", "hydrodynamic speed", symbol=r"\omega_{h}", source=ISO, gt=0,
        remedy="without it there is no film: speed + sleeve speed must differ from twice the load speed",
    )  # fmt: skip
    def omega_h(self) -> Array:
        """Hydrodynamic speed: that of journal and sleeve relative to the load."""
        return hydrodynamic_speed(self.omega_J, self.omega_B, self.omega_F)

    @formula("rad/s", "sliding speed", symbol=r"\omega_{s}")
    def omega_s(self) -> Array:
        """Speed of the journal relative to the sleeve, in the sense of the hydrodynamic speed."""
        return sliding_speed(self.omega_J, self.omega_B, self.omega_F)
