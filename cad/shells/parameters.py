"""Parameters of plain-bearing shells as fitted in the housing, and derived quantities.

The digest of a released model covers this file, so put a change into a new file. A parameter of 0 omits the
feature: lining, tang, relief, hole, groove, flange, chamfers, crush height.
"""

from __future__ import annotations

import numpy as np

from cad.model import CadModel
from cad.shells.eccentric import offset_of, reduction_at
from templates.core.language.template import Array, Truth, choice, derived, formula, given, shared, units


@units("m", "m", returns="1")
def clear_share(width: Array, groove: Array) -> Array:
    """Return the width of the default tang as a share of the shell's width [m].

    The share is 0.12, or 0.09 if a side of the tang would otherwise be close to a side of the groove.
    """
    half = groove / 2 / width
    beside = np.minimum(abs(half - 0.19), abs(half - 0.31)) < 0.006  # 1/4 -+ 0.12/2
    return np.where(beside, 0.09, 0.12)


@units(None, returns="1")
def joints(shells: str) -> Array:
    """Return 1 for half shells, which have joints; 0 for a full bush."""
    return np.asarray(0.0 if shells == "full" else 1.0)


@units("m", "1", returns="1")
def drawable(length: Array, least: float) -> Truth:
    """Return whether a length [m] is 0, or large enough for the kernel: at least `least` micrometres."""
    return (length <= 0) | (length >= 1e-6 * least)


@units("m", "1", returns="m")
def if_drawable(length: Array, least: float) -> Array:
    """Return a length [m], or 0 if it is below `least` micrometres."""
    return np.where(drawable(length, least), length, 0 * length)[()]


@units("m", "m", returns="m")
def if_concentric(depth: Array, reduction: Array) -> Array:
    """Return the depth of a relief, or 0 if the wall reduction says that the bore is eccentric."""
    return np.where(reduction <= 0, depth, 0 * depth)[()]


class ShellParameters(CadModel):
    """Parameters of half shells or of a full bush."""

    d: Array = given("mm", "inner diameter", symbol="d", ge=1, le=5000, also=("bearing diameter", "bore"))

    @derived("mm", "wall", symbol="t", ge=0.04, le=1000)
    def t(self) -> Array:
        """Return the default: a twentieth of the bore."""
        return 0.05 * self.d

    @derived("mm", "width", symbol="B", ge=0.1, le=5000, also=("bearing width",))
    def B(self) -> Array:
        """Return the default: half the bore."""
        return 0.5 * self.d

    shells: str = choice("pair", "upper", "lower", "full", words="shells", default="pair")

    @derived("mm", "lining thickness", symbol="t_l", ge=0, le=600)
    def t_l(self) -> Array:
        """Return the default: an eighth of the wall."""
        return 0.125 * self.t

    @derived("mm", "oil hole diameter", symbol="d_h", ge=0, le=1000)
    def d_h(self) -> Array:
        """Return the default: a usual hole, or the largest for which the width leaves room."""
        return np.minimum(0.08 * self.d, 0.2 * self.B)

    @derived("mm", "oil groove width", symbol="w_g", ge=0, le=1000)
    def w_g(self) -> Array:
        """Return the default: slightly wider than the hole."""
        return np.minimum(1.25 * self.d_h, 0.5 * self.B)

    @derived("mm", "oil groove depth", symbol="t_g", ge=0, le=500)
    def t_g(self) -> Array:
        """Return the default: about a third of the wall, if there is a groove."""
        return 0.35 * self.t * np.sign(self.w_g)

    phi_g: Array = given("deg", "oil groove angle", symbol=r"\varphi_g", default="180 deg", ge=20, le=180)

    @derived("mm", "tang width", symbol="w_t", ge=0, le=1000)
    def w_t(self) -> Array:
        """Return the default: 0.12 of the width, or 0.09 if a side would be in the plane of a groove side."""
        return joints(self.shells) * self.B * clear_share(self.B, self.w_g)

    @derived("mm", "tang length", symbol="l_t", ge=0.05, le=1000)
    def l_t(self) -> Array:
        """Return the default length along the wall."""
        return 0.08 * self.d

    @derived("mm", "tang height", symbol="h_t", ge=0.01, le=1000)
    def h_t(self) -> Array:
        """Return the default height above the back."""
        return 0.4 * self.t

    @derived("mm", "wall reduction", symbol=r"\delta", ge=0, le=100)
    def delta(self) -> Array:
        """Return the default: a concentric bore, with a wall of constant thickness."""
        return 0 * self.d

    @derived("mm", "reduction height", symbol=r"h_\delta", ge=0.05, le=1500)
    def h_delta(self) -> Array:
        """Return the default height above the joint at which the wall reduction is measured."""
        return 0.2 * self.d

    @shared(unit="mm")
    def offset(self) -> Array:
        """Offset of the axis of an eccentric bore."""
        return offset_of(self.d / 2, self.delta, self.h_delta)

    @shared(unit="mm")
    def drop(self) -> Array:
        """Difference between the wall at the crown and at the joint."""
        return reduction_at(self.d / 2, self.offset, 0 * self.d)

    @derived("mm", "relief height", symbol="h_r", ge=0.05, le=1500)
    def h_r(self) -> Array:
        """Return the default height above the joint."""
        return 0.12 * self.d

    @derived("mm", "relief depth", symbol="d_r", ge=0, le=100)
    def d_r(self) -> Array:
        """Return the default depth at the joint: a tenth of the lining, or 0 if that cannot be built."""
        return joints(self.shells) * if_concentric(if_drawable(0.1 * self.t_l, 1.0), self.delta)

    @derived("mm", "inner chamfer", symbol="c_i", ge=0, le=500)
    def c_i(self) -> Array:
        """Return the default chamfer of the bore: a fifth of the wall, or 0 if that cannot be built."""
        return if_drawable(0.2 * self.t, 10.0)

    @derived("mm", "outer chamfer", symbol="c_o", ge=0, le=500)
    def c_o(self) -> Array:
        """Return the default chamfer of the back: a quarter of the wall."""
        return 0.25 * self.t

    @derived("mm", "flange diameter", symbol="D_f", ge=0, le=15000)
    def D_f(self) -> Array:
        """Return the default: no flange."""
        return 0 * self.d

    @derived("mm", "flange thickness", symbol="b_f", ge=0.02, le=1000)
    def b_f(self) -> Array:
        """Return the default: as thick as the wall."""
        return self.t

    n_f: Array = given("1", "flanges", symbol="n_f", default="2", integer=True, ge=1, le=2)

    @derived("mm", "crush height", symbol="a", ge=0, le=50)
    def a(self) -> Array:
        """Return the default: no crush height, as for an installed shell."""
        return 0 * self.d

    @formula("mm", "outer diameter", symbol="D")
    def D(self) -> Array:
        """Outer diameter of the back, as held in the housing."""
        return self.d + 2 * self.t

    @formula("mm", "length of the groove along the bore", name="groove_length", symbol="L_g")
    def L_g(self) -> Array:
        """Arc length of the groove along the bore."""
        return self.d / 2 * self.phi_g

    @formula("mm", "steel back", name="back_thickness", symbol="t_s")
    def t_s(self) -> Array:
        """Thickness of the steel without the lining."""
        return self.t - self.t_l

    @formula("mm", "width between flanges", name="seat_width", symbol="B_s")
    def B_s(self) -> Array:
        """Width of the seat between the flanges; the whole width if there is no flange."""
        return self.B - np.sign(self.D_f) * self.n_f * self.b_f
